"""An import from REXS as text for the terminal: what was made, and every assumption with its reason."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rotorgear.results.tables.common import heading, lines, notes_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rich.console import RenderableType

    from rotorgear.results.rexs_import import Assumption, RexsImport


def import_table(result: RexsImport) -> RenderableType:
    """Return what was read, the assumptions, and what was left out."""
    from rich.console import Group

    made = f"REXS {result.version}" + (f" by {result.application}" if result.application else "")
    case = f", load case {result.load_case}" if result.load_case else ""
    notes = [
        f"{result.shafts} shafts, {result.gears} gears, {result.meshes} meshes, {result.bearings} bearings",
        "",
        *_assumed(result.assumptions),
        "",
        f"{len(result.assumptions)} assumptions; each stands as a comment in the model file",
        *notes_of(result),
    ]
    return Group(heading(result.file, f": {made}{case}"), *lines(*notes))


def _assumed(assumptions: tuple[Assumption, ...]) -> Iterator[str]:
    """One sentence for each reason; parts of one table with the same reason are counted, and named in the model file."""
    alike: dict[tuple[str, str, str], list[Assumption]] = {}
    for item in assumptions:
        table, _, rest = item.address.partition(".")
        alike.setdefault((table, rest.partition(".")[2], item.reason), []).append(item)
    for (table, key, reason), items in alike.items():
        values = list(dict.fromkeys(item.value for item in items))
        if len(items) == 1:
            yield f"assumed {items[0].address} = {values[0]}: {reason}"
        else:
            shown = values[0] if len(values) == 1 else f"{values[0]} and others"
            yield f"assumed {table}.*.{key} = {shown} ({len(items)} of them): {reason}"
