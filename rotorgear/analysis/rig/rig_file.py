"""Read the CSV tables that come with a rig, and the measured lines among them.

One header row, one line a row; blank rows and rows that start with # are skipped; comma, semicolon or tab between the cells.
Beside semicolons or tabs, numbers may have a decimal comma (`361,5`), as spreadsheets write them in many countries. Columns of
measured lines: `frequency` (needed), `label`, `uncertainty`, `damping`. A unit may be in the header (`frequency_hz`,
`frequency (kHz)`, `damping [%]`) or in the cell ("361 Hz", "2 %"), which wins; plain numbers are Hz, Hz of uncertainty, and a
damping ratio as a fraction.
"""

from __future__ import annotations

import csv
import re
from dataclasses import dataclass, field
from pathlib import Path

from rotorgear.errors import ModelError, Problem
from rotorgear.quantity import QuantityError, nearest, parse_quantity
from rotorgear.results.comparison import RigLine


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


# Column -> units that its header may carry, the first being that of a plain number.
_UNITS = {
    "frequency": ("Hz", "kHz", "rpm"),
    "label": (),
    "uncertainty": ("Hz", "kHz", "%"),
    "damping": ("", "%"),
}
_ALIASES = {"damping_ratio": "damping", "damping_percent": "damping_%", "uncertainty_percent": "uncertainty_%"}
_FIELDS = {"frequency_hz": "frequency", "uncertainty_hz": "uncertainty", "damping_ratio": "damping"}
_EXPECTED = {
    "frequency": "a positive frequency such as '361 Hz'",
    "uncertainty": "an uncertainty such as '2 Hz' or '1 %'",
    "damping": "a damping ratio such as 0.012 or '1.2 %'",
}

# A whole cell: a number, and perhaps its unit.
_DECIMAL = re.compile(r"([+-]?[0-9]+)([.,])([0-9]+(?:[eE][+-]?[0-9]+)?\s*[A-Za-z/%]*)\Z")


@dataclass(frozen=True)
class _Column:
    """A column by its meaning, with the unit of its plain numbers."""

    name: str
    unit: str


def read_rig_lines(path: str | Path) -> tuple[RigLine, ...]:
    """Return the rig lines of a CSV file in the order of the file; frequencies and uncertainties in Hz.

    Args:
        path: of the file, with a header row.

    Returns:
        The lines.

    Raises:
        ModelError: every mistake of the file at once, each with file, line and column: no such file, no frequency
            column, unknown or repeated columns, numbers that are none, negative or NaN, frequencies given twice, no
            lines at all.
    """
    file = Path(path)
    delimiter, rows = csv_rows(file, "a readable CSV file in UTF-8")
    if not rows:
        raise _one_problem(file, "", "a header row and at least one line, such as 'frequency_hz' and below it '361'")
    (header_line, header), *body = rows
    table = _Table(file.name, _columns(header, f"{file.name}:{header_line}", file), delimiter)
    lines = [table.read(number, cells) for number, cells in body]
    if not body:
        raise _one_problem(file, "", "at least one rig line below the header")
    if table.problems:
        raise ModelError(table.problems, str(file))
    return tuple(line for line in lines if line)


def _one_problem(file: Path, value: str, expected: str, hint: str = "") -> ModelError:
    return ModelError([Problem(file.name, value, expected, hint)], str(file))


def _columns(header: list[str], where: str, file: Path) -> list[_Column | None]:
    """Return the meaning of every column; an unnamed one is None."""
    problems: list[Problem] = []
    columns = [_column(name, where, problems) if name else None for name in header]
    names = [column.name for column in columns if column]
    problems += [
        Problem(where, f"{names.count(name)} columns for {name}", "one") for name in _UNITS if names.count(name) > 1
    ]
    if "frequency" not in names:
        hint = "" if problems else f"columns found: {', '.join(header)}"
        problems.append(Problem(where, "", "a column 'frequency' or 'frequency_hz'", hint))
    if problems:
        raise ModelError(problems, str(file))
    return columns


