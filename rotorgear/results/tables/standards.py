"""Checks against rules as a table for the terminal, 80 columns wide."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from rotorgear.results.tables.common import heading, lines, notes_of, table

if TYPE_CHECKING:
    from rich.console import RenderableType

    from rotorgear.results.standards import StandardsResult


def standards_table(result: StandardsResult) -> RenderableType:
    """Return title, peaks of the unbalance response, each rule with value, limit and verdict, the rules, and notes."""
    from rich.console import Group

    reference = f"{result.model.reference_shaft} at {result.operating_rpm:.6g} rpm"
    peaks = table("peak, shaft", "rpm", "N1", "N2", "AF", "margin %", "asked %")
    for peak in result.criticals:
        asked = "none" if peak.required_percent is None else f"{peak.required_percent:.2f}"
        speeds = [_number(value, ".1f") for value in (peak.shaft_rpm, peak.below_rpm, peak.above_rpm)]
        factor = _number(peak.amplification_factor, ".4g")
        peaks.add_row(peak.shaft, *speeds, factor, f"{peak.margin_percent:+.2f}", asked)
    out = table("rule", "part", "value", "limit", "unit", "verdict", left=2)
    for check in result.checks:
        unit = check.unit
        out.add_row(check.rule, check.part, _number(check.value), _number(check.limit), unit, check.verdict)
    notes = [
        *(f"{rule.name} ({rule.source}): {rule.formula}" for rule in result.rules),
        f"{result.dofs} dofs, {result.seconds['total']:.2f} s; {result.method}",
        *notes_of(result),
    ]
    title = heading(f"{result.model.title or 'Model'}: rules of standards, {reference}")
    shown = [peaks, ""] if result.criticals else []
    return Group(title, "", *shown, out, "", *lines(*notes), "")


def _number(value: float | None, form: str = ".4g") -> str:
    return "-" if value is None or math.isnan(value) else f"{value:{form}}"
