"""Positions over the mesh cycle where its curves need them, and what may still lie between them.

A curve is known at some positions, and by cubics between them (`cycle_curve`). Each contact solution at a new position judges the
cubic that was there before; what it was wrong by is what the two cubics beside it are taken to be wrong by: in truth that falls
by eight and more where the curve is smooth, but a kink may stand anywhere. With such an error e_i in each interval of length h_i

    pp:          [max(f + e) - min(f - e)] - pp of the positions,        where f + e is above, or f - e below, all positions,
    harmonics:   |c_n - c_n'| <= 4/3 sum of h_i e_i / P, beside the change of c_n by the positions that were added.

The next positions halve the intervals with the largest of these. Where a pair comes or goes, the opening of its flanks crosses
zero, which a chord of it finds within a few solutions. At last the search goes on for some positions that are not kept: they
judge those that are, so that an estimate rests on contact solutions that its result has not seen.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from rotorgear.gears.stiffness.cycle_curve import NEAR, CycleCurve

# A first look at a period takes a third of its positions, between these bounds.
_FIRST = (8, 24)
# Rounds of chords that look for one event.
_CHORDS = 6
# Positions that judge the others: this share of theirs, and until this number is solved in a period.
_JUDGES = 0.25
_LEAST_SOLVED = 48
# They halve intervals down to this, in base pitches, first. The largest pressure of helical teeth stands where a corner
# touches at the end of a face, on a twentieth of a base pitch, and judges that look for events alone pass it by.
_WIDE = 0.05
# New positions of one round, as a share of those that are there: later ones know more, earlier ones cost less together.
_ROUND = 0.15
# What is left of an error after its interval is halved: for a kink between the positions up to the whole of it, and no less than
# this share of what was expected there, since a solution may meet the cubic by chance. (Kinks at 40 places of a parabola that
# nothing told: with 0.5 no error exceeds what is said of it, with 0.25 one of 250 does by three, with 0.125 five by up to 2.7.)
_BY_CHANCE = 0.5
# Places in an interval where the bounds of a curve are looked at; 4 t (1 - t) there is the shape of its error.
_SHARES = np.linspace(0.0, 1.0, 9)
_BUBBLE = 4.0 * _SHARES * (1.0 - _SHARES)
# An error that is seen near the end of an interval tells little of its middle: it counts as if seen at this share of 4 t (1 - t).
_LEAST_BUBBLE = 0.25
# Positions nearer to each other than this, in base pitches, are one.
_SAME = 1e-7


# Solves new positions (m,) and gives the values (m, c) of the curves there.
Add = Callable[[np.ndarray], np.ndarray]
# Where pairs come and go: guesses (k,) that would be solved next, and the solved position (k,) nearest to each.
Events = Callable[[], tuple[np.ndarray, np.ndarray]]


@dataclass(frozen=True)
class SampledCurves:
    """Curves at chosen positions.

    Attributes:
        curve: at the positions that are kept.
        all: at all positions that were solved.
        error: (n, c) what the cubics of `all` may be wrong by, in the interval after each position.
    """

    curve: CycleCurve
    all: CycleCurve
    error: np.ndarray

    def peak_to_peak_error(self) -> np.ndarray:
        """How much larger the peaks to peaks (c,) may be than those at the kept positions."""
        high, low = _bounds(self.all, self.error)
        return np.asarray((high.max(axis=0) - low.min(axis=0)) - np.ptp(self.curve.values, axis=0))

    def largest_error(self) -> np.ndarray:
        """How much larger the largest values (c,) may be than those at the kept positions."""
        return np.asarray(_bounds(self.all, self.error)[0].max(axis=0) - self.curve.values.max(axis=0))

    def mean_error(self) -> np.ndarray:
        """What the means (c,) may be wrong by."""
        return np.asarray(np.abs(self.all.mean() - self.curve.mean()) + self._left_over())

    def harmonics_error(self, count: int) -> np.ndarray:
        """What the complex amplitudes (count, c) of the kept positions may be wrong by."""
        apart = np.abs(self.all.harmonics(count) - self.curve.harmonics(count))
        return np.asarray(apart + 2.0 * self._left_over())

    def _left_over(self) -> np.ndarray:
        """Mean (c,) of the errors over the cycle: that of 4 t (1 - t) is two thirds."""
        return np.asarray(2.0 / 3.0 * (self.all.width @ self.error) / self.all.period)


def _bounds(curve: CycleCurve, error: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Largest and smallest value (n, c) that each interval may hold."""
    inside = curve.within(_SHARES)
    around = error[:, None] * _BUBBLE[:, None]
    return (inside + around).max(axis=1), (inside - around).min(axis=1)


def sampled(
    add: Add, events: Events, count: int, period: float, known: np.ndarray, sides: np.ndarray, *, judged: bool = True
) -> SampledCurves:
    """Choose and solve positions.

    Args:
        add: solves positions.
        events: where pairs come and go among those that are solved.
        count: positions that are kept, over the whole cycle.
        period: length of the cycle in base pitches.
        known: (k,) events that geometry knows.
        sides: (c,) 2 for curves whose peak to peak is asked for, 1 for those whose largest value is.
        judged: whether more positions are solved, which judge those that are kept; else errors are those of the last rounds.
    """
    search = _Search(add, events, period, sides, known)
    first = round(min(max(count / 3, _FIRST[0] * period), _FIRST[1] * period, count))
    search.add(np.arange(first) * (period / first))
    search.fill(count)
    kept = search.curve()
    if judged:
        most = max(count + int(_JUDGES * count), round(_LEAST_SOLVED * period))
        search.halve_wide(most)
        search.fill(most)
    return SampledCurves(kept, search.curve(), search.error)


