"""Measured flanks: deviations over roll length or diameter and face, read from a CSV file or given as numbers.

One header row, one point a row, comma, semicolon or tab between the cells; blank rows and rows that start with # are skipped.
Columns: `roll_length` or `diameter`, `z` and `deviation`, each with its unit in the header (`roll_length_mm`, `z (mm)`,
`deviation_um`); `tooth` and `flank` (left or right) where the points belong to one tooth or one side. The points of each tooth
and side make a whole grid, in any order. Deviations are positive where material stands out, as measuring machines print them
(ISO 1328-1); z is measured from the middle of the face.
"""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any, Literal, TypeVar

from pydantic import BeforeValidator, Field, WithJsonSchema

from rotorgear.files.bounds import LONGEST_TEXT, MOST_ROWS, TABLE
from rotorgear.files.numbers import is_count, number_of
from rotorgear.files.read import UnreadableError, read_text
from rotorgear.model.parts.fields import Length, Part, refuse
from rotorgear.quantity import QuantityError, did_you_mean, parse_quantity

Column = TypeVar("Column")
# In the order of a gear's hand: typing keeps one object for both, and the texts of errors take its order.
Side = Literal["right", "left"]
_LENGTHS = ("roll_length", "diameter", "z", "deviation")
_COLUMNS = (*_LENGTHS, "tooth", "flank")
# Units of a header, as the quantities know them: both letters for micro are in use.
_UNITS = {"m": "m", "mm": "mm", "um": "um", "\u00b5m": "um", "\u03bcm": "um"}


class MeasuredGrid(Part):
    """Deviations of one flank, or of all flanks alike, on a grid."""

    tooth: int | None = Field(None, description="number of the tooth; default: all teeth")
    flank: Side | None = Field(None, description="side of the tooth; default: both")
    places: tuple[Length, ...] = Field(description="roll lengths or diameters, rising")
    z: tuple[Length, ...] = Field(description="places along the face from its middle, rising")
    deviation: tuple[tuple[Length, ...], ...] = Field(
        description="a row for each place, positive where material stands out"
    )


class Topography(Part):
    """Measured deviations of a gear's flanks."""

    by: Literal["roll_length", "diameter"] = Field(description="what the places of the grids are")
    grids: tuple[MeasuredGrid, ...] = Field(description="one for each tooth and side that was measured")


def parse_topography(text: str, name: str) -> dict[str, Any]:
    """Fields of a `Topography` from the text of a CSV file.

    Args:
        text: of the file.
        name: what errors call it.

    Raises:
        PydanticCustomError: what is wrong, with line and column; `Model` makes a `Problem` of it.
    """
    columns, rows = csv_table(text, name, "point, such as roll_length_mm,z_mm,deviation_um", _column)
    names = [column for column, _ in columns]
    repeated = {column for column in names if names.count(column) > 1}
    if repeated:
        raise refuse(f"each column once; {name} has '{min(repeated)}' twice")
    by = [column for column in ("roll_length", "diameter") if column in names]
    missing = [column for column in ("z", "deviation") if column not in names]
    if len(by) != 1 or missing:
        wanted = "one column of roll_length or diameter, one of z and one of deviation"
        units = "roll_length_mm, z_mm, deviation_um"
        raise refuse(f"{wanted}, with units: {units}; {name} has {', '.join(names)}")

    # The points of each tooth and side, by place and z.
    flanks: dict[tuple[int | None, str | None], dict[tuple[float, float], float]] = {}
    for line, cells in rows:
        found = {column: _cell(cell, column, unit, line) for cell, (column, unit) in zip(cells, columns, strict=True)}
        points = flanks.setdefault((found.get("tooth"), found.get("flank")), {})
        place = (found[by[0]], found["z"])
        if place in points:
            raise refuse(f"each point of a flank once; {line} repeats one")
        points[place] = found["deviation"]
    # The points of each flank fill a grid.
    grids = []
    for (tooth, side), points in flanks.items():
        places = sorted({place for place, _ in points})
        z = sorted({station for _, station in points})
        lacking = len(places) * len(z) - len(points)
        if lacking:
            # The first one: it is found after as many steps as there are points.
            first = next((place, station) for place in places for station in z if (place, station) not in points)
            whose = " ".join([*([] if tooth is None else [f"tooth {tooth}"]), *([f"{side} flank"] if side else [])])
            where = f"{1e3 * first[0]:g} mm at z = {1e3 * first[1]:g} mm"
            raise refuse(
                f"a whole grid, each place at each z; {name}{f' ({whose})' if whose else ''} lacks {lacking} of "
                f"{len(places)} x {len(z)} points, the first {where}"
            )
        rows_of_z = [[points[place, station] for station in z] for place in places]
        grids.append({"tooth": tooth, "flank": side, "places": places, "z": z, "deviation": rows_of_z})
    return {"by": by[0], "grids": grids}


