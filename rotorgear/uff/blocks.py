"""A universal file as its datasets: each stands between two lines that hold nothing but -1 in the first six columns.

A set of binary functions (58b) has eleven lines of text, then bytes without any line ends, in which such a line may occur by
chance: its length is taken from its identifier, or from its header where the two disagree, and the one that the closing line
follows is right. Only whole lines count as -1: a coordinate -1 at the end of a row, or at its beginning, closes nothing.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from rotorgear.errors import ModelError, Problem

_BINARY = re.compile(r"\s*58\s*[bB]")
_HEADER_LINES = 11
_MOST_HEADER_LINES = 40
# The line that closes binary data; some programs write a line end before it, which the format doesn't have.
_CLOSES = re.compile(rb"[\r\n]{0,2} {0,4}-1 *(?:[\r\n]|\Z)")
# What programs write before or after the sets; nothing is lost with it.
_BLANK = "\x00\x1a \t\r\n"


@dataclass(frozen=True)
class Block:
    """One dataset: its number, the line of the file it begins in, its identifier and lines of text, and bytes of a binary one."""

    number: int
    line: int
    identifier: str
    lines: tuple[str, ...]
    data: bytes | None = None


@dataclass
class _Cursor:
    """A place in the bytes of a file, moved line by line."""

    data: bytes
    at: int = 0
    line: int = 0

    @property
    def ended(self) -> bool:
        return self.at >= len(self.data)

    def next_line(self) -> str:
        """The line here, without its end, which may be CR LF, LF or CR."""
        found = re.compile(rb"\r\n|\n|\r").search(self.data, self.at)
        end, after = found.span() if found else (len(self.data), len(self.data))
        text = self.data[self.at : end].decode("latin-1")
        self.at = after
        self.line += 1
        return text


def blocks_of(data: bytes, name: str) -> list[Block]:
    """Return the datasets of a file.

    Args:
        data: of the file.
        name: of the file, for messages.

    Raises:
        ModelError: text outside of datasets, a set without a number, one that is not closed.
    """
    cursor = _Cursor(data)
    found = []
    while not cursor.ended:
        text = cursor.next_line()
        if not text.strip(_BLANK):
            continue
        if not _is_mark(text):
            raise _problem(name, cursor.line, "a line with -1 before each dataset", repr(text.strip()[:40]))
        # Two marks in a row are an empty set: the second may open the next one.
        while _is_mark(text) and not cursor.ended:
            text = cursor.next_line()
        if _is_mark(text) or not text.strip(_BLANK):
            continue
        number = re.match(r"\s*(\d+)", text)
        if number is None:
            raise _problem(name, cursor.line, "the number of a dataset after -1", repr(text.strip()[:40]))
        first = cursor.line
        if _BINARY.match(text):
            found.append(_binary(cursor, text, name))
        else:
            found.append(Block(int(number[1]), first, text, _text_lines(cursor, int(number[1]), name)))
    return found


def _text_lines(cursor: _Cursor, number: int, name: str) -> tuple[str, ...]:
    """The lines up to the closing one."""
    first = cursor.line
    lines: list[str] = []
    while not cursor.ended:
        text = cursor.next_line()
        if _is_mark(text):
            return tuple(lines)
        lines.append(text)
    raise _problem(name, first, f"dataset {number} is not closed by -1: the file is cut")


def _binary(cursor: _Cursor, identifier: str, name: str) -> Block:
    """A set 58b with the cursor behind its identifier."""
    first = cursor.line
    fields = identifier[identifier.lower().index("b") + 1 :].split()
    numbers = [int(field) if field.isdigit() else 0 for field in fields]
    stated = numbers[3] if len(numbers) > 3 else 0
    # Fields that have run together say any number.
    count = numbers[2] if len(numbers) > 2 and 0 < numbers[2] <= _MOST_HEADER_LINES else _HEADER_LINES
    lines = tuple(cursor.next_line() for _ in range(count))
    start = cursor.at
    for size in (stated, *sizes_of(lines)):
        closing = _CLOSES.match(cursor.data, start + size) if 0 < size < len(cursor.data) else None
        if closing:
            break
    else:
        closing = _CLOSES.search(cursor.data, start)
        if closing is None:
            raise _problem(name, first, "dataset 58b is not closed by -1: the file is cut")
        size = closing.start() - start
    cursor.at = closing.end()
    cursor.line += 1
    return Block(58, first, identifier, lines, cursor.data[start : start + size])


def sizes_of(lines: tuple[str, ...]) -> tuple[int, ...]:
    """Bytes of binary data by the header of a function: the layouts that programs write.

    An abscissa of its own is single by the published columns (E13.5 beside E20.12), and double in most files of double functions.
    """
    fields = lines[6].split() if len(lines) > 6 else []
    try:
        kind, count, even = (int(field) for field in fields[:3])
    except ValueError:
        return ()
    bytes_each = 8 if kind in (4, 6) else 4
    values = 2 if kind in (5, 6) else 1
    if even:
        return (count * values * bytes_each,)
    return (count * (values + 1) * bytes_each, count * (values * bytes_each + 4))


def _is_mark(text: str) -> bool:
    return text[:6].strip() == "-1" and not text[6:].strip(_BLANK)


def _problem(name: str, line: int, expected: str, value: str = "") -> ModelError:
    return ModelError([Problem(f"{name}:{line}", value, expected)], name)
