"""Whether a run of a sweep may stand: its response type and its exponents agree, and nothing still changes.

    kT              the largest exponent is below zero by more than its error; or the section repeats to 1e-4 and the exponent is
                    not above zero, by more than its error where the step can't hide its sign; for k > 1 the range of the section
                    stays what it is from its first half to its second, so that it is no shorter period to which a spiral still
                    comes down
    quasi-periodic  the largest exponent is zero within its error, and one standard error away from chaos
    chaotic         it is above that bound by a standard error

A kT whose orbit Newton's method finds stands or falls with the multipliers of that orbit instead, and with the period of that
orbit (multipliers.py); one that is unstable goes on from a small deviation in the direction that grows most.

What does not stand settles longer, in rounds of twice the length each, from where it got to. What still does not after the last
of them is "not settled".
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rotorgear.analysis.sweep.classify import CHAOTIC, QUASI_PERIODIC, Motion, classify, exponents, period_of
from rotorgear.analysis.sweep.indicators import indicators
from rotorgear.analysis.sweep.multipliers import SURE
from rotorgear.analysis.sweep.point import Point
from rotorgear.solvers.lanes.lanes import Orbit

# Exponents per period of the fastest mesh that count as zero whatever their error.
_ZERO = 2e-4
_CHANGE = 0.02
# Share of the tolerance within which a section repeats that is not on its way to anything else.
_REPEATS = 5e-3
# Longest periods whose multipliers are asked for, and most degrees of freedom: their cost grows with both.
_LONGEST = 4
_MOST = 40
# Sizes of a motion beyond which it counts as one without bounds.
_FAR = 1e4


@dataclass(frozen=True)
class Judge:
    """How responses are told apart (see classify.py), and how many rounds of settling a run gets at most."""

    tolerance: float
    chaos: float
    rounds: int = 4


def judged(orbit: Orbit, point: Point, steps: int, judge: Judge) -> tuple[Motion, bool]:
    """The response type of a run, and whether it stands."""
    counted = point.system.columns.counted
    x = orbit.section[:, counted, 0]
    measures = indicators(orbit, counted, steps)
    extent = np.maximum(measures["displacement"], measures["peak_to_peak"])
    if not orbit.growth.shape[1]:
        return classify(x, extent, None, 0.0, judge.tolerance, judge.chaos), True
    means, errors = exponents(orbit.growth, float(point.system.turns))
    largest = float(means[0])
    # The statistical error vanishes on a periodic orbit; that of the steps does not.
    error = float(np.hypot(np.nan_to_num(errors[0]), orbit.doubt[0]))
    motion = classify(x, extent, largest, error, judge.tolerance, judge.chaos)
    bound = max(2.0 * error, _ZERO)
    if motion.period and np.isfinite(orbit.multiplier):
        return motion, orbit.multiplier < SURE and orbit.repeats == motion.period and (motion.period == 1 or _stays(x))
    if motion.period:
        # On an orbit that repeats, growth differs between batches only because tangents turn: that says little on its mean. What
        # repeats need not prove its sign then. But where flanks part, an unstable orbit may repeat for thousands of periods, and
        # the step hides the sign: an exponent above zero proves nothing there.
        exact = period_of(x, extent, _REPEATS * judge.tolerance) == motion.period
        most = bound if orbit.doubt[0] <= _ZERO else 0.0
        stable = largest < -bound or (exact and largest <= most)
        return motion, stable and (motion.period == 1 or _stays(x))
    if motion.kind == QUASI_PERIODIC:
        return motion, abs(largest) <= bound and abs(largest) + error <= judge.chaos
    return motion, motion.kind == CHAOTIC and largest - error > judge.chaos


def to_certify(orbit: Orbit, point: Point, steps: int, judge: Judge) -> tuple[int, np.ndarray]:
    """Common periods after which a run repeats, where multipliers are to tell whether it is stable, else 0; and its sizes.

    The sizes are those of its counted displacements (c,) in m, peak to peak.

    What comes back fast needs none: growth that an exponent does not see in so many periods is slower than the bound of chaos.
    Cages do not repeat with the common period, and so a system with rolling elements has no such map.
    """
    system = point.system
    if not orbit.growth.shape[1] or system.n > _MOST or point.rolling:
        return 0, np.zeros(0)
    motion, _ = judged(orbit, point, steps, judge)
    means, _ = exponents(orbit.growth, float(system.turns))
    if not 0 < motion.period <= _LONGEST or not -judge.chaos < means[0] <= judge.chaos:
        return 0, np.zeros(0)
    measures = indicators(orbit, system.columns.counted, steps)
    return motion.period, np.maximum(measures["displacement"], measures["peak_to_peak"])


def _stays(x: np.ndarray) -> bool:
    """Whether a section (p, c) covers the same range in its second half as in its first."""
    half = len(x) // 2
    first = np.ptp(x[:half], axis=0)
    second = np.ptp(x[half:], axis=0)
    return bool(np.all(np.abs(first - second) <= _CHANGE * np.maximum(first, second)))


def bounded(orbit: Orbit, point: Point) -> bool:
    """Whether a run stays within the sizes that its motions can have."""
    return orbit.finite and not np.any(np.abs(orbit.section[:, point.system.columns.counted, 0]) > _FAR * _size(point))


def _size(point: Point) -> float:
    """Displacement in m that motions are measured by: static deflection, backlash, and the smallest that counts."""
    columns = point.system.columns
    backlash = columns.clearance[columns.counted & np.isfinite(columns.clearance)]
    return float(max(np.abs(point.static_force / point.stiffness).max(initial=0.0), backlash.max(initial=0.0), 1e-6))
