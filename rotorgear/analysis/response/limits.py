"""Limits of a run-up from a table: targets over speed of meshes, bearings and points, all orders together or one by one.

A row is a corner of a line: `at`, `speed_rpm`, and the limit as `amplitude_N` (half of peak to peak), `rms_N` (effective value,
amplitude over the root of two) or `level_dB` (20 log10 of the effective value over the reference of ISO 1683). With a column
`order` a line holds for that order alone.
"""

from __future__ import annotations

import math
import re
from collections.abc import Collection
from pathlib import Path
from typing import NamedTuple

import numpy as np

from rotorgear.errors import AnalysisError, ModelError, Problem
from rotorgear.files.numbers import number_of
from rotorgear.files.rows import csv_rows
from rotorgear.model.model import Model
from rotorgear.quantity import RPM_PER_RAD_S, QuantityError, did_you_mean, parse_quantity
from rotorgear.results.response import LimitLine, ResponseResult, reference_of, straight_between, unit_at

_EXPECTED = "expected a table of limits (CSV), such as at,speed_rpm,amplitude_N and below it stage,1000,250"
_KINDS = ("amplitude", "rms", "level")
_DIMENSIONS = {"N": "force", "N m": "torque", "m/s^2": "acceleration"}


class Corner(NamedTuple):
    """A row of the table: speed in rpm and amplitude in the unit of what it limits."""

    speed_rpm: float
    amplitude: float


Lines = dict[tuple[str, str], list[Corner]]


def read_limits(path: str | Path, model: Model) -> Lines:
    """Corners by what they limit and the order, "" for all together, rising in speed.

    Raises:
        ModelError: every mistake of the file at once, each with file, line and column.
    """
    file = Path(path)
    _, rows = csv_rows(file, _EXPECTED)
    if len(rows) < 2:
        raise ModelError([Problem(file.name, "", _EXPECTED)], str(file))
    (number, header), *body = rows
    names = [re.sub(r"[\s_]*[\[(]\s*(.*?)\s*[\])]\Z", r"_\1", text[:100]).strip() for text in header]
    values = [k for k, name in enumerate(names) if name.partition("_")[0].lower() in _KINDS]
    columns = {name.lower(): k for k, name in enumerate(names)}
    known = {"at", "speed_rpm", "order"}
    problems = [
        Problem(f"{file.name}:{number}:{text}", "", "unknown column", "valid: at, speed_rpm, order and the limit")
        for k, text in enumerate(header)
        if text and k not in values and names[k].lower() not in known
    ]
    bare = any("_" not in names[k] for k in values)
    if len(values) != 1 or bare or not {"at", "speed_rpm"} <= columns.keys():
        wanted = "expected columns at, speed_rpm and one of amplitude, rms, level with its unit (amplitude_N, level_dB)"
        problems.append(Problem(f"{file.name}:{number}", "", wanted, f"columns found: {', '.join(header)}"))
    if problems:
        raise ModelError(problems, str(file))
    kind, _, unit = names[values[0]].partition("_")
    there = [*model.meshes, *model.bearings, *model.points]
    found: Lines = {}
    for number, cells in body:
        cells = [*cells, *[""] * (len(header) - len(cells))]
        at = cells[columns["at"]]
        order = cells[columns["order"]] if "order" in columns else ""
        where = f"{file.name}:{number}"
        name = at.rpartition(".")[2]
        if name not in there:
            wanted = f"a mesh, bearing or point of the model: {', '.join(there) or 'none'}"
            problems.append(Problem(f"{where}:at", repr(at), wanted, did_you_mean(at, there)))
            continue
        try:
            speed = number_of(cells[columns["speed_rpm"]])
            limit = _amplitude(cells[values[0]], kind.lower(), unit, unit_at(model, name))
        except ValueError as error:
            problems.append(Problem(where, ",".join(cells), str(error)))
            continue
        corners = found.setdefault((name, order), [])
        if speed < 0.0 or (corners and speed <= corners[-1].speed_rpm):
            problems.append(Problem(f"{where}:speed_rpm", f"{speed:g}", "speeds that rise from row to row of one line"))
        corners.append(Corner(speed, limit))
    for (name, order), corners in found.items() if not problems else ():
        if len(corners) < 2:
            what = f"{name}, order {order}" if order else name
            problems.append(Problem(file.name, f"one row of {what}", "two rows or more: they are corners of a line"))
    if problems:
        raise ModelError(problems, str(file))
    return found


def _amplitude(cell: str, kind: str, unit: str, wanted: str) -> float:
    """A limit as an amplitude in the unit of what it limits.

    Raises:
        QuantityError: no number, another unit, or a limit of 0 or less.
    """
    if kind == "level":
        if unit.lower() != "db":
            raise QuantityError(f"a level in dB (level_dB); got the unit '{unit}'")
        return math.sqrt(2.0) * reference_of(wanted)[0] * 10.0 ** (parse_quantity(cell, "ratio") / 20.0)
    number = parse_quantity(cell, "ratio")
    if wanted in _DIMENSIONS:
        number *= parse_quantity(f"1 {unit}", _DIMENSIONS[wanted])
    elif unit != wanted:
        raise QuantityError(f"a limit in {wanted}; got the unit '{unit}'")
    if not 0.0 < number < math.inf:
        raise QuantityError("a limit above 0")
    return number * (math.sqrt(2.0) if kind == "rms" else 1.0)


def check_limits(lines: Lines, orders: Collection[str], speeds: np.ndarray) -> None:
    """AnalysisError where a line limits an order that the run-up has not, or where none of its speeds (rad/s) lies in it."""
    rpm = np.abs(speeds) * RPM_PER_RAD_S
    for (name, order), corners in lines.items():
        first = corners[0].speed_rpm
        last = corners[-1].speed_rpm
        if not np.any((rpm >= first) & (rpm <= last)):
            reach = f"from {first:g} to {last:g} rpm; the run-up has no speed there"
            raise AnalysisError(f"limits: that of {name} is {reach}: ask for speeds in it (--from, --to)")
        if order and order not in orders:
            hint = did_you_mean(order, orders, f"there are {', '.join(list(orders)[:8])}")
            raise AnalysisError(f"limits: the run-up has no order '{order}', which limits {name} ({hint})")


def against(result: ResponseResult, lines: Lines) -> tuple[LimitLine, ...]:
    """How a run-up stands against its limits, which `check_limits` has let pass."""
    rpm = np.abs(result.speed_rpm)
    rising = np.argsort(rpm)
    steps = np.gradient(rpm[rising]) if len(rpm) > 1 else np.zeros(1)
    found = []
    for (name, order), corners in lines.items():
        value = result.amplitude_over_speed(name, order)
        speeds, limits = (np.array(numbers) for numbers in zip(*corners, strict=True))
        allowed = straight_between(speeds, limits, rpm)
        ratio = np.where(np.isnan(allowed), 0.0, value / allowed)
        worst = int(np.argmax(ratio))
        above = float(steps[ratio[rising] > 1.0].sum())
        numbers = (float(ratio[worst]), float(rpm[worst]), float(value[worst]), float(allowed[worst]), above)
        found.append(LimitLine(name, order, unit_at(result.model, name), speeds, limits, *numbers))
    return tuple(found)
