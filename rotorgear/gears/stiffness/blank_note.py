"""What a tooth model without rim, web and hub leaves out of a gear's compliance: its sign, and its size at least."""

from __future__ import annotations

import math

from rotorgear.gears.geometry.geometry import GearGeometry
from rotorgear.gears.stiffness.mesh_stiffness import ToothBody
from rotorgear.gears.tooth_fe.blank_section import torsional_flexibility


def wind_up_per_width(geometry: GearGeometry, body: ToothBody, width: float) -> float:
    """Deflection along the line of action (m^2/N) by the rotation of the root circle against the bore, for a force per width.

    Only that of a blank with a web: 0 for a solid one.
    """
    blank = body.blank
    if blank is None or blank.is_solid or blank.bore_radius <= 0.0:
        return 0.0
    # In normal modules for a Young's modulus of 1: a rotation for a torque grows as 1 / (E m^3).
    m = geometry.normal_module
    turned = torsional_flexibility(
        blank.scaled(1.0 / m), width / m, 0.5 * geometry.root_diameter / m, body.poisson_ratio
    )
    return geometry.base_radius**2 * turned * width / (body.youngs_modulus * m**3)


def web_left_out(name: str, geometry: GearGeometry, body: ToothBody, width: float, model: str) -> tuple[str, ...]:
    """A warning where a model does not know the web of a gear; none for a solid blank.

    Args:
        name: of the gear.
        geometry, body: of the gear.
        width: of the face (m).
        model: what does not know it, in words.
    """
    missing = wind_up_per_width(geometry, body, width)
    if not missing or math.isnan(missing):
        return ()
    # 1 m^2/N is 1e9 um per N/mm.
    return (
        f"{name}: {model} leaves out the compliance of web and hub, so the mesh comes out too stiff: their wind-up alone is "
        f"{1e9 * missing:.2g} um per N/mm of line load, tilt and translation of the rim come on top; "
        "stiffness = 'tooth_fe' with body = 'wheel' has them",
    )
