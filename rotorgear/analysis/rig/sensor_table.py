"""Where the sensors of a rig sit on the model: by a table of points, or by the coordinates of their nodes.

The table is CSV with the columns `point`, `node` (of the universal file) and `direction`: x, y, z, rx, ry or rz, with a minus
sign where the sensor looks the other way. `point` is a point of the model, a part such as bearings.left, or a place on the
surface of a casing, casings.box(0 mm; 280 mm; 200 mm); an empty one is the nearest of them to the coordinates of the node. Rows
that start with # are skipped.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rotorgear.analysis.common.points import coordinates, located
from rotorgear.errors import AnalysisError, ModelError, Problem
from rotorgear.files.numbers import is_count
from rotorgear.files.rows import csv_rows
from rotorgear.model.model import Model
from rotorgear.model.parts.fields import DOF_NAMES
from rotorgear.model.parts.references import ON_SHAFTS
from rotorgear.model.parts.shaft import Place as ShaftPlace
from rotorgear.note import Note
from rotorgear.quantity import counted
from rotorgear.uff.datasets import AXES, Nodes, UniversalFile

_COLUMNS = ("point", "node", "direction")
# Nodes farther from every place of the model than its own size are given in another unit.
_FAR = 1.0
# Nodes farther away than this share of the model's size are named in a warning.
_NEAR = 0.02


@dataclass(frozen=True)
class Sensor:
    """A sensor on the model.

    Attributes:
        place: name of a point, or a place as `frf` takes it; "" where the coordinates of the node have to say it.
        node: its number in the universal file.
        direction: 0 to 5 for x y z rx ry rz, in the file.
        sign: -1 where it looks the other way.
        distance: from the node to the place in m, where the place was found by coordinates.
    """

    place: str
    node: int
    direction: int
    sign: float
    distance: float | None = None


def sensors_of(
    file: UniversalFile, name: str, table: str | Path | None, model: Model | None
) -> tuple[list[Sensor], list[str]]:
    """Return the sensors of a universal file with their places on a model, and sentences that warn.

    Args:
        file: what was read.
        name: of the file, for messages.
        table: of sensors (CSV); None: every node with shapes or functions, at the nearest place.
        model: needed where a place is found by coordinates.

    Raises:
        ModelError: mistakes in the table; no coordinates of a node without a place.
        AnalysisError: nodes that are nowhere near the model; none at all.
    """
    if table is not None:
        found = read_sensor_table(Path(table))
    else:
        # All nodes and directions in which a shape or function moves, by node.
        moving: set[tuple[int, int]] = set()
        for shape in file.shapes:
            for node, row in zip(shape.nodes, np.abs(shape.values), strict=True):
                moving |= {(int(node), int(axis)) for axis in np.flatnonzero(row > 0.0)}
        for function in file.functions:
            for node, direction in (function.response, function.reference):
                if node and direction:
                    moving.add((node, abs(direction) - 1))
        found = [Sensor("", node, axis, 1.0) for node, axis in sorted(moving)]
    if not found:
        raise AnalysisError(f"{name}: no node of it moves in any direction")
    return _placed(found, file.nodes, name, model)


def read_sensor_table(file: Path) -> list[Sensor]:
    """Return the rows of a table of sensors.

    Raises:
        ModelError: all mistakes at once, each with its line and column.
    """
    _, rows = csv_rows(file, "a table of sensors (CSV)")
    if not rows:
        raise ModelError([Problem(str(file), "", "a header row point,node,direction and a row for each sensor")])
    header = [cell.lower() for cell in rows[0][1]]
    if not set(_COLUMNS) <= set(header):
        problem = Problem(f"{file.name}:{rows[0][0]}", ", ".join(header), f"the columns {', '.join(_COLUMNS)}")
        raise ModelError([problem], str(file))
    found: dict[str, Sensor] = {}
    problems = []
    for number, cells in rows[1:]:
        given = dict.fromkeys(_COLUMNS, "") | dict(zip(header, cells, strict=False))
        address = f"{file.name}:{number}"
        point = given["point"]
        direction = given["direction"].lower()
        if not is_count(given["node"]):
            problems.append(Problem(f"{address}:node", repr(given["node"]), "the number of a node"))
            continue
        if direction.lstrip("+-") not in AXES:
            expected = f"one of {', '.join(AXES)}, with a minus sign where the sensor looks the other way"
            problems.append(Problem(f"{address}:direction", repr(given["direction"]), expected))
            continue
        axis = AXES.index(direction.lstrip("+-"))
        sensor = Sensor(place_text(point, axis), int(given["node"]), axis, -1.0 if direction.startswith("-") else 1.0)
        key = sensor.place or f"{sensor.node}:{axis}"
        if key in found:
            problems.append(Problem(f"{address}:point", repr(point), "every point once"))
        found[key] = sensor
    if not found and not problems:
        problems.append(Problem(file.name, "", "a row for each sensor below the header"))
    if problems:
        raise ModelError(problems, str(file))
    return list(found.values())


def place_text(point: str, axis: int) -> str:
    """A place as `frf` takes it, of a cell of the table: parts and casings get the direction of their sensor."""
    is_part = re.match(rf"(?:{'|'.join((*ON_SHAFTS, 'casings'))})\.", point) is not None
    if not is_part or point.rpartition(":")[2] in DOF_NAMES:
        return point
    return f"{point}:{DOF_NAMES[axis]}"


def _placed(
    sensors: list[Sensor], nodes: Nodes | None, name: str, model: Model | None
) -> tuple[list[Sensor], list[str]]:
    """The sensors with a place each, those without at the place nearest to their node."""
    unknown = sorted({sensor.node for sensor in sensors if not sensor.place})
    if not unknown:
        return sensors, []
    if model is None:
        raise AnalysisError(
            f"{name}: the model is needed to find the places of nodes {_some(unknown)}, or name them in a table"
        )
    at = {} if nodes is None else dict(zip(nodes.numbers.tolist(), nodes.positions, strict=True))
    without = [node for node in unknown if node not in at]
    if without:
        expected = "coordinates of the node (dataset 15), or a table of sensors (--points) that names its place"
        raise ModelError([Problem(f"node {_some(without)}", "", expected)], name)
    places, positions = places_of(model)
    size = float(np.max(np.ptp(positions, axis=0)))
    # Distance to the nearest place, and that place, of each node.
    distances = {node: np.linalg.norm(positions - at[node], axis=1) for node in unknown}
    nearest = {node: (float(away.min()), places[int(away.argmin())]) for node, away in distances.items()}
    farthest = max(nearest, key=lambda node: nearest[node][0])
    most, place = nearest[farthest]
    if most > _FAR * size:
        raise AnalysisError(
            f"{name}: node {farthest} lies {most:.4g} m from the nearest place of a model that is {size:.4g} m long: correct its "
            "units (dataset 164), or name the places of the nodes in a table (--points)"
        )
    notes: list[str] = []
    if away := sum(distance > _NEAR * size for distance, _ in nearest.values()):
        what = f"{away} of {len(unknown)} nodes lie more than {1e3 * _NEAR * size:.3g} mm from a place of the model"
        notes.append(Note("", f"{what}, node {farthest} the farthest", f"{1e3 * most:.3g} mm from {place}"))
    found: dict[str, Sensor] = {}
    for sensor in sensors:
        if not sensor.place:
            distance, place = nearest[sensor.node]
            if place.startswith("casings.") and sensor.direction > 2:
                continue  # surfaces of casings only displace
            _require_plain_axes(model, place, sensor.node)
            sensor = replace(sensor, place=f"{place}:{DOF_NAMES[sensor.direction]}", distance=distance)
        other = found.get(sensor.place)
        if other is None or (other.distance or 0.0) > (sensor.distance or 0.0):
            found[sensor.place] = sensor
    if fewer := len(sensors) - len(found):
        notes.append(Note("", f"{counted(fewer, 'sensors')} left out: another one at the same place is nearer"))
    return list(found.values()), notes


def _require_plain_axes(model: Model, place: str, node: int) -> None:
    """AnalysisError for a node of a file, which looks along the axes of the model, at a place on a shaft with others."""
    where = located(model, f"{place}:x")[1]
    if isinstance(where, ShaftPlace) and model.shafts[where.shaft].frame.is_turned:
        raise AnalysisError(
            f"node {node} lies nearest to {place}, and shaft '{where.shaft}' does not have the axes of the file: name the place "
            "and its direction in the frame of the shaft in a table (--points)"
        )


def places_of(model: Model) -> tuple[list[str], NDArray[np.float64]]:
    """All places of parts on shafts and of the surfaces of casings, without direction, and their coordinates in m (n, 3)."""
    names = [f"{table}.{part}" for table in ON_SHAFTS for part in getattr(model, table)]
    positions = [coordinates(model, f"{name}:x")[0] for name in names]
    for casing in model.casings:
        surface = model.layout.casing(casing).surface
        if surface is not None:
            names += [casing_text(casing, point) for point in surface.points]
            positions += list(surface.points)
    if not names:
        raise AnalysisError("the model has no part on a shaft where a sensor could be: give it [points]")
    return names, np.array(positions)


def casing_text(casing: str, point: Iterable[float]) -> str:
    """A point on the surface of a casing as `frf` takes it."""
    return f"casings.{casing}({'; '.join(f'{1e3 * x:.6g} mm' for x in point)})"


def _some(numbers: list[int]) -> str:
    more = f" and {len(numbers) - 5} more" if len(numbers) > 5 else ""
    return ", ".join(map(str, numbers[:5])) + more
