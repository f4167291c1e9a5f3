"""Read the CSV tables that come with a rig, and the measured lines among them.

One header row, one line a row; blank rows and rows that start with # are skipped; comma, semicolon or tab between the cells.
Beside semicolons or tabs, numbers may have a decimal comma (`361,5`), as spreadsheets write them in many countries. Columns of
measured lines: `frequency` (needed), `label`, `uncertainty`, `damping`. A unit may be in the header (`frequency_hz`,
`frequency (kHz)`, `damping [%]`) or in the cell ("361 Hz", "2 %"), which wins; plain numbers are Hz, Hz of uncertainty, and a
damping ratio as a fraction.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path

from rotorgear.errors import AnalysisError, ModelError, Problem
from rotorgear.files.rows import csv_rows
from rotorgear.files.write import written
from rotorgear.quantity import QuantityError, did_you_mean, parse_quantity
from rotorgear.results.comparison import RigLine

# Column -> units that its header may carry, the first being that of a plain number.
_UNITS = {
    "frequency": ("Hz", "kHz", "rpm"),
    "label": (),
    "uncertainty": ("Hz", "kHz", "%"),
    "damping": ("", "%"),
}
_ALIASES = {"damping_ratio": "damping", "damping_percent": "damping_%", "uncertainty_percent": "uncertainty_%"}
# Of a column: a pattern with blanks on both sides of what it looks for takes time by the cube of its length.
_LONGEST_HEADING = 100
_FIELDS = {"frequency_hz": "frequency", "uncertainty_hz": "uncertainty", "damping_ratio": "damping"}
_EXPECTED = {
    "frequency": "a positive frequency such as '361 Hz'",
    "uncertainty": "an uncertainty such as '2 Hz' or '1 %'",
    "damping": "a damping ratio such as 0.012 or '1.2 %'",
}

# A whole cell: a number, and perhaps its unit.
_DECIMAL = re.compile(r"([+-]?[0-9]+)([.,])([0-9]+(?:[eE][+-]?[0-9]+)?\s*[A-Za-z/%]*)\Z")


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
        raise _one_problem(file, "a header row and at least one line, such as 'frequency_hz' and below it '361'")
    (header_line, header), *body = rows
    columns = _columns(header, f"{file.name}:{header_line}", file)
    if not body:
        raise _one_problem(file, "at least one rig line below the header")
    problems: list[Problem] = []
    signs: dict[str, int] = {}  # decimal sign -> the line that has it first
    first_line: dict[str, int] = {}
    lines = []

    def note(name: str, value: str, expected: str, hint: str = "") -> None:
        address = ":".join(filter(None, (file.name, str(number), name)))
        problems.append(Problem(address, value, expected, hint))

    for number, cells in body:
        known = len(problems)
        filled = [pair for pair in zip(columns + [None] * len(cells), cells, strict=False) if pair[1]]
        stray = [cell for column, cell in filled if column is None]
        given = {column[0]: (cell, column[1]) for column, cell in filled if column}
        if stray:
            hint = "a decimal comma needs semicolons between the cells; a label with a comma needs quotes"
            note("", repr(stray[0]), "no cell without a column in the header", hint)
        elif "frequency" not in given:
            note("frequency", "nothing", _EXPECTED["frequency"])
        values: dict[str, float] = {}
        for name in (name for name in _EXPECTED if name in given):
            cell, unit = given[name]
            found = _DECIMAL.match(cell)
            if found is not None and found[2] != delimiter:
                # A decimal comma is written as a point; a file that has both may mean a thousand by 1,234.
                signs.setdefault(found[2], number)
                first = next(iter(signs))
                if found[2] != first:
                    note(name, repr(cell), "one decimal sign in a file", f"line {signs[first]} has '{first}'")
                cell = f"{found[1]}.{found[3]}"
            plain = cell[-1].isdigit() or cell[-1] == "."
            share = unit == "%" if plain else cell.endswith("%")
            try:
                dimension = "ratio" if share or name == "damping" else "frequency"
                values[name] = parse_quantity(f"{cell} {unit}" if plain else cell, dimension)
            except QuantityError:
                note(name, repr(cell), _EXPECTED[name])
                continue
            if name == "uncertainty" and share:
                values[name] *= values.get("frequency", 0.0)
        if len(problems) > known:
            continue
        try:
            label = given.get("label", ("", ""))[0]
            lines.append(RigLine(values["frequency"], label, values.get("uncertainty"), values.get("damping")))
        except ModelError as error:
            for problem in error.problems:
                name = _FIELDS[problem.address]
                note(name, repr(given[name][0]), problem.expected)
            continue
        before = first_line.setdefault(f"{values['frequency']:.9g}", number)
        if before != number:
            note("frequency", repr(given["frequency"][0]), "every frequency once", f"it is in line {before}")
    if problems:
        raise ModelError(problems, str(file))
    return tuple(lines)


def _one_problem(file: Path, expected: str) -> ModelError:
    return ModelError([Problem(file.name, "", expected)], str(file))


def _columns(header: list[str], where: str, file: Path) -> list[tuple[str, str] | None]:
    """Meaning of every column, and the unit of its plain numbers; an unnamed one is None."""
    problems: list[Problem] = []
    columns: list[tuple[str, str] | None] = []
    for text in header:
        plain = text if len(text) <= _LONGEST_HEADING else ""
        key = re.sub(r"[\s_]*[\[(]\s*(.*?)\s*[\])]\Z", r"_\1", plain).strip().replace(" ", "_").lower()
        name, _, unit = _ALIASES.get(key, key).partition("_")
        units = _UNITS.get(name)
        known = {candidate.lower(): candidate for candidate in units or ()}
        if units is not None and not unit:
            columns.append((name, units[0] if units else ""))
        elif unit in known:
            columns.append((name, known[unit]))
        else:
            columns.append(None)
            if text:
                expected = "one of the columns frequency, label, uncertainty, damping"
                problems.append(Problem(f"{where}:{text}", "", expected, did_you_mean(text, [*_UNITS, *_FIELDS])))
    names = [column[0] for column in columns if column]
    counts = {name: names.count(name) for name in _UNITS}
    problems += [Problem(where, f"{count} columns for {name}", "one") for name, count in counts.items() if count > 1]
    if "frequency" not in names:
        hint = "" if problems else f"columns found: {', '.join(header)}"
        problems.append(Problem(where, "", "a column 'frequency' or 'frequency_hz'", hint))
    if problems:
        raise ModelError(problems, str(file))
    return columns


def write_rig_lines(lines: Iterable[RigLine], path: str | Path) -> Path:
    """Write lines of a rig as `read_rig_lines` reads them.

    Args:
        lines: to be written.
        path: of the file (CSV).

    Returns:
        The path.

    Raises:
        WriteError: the file can't be written.
    """
    rows = ["frequency_hz,uncertainty_hz,damping,label"]
    for line in lines:
        label = line.label.replace('"', "'")
        numbers = (
            "" if x is None else f"{x:.9g}" for x in (line.frequency_hz, line.uncertainty_hz, line.damping_ratio)
        )
        rows.append(",".join([*numbers, f'"{label}"']))
    target = Path(path)
    with written(target) as scratch:
        scratch.write_text("\n".join([*rows, ""]), encoding="utf-8")
    return target


def rig_lines_of(rig: str | Path | Sequence[RigLine | float]) -> tuple[RigLine, ...]:
    """The lines of a rig from a file (CSV), from lines, or from plain frequencies in Hz.

    Raises:
        AnalysisError: no lines at all. ModelError: the file can't be read, or holds mistakes.
    """
    if isinstance(rig, str | Path):
        return read_rig_lines(rig)
    lines = tuple(line if isinstance(line, RigLine) else RigLine(float(line)) for line in rig)
    if not lines:
        raise AnalysisError("there are no rig lines to compare with: give at least one measured frequency")
    return lines


def refuse_repeated(lines: Iterable[RigLine]) -> None:
    """AnalysisError where two lines have one frequency: each of them would need a mode of its own."""
    for f, count in Counter(line.frequency_hz for line in lines).items():
        if count > 1:
            raise AnalysisError(f"the rig line {f:g} Hz is given twice: keep one of them")
