"""Solids and beams as pyvista meshes. pyvista is imported only here and where windows and pictures are made."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from rotorgear.export.solids import Solids
from rotorgear.extras import require


def import_pyvista(purpose: str) -> ModuleType:
    """Return pyvista.

    Raises:
        MissingExtraError: it is not installed; `purpose` says what it was needed for.
    """
    require("pyvista", purpose)
    import pyvista

    return pyvista


def solids_mesh(pv: ModuleType, solids: Solids) -> Any:
    """Return a pyvista.PolyData of the undeformed solids with the cell data `part_id`, `kind_id` and `shaft_id`."""
    quads = np.column_stack([np.full(len(solids.quads), 4), solids.quads])
    triangles = np.column_stack([np.full(len(solids.triangles), 3), solids.triangles])
    mesh = pv.PolyData(solids.points.astype(np.float32), faces=np.concatenate([quads.ravel(), triangles.ravel()]))
    mesh.GetPolys().ConvertTo32BitStorage()  # half of the file's cells
    mesh.cell_data["part_id"] = solids.part.astype(np.int16)
    mesh.cell_data["kind_id"] = solids.kind.astype(np.int16)
    mesh.cell_data["shaft_id"] = solids.shaft.astype(np.int16)
    return mesh


def add_texts(mesh: Any, name: str, texts: Sequence[str]) -> None:
    """Add texts of any script to the field data of a mesh; pyvista itself takes ASCII only."""
    from vtkmodules.vtkCommonCore import vtkStringArray

    array = vtkStringArray()
    array.SetName(name)
    for text in texts:
        array.InsertNextValue(text)
    mesh.GetFieldData().AddArray(array)


def save_mesh(mesh: Any, path: Path) -> None:
    """Write a mesh as a VTK XML file: binary, appended, compressed.

    Raises:
        OSError: the disk does not take it.
    """
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter, vtkXMLUnstructuredGridWriter

    writer = vtkXMLPolyDataWriter() if mesh.IsA("vtkPolyData") else vtkXMLUnstructuredGridWriter()
    writer.SetInputData(mesh)
    writer.SetFileName(str(path))
    writer.SetDataModeToAppended()
    writer.EncodeAppendedDataOff()
    writer.SetCompressorTypeToZLib()
    writer.SetCompressionLevel(2)
    shown = writer.GetGlobalWarningDisplay()
    writer.GlobalWarningDisplayOff()  # what goes wrong is said once, in a sentence
    try:
        written = writer.Write() and not writer.GetErrorCode()
    finally:
        writer.SetGlobalWarningDisplay(shown)
    if not written:
        raise OSError(f"VTK could not write {path.name}; is the disk full?")
