"""python -m validation.seeds [NAME ...] [--counts]: print the rows of the five published systems, all where none is named."""

from __future__ import annotations

import argparse

from validation.seeds.rows import SYSTEMS, counts, rows

if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        prog="python -m validation.seeds", description="Published numbers and computed ones."
    )
    parser.add_argument("systems", nargs="*", metavar="NAME", choices=[*SYSTEMS, []], help=", ".join(SYSTEMS))
    parser.add_argument("--counts", action="store_true", help="only how many rows have each verdict; computes nothing")
    options = parser.parse_args()
    if options.counts:
        print(counts())
    for system in () if options.counts else options.systems or SYSTEMS:
        print(f"\n{system}")
        for row in rows(system):
            value = f"{row.shown} {row.unit}".strip()
            text = f"{row.verdict}  {row.reason}{f' [{row.runs}]' if row.runs else ''}"
            print(f"  {row.where:10} {row.what:60} {row.printed or '-':>12} {value:>18}  {text}")
