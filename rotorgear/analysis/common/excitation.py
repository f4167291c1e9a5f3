"""What excites at which frequency: orders of every shaft and mesh, and sidebands of meshes."""

from __future__ import annotations

import math
from collections.abc import Sequence

from rotorgear.model.model import Model
from rotorgear.model.parts.carrier import written_name
from rotorgear.results.campbell import ExcitationOrder
from rotorgear.results.comparison import ExcitationLine

# Unbalance and misalignment of shafts; the first harmonics of a mesh carry most of its transmission error.
SHAFT_ORDERS = (1, 2)
MESH_ORDERS = (1, 2, 3)
# Kinds of lines, and the parts that they are of.
_PARTS = {"shaft": "shaft", "mesh": "mesh", "sideband": "mesh"}


def excitation_lines(model: Model, speed: float) -> tuple[ExcitationLine, ...]:
    """Return the lines at a speed of the input shaft in rad/s, equal ones of several shafts or meshes joined in one name."""
    turns = abs(speed) / (2.0 * math.pi)
    return tuple(ExcitationLine(line.name, line.order * turns) for line in excitation_orders(model)) if turns else ()


def excitation_orders(
    model: Model,
    shaft_orders: Sequence[float] = SHAFT_ORDERS,
    mesh_orders: Sequence[int] = MESH_ORDERS,
    sidebands: int = 0,
) -> tuple[ExcitationOrder, ...]:
    """Return all lines as multiples of the speed of the input shaft, equal ones of several shafts or meshes joined in one.

    Args:
        model: the model. Meshes of gears without numbers of teeth have no line.
        shaft_orders, mesh_orders: multiples of the speed of each shaft, of the frequency of each mesh.
        sidebands: how many at each side of every mesh order, at the distance of the speed of both shafts of the mesh.
    """
    train = model.layout.train
    found: dict[tuple[str, str, float], list[str]] = {}

    def add(kind: str, label: str, order: float, name: str) -> None:
        if order > 0.0 and name not in (names := found.setdefault((kind, label, round(order, 9)), [])):
            names.append(name)

    for name in model.shafts:
        for order in shaft_orders:
            add("shaft", f"{order:g}x", order * abs(train.ratio(name)), name)
    for name in model.meshes:
        once = model.layout.mesh_frequency(name, 2.0 * math.pi) or 0.0
        for order in mesh_orders:
            add("mesh", f"{order:g}x", order * once, name)
            # A fault of a gear comes round once a turn and modulates the mesh order: lines at the distance of its speed.
            for gear in model.layout.mesh(name).gears if once else ():
                for k in range(1, sidebands + 1):
                    distance = k * abs(model.layout.mesh(name).turns(gear))
                    add("sideband", f"{order:g}x + {k}x {gear.shaft}", order * once + distance, name)
                    add("sideband", f"{order:g}x - {k}x {gear.shaft}", order * once - distance, name)
    return tuple(
        ExcitationOrder(
            f"{_PARTS[kind]} {', '.join(dict.fromkeys(map(written_name, names)))} {label}", kind, tuple(names), order
        )
        for (kind, label, order), names in found.items()
    )
