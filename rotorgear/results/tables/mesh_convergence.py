"""The convergence study of a mesh as a table for the terminal."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from rotorgear.results.tables.common import heading, lines, table

if TYPE_CHECKING:
    from rich.console import RenderableType

    from rotorgear.results.mesh_convergence import MeshConvergenceStudy


def mesh_convergence_table(study: MeshConvergenceStudy) -> RenderableType:
    """Return the study as one rich renderable."""
    from rich.console import Group

    return Group(*_parts(study))


def _parts(study: MeshConvergenceStudy) -> Iterator[Any]:
    yield heading(study.title or "Mesh", f": mesh '{study.mesh}', F_bt {study.base_force_n:.6g} N on a helix")
    yield from lines(
        f"body: {study.body}",
        f"errors in % against {study.reference};",
        "after the stroke what the analysis itself estimates",
    )
    yield ""
    out = table("mesh", "elements", "dofs", "FE", "contact", "k", "k pp", "STE pp", no_wrap=True)
    for rung in study.rungs:
        cells = []
        for name in ("mean_stiffness", "peak_to_peak_stiffness", "ste_peak_to_peak"):
            estimate = rung.estimate
            said = "-" if estimate is None else f"{100 * getattr(estimate, name):.2g}"
            cells.append(f"{100 * getattr(rung.error, name):.2g}/{said}")
        elements = f"{rung.elements}" + (f"x{rung.layers}" if rung.layers else "")
        method = rung.method.removeprefix("preset ")
        seconds = [f"{rung.fe_seconds:.2f} s", f"{rung.contact_seconds:.2f} s"]
        out.add_row(method, elements, str(rung.dofs), *seconds, *cells)
    yield out
    yield ""
