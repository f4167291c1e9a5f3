"""A convergence study as a table for the terminal, 80 columns wide."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rotorgear.results.tables.common import heading, lines, table

if TYPE_CHECKING:
    from rich.console import RenderableType

    from rotorgear.results.convergence import ConvergenceStudy


def convergence_table(study: ConvergenceStudy) -> RenderableType:
    """Return the study as one rich renderable."""
    from rich.console import Group

    rows = table("discretisation", "dofs", "seconds", "error", "estimate", "order")
    for rung in study.rungs:
        order = "" if rung.order is None else f"{rung.order:.2f}"
        rows.add_row(
            rung.method, str(rung.dofs), f"{rung.seconds:.3f} s", f"{rung.error:.1e}", f"{rung.estimate:.1e}", order
        )
    what = f"largest relative error of {study.modes} frequencies"
    if study.analysis == "transient":
        what = f"rms error of {study.modes} contact forces over their change"
    return Group(heading(study.title, f": {what}"), *lines(f"against {study.reference}"), "", rows, "")
