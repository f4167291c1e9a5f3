"""Checks of meshes: whether two gears can mesh at all, and on their axes."""

from __future__ import annotations

import math
from collections.abc import Iterator

from rotorgear.errors import Problem, RotorgearError
from rotorgear.gears.geometry.pair import working_centre_distance
from rotorgear.model.checks.gears import degrees, missing, pressure_angle_problems
from rotorgear.model.layout.inertia import node_bodies
from rotorgear.model.layout.mesh_geometry import (
    base_radius,
    centre_line,
    gear_geometry,
    helix_planes,
    mesh_pair,
    overlap,
)
from rotorgear.model.parts.gear import Gear
from rotorgear.model.parts.mesh import Mesh
from rotorgear.model.parts.tables import Tables
from rotorgear.quantity import millimetres

# Axes may miss the distance of the profile shifts by this share of the normal module: more is another gear, not backlash.
CENTRE_DISTANCE_TOLERANCE = 0.05
# Lumped gears come with rounded radii and angles.
LUMPED_TOLERANCE = 5e-3
# Fewer pitches than these are no body for a tooth and its neighbours.
_LEAST_PITCHES = 3


def mesh_settings(model: Tables) -> Iterator[Problem]:
    """Yield what is wrong with the numbers of a mesh by themselves."""
    for name, mesh in model.meshes.items():
        address = f"meshes.{name}"
        if mesh.damping is not None and mesh.damping_ratio:
            yield Problem(address, "damping and damping_ratio", "one of the two")
        yield from pressure_angle_problems(f"{address}.pressure_angle", mesh.pressure_angle)
        if mesh.tooth_fe.pitches < _LEAST_PITCHES or mesh.tooth_fe.pitches % 2 == 0:
            yield Problem(f"{address}.tooth_fe.pitches", f"{mesh.tooth_fe.pitches}", "an odd number of at least 3")
        if mesh.stagger >= 1.0:
            yield Problem(f"{address}.stagger", f"{mesh.stagger:g}", "a share of the mesh period, from 0 to below 1")


def mesh_problems(model: Tables) -> Iterator[Problem]:
    """Yield what keeps two gears from meshing: kind, module, angle, hand, faces, axes."""
    for name, mesh in model.meshes.items():
        pinion = model.gears[mesh.pinion]
        gear = model.gears[mesh.gear]
        address = f"meshes.{name}"
        if mesh.pinion == mesh.gear:
            yield Problem(address, f"gear '{mesh.gear}' with itself", "two gears")
        elif pinion.shaft == gear.shaft:
            yield Problem(address, f"two gears on shaft '{pinion.shaft}'", "gears on two shafts")
        else:
            yield from _excitations(address, mesh, pinion, gear)
            found = [*_mates(address, pinion, gear), *_faces(model, address, mesh), *_teeth(address, mesh, pinion)]
            yield from found or _axes(model, address, name)


def _excitations(address: str, mesh: Mesh, pinion: Gear, gear: Gear) -> Iterator[Problem]:
    """Harmonics of a mesh need its frequency; what tells two helices apart needs two."""
    for key in ("transmission_error", "stiffness_variation", "corner_impact"):
        if getattr(mesh, key) and not (pinion.teeth and gear.teeth):
            yield Problem(f"{address}.{key}", "harmonics of a mesh whose frequency is unknown", "teeth of both gears")
    if mesh.stiffness_variation and not isinstance(mesh.stiffness, int | float):
        yield Problem(
            f"{address}.stiffness_variation", "harmonics beside a stiffness that varies itself", "one of the two"
        )
    if mesh.corner_impact and not 0.0 < mesh.corner_impact.duration < 1.0:
        yield Problem(
            f"{address}.corner_impact.duration",
            f"{mesh.corner_impact.duration:g}",
            "a share of the mesh cycle between 0 and 1",
        )
    if mesh.friction_coefficient or mesh.lubricant_viscosity:
        if mesh.friction_coefficient and mesh.lubricant_viscosity:
            yield Problem(address, "friction_coefficient and lubricant_viscosity", "one of the two")
        if not (pinion.normal_module and gear.normal_module and (pinion.width or gear.width)):
            yield Problem(
                address,
                "friction between gears without teeth",
                "teeth, module and width of both gears: they place the contacts",
            )
    for key in ("helix_index_error", "helix_stagger"):
        if getattr(mesh, key) and pinion.kind != "herringbone":
            yield Problem(f"{address}.{key}", "a value", "nothing here", "only a herringbone pair has two helices")


def _teeth(address: str, mesh: Mesh, pinion: Gear) -> Iterator[Problem]:
    """A stiffness model needs teeth, and a stagger two helices."""
    if mesh.stagger and pinion.kind != "herringbone":
        yield Problem(
            f"{address}.stagger", f"{mesh.stagger:g}", "0, or herringbone gears", "one helix has nothing to lead"
        )
    if isinstance(mesh.stiffness, str) and pinion.lumped:
        wanted = "a stiffness such as '5e8 N/m' between gears that are given by their base radius"
        yield Problem(f"{address}.stiffness", f"'{mesh.stiffness}'", wanted, "a stiffness model needs teeth")


