"""A universal file as its datasets: each is between two lines that hold nothing but -1 in the first six columns.

A set of binary functions (58b) has eleven lines of text, then bytes without any line ends, in which such a line may occur by
chance: its length is taken from its identifier, or from its header where the two disagree, and the one that the closing line
follows is right. Only whole lines count as -1: a coordinate -1 at the end of a row, or at its beginning, closes nothing. Numbers
in the rows are read as FORTRAN programs of all kinds have written them.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import accumulate, pairwise

import numpy as np
from numpy.typing import NDArray

from rotorgear.errors import ModelError, Problem
from rotorgear.files.numbers import is_count

_BINARY = re.compile(r"\s*58\s*[bB]")
_HEADER_LINES = 11
_MOST_HEADER_LINES = 40
# The line that closes binary data; some programs write a line end before it, which the format doesn't have.
_CLOSES = re.compile(rb"[\r\n]{0,2} {0,4}-1 *(?:[\r\n]|\Z)")
# Characters that programs write before or after the sets, and that carry no data.
_BLANK = "\x00\x1a \t\r\n"
# Columns may touch (-1.0E+00-1.0E+00), exponents may have a D, three digits, or no letter at all (0.1-100).
_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[EeDd][+-]?\d{1,3}|[+-]\d{3}(?!\d*\.))?")
# No measured value is larger in any unit; a larger number comes from columns that have run together.
_LARGEST = 1e100
_LONGEST_WHOLE = 1e10


@dataclass(frozen=True)
class Block:
    """One dataset: its file, its number, the line it begins in, its identifier and lines of text, and bytes of a binary one."""

    file: str
    number: int
    line: int
    identifier: str
    lines: tuple[str, ...]
    data: bytes | None = None

    def problem(self, row: int, expected: str, value: str = "") -> ModelError:
        """An error at a row of the set, counted from 1; row 0 is the set as a whole."""
        address = f"{self.file}:{self.line + row} (dataset {self.number})"
        return ModelError([Problem(address, value, expected)], self.file)

    def filled(self, first: int) -> list[int]:
        """The rows from one on that are not blank, counted from 1."""
        return [row for row, text in enumerate(self.lines[first - 1 :], start=first) if text.strip()]

    def numbers(self, row: int) -> list[float]:
        """The numbers in a row.

        Raises:
            ModelError: something that is no finite number.
        """
        text = self.lines[row - 1]
        rest = _NUMBER.sub(" ", text).strip()
        # An exponent without a letter: 0.1-100.
        parts = (found.upper().replace("D", "E") for found in _NUMBER.findall(text))
        values = [] if rest else [float(re.sub(r"([\d.])([+-]\d{3})\Z", r"\1e\2", part)) for part in parts]
        if rest or not all(abs(value) < _LARGEST for value in values):
            raise self.problem(row, "numbers", repr(text.strip()[:60]))
        return values

    def numbers_from(self, first: int) -> NDArray[np.float64]:
        """The numbers in all rows from one on."""
        return np.array([value for row in self.filled(first) for value in self.numbers(row)])

    def whole(self, row: int, least: int) -> list[int]:
        """The whole numbers in a row, `least` of them or more.

        Raises:
            ModelError: fewer of them, or others.
        """
        values = self.numbers(row)
        if len(values) < least or not all(map(is_whole, values[:least])):
            raise self.problem(row, f"{least} whole numbers", repr(self.lines[row - 1].strip()[:60]))
        return [int(value) for value in values]


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
            found.append(Block(name, int(number[1]), first, text, _text_lines(cursor, int(number[1]), name)))
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
    _, _, count, stated = binary_fields(identifier)
    # Fields that have run together say any number.
    lines = tuple(cursor.next_line() for _ in range(count if 0 < count <= _MOST_HEADER_LINES else _HEADER_LINES))
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
    return Block(name, 58, first, identifier, lines, cursor.data[start : start + size])


def binary_fields(identifier: str) -> list[int]:
    """Byte order, format of numbers, lines of the header and bytes of a set 58b; 0 for what its identifier does not say."""
    fields = identifier[identifier.lower().index("b") + 1 :].split()
    return ([int(field) if is_count(field) else 0 for field in fields] + [0, 0, 0, 0])[:4]


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


def is_whole(value: float) -> bool:
    """Whether a number is one that a field of ten columns can count or name something with."""
    return abs(value) < _LONGEST_WHOLE and value == int(value)


def columns(text: str, widths: Iterable[int]) -> list[str]:
    """The fields of a row by their widths, stripped."""
    return [text[start:end].strip() for start, end in pairwise(accumulate(widths, initial=0))]
