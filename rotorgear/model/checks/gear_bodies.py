"""Checks of gear bodies from meshes before these are read: what a mesh needs, and what it would count twice."""

from __future__ import annotations

from collections.abc import Iterator

from rotorgear.errors import Problem
from rotorgear.model.checks.casings import seat_problems
from rotorgear.model.layout.mesh_layout import MeshLayout
from rotorgear.model.parts.fields import MOTIONS
from rotorgear.model.parts.gear import Gear, GearBody
from rotorgear.model.parts.tables import Tables

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
    if mesh.part.stiffness != "tooth_fe" or not mesh.has_teeth:
        return
    for gear in mesh.gears:
        body = mesh.teeth.fe.body_of(gear.blank)
        if gear.part.body.mesh is not None and body != "rim":
            hint = f"the mesh of gears.{gear.name}.body has web and hub already, which would count twice"
            yield Problem(f"{address}.tooth_fe.body", f"'{body}' of a gear with a mesh", "'rim'", hint)