def _column(text: str, where: str, problems: list[Problem]) -> _Column | None:
    key = re.sub(r"[\s_]*[\[(]\s*(.*?)\s*[\])]\Z", r"_\1", text).strip().replace(" ", "_").lower()
    name, _, unit = _ALIASES.get(key, key).partition("_")
    units = _UNITS.get(name)
    if units is not None and not unit:
        return _Column(name, units[0] if units else "")
    known = {candidate.lower(): candidate for candidate in units or ()}
    if unit in known:
        return _Column(name, known[unit])
    valid = ["frequency", "frequency_hz", "label", "uncertainty", "uncertainty_hz", "damping", "damping_ratio"]
    close = nearest(text, valid)
    hint = f"did you mean '{close}'?" if close else ""
    problems.append(Problem(f"{where}:{text}", "", "one of the columns frequency, label, uncertainty, damping", hint))
    return None


@dataclass
class _Table:
    """The rows below the header: what they give, and the problems met on the way."""

    file: str
    columns: list[_Column | None]
    delimiter: str
    problems: list[Problem] = field(default_factory=list)
    first_line: dict[str, int] = field(default_factory=dict)
    decimal_sign: tuple[str, int] | None = None  # and the line that has it first

    def read(self, number: int, cells: list[str]) -> RigLine | None:
        """Return the rig line in line `number` of the file, or None with its problems noted."""
        before = len(self.problems)
        given = self._given(number, cells)
        values = {name: self._number(number, name, *given[name]) for name in _EXPECTED if name in given}
        if len(self.problems) > before:
            return None
        return self._line(number, given, values)

    def _note(self, number: int, name: str, value: str, expected: str, hint: str = "") -> None:
        address = ":".join(filter(None, (self.file, str(number), name)))
        self.problems.append(Problem(address, value, expected, hint))

    def _given(self, number: int, cells: list[str]) -> dict[str, tuple[str, str]]:
        """Return column name -> (cell, unit of a plain number) of the cells that are filled in."""
        columns = self.columns + [None] * len(cells)
        filled = [(column, cell) for column, cell in zip(columns, cells, strict=False) if cell]
        stray = [cell for column, cell in filled if column is None]
        given = {column.name: (cell, column.unit) for column, cell in filled if column}
        if stray:
            hint = "a decimal comma needs semicolons between the cells; a label with a comma needs quotes"
            self._note(number, "", repr(stray[0]), "no cell without a column in the header", hint)
        elif "frequency" not in given:
            self._note(number, "frequency", "nothing", _EXPECTED["frequency"])
        return given

    def _number(self, number: int, name: str, cell: str, unit: str) -> tuple[float, bool]:
        """Return the value in SI, and whether it is a share (given in %)."""
        cell = self._with_decimal_point(number, name, cell)
        plain = _is_plain(cell)
        is_share = unit == "%" if plain else cell.endswith("%")
        dimension = "ratio" if is_share or name == "damping" else "frequency"
        try:
            return parse_quantity(f"{cell} {unit}" if plain else cell, dimension), is_share
        except QuantityError:
            self._note(number, name, repr(cell), _EXPECTED[name])
            return 0.0, is_share

    def _with_decimal_point(self, number: int, name: str, cell: str) -> str:
        """The cell with a decimal comma written as a point; a file that has both may mean a thousand by 1,234."""
        found = _DECIMAL.match(cell)
        if found is None or found[2] == self.delimiter:
            return cell
        first, line = self.decimal_sign = self.decimal_sign or (found[2], number)
        if found[2] != first:
            self._note(number, name, repr(cell), "one decimal sign in a file", f"line {line} has '{first}'")
        return f"{found[1]}.{found[3]}"

    def _line(
        self, number: int, given: dict[str, tuple[str, str]], values: dict[str, tuple[float, bool]]
    ) -> RigLine | None:
        frequency = values["frequency"][0]
        uncertainty, is_share = values.get("uncertainty", (None, False))
        if uncertainty is not None and is_share:
            uncertainty *= frequency
        label = given.get("label", ("", ""))[0]
        damping = values.get("damping", (None, False))[0]
        try:
            line = RigLine(frequency, label, uncertainty, damping)
        except ModelError as error:
            for problem in error.problems:
                name = _FIELDS[problem.address]
                self._note(number, name, repr(given[name][0]), problem.expected)
            return None
        first = self.first_line.setdefault(f"{frequency:.9g}", number)
        if first != number:
            hint = f"it stands in line {first}"
            self._note(number, "frequency", repr(given["frequency"][0]), "every frequency once", hint)
        return line


def _is_plain(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return True
