"""Named points of a model: where they are, and what a set of shapes does there."""

from __future__ import annotations

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.model.checks.references import ON_SHAFTS
from rotorgear.model.model import Model
from rotorgear.model.parts.fields import DOF_NAMES
from rotorgear.system.system import System


def point_amplitudes(system: System, shapes: np.ndarray) -> dict[str, np.ndarray]:
    """Complex amplitude of each named point in its direction: name -> (m,), from shapes (p, 6, m)."""
    found = {}
    for name, point in system.model.points.items():
        node = system.nodes.at(*system.layout.place(f"points.{name}"))
        found[name] = shapes[node, DOF_NAMES.index(point.direction)]
    return found


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
