"""What a rig has measured: lines with the shapes that belong to them, and frequency responses, from a universal file (UFF).

Mode shapes (dataset 55) are at the sensors of a table, or at the nearest places of a model. Frequency responses (datasets 58 and
58b) are receptances between such places: accelerance and mobility become receptance by powers of i w, so that all pairs are
alike."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rotorgear.analysis.common.points import coordinates
from rotorgear.analysis.rig.sensor_table import Sensor, sensors_of
from rotorgear.errors import AnalysisError, ModelError, Problem
from rotorgear.model.model import Model
from rotorgear.note import Note
from rotorgear.results.comparison import RigLine
from rotorgear.uff.datasets import DERIVATIVES, FREQUENCY, FREQUENCY_RESPONSE
from rotorgear.uff.read import read_universal


@dataclass(frozen=True)
class Measured:
    """Measured modes.

    Attributes:
        lines: frequencies, with uncertainty and damping where known (n).
        points: names of the model's points where shapes were measured, or places such as "bearings.left:x" (s); empty without
            shapes.
        shapes: displacement along the direction of each point (n, s), to any scale and phase of each mode; NaN where a mode was
            not measured at a point.
        notes: sentences on what the file leaves open.
        sensors: what is known of the sensor at each point (s), where the shapes come from a file.
    """

    lines: tuple[RigLine, ...]
    points: tuple[str, ...] = ()
    shapes: NDArray[np.complex128] | None = None
    notes: tuple[str, ...] = ()
    sensors: tuple[Sensor, ...] = ()

    def __post_init__(self) -> None:
        if self.shapes is None:
            return
        if self.shapes.shape != (len(self.lines), len(self.points)):
            raise AnalysisError(
                f"measured shapes have one row a line and one column a point, ({len(self.lines)}, {len(self.points)}); "
                f"got {self.shapes.shape}"
            )
        if np.isinf(self.shapes).any():
            raise AnalysisError("measured shapes hold infinite displacements: NaN stands for one that was not measured")
        twice = sorted({point for point in self.points if self.points.count(point) > 1})
        if twice:
            raise AnalysisError(
                f"shapes were measured twice at {', '.join(twice)}: keep one sensor of each place and direction"
            )
        # A shape that is 0 everywhere has no direction to compare; its frequency is a line like any other.
        still = ~np.any(np.nan_to_num(self.shapes) != 0.0, axis=1)
        if still.any():
            object.__setattr__(self, "shapes", np.where(still[:, None], complex(np.nan), self.shapes))

    def check_points(self, model: Model) -> None:
        """Raise AnalysisError where a measured point is none of the model's."""
        for name in self.points:
            if not (name in model.points or ":" in name):
                known = ", ".join(model.points) or "none"
                raise AnalysisError(
                    f"shapes were measured at '{name}', which is no point of the model ([points]: {known}), and no part with a "
                    "direction such as 'bearings.left:x'"
                )
            coordinates(model, name)

    @property
    def real_shapes(self) -> NDArray[np.float64]:
        """The shapes turned to the phase in which each is most nearly real, (n, s); NaN rows without shapes.

        A mode with little damping moves in phase; its largest part, sum of phi^2, turned to the real axis, is that phase.
        """
        if self.shapes is None:
            return np.full((len(self.lines), 0), np.nan)
        squares = np.nansum(self.shapes**2, axis=1)
        phase = np.exp(-0.5j * np.angle(squares))
        return np.real(self.shapes * phase[:, None])


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
    rows = []
    for number, shape in enumerate(file.shapes, start=1):
        if not 0.0 < shape.frequency_hz < math.inf:
            raise AnalysisError(
                f"{path}: shape {number} has the frequency {shape.frequency_hz:g} Hz; expected a positive one"
            )
        label = shape.names[3] if len(shape.names) > 3 else ""
        damping = shape.damping_ratio if 0.0 < shape.damping_ratio < 1.0 else None
        lines.append(RigLine(shape.frequency_hz, "" if label.lower() == "none" else label, None, damping))
        # Displacements by node and direction, those of all six that the file has.
        moved = {
            (int(n), k): value for n, row in zip(shape.nodes, shape.values, strict=True) for k, value in enumerate(row)
        }
        rows.append([s.sign * moved.get((s.node, s.direction), complex(math.nan)) for s in sensors])
    table = np.array(rows, dtype=complex)
    for sensor, seen in zip(sensors, np.isfinite(table).any(axis=0), strict=True):
        if not seen:
            problem = Problem(f"point {sensor.place}", f"node {sensor.node}", "a node that some shape of the file has")
            raise ModelError([problem], str(path))
    for number in np.flatnonzero(~np.any(np.nan_to_num(table) != 0.0, axis=1)).tolist():
        what = f"shape {number + 1} ({lines[number].frequency_hz:.4g} Hz) moves no sensor"
        notes.append(Note("", what, "taken as a line without shape"))
    if file.nodes is not None and {18, 2420} & set(file.others) and file.nodes.systems.any():
        what = "displacements are in local coordinate systems (datasets 18, 2420), which are not read"
        notes.append(Note("", what, "all are taken as global"))
    names = tuple(sensor.place for sensor in sensors)
    return Measured(tuple(lines), names, table, (*file.notes, *notes), tuple(sensors))