def from_csv(value: Any, what: str, parse: Callable[[str, str], Any]) -> Any:
    """A path becomes what `parse(text, name)` makes of its file; numbers stay. `what` the file holds is for the error."""
    if not isinstance(value, str):
        return value
    try:
        text = read_text(value, TABLE.most_bytes)
    except UnreadableError as error:
        if error.missing:
            raise refuse(f"a CSV file of {what}; there is no '{value}'") from None
        raise refuse(f"a CSV file of {what}; '{error.path.name}' can't be read: {error.reason}") from None
    return parse(text, Path(value).name)


def csv_table(
    text: str, name: str, example: str, column: Callable[[str, str], Column]
) -> tuple[list[Column], list[tuple[str, list[str]]]]:
    """What `column(cell, line)` makes of each cell of the header, and where each other row is, with its stripped cells.

    Rows say something, with a cell for each column; `example` is for the error.
    """
    written = [(f"{name}:{n}", line) for n, line in enumerate(text.splitlines(), 1) if not re.match(r"\s*(#|$)", line)]
    if len(written) < 2:
        raise refuse(f"a header and at least one {example}; {name} has none")
    if len(written) > MOST_ROWS:
        raise refuse(f"up to {MOST_ROWS} rows; {name} has {len(written) - 1}")
    delimiter = max(";\t,", key=written[0][1].count)

    def cells_of(line: str, where: str) -> list[str]:
        """The cells of a line; none is longer than any name."""
        try:
            cells = [cell.strip() for cell in next(csv.reader([line], delimiter=delimiter))]
        except csv.Error as error:
            raise refuse(f"cells that can be read; {where}: {error}") from None
        if max(map(len, cells)) > LONGEST_TEXT:
            raise refuse(f"cells of up to {LONGEST_TEXT} letters; {where} has a longer one")
        return cells

    (head, header), *rows = [(where, cells_of(line, where)) for where, line in written]
    columns = [column(cell, head) for cell in header]
    for where, cells in rows:
        if len(cells) != len(columns):
            raise refuse(f"{len(columns)} cells in each row; {where} has {len(cells)}")
    return columns, rows


def _column(cell: str, line: str) -> tuple[str, str]:
    """Name and unit of a column from its header: roll_length_mm, roll_length (mm), roll_length [mm]."""
    words = [word for word in re.split(r"[\s_()\[\]]+", cell.lower()) if word]
    unit = words.pop() if words and words[-1] in _UNITS else ""
    column = "_".join(words)
    if column not in _COLUMNS:
        hint = did_you_mean(column, _COLUMNS, f"there are {', '.join(_COLUMNS)}")
        raise refuse(f"columns that are known; {line} has '{cell}' ({hint})")
    if column in _LENGTHS and not unit:
        example = f"{column}_{'um' if column == 'deviation' else 'mm'}"
        raise refuse(f"the unit of '{column}' in its header, such as {example}; {line}")
    return column, _UNITS.get(unit, "")


def _cell(cell: str, column: str, unit: str, line: str) -> Any:
    """Number (m), tooth or side of one cell; an empty tooth or side means all."""
    if column == "flank":
        if cell.lower() not in ("", "left", "right"):
            raise refuse(f"left or right as flank; {line} has '{cell}'")
        return cell.lower() or None
    if column == "tooth":
        if cell and not is_count(cell):
            raise refuse(f"the number of a tooth from 0 on; {line} has '{cell}'")
        return int(cell) if cell else None
    try:
        value = parse_quantity(f"{number_of(cell)!r} {unit}", "length")
    except (ValueError, QuantityError):
        value = math.nan
    if not math.isfinite(value):
        raise refuse(f"a number as {column}; {line} has '{cell}'") from None
    return value


TopographyFile = Annotated[
    Topography,
    BeforeValidator(lambda value: from_csv(value, "measured flanks", parse_topography)),
    WithJsonSchema({"type": "string", "description": "CSV file of measured flanks, beside the model file"}),
]
