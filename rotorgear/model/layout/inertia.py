"""Rigid bodies on a shaft as the assembly needs them: mass and moments of inertia at each node, given or from the blank."""

from __future__ import annotations

from dataclasses import dataclass

from rotorgear.gears.geometry.blank import RigidBody, gear_blank, hollow_cylinder
from rotorgear.model.layout.mesh_geometry import gear_geometry, node_positions
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


def node_bodies(model: Tables) -> list[NodeBody]:
    """List the rigid bodies of all gears, disks and point masses, one for each node."""
    found = []
    for name, gear in model.gears.items():
        positions = node_positions(model, name)
        body = gear_body(model, name)
        if len(positions) == 2:
            body = _half(body, gear.helix_offset)
        found += [NodeBody(f"gears.{name}", gear.shaft, z, body) for z in positions]
    for name, disk in model.disks.items():
        z = model.shafts[disk.shaft].station(disk.at)
        found.append(NodeBody(f"disks.{name}", disk.shaft, z, disk_body(model, disk)))
    for name, point in model.point_masses.items():
        z = model.shafts[point.shaft].station(point.at)
        found.append(NodeBody(f"point_masses.{name}", point.shaft, z, RigidBody(point.mass, 0.0, 0.0)))
    return found


def _half(body: RigidBody, offset: float) -> RigidBody:
    """Split a herringbone's body into two halves at +-offset: the same mass and inertias when tied rigidly."""
    tilt = 0.5 * (body.diametral_inertia - body.mass * offset**2)
    return RigidBody(0.5 * body.mass, 0.5 * body.polar_inertia, tilt)


def inertia_is_given(part: Gear | Disk) -> bool:
    """Whether the part gives its mass or a moment of inertia itself."""
    return not (part.mass is None and part.polar_inertia is None and part.diametral_inertia is None)


def _given(part: Gear | Disk) -> RigidBody:
    return RigidBody(part.mass or 0.0, part.polar_inertia or 0.0, part.diametral_inertia or 0.0)


def disk_body(model: Tables, disk: Disk) -> RigidBody:
    """Mass and inertias of a disk, given or of a plain cylinder.

    Raises:
        ValueError: the sizes make no disk; the text is what was expected.
    """
    if inertia_is_given(disk):
        return _given(disk)
    bore = disk.bore
    if bore is None:
        shaft = model.shafts[disk.shaft]
        bore = shaft.diameter_at(shaft.station(disk.at))
    density = model.material_of(disk.shaft, name=disk.material).density
    return hollow_cylinder(disk.outer_diameter or 0.0, bore, disk.width or 0.0, density)


def bore_of(model: Tables, name: str) -> float:
    """Bore of a gear in m: given, or the shaft's diameter there."""
    gear = model.gears[name]
    if gear.body.bore is not None:
        return gear.body.bore
    return max(model.shafts[gear.shaft].diameter_at(z) for z in node_positions(model, name))


def gear_body(model: Tables, name: str) -> RigidBody:
    """Mass and inertias of a whole gear about its middle, given or from its blank.

    Raises:
        ValueError: the sizes make no blank; the text is what was expected.
    """
    gear = model.gears[name]
    if inertia_is_given(gear):
        return _given(gear)
    geometry = gear_geometry(gear)
    if geometry is None or not gear.width:
        raise ValueError("mass and inertias, or teeth, module and width to compute them from")
    helix = gear_blank(
        geometry.reference_diameter,
        bore_of(model, name),
        gear.width,
        model.material_of(gear.shaft, name=gear.material).density,
        root_diameter=geometry.root_diameter,
        rim_thickness=gear.body.rim_thickness,
        web_thickness=gear.body.web_thickness,
        hub_diameter=gear.body.hub_diameter,
        hub_width=gear.body.hub_width,
    )
    if gear.kind != "herringbone":
        return helix
    offset = gear.helix_offset
    return RigidBody(
        2.0 * helix.mass, 2.0 * helix.polar_inertia, 2.0 * (helix.diametral_inertia + helix.mass * offset**2)
    )
