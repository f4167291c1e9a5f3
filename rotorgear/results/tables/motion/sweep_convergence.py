"""The convergence study of a sweep as a table for the terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.tables.common import notes_of, table

if TYPE_CHECKING:
    from rich.console import RenderableType

    from rotorgear.results.motion.sweep_convergence import SweepConvergenceStudy


def sweep_convergence_table(study: SweepConvergenceStudy) -> RenderableType:
    """Return the convergence study of a point: its values, their scatter and its cost."""
    from rich.console import Group
    from rich.text import Text

    out = table("steps", "periods", "seconds", "LE", "scatter", "stated", "p-p um", "scatter", "K_dyn", "error", left=0)
    for rung in study.rungs:
        out.add_row(
            str(rung.steps),
            str(rung.count),
            f"{rung.seconds:.3f} s",
            f"{rung.exponent:+.3f}",
            f"{rung.scatter:.3f}",
            f"{rung.stated:.3f}",
            f"{1e6 * rung.peak_to_peak:.2f}",
            f"{1e6 * rung.peak_to_peak_scatter:.2f}",
            f"{rung.dynamic_factor:.2f}",
            f"{rung.error:.0e}",
        )
    kinds = ", ".join(sorted({kind for rung in study.rungs for kind in rung.motion}))
    at = "" if study.speed is None else f" at {study.speed * RPM_PER_RAD_S:.6g} rpm"
    head = f"{study.title}: one point{at} from {study.runs} states ({kinds})"
    notes = (
        "LE: largest Lyapunov exponent per period of the fastest mesh; scatter: standard deviation over the states; stated: "
        "standard error that one run states; seconds: CPU time of one run; error: of p-p and K_dyn, against "
        f"{study.reference}"
    )
    return Group(Text(head, style="bold"), Text(""), out, Text(""), Text("\n".join([notes, *notes_of(study)])), "")
