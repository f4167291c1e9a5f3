"""Compare measured frequency responses with those of a model, pair by pair of places.

    FRAC = |sum H_rig^* H_model|^2 / (sum |H_rig|^2 sum |H_model|^2)      (Heylen and Lammens 1996)

at the frequencies of the rig. Accelerance and mobility become receptance by powers of i w, so that all pairs are alike.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.response.frequency_response import frf
from rotorgear.analysis.rig.sensor_table import Sensor, sensors_of
from rotorgear.errors import AnalysisError
from rotorgear.model.model import Model
from rotorgear.progress import Progress, silent
from rotorgear.results.rig.frf_comparison import FrfComparison, FrfMatch
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


@recorded
def compare_frf(
    model: Model,
    frf: str | Path | MeasuredFrf,
    *,
    points: str | Path | None = None,
    speed: float | str | None = None,
    modal_damping: float = 0.0,
    accuracy: float | None = None,
    elements: int | None = None,
    progress: Progress = silent,
) -> FrfComparison:
    """Put measured frequency responses beside those of a model.

    Args:
        model: the model, with its damping.
        frf: a universal file with functions (dataset 58 or 58b), or what it holds.
        points: its table of sensors (CSV); None: each node at the nearest place of the model.
        speed, modal_damping, accuracy, elements: as in `frf`.
        progress: callable that is told fraction and step.

    Returns:
        FRAC of each pair of places, with and without phase, and the ratio of sizes.

    Raises:
        ModelError: a file that can't be read. AnalysisError: no frequency responses, places that the model has not.
    """
    given = frf if isinstance(frf, MeasuredFrf) else read_rig_frf(frf, points, model)
    inputs = list(dict.fromkeys(given.references))
    outputs = list(dict.fromkeys(given.responses))
    found = _model_frf(
        model,
        given.frequency_hz,
        inputs=inputs,
        outputs=outputs,
        speed=speed,
        modal_damping=modal_damping,
        accuracy=accuracy,
        elements=elements,
        progress=progress,
    )
    computed = np.array(
        [
            found.receptance[:, outputs.index(o), inputs.index(i)]
            for o, i in zip(given.responses, given.references, strict=True)
        ]
    )
    matches = []
    for response, reference, rig, own in zip(
        given.responses, given.references, given.receptance, computed, strict=True
    ):
        sizes = (float(np.linalg.norm(rig)), float(np.linalg.norm(own)))
        ratio = sizes[1] / sizes[0] if sizes[0] > 0.0 else float("nan")
        matches.append(FrfMatch(response, reference, frac(rig, own), frac(np.abs(rig), np.abs(own)), ratio))
    return FrfComparison(
        model=model,
        frequency_hz=given.frequency_hz,
        pairs=tuple(matches),
        measured=given.receptance,
        computed=computed,
        damping_ratio=found.damping_ratio,
        dofs=found.dofs,
        left_out=found.left_out,
        warnings=(*given.notes, *found.warnings),
        method="FRAC at the frequencies of the rig",
    )


# The verb's own argument is called as its option, --frf.
_model_frf = frf


def frac(a: NDArray[np.complex128] | NDArray[np.float64], b: NDArray[np.complex128] | NDArray[np.float64]) -> float:
    """|a^H b|^2 / (a^H a b^H b); NaN where one is zero."""
    size = float(np.sum(np.abs(a) ** 2) * np.sum(np.abs(b) ** 2))
    return float(np.abs(np.vdot(a, b)) ** 2) / size if size > 0.0 else float("nan")


def _sensor(freedom: tuple[int, int], sensors: dict[tuple[int, int], Sensor]) -> tuple[Sensor | None, float]:
    """The sensor at a signed degree of freedom, and the sign of both together."""
    node, direction = freedom
    sensor = sensors.get((node, abs(direction) - 1))
    return sensor, (1.0 if direction > 0 else -1.0) * (sensor.sign if sensor else 1.0)


def _receptance(function: Function) -> NDArray[np.complex128]:
    w = 2.0 * np.pi * function.x
    power = DERIVATIVES[function.numerator]
    return np.asarray(function.values / np.where(w > 0.0, (1j * w) ** power, 1.0), dtype=complex)
