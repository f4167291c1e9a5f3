"""Order cuts of a measured run-up beside the response of a model: the same orders at the same speeds.

A CSV file has the columns `speed_rpm`, `order` (frequency over that of the input shaft) and one for each named point, with
amplitudes in m/s^2 (rad/s^2 for rotations). A universal file has order functions (dataset 58): rpm along, the order as value on
the z-axis.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.response.response import response
from rotorgear.analysis.rig.csv_rows import csv_rows
from rotorgear.analysis.rig.sensor_table import read_sensor_table
from rotorgear.errors import AnalysisError, ModelError, Problem
from rotorgear.model.model import Model
from rotorgear.progress import Progress, silent
from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.frf_comparison import OrderComparison, OrderMatch
from rotorgear.uff.datasets import DERIVATIVES, RPM
from rotorgear.uff.read import read_universal

# Two orders are the same where their ratios agree to this; orders are read from a display.
_SAME_ORDER = 2e-3


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
                f"{path}: an order function is of type {function.numerator}; expected a motion (8, 11 or 12)"
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
    found = response(
        model,
        speeds=[float(rpm / RPM_PER_RAD_S) for rpm in speeds],
        modal_damping=modal_damping,
        accuracy=accuracy,
        elements=elements,
        progress=progress,
    )
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
        rows.append((_match(cut, found.orders[order], own[at]), rig, own))
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


def _match(cut: OrderCut, order: str, own: NDArray[np.float64]) -> OrderMatch:
    rig = cut.amplitude
    tiny = 1e-300
    levels = 20.0 * np.log10(np.maximum(np.array([rig, own]), tiny))
    varies = float(np.std(levels, axis=1).min()) > 0.0
    return OrderMatch(
        cut.point,
        order,
        cut.ratio,
        float(20.0 * np.log10(max(float(np.linalg.norm(own)), tiny) / max(float(np.linalg.norm(rig)), tiny))),
        float(np.asarray(np.corrcoef(levels))[0, 1]) if varies else float("nan"),
        float(cut.speed_rpm[np.argmax(rig)]),
        float(cut.speed_rpm[np.argmax(own)]),
    )


def _cuts_of_csv(file: Path) -> tuple[OrderCut, ...]:
    delimiter, rows = csv_rows(file, "a table of order cuts (CSV)")
    header = rows[0][1] if rows else []
    if header[:2] != ["speed_rpm", "order"] or len(header) < 3 or len(rows) < 2:
        expected = "a header speed_rpm,order and the names of points, and rows below it"
        raise ModelError([Problem(f"{file.name}:1", repr(",".join(header)), expected)], str(file))
    table = []
    problems = []
    for number, cells in rows[1:]:
        try:
            values = [float(cell) if cell else np.nan for cell in cells]
        except ValueError:
            values = []
        if (
            len(values) != len(header)
            or not all(value > 0.0 for value in values[:2])
            or min(values[2:], default=0.0) < 0.0
        ):
            expected = f"{len(header)} numbers: speed and order above 0, amplitudes from 0"
            problems.append(Problem(f"{file.name}:{number}", repr(delimiter.join(cells)[:60]), expected))
        table.append(values)
    if problems:
        raise ModelError(problems, str(file))
    rows_by_number = np.array(table)
    found = []
    for ratio in np.unique(rows_by_number[:, 1]):
        part = rows_by_number[rows_by_number[:, 1] == ratio]
        part = part[np.argsort(part[:, 0], kind="stable")]
        for k, name in enumerate(header[2:], start=2):
            known = np.isfinite(part[:, k])
            if known.any():
                found.append(OrderCut(name, float(ratio), part[known, 0], part[known, k]))
    return tuple(found)
