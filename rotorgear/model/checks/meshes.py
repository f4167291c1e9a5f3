"""Checks of meshes: whether two gears can mesh at all, and on their axes; and what is odd where their teeth meet."""

from __future__ import annotations

import math
from collections.abc import Iterator

from rotorgear.errors import Problem, RotorgearError
from rotorgear.gears.geometry.interference import radial_distance, tip_distance
from rotorgear.gears.geometry.pair import working_centre_distance
from rotorgear.model.checks.axes import not_parallel
from rotorgear.model.checks.bevel import bevel_problems
from rotorgear.model.checks.casings import counted_twice
from rotorgear.model.checks.gears import degrees, pressure_angle_problems
from rotorgear.model.layout.layout import Layout
from rotorgear.model.layout.mesh_layout import MeshLayout
from rotorgear.model.parts.fields import RIGID
from rotorgear.model.parts.gear import Gear
from rotorgear.model.parts.mesh import Mesh
from rotorgear.model.parts.problems import missing, not_default, told
from rotorgear.model.parts.shaft import PositionByMesh
from rotorgear.model.parts.tables import Tables
from rotorgear.quantity import millimetres

# Axes may miss the distance of the profile shifts by this share of the normal module: more is another gear, not backlash.
CENTRE_DISTANCE_TOLERANCE = 0.05
# Lumped gears come with rounded radii and angles.
LUMPED_TOLERANCE = 5e-3
_AXES = "parallel axes of cylindrical gears"
# What teeth have that give, part or move beside their gears.
_GIVING = (
    *(
        "damping_ratio",
        "damping",
        "tilt",
        "index_error",
        "helix_index_error",
        "transmission_error",
        "stiffness_variation",
    ),
    *("corner_impact", "friction_coefficient", "lubricant_viscosity", "backlash"),
)
_OF_RIGID = "the flanks of a rigid mesh stay in touch exactly; or give it a stiffness"
# Fewer pitches than these are no body for a tooth and its neighbours.
_LEAST_PITCHES = 3
# Teeth that jam by less, in m along the normal, do so by the digits of a drawing: positions are rounded to a micrometre.
_ROUNDED = 1e-6


def mesh_settings(model: Tables) -> Iterator[Problem]:
    """Yield what is wrong with the numbers of a mesh by themselves."""
    for name, mesh in model.meshes.items():
        address = f"meshes.{name}"
        if mesh.damping is not None and mesh.damping_ratio:
            yield Problem(address, "damping and damping_ratio", "one of the two")
        yield from pressure_angle_problems(f"{address}.pressure_angle", mesh.pressure_angle)
        pitches = mesh.tooth_fe.pitches
        few = pitches < _LEAST_PITCHES or pitches % 2 == 0
        yield from told(
            address,
            ("tooth_fe.pitches", few, f"{pitches}", "an odd number of at least 3"),
            ("stagger", mesh.stagger >= 1.0, f"{mesh.stagger:g}", "a share of the mesh period, from 0 to below 1"),
        )


def mesh_problems(layout: Layout) -> Iterator[Problem]:
    """Yield what keeps two gears from meshing: kind, module, angle, hand, faces, axes."""
    for both in layout.meshes:
        mesh = both.part
        pinion = both.pinion.part
        gear = both.gear.part
        address = f"meshes.{both.name}"
        if mesh.pinion == mesh.gear:
            yield Problem(address, f"gear '{mesh.gear}' with itself", "two gears")
        elif pinion.shaft == gear.shaft:
            yield Problem(address, f"two gears on shaft '{pinion.shaft}'", "gears on two shafts")
        elif pinion.is_bevel and gear.is_bevel:
            yield from _excitations(address, mesh, pinion, gear)
            yield from bevel_problems(address, both)
        elif pinion.is_bevel == gear.is_bevel and (inclined := list(not_parallel(address, both.gear_frame, _AXES))):
            yield from inclined
        else:
            yield from _excitations(address, mesh, pinion, gear)
            yield from _on_shafts(address, both)
            # In torsion alone a given stiffness says all: where along z a mesh stands changes nothing.
            anywhere = layout.model.motions == ("torsion",) and not both.is_modelled
            faces = () if anywhere else _faces(address, both)
            found = [*_mates(address, pinion, gear), *faces, *_teeth(address, mesh, pinion, gear)]
            found = found or list(_axes(address, both, in_bending=layout.model.has("bending")))
            yield from found
            if not found:  # loaded teeth need axes on which they mesh
                yield from counted_twice(address, both)
                yield from _wind_up(address, both, [other for other in layout.meshes if other is not both])


