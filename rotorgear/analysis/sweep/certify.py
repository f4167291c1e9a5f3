"""Whether the response type of a run is settled: its section and its exponents agree, and nothing changes any more.

    kT              the largest exponent is below zero by more than its error; or the section repeats to 1e-4 and the exponent is
                    not above zero, by more than its error where the step can't hide its sign; for k > 1 the range of the section
                    stays what it is from its first half to its second, so that it is no shorter period to which a spiral still
                    comes down
    quasi-periodic  the largest exponent is zero within its error, one standard error away from chaos, and the range of the
                    section stays what it was a round before: where flanks part, exponents are too rough to see a slow decay
    chaotic         it is above that bound by a standard error

A kT whose orbit Newton's method finds is judged by the multipliers of that orbit instead, by its period, and by how far the run
is from it (multipliers.py); one that is unstable is run on from a small deviation in the direction that grows most, and one that
is still on its way to a stable orbit from that orbit. Where no orbit is found, exp(L N) after N periods, times the distance of
the start, is what is left of that: a kT is settled once it is less than 2.5e-3 of the motion, and it is a part of the errors.
Where the map is linear the orbit is known from anywhere, whatever the section looks like: a slow decay is no second frequency.

A run that is not settled runs on from its end, in rounds of twice the length each. One that is not after the last round either
is "not settled".

Indicators of the contacts over the periods that a run of a sweep counts.
"""

from __future__ import annotations

import numpy as np

from rotorgear.analysis.sweep.classify import (
    CHAOTIC,
    LEAST_MOTION,
    QUASI_PERIODIC,
    SAME_RANGE,
    classify,
    exponents,
    period_in,
    period_of,
)
from rotorgear.analysis.sweep.multipliers import ARRIVED, SURE
from rotorgear.analysis.sweep.point import Point
from rotorgear.analysis.sweep.request import Request
from rotorgear.solvers.batch.run_block import Orbit, Start
from rotorgear.solvers.time.statistics import STATISTICS, MotionStatistics, Statistics

# Statistics of a contact whose errors a sweep states: `STATISTICS`, and the penetration of the flanks, peak to peak.
STATED = (*STATISTICS, "penetration")
# What moves by less than this share of its size does not move.
_STILL = 1e-6
# Exponents per period of the fastest mesh that count as zero whatever their error.
_ZERO = 2e-4
_CHANGE = 0.02
# Share of the tolerance within which a section repeats that is not on its way to anything else.
_REPEATS = 5e-3
# Longest periods whose multipliers are asked for, and most degrees of freedom: their cost grows with both.
_LONGEST = 4
_MOST = 80
# Share of the motion that may be left of a start.
DECAYED = 2.5e-3
# A motion beyond this many times the static deflection, the backlash or the smallest displacement that counts has no bounds.
_FAR = 1e4
_SMALLEST = 1e-6  # m


def judged(orbit: Orbit, point: Point, request: Request) -> tuple[str, bool]:
    """The response type of a run, and whether it is settled."""
    counted = point.system.columns.counted
    x = orbit.section[:, counted, 0]
    extent = sizes_of(orbit, counted)
    if not orbit.growth.shape[1]:
        kind = classify(x, extent, None, 0.0, request.tolerance, request.chaos)
        return kind, not np.isfinite(orbit.multiplier) or _certified(orbit, period_in(kind))
    means, errors = exponents(orbit.growth, float(point.system.turns))
    largest = float(means[0])
    # The statistical error vanishes on a periodic orbit; that of the steps does not.
    error = float(np.hypot(np.nan_to_num(errors[0]), orbit.doubt[0]))
    kind = classify(x, extent, largest, error, request.tolerance, request.chaos)
    period = period_in(kind)
    bound = max(2.0 * error, _ZERO)
    if period and np.isfinite(orbit.multiplier):
        return kind, _certified(orbit, period) and (period == 1 or _stays(x))
    if period:
        # On an orbit that repeats, growth differs between batches only because tangents turn: that says little on its mean. What
        # repeats need not prove its sign then. But where flanks part, an unstable orbit may repeat for thousands of periods, and
        # the step hides the sign: an exponent above zero proves nothing there.
        exact = period_of(x, extent, _REPEATS * request.tolerance) == period
        most = bound if orbit.doubt[0] <= _ZERO else 0.0
        decayed = largest < -bound and not orbit.away > DECAYED
        stable = decayed or (exact and largest <= most)
        return kind, stable and (period == 1 or _stays(x))
    if kind == QUASI_PERIODIC:
        decays = orbit.multiplier < SURE or not (
            np.any(np.isnan(orbit.before)) or _same(orbit.before, np.ptp(x, axis=0), SAME_RANGE)
        )
        return kind, not decays and abs(largest) <= bound and abs(largest) + error <= request.chaos
    return kind, kind == CHAOTIC and largest - error > request.chaos


