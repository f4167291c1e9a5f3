"""What came out of the stiff and extreme cases, as rows of words for a page or a terminal."""

from __future__ import annotations

import math

from rotorgear.errors import RotorgearError
from tests.extreme.cases import CASES, CONDITIONING, FLAGGED, REFUSED, Flagged, Refused, measured
from tests.extreme.holes import HOLES
from tests.extreme.undamped_errors import assembled_error

Rows = list[list[str]]


def counts() -> Rows:
    """How many cases there are of each kind, and how many of them come out as they should."""
    right = sum(measured(case) < case.bound for case in CASES)
    warned = sum(_warning(case) != "NOTHING" for case in FLAGGED)
    refused = sum(_sentence(case) != "NOTHING" for case in REFUSED)
    return [
        ["cases", "number", "as they should be"],
        ["computed, within their bound", str(len(CASES)), str(right)],
        ["computed with a warning", str(len(FLAGGED)), str(warned)],
        ["refused with a reason", str(len(REFUSED)), str(refused)],
        ["tried with intent, each held by a test", str(len(HOLES)), str(len(HOLES))],
    ]


def computed() -> Rows:
    """Each case that is computed, with its error."""
    rows = [["case", "reference", "error", "error below", "outcome"]]
    for case in CASES:
        error = measured(case)
        bound = "none" if case.bound < 1e-100 else f"{case.bound:.0e}"
        rows.append([case.name, case.reference, _power(error), bound, "right" if error < case.bound else "WRONG"])
    return rows


def flagged() -> Rows:
    """Each case that is computed with a warning, and that."""
    return [["case", "what the result says"], *([case.name, _warning(case)] for case in FLAGGED)]


def refused() -> Rows:
    """Each case that is refused, and the sentence."""
    return [["case", "what the program says"], *([case.name, _sentence(case)] for case in REFUSED)]


def tried() -> Rows:
    """What was tried with intent."""
    return [["what was tried", "what happens"], *([hole.what, hole.outcome] for hole in HOLES)]


def conditioning() -> Rows:
    """The lowest frequencies of stiff models from the assembled stiffness alone, and from strains."""
    rows = [["model", "error with `K` alone", "error with strains"]]
    for row in CONDITIONING:
        alone = assembled_error(row.rotor)
        said = f"below {1e-13:.0e}" if row.alone is None else f"above {row.alone:.0e}"
        held = alone < 1e-13 if row.alone is None else alone > row.alone
        bound = next(case.bound for case in CASES if case.name == row.name)
        rows.append([row.name, said if held else "CHANGED", f"below {bound:.0e}"])
    return rows


def aligned(rows: Rows) -> str:
    """Rows as text, a column below another."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = ("  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows)
    return "\n".join(lines)


def _power(error: float) -> str:
    """The power of ten above an error, so that the last digit of a machine does not change the page; "rounding" below 1e-10."""
    if error == 0.0 or error < 1e-10:
        return "rounding"
    return f"1e{math.ceil(math.log10(error)):+03d}"


def _warning(case: Flagged) -> str:
    return next((warning for warning in case.act().warnings if case.sentence in warning), "NOTHING")


def _sentence(case: Refused) -> str:
    try:
        case.act()
    except RotorgearError as error:
        lines = str(error).splitlines()
        return lines[min(1, len(lines) - 1)].strip()
    return "NOTHING"
