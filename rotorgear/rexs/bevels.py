"""Bevel gears and their meshes: each stands on its cone, at the foot of its mean point on the axis.

The support vector of a bevel gear, and its u_coordinate_on_shaft, are that foot. From the point where both axes meet it is
R_m cos(delta) away (ISO 23509), so that teeth, module and spiral angle say it, too. A positive spiral angle is a right hand.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from rotorgear.gears.geometry.bevel import bevel_pair
from rotorgear.rexs.account import Account
from rotorgear.rexs.document import Component
from rotorgear.rexs.gears import add_no_mass, first_of
from rotorgear.rexs.shafts import ShaftPart
from rotorgear.rexs.structure import Pair, Structure
from rotorgear.rexs.toml_text import Table, quantity, text

_MODULES = (
    ("mean_normal_module", ("mean_normal_module", "normal_module")),
    ("outer_module", ("outer_transverse_module",)),
)
_SPIRAL = ("mean_spiral_angle", "spiral_angle")
# Pressure angles of the flank that drives, and of the other one.
_DRIVE = ("generated_pressure_angle_drive", "nominal_design_pressure_angle_drive", "normal_pressure_angle")
_COAST = ("generated_pressure_angle_coast", "nominal_design_pressure_angle_coast")
_SPUR = 1e-9
# Axes that pass each other at more than this share of the module do not meet, and a gear is off its cone by more than that.
_PASSING = 1e-3
_OFF = 0.05
# Density of steel in kg/m^3.
_STEEL = 7850.0


@dataclass(frozen=True)
class BevelPart:
    """A bevel gear of the model. Lengths in m, angles in rad; spiral > 0 is a right hand. `module` is that of the key `kind`."""

    component: Component
    name: str
    shaft: ShaftPart
    z: float
    teeth: int
    kind: str
    module: float
    spiral: float
    width: float
    pressure_angle: float
    comments: dict[str, str]


def read_bevel_gear(gear: Component, name: str, shafts: dict[str, ShaftPart], structure: Structure) -> BevelPart | None:
    """A bevel gear; None, and problems on the account, where it can't be made."""
    account = structure.account
    shaft = shafts.get(structure.shaft_of(gear))
    if shaft is None:
        account.missing(gear, "it must be on a shaft, by an assembly relation")
        return None
    data = structure.data_of(gear)
    teeth = account.number(gear, ("number_of_teeth",), "ratio")
    width = first_of(data, ("face_width",), "length", account)
    modules = ((key, first_of(data, names, "length", account)) for key, names in _MODULES)
    kind, module = next(((key, value) for key, value in modules if value), ("", 0.0))
    if teeth is None or teeth < 1 or teeth != round(teeth):
        account.missing(gear, "number_of_teeth is needed, a whole number of at least 1")
    if not module or module < 0.0:
        account.missing(gear, "mean_normal_module or outer_transverse_module is needed, above 0")
    if not width or width < 0.0:
        account.missing(gear, "face_width is needed, above 0")
    u = account.number(gear, ("u_coordinate_on_shaft",), "length")
    frame = structure.frame(gear)
    if frame is None and u is None:
        account.missing(gear, "its place is needed: support_vector or u_coordinate_on_shaft")
        return None
    z = shaft.axis.z(u or 0.0) if frame is None else float(shaft.axis.base.sees(frame.origin)[0])
    if not teeth or not module or not width or teeth < 1 or module < 0.0 or width < 0.0:
        return None
    spiral = first_of(data, _SPIRAL, "angle", account) or 0.0
    word = account.text(gear, "spiral_angle_pitch_direction").lower()
    if word in ("left", "right"):
        spiral = math.copysign(spiral, 1.0 if word == "right" else -1.0)
    return BevelPart(gear, name, shaft, z, round(teeth), kind, module, spiral, width, math.radians(20.0), {})


def matched_bevels(
    first: BevelPart, second: BevelPart, pair: Pair, account: Account
) -> tuple[BevelPart, BevelPart] | None:
    """Two bevel gears of opposite hands, each on its cone; None, and a problem on the account, where they can't mesh."""
    stage = pair.stage
    passed = account.number(stage, ("hypoid_offset",), "length") or 0.0
    met = _meeting(first.shaft, second.shaft)
    if met is None:
        account.missing(stage, "the axes of its two bevel gears must meet, and are parallel")
        return None
    *apex, apart = met
    if max(abs(passed), apart) > _PASSING * first.module:
        words = f"its axes pass each other at {1e3 * max(abs(passed), apart):.6g} mm, and hypoid pairs are not built"
        account.missing(stage, f"axes that meet are needed: {words}")
        return None
    if first.spiral * second.spiral > _SPUR:
        reason = f"both spiral angles of {stage} have one hand, and bevel gears have opposite ones"
        left = second.spiral > 0.0
        note = account.assume(f"gears.{second.name}.hand", "left" if left else "right", reason)
        second = replace(second, spiral=-second.spiral, comments={**second.comments, "hand": note})
    first, second = (_with_pressure_angle(part, stage, account) for part in (first, second))
    ways = [1 if part.z >= z else -1 for part, z in zip((first, second), apex, strict=True)]
    lines = [way * part.shaft.axis.base.axes[0] for way, part in zip(ways, (first, second), strict=True)]
    cones = bevel_pair(
        (first.teeth, second.teeth),
        math.acos(min(max(float(lines[0] @ lines[1]), -1.0), 1.0)),
        min(first.width, second.width),
        outer_module=first.module if first.kind == "outer_module" else None,
        mean_normal_module=first.module if first.kind == "mean_normal_module" else None,
        spiral_angle=abs(first.spiral),
        normal_pressure_angle=first.pressure_angle,
    )
    found = [
        _on_cone(part, z + way * distance, account)
        for part, z, way, distance in zip((first, second), apex, ways, cones.mean_distances, strict=True)
    ]
    return found[0], found[1]


