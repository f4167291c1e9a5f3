"""Numbers in the rows of a universal file, as FORTRAN programs of all kinds have written them."""

from __future__ import annotations

import re
from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from rotorgear.errors import ModelError, Problem

# Columns may touch (-1.0E+00-1.0E+00), exponents may have a D, three digits, or no letter at all (0.1-100).
_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[EeDd][+-]?\d{1,3}|[+-]\d{3}(?!\d*\.))?")


# Nothing that is measured is larger, in any unit; what is comes from columns that have run together.
_LARGEST = 1e100
_LONGEST_WHOLE = 1e10


class Where:
    """A dataset in a file, for messages about its lines."""

    def __init__(self, file: str, number: int, first_line: int) -> None:
        self.file = file
        self.number = number
        self.first_line = first_line

    def problem(self, row: int, expected: str, value: str = "") -> ModelError:
        """An error at a row of the set, counted from 1; row 0 is the set as a whole."""
        address = f"{self.file}:{self.first_line + row} (dataset {self.number})"
        return ModelError([Problem(address, value, expected)], self.file)


def numbers_in(text: str, where: Where, row: int) -> list[float]:
    """The numbers in a row.

    Raises:
        ModelError: something that is no finite number.
    """
    rest = _NUMBER.sub(" ", text).strip()
    values = [] if rest else [_value(found) for found in _NUMBER.findall(text)]
    if rest or not all(abs(value) < _LARGEST for value in values):
        raise where.problem(row, "numbers", repr(text.strip()[:60]))
    return values


def numbers_of(rows: Iterable[tuple[int, str]], where: Where) -> NDArray[np.float64]:
    """The numbers in several rows, each with its place in the set."""
    return np.array([value for row, text in rows for value in numbers_in(text, where, row)])


def whole_in(text: str, where: Where, row: int, least: int) -> list[int]:
    """The whole numbers in a row, at least so many.

    Raises:
        ModelError: fewer of them, or others.
    """
    values = numbers_in(text, where, row)
    if len(values) < least or not all(map(is_whole, values[:least])):
        raise where.problem(row, f"{least} whole numbers", repr(text.strip()[:60]))
    return [int(value) for value in values]


def is_whole(value: float) -> bool:
    """Whether a number is one that a field of ten columns can count or name something with."""
    return abs(value) < _LONGEST_WHOLE and value == int(value)


def columns(text: str, widths: Iterable[int]) -> list[str]:
    """The fields of a row by their widths, stripped."""
    fields = []
    at = 0
    for width in widths:
        fields.append(text[at : at + width].strip())
        at += width
    return fields


def _value(text: str) -> float:
    mantissa = re.fullmatch(r"([+-]?[\d.]+)([+-]\d{3})", text)
    return float(f"{mantissa[1]}e{mantissa[2]}") if mantissa else float(text.upper().replace("D", "E"))