def _certified(orbit: Orbit, period: int) -> bool:
    """Whether a run is on a stable orbit of that period."""
    return orbit.multiplier < SURE and orbit.repeats == period and not orbit.away > ARRIVED


def to_certify(orbit: Orbit, point: Point, request: Request) -> tuple[int, bool]:
    """Common periods of the map whose orbit is to tell about a run, 0 for none; whether one near by is that of the run.

    What comes back fast needs none: growth that an exponent does not see in that many periods is slower than the bound of chaos,
    and nothing is left of the start. What does not repeat may be on its way to an orbit of one period.
    Cages do not repeat with the common period, and so a system with rolling elements has no such map.
    """
    system = point.system
    if system.n > _MOST or point.rolling:
        return 0, False
    period = period_in(judged(orbit, point, request)[0])
    if orbit.growth.shape[1]:
        means, _ = exponents(orbit.growth, float(system.turns))
        if means[0] > request.chaos or (means[0] <= -request.chaos and not orbit.away > ARRIVED):
            return 0, False
    return (period, True) if 0 < period <= _LONGEST else (1, False)


def left_of(orbit: Orbit, start: Start, point: Point) -> float:
    """What is left of a start as counting begins, over the size of the motion, by the largest exponent; nan without one."""
    if not orbit.growth.shape[1]:
        return float("nan")
    system = point.system
    z = start.z - orbit.end.z
    dz = start.dz - orbit.end.dz
    off = [u - system.rigid.T @ (system.rigid @ u) for u in (z, dz)]
    size = sizes_of(orbit, system.columns.counted).max() / np.linalg.norm(system.B, axis=0).max()
    decay = float(orbit.growth[:, 0].mean()) * orbit.settled
    return float(np.linalg.norm(off) / size * np.exp(min(decay, 1.0)))


def needed(orbit: Orbit) -> float:
    """Common periods after which nothing is left of a start that decays; nan where it does not, or where that is not known."""
    rate = orbit.multiplier
    if not np.isfinite(rate) and orbit.growth.shape[1]:
        rate = float(orbit.growth[:, 0].mean())
    return (
        orbit.settled + float(np.log(orbit.away / DECAYED)) / -rate
        if rate < 0.0 and orbit.away > DECAYED
        else float("nan")
    )


def _stays(x: np.ndarray) -> bool:
    """Whether a section (p, c) covers the same range in its second half as in its first."""
    half = len(x) // 2
    return _same(np.ptp(x[:half], axis=0), np.ptp(x[half:], axis=0), _CHANGE)


def _same(first: np.ndarray, second: np.ndarray, share: float) -> bool:
    """Whether ranges differ by at most a share of the larger one."""
    return bool(np.all(np.abs(first - second) <= share * np.maximum(first, second)))


def to_go_on(orbit: Orbit, point: Point, request: Request) -> bool:
    """Whether a run goes on for another round: one that is not settled, and one with two frequencies for a second look."""
    kind, stands = judged(orbit, point, request)
    return bounded(orbit, point) and not (stands and (kind != QUASI_PERIODIC or not np.any(np.isnan(orbit.before))))


