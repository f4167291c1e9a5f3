"""The beam model as lines: nodes with sizes, and all six degrees of freedom of all modes in full precision."""

from __future__ import annotations

from types import ModuleType
from typing import Any

import numpy as np

from rotorgear.export.attachment import nodes_in_order
from rotorgear.export.polydata import add_texts
from rotorgear.export.solids import Solids
from rotorgear.results.modal import ModalResult


def beam_mesh(pv: ModuleType, result: ModalResult, solids: Solids) -> Any:
    """Return a pyvista.PolyData of the nodes, joined by a line along each shaft; nodes of pedestals are single points.

    Point data: `shaft_id`, `pedestal` (0 or 1), `outer_diameter` (m), and for each mode NN `mode_NN_translation_real`,
    `mode_NN_translation_imag` (m), `mode_NN_rotation_real` and `mode_NN_rotation_imag` (rad), mass-normalised.
    """
    nodes = result.nodes
    model = result.model
    lines = [nodes_in_order(nodes, name) for name in model.shafts]
    cells = [[len(line), *line] for line in lines if len(line) > 1]
    single = [int(line[0]) for line in lines if len(line) == 1]
    single += [number for number, bearing in enumerate(nodes.pedestal) if bearing]
    # Points of casings come last, and are no nodes of a beam.
    count = sum(bool(shaft) for shaft in nodes.shaft)
    mesh = pv.PolyData()
    mesh.points = np.asarray(solids.node_positions[:count], float)
    if cells:
        mesh.lines = np.concatenate(cells)
    if single:
        mesh.verts = np.column_stack([np.ones(len(single), int), single]).ravel()
    names = list(model.shafts)
    mesh.point_data["shaft_id"] = np.array([names.index(shaft) for shaft in nodes.shaft[:count]], dtype=np.int16)
    mesh.point_data["pedestal"] = np.array([bool(bearing) for bearing in nodes.pedestal[:count]], dtype=np.uint8)
    mesh.point_data["outer_diameter"] = np.array(
        [model.shafts[s].diameter_at(z) for s, z in zip(nodes.shaft[:count], nodes.position[:count, 2], strict=True)]
    )
    for mode in range(len(result)):
        for what, dofs in (("translation", slice(0, 3)), ("rotation", slice(3, 6))):
            values = result.shapes[:count, dofs, mode]
            mesh.point_data[f"mode_{mode + 1:02d}_{what}_real"] = np.ascontiguousarray(values.real, float)
            mesh.point_data[f"mode_{mode + 1:02d}_{what}_imag"] = np.ascontiguousarray(values.imag, float)
    add_texts(mesh, "shaft_names", names)
    mesh.field_data["frequency_hz"] = result.frequency_hz
    mesh.field_data["damping_ratio"] = result.damping_ratio
    add_texts(mesh, "description", result.description)
    return mesh
