"""What all tables share: their look, and how an error is written."""

from __future__ import annotations

from typing import Any


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


def error_words(value: float) -> str:
    """A small relative error in one digit; what rounding alone decides is not told apart."""
    return "<1e-9" if value < 1e-9 else f"{value:.0e}"
