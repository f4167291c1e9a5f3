"""Where loaded teeth end and the mesh of their gear's body begins: at one circle, so that nothing gives twice or not at all."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rotorgear.errors import AnalysisError
from rotorgear.model.layout.mesh_layout import MeshLayout
from rotorgear.quantity import millimetres

if TYPE_CHECKING:
    from rotorgear.casings.wheel import ReducedWheel

# How far the circle that the teeth are held on may be off the rim of the mesh, in normal modules. A ring of this height under
# the mean force of the teeth gives some thousandths of what the teeth give.
_BETWEEN = 0.5


def teeth_end_on_rim(mesh: MeshLayout, wheels: dict[str, ReducedWheel]) -> None:
    """Loaded teeth on an elastic body are held where its rim is: below, its mesh gives, above the elements of the teeth.

    Raises:
        AnalysisError: they end elsewhere; it says the rim thickness that fits.
    """
    if mesh.part.stiffness != "tooth_fe" or not mesh.has_teeth:
        return
    for gear in mesh.gears:
        wheel = wheels.get(gear.name)
        geometry = gear.geometry
        if wheel is None or geometry is None:
            continue
        root = 0.5 * geometry.root_diameter
        module = geometry.normal_module
        held = root - mesh.part.tooth_fe.rim_thickness * module
        if abs(held - wheel.rim_radius) <= _BETWEEN * module:
            continue
        fitting = (root - wheel.rim_radius) / module
        remedy = (
            f"say meshes.{mesh.name}.tooth_fe.rim_thickness = {fitting:.3g}"
            if fitting >= 1.0
            else f"name a set of nodes at the radius {millimetres(held)} as gears.{gear.name}.body.rim"
        )
        what = "would count twice" if held < wheel.rim_radius else "would be in neither"
        raise AnalysisError(
            f"meshes.{mesh.name}.tooth_fe: the loaded teeth of {gear.name} are held at the radius {millimetres(held)}, and the "
            f"rim of its mesh is at {millimetres(wheel.rim_radius)}: what gives between the two {what}. Make both one: {remedy}."
        )