def _mates(address: str, pinion: Gear, gear: Gear) -> Iterator[Problem]:
    if pinion.kind != gear.kind:
        yield Problem(address, f"a {pinion.kind} pinion and a {gear.kind} gear", "two gears of one kind")
        return
    if pinion.lumped != gear.lumped:
        toothed, lumped = ("gear", "pinion") if pinion.lumped else ("pinion", "gear")
        text = f"a {toothed} given by its teeth and a {lumped} given by its base radius"
        yield Problem(address, text, "two gears given in the same way")
        return
    keys = ["normal_module", "normal_pressure_angle", "helix_angle"]
    for key in ["transverse_pressure_angle", "base_helix_angle"] if pinion.lumped else keys:
        first = getattr(pinion, key)
        second = getattr(gear, key)
        if first is not None and second is not None and not math.isclose(first, second, rel_tol=1e-9):
            one, other = (f"{1e3 * x:.9g} mm" if key == "normal_module" else degrees(x) for x in (first, second))
            text = f"a {key.replace('_', ' ')} of {one} on the pinion and {other} on the gear"
            yield Problem(address, text, "the same on both")
    if pinion.kind != "spur" and pinion.hand == gear.hand:
        hint = "external gears on parallel axes have opposite hands"
        yield Problem(address, f"two {pinion.hand}-hand gears", "a right-hand and a left-hand one", hint)


def _faces(model: Tables, address: str, mesh: Mesh) -> Iterator[Problem]:
    first = model.gears[mesh.pinion]
    second = model.gears[mesh.gear]
    if first.kind != second.kind:
        return
    for one, other in zip(helix_planes(model, mesh.pinion), helix_planes(model, mesh.gear), strict=True):
        face = overlap(first, second, one, other)
        if face is None and abs(one - other) > 1e-9 + 1e-6 * max(abs(one), abs(other)):
            text = f"gears at z = {millimetres(one)} and z = {millimetres(other)}, not both with a width"
            yield Problem(address, text, "gears at one z, or widths that say where the faces meet")
            return
        if face and face[1] <= face[0]:
            low = millimetres(one)
            high = millimetres(other)
            yield Problem(
                address, f"faces around z = {low} and z = {high}", "faces that overlap", "check at, width and gap"
            )
            return


def _axes(model: Tables, address: str, name: str) -> Iterator[Problem]:
    mesh = model.meshes[name]
    line = centre_line(model, name)
    found = list(_no_axes(model, address, mesh) if line is None else _given_twice(address, mesh))
    try:
        found += [] if line is None else _distance(model, address, mesh, line[0])
        if not found:
            mesh_pair(model, name)
    except RotorgearError as error:
        found.append(Problem(address, "", str(error)))
    yield from found


def _given_twice(address: str, mesh: Mesh) -> Iterator[Problem]:
    for key in ("centre_line_angle", "pressure_angle"):
        if (angle := getattr(mesh, key)) is not None:
            yield Problem(
                f"{address}.{key}", degrees(angle), "nothing here", "it follows from the positions of the shafts"
            )


def _distance(model: Tables, address: str, mesh: Mesh, given: float) -> Iterator[Problem]:
    pinion = model.gears[mesh.pinion]
    gear = model.gears[mesh.gear]
    bases = base_radius(pinion) + base_radius(gear)
    wanted, slack = _centre_distance(pinion, gear)
    if given <= bases or (wanted and abs(given - wanted) > slack):
        text = (
            f"a centre distance of {millimetres(wanted)}"
            if wanted
            else f"more than both base radii, {millimetres(bases)}"
        )
        hint = "check the positions of the shafts, the teeth, the module and the profile shifts"
        yield Problem(address, f"axes {millimetres(given)} apart", text, "" if pinion.lumped else hint)


def _centre_distance(pinion: Gear, gear: Gear) -> tuple[float, float]:
    """Return the distance of the axes that two gears want and how far it may be missed, in m; 0 where they want none."""
    first = gear_geometry(pinion)
    second = gear_geometry(gear)
    if first and second:
        return working_centre_distance(first, second), CENTRE_DISTANCE_TOLERANCE * first.normal_module
    angle = pinion.transverse_pressure_angle or gear.transverse_pressure_angle
    wanted = (base_radius(pinion) + base_radius(gear)) / math.cos(angle) if angle else 0.0
    return wanted, LUMPED_TOLERANCE * wanted


def _no_axes(model: Tables, address: str, mesh: Mesh) -> Iterator[Problem]:
    pinion = model.gears[mesh.pinion]
    gear = model.gears[mesh.gear]
    if not model.has("bending"):
        return
    if mesh.centre_line_angle is None:
        yield missing(f"{address}.centre_line_angle", "positions of both shafts, or the angle of the centre line here")
    angles = (pinion.transverse_pressure_angle, gear.transverse_pressure_angle, mesh.pressure_angle)
    if pinion.lumped and all(angle is None for angle in angles):
        yield missing(
            f"{address}.pressure_angle", "positions of both shafts, or the working transverse pressure angle here"
        )


def massless_gears(model: Tables) -> Iterator[Problem]:
    """A damping ratio needs the inertia of both gears."""
    inertia: dict[str, float] = {}
    for node in node_bodies(model):
        inertia[node.part] = inertia.get(node.part, 0.0) + node.body.polar_inertia
    for name, mesh in model.meshes.items():
        empty = [gear for gear in (mesh.pinion, mesh.gear) if not inertia[f"gears.{gear}"]]
        if mesh.damping_ratio and empty:
            text = f"{mesh.damping_ratio:g} with gear '{empty[0]}' of no polar inertia"
            hint = "c = 2 zeta sqrt(k m_e) needs the inertia of both gears"
            yield Problem(f"meshes.{name}.damping_ratio", text, "a damping coefficient, damping, instead", hint)
