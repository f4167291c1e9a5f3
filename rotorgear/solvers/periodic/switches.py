"""Where laws change sides along a periodic motion, and what a sum over instants misses of the jumps there.

For g with jumps [g] and [g'] at theta of a cell, 0 < theta < 1, the sum over instants with spacing s errs by

    sum g - int g = s [g] B_1(theta) - s^2/2 [g'] B_2(theta) + O(s^3)

with the Bernoulli polynomials B_1 = theta - 1/2, B_2 = theta^2 - theta + 1/6 (Euler and Maclaurin).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rotorgear.solvers.periodic.plant import Plant
from rotorgear.solvers.periodic.samples import Samples, arguments_of
from rotorgear.solvers.time.arguments import Answer, Instants

_BISECTIONS = 40
# Distance from a switch, as a share of the spacing, at which both sides are looked at.
_BESIDE = 1e-6
# More switches than these say that a law chatters: then the sum stays as it is.
_MOST = 400


@dataclass(frozen=True)
class Switches:
    """e switches: phase w t of each (e,), theta in its cell, spacing of the instants in phase, and jumps.

    `force` and `rate`: of -F and of its rate over phase, (e, m). `in_d`, `in_v`: of -Kd and -Kv, (e, blocks).
    """

    phase: np.ndarray
    theta: np.ndarray
    spacing: float
    force: np.ndarray
    rate: np.ndarray
    in_d: np.ndarray
    in_v: np.ndarray

    def of_forces(self, harmonics: int, m: int) -> np.ndarray:
        """What the mean of u e^{-i h w t} over the instants has too much, (H + 1, m)."""
        if not self.phase.size:
            return np.zeros((harmonics + 1, m), complex)
        h = np.arange(harmonics + 1)
        first = self.theta - 0.5
        second = self.theta**2 - self.theta + 1.0 / 6.0
        turned = np.exp(-1j * np.outer(h, self.phase))
        # The rate of u e^{-i h p} jumps by [u'] - i h [u].
        slope = turned @ (second[:, None] * self.rate)
        value = turned @ (first[:, None] * self.force)
        bent = turned @ (second[:, None] * self.force)
        s = self.spacing
        return np.asarray((s * value - 0.5 * s * s * (slope - 1j * h[:, None] * bent)) / (2.0 * np.pi))

    def of_tangents(self, harmonics: int, flat: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The same for tangents in d and v, for h from -H to H, (2 H + 1, pairs) each; the leading term."""
        if not self.phase.size:
            nothing = np.zeros((2 * harmonics + 1, flat.size), complex)
            return nothing, nothing
        h = np.arange(-harmonics, harmonics + 1)
        turned = np.exp(-1j * np.outer(h, self.phase)) * (self.theta - 0.5) * self.spacing / (2.0 * np.pi)
        return turned @ self.in_d[:, flat], turned @ self.in_v[:, flat]


def switches_of(c: np.ndarray, now: Samples, plant: Plant, w: float) -> Switches:
    """Find where the laws change sides between the instants of a motion with coefficients c (H + 1, m) and frequency w."""
    from rotorgear.solvers.periodic.kernel_instants import switches_in

    forces = plant.forces
    N = len(now.t)
    spacing = 2.0 * np.pi / N
    side = now.side
    cells, laws = np.nonzero(side != np.roll(side, -1, axis=0))
    m = forces.m
    blocks = now.Kd.shape[1]
    if not cells.size or cells.size > _MOST:
        nothing = np.zeros((0, m))
        tangents = np.zeros((0, blocks))
        return Switches(np.zeros(0), np.zeros(0), spacing, nothing, nothing, tangents, tangents)
    e = cells.size
    theta = np.zeros(e)
    instants = Instants(np.zeros(0), np.zeros(0), np.zeros(0), np.zeros((4 * e, m)), np.zeros((4 * e, m)))
    answer = Answer(
        np.zeros((4 * e, m)), np.zeros((4 * e, blocks)), np.zeros((4 * e, blocks)), np.zeros((4 * e, side.shape[1] * 4))
    )
    switches_in(
        arguments_of(forces),
        np.ascontiguousarray(c.real),
        np.ascontiguousarray(c.imag),
        w,
        plant.speed,
        spacing,
        cells,
        laws,
        _BISECTIONS,
        _BESIDE,
        theta,
        instants,
        answer,
    )
    phase = (cells + theta) * spacing
    step = _BESIDE * spacing
    F_before, F_earlier, F_after, F_later = answer.F.reshape(4, e, m)
    Kd_before, _, Kd_after, _ = answer.Kd.reshape(4, e, blocks)
    Kv_before, _, Kv_after, _ = answer.Kv.reshape(4, e, blocks)
    own = np.zeros((cells.size, m), bool)
    own_block = np.zeros((cells.size, blocks), bool)
    for i in range(len(forces.laws)):
        own[laws == i, forces.first[i] : forces.first[i + 1]] = True
        own_block[laws == i, forces.block_first[i] : forces.block_first[i + 1]] = True
    rate = ((F_later - F_after) - (F_before - F_earlier)) / step
    jump = (2.0 * F_after - F_later) - (2.0 * F_before - F_earlier)
    return Switches(
        phase,
        theta,
        spacing,
        np.where(own, -jump, 0.0),
        np.where(own, -rate, 0.0),
        np.where(own_block, Kd_before - Kd_after, 0.0),
        np.where(own_block, Kv_before - Kv_after, 0.0),
    )