def _wind_up(address: str, mesh: MeshLayout, others: list[MeshLayout]) -> Iterator[Problem]:
    """A gear winds up in the rotor model or in its meshes, not in both."""
    if not mesh.has_loaded_teeth:
        return
    fe = mesh.teeth.fe
    try:
        bodies = mesh.teeth.bodies
    except RotorgearError as error:
        yield Problem(f"{address}.tooth_fe", "", str(error))
        return
    for gear, body in zip(mesh.gears, bodies, strict=True):
        if gear.part.integral and body == "wheel" and fe.excludes_torsion(body):
            got = f"a wheel that winds up against its bore, of gear '{gear.name}', which is cut on its shaft"
            wanted = "another body or exclude_torsion = false, or integral = false for the gear"
            yield Problem(f"{address}.tooth_fe", got, wanted)
    elastic: dict[str, str] = {}
    for other in others:
        try:
            elastic |= {gear.name: other.name for gear in other.elastic_gears} if other.has_teeth else {}
        except RotorgearError:  # teeth that can't mesh are told of that mesh
            continue
    for gear in mesh.gears:
        if gear.name in elastic and gear not in mesh.elastic_gears:
            wanted = f"body and exclude_torsion as in meshes.{elastic[gear.name]}, which leaves it to the rotor model"
            yield Problem(f"{address}.tooth_fe", f"the wind-up of gear '{gear.name}' in this mesh", wanted)


def _excitations(address: str, mesh: Mesh, pinion: Gear, gear: Gear) -> Iterator[Problem]:
    """Harmonics of a mesh need its frequency; what tells two helices apart needs two."""
    unknown = not (pinion.teeth and gear.teeth)
    keys = [key for key in ("transmission_error", "stiffness_variation", "corner_impact") if getattr(mesh, key)]
    rigid = mesh.stiffness == RIGID
    varies = mesh.stiffness_variation and not (rigid or isinstance(mesh.stiffness, int | float))
    duration = mesh.corner_impact.duration if mesh.corner_impact else 0.5
    both = mesh.friction_coefficient and mesh.lubricant_viscosity
    toothless = not (pinion.normal_module and gear.normal_module and (pinion.width or gear.width))
    place = "teeth, module and width of both gears: they place the contacts"
    helix = mesh.helix_index_error and pinion.kind != "herringbone"
    cycle = "a share of the mesh cycle between 0 and 1"
    yield from told(
        address,
        *((key, unknown, "harmonics of a mesh whose frequency is unknown", "teeth of both gears") for key in keys),
        ("stiffness_variation", varies, "harmonics beside a stiffness that varies itself", "one of the two"),
        ("corner_impact.duration", not 0.0 < duration < 1.0, f"{duration:g}", cycle),
        ("", both, "friction_coefficient and lubricant_viscosity", "one of the two"),
        ("", mesh.rubs and toothless, "friction between gears without teeth", place),
        ("helix_index_error", helix, "a value", "nothing here", "only a herringbone pair has two helices"),
        *((key, rigid, "a value", "nothing here", _OF_RIGID) for key in not_default(mesh, _GIVING)),
    )


def _teeth(address: str, mesh: Mesh, pinion: Gear, gear: Gear) -> Iterator[Problem]:
    """A stiffness model needs teeth, a stagger two helices, and a tilt a face."""
    narrow = mesh.tilt and not (pinion.width and gear.width)
    face = "the flanks resist a tilt over the width of their face"
    one = mesh.stagger and pinion.kind != "herringbone"
    named = isinstance(mesh.stiffness, str) and mesh.stiffness != RIGID and pinion.lumped
    wanted = "a stiffness such as '5e8 N/m' between gears that are given by their base radius"
    energy = mesh.stiffness == "potential_energy" and gear.internal and not gear.lumped
    others = "'iso', 'contact_line', 'tooth_fe' or a number"
    yield from told(
        address,
        ("tilt", narrow, "true between gears without a width", "a width of both gears", face),
        ("stagger", one, f"{mesh.stagger:g}", "0, or herringbone gears", "one helix has nothing to lead"),
        ("stiffness", energy, f"'{mesh.stiffness}' in a ring", others, "its formulas are of external teeth"),
        ("stiffness", named, f"'{mesh.stiffness}'", wanted, "a stiffness model needs teeth"),
    )


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
    if pinion.internal:
        yield Problem(address, "a ring as its pinion", "the ring as the gear: the external gear is the pinion")
    elif pinion.kind != "spur" and gear.internal and pinion.hand != gear.hand:
        text = f"a {pinion.hand}-hand pinion in a {gear.hand}-hand ring"
        yield Problem(address, text, "the same hand of both", "an internal pair winds the same way")
    elif pinion.kind != "spur" and not gear.internal and pinion.hand == gear.hand:
        hint = "external gears on parallel axes have opposite hands"
        yield Problem(address, f"two {pinion.hand}-hand gears", "a right-hand and a left-hand one", hint)


