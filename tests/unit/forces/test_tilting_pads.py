"""Tilting pads: level pads, symmetry, reduction of their tilt, and the grid."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.errors import AnalysisError
from rotorgear.forces.tilting_pads import TiltingPads

SPEED = 500.0
GRID = {"around": 120, "along": 4}


def pads(**changes: object) -> TiltingPads:
    given = {"viscosity": 0.02, "radius": 0.05, "length": 0.05, "clearance": 1e-4, "preload": 0.3, **GRID, **changes}
    return TiltingPads(**given)  # type: ignore[arg-type]


def pushed(law: TiltingPads, load: np.ndarray) -> np.ndarray:
    """Where the journal stands under a load."""
    d = np.zeros(2)
    for _ in range(40):
        about = law.linearised(d, speed=SPEED)
        step = np.linalg.solve(about.stiffness, load - about.force)
        d = d + step * min(1.0, 0.3 * law.clearance / np.abs(step).max())
        if np.abs(step).max() < 1e-13:
            return d
    raise AssertionError("no equilibrium")


@pytest.mark.parametrize("at", [-90.0, -54.0])
@pytest.mark.parametrize("pivot", [0.5, 0.6])
def test_a_load_on_or_between_pads_moves_the_journal_along_itself_without_cross_stiffness(at, pivot) -> None:
    law = pads(at=np.radians(at), pivot=pivot)
    d = pushed(law, np.array([0.0, -3000.0]))
    state = law.settled(d).linearised(d, speed=SPEED)
    K = state.stiffness
    C = state.damping
    assert abs(d[0]) < 1e-8 * abs(d[1])
    assert max(abs(K[0, 1]), abs(K[1, 0])) < 1e-8 * np.abs(K).max()
    assert max(abs(C[0, 1]), abs(C[1, 0])) < 1e-8 * np.abs(C).max()
    assert np.linalg.eigvalsh(C).min() > 0.0


def test_pads_stand_where_their_pressure_has_no_moment_about_the_pivot() -> None:
    law = pads(at=-1.2)
    d = np.array([1e-5, -5e-5])
    film = law.inside(d, speed=SPEED)
    pivots = law.at + 2.0 * np.pi * np.arange(5) / 5
    for k, pressure in enumerate(np.split(film.pressure, 5)):
        angle = np.split(film.angle, 5)[k] - pivots[k]
        moment = np.sum(pressure.sum(axis=1) * np.sin(angle))
        assert abs(moment) <= 1e-9 * max(np.sum(pressure), 1.0)
    assert film.gap.min() > 0.0
    total = np.array([np.sum(film.pressure.T * f(film.angle)) for f in (np.cos, np.sin)])
    force = law.evaluate(d, speed=SPEED).force
    assert total[1] / total[0] == pytest.approx(force[1] / force[0], rel=1e-9)


def test_slow_motions_have_the_stiffness_of_the_difference_quotient() -> None:
    law = pads(at=-1.0, pivot=0.55)
    d = np.array([1e-5, -4e-5])
    slow = law.settled(d)
    h = 1e-9
    quotient = np.column_stack(
        [
            (law.evaluate(d + h * e, speed=SPEED).force - law.evaluate(d - h * e, speed=SPEED).force) / (2 * h)
            for e in np.eye(2)
        ]
    )
    reduced = replace(slow, whirl_ratio=1e-4).linearised(d, speed=SPEED).stiffness
    np.testing.assert_allclose(reduced, quotient, atol=2e-4 * np.abs(quotient).max())
    # At the speed itself the pads lag behind, and the stiffness is another one.
    assert np.abs(slow.linearised(d, speed=SPEED).stiffness - quotient).max() > 1e-3 * np.abs(quotient).max()


def test_a_mirrored_bearing_that_turns_the_other_way_is_the_mirror_image() -> None:
    there = pads(at=0.3, pivot=0.6)
    mirrored = pads(at=np.pi - 0.3, pivot=0.6, order=-1.0)
    d = np.array([2e-5, -3e-5])
    flip = np.array([-1.0, 1.0])
    np.testing.assert_allclose(
        mirrored.evaluate(flip * d, speed=SPEED).force, flip * there.evaluate(d, speed=SPEED).force, rtol=1e-8
    )


def test_the_force_converges_with_the_square_of_the_grid() -> None:
    d = np.array([0.0, -5e-5])
    forces = [pads(at=-np.pi / 2, around=60 * n, along=3 * n).evaluate(d, speed=SPEED).force[1] for n in (1, 2, 4)]
    assert np.log2((forces[1] - forces[0]) / (forces[2] - forces[1])) > 1.6


def test_pads_that_do_not_fit_are_refused() -> None:
    with pytest.raises(AnalysisError, match="pads that fit"):
        pads(arc=1.3)


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        ("pads = 1", "bearings.b.journal.pads: got 1, expected 2 to 12 pads"),
        (
            'pads = 5, pad_arc = "80 deg"',
            "bearings.b.journal.pad_arc: got 5 of 80 deg, expected pads that fit on 360 deg",
        ),
        ("pads = 5, lobes = 2", "bearings.b.journal.pads: got pads beside lobes"),
        ("pads = 5, pivot = 1.0", "bearings.b.journal.pivot: got 1"),
        ("whirl_ratio = 0.5", "keys of pads in a fixed bearing"),
    ],
)
def test_keys_of_pads_in_a_file_that_make_no_sense_are_told_by_address(keys: str, said: str) -> None:
    film = 'diameter = "60 mm", length = "30 mm", clearance = "60 um", viscosity = "20 mPa s"'
    text = f'[shafts.a]\n[bearings.b]\nshaft = "a"\nat = "start"\njournal = {{ {film}, {keys} }}\n'
    with pytest.raises(rg.ModelError, match=said):
        rg.loads(text)
