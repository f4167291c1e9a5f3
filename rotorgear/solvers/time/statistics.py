"""Statistics of a motion, whoever found it: over the steps of a run, over the sums of many, or over a period.

    mean = 1/T int F dt,    rms^2 = 1/T int (F - mean)^2 dt,    loss = 1/T int [no side touches] dt

and the least and the largest value, whose difference is the peak to peak. Over a period the motion is cubic between instants
(Hermite, from values and rates); laws change sides at instants of their own, which are found, and integrals are Gauss's between
them, so that nothing depends on where the instants lie.

The error of each statistic is that of the statistic itself, relative to its own size: see `scales` and `compared`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from rotorgear.solvers.time.arguments import Gathered

# Statistics of a contact, in the order of `MotionStatistics.values`.
STATISTICS = (
    "mean force",
    "rms force",
    "largest force",
    "smallest force",
    "contact loss",
    "coast contact",
    "transmission error",
    "approach",
)
# What moves by less than this share of its size does not move: the contact forces of a step are found to 1e-10 of that.
_STILL = 1e-6
# Roache's margin, for where sides meet and part and impacts begin and end an order holds in the mean only.
# J. Fluids Eng. 116 (1994) 405.
_MARGIN = 1.25
# Which side touches is known at the ends of steps only: both switches of a flight are off by up to half a step, evenly, and its
# length by sqrt(1/12 + 1/12) of one.
_COUNTED = 6.0**-0.5
# Parts of an interval in which a side changes, and how often it is divided: to 3e-8 of the interval.
_PARTS = 32
_DIVISIONS = 5
# Highest peaks that are looked at closely, points about each, and how often they close in on it: to 1/500 of their distance.
_PEAKS = 4
_ABOUT = 17
_CLOSER = 3
# By how much smaller the steps are of the run that tells an error. Where errors have a part of chance, a run of half the step
# says less than .3 of them one time in 30, at 3 times the cost of the run alone; a third of it one time in 50, at 4 times.
FINER = 3
# Share of the difference to that run which is the error, of second order: impacts begin between steps in all methods.
OF_ERROR = 1.0 - FINER**-2.0
# Windows that a record is cut into where a motion never repeats, and is made anew from, drawn with replacement.
WINDOWS = 8
# Standard deviations that nineteen of twenty values lie within.
_NINETEEN = 1.96
# Gauss's points on 0 to 1, and their weights.
_GAUSS = 0.5 + 0.5 * np.sqrt(0.6) * np.array([-1.0, 0.0, 1.0])
_WEIGHTS = np.array([5.0, 8.0, 5.0]) / 18.0
# Forces (r, m) and sides of the laws (r, l) at times (r,), displacements and velocities (r, m).
Laws = Callable[[np.ndarray, np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]


@dataclass(frozen=True)
class Statistics:
    """Of g quantities: mean, root mean square about it, least and largest, (g,); NaN where nothing counts."""

    mean: np.ndarray
    rms: np.ndarray
    least: np.ndarray
    largest: np.ndarray

    @staticmethod
    def of_sums(
        count: Any, sums: np.ndarray, squares: np.ndarray, least: np.ndarray, largest: np.ndarray, level: Any = 0.0
    ) -> Statistics:
        """From sums (g,) of values about a level, and of their squares, over a count of steps."""
        about = sums / count
        rms = np.sqrt(np.maximum(squares / count - about**2, 0.0))
        return Statistics(level + about, rms, least, largest)

    @staticmethod
    def of_steps(gathered: Gathered) -> Statistics:
        """What the compiled loops of a run have summed up."""
        steps = int(gathered.steps[0])
        if not steps:
            nothing = np.full(gathered.level.size, np.nan)
            return Statistics(nothing, nothing, nothing, nothing)
        sums, squares, _ = gathered.sums.T
        least, largest = gathered.extremes.T
        return Statistics.of_sums(steps, sums, squares, least.copy(), largest.copy(), gathered.level)

    def about(self, constant: np.ndarray) -> Statistics:
        """Those of the quantities with constants (g,) added to them."""
        return Statistics(self.mean + constant, self.rms, self.least + constant, self.largest + constant)

    def chosen(self, which: np.ndarray | slice) -> Statistics:
        """Those of some quantities."""
        return Statistics(self.mean[which], self.rms[which], self.least[which], self.largest[which])


@dataclass(frozen=True)
class MotionStatistics:
    """Of c contacts: their forces, shares of the time in front, apart and behind (c, 3), transmission error and approach (c, 2).

    The last two are least and largest values in m, whose difference is the peak to peak. `losses`: contact losses for each
    step (c,), where shares are counted by steps; none where switches are found between them.
    """

    force: Statistics
    shares: np.ndarray
    transmission_error: np.ndarray
    approach: np.ndarray
    losses: np.ndarray | None = None

    @property
    def values(self) -> np.ndarray:
        """`STATISTICS` of each contact, (c, 8)."""
        force = self.force
        moved = [np.ptp(ends, axis=1) for ends in (self.transmission_error, self.approach)]
        shares = self.shares[:, 1:].T
        return np.column_stack([force.mean, force.rms, force.largest, force.least, *shares, *moved])

    @property
    def scales(self) -> np.ndarray:
        """The size of each statistic, (c, 8), that its error is taken relative to.

        A root mean square and a peak to peak are as large as they are, however large the mean beside them. A mean or a least
        value may be zero: they count as no smaller than the force itself, sqrt(mean^2 + rms^2). Shares are of 1.
        """
        force = self.force
        size = np.sqrt(force.mean**2 + force.rms**2)
        # A largest force is as large as it is: of impacts that last a thousandth of a period, many times the root mean square.
        ends = [np.maximum(size, np.abs(end)) for end in (force.largest, force.least)]
        moved = [_own(np.ptp(x, axis=1), np.abs(x).max(axis=1)) for x in (self.transmission_error, self.approach)]
        whole = np.ones(size.size)
        return np.column_stack([size, _own(force.rms, size), *ends, whole, whole, *moved])

    @property
    def counted(self) -> np.ndarray:
        """What counting by steps leaves of each statistic, (c, 8): of shares of flights, and of visits between two of them."""
        found = np.zeros((len(self.shares), len(STATISTICS)))
        if self.losses is not None:
            found[:, STATISTICS.index("contact loss")] = _COUNTED * self.losses
            found[:, STATISTICS.index("coast contact")] = (
                np.where(self.shares[:, 2] > 0.0, 0.5, 0.0) * _COUNTED * self.losses
            )
        return found


def _own(moved: np.ndarray, size: np.ndarray) -> np.ndarray:
    """How far something moves (c,), or its size where it does not."""
    return np.where(moved > _STILL * size, moved, size)


def blank_gathered(values: np.ndarray) -> Gathered:
    """Statistics of nothing yet, of quantities with these values (g,) at the start."""
    size = values.size
    recent = np.ascontiguousarray(np.repeat(values[:, None], 3, axis=1), dtype=float)
    nothing = np.tile([np.inf, -np.inf], (size, 1))
    return Gathered(recent, np.zeros(size), np.zeros((size, 3)), nothing, np.zeros(1, dtype=np.int64))


@dataclass(frozen=True)
class PeriodicCurve:
    """The cubics through values and rates (N, k) at equally spaced instants of a period T in s."""

    period: float
    value: np.ndarray
    rate: np.ndarray

    @cached_property
    def _cubic(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """x(s) = x + s (g + s (b + s a)) on 0 <= s <= 1 from one instant to the next, (N, k) each."""
        x = self.value
        g = self.period / len(x) * self.rate
        x1 = np.roll(x, -1, axis=0)
        g1 = np.roll(g, -1, axis=0)
        return x, g, 3.0 * (x1 - x) - (2.0 * g + g1), 2.0 * (x - x1) + (g + g1)

    def at(self, t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Values and rates (r, k) at times (r,)."""
        N = len(self.value)
        place = N / self.period * t
        cell = np.floor(place).astype(int)
        s = (place - cell)[:, None]
        x, g, b, a = (one[cell % N] for one in self._cubic)
        return x + s * (g + s * (b + s * a)), N / self.period * (g + s * (2.0 * b + 3.0 * s * a))

    def extremes(self) -> np.ndarray:
        """Least and largest values, (k, 2)."""
        x, g, b, a = self._cubic
        root = np.sqrt(np.maximum(b * b - 3.0 * a * g, 0.0))
        found = [x]
        for sign in (1.0, -1.0):
            q = -(b + sign * root)
            with np.errstate(divide="ignore", invalid="ignore"):
                for s in (q / (3.0 * a), g / np.where(q == 0.0, np.nan, q)):
                    inside = (s > 0.0) & (s < 1.0)
                    s = np.where(inside, s, 0.0)
                    found.append(x + s * (g + s * (b + s * a)))
        stacked = np.concatenate(found)
        return np.column_stack([stacked.min(axis=0), stacked.max(axis=0)])


