"""Casings with their modes, and loaded teeth with their stresses, for ParaView."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from rotorgear.export.paraview import import_pyvista, save_mesh
from rotorgear.files.write import filling, publish
from rotorgear.results.casing import CasingSurvey
from rotorgear.results.tooth_field import ToothFields


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
        MissingExtraError: pyvista is not installed. WriteError: the folder can't be written.
    """
    pv = import_pyvista("VTK output")
    names = []
    with filling(folder) as scratch:
        for name, row in survey.casings.items():
            faces = np.column_stack([np.full(len(row.triangles), 3), row.triangles])
            mesh = pv.PolyData(row.points.astype(np.float32), faces=faces.ravel())
            for kind in ("free", "held"):
                for mode, shape in enumerate(np.moveaxis(getattr(row, f"{kind}_shapes"), 2, 0), start=1):
                    largest = np.linalg.norm(shape, axis=1).max()
                    mesh.point_data[f"{kind}_{mode:02d}"] = (shape / largest).astype(np.float32)
                mesh.field_data[f"{kind}_frequency_hz"] = np.array(getattr(row, f"{kind}_frequency_hz"))
            names.append(f"casing_{name}.vtp")
            save_mesh(mesh, scratch / names[-1])
        return publish(scratch, Path(folder), names)


_README = """Loaded teeth of mesh '{mesh}' at position {position:g} of the mesh period, first helix.

{first}.vtu, {second}.vtu   quadratic finite elements of the teeth near contact, in m. Point data: displacement (m; warp by it to
                  see it, with a factor of some hundreds), von_mises and largest_principal (Pa), tooth.
contact.vtp       contact lines on the plane of action. Cell data: line_load (N/m), half_width (m) and pressure (Pa) of the
                  Hertz contact, pair.

The pinion's axis is the z axis, the gear's stands on +y; the pinion pushes clockwise, and contact runs ahead at larger z. The
other hand and the other flanks are the mirror image. Under a contact line the elements carry the load spread over a patch that
is wider than the Hertz contact: stresses there are not those of the contact, those of the fillets are right.
Largest principal stress in the fillets: {first} {one:.4g} MPa, {second} {two:.4g} MPa.
"""


def write_tooth_vtk(fields: ToothFields, directory: str | Path) -> list[Path]:
    """Write one .vtu a gear, contact.vtp and README.txt into a folder, made if need be, and return their paths.

    Raises:
        MissingExtraError: pyvista is not installed.
        WriteError: the folder can't be written.
    """
    pv = import_pyvista("VTK output")
    first, second = fields.gears
    with filling(directory) as scratch:
        names = []
        for gear in fields.gears:
            # Nine nodes an element in the plane, 27 in space: VTK has both orders as they are.
            kind = pv.CellType.BIQUADRATIC_QUAD if gear.cells.shape[1] == 9 else pv.CellType.TRIQUADRATIC_HEXAHEDRON
            teeth = pv.UnstructuredGrid({kind: gear.cells}, gear.points)
            for name in ("displacement", "von_mises", "largest_principal", "tooth"):
                teeth.point_data[name] = getattr(gear, name)
            names.append(f"{gear.name}.vtu")
            save_mesh(teeth, scratch / names[-1])

        contact = fields.contact
        n = len(contact.pair)
        lines = np.column_stack([np.full(n, 2), np.arange(2 * n).reshape(n, 2)])
        contact_lines = pv.PolyData(contact.ends.reshape(-1, 3), lines=lines.ravel())
        for name in ("line_load", "half_width", "pressure", "pair"):
            contact_lines.cell_data[name] = getattr(contact, name)
        save_mesh(contact_lines, scratch / "contact.vtp")

        text = _README.format(
            mesh=fields.mesh,
            position=fields.position,
            first=first.name,
            second=second.name,
            one=1e-6 * first.root_stress,
            two=1e-6 * second.root_stress,
        )
        (scratch / "README.txt").write_text(text, encoding="utf-8")
        return publish(scratch, Path(directory), [*names, "contact.vtp", "README.txt"])
