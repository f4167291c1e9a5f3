"""Checks of casings and gear bodies before their meshes are read: what they need, and what would count twice."""

from __future__ import annotations

from collections.abc import Iterator

from rotorgear.errors import Problem
from rotorgear.model.checks.names import PartName, unknown
from rotorgear.model.checks.sizes import six_by_six
from rotorgear.model.layout.mesh_layout import MeshLayout
from rotorgear.model.parts.casing import Casing, Seat
from rotorgear.model.parts.fields import MOTIONS
from rotorgear.model.parts.gear import Gear, GearBody
from rotorgear.model.parts.problems import shown
from rotorgear.model.parts.tables import Tables

# Keys that say something of a body which was reduced elsewhere; all others are of meshes.
_OF_MATRICES = ("matrices", "interface", "seats", "damping_ratio")
_OWN = ("youngs_modulus", "poisson_ratio", "density")
_PLACE = ("axis", "center", "from", "to", "radius")


def casings(model: Tables, broken: set[PartName]) -> Iterator[Problem]:
    """Casings have mesh, unit and material; their seats are those of bearings."""
    tables = ("bearings", "nonlinear_elements")
    seated = [*model.bearings, *model.nonlinear_elements, *(name for table, name in broken if table in tables)]
    absent = [motion for motion in MOTIONS if not model.has(motion)]
    if model.casings and absent:
        hint = "seats move in all directions"
        yield Problem("motions", f"without {' and '.join(absent)}", "all three beside a casing", hint)
    for name, casing in model.casings.items():
        address = f"casings.{name}"
        if casing.matrices is not None:
            yield from _matrices(address, casing)
            continue
        if casing.interface:
            hint = "the seats of a mesh stand under seats"
            yield Problem(f"{address}.interface", "without matrices", "matrices beside it", hint)
        yield from _source(address, casing)
        yield from _material(address, casing)
        for set_name, mount in casing.mounts.items():
            yield from six_by_six(f"{address}.mounts.{set_name}", mount, None)
            yield from six_by_six(f"{address}.mounts.{set_name}", None, mount.damping)
        if not casing.seats:
            yield Problem(
                f"{address}.seats", "", "missing", "where bearings sit: seats = { left = 'name of a face set' }"
            )
        for bearing, seat in casing.seats.items():
            if bearing not in seated and not {(table, "") for table in tables} & broken:
                yield unknown(f"{address}.seats.{bearing}", bearing, seated, "a bearing")
            yield from seat_problems(f"{address}.seats.{bearing}", seat)
    yield from _seated(model)


def _source(address: str, casing: Casing) -> Iterator[Problem]:
    if not casing.mesh:
        yield Problem(f"{address}.mesh", "", "missing", "required: the file of the mesh, such as 'box.msh'")
    elif casing.unit is None:
        hint = "required: files of meshes carry no unit of length; say unit = 'mm' or 'm'"
        yield Problem(f"{address}.unit", "", "missing", hint)


def _material(address: str, casing: Casing) -> Iterator[Problem]:
    given = [key for key in _OWN if getattr(casing, key) is not None]
    if casing.material is not None and given:
        yield Problem(address, f"material and {', '.join(given)}", "one of the two ways to say what the casing is of")
    elif casing.material is None and not given and casing.mesh:
        yield Problem(f"{address}.material", "", "missing", f"required, or {', '.join(_OWN)}")
    elif given:
        for key in _OWN:
            if key not in given:
                yield Problem(f"{address}.{key}", "", "missing", f"required beside {', '.join(given)}")
        if casing.poisson_ratio is not None and casing.poisson_ratio >= 0.5:
            yield Problem(f"{address}.poisson_ratio", f"{casing.poisson_ratio:.4g}", "one from 0 to below 0.5")


def seat_problems(address: str, seat: Seat) -> Iterator[Problem]:
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


def _matrices(address: str, casing: Casing) -> Iterator[Problem]:
    """A body that was reduced elsewhere has its material, supports and modes already."""
    fields = type(casing).model_fields
    given = [
        key for key, field in fields.items() if getattr(casing, key) != field.get_default(call_default_factory=True)
    ]
    for key in given:
        if key not in _OF_MATRICES:
            yield Problem(
                f"{address}.{key}", "beside matrices", f"{key} beside a mesh only", "the matrices have it already"
            )
    for bearing, seat in casing.seats.items():
        if seat.set is None:
            yield Problem(f"{address}.seats.{bearing}", "a place", "the name of a seat in the file of matrices")


