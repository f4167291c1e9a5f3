"""Checks of casings and gear bodies before their meshes are read: what they need, and what would count twice."""

from __future__ import annotations

from collections.abc import Iterator

from rotorgear.errors import Problem
from rotorgear.model.checks.names import unknown
from rotorgear.model.checks.sizes import six_by_six
from rotorgear.model.layout.casings import bore_sizes, parts_in
from rotorgear.model.layout.mesh_layout import MeshLayout
from rotorgear.model.parts.casing import Box, Casing, Seat
from rotorgear.model.parts.fields import MOTIONS
from rotorgear.model.parts.gear import BLANK
from rotorgear.model.parts.problems import missing, not_default, shown, told
from rotorgear.model.parts.references import PartName
from rotorgear.model.parts.tables import Tables
from rotorgear.quantity import millimetres

# Keys that say something of a casing which was reduced elsewhere; all others are of meshes.
_OF_MATRICES = ("matrices", "interface", "seats", "damping_ratio")
_MATERIAL = ("youngs_modulus", "poisson_ratio", "density")
_PLACE = ("axis", "center", "from", "to", "radius")
# Keys of a gear body.
_OF_MESHES = ("unit", "material", "seat", "rim", "connection", "modes_to", "damping_ratio", "mass_tolerance")
# Keys that say something of a mesh from a file.
_OF_FILES = ("mesh", "unit", "seats", "joins")
_UNIT = "files of meshes carry no unit of length; say unit = 'mm' or 'm'"


def casings(model: Tables, broken: set[PartName]) -> Iterator[Problem]:
    """Casings have mesh, unit and material; their seats are those of bearings."""
    tables = ("bearings", "nonlinear_elements")
    rings = {name: gear for name, gear in model.gears.items() if gear.casing is not None}
    seated = [*model.bearings, *model.nonlinear_elements, *rings, *(name for table, name in broken if table in tables)]
    if model.casings:
        yield from _all_motions(model, "a casing", "seats move in all directions")
    for name, casing in model.casings.items():
        address = f"casings.{name}"
        if casing.matrices is not None:
            # A body that was reduced elsewhere has its material, supports and modes already.
            for key in not_default(casing, (key for key in type(casing).model_fields if key not in _OF_MATRICES)):
                what = f"{key} beside a mesh only"
                yield Problem(f"{address}.{key}", "beside matrices", what, "the matrices have it already")
            for bearing, seat in casing.seats.items():
                if seat.set is None:
                    what = "the name of a seat in the file of matrices"
                    yield Problem(f"{address}.seats.{bearing}", "a place", what)
            continue
        given = [key for key in _MATERIAL if getattr(casing, key) is not None]
        these = ", ".join(given)
        named = casing.material is not None
        lacking = [key for key in _MATERIAL if key not in given] if given and not named else []
        nu = casing.poisson_ratio or 0.0
        under = "the seats of a mesh stand under seats"
        body = casing.mesh or casing.box
        yield from told(
            address,
            ("interface", casing.interface, "without matrices", "matrices beside it", under),
            ("mesh", not body, "", "missing", "required: the file of the mesh, such as 'box.msh'; or give a box"),
            ("unit", casing.mesh and casing.unit is None, "", "missing", f"required: {_UNIT}"),
            ("", named and given, f"material and {these}", "one of the two ways to say what the casing is of"),
            ("material", body and not (named or given), "", "missing", f"required, or {', '.join(_MATERIAL)}"),
            *((key, True, "", "missing", f"required beside {these}") for key in lacking),
            ("poisson_ratio", not named and nu >= 0.5, f"{nu:.4g}", "one from 0 to below 0.5"),
        )
        for set_name, mount in casing.mounts.items():
            yield from six_by_six(f"{address}.mounts.{set_name}", mount, None, f"hold it: held = ['{set_name}']")
            yield from six_by_six(f"{address}.mounts.{set_name}", None, mount.damping)
        if casing.box is not None:
            yield from _box(model, name, casing, casing.box)
            continue
        if not casing.seats:
            where = "where bearings sit: seats = { left = 'name of a face set' }"
            yield Problem(f"{address}.seats", "", "missing", where)
        for bearing, seat in casing.seats.items():
            if bearing not in seated and not {(table, "") for table in tables} & broken:
                yield unknown(f"{address}.seats.{bearing}", bearing, seated, "a bearing")
            yield from _seat(f"{address}.seats.{bearing}", seat)
    # What stands in a casing has a seat there, and stands on nothing else.
    for address, part in [*model.parts_of(*tables), *((f"gears.{name}", ring) for name, ring in rings.items())]:
        owner = model.casings.get(part.casing or "")
        name = address.partition(".")[2]
        if owner is not None and owner.box is not None and address.startswith("gears."):
            yield Problem(
                f"{address}.casing", shown(part.casing), "a casing from a mesh", "a box has seats of bearings only"
            )
        elif owner is not None and owner.matrices is None and owner.box is None and name not in owner.seats:
            hint = f"add it: casings.{part.casing}.seats.{name} = 'name of a face set'"
            yield Problem(f"{address}.casing", shown(part.casing), "a casing with a seat of this name", hint)
    for name, holder in model.bearings.items():
        if holder.casing is not None and holder.pedestal is not None:
            hint = "leave the pedestal out: the casing brings the flexibility of the seat"
            yield Problem(f"bearings.{name}", "casing and pedestal", "one of the two", hint)
    for name, element in model.nonlinear_elements.items():
        if element.casing is not None and element.to_shaft is not None:
            yield Problem(f"nonlinear_elements.{name}", "casing and to_shaft", "one of the two")


