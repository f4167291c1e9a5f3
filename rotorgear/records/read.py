"""A record from a file that somebody named: by the ending of its name, a table where that says nothing."""

from __future__ import annotations

from pathlib import Path

from rotorgear.records.logger import PACKAGES, read_logged
from rotorgear.records.record import TimeRecord
from rotorgear.records.table import read_table


def read_record(path: str | Path) -> TimeRecord:
    """Return the channels of a record over their time.

    Args:
        path: of a table (CSV, also with semicolons, tabs and decimal commas), or of MDF4 (.mf4), TDMS or WAV.

    Returns:
        Time in s, and channels with their names and units as the file has them.

    Raises:
        ModelError: a file that can't be read, or without channels over a time that rises.
        MissingExtraError: the package that reads it is not installed.
    """
    return read_logged(path) if Path(path).suffix.lower() in PACKAGES else read_table(path)
