"""Where a result knows its shapes: nodes, stations inside shaft elements with polynomials of their own, surfaces of casings."""

from __future__ import annotations

import numpy as np

from rotorgear.elements.shaft import inner_fields
from rotorgear.results.modal import NodeTable
from rotorgear.system.groups import alike, element_data, shaft_dofs
from rotorgear.system.system import System


def shapes_at_stations(system: System, q: np.ndarray) -> tuple[NodeTable, np.ndarray]:
    """Return nodes, then inner stations, then points on casings, and the displacements (p, 6, m) there, from all dofs q (a, m).

    Between the nodes of a basic element the exact static shape is all there is, so it gets no stations.
    """
    count = len(system.nodes)
    shafts = list(system.nodes.shaft)
    pedestals = list(system.nodes.pedestal)
    positions = [system.positions()]
    shapes = [q[: 6 * count].reshape(count, 6, -1)]
    for name, shaft in system.model.shafts.items():
        x, y = shaft.position or (0.0, 0.0)
        for rigid, order, elements in alike(system.model, system.nodes, name):
            if rigid or order < 2:
                continue
            places, fields = inner_fields(element_data(system.model, name, elements), order)
            local = q[shaft_dofs(system.nodes, elements, shaft.shear_deformation)]
            moved = np.moveaxis(fields @ local, 0, 2)
            inner = moved.reshape(-1 if moved.size else moved.shape[0] * moved.shape[1], 6, q.shape[1])
            left = np.array([system.nodes.z[element.left] for element in elements])
            length = np.array([element.length for element in elements])
            z = (left[:, None] + length[:, None] * places).ravel()
            positions.append(np.column_stack([np.full(len(z), x), np.full(len(z), y), z]))
            shapes.append(inner)
            shafts += [name] * len(z)
            pedestals += [""] * len(z)
    casings: list[str] = []
    for name in system.model.casings:
        surface = system.layout.casing(name).surface
        if surface is None:
            continue
        casings += [""] * (len(shafts) - len(casings)) + [name] * len(surface.points)
        shafts += [""] * len(surface.points)
        pedestals += [""] * len(surface.points)
        positions.append(surface.points)
        displaced = surface.basis @ q[system.nodes.of_casing(name)]
        shapes.append(np.concatenate([displaced, np.zeros_like(displaced)], axis=1))
    return NodeTable(tuple(shafts), np.vstack(positions), tuple(pedestals), tuple(casings)), np.vstack(shapes)
