"""Casings for ParaView: the surface of each, with its free and held modes."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from rotorgear.export.files import replacing
from rotorgear.export.polydata import import_pyvista, save_mesh
from rotorgear.results.casing import CasingRow, CasingSurvey


def write_casing_vtk(survey: CasingSurvey, folder: str | Path) -> list[Path]:
    """Write one `casing_NAME.vtp` for each casing.

    Point data: `free_NN` and `held_NN`, displacements (3) of mode NN from 1, the largest of them 1; field data:
    `free_frequency_hz`, `held_frequency_hz`. ParaView's filter Warp By Vector shows a mode.

    Args:
        survey: what `casing` returned.
        folder: made if it is not there.

    Returns:
        The files.

    Raises:
        MissingExtraError: pyvista is not installed. OSError: the files can't be written.
    """
    pv = import_pyvista("VTK output")
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    written = []
    for name, row in survey.casings.items():
        faces = np.column_stack([np.full(len(row.triangles), 3), row.triangles])
        mesh = pv.PolyData(row.points.astype(np.float32), faces=faces.ravel())
        for kind, shapes in (("free", row.free_shapes), ("held", row.held_shapes)):
            _add(mesh, kind, shapes)
            mesh.field_data[f"{kind}_frequency_hz"] = np.array(_frequencies(row, kind))
        path = folder / f"casing_{name}.vtp"
        with replacing(path) as scratch:
            save_mesh(mesh, scratch)
        written.append(path)
    return written


def _add(mesh: object, kind: str, shapes: np.ndarray) -> None:
    for mode in range(shapes.shape[2]):
        shape = shapes[:, :, mode]
        largest = np.linalg.norm(shape, axis=1).max()
        mesh.point_data[f"{kind}_{mode + 1:02d}"] = (shape / largest).astype(np.float32)  # type: ignore[attr-defined]


def _frequencies(row: CasingRow, kind: str) -> np.ndarray:
    return row.free_frequency_hz if kind == "free" else row.held_frequency_hz
