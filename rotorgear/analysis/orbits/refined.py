"""Error of motions along a branch: from twice the harmonics and instants, or from a wider tolerance."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from rotorgear.analysis.orbits.follow import Branch
from rotorgear.errors import ConvergenceError
from rotorgear.solvers.periodic.arclength import at_value
from rotorgear.solvers.periodic.harmonic_orbits import HarmonicOrbits

# Points of a branch that are solved anew.
_POINTS = 3
# Of the largest displacement: what moves less has no accuracy of its own.
_STILL = 1e-6


def largest_error(branch: Branch, columns: np.ndarray) -> float:
    """Largest relative difference of the displacements' coefficients at some points from a finer solution.

    Of harmonic balance the finer solution has twice the harmonics and instants. Of shooting it is harmonic balance with many
    instants, another method: their difference is the larger error of both.

    Args:
        branch: a branch. columns: local displacements that are compared.
    """
    orbits = branch.orbits
    numbers = np.unique(np.linspace(0, len(branch.nodes) - 1, _POINTS + 2).round().astype(int)[1:-1])
    # Beside a fold both solutions of one value lie next to each other: there the value says too little.
    sound = [i for i in numbers if abs(branch.nodes[i].node.tangent[-1]) > 1e-3]
    found = []
    for i in sound:
        node = branch.nodes[i].node
        coarse = orbits.cycle(node.y, node.p).displacement
        finer = finer_of(orbits)
        c = np.zeros((finer.grid.harmonics + 1, coarse.shape[1]), complex)
        c[: len(coarse)] = coarse
        try:
            finer.settle_on(node.p)
            better = finer.coefficients(at_value(finer, finer.unknowns(c), node.p).y)
        except ConvergenceError:
            found.append(np.nan)
            continue
        found.append(float(change(coarse, better, columns).max()))
    return float(max(found, default=float("nan")))


def change(coarse: np.ndarray, better: np.ndarray, columns: np.ndarray) -> np.ndarray:
    """Largest difference of coefficients (h + 1, m) in each column, over the largest harmonic of the better ones.

    One that hardly moves beside the others is measured by the largest of them.
    """
    both = np.zeros((2, max(len(coarse), len(better)), len(columns)), complex)
    both[0, : len(coarse)] = coarse[:, columns]
    both[1, : len(better)] = better[:, columns]
    size = np.abs(both[1, 1:]).max(axis=0)
    size = np.maximum(size, _STILL * size.max(initial=0.0))
    return np.asarray(np.abs(both[0] - both[1]).max(axis=0) / size)


def finer_of(orbits: object) -> HarmonicOrbits:
    """Equations of twice the harmonics and instants."""
    from rotorgear.solvers.periodic.balance import Grid
    from rotorgear.solvers.periodic.shooting import ShootingOrbits

    if isinstance(orbits, ShootingOrbits):
        H = 2 * orbits.harmonics * orbits.periods
        grid = Grid(H, 2 * 16 * H, orbits.order / orbits.periods)
        return HarmonicOrbits(orbits._plant_at, grid, orbits.scale)
    assert isinstance(orbits, HarmonicOrbits)
    grid = replace(orbits.grid, harmonics=2 * orbits.grid.harmonics, instants=2 * orbits.grid.instants)
    return HarmonicOrbits(orbits._plant_at, grid, orbits.scale)
