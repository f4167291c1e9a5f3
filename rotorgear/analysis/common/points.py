"""Named points of a model: where they are, and what a set of shapes does there."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np
import scipy.sparse as sp

from rotorgear.errors import AnalysisError
from rotorgear.model.checks.names import ON_SHAFTS
from rotorgear.model.model import Model
from rotorgear.model.parts.fields import DOF_NAMES
from rotorgear.quantity import QuantityError, parse_quantity
from rotorgear.results.modal import NodeTable
from rotorgear.system.system import System


def point_amplitudes(system: System, nodes: NodeTable, shapes: np.ndarray) -> dict[str, np.ndarray]:
    """Complex amplitude of each named point in its direction: name -> (m,), from shapes (p, 6, m) at all nodes and surfaces."""
    found = {}
    for name, point in system.model.points.items():
        if point.on_casing is not None:
            found[name] = shapes[point_node(system.model, nodes, name)]
            continue
        node = system.nodes.at(*system.layout.place(f"points.{name}"))
        found[name] = shapes[node, DOF_NAMES.index(point.direction)]
    return found


def point_rows(system: System, names: Sequence[str]) -> sp.csr_array:
    """Rows R (s, n) with the displacement R q of places along their directions, from the free dofs q (n).

    Args:
        system: an assembled model.
        names: of points, or places as `frf` takes them: "bearings.left:x", "casings.box(0 mm; 280 mm; 200 mm):y".

    Raises:
        AnalysisError: a place that the model has not.
    """
    rows = []
    for text in names:
        name = spelled(system.model, text)
        if name.startswith("casings."):
            casing, row = casing_row(system.model, name)
            rows.append(
                sp.csr_array(row[None]) @ sp.csr_array(system.dofs.transform[system.nodes.of_casing(casing), :])
            )
            continue
        shaft, z, direction = named_place(system.model, name)
        dof = 6 * system.nodes.at(shaft, z) + DOF_NAMES.index(direction)
        rows.append(sp.csr_array(system.dofs.transform[[dof]]))
    return sp.csr_array(sp.vstack(rows)) if rows else sp.csr_array(system.dofs.transform[[]])


def moving_rows(system: System, names: Sequence[str]) -> np.ndarray:
    """The same (s, n), dense, of places that can move.

    Raises:
        AnalysisError: a place that the model has not, or one that can't move.
    """
    R = point_rows(system, names).toarray()
    for text, row in zip(names, R, strict=True):
        if not row.any() and not spelled(system.model, text).startswith("casings."):
            raise AnalysisError(f"'{text}' can't move: a support or the motions of the model hold it")
    return R


def rotates(model: Model, text: str) -> bool:
    """Whether a place, as `point_rows` takes it, is one of a rotation: a moment acts there, not a force.

    Raises:
        AnalysisError: a place that the model has not.
    """
    there = spelled(model, text)
    if there.startswith("casings."):
        return casing_place(model, there)[1] > 2
    return named_place(model, there)[2] in DOF_NAMES[3:]


def spelled(model: Model, text: str) -> str:
    """A place as it is; a named point on a casing as its place, 'casings.box(0.0 m; 0.28 m; 0.2 m):y'."""
    point = model.points.get(text)
    if point is None or point.on is None or point.on_casing is None:
        return text
    assert point.place is not None, "checked: a point on a casing has a place"
    return f"{point.on}({'; '.join(f'{x!r} m' for x in point.place)}):{point.direction}"


def named_place(model: Model, text: str) -> tuple[str, float, str]:
    """Shaft, z in m and direction from the name of a point, or from 'gears.wheel:x', a part and a direction.

    Raises:
        AnalysisError: neither; the sentence lists what there is.
    """
    if text in model.points:
        return *model.layout.place(f"points.{text}"), model.points[text].direction
    address, _, direction = text.rpartition(":")
    table, _, part = address.partition(".")
    if table in ON_SHAFTS and part in getattr(model, table) and direction in DOF_NAMES:
        return *model.layout.place(address), direction
    points = f"the points {', '.join(model.points)}" if model.points else "a point (the model has none)"
    raise AnalysisError(
        f"'{text}' is no place: expected {points}, or a part and a direction such as 'bearings.left:x' "
        f"(tables {', '.join(ON_SHAFTS)}; directions {', '.join(DOF_NAMES)})"
    )


def point_node(model: Model, nodes: NodeTable, text: str) -> tuple[int, int]:
    """Number of the node of a result that a place is at or nearest to, and number of the direction in x y z tx ty tz.

    Raises:
        AnalysisError: as `named_place` and `casing_place` do; a seat of a casing is no node.
    """
    there = spelled(model, text)
    if there.startswith("casings."):
        casing, dof, seat, point = casing_place(model, there)
        if seat:
            raise AnalysisError(
                f"'{text}': shapes are known on the surface of a casing; name a place on it in place of a seat"
            )
        return int(nodes.of_casing(casing)[point]), dof
    shaft, z, direction = named_place(model, text)
    return nodes.nearest(shaft, z), DOF_NAMES.index(direction)


def coordinates(model: Model, text: str) -> tuple[np.ndarray, int]:
    """Coordinates (3,) in m, and number of the direction in x y z tx ty tz, of a place as `frf` takes it.

    Raises:
        AnalysisError: as `named_place` and `casing_row` do.
    """
    text = spelled(model, text)
    if text.startswith("casings."):
        name, dof, seat, point = casing_place(model, text)
        body = model.layout.casing(name)
        if seat:
            return np.asarray(body.seat_points[body.seats.index(seat)]), dof
        assert body.surface is not None
        return np.asarray(body.surface.points[point]), dof
    shaft, z, direction = named_place(model, text)
    x, y = model.shafts[shaft].position or (0.0, 0.0)
    return np.array([x, y, z]), DOF_NAMES.index(direction)


def casing_row(model: Model, text: str) -> tuple[str, np.ndarray]:
    """Casing and row on its coordinates from 'casings.box.left:x', a seat, or 'casings.box(0 mm; 280 mm; 200 mm):y'.

    The latter is the point of its surface that is next to the place; only its displacements along x, y and z are known.

    Raises:
        AnalysisError: no such casing, seat, direction, or a casing without a surface.
    """
    name, dof, seat, point = casing_place(model, text)
    body = model.layout.casing(name)
    if not seat:
        assert body.surface is not None
        return name, np.asarray(body.surface.basis[point, dof])
    row = np.zeros(body.size)
    row[body.seat(seat).start + dof] = 1.0
    return name, row


def casing_place(model: Model, text: str) -> tuple[str, int, str, int]:
    """Casing, number of the direction, seat ("" for none), and number of the point of the surface (-1 for a seat)."""
    address, _, direction = text.rpartition(":")
    found = re.fullmatch(r"casings\.(?P<name>[\w -]+?)(?:\.(?P<seat>[\w -]+)|\((?P<place>[^()]*)\))", address)
    if found is None or found["name"] not in model.casings or direction not in DOF_NAMES:
        raise AnalysisError(
            f"'{text}' is no place of a casing: expected a seat such as 'casings.box.left:x', or a place such as "
            f"'casings.box(0 mm; 280 mm; 200 mm):y' (casings {', '.join(model.casings) or 'none'}; "
            f"directions {', '.join(DOF_NAMES)})"
        )
    name = found["name"]
    body = model.layout.casing(name)
    dof = DOF_NAMES.index(direction)
    if found["seat"] is not None:
        if found["seat"] not in body.seats:
            raise AnalysisError(f"'{text}': casing '{name}' has no such seat; there is: {', '.join(body.seats)}")
        return name, dof, found["seat"], -1
    if body.surface is None or dof > 2:
        why = "its surface is not known" if body.surface is None else "of a surface x, y and z are known"
        raise AnalysisError(f"'{text}': {why}")
    try:
        place = [parse_quantity(part.strip(), "length") for part in found["place"].split(";")]
    except QuantityError as error:
        raise AnalysisError(f"'{text}': expected {error}, three of them with ; between") from None
    if len(place) != 3:
        raise AnalysisError(f"'{text}': got {len(place)} coordinates, expected x; y; z")
    return name, dof, "", int(np.argmin(np.sum((body.surface.points - np.array(place)) ** 2, axis=1)))