def _faces(address: str, mesh: MeshLayout) -> Iterator[Problem]:
    if mesh.pinion.part.kind != mesh.gear.part.kind:
        return
    for helix, (one, other) in enumerate(mesh.planes):
        face = mesh.face(helix)
        if face is None and abs(one - other) > 1e-9 + 1e-6 * max(abs(one), abs(other)):
            text = f"gears at z = {millimetres(one)} and z = {millimetres(other)}, not both with a width"
            yield Problem(address, text, "gears at one z, or widths that say where the faces meet")
            return
        if face and face[1] <= face[0]:
            text = f"faces around z = {millimetres(one)} and z = {millimetres(other)}"
            yield Problem(address, text, "faces that overlap", "check at, width and gap")
            return


def _on_shafts(address: str, mesh: MeshLayout) -> Iterator[Problem]:
    """A face that is cut on its shaft lies on it."""
    if not mesh.part.tilt or mesh.pinion.part.kind != mesh.gear.part.kind:
        return
    for gear in mesh.gears:
        shaft = gear.shaft_part
        slack = 1e-9 * max(shaft.length, abs(shaft.start))
        for helix in range(mesh.helices if gear.part.integral else 0):
            low, high = mesh.own_face(gear, helix) or (shaft.start, shaft.end)
            if low < shaft.start - slack or high > shaft.end + slack:
                text = f"a face from {millimetres(low)} to {millimetres(high)} on shaft '{gear.shaft}'"
                run = f"it runs from {millimetres(shaft.start)} to {millimetres(shaft.end)}"
                run = f"a shaft under the whole face; {run}"
                yield Problem(f"gears.{gear.name}.integral", text, run, f"{address} has tilt = true")
                return


def _axes(address: str, mesh: MeshLayout, *, in_bending: bool) -> Iterator[Problem]:
    line = mesh.centre_line
    # Where a mesh could not place a shaft its teeth can't mesh, which is told below.
    unplaced = any(isinstance(gear.shaft_part.position, PositionByMesh) for gear in mesh.gears)
    found: list[Problem] = []
    if line is not None and not mesh.has_own_angle:
        for key in ("centre_line_angle", "pressure_angle"):
            if (angle := getattr(mesh.part, key)) is not None:
                hint = "it follows from the positions of the shafts"
                found.append(Problem(f"{address}.{key}", degrees(angle), "nothing here", hint))
    elif in_bending and line is None and not unplaced:  # torsion alone needs no direction of the mesh force
        pinion = mesh.pinion.part
        gear = mesh.gear.part
        if mesh.part.centre_line_angle is None:
            why = "positions of both shafts, or the angle of the centre line here"
            found.append(missing(f"{address}.centre_line_angle", why))
        angles = (pinion.transverse_pressure_angle, gear.transverse_pressure_angle, mesh.part.pressure_angle)
        if pinion.lumped and all(angle is None for angle in angles):
            why = "positions of both shafts, or the working transverse pressure angle here"
            found.append(missing(f"{address}.pressure_angle", why))
    try:
        found += [] if line is None or mesh.has_own_angle else _distance(address, mesh, line[0])
        if not found:
            _ = mesh.pair  # derived here, so that teeth that can't mesh are told now
            found += _tips(address, mesh)
    except RotorgearError as error:
        found.append(Problem(address, "", str(error)))
    yield from found


def _tips(address: str, mesh: MeshLayout) -> Iterator[Problem]:
    """The tips of a pinion and its ring pass each other beside the line of action."""
    pinion = mesh.pinion.geometry
    ring = mesh.gear.geometry
    if not mesh.is_internal or pinion is None or ring is None or mesh.pair is None:
        return
    least = -_ROUNDED - mesh.backlash.least / math.cos(pinion.normal_pressure_angle)
    if (passed := tip_distance(pinion, ring, mesh.pair)) < least:
        text = f"tips of '{mesh.pinion.name}' and '{mesh.gear.name}' that cut each other by {millimetres(-passed)}"
        hint = f"{abs(ring.teeth)} teeth are few around {pinion.teeth}: take more, smaller addenda or another profile shift"
        yield Problem(address, text, "tips that pass each other beside the mesh", hint)


