"""Tries every hole that was found and prints what happens now:  python -m tests.extreme

`--cases` prints every stiff or extreme case with its error, warning or refusal, and `--counts` how many there are of each kind.

A line is "right", "refused" or "flagged" when all its tests pass, "skipped" when one of them can't run here, else "OPEN", and the
exit code is then 1.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import sys

import mpmath as mp
import pytest

from tests.extreme import outcomes as found
from tests.extreme.holes import HOLES, Hole
from tests.extreme.references import DIGITS


class Outcomes:
    """Which tests passed, failed and were skipped, by the name of their function."""

    def __init__(self) -> None:
        self.of: dict[str, set[str]] = {}

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Keep what a call, or a set-up that failed, came to."""
        if report.when == "call" or report.outcome != "passed":
            name = report.nodeid.rpartition("::")[2].partition("[")[0]
            self.of.setdefault(name, set()).add(report.outcome)

    def word(self, hole: Hole) -> str:
        """The outcome of a hole in a word."""
        seen = [self.of.get(test, {"missing"}) for test in hole.tests]
        if all(outcomes == {"passed"} for outcomes in seen):
            return hole.outcome
        return "skipped" if all(outcomes <= {"passed", "skipped"} for outcomes in seen) else "OPEN"


def main() -> int:
    """Print what is asked for."""
    parser = argparse.ArgumentParser(prog="python -m tests.extreme", description="Stiff and extreme cases.")
    parser.add_argument("--cases", action="store_true", help="every case with its error, warning or refusal")
    parser.add_argument("--counts", action="store_true", help="how many cases there are of each kind")
    options = parser.parse_args()
    tables = (found.computed, found.flagged, found.refused, found.conditioning) if options.cases else ()
    with mp.workdps(DIGITS):
        for table in (*tables, *((found.counts,) if options.counts else ())):
            print(found.aligned(table()))
    return 0 if options.cases or options.counts else tried()


def tried() -> int:
    """Run the tests of the holes and print a line for each; 1 where one is open."""
    outcomes = Outcomes()
    wanted = list(dict.fromkeys(f"{hole.file}::{test}" for hole in HOLES for test in hole.tests))
    said = io.StringIO()
    with contextlib.redirect_stdout(said):
        pytest.main(["-q", "-p", "no:cacheprovider", *wanted], plugins=[outcomes])
    words = [outcomes.word(hole) for hole in HOLES]
    for hole, word in zip(HOLES, words, strict=True):
        print(f"{word:8} {hole.what}")
    counts = ", ".join(f"{words.count(word)} {word}" for word in dict.fromkeys(words))
    print(f"{len(HOLES)} holes: {counts}")
    if "OPEN" in words:
        print(said.getvalue())
    return 1 if "OPEN" in words else 0


if __name__ == "__main__":
    sys.exit(main())
