"""What all tables share: their look, and how an error is written."""

from __future__ import annotations

from typing import Any


def table(*names: str, left: int = 1) -> Any:
    """An empty table without lines; the first columns stand to the left, the others to the right."""
    from rich.table import Table

    out = Table(box=None, pad_edge=False, header_style="bold")
    for number, name in enumerate(names):
        out.add_column(name, justify="left" if number < left else "right")
    return out


def error_words(value: float) -> str:
    """A small relative error in one digit; what rounding alone decides is not told apart."""
    return "<1e-9" if value < 1e-9 else f"{value:.0e}"
