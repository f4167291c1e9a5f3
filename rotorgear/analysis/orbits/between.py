"""Systems between exact ones: their numbers as polynomials of a parameter, where these hold to rounding.

A model is read, checked and assembled for each value of a parameter, which takes longer than to solve for a motion there. Loads,
matrices and parameters of laws are mostly smooth in it: the interpolant through Chebyshev points then converges geometrically
(Trefethen, Approximation Theory and Approximation Practice, SIAM 2013, ch. 8), and values at the new points of twice as many
tell its error. What is not smooth is assembled at each value.

A power gives torques in proportion to 1/speed: over a speed the polynomials are those of each number times the speed, of low
degree over wide ranges too.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import scipy.sparse as sp

from rotorgear.solvers.time.local_system import LocalSystem

# Error of the interpolant, of the largest value that a number takes, that is rounding of the assembly.
_ROUNDING = 1e-11
_MOST = 32
_MATRICES = ("M", "D", "K", "G", "B")
_OF_LAWS = ("parameters", "reference_stiffness", "reference_damping")
_ABOUT = {
    "stiffness_about": ("K", "B", "reference_stiffness"),
    "damping_about": ("D", "B", "reference_damping"),
}


@dataclass(frozen=True)
class Between:
    """Polynomials through systems at k shares of a range, their Chebyshev points: numbers by name (k, ...).

    `factor`: by which numbers are multiplied, at a share.
    """

    shares: np.ndarray
    first: LocalSystem
    varying: dict[str, np.ndarray]
    factor: Callable[[float], float]

    def at(self, share: float) -> LocalSystem:
        """The system at a share."""
        own = self.numbers(share)
        first = self.first
        changed: dict[str, Any] = {name: own[name] for name in ("load", "watched") if name in own}
        for name in own.keys() & set(_MATRICES):
            A = getattr(first, name)
            changed[name] = sp.csc_array((own[name], A.indices, A.indptr), shape=A.shape)
        inner: dict[str, Any] = {key: own[key] for key in _OF_LAWS if key in own}
        if inner:
            changed["forces"] = replace(first.forces, **inner)
        if "speeds" in own:
            changed["rotation"] = replace(first.rotation, speeds=own["speeds"])
        made = replace(first, **changed)
        for name, parts in _ABOUT.items():
            if not any(part in own for part in parts):
                made.__dict__[name] = getattr(first, name)  # a cached property of the same arguments
        return made

    def numbers(self, share: float) -> dict[str, np.ndarray]:
        """The numbers that vary, at a share."""
        off = share - self.shares
        at = np.flatnonzero(off == 0.0)
        if at.size:
            return {name: values[at[0]] for name, values in self.varying.items()}
        # Barycentric weights.
        parts = (-1.0) ** np.arange(len(off))
        parts[[0, -1]] *= 0.5
        parts /= off
        parts /= parts.sum()
        parts *= np.array([self.factor(one) for one in self.shares]) / self.factor(share)
        whole = parts.sum()
        # About the first of them, so that numbers that stay the same stay so to the last bit: a count is no 2.9999.
        found = {}
        for name, values in self.varying.items():
            mixed = whole * values[0] + np.tensordot(parts, values - values[0], axes=1)
            found[name] = np.where(np.all(values == values[0], axis=0), values[0], mixed)
        return found


def between(
    system_at: Callable[[float], LocalSystem], factor: Callable[[float], float] = lambda share: 1.0
) -> Between | None:
    """Polynomials of the systems over shares from 0 to 1; None where they do not converge.

    Args:
        system_at: the system at a share. factor: with which its numbers are polynomials, at a share; never zero.
    """
    known: dict[float, dict[str, np.ndarray]] = {}
    systems: dict[float, LocalSystem] = {}

    def numbers_at(share: float) -> dict[str, np.ndarray]:
        if share not in known:
            systems[share] = system_at(share)
            system = systems[share]
            own = {name: getattr(system, name).data for name in _MATRICES if getattr(system, name) is not None}
            if system.watched is not None:
                own["watched"] = system.watched
            own |= {name: getattr(system.forces, name) for name in _OF_LAWS}
            known[share] = own | {"load": system.load, "speeds": system.rotation.speeds}
        return known[share]

    degree = 2
    while degree < _MOST:
        coarse = _points(degree)
        fine = _points(2 * degree)
        rows = [numbers_at(share) for share in coarse]
        if not all(_alike(systems[0.0], systems[share]) for share in coarse):
            return None
        varying = {
            name: np.array([row[name] for row in rows])
            for name, values in rows[0].items()
            if not all(np.array_equal(values, row[name]) for row in rows)
        }
        found = Between(coarse, systems[0.0], varying, factor)
        sizes = {name: np.abs(values).max(axis=0) for name, values in varying.items()}
        worst = 0.0
        for share in fine[1::2]:
            exact = numbers_at(share)
            if not _alike(systems[0.0], systems[share]):
                return None
            guess = found.numbers(share)
            for name, values in exact.items():
                if name in varying:
                    size = np.maximum(sizes[name], 1e-6 * sizes[name].max())
                    worst = max(worst, float((np.abs(guess[name] - values) / size).max()))
                elif not np.array_equal(values, rows[0][name]):
                    return None
        if worst <= _ROUNDING:
            return found
        degree *= 2
    return None


def _points(degree: int) -> np.ndarray:
    """Chebyshev points from 0 to 1; those of half the degree are among them to the last bit."""
    all_points = 0.5 - 0.5 * np.cos(np.pi * np.arange(_MOST + 1) / _MOST)
    all_points[-1] = 1.0
    return all_points[:: _MOST // degree]


def _alike(first: LocalSystem, other: LocalSystem) -> bool:
    """Whether two systems differ in numbers alone."""
    for A, B in ((getattr(first, name), getattr(other, name)) for name in _MATRICES):
        if A is None or B is None:
            if A is not B:
                return False
        elif not (np.array_equal(A.indices, B.indices) and np.array_equal(A.indptr, B.indptr)):
            return False
    a = first.forces
    b = other.forces
    same = np.array_equal(a.kind, b.kind) and np.array_equal(a.parameters_first, b.parameters_first)
    return same and a.forces == b.forces and first.rotation.speeds.shape == other.rotation.speeds.shape
