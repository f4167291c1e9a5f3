"""python -m validation [CASE ...] [--cases] [--json FILE]: run the validation cases, all of them where none is named."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from rotorgear.errors import RotorgearError
from validation.runner import main

if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="python -m validation", description="Run the validation cases.")
    parser.add_argument("cases", nargs="*", metavar="CASE", help="cases to run, such as two_disk_rotor (default: all)")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the rows to a file as well")
    parser.add_argument(
        "--cases", dest="by_case", action="store_true", help="print a line a case in place of all lines"
    )
    options = parser.parse_args()
    try:
        sys.exit(main(options.cases, options.json, by_case=options.by_case))
    except RotorgearError as error:
        print(error, file=sys.stderr)
        sys.exit(2)
