"""Measured frequency responses from a universal file (UFF, datasets 58 and 58b) as receptances between places of a model.

Accelerance and mobility become receptance by powers of i w, so that all pairs are alike.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rotorgear.analysis.rig.sensor_table import Sensor, sensors_of
from rotorgear.errors import AnalysisError
from rotorgear.model.model import Model
from rotorgear.uff.datasets import DERIVATIVES, FREQUENCY, FREQUENCY_RESPONSE, Function
from rotorgear.uff.read import read_universal


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
        rows.append((response.place, reference.place, sign * other * _receptance(function)))
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


def _receptance(function: Function) -> NDArray[np.complex128]:
    w = 2.0 * np.pi * function.x
    power = DERIVATIVES[function.numerator]
    return np.asarray(function.values / np.where(w > 0.0, (1j * w) ** power, 1.0), dtype=complex)
