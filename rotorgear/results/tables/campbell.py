"""The Campbell result as tables for the terminal."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from rotorgear.quantity import RPM_PER_RAD_S

if TYPE_CHECKING:
    from rich.console import RenderableType

    from rotorgear.results.campbell import CampbellResult


def campbell_table(result: CampbellResult, *, crossings: bool = False) -> RenderableType:
    """Return branches, margins and, where asked for, crossings as one rich renderable that fits 80 columns."""
    from rich.console import Group
    from rich.text import Text

    first = result.speed_rpm[0]
    last = result.speed_rpm[-1]
    title = f"{result.model.title or 'Modes'}: {result.model.reference_shaft} at {first:.6g} to {last:.6g} rpm"
    branches = plain_table()
    branches.add_column("branch", justify="right")
    for speed in (first, last):
        branches.add_column(f"Hz at {speed:.6g}", justify="right")
    branches.add_column("log dec.", justify="right")
    branches.add_column("whirl")
    branches.add_column("what moves", overflow="fold")
    for b in range(len(result)):
        branches.add_row(
            str(b + 1),
            *(_number(value, ".4f") for value in result.frequency_hz[[0, -1], b]),
            _number(result.log_decrement[-1, b], ".4f"),
            result.whirl_word(-1, b),
            result.description[b],
        )
    parts: list[RenderableType] = [Text(title, style="bold"), branches]
    if result.margins:
        parts.append(_margins(result))
    if crossings:
        parts.append(_crossings(result))
    notes = [""]
    if any(not item.branch for item in result.margins):
        notes.append("-: the line lies above all branches (--fmax follows more), or can't excite any")
    if not crossings:
        excited = f"{sum(item.excited for item in result.crossings)} of them of modes that the line can excite"
        notes.append(f"{len(result.crossings)} crossings, {excited}; --crossings lists them")
    notes.append(f"{result.dofs} dofs, {result.seconds['total']:.2f} s; {result.method}")
    estimates = result.error_estimate[np.isfinite(result.error_estimate)]
    if estimates.size:
        notes.append(f"error: estimated relative discretisation error of each frequency, largest {estimates.max():.1e}")
    notes += [f"left out: {note}" for note in result.left_out]
    notes += [f"Warning: {note}" for note in result.warnings]
    return Group(*parts, *(Text(note) for note in notes), "")


def plain_table(title: str = "") -> Any:
    """An empty table without lines."""
    from rich.table import Table

    return Table(
        box=None,
        pad_edge=False,
        title=f"\n{title}" if title else None,
        title_justify="left",
        title_style="bold",
        header_style="bold",
    )


def _margins(result: CampbellResult) -> Any:
    assert result.operating_speed is not None
    table = plain_table(f"Margins at {result.operating_speed * RPM_PER_RAD_S:.6g} rpm")
    table.add_column("line", overflow="fold")
    for name in ("Hz", "branch", "Hz", "margin %", "takes part %", "crossing rpm"):
        table.add_column(name, justify="right")
    for item in result.margins:
        known = item.branch > 0
        table.add_row(
            item.line,
            f"{item.frequency_hz:.2f}",
            str(item.branch) if known else "-",
            _number(item.mode_hz, ".2f"),
            _number(100.0 * item.margin, "+.2f"),
            _number(100.0 * item.participation, ".2f") if known else "-",
            _number(item.crossing_speed * RPM_PER_RAD_S, ".1f"),
        )
    return table


def _crossings(result: CampbellResult) -> Any:
    table = plain_table("Crossings")
    table.add_column("rpm", justify="right")
    table.add_column("Hz", justify="right")
    table.add_column("branch", justify="right")
    table.add_column("line", overflow="fold")
    table.add_column("whirl")
    table.add_column("zeta %", justify="right")
    table.add_column("takes part %", justify="right")
    for item in result.crossings:
        share = f"{100.0 * item.participation:.2f}" if item.excited else "not excited"
        table.add_row(
            f"{item.speed * RPM_PER_RAD_S:.2f}",
            f"{item.frequency_hz:.3f}",
            str(item.branch),
            item.line,
            item.whirl,
            _number(100.0 * item.damping_ratio, ".3f"),
            share,
        )
    return table


def _number(value: float, form: str) -> str:
    """A number, -0.0 as 0.0; a stroke for what is not known."""
    return format(value + 0.0, form) if math.isfinite(value) else "-"
