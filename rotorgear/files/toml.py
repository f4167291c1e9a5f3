"""TOML of others, in time that grows with its length."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator
from typing import Any

from rotorgear.files.bounds import LONGEST_TEXT, MOST_DOTS

# What a line is made of, as far as dots between parts of a key go: a part (bare or in quotes), a dot, blanks, anything else.
_PIECE = re.compile(r"""(?P<part>[A-Za-z0-9_-]++|"(?:[^"\\]|\\.)*+"|'[^']*+')|(?P<dot>\.)|(?P<blank>[ \t]++)|.""")


def tables_of(text: str) -> dict[str, Any]:
    """The tables of a text in TOML.

    Raises:
        ValueError: no TOML; a key of too many parts; brackets within brackets too deep.
    """
    for number, line in enumerate(text.split("\n"), 1):
        if line.count(".") > MOST_DOTS and _most_dots(line) > MOST_DOTS:
            raise ValueError(f"a key of more than {MOST_DOTS} parts between dots (at line {number}, column 1)")
    try:
        return tomllib.loads(text)
    except RecursionError:
        raise ValueError("brackets within brackets too deep") from None


def _most_dots(line: str) -> int:
    """The most dots that follow one another between parts."""
    most = dots = 0
    after_part = False
    for found in _PIECE.finditer(line):
        if found["dot"]:
            dots = dots + 1 if after_part else 0
            after_part = False
        elif found["part"]:
            dots = 0 if after_part else dots
            after_part = True
        elif not found["blank"]:
            dots = 0
            after_part = False
        most = max(most, dots)
    return most


def long_texts(data: Any, address: tuple[str | int, ...] = ()) -> Iterator[tuple[str | int, ...]]:
    """Where names or texts stand that are longer than any name."""
    if isinstance(data, str):
        if len(data) > LONGEST_TEXT:
            yield address
    elif isinstance(data, dict | list):
        for key, value in data.items() if isinstance(data, dict) else enumerate(data):
            if isinstance(key, str) and len(key) > LONGEST_TEXT:
                yield (*address, key)
            else:
                yield from long_texts(value, (*address, key))
