"""Displacements at the parts on the shafts, by their addresses."""

from __future__ import annotations

import numpy as np

from rotorgear.model.layout.mesh_geometry import node_positions
from rotorgear.system.system import System


def part_nodes(system: System) -> dict[str, int]:
    """Node of every gear, disk and bearing by address; a herringbone with two nodes has one "left" and one "right"."""
    model = system.model
    nodes = system.nodes
    found = {}
    for name, gear in model.gears.items():
        places = node_positions(model, name)
        for z, side in zip(places, (" left", " right") if len(places) == 2 else ("",), strict=True):
            found[f"gears.{name}{side}"] = nodes.at(gear.shaft, z)
    for table in ("disks", "bearings"):
        for name, part in getattr(model, table).items():
            found[f"{table}.{name}"] = nodes.at(part.shaft, model.shafts[part.shaft].station(part.at))
    return found


def displacement_places(system: System, moved: np.ndarray) -> dict[str, np.ndarray]:
    """x y z tilt_x tilt_y torsion at those places, address -> (6,), from displacements of all nodes (p, 6)."""
    return {place: moved[node] for place, node in part_nodes(system).items()}
