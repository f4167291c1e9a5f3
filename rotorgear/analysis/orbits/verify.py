"""Transients that start on an orbit: how far they leave it, and how fast a small deviation grows or dies out."""

from __future__ import annotations

import numpy as np

from rotorgear.analysis.orbits.family import Range, SystemFamily
from rotorgear.analysis.orbits.follow import AnyOrbits, Branch
from rotorgear.analysis.orbits.start import run_periods
from rotorgear.results.motion.orbits import OrbitVerification
from rotorgear.solvers.periodic.harmonic_orbits import HarmonicOrbits
from rotorgear.solvers.periodic.special import Certified

_PERIODS = 40
_STEPS = 2000
# Size of the deviation, over the peak to peak; between these sizes its growth is read.
_PUSH = 1e-7
_LARGEST = 1e-3
_LEAST_PERIODS = 4


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
    periods = _PERIODS * k
    exact = cycle.at.d[:, column]
    # Steps so that every instant of the orbit is the end of one.
    each = int(np.ceil(_STEPS * k / len(exact)))
    steps = each * len(exact) // k
    _, d = run_periods(system, family.order, periods, q, v, steps)
    push = plant.still.X @ np.ones(plant.m)
    moved = float(np.abs((plant.B.T @ push)[column]).max(initial=0.0)) or 1.0
    _, other = run_periods(system, family.order, periods, q + push * (_PUSH * size / moved), v, steps)
    per = steps * k
    # Records stand at the ends of steps: the first period is rows 0 to per - 1.
    start = (plant.B.T @ q)[column]
    after_one = d[:per][:, column]
    orbit = np.vstack([after_one[-1:], after_one[:-1]])
    deviation = float(np.abs(orbit[::each][1:] - exact[1:]).max() / size)
    deviation = max(deviation, float(np.abs(after_one[-1] - start).max() / size))
    away = np.linalg.norm((other - d)[:, column].reshape(_PERIODS, per, -1), axis=(1, 2)) / np.sqrt(per) / size
    left = np.abs(d[:, column].reshape(_PERIODS, per, -1) - after_one).max(axis=(1, 2)) / size
    sound = np.flatnonzero((away < _LARGEST) & (away > 1e-3 * _PUSH) & (left < 1e-2))
    sound = sound[sound == np.arange(sound.size)]  # up to the first that is not
    late = sound[len(sound) // 2 :]
    growth = float("nan")
    if late.size >= _LEAST_PERIODS:
        growth = float(np.exp(np.polyfit(late, np.log(away[late]), 1)[0]))
    return OrbitVerification(
        along.at(node.p), one.stable, deviation, growth, float(np.abs(one.multipliers[0])), periods
    )


def state_on(orbits: AnyOrbits, y: np.ndarray, p: float) -> tuple[np.ndarray, np.ndarray]:
    """Displacements and velocities (n,) of a motion at the begin of its period."""
    if isinstance(orbits, HarmonicOrbits):
        return orbits.state(y, p)
    return orbits.motion(y, p)
