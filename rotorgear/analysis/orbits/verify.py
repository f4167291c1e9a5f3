"""Transients that start on an orbit: how far they leave it, and how fast a small deviation grows or dies out.

A transient on an unstable orbit is soon too far from it to tell its multipliers. So each period starts on the orbit again, with
the deviation that the last one ended with, made small: the power method on the transient's own map over a period.
"""

from __future__ import annotations

import numpy as np

from rotorgear.analysis.orbits.family import Range, SystemFamily
from rotorgear.analysis.orbits.follow import AnyOrbits, Branch
from rotorgear.analysis.orbits.start import run_periods
from rotorgear.results.orbits import OrbitVerification
from rotorgear.solvers.periodic.harmonic_orbits import HarmonicOrbits
from rotorgear.solvers.periodic.plant import Plant
from rotorgear.solvers.periodic.special import Certified

_PERIODS = 36
_STEPS = 4000
# Size of the deviation at the begin of each period, over the peak to peak: contacts then close a step earlier or later.
_PUSH = 1e-4
# Of so many last periods the growth is told: the other multipliers have died out there.
_TOLD = 18
_OTHERS = 3e-3


def verified(
    branches: list[Branch], family: SystemFamily, column: np.ndarray, along: Range
) -> tuple[OrbitVerification, ...]:
    """Start transients on a motion of each stretch of the branches, in its middle; `column`: displacements that are compared."""
    return tuple(_verified(branch, one, family, column, along) for branch in branches for one in _middles(branch))


def _middles(branch: Branch) -> list[Certified]:
    """One motion of each stretch of one stability, the first six."""
    stretches: list[list[Certified]] = []
    for one in branch.nodes:
        if not stretches or stretches[-1][-1].stable != one.stable:
            stretches.append([])
        stretches[-1].append(one)
    return [stretch[len(stretch) // 2] for stretch in stretches][:6]


def _verified(
    branch: Branch, one: Certified, family: SystemFamily, column: np.ndarray, along: Range
) -> OrbitVerification:
    orbits = branch.orbits
    node = one.node
    system = family.system(family.shares_at(node.p))
    plant = family.plant(*family.shares_at(node.p))
    q, v = state_on(orbits, node.y, node.p)
    cycle = orbits.cycle(node.y, node.p)
    ends = cycle.extremes()
    size = float(np.ptp(ends[column], axis=1).max(initial=0.0)) or 1.0
    k = branch.periods
    exact = cycle.at.d[:, column]
    # Steps so that every instant of the orbit is the end of one.
    each = int(np.ceil(_STEPS * k / len(exact)))
    steps = each * len(exact) // k

    def period_from(q: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        state, d = run_periods(system, family.order, k, q, v, steps)
        return state.q, state.v, d[:, column]

    end_q, end_v, after_one = period_from(q, v)
    # Records stand at the ends of steps: the period is rows 0 to the last.
    orbit = np.vstack([after_one[-1:], after_one[:-1]])
    deviation = float(np.abs(orbit[::each][1:] - exact[1:]).max() / size)
    deviation = max(deviation, float(np.abs(after_one[-1] - (plant.B.T @ q)[column]).max() / size))
    push = plant.still.X @ np.ones(plant.m)
    moved = float(np.abs((plant.B.T @ push)[column]).max(initial=0.0)) or 1.0
    dq = push * (_PUSH * size / moved)
    dv = np.zeros(q.size)
    waves: list[np.ndarray] = []
    shares: list[float] = []
    for _ in range(_PERIODS):
        other_q, other_v, other = period_from(q + dq, v + dv)
        waves.append((other - after_one).ravel())
        away = float(np.abs(waves[-1]).max()) / size
        if not 0.0 < away < np.inf:
            break
        shares.append(_PUSH / away)
        # Motions without strain neither grow nor move the contacts.
        dq = shares[-1] * _strained(plant, other_q - end_q)
        dv = shares[-1] * _strained(plant, other_v - end_v)
    return OrbitVerification(
        along.at(node.p), one.stable, deviation, _growth(waves, shares), float(np.abs(one.multipliers[0])), _PERIODS * k
    )


def _growth(waves: list[np.ndarray], shares: list[float]) -> float:
    """Modulus of the multipliers that deviations (r,) of one period after the other show; each begins as a share of the last end.

    Where one pair outlasts all others, A^2 w = a A w + b w for all deviations w: a real multiplier or both of a complex pair are
    roots of x^2 = a x + b.
    """
    last = range(max(len(shares) - _TOLD, 0), len(shares) - 2)
    if not last:
        return float("nan")
    here, once, twice = (
        np.concatenate([waves[j + ahead] / np.prod(shares[j : j + ahead]) / np.abs(waves[j]).max() for j in last])
        for ahead in range(3)
    )
    # What is left of other multipliers, and of powers of the deviation, is no second direction.
    a, b = np.linalg.lstsq(np.column_stack([once, here]), twice, rcond=_OTHERS)[0]
    return float(np.abs(np.roots([1.0, -a, -b])).max())


def _strained(plant: Plant, q: np.ndarray) -> np.ndarray:
    """Displacements or velocities (n,) without their part in motions that strain nothing."""
    return np.asarray(q - plant.free @ (plant.free.T @ (plant.M @ q)))


def state_on(orbits: AnyOrbits, y: np.ndarray, p: float) -> tuple[np.ndarray, np.ndarray]:
    """Displacements and velocities (n,) of a motion at the begin of its period."""
    if isinstance(orbits, HarmonicOrbits):
        return orbits.state(y, p)
    return orbits.motion(y, p)
