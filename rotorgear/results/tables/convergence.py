"""A convergence study as a table for the terminal, 80 columns wide."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.tables.common import heading, lines, notes_of, table

if TYPE_CHECKING:
    from rich.console import RenderableType

    from rotorgear.results.convergence import ConvergenceStudy, MeshConvergenceStudy, SweepConvergenceStudy


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


def mesh_convergence_table(study: MeshConvergenceStudy) -> RenderableType:
    """Return the study as one rich renderable."""
    from rich.console import Group

    title = heading(study.title or "Mesh", f": mesh '{study.mesh}', F_bt {study.base_force_n:.6g} N on a helix")
    legend = lines(
        f"body: {study.body}",
        f"errors in % against {study.reference};",
        "after the stroke what the analysis itself estimates",
    )
    ladder = table("mesh", "elements", "dofs", "FE", "contact", "k", "k pp", "STE pp", no_wrap=True)
    for rung in study.rungs:
        cells = []
        for name in ("mean_stiffness", "peak_to_peak_stiffness", "ste_peak_to_peak"):
            estimate = rung.estimate
            said = "-" if estimate is None else f"{100 * getattr(estimate, name):.2g}"
            cells.append(f"{100 * getattr(rung.error, name):.2g}/{said}")
        ladder.add_row(
            rung.method.removeprefix("preset "),
            f"{rung.elements}" + (f"x{rung.layers}" if rung.layers else ""),
            str(rung.dofs),
            f"{rung.fe_seconds:.2f} s",
            f"{rung.contact_seconds:.2f} s",
            *cells,
        )
    return Group(title, *legend, "", ladder, "")


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
