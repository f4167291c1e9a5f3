"""The rows of a validation run as an aligned text table."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

HEAD = ("case", "what", "expected", "got", "error", "allowed", "", "dofs", "time")
_RIGHT = {"expected", "got", "error", "dofs", "time"}
# Differences this small are rounding, which is another one on every machine.
ROUNDING = 1e-8


@dataclass(frozen=True)
class Row:
    """One judged line.

    Attributes:
        case, what: name of the case, and what was compared in words.
        expected, got: numbers or words.
        error: relative to the expected number, or absolute where the tolerance is; 0 for words that agree, else 1.
        tolerance: what was allowed, as in expected.csv; "" is shown but not judged.
        passed: whether the error is within.
        dofs, seconds: of the largest model, and of all solutions of this line.
        reason: why a line failed; "" for one that passed.
        source, note: as in expected.csv.
    """

    case: str
    what: str
    expected: str
    got: float | str
    error: float
    tolerance: str
    passed: bool
    dofs: int
    seconds: float
    reason: str
    source: str
    note: str

    @property
    def judged(self) -> bool:
        """Whether the line has a tolerance."""
        return bool(self.tolerance)


def number(got: float | str, expected: str) -> str:
    """Print a result with the digits of what was expected, 7 or more; with 4 where a round number or a bound was."""
    if isinstance(got, str):
        return got
    given = len(expected.lstrip(">=- 0.").replace(".", ""))
    digits = max(7, min(12, given)) if given > 2 else 4
    return f"{got:.{digits}g}"


def error(row: Row) -> str:
    """Print an error with two digits; below rounding it is only said to be that small."""
    if isinstance(row.got, str) or (row.tolerance == "bound" and row.passed):
        return "-"
    return f"< {ROUNDING:.0e}" if row.error < ROUNDING else f"{row.error:.1e}"


def verdict(row: Row) -> str:
    """Return pass, FAIL, or shown for a line without tolerance."""
    if not row.judged:
        return "shown"
    return "pass" if row.passed else "FAIL"


def overview(titles: Mapping[str, str], rows: Sequence[Row]) -> str:
    """A line a case, by its name and title: how many lines are judged, how many of them pass, and how many are only shown."""
    lines = [f"{'case':24}  {'what':65}  judged  passed  shown"]
    for name, title in titles.items():
        judged = [row for row in rows if row.case == name and row.judged]
        shown = sum(row.case == name for row in rows) - len(judged)
        lines.append(f"{name:24}  {title:65}  {len(judged):6}  {sum(row.passed for row in judged):6}  {shown:5}")
    return "\n".join(lines) + "\n"


def printed(rows: Sequence[Row]) -> str:
    """Return the table, with sources of failed rows and their reasons below."""
    cells = [list(HEAD)]
    cells += [
        [
            row.case,
            row.what,
            row.expected,
            number(row.got, row.expected),
            error(row),
            row.tolerance or "-",
            verdict(row),
            str(row.dofs),
            f"{row.seconds:.2f} s",
        ]
        for row in rows
    ]
    widths = [max(len(line[k]) for line in cells) for k in range(len(HEAD))]
    lines = [
        "  ".join(
            cell.rjust(width) if name in _RIGHT else cell.ljust(width)
            for cell, width, name in zip(line, widths, HEAD, strict=True)
        ).rstrip()
        for line in cells
    ]
    lines += [
        f"FAIL {row.case}: {row.what}: {row.reason} (source: {row.source}{_note(row)})"
        for row in rows
        if row.judged and not row.passed
    ]
    return "\n".join(lines) + "\n"


def _note(row: Row) -> str:
    return f"; {row.note}" if row.note else ""
