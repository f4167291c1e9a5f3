"""Checks of gears and disks by themselves: what each kind needs, and bodies that can be."""

from __future__ import annotations

import math
from collections.abc import Iterator

from rotorgear.errors import Problem, RotorgearError
from rotorgear.gears.geometry.geometry import impossible_teeth
from rotorgear.model.checks.teeth import tooth_problems
from rotorgear.model.layout.bodies import inertia_is_given
from rotorgear.model.layout.layout import Layout
from rotorgear.model.parts.bodies import Disk
from rotorgear.model.parts.gear import Gear, GearBody
from rotorgear.model.parts.tables import Tables
from rotorgear.quantity import millimetres

# Relative: inertias that are written with six digits, each rounded by up to 5e-6.
_SIX_DIGITS = 1e-5
# deg
_LARGEST_PRESSURE_ANGLE = 45.0
_LARGEST_HELIX_ANGLE = 60.0
_OF_TEETH = (
    "normal_module",
    "normal_pressure_angle",
    "helix_angle",
    "profile_shift",
    "addendum_factor",
    "dedendum_factor",
    "tip_diameter",
)


def missing(address: str, why: str) -> Problem:
    """Return the problem of a key that is needed."""
    return Problem(address, "", "missing", f"required: {why}")


def degrees(angle: float) -> str:
    """Write an angle in rad as an engineer reads it."""
    return f"{math.degrees(angle):.9g} deg"


def pressure_angle_problems(address: str, angle: float | None) -> Iterator[Problem]:
    """A pressure angle, normal or transverse, lies between 0 and 45 deg."""
    if angle is not None and not 0.0 < angle < math.radians(_LARGEST_PRESSURE_ANGLE):
        yield Problem(address, degrees(angle), f"an angle between 0 and {_LARGEST_PRESSURE_ANGLE:g} deg")


def gear_problems(model: Tables) -> Iterator[Problem]:
    """Yield what is missing or impossible in the teeth of each gear by itself."""
    for name, gear in model.gears.items():
        yield from _lumped_gear(f"gears.{name}", gear) if gear.lumped else _toothed_gear(f"gears.{name}", gear)


def _toothed_gear(address: str, gear: Gear) -> Iterator[Problem]:
    if gear.teeth is None and gear.normal_module is None:
        ways = "teeth, normal_module and width, or base_radius with mass and moments of inertia"
        yield Problem(address, "neither teeth nor a base radius", ways)
        return
    found = [
        missing(f"{address}.{key}", Gear.model_fields[key].description or "a value")
        for key in ("teeth", "normal_module", "width")
        if getattr(gear, key) is None
    ]
    found += [
        _unwanted(f"{address}.{key}", degrees(angle), "it follows from the teeth")
        for key in ("base_helix_angle", "transverse_pressure_angle")
        if (angle := getattr(gear, key)) is not None
    ]
    found += _helix(address, gear, "helix_angle")
    found += pressure_angle_problems(f"{address}.normal_pressure_angle", gear.normal_pressure_angle)
    yield from found
    geometry = None if found else gear.geometry
    if geometry and (wrong := list(impossible_teeth(geometry))):
        yield from (Problem(address, "", text) for text in wrong)
    elif geometry:
        yield from tooth_problems(address, gear, geometry)


def _lumped_gear(address: str, gear: Gear) -> Iterator[Problem]:
    for key in _OF_TEETH:
        if getattr(gear, key) != Gear.model_fields[key].default:
            yield _unwanted(f"{address}.{key}", "a value", "a gear has teeth with a module or a base_radius, not both")
    yield from _helix(address, gear, "base_helix_angle")
    yield from pressure_angle_problems(f"{address}.transverse_pressure_angle", gear.transverse_pressure_angle)
    if gear.kind == "herringbone" and gear.width is None:
        yield missing(f"{address}.width", "width of one helix, which with the gap places the two helices")
    if not inertia_is_given(gear) and gear.body.mesh is None:
        yield missing(f"{address}.mass", "mass and moments of inertia of a gear that is given by its base radius")


def _unwanted(address: str, value: str, why: str) -> Problem:
    return Problem(address, value, "nothing here", why)


