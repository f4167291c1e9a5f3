"""Tables as the terminal shows them."""

from __future__ import annotations

import io
from typing import Any

import pytest
from rich.console import Console

from rotorgear.results.table import Block, Line, as_rich, grid, short, written


def shown(*blocks: Block, width: int = 40) -> str:
    out = io.StringIO()
    Console(file=out, width=width, highlight=False).print(as_rich(blocks))
    return out.getvalue()


@pytest.mark.parametrize("look", [{}, {"ruled": True}, {"titled": True, "caption": "what they are"}])
def test_no_line_of_a_table_or_of_a_text_ends_in_blanks(look: dict[str, Any]) -> None:
    table = grid(
        [("a", "1", "short"), ("b", "20", "words of another length"), ("", "", "")], "k", "n", "w", last=True, **look
    )
    text = shown(Line("A title", ", and the rest of it, which the screen has to break"), "", table, "more words " * 12)
    assert "words of another" in text
    assert [line for line in text.splitlines() if line != line.rstrip()] == []


def test_an_empty_line_between_blocks_stays() -> None:
    assert shown("one", "", "two") == "one\n\ntwo\n"


def test_a_zero_has_no_sign_in_whatever_form() -> None:
    assert written(-0.0, ".5g") == written(-1e-9, ".2f").replace("0.00", "0") == short(-0.0) == "0"
