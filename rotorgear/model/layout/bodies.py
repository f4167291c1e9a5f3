"""Rigid bodies on a shaft as the assembly needs them: mass and moments of inertia at each node, given or from the blank."""

from __future__ import annotations

from dataclasses import dataclass

from rotorgear.gears.geometry.blank import RigidBody, hollow_cylinder
from rotorgear.model.parts.bodies import Disk
from rotorgear.model.parts.gear import Gear
from rotorgear.model.parts.tables import Tables


@dataclass(frozen=True)
class NodeBody:
    """A rigid body at a node: which part, which shaft, where (m), and its RigidBody."""

    part: str
    shaft: str
    z: float
    body: RigidBody


def inertia_is_given(part: Gear | Disk) -> bool:
    """Whether the part gives its mass or a moment of inertia itself."""
    return not (part.mass is None and part.polar_inertia is None and part.diametral_inertia is None)


def given_body(part: Gear | Disk) -> RigidBody:
    """Mass and inertias as the part gives them; what it leaves out is 0."""
    return RigidBody(part.mass or 0.0, part.polar_inertia or 0.0, part.diametral_inertia or 0.0)


def disk_body(model: Tables, disk: Disk) -> RigidBody:
    """Mass and inertias of a disk, given or of a plain cylinder.

    Raises:
        ValueError: the sizes make no disk; the text is what was expected.
    """
    if inertia_is_given(disk):
        return given_body(disk)
    bore = disk.bore
    if bore is None:
        shaft = model.shafts[disk.shaft]
        bore = shaft.diameter_at(shaft.station(disk.at))
    density = model.material_of(disk.shaft, name=disk.material).density
    return hollow_cylinder(disk.outer_diameter or 0.0, bore, disk.width or 0.0, density)