def over_period(curve: PeriodicCurve, laws: Laws) -> tuple[Statistics, np.ndarray]:
    """Statistics of the forces (m,) of a periodic motion d (m,), and shares (l, 3) of the time in front, apart, behind."""
    T = curve.period
    N = len(curve.value)
    instants = T / N * np.arange(N)

    def answer(t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return laws(t, *curve.at(t))

    F, side = answer(instants)
    if not F.size:
        nothing = np.zeros(0)
        return Statistics(nothing, nothing, nothing, nothing), np.zeros((0, 3))
    breaks = np.unique(np.concatenate([instants, _switches(answer, instants, T / N, side), [T]]))
    long = np.diff(breaks)
    t = (breaks[:-1, None] + long[:, None] * _GAUSS).ravel()
    weight = (long[:, None] / T * _WEIGHTS).ravel()
    between, side = answer(t)
    mean = weight @ between
    rms = np.sqrt(weight @ (between - mean) ** 2)
    order = np.argsort(np.concatenate([instants, t]))
    t = np.concatenate([instants, t])[order]
    F = np.concatenate([F, between])[order]
    ends = [sign * _largest(lambda at, sign=sign: sign * answer(at)[0], t, sign * F, T) for sign in (-1.0, 1.0)]  # type: ignore[misc]
    shares = np.column_stack([weight @ (side > 0.0), weight @ (side == 0.0), weight @ (side < 0.0)])
    return Statistics(mean, rms, *ends), shares


def _switches(
    answer: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]], instants: np.ndarray, h: float, side: np.ndarray
) -> np.ndarray:
    """Times at which laws change sides between instants h apart, with sides (N, l) there."""
    at, law = np.nonzero(side != np.roll(side, -1, axis=0))
    begin = instants[at]
    parts = np.arange(_PARTS + 1)
    for _ in range(_DIVISIONS):
        if not begin.size:
            break
        h /= _PARTS
        seen = answer((begin[:, None] + h * parts).ravel())[1].reshape(begin.size, parts.size, -1)
        own = seen[np.arange(begin.size), :, law]
        # An interval may hold several changes: a flight from one side to the other.
        interval, part = np.nonzero(own[:, 1:] != own[:, :-1])
        begin = begin[interval] + h * part
        law = law[interval]
    return begin + 0.5 * h