def _distance(address: str, mesh: MeshLayout, given: float) -> Iterator[Problem]:
    """Axes that lie as far apart as the teeth want, so far as that may be missed."""
    bases = abs(mesh.pinion.base_radius + mesh.gear_base_radius)
    first = mesh.pinion.geometry
    second = mesh.gear.geometry
    if first and second:
        wanted = abs(working_centre_distance(first, second))
        slack = CENTRE_DISTANCE_TOLERANCE * first.normal_module
    else:
        angle = mesh.pinion.part.transverse_pressure_angle or mesh.gear.part.transverse_pressure_angle
        wanted = bases / math.cos(angle) if angle else 0.0
        slack = LUMPED_TOLERANCE * wanted
    if given <= bases or (wanted and abs(given - wanted) > slack):
        least = f"more than {'the difference of' if mesh.is_internal else 'both'} base radii, {millimetres(bases)}"
        text = f"a centre distance of {millimetres(wanted)}" if wanted else least
        hint = "check the positions of the shafts, the teeth, the module and the profile shifts"
        yield Problem(address, f"axes {millimetres(given)} apart", text, "" if mesh.pinion.part.lumped else hint)


def massless_gears(layout: Layout) -> Iterator[Problem]:
    """A damping ratio needs the inertia of both gears."""
    for mesh in layout.meshes:
        ratio = mesh.part.damping_ratio
        rigid = [gear for gear in mesh.gears if gear.part.body.mesh is None]
        empty = [gear.name for gear in rigid if ratio and not gear.body.polar_inertia]
        if empty:
            text = f"{ratio:g} with gear '{empty[0]}' of no polar inertia"
            hint = "c = 2 zeta sqrt(k m_e) needs the inertia of both gears"
            yield Problem(f"meshes.{mesh.name}.damping_ratio", text, "a damping coefficient, damping, instead", hint)


# Less clearance between tip and root than this share of the module is worth a word (ISO 53 has 0.25).
_LEAST_CLEARANCE = 0.1


def mesh_findings(mesh: MeshLayout) -> Iterator[str]:
    """Sentences on a mesh whose teeth meet where they shouldn't, or hardly."""
    from rotorgear.gears.geometry.outline import tooth_outline

    pair = mesh.pair
    first = mesh.pinion.geometry
    second = mesh.gear.geometry
    if pair is None or first is None or second is None:
        return
    if pair.interference:
        yield "a tip reaches below its mate's base tangent point (interference); contact ratios are nominal"
    active = pair.active_root_diameters(first, second)
    for own, mate, g, h, used in (
        (mesh.pinion.name, mesh.gear.name, first, second, active[0]),
        (mesh.gear.name, mesh.pinion.name, second, first, active[1]),
    ):
        form = 2.0 * g.sign * tooth_outline(g).form_radius
        if not pair.interference and used < form - 1e-6 * abs(form):
            change = "increase" if h.is_internal else "reduce"
            yield (
                f"the tip of '{mate}' works down to diameter {1e3 * abs(used):.6g} mm of '{own}', whose involute begins at "
                f"{1e3 * abs(form):.6g} mm: contact begins in the fillet; {change} the tip diameter of '{mate}'"
            )
        clearance = pair.centre_distance - 0.5 * (h.effective_tip_diameter + g.root_diameter)
        if clearance < _LEAST_CLEARANCE * g.normal_module:
            yield f"between the tip of '{mate}' and the root of '{own}' are only {1e3 * clearance:.3g} mm"
    if second.is_internal and radial_distance(first, second, pair) < -_ROUNDED:
        yield f"'{mesh.pinion.name}' can't be put into '{mesh.gear.name}' from inside, only along the axis: tips are in the way"
    if pair.total_contact_ratio < 1.0:
        yield f"total contact ratio {pair.total_contact_ratio:.3g} is below 1, the teeth lose contact"
    if mesh.backlash.least < -_ROUNDED:
        jam = f"{-1e6 * mesh.backlash.least:.3g} um along the flank normal"
        far, move = ("far apart", "together") if second.is_internal else ("close", "apart")
        yield f"the axes are too {far}: the teeth would jam by {jam}; give allowances, or move the axes {move}"
