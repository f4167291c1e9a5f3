"""Follows the modes of one independent group of dofs over speed, halving a step where it leaves a doubt.

The modes are those of `SpeedModes.at`; a step is judged by `solvers.tracking`.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from rotorgear.solvers.eigen.reduced_pencil import Eigen
from rotorgear.solvers.eigen.tracking import Step, step

# A veering narrower than this share of the speed range is drawn as a crossing.
NARROWEST = 2.0**-16
# A mode that ends (it stops to oscillate) is looked for down to this share.
_END = 2.0**-10


@dataclass
class Track:
    """Chains of modes: `number` (speeds, chains) place of each chain's mode at a speed, -1 where it doesn't oscillate.

    `halvings` counts the speeds that were put between; `unsure` lists speeds in rad/s at which two modes stayed hard to tell.
    """

    number: np.ndarray
    halvings: int = 0
    unsure: list[float] = field(default_factory=list)


def track(modes: Callable[[float], Eigen], speeds: np.ndarray, watched: int) -> Track:
    """Chain the modes at ascending speeds (k,) in rad/s.

    Args:
        modes: speed -> eigenpairs of the group.
        speeds: ascending; tables of bearings may have kinks at these speeds only.
        watched: the lowest so many modes at a speed must be followed without doubt.
    """
    walk = _Walk(modes, abs(speeds[-1] - speeds[0]), watched)
    first = modes(speeds[0])
    chains = [np.arange(len(first.s))]
    for a, b in itertools.pairwise(speeds):
        partner = walk.link(float(a), float(b))
        ends = chains[-1]
        here = np.where(ends >= 0, partner[np.maximum(ends, 0)], -1) if len(partner) else np.full(len(ends), -1)
        new = np.setdiff1d(np.arange(len(modes(b).s)), here)
        chains = [np.append(row, np.full(len(new), -1)) for row in chains]
        chains.append(np.append(here, new))
    return Track(np.array(chains), walk.halvings, walk.unsure)


@dataclass
class _Walk:
    modes: Callable[[float], Eigen]
    span: float
    watched: int
    halvings: int = 0
    unsure: list[float] = field(default_factory=list)

    def link(self, a: float, b: float) -> np.ndarray:
        """Partner at b of each mode at a (m_a,), over as many steps as it takes."""
        left = self.modes(a)
        right = self.modes(b)
        found = step(left, right, b - a, NARROWEST * self.span)
        width = abs(b - a)
        if not self._unclear(found, left, right, width):
            return found.partner
        if width <= NARROWEST * self.span:
            self.unsure.append(0.5 * (a + b))
            return found.partner
        self.halvings += 1
        middle = 0.5 * (a + b)
        first = self.link(a, middle)
        second = self.link(middle, b)
        return np.where(first >= 0, second[np.maximum(first, 0)], -1) if len(second) else np.full(len(first), -1)

    def _unclear(self, found: Step, left: Eigen, right: Eigen, width: float) -> bool:
        inner = np.arange(len(left.s)) < self.watched
        inner |= (found.partner >= 0) & (found.partner < self.watched)
        if np.any(found.doubt & inner & (found.partner >= 0)):
            return True
        taken = np.isin(np.arange(len(right.s)), found.partner)
        ended = np.any(inner & (found.partner < 0)) or not taken[: self.watched].all()
        return bool(ended and width > _END * self.span)
