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

_BISECTIONS = 40
# Distance from a switch, as a share of the spacing, at which both sides are looked at.
_BESIDE = 1e-6
_ROUNDING = 1e-9
# More switches than these say that a law chatters: then the sum stays as it is.
_MOST = 400


@dataclass(frozen=True)
class Switches:
    """e switches: phase w t of each (e,), theta in its cell, spacing of the instants in phase, and jumps.

    `force` and `rate`: of -F and of its rate over phase, (e, m). `in_d`, `in_v`: of -Kd and -Kv, (e, blocks), and of their rates.
    """

    phase: np.ndarray
    theta: np.ndarray
    spacing: float
    force: np.ndarray
    rate: np.ndarray
    in_d: np.ndarray
    in_v: np.ndarray
    rate_in_d: np.ndarray
    rate_in_v: np.ndarray

    def of_forces(self, harmonics: int) -> np.ndarray:
        """What the mean of u e^{-i h w t} over the instants has too much, (H + 1, m)."""
        return self._too_much(np.arange(harmonics + 1), self.force, self.rate)

    def of_tangents(self, harmonics: int) -> tuple[np.ndarray, np.ndarray]:
        """The same for tangents in d and v, for h from -H to H, (2 H + 1, blocks) each."""
        h = np.arange(-harmonics, harmonics + 1)
        return self._too_much(h, self.in_d, self.rate_in_d), self._too_much(h, self.in_v, self.rate_in_v)

    def _too_much(self, h: np.ndarray, jump: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """Error of the mean of g e^{-i h p}, (len(h), k), of jumps of g and of its rate over phase (e, k)."""
        if not self.phase.size:
            return np.zeros((h.size, jump.shape[1]), complex)
        s = self.spacing
        turned = np.exp(-1j * np.outer(h, self.phase))
        first = (self.theta - 0.5)[:, None]
        second = (self.theta**2 - self.theta + 1.0 / 6.0)[:, None]
        # The rate of g e^{-i h p} jumps by [g'] - i h [g].
        bent = turned @ (second * rate) - 1j * h[:, None] * (turned @ (second * jump))
        return np.asarray((s * (turned @ (first * jump)) - 0.5 * s * s * bent) / (2.0 * np.pi))


def switches_of(c: np.ndarray, now: Samples, plant: Plant, w: float) -> Switches:
    """Find where laws come from one smooth piece to another between the instants of a motion with coefficients c (H + 1, m)."""
    from rotorgear.solvers.periodic.kernel_instants import Harmonic, switches_in

    forces = plant.forces
    spacing = 2.0 * np.pi / len(now.t)
    m = forces.m
    blocks = now.Kd.shape[1]
    # Which smooth piece each law is on at the instants (r, l), told as `law_at` tells it, by the full damping (l,) of each.
    first = forces.block_first[:-1]
    damping = np.add.reduceat(now.Kv, first, axis=1)
    largest = damping.max(axis=0)
    full = np.where(largest > 0.0, (1.0 - _ROUNDING) * largest, np.inf)
    holds = np.add.reduceat((now.Kd != 0.0) | (now.Kv != 0.0), first, axis=1)
    piece = 4.0 * now.side + holds.astype(bool) + 2.0 * (damping >= full)
    cells, laws = np.nonzero(piece != np.roll(piece, -1, axis=0))
    if not cells.size or cells.size > _MOST:
        nothing = np.zeros((0, m))
        tangents = np.zeros((0, blocks))
        return Switches(np.zeros(0), np.zeros(0), spacing, nothing, nothing, tangents, tangents, tangents, tangents)
    motion = Harmonic(np.ascontiguousarray(c.real), np.ascontiguousarray(c.imag), w, plant.speed, spacing)
    cell, law, theta, F, Kd, Kv = switches_in(arguments_of(forces), motion, cells, laws, full, _BISECTIONS, _BESIDE)
    numbers = np.arange(len(forces.laws))
    own = np.repeat(numbers, np.diff(forces.first)) == law[:, None]
    own_block = np.repeat(numbers, np.diff(forces.block_first)) == law[:, None]
    step = _BESIDE * spacing
    force, rate = _jumps(F, own, step)
    in_d, rate_in_d = _jumps(Kd, own_block, step)
    in_v, rate_in_v = _jumps(Kv, own_block, step)
    return Switches((cell + theta) * spacing, theta, spacing, force, rate, in_d, in_v, rate_in_d, rate_in_v)


def _jumps(beside: np.ndarray, own: np.ndarray, step: float) -> tuple[np.ndarray, np.ndarray]:
    """Jumps of -g and of its rate (e, k) from g at -1, -2, 1 and 2 steps (4, e, k), of those entries that are a law's own."""
    before, earlier, after, later = beside
    jump = (2.0 * after - later) - (2.0 * before - earlier)
    rate = ((later - after) - (before - earlier)) / step
    return np.where(own, -jump, 0.0), np.where(own, -rate, 0.0)
