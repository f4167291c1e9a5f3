"""Numbers of the page: each is looked up in the numbers that `--json` writes, and carries the place where it stands there."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

Path = tuple[str | int, ...]
# Where the results of all analyses stand in the JSON output of a report.
RESULTS = "results"


@dataclass(frozen=True)
class Cell:
    """What stands in a table: its text; of a number also its place in the JSON output, and what it was multiplied with."""

    text: str
    key: str = ""
    factor: float = 1.0

    @property
    def is_number(self) -> bool:
        """Whether the text is a number of the JSON output."""
        return bool(self.key)


@dataclass(frozen=True)
class Table:
    """A table with a caption; the first `left` columns are words. `verdict`: number of the column that holds one, or -1."""

    caption: str
    heads: tuple[str, ...]
    rows: list[list[Cell]]
    left: int = 1
    verdict: int = -1

    def is_numeric(self, column: int) -> bool:
        """Whether a column holds numbers."""
        return any(row[column].is_number for row in self.rows)


@dataclass(frozen=True)
class Figure:
    """A picture: inline SVG or an image, and what it shows. `small`: several stand in a row."""

    caption: str
    markup: str
    small: bool = False


@dataclass
class Section:
    """A section of the page."""

    name: str
    title: str
    words: list[str] = field(default_factory=list)
    tables: list[Table] = field(default_factory=list)
    figures: list[Figure] = field(default_factory=list)


class Numbers:
    """The JSON output of a report, and cells from it."""

    def __init__(self, data: dict[str, Any]) -> None:
        self.data = data

    def at(self, *path: str | int) -> Any:
        """The value at a path."""
        value: Any = self.data
        for step in path:
            value = value[step]
        return value

    def cell(self, form: str, *path: str | int, factor: float = 1.0) -> Cell:
        """A number in a format; a dash where there is none."""
        value = self.at(*path)
        if value is None or (isinstance(value, float) and math.isnan(value)):
            return Cell("–")
        shown = value if factor == 1.0 else value * factor
        text = f"{shown:{form}}"
        if text.startswith("-") and not text.strip("-0."):
            text = text[1:]  # a zero has no sign
        return Cell(text.replace("-", "−"), pointer(path), factor)

    def word(self, *path: str | int) -> Cell:
        """A word of the output."""
        return Cell(str(self.at(*path) or ""))


def pointer(path: Path) -> str:
    """A path as a JSON pointer (RFC 6901)."""
    return "".join("/" + str(step).replace("~", "~0").replace("/", "~1") for step in path)


def words(*texts: str) -> list[Cell]:
    """Cells of words."""
    return [Cell(text) for text in texts]
