"""python -m validation.seeds [NAME ...] [--verdict WORD] [--find TEXT] [--counts]: print rows of the five published systems."""

from __future__ import annotations

import argparse
import textwrap

from validation.seeds.rows import SYSTEMS, Row, counts, rows
from validation.seeds.rules import VERDICTS


def text_of(row: Row) -> str:
    """A row in lines: what is printed and computed, then verdict, rule and reason."""
    numbers = f"{row.printed or '-'} | {row.shown} {row.unit}".strip()
    test = f": {row.by}" if row.by else ""
    reason = f". {row.reason}" if row.reason else ""
    told = f"{row.verdict}{test}{reason}{f' [{row.runs}]' if row.runs else ''}"
    indent = " " * 6
    return "\n".join(
        [
            f"  {row.where}: {row.what}: {numbers}",
            textwrap.fill(told, 118, initial_indent=indent, subsequent_indent=indent, break_on_hyphens=False),
        ]
    )


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        prog="python -m validation.seeds",
        description="Claims of five published systems: printed | computed, then the verdict and the test that gave it.",
    )
    parser.add_argument("systems", nargs="*", metavar="NAME", choices=[*SYSTEMS, []], help=", ".join(SYSTEMS))
    parser.add_argument("--verdict", choices=VERDICTS, help="only rows of this verdict")
    parser.add_argument("--find", default="", metavar="TEXT", help="only rows that say this")
    parser.add_argument("--counts", action="store_true", help="only how many rows have each verdict")
    options = parser.parse_args()
    if options.counts:
        print(counts())
    for system in () if options.counts else options.systems or SYSTEMS:
        found = [
            row
            for row in rows(system)
            if options.verdict in (None, row.verdict) and options.find in f"{row.where} {row.what} {row.reason}"
        ]
        if found:
            print("\n".join([f"\n{system}", *map(text_of, found)]))
