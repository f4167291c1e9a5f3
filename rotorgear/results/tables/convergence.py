"""A convergence study as a table for the terminal, 80 columns wide."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from rotorgear.results.tables.common import heading, lines, notes_of, table

if TYPE_CHECKING:
    from rich.console import RenderableType

    from rotorgear.results.convergence import ConvergenceStudy


def convergence_table(study: ConvergenceStudy) -> RenderableType:
    """Return the study as one rich renderable."""
    from rich.console import Group

    rows = table("discretisation", "dofs", "CPU s", "+-", "MB", "error", "estimate", "ratio", "order")
    marks: dict[str, str] = {}
    for rung in study.rungs:
        signs = "".join(marks.setdefault(note, "*+'\"^~"[len(marks) % 6]) for note in rung.notes)
        finite = math.isfinite(rung.seconds)
        rows.add_row(
            rung.method + signs,
            str(rung.dofs) if rung.dofs else "",
            f"{rung.seconds:.3f}" if finite else "",
            f"{100.0 * rung.spread:.0f}%" if finite and rung.timed > 1 else "",
            f"{rung.memory / 1e6:.1f}" if rung.memory else "",
            f"{rung.error:.1e}",
            "" if math.isnan(rung.estimate) else f"{rung.estimate:.1e}",
            "" if rung.effectivity is None else f"{rung.effectivity:.2f}",
            "" if rung.order is None else f"{rung.order:.2f}",
        )
    title = heading(study.title, f": {study.analysis}, {study.modes} {study.compared}")
    legend = lines(
        f"error: the largest relative one, against {study.reference}",
        "ratio: estimate over error",
        *(f"{sign} {note}" for note, sign in marks.items()),
        *notes_of(study),
    )
    return Group(title, *legend, "", rows, "")
