"""Named points of a model: where they are, and what a set of shapes does there."""

from __future__ import annotations

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.model.checks.references import ON_SHAFTS
from rotorgear.model.layout.mesh_geometry import node_positions
from rotorgear.model.model import Model
from rotorgear.model.parts.fields import DOF_NAMES
from rotorgear.system.system import System


def point_amplitudes(system: System, shapes: np.ndarray) -> dict[str, np.ndarray]:
    """Complex amplitude of each named point in its direction: name -> (m,), from shapes (p, 6, m)."""
    found = {}
    for name, point in system.model.points.items():
        shaft, z = point_place(system.model, name)
        found[name] = shapes[system.nodes.at(shaft, z), DOF_NAMES.index(point.direction)]
    return found


def point_place(model: Model, name: str) -> tuple[str, float]:
    """Shaft and z in m of a named point."""
    point = model.points[name]
    if point.on is None:
        assert point.shaft is not None
        assert point.at is not None
        return point.shaft, model.shafts[point.shaft].station(point.at)
    return part_place(model, point.on)


def part_place(model: Model, address: str) -> tuple[str, float]:
    """Shaft and z in m of a part on a shaft, from its address; for a herringbone that of the helix at the smaller z."""
    table, _, part = address.partition(".")
    owner = getattr(model, table)[part]
    z = node_positions(model, part)[0] if table == "gears" else model.shafts[owner.shaft].station(owner.at)
    return owner.shaft, z


def named_place(model: Model, text: str) -> tuple[str, float, str]:
    """Shaft, z in m and direction from the name of a point, or from 'gears.wheel:x', a part and a direction.

    Raises:
        AnalysisError: neither; the sentence lists what there is.
    """
    if text in model.points:
        return *point_place(model, text), model.points[text].direction
    address, _, direction = text.rpartition(":")
    table, _, part = address.partition(".")
    if table in ON_SHAFTS and part in getattr(model, table) and direction in DOF_NAMES:
        return *part_place(model, address), direction
    points = f"the points {', '.join(model.points)}" if model.points else "a point (the model has none)"
    raise AnalysisError(
        f"'{text}' is no place: expected {points}, or a part and a direction such as 'bearings.left:x' "
        f"(tables {', '.join(ON_SHAFTS)}; directions {', '.join(DOF_NAMES)})"
    )