def _box(model: Tables, name: str, casing: Casing, box: Box) -> Iterator[Problem]:
    """A box is larger than its walls, and holds bearings on axes along z whose outer rings are known."""
    address = f"casings.{name}.box"
    for key in not_default(casing, _OF_FILES):
        yield Problem(
            f"casings.{name}.{key}", "beside a box", "leave it out", "it says something of a mesh from a file"
        )
    inside = [abs(b - a) for a, b in zip(*box.corners, strict=True)]
    ends = sorted(corner[2] for corner in box.corners)
    half = 0.5 * box.wall
    yield from told(
        address,
        ("corners", min(inside) <= 0.0, "", "two corners that differ in x, y and z", "the inner space has no volume"),
        (
            "wall",
            0.0 < min(inside) <= 2.0 * box.wall,
            shown(box.wall),
            f"less than half of the inner space, which measures {millimetres(min(inside))} there",
        ),
    )
    for number, z in enumerate(box.walls):
        if not ends[0] + half < z < ends[1] - half:
            what = f"a place between the ends, {millimetres(ends[0])} and {millimetres(ends[1])}"
            yield Problem(f"{address}.walls[{number}]", shown(z), what)
    for number, axis in enumerate("xyz"):
        low, high = sorted(corner[number] for corner in box.corners)
        for at, place in enumerate(getattr(box.ribs, axis) if box.ribs else ()):
            reach = 0.5 * box.ribs.thickness - box.wall if box.ribs else 0.0
            if not low + reach <= place <= high - reach:
                what = f"a place on the box, {millimetres(low + reach)} to {millimetres(high - reach)}"
                yield Problem(f"{address}.ribs.{axis}[{at}]", shown(place), what)
        if box.feet and axis != box.feet.side[1] and 2.0 * box.feet.size[number] > high - low + 2.0 * box.wall:
            what = f"at most half of the box, {millimetres(0.5 * (high - low) + box.wall)}"
            yield Problem(f"{address}.feet.size[{number}]", shown(box.feet.size[number]), what)
    parts = parts_in(model, name)
    for bearing in box.bores:
        if bearing not in parts:
            yield unknown(f"{address}.bores.{bearing}", bearing, list(parts), "a bearing in this casing")
    if not parts:
        yield Problem(address, "", "bearings that stand in it", f"say casing = '{name}' in each of them")
    for bearing, part in parts.items():
        table = "bearings" if bearing in model.bearings else "nonlinear_elements"
        shaft = model.shafts.get(part.shaft)
        if shaft is not None and shaft.frame.is_turned:
            hint = "a box has seats on axes along z; use a mesh"
            yield Problem(f"{table}.{bearing}.casing", f"on shaft '{part.shaft}', which is not along z", "ground", hint)
        elif bore_sizes(box, bearing, part) is None:
            what = "required where no designation tells the outer ring: { diameter = '80 mm', width = '18 mm' }"
            yield Problem(f"{address}.bores.{bearing}", "", "missing", what)


