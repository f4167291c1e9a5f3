"""Measured mode shapes from a universal file (UFF, dataset 55), at the sensors of a table.

The table of sensors is CSV with the columns `point` (of the model), `node` (of the universal file) and `direction`: x, y, z,
rx, ry or rz, with a minus sign where the sensor looks the other way. Rows that start with # are skipped.
"""

from __future__ import annotations

import csv
import io
import math
from contextlib import redirect_stdout
from pathlib import Path
from typing import Any

import numpy as np

from rotorgear.analysis.rig.measured import Measured
from rotorgear.errors import AnalysisError, MissingExtraError, ModelError, Problem
from rotorgear.results.comparison import RigLine

_COLUMNS = ("point", "node", "direction")
_DIRECTIONS = {"x": 0, "y": 1, "z": 2, "rx": 3, "ry": 4, "rz": 5}
# Dataset 55: mode shapes, real or complex, and those of a damped system by its eigenvalue.
_SHAPES = 55
_NORMAL = 2
_COMPLEX_FIRST_ORDER = 3
_COMPLEX = 7


def read_rig_shapes(path: str | Path, points: str | Path) -> Measured:
    """Return frequencies and shapes of a universal file, at the sensors of a table.

    Args:
        path: of the universal file, ASCII or with binary sets.
        points: of the table of sensors (CSV).

    Returns:
        A line for each shape, in the order of the file, and the shapes at the points of the table (n, s).

    Raises:
        MissingExtraError: pyuff is not installed.
        ModelError: a file that can't be read, mistakes in the table, a sensor whose node no shape has.
        AnalysisError: a universal file without shapes, or whose shapes have no frequency.
    """
    sensors = _read_sensors(Path(points))
    sets = _read_sets(Path(path))
    shapes = [data for data in sets if int(data.get("type", 0)) == _SHAPES]
    if not shapes:
        kinds = ", ".join(sorted({str(int(data.get("type", 0))) for data in sets})) or "none"
        raise AnalysisError(f"{path}: no mode shapes (dataset 55) in it; its datasets: {kinds}")
    lines = []
    rows = []
    for number, data in enumerate(shapes, start=1):
        lines.append(_line(data, number, path))
        rows.append([_value(data, node, direction, sign, path) for node, direction, sign in sensors.values()])
    table = np.array(rows)
    for column, name in enumerate(sensors):
        if not np.isfinite(table[:, column]).any():
            node = sensors[name][0]
            raise ModelError(
                [Problem(f"point {name}", f"node {node}", "a node that some shape of the file has")], str(path)
            )
    return Measured(tuple(lines), tuple(sensors), table)


def _read_sets(file: Path) -> list[dict[str, Any]]:
    try:
        import pyuff
    except ImportError:
        raise MissingExtraError("Reading universal files", "pyuff", "rig") from None
    if not file.is_file():
        raise ModelError([Problem(str(file), "", "a universal file (UFF)", "there is no such file")])
    try:
        with redirect_stdout(io.StringIO()):  # it prints what it can't read
            sets = pyuff.UFF(str(file)).read_sets()
    except Exception as error:  # pyuff raises whatever the broken file makes its parsers meet
        reason = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise ModelError([Problem(str(file), "", "a universal file (UFF) that is whole", reason)]) from None
    if not sets:
        raise ModelError([Problem(str(file), "", "a universal file (UFF) with datasets", "it has none")])
    return [sets] if isinstance(sets, dict) else list(sets)


def _line(data: dict[str, Any], number: int, path: str | Path) -> RigLine:
    """Frequency and damping ratio of a shape: of a normal mode as they stand, of a complex one from its eigenvalue."""
    kind = int(data.get("analysis_type", 0))
    if kind == _NORMAL:
        frequency = float(data.get("freq", math.nan))
        damping = float(data.get("modal_damp_vis", 0.0))
    elif kind in (_COMPLEX_FIRST_ORDER, _COMPLEX):
        eigenvalue = complex(data.get("eig", math.nan))
        frequency = abs(eigenvalue) / (2.0 * math.pi)
        damping = -eigenvalue.real / abs(eigenvalue) if abs(eigenvalue) > 0.0 else math.nan
    else:
        raise AnalysisError(
            f"{path}: shape {number} is of analysis type {kind}; expected a normal (2) or complex (3) mode"
        )
    if not (math.isfinite(frequency) and frequency > 0.0):
        raise AnalysisError(f"{path}: shape {number} has the frequency {frequency:g} Hz; expected a positive one")
    label = str(data.get("id4", "")).strip()
    return RigLine(frequency, "" if label.lower() == "none" else label, None, damping if 0.0 < damping < 1.0 else None)


def _value(data: dict[str, Any], node: int, direction: int, sign: float, path: str | Path) -> complex:
    """Displacement of a node along a direction; NaN where the shape has none."""
    where = np.flatnonzero(np.asarray(data["node_nums"], dtype=int) == node)
    component = data.get(f"r{direction + 1}")
    if not where.size or component is None:
        return complex(math.nan)
    value = complex(np.asarray(component)[where[0]])
    if not np.isfinite(value):
        raise AnalysisError(f"{path}: node {node} has the displacement {value}; expected finite numbers")
    return sign * value


def _read_sensors(file: Path) -> dict[str, tuple[int, int, float]]:
    """Point -> node, direction, sign."""
    try:
        text = file.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        raise ModelError([Problem(str(file), "", "a table of sensors (CSV)", reason)]) from None
    rows = [(k, row) for k, row in enumerate(text.splitlines(), start=1) if row.strip() and not row.startswith("#")]
    if not rows:
        raise ModelError([Problem(str(file), "", "a header row point,node,direction and a row for each sensor")])
    delimiter = max(",;\t", key=rows[0][1].count)
    header = [cell.strip().lower() for cell in rows[0][1].split(delimiter)]
    missing = [name for name in _COLUMNS if name not in header]
    if missing:
        raise ModelError(
            [Problem(f"{file.name}:{rows[0][0]}", ", ".join(header), f"the columns {', '.join(_COLUMNS)}")], str(file)
        )
    found: dict[str, tuple[int, int, float]] = {}
    problems = []
    for number, row in rows[1:]:
        cells = [cell.strip() for cell in next(csv.reader([row], delimiter=delimiter, skipinitialspace=True))]
        given = dict(zip(header, cells, strict=False))
        address = f"{file.name}:{number}"
        direction = given.get("direction", "").lower()
        if not given.get("node", "").isdecimal():
            problems.append(Problem(f"{address}:node", repr(given.get("node", "")), "the number of a node"))
        elif direction.lstrip("+-") not in _DIRECTIONS:
            expected = f"one of {', '.join(_DIRECTIONS)}, with a minus sign where the sensor looks the other way"
            problems.append(Problem(f"{address}:direction", repr(given.get("direction", "")), expected))
        elif not given.get("point"):
            problems.append(Problem(f"{address}:point", "", "the name of a point of the model"))
        elif given["point"] in found:
            problems.append(Problem(f"{address}:point", repr(given["point"]), "every point once"))
        else:
            sign = -1.0 if direction.startswith("-") else 1.0
            found[given["point"]] = (int(given["node"]), _DIRECTIONS[direction.lstrip("+-")], sign)
    if not found and not problems:
        problems.append(Problem(file.name, "", "a row for each sensor below the header"))
    if problems:
        raise ModelError(problems, str(file))
    return found
