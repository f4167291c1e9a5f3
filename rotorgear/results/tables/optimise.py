"""A layout before and after as tables: numbers with their bounds, margins with the modes that count."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.optimise import OptimiseResult, value_words
from rotorgear.results.tables.common import heading, lines, notes_of, table

if TYPE_CHECKING:
    from rich.console import RenderableType


def optimise_table(result: OptimiseResult) -> RenderableType:
    """What `rotorgear optimise` prints."""
    from rich.console import Group

    numbers = table("number", "before", "after", "low", "high", "")
    numbers.columns[0].overflow = "fold"
    for row in result.numbers:
        values = (value_words(row, value) for value in (row.before, row.after, row.low, row.high))
        numbers.add_row(row.address, *values, {"low": "at low", "high": "at high", "": ""}[row.at_bound])
    title = heading(result.title or "Layout")
    return Group(title, numbers, *lines(""), _margins(result), *lines("", *_said(result)))


def _margins(result: OptimiseResult) -> Any:
    out = table("excitation, and the mode next to it", "rpm", "Hz", "mode", "margin", "share", "others")
    for row in result.lines:
        first = (f"{row.speed * RPM_PER_RAD_S:.6g}", f"{row.frequency_hz:.1f}")
        before = (row.before_hz, row.before_margin, row.before_participation, row.before_inside)
        after = (row.after_hz, row.after_margin, row.after_participation, row.after_inside)
        out.add_row(f"{row.line}: before", *first, *_cells(*before))
        out.add_row("after", "", "", *_cells(*after))
    return out


def _cells(hz: float, margin: float, share: float, inside: float) -> tuple[str, ...]:
    others = f"{100 * inside:.2f} %" if inside else "-"
    if not np.isfinite(hz):
        return ("none", "-", "-", others)
    return (f"{hz:.1f}", f"{100 * margin:+.2f} %", f"{100 * share:.2f} %", others)


def _deviations(value: float) -> str:
    return f"{value:+.1f} standard deviations" if np.isfinite(value) else "any scatter (no mode that counts is near)"


def _said(result: OptimiseResult) -> list[str]:
    asked = f"{100 * result.least_margin:.3g} %"
    least = f"{100 * result.participation:.3g} %"
    said = [
        f"share: participation of the mode; others: the largest within the margin of a mode that has less than {least}"
    ]
    if result.reached:
        said.append(
            f"Every excitation keeps {asked} from the modes that it excites (participation of {least} and more)."
        )
    else:
        short = dict.fromkeys(row.line for row in result.lines if abs(row.after_margin) < result.least_margin)
        said.append(
            f"A margin of {asked} was NOT reached by {', '.join(short)} (modes with a participation of {least} and more)."
        )
        held = "; ".join(result.forbidden_by)
        said.append(
            f"Bounds that forbid it: {held}."
            if held
            else "None of the free numbers moves the modes that count: free others."
            if not any(row.pull for row in result.numbers)
            else "No bound forbids it: the search ended in a local minimum; free more numbers, or ask for more searches."
        )
    if result.deviations_before is not None and result.deviations_after is not None:
        said.append(
            f"With [scatter], the margin is kept by {_deviations(result.deviations_before)} before, "
            f"{_deviations(result.deviations_after)} after (negative: a mode inside it)."
        )
    said.append(f"Mass of the rotors {result.mass_before_kg:.2f} kg before, {result.mass_after_kg:.2f} kg after.")
    said.append(
        f"{result.searches_reached} of {result.searches} searches reached the margin; {result.solutions} modal solutions, "
        f"{result.gradients} gradients, {result.dofs} dofs"
    )
    return said + notes_of(result)
