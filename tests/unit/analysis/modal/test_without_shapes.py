"""Modes without shapes: the same numbers to the last bit, and one sentence where a shape is wanted."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.export.solids import build_solids
from tests.paths import ROOT

# Gears at standstill and at speed, planets, plain bearings without teeth, dofs without inertia, damping.
ASKED = (
    ("split_torque", None),
    ("split_torque", "16350 rpm"),
    ("planetary", None),
    ("herringbone_pair_12dof", None),
    ("jeffcott", "3000 rpm"),
)


@pytest.mark.parametrize(("name", "speed"), ASKED)
def test_the_numbers_are_the_same_to_the_last_bit(name: str, speed: str | None) -> None:
    model = rg.load(ROOT / "models" / f"{name}.toml")
    whole = rg.modal(model, speed=speed)
    quick = rg.modal(model, speed=speed, shapes=False)
    for field in ("eigenvalues", "rigid", "frequency_hz", "damping_ratio", "error_estimate", "backward_error"):
        assert np.array_equal(getattr(whole, field), getattr(quick, field), equal_nan=True), field
    assert quick.left_out == whole.left_out
    assert quick.warnings == whole.warnings
    assert (quick.dofs, quick.method) == (whole.dofs, whole.method)


def test_what_wants_shapes_says_that_there_are_none(tmp_path: Path) -> None:
    model = rg.load(ROOT / "models" / "jeffcott.toml")
    quick = rg.modal(model, shapes=False)
    for wanting in (lambda: build_solids(model, quick.nodes), lambda: rg.write_uff(quick, tmp_path / "a.unv")):
        with pytest.raises(rg.AnalysisError, match="found without their shapes"):
            wanting()
    assert "what moves" not in quick.text()
    kept = rg.read(rg.save(quick, tmp_path / "a.h5"))
    assert np.array_equal(kept.eigenvalues, quick.eigenvalues)
