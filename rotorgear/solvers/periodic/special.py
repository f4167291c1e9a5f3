"""Special points of a branch of periodic motions: fold, period doubling and Neimark-Sacker point, told and located.

Between two solutions a test function changes its sign: at a fold the parameter's part of the tangent; at a period doubling
prod (1 + mu), the determinant of the monodromy matrix plus one; at a Neimark-Sacker point |mu| - 1 of the complex pair. The root
is bracketed along the chord (Brent), each time on the branch itself. Seydel (2010), ch. 5 and 7.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Protocol

import numpy as np
from scipy.optimize import brentq

from rotorgear.errors import ConvergenceError
from rotorgear.solvers.periodic.arclength import Equations, Node, corrected

FOLD = "fold"
DOUBLING = "period doubling"
NEIMARK_SACKER = "Neimark-Sacker"
# Root of the test function along the chord, as a share of it.
_TOLERANCE = 1e-8
_EVALUATIONS = 60
# What is left of the test function at its root, as a share of its values at both ends.
_JUMP = 0.01
_REAL = 1e-9
# Multipliers nearer to zero are rounding.
_NOTHING = 1e-6


class Orbits(Equations, Protocol):
    """Equations of periodic motions that know their multipliers."""

    def multipliers(self, y: np.ndarray, p: float) -> np.ndarray:
        """Floquet multipliers of a solution."""


@dataclass(frozen=True)
class Certified:
    """A solution with its multipliers."""

    node: Node
    multipliers: np.ndarray

    @property
    def stable(self) -> bool:
        """Whether small deviations die out."""
        return bool(np.all(np.abs(self.multipliers) <= 1.0 + 1e-9))


@dataclass(frozen=True)
class Special:
    """A special point: what it is, the solution there, and the node of the branch behind which it lies."""

    kind: str
    at: Certified
    after: int


def kinds_between(a: Certified, b: Certified) -> list[str]:
    """Kinds of special points between two neighbours of a branch."""
    found = []
    left = _outside(b.multipliers) - _outside(a.multipliers)
    if a.node.tangent[-1] * b.node.tangent[-1] < 0.0:
        found.append(FOLD)
        left -= int(np.sign(left))
    if _doubling(a.multipliers) * _doubling(b.multipliers) < 0.0:
        found.append(DOUBLING)
        left -= int(np.sign(left))
    if abs(left) >= 2 and any(_pair(one.multipliers).size for one in (a, b)):
        found.append(NEIMARK_SACKER)
    return found


def located(orbits: Orbits, a: Certified, b: Certified, kind: str) -> Certified | None:
    """The special point of a kind between two neighbours.

    Returns:
        The point; None where its test function does not cross zero, or the branch can't be solved there.
    """
    chord = b.node.z - a.node.z
    length = float(np.linalg.norm(chord))
    normal = chord / length

    @cache
    def node_at(share: float) -> Node:
        if share in (0.0, 1.0):
            return b.node if share else a.node
        return corrected(orbits, a.node.z + share * chord, normal, normal)

    @cache
    def certified(share: float) -> Certified:
        if share in (0.0, 1.0):
            return b if share else a
        node = node_at(share)
        return Certified(node, orbits.multipliers(node.y, node.p))

    def test(share: float) -> float:
        if kind == FOLD:
            # Multipliers cost more than all else, and a fold does not ask for them.
            tangent = node_at(share).tangent
            return float(tangent[-1] * np.sign(tangent @ normal))
        multipliers = certified(share).multipliers
        if kind == DOUBLING:
            return _doubling(multipliers)
        # How far the complex pair nearest to the circle lies outside it.
        sizes = np.abs(_pair(multipliers)) - 1.0
        return float(sizes[np.argmax(sizes)]) if sizes.size else -1.0

    ends = (test(0.0), test(1.0))
    if not ends[0] * ends[1] < 0.0:
        return None
    try:
        root = float(brentq(test, 0.0, 1.0, xtol=_TOLERANCE, maxiter=_EVALUATIONS, disp=False))
        left = abs(test(root))
    except ConvergenceError:
        return None
    # Where a pair comes into being outside the circle, none has crossed it.
    if kind == NEIMARK_SACKER and left > _JUMP * max(abs(one) for one in ends):
        return None
    return certified(root)


def _outside(multipliers: np.ndarray) -> int:
    return int(np.sum(np.abs(multipliers) > 1.0))


def _doubling(multipliers: np.ndarray) -> float:
    """prod (1 + mu) with its sign; those near zero left out."""
    mu = multipliers[np.abs(multipliers) > _NOTHING]
    return float(np.real(np.prod(1.0 + mu)))


def _pair(multipliers: np.ndarray) -> np.ndarray:
    mu = multipliers[np.abs(multipliers) > 0.5]
    return np.asarray(mu[np.abs(mu.imag) > _REAL])