def _helix(address: str, gear: Gear, key: str) -> Iterator[Problem]:
    angle = getattr(gear, key)
    if gear.kind == "spur":
        if angle:
            yield _unwanted(f"{address}.{key}", degrees(angle), "a spur gear has no helix; kind = 'helical' has")
        if gear.hand:
            yield _unwanted(f"{address}.hand", f"'{gear.hand}'", "a spur gear has no hand; kind = 'helical' has")
    else:
        if angle is None:
            yield missing(f"{address}.{key}", f"an angle such as '20 deg' for a {gear.kind} gear")
        elif not 0.0 < angle < math.radians(_LARGEST_HELIX_ANGLE):
            limits = f"an angle between 0 and {_LARGEST_HELIX_ANGLE:g} deg"
            yield Problem(
                f"{address}.{key}", degrees(angle), limits, "hand = 'left' or 'right' says which way it winds"
            )
        if gear.hand is None:
            yield missing(f"{address}.hand", "'right' or 'left'")
    if gear.kind != "herringbone":
        if gear.gap:
            yield _unwanted(
                f"{address}.gap", millimetres(gear.gap), "only a herringbone gear has a gap between two helices"
            )
        if gear.nodes == 2:
            yield _unwanted(f"{address}.nodes", "2", "only a herringbone gear has two nodes")


def inertia_problems(layout: Layout) -> Iterator[Problem]:
    """Yield what is missing or impossible in the mass and inertias of gears and disks on their shafts."""
    for name, gear in layout.model.gears.items():
        yield from _body(layout, f"gears.{name}", name, gear)
    for name, disk in layout.model.disks.items():
        yield from _body(layout, f"disks.{name}", name, disk)


def _body(layout: Layout, address: str, name: str, part: Gear | Disk) -> Iterator[Problem]:
    """Mass and inertias: all that the motions of the model need, or the sizes to compute them from."""
    model = layout.model
    if isinstance(part, Gear) and part.body.mesh is not None:
        return  # its mesh has them; reading it waits for an analysis
    found: list[Problem] = []
    if inertia_is_given(part):
        found += _given_inertia(model, address, part)
    elif isinstance(part, Disk):  # the sizes of a gear are those of its teeth, which are checked with them
        for key in ("outer_diameter", "width"):
            if getattr(part, key) is None:
                found.append(missing(f"{address}.{key}", "outer_diameter and width, or mass and moments of inertia"))
    yield from found
    if found:
        return
    try:
        body = layout.disk_body(name) if isinstance(part, Disk) else layout.gear(name).body
    except (ValueError, RotorgearError) as error:
        own_bore = part.bore if isinstance(part, Disk) else part.body.bore
        bored = own_bore is None and "bore" in str(error)
        hint = "where no bore is given it is the shaft's diameter there" if bored else ""
        yield Problem(address, "", str(error), hint)
        return
    if not model.has("bending"):
        return
    if body.polar_inertia > 2.0 * body.diametral_inertia * (1.0 + _SIX_DIGITS) and body.diametral_inertia > 0.0:
        limit = f"at most twice the diametral one, {2 * body.diametral_inertia:.6g} kg m^2"
        hint = "a flat disk has that, no body has more"
        yield Problem(f"{address}.polar_inertia", f"{body.polar_inertia:.6g} kg m^2", limit, hint)
    elif isinstance(part, Gear) and part.node_count == 2:
        least = body.mass * part.helix_offset**2
        if body.diametral_inertia - least < -1e-9 * body.diametral_inertia:
            limit = f"at least mass x ((gap + width)/2)^2 = {least:.6g} kg m^2"
            hint = "it is that of the whole gear about its middle; or nodes = 1"
            yield Problem(f"{address}.diametral_inertia", f"{body.diametral_inertia:.6g} kg m^2", limit, hint)


def _given_inertia(model: Tables, address: str, part: Gear | Disk) -> Iterator[Problem]:
    needed = {"mass": ("bending", "axial"), "polar_inertia": ("torsion", "bending"), "diametral_inertia": ("bending",)}
    for key, motions in needed.items():
        if getattr(part, key) is None and any(model.has(motion) for motion in motions):
            yield missing(f"{address}.{key}", "a value beside the other inertias, 0 if it has none")
    if isinstance(part, Disk):
        for key in ("outer_diameter", "width", "bore"):
            if (size := getattr(part, key)) is not None:
                yield _unwanted(f"{address}.{key}", millimetres(size), "a disk has sizes or given inertias, not both")
    elif part.body != GearBody():
        yield _unwanted(f"{address}.body", "a table", "a gear has a body or given inertias, not both")