class _Search:
    """Positions that are solved, and what each interval between them may be wrong by."""

    def __init__(self, solve: Add, events: Events, period: float, sides: np.ndarray, known: np.ndarray) -> None:
        self.solve = solve
        self.events = events
        self.period = period
        self.sides = sides
        self.known = np.unique(np.mod(known, period))
        self.position = np.empty(0)
        self.values = np.empty((0, len(sides)))
        self.event = np.empty(0, bool)
        self.error = np.empty((0, len(sides)))  # in the interval after each position

    def curve(self) -> CycleCurve:
        """Of all positions."""
        return CycleCurve(self.position, self.values, self.period, self.event)

    def fill(self, count: int) -> None:
        """Add positions until there are `count`: at events first, then where the curves may be wrong."""
        self.add(self._new(self.known)[: count - len(self.position)])
        for _ in range(_CHORDS):
            guesses = self._new(self.events()[0])[: count - len(self.position)]
            if not len(guesses):
                break
            self.add(guesses)
        while len(self.position) < count:
            self._mark_events()
            self.add(self._next(count - len(self.position)))
        self._mark_events()

    def halve_wide(self, count: int) -> None:
        """Halve wide intervals, the widest first, until none is left or there are `count` positions."""
        while len(self.position) < count:
            width = self.curve().width
            widest = np.argsort(-width, kind="stable")[: count - len(self.position)]
            chosen = widest[width[widest] > _WIDE]
            if not len(chosen):
                break
            self.add(np.mod(self.position[chosen] + 0.5 * width[chosen], self.period))

    def _new(self, positions: np.ndarray) -> np.ndarray:
        """Those of some positions that are not solved yet, each once, rising."""
        u = np.unique(np.mod(positions, self.period))
        u = u[np.diff(u, prepend=-1.0) > _SAME]
        apart = np.abs(
            u[:, None] - np.concatenate([self.position, self.position - self.period, self.position + self.period])
        )
        return np.asarray(u[apart.min(axis=1) > _SAME])

    def _mark_events(self) -> None:
        places = np.concatenate([self.known, self.events()[1]])
        if len(places):
            apart = np.abs(self.position[:, None] - np.mod(places, self.period))
            self.event = apart.min(axis=1) <= _SAME

    def add(self, positions: np.ndarray) -> None:
        """Solve positions (m,), and learn from what the cubics had there."""
        if not len(positions):
            return
        values = self.solve(positions)
        first = not len(self.position)
        error = self.error
        if not first:
            curve = self.curve()
            miss = np.abs(values - curve.at(positions))
            parent = np.mod(np.searchsorted(self.position, positions, side="right") - 1, len(self.position))
            left = _BY_CHANCE * self.error
            # The error of a cubic is about 4 t (1 - t) of that in its middle.
            share = np.mod(positions - self.position[parent], self.period) / curve.width[parent]
            np.maximum.at(left, parent, miss / np.maximum(4.0 * share * (1.0 - share), _LEAST_BUBBLE)[:, None])
            error[parent] = left[parent]
            error = np.concatenate([error, left[parent]])
        order = np.argsort(np.concatenate([self.position, positions]), kind="stable")
        self.position = np.concatenate([self.position, positions])[order]
        self.values = np.concatenate([self.values, values])[order]
        self.event = np.concatenate([self.event, np.zeros(len(positions), bool)])[order]
        curve = self.curve()
        width = curve.width[:, None]
        following = np.roll(self.values, -1, axis=0)
        rise = np.abs(following - self.values)
        # As long as nothing has judged the cubics, they may be wrong by as much as they are away from the chord.
        from_chord = np.abs(curve.within(np.array([0.5]))[:, 0] - 0.5 * (self.values + following))
        error = from_chord if first else error[order]
        # No interval can hide more than the curve climbs in it where it is steepest.
        error = np.minimum(error, (rise / width).max(axis=0) * width)
        # Near positions enclose an event; between them curves are monotone: a quarter of the rise is the most for that.
        self.error = np.where(width <= NEAR, np.minimum(error, 0.25 * rise), error)

    def _next(self, most: int) -> np.ndarray:
        """New positions in the intervals that may change a result most."""
        curve = self.curve()
        scale = np.where(self.sides == 2, np.ptp(self.values, axis=0), np.abs(self.values).max(axis=0))
        scale = np.maximum(scale, 1e-12 * np.abs(self.values).max(axis=0) + 1e-300)
        high, low = _bounds(curve, self.error)
        above = (high - self.values.max(axis=0)) / scale
        below = np.where(self.sides == 2, (self.values.min(axis=0) - low) / scale, 0.0)
        # In harmonics an interval counts by its area.
        area = np.where(self.sides == 2, 4.0 / 3.0 * curve.width[:, None] * self.error / (self.period * scale), 0.0)
        gain = np.maximum(np.maximum(above, below), area).max(axis=1)
        # They are not halved either: a step, as where a contact line gets another number of slices, would take all positions.
        gain = np.where(curve.width > NEAR, gain, -1.0)
        count = min(most, max(2, int(_ROUND * len(self.position))))
        chosen = np.argsort(-gain, kind="stable")[:count]
        # Where the cubic has a peak inside, there; else in the middle.
        inside = curve.within(_SHARES)[chosen]
        share = np.full(len(chosen), 0.5)
        for values, beyond in ((inside, above[chosen]), (-inside, below[chosen])):
            worst = beyond.argmax(axis=1)
            peak = values[np.arange(len(chosen)), :, worst].argmax(axis=1)
            counts = (beyond.max(axis=1) > area[chosen].max(axis=1)) & (peak > 0) & (peak < len(_SHARES) - 1)
            share = np.where(counts, _SHARES[peak], share)
        return np.asarray(np.mod(self.position[chosen] + share * curve.width[chosen], self.period))