def _all_motions(model: Tables, beside: str, why: str) -> Iterator[Problem]:
    """A body from a mesh moves in all directions, and so must the model."""
    absent = [motion for motion in MOTIONS if not model.has(motion)]
    if absent:
        yield Problem("motions", f"without {' and '.join(absent)}", f"all three beside {beside}", why)


def _seat(address: str, seat: Seat) -> Iterator[Problem]:
    """A seat is a set, or a whole place."""
    given = [key for key in _PLACE if getattr(seat, key) is not None]
    if seat.set is not None and given:
        yield Problem(address, f"set and {', '.join(given)}", "one of the two ways to say where it is")
    elif seat.set is None:
        for key in _PLACE:
            if key not in given:
                yield Problem(f"{address}.{key}", "", "missing", f"a seat is a set, or all of {', '.join(_PLACE)}")
        if seat.begin is not None and seat.to is not None and seat.to <= seat.begin:
            yield Problem(f"{address}.to", shown(seat.to), f"more than from, {seat.begin:.6g} m")


def gear_bodies(model: Tables) -> Iterator[Problem]:
    """Gears with a mesh have its unit, bore and rim, and no sizes of a blank beside it."""
    meshed = [name for name, gear in model.gears.items() if gear.body.mesh is not None]
    if meshed:
        why = f"the body of gears.{meshed[0]} moves in all directions"
        yield from _all_motions(model, "a gear body from a mesh", why)
    for name, gear in model.gears.items():
        body = gear.body
        address = f"gears.{name}.body"
        if body.mesh is None:
            for key in not_default(body, _OF_MESHES):
                what = "it says something of the mesh"
                yield Problem(f"{address}.{key}", "without a mesh", "mesh beside it", what)
            continue
        if body.unit is None:
            yield missing(f"{address}.unit", _UNIT)
        for key, what in (("seat", "its bore on the shaft"), ("rim", "the face below the teeth")):
            face = getattr(body, key)
            if face is None:
                wanted = f"required beside mesh: {what}, such as a set of faces"
                yield Problem(f"{address}.{key}", "", "missing", wanted)
            else:
                yield from _seat(f"{address}.{key}", face)
        beside = ("beside a mesh", "a mesh or sizes of a blank", "the mesh has this shape already")
        cut = "teeth cut on the shaft have no bore; leave the mesh out"
        place = "an elastic body sits on its shaft at one place: say nodes = 1"
        yield from told(
            address,
            *((key, True, *beside) for key in not_default(body, BLANK)),
            ("mesh", gear.integral, "of a gear that is cut on its shaft", "integral = false", cut),
            ("mesh", gear.node_count == 2, "of a herringbone gear with two nodes", "one node", place),
        )


def counted_twice(address: str, mesh: MeshLayout) -> Iterator[Problem]:
    """What a gear gives between bore and rim stands in its mesh or in the loaded teeth, not in both."""
    for gear in mesh.gears if mesh.has_loaded_teeth else ():
        body = mesh.teeth.fe.body_of(gear.blank)
        if gear.part.body.mesh is not None and body != "rim":
            hint = f"the mesh of gears.{gear.name}.body has web and hub already, which would count twice"
            yield Problem(f"{address}.tooth_fe.body", f"'{body}' of a gear with a mesh", "'rim'", hint)