def bounded(orbit: Orbit, point: Point) -> bool:
    """Whether a run stays within the sizes that its motions can have."""
    if not orbit.finite:
        return False
    columns = point.system.columns
    backlash = columns.clearance[columns.counted & np.isfinite(columns.clearance)]
    static = np.abs(point.static_force / point.stiffness).max(initial=0.0)
    size = max(static, backlash.max(initial=0.0), _SMALLEST)
    return not np.any(np.abs(orbit.section[:, columns.counted, 0]) > _FAR * size)


def sizes_of(orbit: Orbit, counted: np.ndarray) -> np.ndarray:
    """Peak to peak in m of the displacements `counted` (m,), with or without transmission error, whichever is larger, (c,).

    No smaller than the least that counts."""
    from rotorgear.solvers.batch import kernel_parts as k

    sums = orbit.sums[counted].T
    return np.maximum(np.maximum(sums[k.D_MAX] - sums[k.D_MIN], sums[k.X_MAX] - sums[k.X_MIN]), LEAST_MOTION)


def indicators(orbit: Orbit, counted: np.ndarray, steps: int) -> dict[str, np.ndarray]:
    """Indicators of the contacts, which are the local displacements `counted` (m,); watched are two displacements of each."""
    from rotorgear.solvers.batch import kernel_parts as k

    sums = orbit.sums[counted].T
    total = np.maximum(sums[[k.FRONT, k.APART, k.BACK]].sum(axis=0), 1.0)
    d = Statistics.of_sums(total, sums[k.D_SUM], sums[k.D_SQUARES], sums[k.D_MIN], sums[k.D_MAX])
    displacement = d.largest - d.least
    motion = motion_statistics(orbit, counted)
    approach = np.ptp(motion.approach, axis=1)
    return {
        "peak_to_peak": sums[k.X_MAX] - sums[k.X_MIN],
        "peak_to_peak_transmission_error": np.ptp(motion.transmission_error, axis=1),
        "peak_to_peak_approach": approach,
        "rms_approach": d.rms * (approach / np.where(displacement > 0.0, displacement, 1.0)),
        "mean_force": motion.force.mean,
        "rms_force": motion.force.rms,
        "largest_force": motion.force.largest,
        "driving": motion.shares[:, 0],
        "apart": motion.shares[:, 1],
        "back": motion.shares[:, 2],
        "losses": sums[k.LOSSES] / total * steps,
    }


def judged_statistics(orbit: Orbit, counted: np.ndarray) -> np.ndarray:
    """Values of `STATED` of each contact, their sizes, and what counting by steps leaves of them, (3, c, 9)."""
    from rotorgear.solvers.batch import kernel_parts as k

    motion = motion_statistics(orbit, counted)
    sums = orbit.sums[counted].T
    ends = np.abs(sums[[k.X_MIN, k.X_MAX]])
    moved = sums[k.X_MAX] - sums[k.X_MIN]
    penetration = (moved, np.where(moved > _STILL * ends.max(axis=0), moved, ends.max(axis=0)), np.zeros(moved.size))
    of_motion = (motion.values, motion.scales, motion.counted)
    return np.array([np.column_stack(both) for both in zip(of_motion, penetration, strict=True)])


def motion_statistics(orbit: Orbit, counted: np.ndarray) -> MotionStatistics:
    """Statistics of the contacts, as every analysis of motions tells them."""
    from rotorgear.solvers.batch import kernel_parts as k

    sums = orbit.sums[counted].T
    sides = sums[[k.FRONT, k.APART, k.BACK]]
    total = np.maximum(sides.sum(axis=0), 1.0)
    transmission_error, approach = np.split(orbit.extremes, 2)
    return MotionStatistics(
        Statistics.of_sums(total, sums[k.F_SUM], sums[k.F_SQUARES], sums[k.F_MIN], sums[k.F_MAX]),
        (sides / total).T,
        transmission_error,
        approach,
        sums[k.LOSSES] / total,
    )
