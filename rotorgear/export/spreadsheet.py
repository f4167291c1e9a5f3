"""The tables of a result as a workbook (XLSX): a sheet each, numbers with all their digits where the result has them."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from rotorgear.extras import require
from rotorgear.files.write import written
from rotorgear.results.result import Result
from rotorgear.results.table import Cell, Table

_LONGEST_NAME = 31  # of a sheet, for all programs
_WIDEST = 60


def write_xlsx(result: Result, path: str | Path) -> Path:
    """Write the tables of a result, as the terminal shows them, into a workbook.

    A number is that of the JSON output in the unit of its column; what is text stays text, whatever it begins with.

    Args:
        result: of any analysis.
        path: of the file, such as "modes.xlsx".

    Raises:
        MissingExtraError: openpyxl is not installed. WriteError: the file can't be written.
    """
    require("openpyxl", "A workbook")
    from openpyxl import Workbook
    from openpyxl.styles import Font
    from openpyxl.utils import get_column_letter

    target = Path(path)
    data = result.to_dict()
    book = Workbook()
    book.remove(book.active)
    for table in (one for one in result.tables() if isinstance(one, Table)):
        sheet = book.create_sheet(_name(table.caption or result.kind, book.sheetnames))
        for c, column in enumerate(table.columns, 1):
            head = sheet.cell(1, c)
            _text(head, (column.label or column.heading).replace("\n", " "))
            head.font = Font(bold=True)
            shown = [cell.text for cell in (row[c - 1] for row in table.rows)]
            sheet.column_dimensions[get_column_letter(c)].width = min(
                _WIDEST, 2 + max(map(len, [str(head.value), *shown]))
            )
        for r, row in enumerate(table.rows, 2):
            for c, cell in enumerate(row, 1):
                number = _number(cell, data)
                if number is None:
                    _text(sheet.cell(r, c), cell.text)
                else:
                    sheet.cell(r, c, number)
        sheet.freeze_panes = "A2"
    if not book.sheetnames:
        book.create_sheet(_name(result.kind, ()))
    with written(target) as scratch:
        book.save(scratch)
    return target


def _text(cell: Any, text: str) -> None:
    """A text that no program takes for a formula."""
    cell.value = re.sub(r"[\x00-\x08\x0b\x0c\x0e-\x1f]", " ", text)
    cell.data_type = "s"


def _number(cell: Cell, data: Any) -> float | int | None:
    """The number of a cell: from its place in the JSON output, else as it is shown; None for words and what is not known."""
    if not cell.number:
        return None
    value: Any = data if cell.path else None
    for step in cell.path:
        try:
            value = value[step]
        except (KeyError, IndexError, TypeError):
            value = None
            break
    if isinstance(value, int | float) and not isinstance(value, bool):
        return value if cell.factor == 1.0 else value * cell.factor
    try:
        return float(cell.text) if re.search(r"[.eE]", cell.text) else int(cell.text)
    except ValueError:
        return None


def _name(caption: str, taken: Any) -> str:
    """A name of a sheet that all programs take: short, without their signs, and not there yet."""
    name = re.sub(r"[\[\]:*?/\\']", " ", caption).strip()[:_LONGEST_NAME] or "table"
    number = 1
    while name.lower() in [one.lower() for one in taken]:
        number += 1
        name = f"{name[: _LONGEST_NAME - 4].rstrip('0123456789 ')} {number}"
    return name
