"""Tables of text that people write: CSV with comma, semicolon or tab, as numbered rows of cells."""

from __future__ import annotations

import csv
from pathlib import Path

from rotorgear.errors import ModelError, Problem
from rotorgear.files.bounds import LONGEST_TEXT, MOST_ROWS, TABLE
from rotorgear.files.read import UnreadableError, read_text


def csv_rows(file: Path, expected: str) -> tuple[str, list[tuple[int, list[str]]]]:
    """Return the delimiter, and (line number, stripped cells) of every row that says something, the header first.

    Cells are separated by comma, semicolon or tab; blank rows and rows that start with # are skipped.

    Args:
        file: to be read.
        expected: what it ought to be, for the error.

    Raises:
        ModelError: no such file, no text in UTF-8, a quote that is not closed in its line.
    """
    try:
        text = read_text(file, TABLE.most_bytes)
    except UnreadableError as error:
        raise ModelError([Problem(file.name, "", expected, error.reason)], str(file)) from None
    numbered = enumerate(text.splitlines(), start=1)
    lines = [(number, line) for number, line in numbered if line.strip() and not line.lstrip().startswith("#")]
    if len(lines) > MOST_ROWS:
        raise ModelError([Problem(file.name, "", f"up to {MOST_ROWS} rows; it has {len(lines)}")], str(file))
    # The header tells the delimiter: below it, commas may also be in numbers and labels.
    delimiter = max(",;\t", key=lines[0][1].count if lines else len)
    rows = []
    for number, line in lines:
        # Line by line: no cell goes on over the next one, so a quote that is not closed can't swallow the rest of the file.
        try:
            cells = [
                cell.strip()
                for cell in next(csv.reader([line], delimiter=delimiter, skipinitialspace=True, strict=True))
            ]
        except csv.Error:
            closed = "every quote closed in its line, and nothing behind it in its cell"
            raise ModelError([Problem(f"{file.name}:{number}", repr(line), closed)], str(file)) from None
        if max(map(len, cells), default=0) > LONGEST_TEXT:
            raise ModelError(
                [Problem(f"{file.name}:{number}", "", f"cells of up to {LONGEST_TEXT} letters")], str(file)
            )
        if any(cells):
            rows.append((number, cells))
    return delimiter, rows
