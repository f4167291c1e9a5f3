"""Sums over the instants of a period where laws come from one smooth piece of their force to another."""

from __future__ import annotations

import numpy as np

import rotorgear as rg
from rotorgear.analysis.orbits.family import SystemFamily, range_of
from rotorgear.solvers.periodic.balance import HarmonicGrid, balance
from tests.paths import MODELS


def test_tangents_move_without_jumps_as_flanks_touch_are_fully_damped_and_let_go() -> None:
    model = rg.load(MODELS / "flexible_pair.toml")
    family = SystemFamily(model, [range_of(model, "operation.speed", "5990 rpm:6160 rpm")], None, None)
    plant = family.plant(0.0)
    harmonics = 8
    instants = 128
    grid = HarmonicGrid(harmonics, instants, family.order)
    # In contact for more than half of a period, with the non-adhesive damper that lets go before the flanks part.
    c = np.zeros((harmonics + 1, plant.m), complex)
    c[0] = 1e-5
    c[1] = 4e-5
    spacing = 2.0 * np.pi / instants
    tangents = [
        balance(c * np.exp(-1j * turn * spacing * np.arange(harmonics + 1))[:, None], plant, grid)[1].ravel()
        for turn in np.linspace(0.0, 1.0, 101)
    ]
    steps = np.linalg.norm(np.diff(tangents, axis=0), axis=1)
    assert steps.max() < 1.5 * np.median(steps)
    exact_u, exact_tangent = balance(c, plant, HarmonicGrid(harmonics, 64 * instants, family.order))
    u, tangent = balance(c, plant, grid)
    assert np.abs(u - exact_u).max() < 1e-4 * np.abs(exact_u).max()
    assert np.abs(tangent - exact_tangent).max() < 1e-3 * np.abs(exact_tangent).max()
