"""Error of motions along a branch: from twice the harmonics and instants, or from shooting to a tighter tolerance."""

from __future__ import annotations

import numpy as np

from rotorgear.analysis.orbits.follow import AnyOrbits, Branch
from rotorgear.errors import ConvergenceError
from rotorgear.solvers.periodic.arclength import Node

# Points of a branch whose coefficients are compared.
_POINTS = 3
# Beside a fold both solutions of one value lie next to each other: there the value tells no motion, and no error of one.
_FOLD = 1e-3
# Of the largest displacement: what moves less has no accuracy of its own.
_STILL = 1e-6


def refined(orbits: AnyOrbits, finer: AnyOrbits, node: Node) -> np.ndarray | None:
    """Unknowns of the finer equations at a node's value, a step of Newton's method from its motion; none beside a fold.

    The step is from a residual that is small by itself: what a second one would change is the square of the error.
    """
    if abs(node.tangent[-1]) <= _FOLD:
        return None
    try:
        finer.settle_on(node.p)
        y = orbits.lifted(node.y, finer)  # type: ignore[arg-type]
        residual, slope = finer.values(y, node.p)
        better = y - np.linalg.solve(slope, residual)
    except (ConvergenceError, np.linalg.LinAlgError):
        return None
    return np.asarray(better) if np.all(np.isfinite(better)) else None


def largest_error(branch: Branch, columns: np.ndarray) -> float:
    """Largest relative difference of the displacements' coefficients at some points from the finer solution of the same method.

    Args:
        branch: a branch. columns: local displacements that are compared.
    """
    orbits = branch.orbits
    finer = orbits.finer()
    numbers = np.unique(np.linspace(0, len(branch.nodes) - 1, _POINTS + 2).round().astype(int)[1:-1])
    found = []
    for node in (branch.nodes[i].node for i in numbers):
        better = refined(orbits, finer, node)
        if better is not None:
            coarse = orbits.cycle(node.y, node.p).displacement
            found.append(float(change(coarse, finer.cycle(better, node.p).displacement, columns).max()))
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
