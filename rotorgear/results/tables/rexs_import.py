"""An import from REXS as text for the terminal: what was made, and every assumption by its reason."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rotorgear.results.tables.common import heading, lines, table_of

if TYPE_CHECKING:
    from rich.console import RenderableType

    from rotorgear.results.rexs_import import RexsImport


def import_table(result: RexsImport) -> RenderableType:
    """Return what was read, the assumptions, and what was left out."""
    from rich.console import Group

    counts = f"{result.shafts} shafts, {result.gears} gears, {result.meshes} meshes, {result.bearings} bearings"
    case = f", load case {result.load_case}" if result.load_case else ""
    assumed = table_of(
        result.assumptions,
        ("assumed", "left", lambda row: row.address),
        ("value", "left", lambda row: row.value),
        ("why", "left", lambda row: row.reason),
    )
    notes = [
        f"{len(result.assumptions)} assumptions; each stands as a comment in the model file",
        *(f"left out: {note}" for note in result.left_out),
        *(f"Warning: {note}" for note in result.warnings),
    ]
    made = f"REXS {result.version}" + (f" by {result.application}" if result.application else "")
    head = heading(result.source, f": {made}{case}")
    body = [assumed, ""] if result.assumptions else []
    return Group(head, *lines(counts), "", *body, *lines(*notes))
