"""A layout that keeps its excitations away from the modes that they excite: numbers and margins before and after."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from rotorgear.model.model import Model
from rotorgear.model.numbers import numbers_of
from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.result import ModelResult
from rotorgear.results.schema import Record, derived, of
from rotorgear.results.table import Block, Line, Table, grid

# Shares of the least participation, so that just below it is no way out. From here on a mode may come to count.
NEARLY = 0.5
# It has a weight in the penalty, which so has a slope at the least participation.
WEIGHS_FROM = 0.6
# The search does not end while such a mode is within the margin; the finer mesh that judges it may differ a little.
SOUGHT_FROM = 0.63
# It forbids the margin.
COUNTS_FROM = 0.7
# Modes within the margin are named where their participation is this near to the least one.
_NEAR_LEAST = (NEARLY, 1.3)


class LayoutNumber(Record):
    """A number of the model that was free."""

    address: str = of("address in the model file")
    unit: str = of("SI unit", note=" of the values; empty for a factor or ratio")
    before: float = of("value in the file", note="; 1 where several numbers have one factor")
    after: float = of("value found")
    low: float = of("lower bound")
    high: float = of("upper bound")
    at_bound: str = of("bound that the value stands at", note=': `"low"`, `"high"` or `""`')
    pull: float = of(
        "derivative of the penalty by the share of the bounds", note=": the value would go on against its sign"
    )


class LayoutMargin(Record):
    """One excitation at one speed, and the mode next to it among those that count, before and after."""

    line: str = of("excitation line")
    speed: float = of("speed of the input shaft", "rad/s")
    frequency_hz: float = of("frequency", "Hz", note=" of the line", form=".2f")
    before_hz: float = of("frequency of the nearest mode before", "Hz", note="; `null`: none", form=".2f")
    before_margin: float = of("margin before", note=": f_mode / f_line - 1")
    before_participation: float = of("participation of that mode")
    before_inside: float = of("largest participation of a mode within the margin that does not count")
    after_hz: float = of("frequency of the nearest mode after", "Hz", note="; `null`: none", form=".2f")
    after_margin: float = of("margin after")
    after_participation: float = of("participation of that mode", note=" after")
    after_inside: float = of("largest participation of a mode within the margin that does not count", note=", after")


class LayoutMode(Record):
    """A mode near an excitation."""

    line: str = of("excitation line")
    speed: float = of("speed of the input shaft", "rad/s")
    frequency_hz: float = of("frequency", "Hz", note=" of the mode", form=".2f")
    margin: float = of("margin", note=": f_mode / f_line - 1", form="+.4f")
    participation: float = of("participation of the mode", form=".2%")


class OptimiseResult(ModelResult, kind="optimise"):
    """The layout found; `model` is the one before, `optimised` the one after."""

    numbers: tuple[LayoutNumber, ...] = of("free numbers", "", "number", record=LayoutNumber)
    lines: tuple[LayoutMargin, ...] = of("excitations", "", "line", record=LayoutMargin)
    modes_before: tuple[LayoutMode, ...] = of(
        "modes within three margins of a line, before", "", "near_mode", record=LayoutMode
    )
    modes_after: tuple[LayoutMode, ...] = of(
        "modes within three margins of a line, after", "", "near_mode_after", record=LayoutMode
    )
    least_margin: float = of("margin that is asked for")
    participation: float = of("least participation that counts")
    objective: str = of("objective", note=': `"change"`, `"mass"` or `"scatter"`')
    penalty_before: float = of("penalty before", note=": 0 where all margins are kept")
    penalty_after: float = of("penalty after")
    deviations_before: float | None = of(
        "standard deviations by which the margin is kept before", note="; negative inside it, `null` without scatter"
    )
    deviations_after: float | None = of("standard deviations by which the margin is kept after")
    mass_before_kg: float = of("mass of the rotors before", "kg")
    mass_after_kg: float = of("mass of the rotors after", "kg")
    solutions: int = of("modal solutions that were needed")
    gradients: int = of("gradients that were needed")
    searches_reached: int = of("number of searches that reached the margin")
    searches: int = of("number of searches")

    @property
    def optimised(self) -> Model:
        """The model with the numbers found."""
        numbers = numbers_of(self.model, [row.address for row in self.numbers])
        return numbers.at(np.array([row.after for row in self.numbers]))

    @derived("whether every excitation keeps the margin")
    def reached(self) -> bool:
        """On the mesh of the table, which is refined for the model before and for that after.

        No mode within the margin takes part by 0.7 of the least participation and more.
        """
        return not any(map(self._missed, self.lines))

    def _missed(self, row: LayoutMargin) -> bool:
        return abs(row.after_margin) < self.least_margin or row.after_inside >= COUNTS_FROM * self.participation

    @derived("modes within the margin whose participation is near the least one", "", "sentence")
    def nearly_counting(self) -> tuple[str, ...]:
        """Modes after, with 0.5 to 1.3 times the least participation."""
        low, high = (share * self.participation for share in _NEAR_LEAST)
        return tuple(
            f"{row.frequency_hz:.1f} Hz ({100.0 * row.margin:+.1f} % from {row.line}, "
            f"participation {100.0 * row.participation:.2g} %)"
            for row in self.modes_after
            if abs(row.margin) < self.least_margin and low <= row.participation < high
        )

    @derived("which bounds forbid the margin", "", "sentence", note="; empty where it is reached")
    def forbidden_by(self) -> tuple[str, ...]:
        """Numbers at a bound beyond which the penalty would go on to fall, strongest first."""
        if self.reached:
            return ()
        held = [row for row in self.numbers if row.at_bound and abs(row.pull) > 0.0]
        held = [row for row in held if (row.pull > 0.0) == (row.at_bound == "low")]
        held.sort(key=lambda row: -abs(row.pull))
        return tuple(
            f"{row.address} at its {'lower' if row.at_bound == 'low' else 'upper'} bound of {_value(row, row.after)}"
            for row in held
        )

    def tables(self) -> Iterator[Block]:
        """Numbers with their bounds, margins with the modes that count, and what was reached."""
        rows = []
        for row in self.numbers:
            values = (value_words(row, value) for value in (row.before, row.after, row.low, row.high))
            rows.append((row.address, *values, f"at {row.at_bound}" if row.at_bound else ""))
        yield Line(self.title or "Layout")
        yield from (grid(rows, "number", "before", "after", "low", "high", "", caption="Free numbers"), "")
        yield from (self._margins(), "")
        yield from (*self._said(), *self.remarks())

    def _margins(self) -> Table:
        def cells(hz: float, margin: float, share: float, inside: float) -> tuple[str, ...]:
            others = f"{100 * inside:.2f} %" if inside else "-"
            if not np.isfinite(hz):
                return ("none", "-", "-", others)
            return (f"{hz:.1f}", f"{100 * margin:+.2f} %", f"{100 * share:.2f} %", others)

        rows: list[tuple[str, ...]] = []
        for row in self.lines:
            first = (f"{row.speed * RPM_PER_RAD_S:.6g}", f"{row.frequency_hz:.1f}")
            before = (row.before_hz, row.before_margin, row.before_participation, row.before_inside)
            after = (row.after_hz, row.after_margin, row.after_participation, row.after_inside)
            rows += [(f"{row.line}: before", *first, *cells(*before)), ("after", "", "", *cells(*after))]
        heads = ("excitation, and the mode next to it", "rpm", "Hz", "mode", "margin", "share", "others")
        return grid(rows, *heads, caption="Margins")

    def _said(self) -> Iterator[str]:
        asked = f"{100 * self.least_margin:.3g} %"
        least = f"{100 * self.participation:.3g} %"
        yield f"share: participation of the mode; others: the largest within the margin of a mode that has less than {least}"
        from_here = f"participation of {100 * COUNTS_FROM * self.participation:.3g} % and more"
        if self.reached:
            yield f"Every excitation keeps {asked} from the modes that it excites ({from_here})."
        else:
            short = dict.fromkeys(row.line for row in self.lines if self._missed(row))
            yield f"A margin of {asked} was NOT reached by {', '.join(short)} (modes with a {from_here})."
            if self.forbidden_by:
                yield f"Bounds that forbid it: {'; '.join(self.forbidden_by)}."
            elif any(row.pull for row in self.numbers):
                yield "No bound forbids it: the search ended in a local minimum; free more numbers, or ask for more searches."
            else:
                yield "None of the free numbers moves the modes that count: free others."
        if self.nearly_counting:
            yield f"Modes within the margin that take part by nearly {least}: {'; '.join(self.nearly_counting)}."
        if self.deviations_before is not None and self.deviations_after is not None:
            yield (
                f"With [scatter], the margin is kept by {_deviations(self.deviations_before)} before, "
                f"{_deviations(self.deviations_after)} after (negative: a mode inside it)."
            )
        yield f"Mass of the rotors {self.mass_before_kg:.2f} kg before, {self.mass_after_kg:.2f} kg after."
        yield (
            f"{self.searches_reached} of {self.searches} searches reached the margin; {self.solutions} modal solutions, "
            f"{self.gradients} gradients, {self.dofs} dofs"
        )


def _value(row: LayoutNumber, value: float) -> str:
    if row.unit == "m":
        return f"{1e3 * value:.4g} mm"
    return f"{value:.4g} {row.unit}".strip()


def value_words(row: LayoutNumber, value: float) -> str:
    """A value of a number with its unit, lengths in mm; a factor as a factor."""
    return _value(row, value) if row.unit else f"x {value:.4f}"


def _deviations(value: float) -> str:
    return f"{value:+.1f} standard deviations" if np.isfinite(value) else "any scatter (no mode that counts is near)"
