"""The places of a planned test as the table of sensors that `compare` and `update` read."""

from __future__ import annotations

from pathlib import Path

from rotorgear.export.csv_file import write_csv
from rotorgear.results.sensors import SensorPlan


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