def _meeting(first: ShaftPart, second: ShaftPart) -> tuple[float, float, float] | None:
    """z in m on both shafts of the points nearest to the other axis, and their distance; None of parallel axes."""
    bases = [part.axis.base for part in (first, second)]
    places = [
        base.origin + np.array([0.0, p.axis.x, p.axis.y]) @ base.axes
        for base, p in zip(bases, (first, second), strict=True)
    ]
    one, two = (base.axes[0] for base in bases)
    across = np.cross(one, two)
    if bases[0] is bases[1] or not np.any(across):
        return None
    between = places[1] - places[0]
    size = float(across @ across)
    z = [float(np.cross(between, line) @ across) / size for line in (two, one)]
    return z[0], z[1], abs(float(between @ across)) / math.sqrt(size)


def _with_pressure_angle(part: BevelPart, stage: Component, account: Account) -> BevelPart:
    """The gear with the normal pressure angle of its stage."""
    address = f"gears.{part.name}.normal_pressure_angle"
    drive = account.number(stage, _DRIVE, "angle")
    coast = account.number(stage, _COAST, "angle")
    if drive is None or not 0.0 < drive < math.radians(45.0):
        note = account.assume(address, "20 deg", f"{stage} gives no pressure angle: that of ISO 53")
        return replace(part, comments={**part.comments, "normal_pressure_angle": note})
    if coast is None or abs(coast - drive) < 1e-6:
        return replace(part, pressure_angle=drive)
    value = f"{math.degrees(drive):.6g} deg"
    note = account.assume(
        address, value, f"{stage} has other pressure angles on drive and coast side: that of the drive side"
    )
    return replace(part, pressure_angle=drive, comments={**part.comments, "normal_pressure_angle": note})


def _on_cone(part: BevelPart, z: float, account: Account) -> BevelPart:
    """The gear at the foot of its mean point; a place that misses it by up to the face width is mended, with a warning."""
    off = abs(part.z - z)
    if off <= _OFF * part.module:
        return part
    if off > part.width:
        told = f"its place must be the foot of its mean point on the axis, and is {1e3 * off:.6g} mm from it"
        account.missing(part.component, told)
        return part
    reason = f"the file says {1e3 * part.z:.6g} mm, and on its cone it stands at {1e3 * z:.6g} mm"
    account.warnings.append(f"gears.{part.name}.at: {reason}, which is written")
    note = account.assume(f"gears.{part.name}.at", f"{1e3 * z:.6g} mm", reason)
    return replace(part, z=z, comments={**part.comments, "at": note})


def bevel_table(part: BevelPart, structure: Structure, material: tuple[str, str]) -> Table:
    """The table of a bevel gear."""
    account = structure.account
    table = Table(f"gears.{part.name}", str(part.component))
    comments = {"hand": "a positive spiral angle is a right hand"} | part.comments
    values = {
        "shaft": text(part.shaft.name),
        "at": quantity(part.z, "length"),
        "kind": '"bevel"',
        "teeth": str(part.teeth),
        part.kind: quantity(part.module, "length"),
        "normal_pressure_angle": quantity(part.pressure_angle, "angle"),
    }
    if abs(part.spiral) > _SPUR:
        values["spiral_angle"] = quantity(abs(part.spiral), "angle")
        values["hand"] = '"right"' if part.spiral > 0.0 else '"left"'
    values["width"] = quantity(part.width, "length")
    for key, value in values.items():
        table.add(key, value, comments.get(key, ""))
    _add_mass(table, part, account)
    if material[0]:
        table.add("material", text(material[0]), material[1])
    return table


def _add_mass(table: Table, part: BevelPart, account: Account) -> None:
    """Mass and moments of inertia, which the format does not have: those of a disk."""
    bore = part.shaft.diameter(part.z)
    size = part.teeth * part.module / (math.cos(part.spiral) if part.kind == "mean_normal_module" else 1.0)
    if bore >= size:
        add_no_mass(
            table, "the section of the shaft there is as large as the mean pitch circle and has the mass", account
        )
        return
    mass = _STEEL * math.pi / 4.0 * (size**2 - bore**2) * part.width
    polar = mass * (size**2 + bore**2) / 8.0
    reason = f"REXS has none of bevel gears: a steel disk of its pitch circle, {1e3 * size:.6g} mm, as thick as its face is wide"
    note = account.assume(f"{table.header}.mass", f"{mass:.3g} kg", reason)
    for key, value, kind, comment in (
        ("mass", mass, "mass", note),
        ("polar_inertia", polar, "inertia", ""),
        ("diametral_inertia", polar / 2.0 + mass * part.width**2 / 12.0, "inertia", ""),
    ):
        table.add(key, quantity(float(f"{value:.6g}"), kind), comment)
