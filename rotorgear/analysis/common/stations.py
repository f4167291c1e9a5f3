"""Where a result knows its shapes: nodes, stations inside shaft elements of higher order, surfaces of casings and gear bodies.

Beside them: displacements at the parts on the shafts.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from rotorgear.casings.reduced_body import rigid_motions
from rotorgear.elements.shaft import inner_fields
from rotorgear.results.modal import NodeTable, body_name
from rotorgear.system.groups import alike, element_data
from rotorgear.system.system import System


def shapes_at_stations(system: System, q: np.ndarray) -> tuple[NodeTable, np.ndarray]:
    """Return nodes, inner stations and points on casings and gear bodies, and the displacements (p, 6, m) there of dofs q (a, m).

    Those on shafts are in the frame of their shaft, those of surfaces along the axes of the model.

    Between the nodes of a basic element the exact static shape is all there is, so it gets no stations.
    """
    count = len(system.nodes)
    shafts = list(system.nodes.shaft)
    pedestals = list(system.nodes.pedestal)
    along = [np.array(system.nodes.z)]
    positions = [system.positions()]
    shapes = [q[: 6 * count].reshape(count, 6, -1)]
    for name, shaft in system.model.shafts.items():
        for rigid, order, elements, dofs in alike(system.model, system.nodes, name):
            if rigid or order < 2:
                continue
            places, fields = inner_fields(element_data(system.model, name, elements), order)
            moved = np.moveaxis(fields @ q[dofs], 0, 2)
            inner = moved.reshape(-1 if moved.size else moved.shape[0] * moved.shape[1], 6, q.shape[1])
            left = np.array([system.nodes.z[element.left] for element in elements])
            length = np.array([element.length for element in elements])
            z = (left[:, None] + length[:, None] * places).ravel()
            along.append(z)
            positions.append(shaft.frame.at(z))
            shapes.append(inner)
            shafts += [name] * len(z)
            pedestals += [""] * len(z)
    casings: list[str] = []
    for name, points, displaced in _surfaces(system, q):
        casings += [""] * (len(shafts) - len(casings)) + [name] * len(points)
        shafts += [""] * len(points)
        pedestals += [""] * len(points)
        along.append(points[:, 2])
        positions.append(points)
        shapes.append(np.concatenate([displaced, np.zeros_like(displaced)], axis=1))
    # Those of a large model fill a good part of the memory: no copy without a reason.
    displaced_all = shapes[0] if len(shapes) == 1 else np.vstack(shapes)
    inclined = any(shaft.frame.is_moved for shaft in system.model.shafts.values())
    on_axis = np.concatenate(along) if inclined else None
    return NodeTable(tuple(shafts), np.vstack(positions), tuple(pedestals), tuple(casings), on_axis), displaced_all


def _surfaces(system: System, q: np.ndarray) -> Iterator[tuple[str, np.ndarray, np.ndarray]]:
    """Yield name, points (p, 3) and displacements (p, 3, m) of the surface of each casing and elastic gear body."""
    for name in system.model.casings:
        surface = system.layout.casing(name).surface
        if surface is not None:
            yield name, surface.points, surface.basis @ q[system.nodes.of_casing(name)]
    for name, wheel in system.layout.elastic_bodies.items():
        if wheel.surface is None:
            continue
        place = system.layout.gear(name).places[0]
        node = system.nodes.at(*place)
        rigid = rigid_motions(wheel.surface.points).reshape(-1, 3, 6) @ q[6 * node : 6 * node + 6]
        elastic = wheel.surface.basis @ q[system.nodes.of_body(name)]
        frame = system.model.shafts[place.shaft].frame
        moved = np.einsum("ij,pjm->pim", frame.axes, rigid + elastic) if frame.is_turned else rigid + elastic
        yield body_name(name), wheel.surface.points @ frame.axes.T + system.positions()[node], moved


def part_nodes(system: System) -> dict[str, int]:
    """Node of every gear, disk, bearing and nonlinear element by address; of a herringbone one "left" and one "right"."""
    nodes = system.nodes
    found = {}
    for gear in system.layout.gears:
        sides = (" left", " right") if len(gear.places) == 2 else ("",)
        for place, side in zip(gear.places, sides, strict=True):
            found[f"gears.{gear.name}{side}"] = nodes.at(*place)
    for address, _ in system.model.parts_of("disks", "bearings", "nonlinear_elements"):
        found[address] = nodes.at(*system.layout.place(address))
    return found


def displacement_places(system: System, moved: np.ndarray) -> dict[str, np.ndarray]:
    """x y z tilt_x tilt_y torsion at those places, address -> (6,), from displacements of all nodes (p, 6)."""
    return {place: moved[node] for place, node in part_nodes(system).items()}
