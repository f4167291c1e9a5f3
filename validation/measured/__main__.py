"""Runs the cases of measured machines: python -m validation.measured"""

from __future__ import annotations

import sys

from validation.case import FOLDERS, INPUTS, names
from validation.runner import main

__all__ = ["INPUTS"]  # what docs/machinery/made.py reads of a table's module

if __name__ == "__main__":
    sys.exit(main([name for name in names() if (FOLDERS[1] / name).is_dir()]))
