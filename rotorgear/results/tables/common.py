"""What all tables share: their look, and how an error is written."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any, Literal

from rotorgear.note import NAMED, sentences
from rotorgear.quantity import RPM_PER_RAD_S

if TYPE_CHECKING:
    from rotorgear.results.laws import LawRow
    from rotorgear.results.result import Result

# Heading of a column, the side it stands on, and what it says of a row.
Column = tuple[str, Literal["left", "right"], Callable[[Any], str]]

# What the two displacements of a contact are, beside every table that has them.
TRANSMISSION_WORDS = (
    "transmission error: rotation at the base circles, r_b1 theta_1 + r_b2 theta_2; approach: of the flanks, transverse, with "
    "bending and axial motion"
)


def heading(title: str, rest: str = "") -> Any:
    """A title in bold, and what follows it on the line; brackets in it are no markup."""
    from rich.text import Text

    return Text.assemble((title, "bold"), rest)


def lines(*texts: str) -> list[Any]:
    """Sentences as they are: brackets in them are no markup."""
    from rich.text import Text

    return [Text(text) for text in texts]


def table(*names: str, left: int = 1, no_wrap: bool = False) -> Any:
    """An empty table without lines; the first columns stand to the left, the others to the right."""
    from rich.table import Table

    out = Table(box=None, pad_edge=False, header_style="bold")
    for number, name in enumerate(names):
        out.add_column(name, justify="left" if number < left else "right", no_wrap=no_wrap)
    return out


def plain_table(title: str = "") -> Any:
    """An empty table without lines, its title in bold above it."""
    from rich.table import Table

    return Table(
        box=None,
        pad_edge=False,
        title=f"\n{title}" if title else None,
        title_justify="left",
        title_style="bold",
        header_style="bold",
    )


def table_of(rows: Iterable[Any], *columns: Column, title: str = "") -> Any:
    """A table of records, a line for each; long texts are folded."""
    out = plain_table(title)
    for name, justify, _ in columns:
        out.add_column(name, justify=justify, overflow="fold")
    for row in rows:
        out.add_row(*(cell(row) for _, _, cell in columns))
    return out


def error_words(value: float) -> str:
    """A small relative error in one digit; what rounding alone decides is not told apart."""
    return "<1e-9" if value < 1e-9 else f"{value:.0e}"


def notes_of(result: Result) -> list[str]:
    """What every table ends with: what the analysis left out, and its warnings, one sentence for each cause."""
    return [
        *(f"left out: {text}" for text in sentences(result.left_out, named=NAMED)),
        *(f"Warning: {text}" for text in sentences(result.warnings, named=NAMED)),
    ]


def operating_points(rows: Sequence[LawRow]) -> Any:
    """Force, deflection and stiffness of each across the shaft, in the direction of the force, and along z.

    "mean" stands behind those that are averaged over a pitch of rolling elements.
    """
    out = table("operating point", "rpm", "F N", "moves um", "N/um", "Fz N", "z um", "z N/um")
    for row in rows:
        # What is rounding of the largest component is shown as none.
        least = 1e-6 * max(map(abs, row.force), default=0.0)
        across = (row.load, 1e6 * row.deflection, 1e-6 * row.along_load) if row.load > least else None
        along = None
        if len(row.force) >= 3 and abs(row.force[2]) > least:
            along = (row.force[2], 1e6 * row.displacement[2], 1e-6 * row.stiffness[2, 2])
        numbers = [f"{x:.4g}" for x in across or ()] or ["-", f"{1e6 * row.deflection:.4g}", "-"]
        speed = "-" if row.speed is None else f"{row.speed * RPM_PER_RAD_S:.6g}"
        out.add_row(
            row.part + (", mean" if row.averaged else ""),
            speed,
            *numbers,
            *([f"{x:.4g}" for x in along] if along else "---"),
        )
    return out
