"""Loaded teeth for ParaView: both finite-element meshes with deflection and stress, and the contact lines with pressure."""

from __future__ import annotations

from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from rotorgear.export.files import filling, publish
from rotorgear.export.polydata import import_pyvista, save_mesh
from rotorgear.results.tooth_field import ContactField, ToothField, ToothFields

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
            names.append(f"{gear.name}.vtu")
            save_mesh(_gear_mesh(pv, gear), scratch / names[-1])
        save_mesh(_contact_mesh(pv, fields.contact), scratch / "contact.vtp")
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


def _gear_mesh(pv: ModuleType, gear: ToothField) -> Any:
    kind = pv.CellType.BIQUADRATIC_QUAD if gear.cells.shape[1] == 9 else pv.CellType.TRIQUADRATIC_HEXAHEDRON
    mesh = pv.UnstructuredGrid({kind: gear.cells}, gear.points)
    mesh.point_data["displacement"] = gear.displacement
    mesh.point_data["von_mises"] = gear.von_mises
    mesh.point_data["largest_principal"] = gear.largest_principal
    mesh.point_data["tooth"] = gear.tooth
    return mesh


def _contact_mesh(pv: ModuleType, contact: ContactField) -> Any:
    n = len(contact.pair)
    lines = np.column_stack([np.full(n, 2), np.arange(2 * n).reshape(n, 2)])
    mesh = pv.PolyData(contact.ends.reshape(-1, 3), lines=lines.ravel())
    for name in ("line_load", "half_width", "pressure", "pair"):
        mesh.cell_data[name] = getattr(contact, name)
    return mesh
