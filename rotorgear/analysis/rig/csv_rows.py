"""Rows of the CSV tables that come with a rig: its lines, its sensors, its order cuts."""

from __future__ import annotations

import csv
from pathlib import Path

from rotorgear.errors import ModelError, Problem


def csv_rows(file: Path, expected: str) -> tuple[str, list[tuple[int, list[str]]]]:
    """Return the delimiter, and (line number, stripped cells) of every row that says something, the header first.

    Comma, semicolon or tab stand between the cells; blank rows and rows that start with # are skipped.

    Args:
        file: to be read.
        expected: what it ought to be, for the error.

    Raises:
        ModelError: no such file, no text in UTF-8, a quote that is not closed in its line.
    """
    try:
        text = file.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        raise ModelError([Problem(file.name, "", expected, reason)], str(file)) from error
    # A comment becomes an empty line, so that the numbers of lines stay those of the file.
    lines = ["" if line.lstrip().startswith("#") else line for line in text.splitlines()]
    # The header tells the delimiter: below it, commas may also stand in numbers and labels.
    delimiter = max(",;\t", key=next((line for line in lines if line.strip()), "").count)
    rows = []
    for number, line in enumerate(lines, start=1):
        # Line by line: no cell goes on over the next one, so a quote that is not closed can't swallow the rest of the file.
        try:
            cells = next(csv.reader([line], delimiter=delimiter, skipinitialspace=True, strict=True), [])
        except csv.Error:
            closed = "every quote closed in its line, and nothing behind it in its cell"
            raise ModelError([Problem(f"{file.name}:{number}", repr(line), closed)], str(file)) from None
        rows.append((number, [cell.strip() for cell in cells]))
    return delimiter, [(number, cells) for number, cells in rows if any(cells)]
