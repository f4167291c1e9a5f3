"""The Campbell result as tables for the terminal."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.tables.common import notes_of, plain_table, table_of

if TYPE_CHECKING:
    from rich.console import RenderableType

    from rotorgear.results.campbell import CampbellResult

# So many crossings are printed; sidebands of a gearbox give thousands.
_MOST_CROSSINGS = 100


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
    if result.operating_speed is not None and result.margins:
        margins = table_of(
            result.margins,
            ("line", "left", lambda item: item.line),
            ("Hz", "right", lambda item: f"{item.frequency_hz:.2f}"),
            ("branch", "right", lambda item: str(item.branch) if item.branch else "-"),
            ("Hz", "right", lambda item: _number(item.mode_hz, ".2f")),
            ("margin %", "right", lambda item: _number(100.0 * item.margin, "+.2f")),
            ("whirl", "left", lambda item: item.whirl),
            ("part %", "right", lambda item: _number(100.0 * item.participation, ".2f") if item.branch else "-"),
            ("crossing rpm", "right", lambda item: _number(item.crossing_speed * RPM_PER_RAD_S, ".1f")),
            title=f"Margins at {result.operating_speed * RPM_PER_RAD_S:.6g} rpm",
        )
        parts.append(margins)
    if crossings:
        # The most telling ones of a long list, in its order.
        by_share = sorted(result.crossings, key=lambda item: -item.participation)[:_MOST_CROSSINGS]
        kept = {id(item) for item in by_share}
        met = table_of(
            [item for item in result.crossings if id(item) in kept],
            ("rpm", "right", lambda item: f"{item.speed * RPM_PER_RAD_S:.2f}"),
            ("Hz", "right", lambda item: f"{item.frequency_hz:.3f}"),
            ("branch", "right", lambda item: str(item.branch)),
            ("line", "left", lambda item: item.line),
            ("whirl", "left", lambda item: item.whirl),
            ("zeta %", "right", lambda item: _number(100.0 * item.damping_ratio, ".3f")),
            (
                "takes part %",
                "right",
                lambda item: f"{100.0 * item.participation:.2f}" if item.excited else "not excited",
            ),
            title="Crossings",
        )
        parts.append(met)
    notes = [""]
    if crossings and len(result.crossings) > _MOST_CROSSINGS:
        rest = len(result.crossings) - _MOST_CROSSINGS
        notes.append(f"{rest} more crossings take part less than these: --json has them all")
    if any(not item.branch for item in result.margins):
        notes.append("-: the line lies above all branches (--fmax follows more), or can't excite any")
    if not crossings:
        excited = f"{sum(item.excited for item in result.crossings)} of them of modes that the line can excite"
        notes.append(f"{len(result.crossings)} crossings, {excited}; --crossings lists them")
    notes.append(f"{result.dofs} dofs, {result.seconds['total']:.2f} s; {result.method}")
    estimates = result.error_estimate[np.isfinite(result.error_estimate)]
    if estimates.size:
        notes.append(f"error: estimated relative discretisation error of each frequency, largest {estimates.max():.1e}")
    notes += notes_of(result)
    return Group(*parts, *(Text(note) for note in notes), "")


def _number(value: float, form: str) -> str:
    """A number, -0.0 as 0.0; a stroke for what is not known."""
    return format(value + 0.0, form) if math.isfinite(value) else "-"
