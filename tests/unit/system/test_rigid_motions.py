"""Motions without strain: part by part where nothing joins the parts, and all of them together."""

from __future__ import annotations

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.system.rigid_motions import rigid_motions
from rotorgear.system.system import System

COUPLING = {
    "from_shaft": "s0",
    "from_at": 0.1,
    "to_shaft": "s2",
    "to_at": 0.0,
    "stiffness": {"radial": 1e8, "axial": 1e8, "tilt": 1e5, "torsion": 1e5},
}
PAIRS = {
    f"{shaft}_{k}": {"shaft": shaft, "at": at, "stiffness": {"radial": 1e8}}
    for shaft in ("s0", "s1")
    for k, at in enumerate((0.0, 0.1))
}


def loose(count: int, **parts: object) -> System:
    """So many shafts with nothing that holds them but what is given."""
    section = {"length": 0.1, "outer_diameter": 0.02}
    return System(rg.Model(shafts={f"s{k}": {"sections": [section]} for k in range(count)}, **parts), 2)


@pytest.mark.parametrize(
    ("parts", "count"),
    [
        ({}, 18),
        # A bearing across one shaft holds two motions, a pin three, a coupling of six stiffnesses six of the two.
        ({"bearings": {"b": {"shaft": "s0", "at": 0.0, "stiffness": {"radial": 1e8}}}}, 16),
        ({"supports": {"s": {"shaft": "s1", "at": 0.05, "fixed": ["x", "y", "z"]}}}, 15),
        ({"couplings": {"c": COUPLING}}, 12),
        # Each of two shafts in its bearings keeps two, which the coupling hands on to the third, or takes with a held torsion.
        ({"bearings": PAIRS, "couplings": {"c": COUPLING}}, 4),
        (
            {
                "bearings": PAIRS,
                "couplings": {"c": COUPLING},
                "supports": {"s": {"shaft": "s2", "at": 0.05, "fixed": ["torsion"]}},
            },
            3,
        ),
    ],
)
def test_loose_shafts_keep_the_motions_that_nothing_holds(parts: dict[str, object], count: int) -> None:
    system = loose(3, **parts)
    R = rigid_motions(system, system.groups)
    assert R.shape == (system.n, count)
    assert np.linalg.matrix_rank(R) == count
    strained = system.strain_factor() @ R
    assert np.abs(strained).max() < 1e-12 * np.abs(system.strain_factor()).max()


def test_parts_that_nothing_joins_are_solved_apart() -> None:
    system = loose(60)
    R = rigid_motions(system, system.groups)
    assert R.shape[1] == 360
    # Six motions of one shaft stand in the rows of that shaft only.
    assert np.count_nonzero(np.abs(R).max(axis=1) > 0.0) == system.n
    assert all(np.count_nonzero(column) <= system.n // 60 for column in R.T)
