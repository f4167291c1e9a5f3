"""Gear bodies from meshes: what the model file says in plain values, and the reduced body, held against what the gear states."""

from __future__ import annotations

from pathlib import Path

from rotorgear.casings.assembly import Elastic
from rotorgear.casings.settings import CasingSettings
from rotorgear.casings.wheel import ReducedWheel
from rotorgear.errors import AnalysisError
from rotorgear.model.layout.casings import place_of
from rotorgear.model.parts.casing import ONLY_MESH, UNIT_LENGTHS
from rotorgear.model.parts.gear import Gear
from rotorgear.model.parts.shaft import Material
from rotorgear.progress import listener


def wheel_settings(name: str, gear: Gear, material: Material) -> CasingSettings:
    """The settings of the body of a gear whose fields are in order: bore and rim are its two seats."""
    body = gear.body
    assert body.mesh is not None, "asked for gears with a mesh only"
    assert body.unit is not None, "checked: a mesh has a unit"
    assert body.seat is not None, "checked: a mesh has a bore"
    assert body.rim is not None, "checked: a mesh has a rim"
    return CasingSettings(
        name=f"{name}.body",
        files=((ONLY_MESH, Path(body.mesh)),),
        unit=UNIT_LENGTHS[body.unit],
        material=Elastic(material.youngs_modulus, material.nu, material.density),
        seats=(("seat", place_of(body.seat)), ("rim", place_of(body.rim))),
        connection=body.connection,
        modes_to=body.modes_to,
        damping_ratio=body.damping_ratio,
        mass=gear.mass,
        mass_tolerance=body.mass_tolerance,
        table="gears",
    )


def reduced_wheel(name: str, gear: Gear, material: Material) -> ReducedWheel:
    """The reduced body of a gear; whoever is `listening` hears of its progress.

    Raises:
        AnalysisError: what is wrong with its mesh, or moments of inertia that the gear states otherwise.
        MissingExtraError: meshio or scikit-fem is not installed.
    """
    from rotorgear.casings.casing import reduced_gear_body

    wheel = reduced_gear_body(wheel_settings(name, gear, material), progress=listener())
    found = {"polar_inertia": wheel.polar_inertia, "diametral_inertia": wheel.diametral_inertia}
    for key, value in found.items():
        stated = getattr(gear, key)
        if stated is not None and abs(value - stated) > gear.body.mass_tolerance * stated:
            raise AnalysisError(
                f"gears.{name}.{key}: the mesh has {value:.6g} kg m^2, and {stated:.6g} kg m^2 are stated. A gear with a mesh "
                "has the mass of the mesh, counted once: leave the value out, correct the mesh, or give body.mass_tolerance."
            )
    return wheel
