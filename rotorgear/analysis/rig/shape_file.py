"""Measured mode shapes from a universal file (UFF, dataset 55), at sensors of a table or at the nearest places of a model."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from rotorgear.analysis.rig.measured import Measured
from rotorgear.analysis.rig.sensor_table import sensors_of
from rotorgear.errors import AnalysisError, ModelError, Problem
from rotorgear.model.model import Model
from rotorgear.results.comparison import RigLine
from rotorgear.uff.datasets import Shape, UniversalFile
from rotorgear.uff.read import read_universal


def read_rig_shapes(path: str | Path, points: str | Path | None = None, model: Model | None = None) -> Measured:
    """Return frequencies and shapes of a universal file, at its sensors.

    Args:
        path: of the universal file.
        points: of the table of sensors (CSV); None: every node that moves, at the nearest place of the model.
        model: needed where the table doesn't name all places.

    Returns:
        A line for each shape, in the order of the file, and the shapes at the sensors (n, s).

    Raises:
        ModelError: a file that can't be read, mistakes in the table, a sensor whose node no shape has.
        AnalysisError: a universal file without shapes, or whose shapes have no frequency.
    """
    file = read_universal(path)
    if not file.shapes:
        raise AnalysisError(f"{path}: no mode shapes (dataset 55) in it; its datasets: {file.kinds}")
    sensors, notes = sensors_of(file, Path(path).name, points, model)
    lines = []
    columns = []
    for number, shape in enumerate(file.shapes, start=1):
        lines.append(_line(shape, number, path))
        row = {int(node): values for node, values in zip(shape.nodes, shape.values, strict=True)}
        at = [row.get(sensor.node) for sensor in sensors]
        columns.append(
            [
                complex(math.nan)
                if values is None or sensor.direction >= len(values)
                else sensor.sign * values[sensor.direction]
                for values, sensor in zip(at, sensors, strict=True)
            ]
        )
    table = np.array(columns, dtype=complex)
    for k, sensor in enumerate(sensors):
        if not np.isfinite(table[:, k]).any():
            raise ModelError(
                [Problem(f"point {sensor.place}", f"node {sensor.node}", "a node that some shape of the file has")],
                str(path),
            )
    still = np.flatnonzero(~np.any(np.nan_to_num(table) != 0.0, axis=1))
    for number in map(int, still):
        # A shape that is 0 everywhere has no direction to compare; its frequency is a line like any other.
        table[number] = complex(math.nan)
        notes.append(
            f"shape {number + 1} ({lines[number].frequency_hz:.4g} Hz) moves no sensor: taken as a line without shape"
        )
    names = tuple(sensor.place for sensor in sensors)
    return Measured(tuple(lines), names, table, (*file.notes, *notes, *_turned_systems(file)), tuple(sensors))


def _line(shape: Shape, number: int, path: str | Path) -> RigLine:
    if not (math.isfinite(shape.frequency_hz) and shape.frequency_hz > 0.0):
        raise AnalysisError(
            f"{path}: shape {number} has the frequency {shape.frequency_hz:g} Hz; expected a positive one"
        )
    label = shape.names[3] if len(shape.names) > 3 else ""
    damping = shape.damping_ratio
    return RigLine(
        shape.frequency_hz, "" if label.lower() == "none" else label, None, damping if 0.0 < damping < 1.0 else None
    )


def _turned_systems(file: UniversalFile) -> list[str]:
    """A warning where displacements may stand in local coordinate systems, which are not read."""
    if file.nodes is None or not ({18, 2420} & set(file.others)) or not file.nodes.systems.any():
        return []
    return [
        "displacements stand in local coordinate systems (datasets 18, 2420), which are not read: all are taken as global"
    ]
