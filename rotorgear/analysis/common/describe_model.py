"""Says what a model describes before anything is solved: the verb behind `rotorgear check`."""

from __future__ import annotations

import math

import numpy as np

from rotorgear.analysis.common.left_out import left_out
from rotorgear.analysis.common.model_warnings import model_warnings
from rotorgear.analysis.common.recorded import recorded
from rotorgear.elements.gear_mesh import flank_normal
from rotorgear.model.checks.names import TABLES
from rotorgear.model.layout.state import contact_geometry
from rotorgear.model.model import Model
from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.description import GearRow, MeshRow, ModelDescription, PlaceRow, ShaftRow, TorqueRow
from rotorgear.system.plan import Plan
from rotorgear.system.system import System, flow_system

# Tables whose parts are counted, in the order in which they are told.
_FIRST = ("shafts", "gears", "meshes")
_COUNTED = (*_FIRST, *(table for table in TABLES if table not in (*_FIRST, "materials", "loads")))


@recorded
def check(model: Model, *, elements: int | None = None) -> ModelDescription:
    """Return speeds, mesh frequencies, torques, contact ratios, masses, dofs and warnings of a model.

    Args:
        model: a checked model.
        elements: number of basic elements in each shaft segment, for the number of degrees of freedom (default: 1).
    """
    system = flow_system(model, Plan(elements or 1))
    speed = model.operating_speed
    masses = _masses(system)
    casings = {name: float(system.layout.casing(name).body_mass) for name in model.casings}
    ratios = {name: system.train.ratio(name) for name in model.shafts}
    rpm = {name: None if speed is None else ratio * speed * RPM_PER_RAD_S for name, ratio in ratios.items()}
    tables = ("bearings", "supports", "couplings", "disks", "point_masses", "loads", "unbalances", "points")
    places = [PlaceRow(part, *place) for part, _ in model.parts_of(*tables) for place in system.layout.places(part)]
    shaft_order = list(model.shafts)
    return ModelDescription(
        title=model.title,
        reference_shaft=model.reference_shaft,
        speed_rpm=None if speed is None else speed * RPM_PER_RAD_S,
        shafts=tuple(
            ShaftRow(name, ratio, rpm[name], model.shafts[name].length, *masses[name]) for name, ratio in ratios.items()
        ),
        gears=tuple(
            GearRow(
                name=gear.name,
                shaft=gear.shaft,
                teeth=gear.part.teeth,
                hand=gear.part.hand,
                base_radius_m=gear.base_radius,
                z_m=tuple(place.z for place in gear.places),
                clocking_deg=math.degrees(system.layout.assembly.clocking.get(gear.name, 0.0)),
                mass_kg=gear.body.mass,
                polar_inertia_kg_m2=gear.body.polar_inertia,
            )
            for gear in system.layout.gears
        ),
        places=tuple(sorted(places, key=lambda row: (shaft_order.index(row.shaft), row.z_m))),
        meshes=tuple(_mesh(system, name, speed) for name in model.meshes),
        torques=tuple(
            TorqueRow(
                item.name,
                item.shaft,
                item.torque,
                None if speed is None else item.torque * system.train.ratio(item.shaft) * speed,
            )
            for item in system.state.applied
        ),
        total_mass_kg=sum(bare + bodies for bare, bodies, _ in masses.values()),
        casing_mass_kg={name: mass for name, mass in casings.items() if math.isfinite(mass)},
        counts={table: len(getattr(model, table)) for table in _COUNTED if getattr(model, table)},
        nodes=len(system.nodes),
        dofs=system.n,
        mesh=f"{elements or 1} basic element{'s'[: (elements or 1) != 1]} per shaft segment, before any refinement",
        left_out=left_out(system, "modes", speed),
        warnings=(*system.nodes.merged, *model_warnings(system)),
    )


def _masses(system: System) -> dict[str, tuple[float, float, float]]:
    """Of each shaft: its mass, mass of the bodies on it (kg), and the polar inertia of both (kg m^2)."""
    found = {name: [0.0, 0.0, 0.0] for name in system.model.shafts}
    for group in system.groups:
        M = group.matrices.mass
        if M is None or group.shaft not in found:
            continue
        if group.part.removeprefix("gears.") in system.layout.elastic_bodies:
            M = M[:, :6, :6]  # the motion of the hub; the modes behind it do not take part in a rigid motion
        x = np.arange(0, M.shape[1], 6)
        tz = np.arange(5, M.shape[1], 6)
        own = found[group.shaft]
        own[0 if group.part == f"shafts.{group.shaft}" else 1] += float(M[:, x][:, :, x].sum())
        own[2] += float(M[:, tz][:, :, tz].sum())
    return {name: (bare, bodies, polar) for name, (bare, bodies, polar) in found.items()}


def _mesh(system: System, name: str, speed: float | None) -> MeshRow:
    mesh = system.layout.mesh(name)
    pinion = mesh.pinion.part
    gear = mesh.gear.part
    forces = system.state.of_mesh(name)
    contact = forces[0].contact
    phases = [system.state.phase(force.contact) for force in forces]
    line = mesh.centre_line
    pair = mesh.pair
    radial = axial = None
    if contact.cone is not None:
        on_gear = forces[0].normal_force * flank_normal(contact_geometry(forces[0]))
        radial = float(on_gear[0] * math.cos(contact.psi) + on_gear[1] * math.sin(contact.psi))
        axial = float(-contact.cone.sides[0] * on_gear[2])
    viscosities = (group.matrices.viscosity for group in system.groups if group.part == f"meshes.{name}")
    return MeshRow(
        name=name,
        pinion=mesh.pinion.name,
        gear=mesh.gear.name,
        ratio=gear.teeth / pinion.teeth
        if gear.teeth and pinion.teeth
        else mesh.gear.base_radius / mesh.pinion.base_radius,
        centre_distance_m=line[0] if line else (pair.centre_distance if pair else None),
        centre_line_deg=math.degrees(
            math.remainder(contact.psi, 2.0 * math.pi) if contact.psi > math.pi else contact.psi
        ),
        pressure_angle_deg=math.degrees(contact.pressure_angle),
        base_helix_angle_deg=math.degrees(contact.base_helix_angle),
        transverse_contact_ratio=pair.transverse_contact_ratio if pair else None,
        overlap_ratio=pair.overlap_ratio if pair else None,
        mesh_frequency_hz=None if speed is None else system.layout.mesh_frequency(name, speed),
        phase_pitches=tuple(None if phi is None else phi / (2.0 * math.pi) % 1.0 for phi in phases),
        normal_force_n=tuple(force.normal_force for force in forces),
        driver=(mesh.pinion if forces[0].pinion_drives else mesh.gear).name,
        flank_assumed=any(force.assumed for force in forces),
        stiffness_n_per_m=None if mesh.is_rigid else sum(force.contact.stiffness for force in forces),
        damping_n_s_per_m=sum((float(C[0, 0, 0]) for C in viscosities if C is not None), 0.0),
        bevel_radial_force_n=radial,
        bevel_axial_force_n=axial,
    )
