"""Records in tables of text: comma, semicolon, tab or blanks between the cells, a point or a comma in the numbers.

What programs write above the numbers differs: lines on the test, then the names of the columns, perhaps a line of their units.
The numbers tell where they begin: at the first line that holds nothing else, in two cells or more. The line above it, of as many
cells, has the names, or the units of those above that. A unit stands behind a name as in "torque (N m)", "torque [N m]",
"torque_Nm", "torque / N m" or "torque N m".
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rotorgear.common_units import COMMON_UNITS
from rotorgear.errors import ModelError, Problem
from rotorgear.files.bounds import LONGEST_TEXT, MOST_SAMPLES, RECORD
from rotorgear.files.numbers import NUMBER
from rotorgear.files.read import UnreadableError, read_named
from rotorgear.quantity import parse_quantity
from rotorgear.records.record import Channel, TimeRecord

# Cells are parted by the first of these that makes two numbers or more of a line; None: by blanks.
_DELIMITERS = (";", "\t", ",", None)
# Lines above the numbers.
_MOST_HEAD = 200
_COMMA = NUMBER.replace(r"\.", "[.,]")
_TIMES = ("time", "t", "zeit", "times")
_UNITS = frozenset(unit for units in COMMON_UNITS.values() for unit in units) | {
    *("Hz", "kHz", "rpm", "1/min", "rad/s", "deg/s", "%", "m/s", "mm/s", "rad/s2", "g", "V", "mV")
}


def read_table(path: str | Path) -> TimeRecord:
    """Return the record in a table of text; the column of time is called so, or has a unit of time, or is called by one.

    Raises:
        ModelError: a file that can't be read, no numbers, no time, cells that are no numbers, times that do not rise.
    """
    file = Path(path)
    expected = "a table of channels over time, such as time_s;torque_Nm and numbers below it"
    try:
        data = read_named(file, RECORD.most_bytes)
    except UnreadableError as error:
        raise ModelError([Problem(file.name, "", expected, error.reason)], str(file)) from None
    lines = _text(data).splitlines()
    rows = [
        (number, line) for number, line in enumerate(lines, 1) if line.strip() and not line.lstrip().startswith("#")
    ]
    marks = (_delimiter(line) for _, line in rows[:_MOST_HEAD])
    at, found = next(((k, mark) for k, mark in enumerate(marks) if mark != ""), (-1, None))
    if at < 0:
        raise ModelError(
            [Problem(file.name, "", expected, "no line of it holds two numbers and nothing else")], str(file)
        )
    first = _numbers(rows[at][1], found)
    head = [_cells(line, found) for _, line in rows[max(0, at - 2) : at]]
    head = [cells for cells in head if len(cells) == len(first)]
    if not head:
        hint = f"line {rows[at][0]} has {len(first)} numbers, and no names stand above it"
        raise ModelError([Problem(file.name, "", "a header with a name for each column", hint)], str(file))
    if len(head) == 2 and all(_unit_of(cell) is not None or not cell for cell in head[1]):
        names = [(name, _unit_of(unit) or "") for name, unit in zip(*head, strict=True)]
    else:
        names = [_name_and_unit(cell) for cell in head[-1]]
    if len(first) * (len(rows) - at) > MOST_SAMPLES:
        raise ModelError([Problem(file.name, "", f"up to {MOST_SAMPLES:,} numbers")], str(file))
    table = _table(rows[at:], found, len(first), file)
    column = _time_column(names, file, rows[at - 1][0])
    name, unit = names[column]
    factor = parse_quantity(f"1 {unit or name}" if (unit or name) in COMMON_UNITS["time"] else "1 s", "time")
    time = factor * table[:, column]
    if len(time) < 2 or not np.all(np.diff(time) > 0.0):
        late = int(np.argmin(np.diff(time) > 0.0)) + at + 1 if len(time) > 1 else at
        address = f"{file.name}:{rows[late][0]}:{name}"
        raise ModelError([Problem(address, "", "times that rise, in two rows or more")], str(file))
    channels = [Channel(*said, table[:, k]) for k, said in enumerate(names) if k != column]
    return TimeRecord(time, tuple(channels))


def _delimiter(line: str) -> str | None:
    """What parts the cells of a line of numbers; "" of another line."""
    return next((mark for mark in _DELIMITERS if len(_numbers(line, mark)) > 1), "")


def _text(data: bytes) -> str:
    """The text of a file as its marks say, else UTF-8; what is none of it is that of Windows, whose letters are bytes."""
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        return data.decode("utf-16", errors="replace")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("cp1252", errors="replace")


def _cells(line: str, delimiter: str | None) -> list[str]:
    """The cells of a line, without the quotes about them; long ones are cut, since none of them is a name."""
    parts = line.rstrip(delimiter).split(delimiter)
    return [part.strip().strip('"').strip()[:LONGEST_TEXT] for part in parts]


def _numbers(line: str, delimiter: str | None) -> list[str]:
    """The cells of a line of numbers; none of another line."""
    cells = _cells(line, delimiter)
    pattern = NUMBER if delimiter == "," else _COMMA
    return cells if all(len(cell) <= 100 and re.fullmatch(pattern, cell) for cell in cells) else []


def _table(rows: list[tuple[int, str]], delimiter: str | None, count: int, file: Path) -> NDArray[np.float64]:
    """All numbers (r, count).

    Raises:
        ModelError: the first row that has another number of cells, or a cell that is no number.
    """
    number = NUMBER if delimiter == "," else _COMMA
    # Possessive: a long stretch of blanks is gone through once.
    mark = r"\s" if delimiter is None else re.escape(delimiter)
    blanks = r"\s*+" if delimiter is None else rf"[^\S{mark}]*+"
    cell = rf'{blanks}"?{number}"?'
    gap = mark if delimiter is None else blanks + mark
    line_of = re.compile(rf"{cell}(?:{gap}{cell}){{{count - 1}}}(?:{gap})?+{blanks}")
    plain = str.maketrans({'"': " ", delimiter or " ": " "} | ({} if delimiter == "," else {",": "."}))
    for where, line in rows:
        if not line_of.fullmatch(line):
            cells = _cells(line, delimiter)
            wrong = next((cell for cell in cells if not re.fullmatch(number, cell)), None)
            hint = "leave out rows in which a channel has no value" if not wrong else ""
            expected = f"{count} numbers" if wrong is None else "a number in each cell"
            value = f"{len(cells)} of them" if wrong is None else repr(wrong[:60])
            raise ModelError([Problem(f"{file.name}:{where}", value, expected, hint)], str(file))
    values = np.fromstring(" ".join(line.translate(plain) for _, line in rows), sep=" ")
    if not np.isfinite(values).all():
        raise ModelError([Problem(file.name, "", "numbers that a computer can hold")], str(file))
    return values.reshape(-1, count)


def _unit_of(text: str) -> str | None:
    """The unit that a text is, perhaps in brackets; None of any other text."""
    plain = text.strip().strip("[]()").strip()
    plain = {"-": "", "": ""}.get(plain, plain)
    spelt = (
        plain.replace("*", " ").replace("·", " ").replace("^", "").replace("²", "2").replace("µ", "u").replace("μ", "u")
    )
    return spelt if not spelt or spelt in _UNITS else None


def _name_and_unit(cell: str) -> tuple[str, str]:
    """The name in a cell of the header, and the unit behind it; "" where there is none."""
    if bracket := re.fullmatch(r"([^\[(]{1,200})[\[(]([^\])]{0,40})[\])]", cell):
        known = _unit_of(bracket[2])
        return bracket[1].strip(" _"), bracket[2].strip() if known is None else known
    if over := re.fullmatch(r"(.{1,200}?)\s+(?:/|in)\s+(.{1,40})", cell):
        known = _unit_of(over[2])
        if known is not None:
            return over[1], known
    for gap in re.finditer(r"[\s_]+", cell[:LONGEST_TEXT]):  # the longest unit at the end
        if known := _unit_of(cell[gap.end() :]):
            return cell[: gap.start()], known
    return cell, ""


def _time_column(names: list[tuple[str, str]], file: Path, line: int) -> int:
    """Which column is the time: by its name, or by its unit, or by a name that is a unit of time."""
    times = COMMON_UNITS["time"]
    by_name = [k for k, (name, unit) in enumerate(names) if name.lower() in _TIMES and (not unit or unit in times)]
    by_unit = [k for k, (name, unit) in enumerate(names) if unit in times or (not unit and name in times)]
    found = by_name or by_unit
    if len(found) == 1:
        return found[0]
    hint = f"columns found: {', '.join(name for name, _ in names)[:200]}"
    expected = "one column of time, such as 'time_s' or 't (ms)'"
    raise ModelError(
        [Problem(f"{file.name}:{line}", f"{len(found)} of them" if found else "", expected, hint)], str(file)
    )
