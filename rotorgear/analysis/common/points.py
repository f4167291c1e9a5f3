"""Named points of a model: where they are, and what a set of shapes does there."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np
import scipy.sparse as sp

from rotorgear.errors import AnalysisError
from rotorgear.model.model import Model
from rotorgear.model.parts.fields import DOF_NAMES
from rotorgear.model.parts.references import ON_SHAFTS
from rotorgear.model.parts.shaft import Place
from rotorgear.quantity import QuantityError, parse_quantity
from rotorgear.results.modal import NodeTable
from rotorgear.system.system import System


def motion_points(model: Model) -> tuple[str, ...]:
    """The points that read a motion, in the order of the model; the others read a load (`read_loads`)."""
    return tuple(name for name, point in model.points.items() if point.quantity is None)


def point_amplitudes(system: System, nodes: NodeTable, shapes: np.ndarray) -> dict[str, np.ndarray]:
    """Complex amplitude of each named point of a motion in its direction: name -> (m,).

    They are read from shapes (p, 6, m) at all nodes and surfaces.
    """
    found = {}
    for name in motion_points(system.model):
        point = system.model.points[name]
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
    transform = system.dofs.transform
    rows = []
    for text in names:
        casing, where, dof = located(system.model, text)
        if isinstance(where, Place):
            rows.append(sp.csr_array(transform[[6 * system.nodes.at(*where) + dof]]))
            continue
        body = system.layout.casing(casing)
        row = np.zeros(body.size)
        if isinstance(where, str):
            row[body.seat(where).start + dof] = 1.0
        else:
            assert body.surface is not None
            row = np.asarray(body.surface.basis[where, dof])
        rows.append(sp.csr_array(row[None]) @ sp.csr_array(transform[system.nodes.of_casing(casing), :]))
    return sp.csr_array(sp.vstack(rows)) if rows else sp.csr_array(transform[[]])


def moving_rows(system: System, names: Sequence[str]) -> np.ndarray:
    """The same (s, n), dense, of places that can move.

    Raises:
        AnalysisError: a place that the model has not, or one that can't move.
    """
    R = point_rows(system, names).toarray()
    for text, row in zip(names, R, strict=True):
        if not row.any() and not located(system.model, text)[0]:
            raise AnalysisError(f"'{text}' can't move: a support, a rigid bearing or the motions of the model hold it")
    return R


def rotates(model: Model, text: str) -> bool:
    """Whether a place, as `point_rows` takes it, is one of a rotation: a moment acts there, not a force.

    Raises:
        AnalysisError: a place that the model has not.
    """
    return located(model, text)[2] > 2


def point_node(model: Model, nodes: NodeTable, text: str) -> tuple[int, int]:
    """Number of the node of a result that a place is at or nearest to, and number of the direction in x y z tx ty tz.

    Raises:
        AnalysisError: as `located` does; a seat of a casing is no node.
    """
    casing, where, dof = located(model, text)
    if isinstance(where, Place):
        return nodes.nearest(*where), dof
    if isinstance(where, str):
        raise AnalysisError(f"'{text}': shapes are known on the surface of a casing; name a place on it, not a seat")
    return int(nodes.of_casing(casing)[where]), dof


def coordinates(model: Model, text: str) -> tuple[np.ndarray, int]:
    """Coordinates (3,) in m, and number of the direction in x y z tx ty tz, of a place as `frf` takes it.

    Raises:
        AnalysisError: as `located` does.
    """
    casing, where, dof = located(model, text)
    if isinstance(where, Place):
        return model.shafts[where.shaft].frame.at(where.z), dof
    body = model.layout.casing(casing)
    if isinstance(where, str):
        return np.asarray(body.seat_points[body.seats.index(where)]), dof
    assert body.surface is not None
    return np.asarray(body.surface.points[where]), dof


def located(model: Model, text: str) -> tuple[str, Place | str | int, int]:
    """Where a place is, from the name of a point, a part and a direction such as "gears.wheel:x", or a place of a casing.

    Returns:
        The casing, "" for a place on a shaft; the place on the shaft, the seat, or the number of the point of the surface that
        is next to the place; and the number of the direction in x y z tilt_x tilt_y torsion.

    Raises:
        AnalysisError: the model has no such place; the sentence lists what there is.
    """
    point = model.points.get(text)
    if point is not None and point.quantity is not None:
        raise AnalysisError(
            f"'{text}' reads a load inside a shaft or coupling ({point.quantity}): a motion is needed here"
        )
    if point is not None and point.on_casing is not None:
        assert point.place is not None, "checked: a point on a casing has a place"
        text = f"{point.on}({'; '.join(f'{x!r} m' for x in point.place)}):{point.direction}"
    elif point is not None:
        return "", model.layout.place(f"points.{text}"), DOF_NAMES.index(point.direction)
    if text.startswith("casings."):
        return _on_casing(model, text)
    address, _, direction = text.rpartition(":")
    table, _, part = address.partition(".")
    if table in ON_SHAFTS and part in getattr(model, table) and direction in DOF_NAMES:
        return "", model.layout.place(address), DOF_NAMES.index(direction)
    points = f"the points {', '.join(model.points)}" if model.points else "a point (the model has none)"
    raise AnalysisError(
        f"'{text}' is no place: expected {points}, or a part and a direction such as 'bearings.left:x' "
        f"(tables {', '.join(ON_SHAFTS)}; directions {', '.join(DOF_NAMES)})"
    )


def _on_casing(model: Model, text: str) -> tuple[str, str | int, int]:
    """Casing, seat or number of the point of the surface, and number of the direction.

    The place is a seat, 'casings.box.left:x', or 'casings.box(0 mm; 280 mm; 200 mm):y', of which the displacements along x, y
    and z are known.
    """
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
        return name, found["seat"], dof
    if body.surface is None or dof > 2:
        why = "its surface is not known" if body.surface is None else "of a surface x, y and z are known"
        raise AnalysisError(f"'{text}': {why}")
    try:
        place = [parse_quantity(part.strip(), "length") for part in found["place"].split(";")]
    except QuantityError as error:
        raise AnalysisError(f"'{text}': expected {error}, three of them with ; between") from None
    if len(place) != 3:
        raise AnalysisError(f"'{text}': got {len(place)} coordinates, expected x; y; z")
    return name, int(np.argmin(np.sum((body.surface.points - np.array(place)) ** 2, axis=1))), dof