@dataclass(frozen=True)
class MeasuredFrf:
    """Measured receptances of p pairs of places at f frequencies.

    Attributes:
        frequency_hz: positive, ascending (f,).
        responses, references: places as `frf` takes them (p,).
        receptance: (p, f), signs of the sensors applied.
        notes: sentences on what the file leaves open.
    """

    frequency_hz: NDArray[np.float64]
    responses: tuple[str, ...]
    references: tuple[str, ...]
    receptance: NDArray[np.complex128]
    notes: tuple[str, ...] = ()


def read_rig_frf(path: str | Path, points: str | Path | None = None, model: Model | None = None) -> MeasuredFrf:
    """Return the frequency responses of a universal file (dataset 58 or 58b) as receptances.

    Args:
        path: of the file.
        points: table of sensors (CSV); None: each node at the nearest place of the model.
        model: needed where the table doesn't name all places.

    Raises:
        ModelError: a file that can't be read.
        AnalysisError: no frequency responses, different frequencies, quantities that are no motion over force.
    """
    file = read_universal(path)
    functions = [function for function in file.functions if function.kind == FREQUENCY_RESPONSE]
    if not functions:
        raise AnalysisError(
            f"{path}: no frequency responses (dataset 58, function type 4) in it; its datasets: {file.kinds}"
        )
    sensors, notes = sensors_of(file, Path(path).name, points, model)
    by_freedom = {(sensor.node, sensor.direction): sensor for sensor in sensors}
    hz = functions[0].x
    rows = []
    left = 0
    for function in functions:
        if function.numerator not in DERIVATIVES:
            raise AnalysisError(
                f"{path}: the response of a function is of type {function.numerator}; expected displacement (8), "
                "velocity (11) or acceleration (12)"
            )
        if function.denominator in DERIVATIVES:
            raise AnalysisError(
                f"{path}: a function is a motion over a motion (type {function.denominator}), a transmissibility; expected "
                "motions over forces (13)"
            )
        if function.x_type not in (0, FREQUENCY):
            raise AnalysisError(
                f"{path}: a function is over an axis of type {function.x_type}; expected frequency (18)"
            )
        if len(function.x) != len(hz) or not np.allclose(function.x, hz, rtol=1e-4):
            raise AnalysisError(
                f"{path}: frequency responses have different frequencies; give one file for each set of them"
            )
        response, sign = _sensor(function.response, by_freedom)
        reference, other = _sensor(function.reference, by_freedom)
        if response is None or reference is None:
            left += 1
            continue
        w = 2.0 * np.pi * function.x
        receptance = function.values / np.where(w > 0.0, (1j * w) ** DERIVATIVES[function.numerator], 1.0)
        rows.append((response.place, reference.place, sign * other * np.asarray(receptance, dtype=complex)))
    if not rows:
        raise AnalysisError(f"{path}: none of its frequency responses is between two sensors of the table")
    if left:
        notes.append(f"{left} of {len(functions)} frequency responses are at nodes that the table of sensors has not")
    keep = hz > 0.0
    places = list(zip(*rows, strict=True))
    return MeasuredFrf(
        hz[keep], tuple(places[0]), tuple(places[1]), np.array(places[2])[:, keep], (*file.notes, *notes)
    )


def _sensor(freedom: tuple[int, int], sensors: dict[tuple[int, int], Sensor]) -> tuple[Sensor | None, float]:
    """The sensor at a signed degree of freedom, and the sign of both together."""
    node, direction = freedom
    sensor = sensors.get((node, abs(direction) - 1))
    return sensor, (1.0 if direction > 0 else -1.0) * (sensor.sign if sensor else 1.0)
