"""Writes rows of numbers as a CSV file: a header with names and units, full digits, commas."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Mapping
from pathlib import Path

from rotorgear.export.files import replacing


def write_csv(rows: Iterable[Mapping[str, object]], path: str | Path) -> Path:
    """Write rows with equal keys, whole or not at all.

    Args:
        rows: one mapping a line; the keys of the first are the header.
        path: file to write.

    Returns:
        The path.

    Raises:
        WriteError: the file can't be written.
    """
    listed = [dict(row) for row in rows]
    target = Path(path)
    with replacing(target) as scratch, open(scratch, "w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, fieldnames=list(listed[0]) if listed else [], lineterminator="\n")
        writer.writeheader()
        writer.writerows(listed)
    return target