def _seated(model: Tables) -> Iterator[Problem]:
    """What stands in a casing has a seat there, and stands on nothing else."""
    for table in ("bearings", "nonlinear_elements"):
        for name, part in getattr(model, table).items():
            casing = model.casings.get(part.casing or "")
            if casing is not None and casing.matrices is None and name not in casing.seats:
                hint = f"add it: casings.{part.casing}.seats.{name} = 'name of a face set'"
                yield Problem(f"{table}.{name}.casing", shown(part.casing), "a casing with a seat of this name", hint)
    for name, bearing in model.bearings.items():
        if bearing.casing is not None and bearing.pedestal is not None:
            hint = "leave the pedestal out: the casing brings the flexibility of the seat"
            yield Problem(f"bearings.{name}", "casing and pedestal", "one of the two", hint)
    for name, element in model.nonlinear_elements.items():
        if element.casing is not None and element.to_shaft is not None:
            yield Problem(f"nonlinear_elements.{name}", "casing and to_shaft", "one of the two")


_OF_MESHES = ("unit", "material", "seat", "rim", "connection", "modes_to", "damping_ratio", "mass_tolerance")

_OF_SIZES = ("rim_thickness", "web_thickness", "web_position", "hub_diameter", "hub_width")


def gear_bodies(model: Tables) -> Iterator[Problem]:
    """Gears with a mesh have its unit, bore and rim, and no sizes of a blank beside it."""
    absent = [motion for motion in MOTIONS if not model.has(motion)]
    meshed = [name for name, gear in model.gears.items() if gear.body.mesh is not None]
    if meshed and absent:
        hint = f"the body of gears.{meshed[0]} moves in all directions"
        yield Problem("motions", f"without {' and '.join(absent)}", "all three beside a gear body from a mesh", hint)
    for name, gear in model.gears.items():
        address = f"gears.{name}.body"
        if gear.body.mesh is None:
            for key in _given(gear, _OF_MESHES):
                yield Problem(f"{address}.{key}", "without a mesh", "mesh beside it", "it says something of the mesh")
            continue
        yield from _mesh(address, gear)


def _given(gear: Gear, keys: tuple[str, ...]) -> list[str]:
    fields = GearBody.model_fields
    return [key for key in keys if getattr(gear.body, key) != fields[key].get_default(call_default_factory=True)]


def _mesh(address: str, gear: Gear) -> Iterator[Problem]:
    body = gear.body
    if body.unit is None:
        hint = "required: files of meshes carry no unit of length; say unit = 'mm' or 'm'"
        yield Problem(f"{address}.unit", "", "missing", hint)
    for key, what in (("seat", "its bore on the shaft"), ("rim", "the face below the teeth")):
        place = getattr(body, key)
        if place is None:
            yield Problem(f"{address}.{key}", "", "missing", f"required beside mesh: {what}, such as a set of faces")
        else:
            yield from seat_problems(f"{address}.{key}", place)
    for key in _given(gear, _OF_SIZES):
        yield Problem(
            f"{address}.{key}", "beside a mesh", "a mesh or sizes of a blank", "the mesh has this shape already"
        )
    if gear.integral:
        hint = "teeth cut on the shaft have no bore; leave the mesh out"
        yield Problem(f"{address}.mesh", "of a gear that is cut on its shaft", "integral = false", hint)
    if gear.node_count == 2:
        hint = "an elastic body sits on its shaft at one place: say nodes = 1"
        yield Problem(f"{address}.mesh", "of a herringbone gear with two nodes", "one node", hint)


def counted_twice(address: str, mesh: MeshLayout) -> Iterator[Problem]:
    """What a gear gives between bore and rim stands in its mesh or in the loaded teeth, not in both."""
    if not mesh.has_loaded_teeth:
        return
    for gear in mesh.gears:
        body = mesh.teeth.fe.body_of(gear.blank)
        if gear.part.body.mesh is not None and body != "rim":
            hint = f"the mesh of gears.{gear.name}.body has web and hub already, which would count twice"
            yield Problem(f"{address}.tooth_fe.body", f"'{body}' of a gear with a mesh", "'rim'", hint)
