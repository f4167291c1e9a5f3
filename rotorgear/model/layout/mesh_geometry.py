"""Where and how two gears touch: one `Contact` for each helix of a mesh.

The working pressure angle follows from the distance of the axes, cos a = (r_b1 + r_b2)/a_w (ISO 21771), the contact's
plane from the overlap of the faces. Signs of flank and hand are left to `elements/gear_mesh.py`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from rotorgear.gears.geometry.geometry import GearGeometry
from rotorgear.gears.geometry.pair import PairGeometry, pair_geometry, working_pressure_angle_from_shifts
from rotorgear.model.parts.gear import Gear
from rotorgear.model.parts.tables import Tables


@dataclass(frozen=True)
class Contact:
    """One helix of a mesh, as the assembly needs it (m, rad, N/m).

    Attributes:
        mesh: name of the mesh.
        helix: 0 for the only one or that at the smaller z, 1 for the other of a herringbone.
        pinion_z, gear_z: z of the two gear nodes.
        contact_z: z of the middle of the common face.
        hand: +1 right, -1 left hand of the pinion's helix, 0 for a spur gear.
        psi: direction from pinion to gear from +x.
        pressure_angle: working transverse pressure angle.
    """

    mesh: str
    helix: int
    pinion: str
    gear: str
    pinion_z: float
    gear_z: float
    contact_z: float
    hand: int
    psi: float
    pressure_angle: float
    base_helix_angle: float
    pinion_base_radius: float
    gear_base_radius: float
    stiffness: float
    contact_position: float


def gear_geometry(gear: Gear) -> GearGeometry | None:
    """Return the ISO 21771 geometry of a gear given by its teeth; None for a lumped gear or one with missing data."""
    if gear.lumped or gear.teeth is None or gear.normal_module is None:
        return None
    return GearGeometry(
        teeth=gear.teeth,
        normal_module=gear.normal_module,
        normal_pressure_angle=gear.normal_pressure_angle,
        helix_angle=gear.helix_angle or 0.0,
        profile_shift=gear.profile_shift,
        addendum_factor=gear.addendum_factor,
        dedendum_factor=gear.dedendum_factor,
        tip_diameter=gear.tip_diameter,
        root_radius_factor=gear.root_radius_factor,
    )


def base_radius(gear: Gear) -> float:
    """Base radius in m, given or from the teeth."""
    geometry = gear_geometry(gear)
    return geometry.base_radius if geometry else (gear.base_radius or 0.0)


def base_helix_angle(gear: Gear) -> float:
    """Base helix angle in rad, given or from the teeth; 0 for a spur gear."""
    geometry = gear_geometry(gear)
    return geometry.base_helix_angle if geometry else (gear.base_helix_angle or 0.0)


def node_positions(model: Tables, name: str) -> tuple[float, ...]:
    """z in m of the nodes of a gear: one, or one for each helix from left to right."""
    gear = model.gears[name]
    z = model.shafts[gear.shaft].station(gear.at)
    offset = gear.helix_offset
    return (z - offset, z + offset) if gear.node_count == 2 else (z,)


def helix_planes(model: Tables, name: str) -> tuple[float, ...]:
    """z in m of the mid-plane of each helix of a gear, from left to right."""
    gear = model.gears[name]
    z = model.shafts[gear.shaft].station(gear.at)
    return (z - gear.helix_offset, z + gear.helix_offset) if gear.kind == "herringbone" else (z,)


def centre_line(model: Tables, mesh_name: str) -> tuple[float, float] | None:
    """Centre distance in m and direction from pinion to gear in rad; None where the shafts have no positions."""
    mesh = model.meshes[mesh_name]
    first = model.shafts[model.gears[mesh.pinion].shaft].position
    second = model.shafts[model.gears[mesh.gear].shaft].position
    if first is None or second is None:
        return None
    dx = second[0] - first[0]
    dy = second[1] - first[1]
    return math.hypot(dx, dy), math.atan2(dy, dx)


def pressure_angle(model: Tables, mesh_name: str) -> float:
    """Working transverse pressure angle in rad."""
    mesh = model.meshes[mesh_name]
    pinion = model.gears[mesh.pinion]
    gear = model.gears[mesh.gear]
    line = centre_line(model, mesh_name)
    if line is not None:
        return math.acos(min((base_radius(pinion) + base_radius(gear)) / line[0], 1.0))
    if mesh.pressure_angle is not None:
        return mesh.pressure_angle
    first = gear_geometry(pinion)
    second = gear_geometry(gear)
    if first and second:
        return working_pressure_angle_from_shifts(first, second)
    return pinion.transverse_pressure_angle or gear.transverse_pressure_angle or 0.0


def mesh_pair(model: Tables, mesh_name: str) -> PairGeometry | None:
    """Contact ratios and working circles of a mesh; None for lumped gears."""
    mesh = model.meshes[mesh_name]
    pinion = model.gears[mesh.pinion]
    gear = model.gears[mesh.gear]
    first = gear_geometry(pinion)
    second = gear_geometry(gear)
    if first is None or second is None:
        return None
    line = centre_line(model, mesh_name)
    widths = [width for width in (pinion.width, gear.width) if width]
    return pair_geometry(first, second, centre_distance=line[0] if line else None, width=min(widths, default=0.0))


def contacts(model: Tables, mesh_name: str, stiffness: float = math.nan) -> tuple[Contact, ...]:
    """Return the contacts of a mesh: one, or two for a herringbone pair (each with half the stiffness).

    `stiffness` is that of the mesh along the flank normal in N/m; without it, the contacts serve their geometry only.
    """
    mesh = model.meshes[mesh_name]
    pinion = model.gears[mesh.pinion]
    gear = model.gears[mesh.gear]
    line = centre_line(model, mesh_name)
    planes = list(zip(helix_planes(model, mesh.pinion), helix_planes(model, mesh.gear), strict=True))
    first_nodes = node_positions(model, mesh.pinion)
    second_nodes = node_positions(model, mesh.gear)
    hand = {"right": 1, "left": -1, None: 0}[pinion.hand] if pinion.kind != "spur" else 0
    return tuple(
        Contact(
            mesh=mesh_name,
            helix=number,
            pinion=mesh.pinion,
            gear=mesh.gear,
            pinion_z=first_nodes[number if len(first_nodes) == 2 else 0],
            gear_z=second_nodes[number if len(second_nodes) == 2 else 0],
            contact_z=_common_plane(pinion, gear, first, second),
            hand=hand if number == 0 else -hand,
            psi=line[1] if line else (mesh.centre_line_angle or 0.0),
            pressure_angle=pressure_angle(model, mesh_name),
            base_helix_angle=base_helix_angle(pinion),
            pinion_base_radius=base_radius(pinion),
            gear_base_radius=base_radius(gear),
            stiffness=stiffness / len(planes),
            contact_position=mesh.contact_position,
        )
        for number, (first, second) in enumerate(planes)
    )


def overlap(pinion: Gear, gear: Gear, first: float, second: float) -> tuple[float, float] | None:
    """z range in m where two helices with mid-planes at `first` and `second` face each other; None where a width is missing."""
    if not pinion.width or not gear.width:
        return None
    low = max(first - 0.5 * pinion.width, second - 0.5 * gear.width)
    high = min(first + 0.5 * pinion.width, second + 0.5 * gear.width)
    return low, high


def _common_plane(pinion: Gear, gear: Gear, first: float, second: float) -> float:
    face = overlap(pinion, gear, first, second)
    return 0.5 * (first + second) if face is None else 0.5 * (face[0] + face[1])