def _largest(values: Callable[[np.ndarray], np.ndarray], t: np.ndarray, F: np.ndarray, period: float) -> np.ndarray:
    """Largest values (m,) of functions of time, kinks and jumps allowed, with values F (r, m) at ascending times of a period."""
    r, m = F.shape
    peaks = np.where((np.roll(F, 1, axis=0) <= F) & (np.roll(F, -1, axis=0) <= F), F, -np.inf)
    highest = np.argsort(peaks, axis=0)[-_PEAKS:].ravel()
    column = np.tile(np.arange(m), min(_PEAKS, r))
    low = np.where(highest > 0, t[highest - 1], t[-1] - period)
    high = np.where(highest < r - 1, t[(highest + 1) % r], t[0] + period)
    found = F.max(axis=0)
    for _ in range(_CLOSER):
        about = np.linspace(low, high, _ABOUT, axis=1)
        seen = values(about.ravel() % period).reshape(column.size, _ABOUT, m)[np.arange(column.size), :, column]
        np.maximum.at(found, column, seen.max(axis=1))
        best = seen.argmax(axis=1)
        rows = np.arange(column.size)
        low, high = about[rows, np.maximum(best - 1, 0)], about[rows, np.minimum(best + 1, _ABOUT - 1)]
    return found


def gain(ratio: float) -> float:
    """By how much a step that is smaller by a ratio is better, less 1, with second order, and with a margin."""
    return (ratio**2 - 1.0) / _MARGIN


def compared(fine: np.ndarray, coarse: np.ndarray, scale: np.ndarray, factor: float, luck: float = 1.0) -> np.ndarray:
    """Errors of the better of two sets of statistics, each of which is by a factor, less 1, nearer to the truth.

    The error of one statistic may pass through zero between two steps; that half of all are as good says nothing of it. So none
    is said to be better than a share `luck` of what half of them are, relative to their scales; those of scale 0 or infinity have
    no part in that. What is the same to the last digit, such as the loss of a contact that never parts, has no error.
    """
    errors = np.abs(fine - coarse) / factor
    known = ~(scale <= 0.0)
    relative = errors[known] / scale[known]
    typical = float(np.median(relative)) if relative.size and np.all(np.isfinite(relative)) else 0.0
    least = luck * typical * np.where(known & np.isfinite(scale) & (fine != coarse), scale, 0.0)
    return np.asarray(np.maximum(errors, least))


def largest_relative(errors: np.ndarray, scale: np.ndarray) -> float:
    """The largest of errors relative to their scales; infinite where one is not known."""
    known = ~(scale <= 0.0)
    relative = errors[known] / scale[known]
    return float(relative.max(initial=0.0)) if np.all(np.isfinite(relative)) else float("inf")


def scatter_of_two(rows: np.ndarray) -> np.ndarray:
    """By how much two records differ in nineteen cases of twenty, (...), where rows (r, ...) are statistics of such records."""
    return np.asarray(_NINETEEN * np.sqrt(2.0) * rows.std(axis=0))
