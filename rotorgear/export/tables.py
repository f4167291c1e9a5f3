"""Rows of numbers as a CSV file, with names and units in its header, and the sensors of a planned test as such a table."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Mapping
from io import StringIO
from pathlib import Path

from rotorgear.files.write import written
from rotorgear.results.sensors import SensorPlan


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
    text = StringIO()
    writer = csv.DictWriter(text, fieldnames=list(listed[0]) if listed else [], lineterminator="\n")
    writer.writeheader()
    writer.writerows(listed)
    with written(target) as scratch:
        scratch.write_bytes(text.getvalue().encode("utf-8", "backslashreplace"))
    return target


def write_sensors(plan: SensorPlan, path: str | Path) -> Path:
    """Write point, node and direction of each sensor, and where it is in mm; the rig numbers its nodes so.

    Args:
        plan: of `sensors`.
        path: of the file, such as "sensors.csv".

    Raises:
        WriteError: the file can't be written.
    """
    rows = [
        {"point": row.place, "node": row.node, "direction": row.direction}
        | {f"{axis}_mm": f"{1e3 * value:.3f}" for axis, value in zip("xyz", row.position, strict=True)}
        for row in plan.sensors
    ]
    return write_csv(rows, path)
