"""Excitation lines at a speed: orders of every shaft and of every mesh."""

from __future__ import annotations

import math

from rotorgear.model.model import Model
from rotorgear.model.train import mesh_frequency, walk
from rotorgear.results.comparison import ExcitationLine

# Unbalance and misalignment of shafts; the first harmonics of a mesh carry most of its transmission error.
SHAFT_ORDERS = (1, 2)
MESH_ORDERS = (1, 2, 3)


def excitation_lines(model: Model, speed: float) -> tuple[ExcitationLine, ...]:
    """Return the lines at a speed of the input shaft in rad/s, equal ones of several shafts or meshes joined in one name."""
    train, _ = walk(model)
    found: dict[tuple[str, int, float], list[str]] = {}
    for name in model.shafts:
        turns = abs(train.ratio(name) * speed) / (2.0 * math.pi)
        for order in SHAFT_ORDERS if turns > 0.0 else ():
            found.setdefault(("shaft", order, round(order * turns, 9)), []).append(name)
    for name in model.meshes:
        frequency = mesh_frequency(model, train, name, speed)
        for order in MESH_ORDERS if frequency else ():
            found.setdefault(("mesh", order, round(order * (frequency or 0.0), 9)), []).append(name)
    return tuple(
        ExcitationLine(f"{kind} {', '.join(names)} {order}x", frequency)
        for (kind, order, frequency), names in found.items()
    )
