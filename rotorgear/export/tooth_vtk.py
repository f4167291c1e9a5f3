"""Loaded teeth for ParaView: both finite-element meshes with deflection and stress, and the contact lines with pressure."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from rotorgear.export.files import filling, publish
from rotorgear.export.polydata import import_pyvista, save_mesh
from rotorgear.results.tooth_field import ToothFields

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
            teeth.point_data["displacement"] = gear.displacement
            teeth.point_data["von_mises"] = gear.von_mises
            teeth.point_data["largest_principal"] = gear.largest_principal
            teeth.point_data["tooth"] = gear.tooth
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
