"""Measures what a line of expected.csv asks of the gear sheet: "sheet gears.pinion.base_diameter_m" is that key of that row."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

import rotorgear as rg
from rotorgear.errors import AnalysisError

if TYPE_CHECKING:
    from pathlib import Path

KIND = "sheet "


def is_of_sheet(quantity: str) -> bool:
    """Whether a quantity belongs to the gear sheet, not to modes."""
    return quantity.startswith(KIND)


def measure_sheet(folder: Path, model: str, quantity: str) -> tuple[float, float]:
    """Return a number of the gear sheet and the seconds it took.

    Raises:
        AnalysisError: the sheet has no such row or number.
    """
    start = time.perf_counter()
    table, name, key = quantity.removeprefix(KIND).split(".")
    rows = [row for row in rg.gear(rg.load(folder / model)).to_dict()[table] if row["name"] == name]
    if not rows or rows[0].get(key) is None:
        raise AnalysisError(f"{model}: the gear sheet has no {quantity.removeprefix(KIND)}")
    return float(rows[0][key]), time.perf_counter() - start


def sheet_words(quantity: str) -> str:
    """Return a quantity of the sheet as a reader writes it: "pinion: base diameter m"."""
    _, name, key = quantity.removeprefix(KIND).split(".")
    return f"{name}: {key.replace('_', ' ')}"
