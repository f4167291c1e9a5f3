"""Displacements at the parts on the shafts, by their addresses."""

from __future__ import annotations

import numpy as np

from rotorgear.system.system import System


def part_nodes(system: System) -> dict[str, int]:
    """Node of every gear, disk, bearing and nonlinear element by address; of a herringbone one "left" and one "right"."""
    model = system.model
    nodes = system.nodes
    found = {}
    for gear in system.layout.gears:
        sides = (" left", " right") if len(gear.places) == 2 else ("",)
        for place, side in zip(gear.places, sides, strict=True):
            found[f"gears.{gear.name}{side}"] = nodes.at(*place)
    for table in ("disks", "bearings", "nonlinear_elements"):
        for name in getattr(model, table):
            found[f"{table}.{name}"] = nodes.at(*system.layout.place(f"{table}.{name}"))
    return found


def displacement_places(system: System, moved: np.ndarray) -> dict[str, np.ndarray]:
    """x y z tilt_x tilt_y torsion at those places, address -> (6,), from displacements of all nodes (p, 6)."""
    return {place: moved[node] for place, node in part_nodes(system).items()}
