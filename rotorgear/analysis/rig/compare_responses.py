"""Compare what a rig measured of responses with those of a model: frequency responses, order cuts, spectral lines.

Frequency responses are compared pair by pair of places, at the frequencies of the rig:

    FRAC = |sum H_rig^* H_model|^2 / (sum |H_rig|^2 sum |H_model|^2)      (Heylen and Lammens 1996)

Order cuts of a run-up are compared with the response at the same speeds. A CSV file of them has the columns `speed_rpm`, `order`
(frequency over that of the input shaft) and one for each named point, with amplitudes in m/s^2 (rad/s^2 for rotations). A
universal file has order functions (dataset 58): rpm along, the order as value on the z-axis.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rotorgear.analysis.common.excitation import excitation_lines
from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.response.frequency_response import frf as model_frf  # the verb's own argument is called frf
from rotorgear.analysis.response.response import response
from rotorgear.analysis.rig.likeness import frac
from rotorgear.analysis.rig.measured import MeasuredFrf, frf_of
from rotorgear.analysis.rig.sensor_table import read_sensor_table
from rotorgear.errors import AnalysisError, ModelError, Problem
from rotorgear.files.numbers import number_of
from rotorgear.files.rows import csv_rows
from rotorgear.model.model import Model
from rotorgear.progress import Progress, silent
from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.comparison import RigLine
from rotorgear.results.frf_comparison import FrfComparison, FrfMatch, OrderComparison, OrderMatch
from rotorgear.results.spectrum import RigSpectrum, SpectralLines
from rotorgear.results.transient import TransientResult
from rotorgear.uff.datasets import DERIVATIVES, RPM
from rotorgear.uff.read import read_universal

# Two orders are the same where their ratios agree to this; orders are read from a display.
_SAME_ORDER = 2e-3
# Spectral lines within this share of a rig line are that line.
TOLERANCE = 0.01
_TINY = 1e-300


@recorded
def compare_frf(
    model: Model,
    frf: str | Path | MeasuredFrf,
    *,
    points: str | Path | None = None,
    frf_motion: str | None = None,
    speed: float | str | None = None,
    modal_damping: float = 0.0,
    accuracy: float | None = None,
    elements: int | None = None,
    progress: Progress = silent,
) -> FrfComparison:
    """Put measured frequency responses beside those of a model.

    Args:
        model: the model, with its damping.
        frf: measured frequency responses: a universal file (dataset 58 or 58b); in Python also what it holds.
        points: as in `compare_shapes`.
        frf_motion: what responses are where neither their type in the file nor their unit says it: "displacement", "velocity" or
            "acceleration".
        speed: as in `compare`.
        modal_damping: as in `frf`.
        accuracy: as in `frf`.
        elements: as in `frf`.
        progress: callable that is told fraction and step.

    Returns:
        FRAC of each pair of places, with and without phase, and the ratio of sizes.

    Raises:
        ModelError: a file that can't be read. AnalysisError: no frequency responses, places that the model has not.
    """
    given = frf_of(frf, points, model, frf_motion)
    inputs = list(dict.fromkeys(given.references))
    outputs = list(dict.fromkeys(given.responses))
    settings: dict[str, Any] = {
        "speed": speed,
        "modal_damping": modal_damping,
        "accuracy": accuracy,
        "elements": elements,
    }
    found = model_frf(model, given.frequency_hz, inputs=inputs, outputs=outputs, **settings, progress=progress)
    pairs = list(zip(given.responses, given.references, strict=True))
    computed = np.array([found.receptance[:, outputs.index(o), inputs.index(i)] for o, i in pairs])
    matches = []
    for (output, reference), rig, own in zip(pairs, given.receptance, computed, strict=True):
        size = float(np.linalg.norm(rig))
        ratio = float(np.linalg.norm(own)) / size if size > 0.0 else float("nan")
        matches.append(FrfMatch(output, reference, frac(rig, own), frac(np.abs(rig), np.abs(own)), ratio))
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


@dataclass(frozen=True)
class OrderCut:
    """Amplitude of acceleration (s,) at a named point along one order, over speeds in rpm (s,), ascending."""

    point: str
    ratio: float
    speed_rpm: NDArray[np.float64]
    amplitude: NDArray[np.float64]


def read_order_cuts(path: str | Path, points: str | Path | None = None) -> tuple[OrderCut, ...]:
    """Return the order cuts of a CSV file, or of a universal file with its table of sensors.

    Args:
        path: of the file; `.csv` and `.txt` are tables, others universal files (dataset 58 over rpm).
        points: table of sensors (CSV) that names the nodes of a universal file.

    Raises:
        ModelError: mistakes of the file, with line and column. AnalysisError: no cuts in it, or no table beside a universal file.
    """
    if Path(path).suffix.lower() in (".csv", ".txt"):
        return _cuts_of_csv(Path(path))
    if points is None:
        raise AnalysisError("order cuts of a universal file need --points: the table of sensors that names its nodes")
    sensors = {(sensor.node, sensor.direction): sensor.place for sensor in read_sensor_table(Path(points))}
    found = []
    file = read_universal(path)
    for function in file.functions:
        place = sensors.get((function.response[0], abs(function.response[1]) - 1))
        if function.x_type != RPM or place is None or function.z <= 0.0:
            continue
        power = DERIVATIVES.get(function.numerator)
        if power is None:
            raise AnalysisError(
                f"{path}: an order function is of type {function.numerator}; expected a motion (8, 11 or 12), or a "
                "unit such as m/s^2 or g that says it"
            )
        w = function.z * function.x / RPM_PER_RAD_S
        found.append(OrderCut(place, function.z, function.x, np.abs(function.values) * w ** (2 - power)))
    if not found:
        raise AnalysisError(
            f"{path}: no order functions (dataset 58 over rpm, order as z-axis value) at sensors; datasets: {file.kinds}"
        )
    return tuple(found)


@recorded
def compare_orders(
    model: Model,
    orders: str | Path | Sequence[OrderCut],
    *,
    points: str | Path | None = None,
    modal_damping: float = 0.0,
    accuracy: float | None = None,
    elements: int | None = None,
    progress: Progress = silent,
) -> OrderComparison:
    """Put order cuts of a run-up beside the response of a model, at the speeds of the rig.

    Args:
        model: with the excitations of the run-up, and the measured points as its points.
        orders: order cuts of a run-up: a file (CSV, or a universal file with dataset 58); in Python also what it holds.
        points: table of the sensors of a universal file (CSV: point,node,direction).
        modal_damping: as in `response`.
        accuracy: as in `response`.
        elements: as in `response`.
        progress: callable that is told fraction and step.

    Raises:
        ModelError: mistakes of the file. AnalysisError: points that the model has not, no order that the model has.
    """
    cuts = read_order_cuts(orders, points) if isinstance(orders, str | Path) else tuple(orders)
    strange = sorted({cut.point for cut in cuts} - set(model.points))
    if strange:
        known = ", ".join(model.points) or "none"
        raise AnalysisError(
            f"order cuts were measured at {', '.join(strange)}: no points of the model ([points]: {known})"
        )
    speeds = np.unique(np.concatenate([cut.speed_rpm for cut in cuts]))
    settings: dict[str, Any] = {"modal_damping": modal_damping, "accuracy": accuracy, "elements": elements}
    found = response(model, speeds=(speeds / RPM_PER_RAD_S).tolist(), **settings, progress=progress)
    rows = []
    without = []
    for cut in cuts:
        off = np.abs(found.ratio / cut.ratio - 1.0)
        if not off.size or off.min() > _SAME_ORDER:
            without.append(f"{cut.ratio:g} at {cut.point}")
            continue
        order = int(np.argmin(off))
        own = np.abs(found.acceleration[order, :, found.points.index(cut.point)])
        at = np.searchsorted(speeds, cut.speed_rpm)
        rig = np.full(len(speeds), np.nan)
        rig[at] = cut.amplitude
        levels = 20.0 * np.log10(np.maximum(np.array([cut.amplitude, own[at]]), _TINY))
        varies = float(np.std(levels, axis=1).min()) > 0.0
        sizes = [max(float(np.linalg.norm(values)), _TINY) for values in (own[at], cut.amplitude)]
        match = OrderMatch(
            cut.point,
            found.orders[order],
            cut.ratio,
            float(20.0 * np.log10(sizes[0] / sizes[1])),
            float(np.asarray(np.corrcoef(levels))[0, 1]) if varies else float("nan"),
            float(cut.speed_rpm[np.argmax(cut.amplitude)]),
            float(cut.speed_rpm[np.argmax(own[at])]),
        )
        rows.append((match, rig, own))
    if not rows:
        have = ", ".join(f"{ratio:g}" for ratio in found.ratio) or "none"
        raise AnalysisError(f"the model excites none of the measured orders ({'; '.join(without)}); it has {have}")
    return OrderComparison(
        model=model,
        speed_rpm=speeds,
        cuts=tuple(match for match, _, _ in rows),
        measured_acceleration=np.array([rig for _, rig, _ in rows]),
        computed_acceleration=np.array([own for _, _, own in rows]),
        without=tuple(without),
        dofs=found.dofs,
        left_out=found.left_out,
        warnings=found.warnings,
        method="response at the speeds of the rig",
    )


def _cuts_of_csv(file: Path) -> tuple[OrderCut, ...]:
    delimiter, rows = csv_rows(file, "a table of order cuts (CSV)")
    header = rows[0][1] if rows else []
    if header[:2] != ["speed_rpm", "order"] or len(header) < 3 or len(rows) < 2:
        expected = "a header speed_rpm,order and the names of points, and rows below it"
        raise ModelError([Problem(f"{file.name}:1", repr(",".join(header)), expected)], str(file))
    read = []
    problems = []
    for number, cells in rows[1:]:
        try:
            values = [number_of(cell) if cell else np.nan for cell in cells]
        except ValueError:
            values = []
        if len(values) != len(header) or not all(x > 0.0 for x in values[:2]) or min(values[2:]) < 0.0:
            expected = f"{len(header)} numbers: speed and order above 0, amplitudes from 0"
            problems.append(Problem(f"{file.name}:{number}", repr(delimiter.join(cells)[:60]), expected))
        read.append(values)
    if problems:
        raise ModelError(problems, str(file))
    table = np.array(read)
    found = []
    for ratio in np.unique(table[:, 1]):
        part = table[table[:, 1] == ratio]
        part = part[np.argsort(part[:, 0], kind="stable")]
        for name, amplitude in zip(header[2:], part.T[2:], strict=True):
            known = np.isfinite(amplitude)
            if known.any():
                found.append(OrderCut(name, float(ratio), part[known, 0], amplitude[known]))
    return tuple(found)


@recorded
def compare_spectrum(
    result: TransientResult, lines: SpectralLines, rig: Sequence[RigLine], tolerance: float = TOLERANCE
) -> RigSpectrum:
    """Put the nearest spectral line within a relative tolerance beside each rig line, and say why where there is none.

    Args:
        result: a transient.
        lines: lines in the spectrum of one of its histories, from `spectral_lines`.
        rig: lines of a rig.
        tolerance: largest |f_line / f_rig - 1|.

    Returns:
        One row a rig line.
    """
    excitations = excitation_lines(result.model, float(result.speed[-1]))
    near = np.full((2, len(rig)), np.nan)
    sources = [""] * len(rig)
    reasons = [""] * len(rig)
    for k, line in enumerate(rig):
        error = np.abs(lines.frequency_hz / line.frequency_hz - 1.0)
        best = int(np.argmin(error)) if error.size else -1
        if best >= 0 and error[best] <= tolerance:
            near[:, k] = (lines.frequency_hz[best], lines.amplitude[best])
            sources[k] = lines.source[best]
            continue
        # Whether anything in the model shakes at the frequency.
        reasons[k] = "nothing turns"
        if excitations:
            orders = [(abs(e.frequency_hz / line.frequency_hz - 1.0), e.name, e.frequency_hz) for e in excitations]
            off, name, f = min(orders)
            reasons[k] = (
                f"no shaft or mesh order: the nearest is {name} at {f:.2f} Hz; a forced response has no line here"
            )
            if off <= tolerance:
                reasons[k] = f"{name} at {f:.2f} Hz is there, but too weak at this place, or not excited by the model"
    hz, amplitude = near
    return RigSpectrum(
        lines.name,
        lines.unit,
        np.array([line.frequency_hz for line in rig]),
        tuple(line.label or "" for line in rig),
        hz,
        amplitude,
        tuple(sources),
        tuple(reasons),
        tolerance,
    )
