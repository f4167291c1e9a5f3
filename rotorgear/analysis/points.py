"""Named points of a model: where they are, and what a set of shapes does there."""

from __future__ import annotations

import numpy as np

from rotorgear.model.fields import DOF_NAMES
from rotorgear.model.mesh_geometry import node_positions
from rotorgear.model.model import Model
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
    table, _, part = point.on.partition(".")
    owner = getattr(model, table)[part]
    z = node_positions(model, part)[0] if table == "gears" else model.shafts[owner.shaft].station(owner.at)
    return owner.shaft, z
