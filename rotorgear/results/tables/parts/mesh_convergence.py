"""The convergence study of a mesh as a table for the terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rotorgear.results.tables.common import heading, lines, table

if TYPE_CHECKING:
    from rich.console import RenderableType

    from rotorgear.results.parts.mesh_convergence import MeshConvergenceStudy


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
