"""Independent groups of dofs are solved apart: the same modes as all together, and what is left out is said."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import pytest

import rotorgear as rg
from tests import paths

# A model remembers the state of its loaded teeth, which takes longer to find than all modes here.
load = cache(rg.load)


@pytest.mark.parametrize("speed", [None, 0.0, 100.0])
@pytest.mark.parametrize("path", paths.SHIPPED)
def test_pruned_and_full_models_have_the_same_eigenvalues(path: Path, speed: float | None) -> None:
    model = load(path)
    if speed is not None and any(bearing.journal for bearing in model.bearings.values()):
        # Oil films carry a gearbox where its journals turn.
        speed = model.operation.speed
    pruned = rg.modal(model, speed=speed, modes=16, elements=2)
    full = rg.modal(model, speed=speed, modes=16, elements=2, pruning=False)
    scale = np.abs(full.eigenvalues[~full.rigid]).min(initial=np.inf)
    assert pruned.rigid.tolist() == full.rigid.tolist()
    difference = np.abs(np.abs(pruned.eigenvalues) - np.abs(full.eigenvalues)) / np.maximum(
        np.abs(full.eigenvalues), scale
    )
    assert np.max(difference) < 1e-10


def plain_rotor() -> rg.Model:
    return rg.Model(
        shafts={"s": rg.Shaft(sections=[rg.Section(length=1.0, outer_diameter=0.05)])},
        disks={"d": rg.Disk(shaft="s", at=0.4, outer_diameter=0.3, width=0.05)},
        bearings={end: rg.Bearing(shaft="s", at=end, stiffness={"radial": 1e7}) for end in ("start", "end")},
    )


def test_a_plain_rotor_falls_into_two_planes_of_bending_and_two_single_motions() -> None:
    result = rg.modal(plain_rotor(), modes=10)
    note = next(note for note in result.left_out if "solved apart" in note)
    assert "4 groups" in note
    assert note.count("bending") == 2
    assert "axial" in note
    assert "torsion" in note


def test_gyroscopic_terms_join_the_planes_of_bending() -> None:
    result = rg.modal(plain_rotor(), modes=10, speed="3000 rpm")
    note = next(note for note in result.left_out if "solved apart" in note)
    assert "3 groups" in note


def test_only_torsion_leaves_out_what_torsion_cannot_reach() -> None:
    everything = rg.modal(plain_rotor(), modes=24)
    torsion = rg.modal(plain_rotor(), modes=3, only=["torsion"])
    assert any(note.startswith("bending:") for note in torsion.left_out)
    assert any(note.startswith("axial:") for note in torsion.left_out)
    turning = everything.frequency_hz[everything.kinetic_by_motion["torsion"] > 0.5]
    assert torsion.frequency_hz[: len(turning)] == pytest.approx(turning[:3], rel=1e-3)


def test_a_mesh_of_helical_gears_joins_all_motions() -> None:
    result = rg.modal(load(paths.MODELS / "split_torque.toml"), modes=6)
    assert not any("solved apart" in note for note in result.left_out)


def test_an_unknown_motion_is_refused() -> None:
    with pytest.raises(rg.AnalysisError, match="expected motions among bending, axial, torsion"):
        rg.modal(plain_rotor(), only=["twisting"])
