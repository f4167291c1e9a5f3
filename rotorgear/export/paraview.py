"""What all files for ParaView share: solids as pyvista meshes, texts in them, and collections of files over time (.pvd)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from types import ModuleType
from typing import Any
from xml.sax.saxutils import quoteattr

import numpy as np

from rotorgear.export.solids import Solids, build_solids
from rotorgear.extras import require


def import_pyvista(purpose: str) -> ModuleType:
    """Return pyvista.

    Raises:
        MissingExtraError: it is not installed; `purpose` says what it was needed for.
    """
    require("pyvista", purpose)
    import pyvista

    return pyvista


def undeformed(result: Any) -> tuple[ModuleType, Solids, Any]:
    """pyvista, the solids of a result's model, and their mesh with the names of parts, kinds and shafts and the title.

    Raises:
        MissingExtraError: pyvista is not installed.
    """
    pv = import_pyvista("VTK output")
    solids = build_solids(result.model, result.nodes)
    mesh = solids_mesh(pv, solids)
    for name in ("part_names", "kind_names", "shaft_names"):
        add_texts(mesh, name, getattr(solids, name))
    add_texts(mesh, "title", [result.model.title])
    return pv, solids, mesh


def solids_mesh(pv: ModuleType, solids: Solids) -> Any:
    """Return a pyvista.PolyData of the undeformed solids with the cell data `part_id`, `kind_id` and `shaft_id`."""
    quads = np.column_stack([np.full(len(solids.quads), 4), solids.quads])
    triangles = np.column_stack([np.full(len(solids.triangles), 3), solids.triangles])
    mesh = pv.PolyData(solids.points.astype(np.float32), faces=np.concatenate([quads.ravel(), triangles.ravel()]))
    mesh.GetPolys().ConvertTo32BitStorage()  # half of the file's cells
    for name in ("part", "kind", "shaft"):
        mesh.cell_data[f"{name}_id"] = getattr(solids, name).astype(np.int16)
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
    writer.GlobalWarningDisplayOff()  # the exception below says what is wrong
    try:
        written = writer.Write() and not writer.GetErrorCode()
    finally:
        writer.SetGlobalWarningDisplay(shown)
    if not written:
        raise OSError(f"VTK could not write {path.name}; is the disk full?")


def save_shape(plain: Any, path: Path, shapes: Mapping[str, np.ndarray], facts: Mapping[str, Any]) -> None:
    """Write undeformed solids with displacements (P, 3) of their points, and with numbers and texts as field data.

    The star in the name of complex displacements, such as "displacement*_m", becomes "_real" and "_imag".
    """
    mesh = plain.copy(deep=False)  # the same points and cells, but data of its own
    for name, values in shapes.items():
        for word, part in (("_real", values.real), ("_imag", values.imag)) if "*" in name else (("", values),):
            mesh.point_data[name.replace("*", word)] = part.astype(np.float32)
    for name, fact in facts.items():
        if isinstance(fact, str):
            add_texts(mesh, name, [fact])
        else:
            mesh.field_data[name] = np.array([fact])
    save_mesh(mesh, path)


def write_collection(path: Path, steps: Iterable[tuple[float, str]]) -> None:
    """Write a .pvd file that shows one file at each time."""
    rows = [f'    <DataSet timestep="{time:.9g}" part="0" file={quoteattr(file)}/>' for time, file in steps]
    head = '<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1" byte_order="LittleEndian">\n  <Collection>'
    path.write_text("\n".join([head, *rows, "  </Collection>\n</VTKFile>\n"]), encoding="utf-8")
