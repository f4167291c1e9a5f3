"""Critical speeds and their map as tables for the terminal, 80 columns wide."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.modal import WHIRL_WORDS
from rotorgear.results.tables.common import error_words, heading, lines, notes_of, plain_table

if TYPE_CHECKING:
    from rich.console import RenderableType

    from rotorgear.results.critical import CriticalMap, CriticalResult

_LETTERS = {word: word[:1] for word in WHIRL_WORDS}


def critical_table(result: CriticalResult) -> RenderableType:
    """Return the critical speeds and the notes as one rich renderable."""
    from rich.console import Group

    kind = "damped" if result.damped else "undamped"
    title = f"{result.model.title or 'Critical speeds'}: {kind} critical speeds to {result.top_speed * RPM_PER_RAD_S:.6g} rpm"
    # The residuals' power of ten; below 1e-12 they are rounding.
    bound = 10.0 ** math.ceil(math.log10(max(result.worst_residual, 1e-12)))
    worst = max((item.error_estimate for item in result.speeds), default=0.0)
    notes = (
        f"{result.dofs} dofs, {result.seconds['total']:.2f} s; {result.method}",
        f"substituted back: |w - p W| / (p W) at most {bound:.0e}",
        f"estimated relative discretisation error of the speeds at most {error_words(worst)}",
        *notes_of(result),
    )
    speeds = plain_table()
    speeds.add_column("rpm", justify="right")
    speeds.add_column("Hz", justify="right")
    speeds.add_column("line", overflow="fold", min_width=14)
    if result.damped:
        speeds.add_column("zeta %", justify="right")
    speeds.add_column("whirl")
    speeds.add_column("part %", justify="right")
    speeds.add_column("what moves", overflow="fold")
    for item in result.speeds:
        # A damping ratio that rounds to nothing is 0, not -0.
        zeta = [f"{round(100.0 * item.damping_ratio, 3) + 0.0:.3f}"] if result.damped else []
        speeds.add_row(
            f"{item.speed * RPM_PER_RAD_S:.2f}",
            f"{item.frequency_hz:.3f}",
            item.line,
            *zeta,
            item.whirl,
            f"{100.0 * item.participation:.2f}" if item.excited else "none",
            item.description,
        )
    return Group(heading(title), speeds, "", *lines(*notes))


def critical_map_table(chart: CriticalMap) -> RenderableType:
    """Return the map as one table: critical speeds in ascending order, whirl by letter."""
    from rich.console import Group
    from rich.text import Text

    table = plain_table(f"Undamped map: {chart.line}, rpm of the input shaft")
    table.add_column("N/m", justify="right")
    table.add_column("critical speeds", overflow="fold")
    for k in range(0, len(chart.stiffness), max(1, len(chart.stiffness) // 8)):
        known = [(v, WHIRL_WORDS[w]) for v, w in zip(chart.critical_speeds[k], chart.whirl[k], strict=True) if v == v]
        row = ", ".join(f"{v * RPM_PER_RAD_S:.0f} {_LETTERS[word]}".rstrip() for v, word in known)
        table.add_row(f"{chart.stiffness[k]:.2e}", row)
    legend = "f forward, b backward, m mixed, p planar for the shaft of the line; no letter: torsional or axial"
    return Group(table, Text(legend))
