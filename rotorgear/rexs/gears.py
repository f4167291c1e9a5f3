"""Cylindrical gears and their meshes, external and internal: teeth, profile shifts that fit the axes, tips and roots.

Teeth and diameters of a ring are positive in a model file, and negative in some REXS files; its profile shift has the sign of
ISO 21771 in both, where a positive one makes teeth thicker and moves their tips inwards.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from rotorgear.gears.geometry.geometry import involute
from rotorgear.rexs.account import Account
from rotorgear.rexs.document import Component
from rotorgear.rexs.shafts import CENTRE_DISTANCE, ShaftPart
from rotorgear.rexs.structure import BEVEL_STAGE, Pair, Structure, is_internal
from rotorgear.rexs.toml_text import Table, number, quantity, row, text

# Attribute names over the versions.
_SHIFT = ("profile_shift_coefficient", "addendum_modification_coefficient")
_SHIFT_LENGTH = ("addendum_modification", "profile_shift")
_HELIX = ("helix_angle_reference_diameter", "helix_angle_at_reference_diameter", "helix_angle")
# Heights over the module that a tooth can have; 1 and 1.25 are ISO 53's. Placeholders lie far outside.
_ADDENDUM = (0.3, 2.5)
_DEDENDUM = (0.6, 2.5)
# The model file allows this difference, over the module, between the shafts' distance and that of teeth and shifts; a larger one
# is corrected in a shift.
_FIT = 0.045
# The largest correction of a profile shift; a larger difference is no rounding, but belongs to another gear.
_MENDED = 0.3
# Thickness over the module of the rim of a ring of which the file says nothing.
_RIM = 3.0
# Below this an angle is zero.
_SPUR = 1e-9


@dataclass(frozen=True)
class GearPart:
    """A gear of the model. Lengths in m, angles in rad; helix_angle > 0 is a right hand. `shift` None: not given.

    `sign` is -1 of a ring, whose number of teeth is positive here.
    """

    component: Component
    name: str
    shaft: ShaftPart
    z: float
    teeth: int
    module: float
    pressure_angle: float
    helix_angle: float
    width: float
    shift: float | None
    comments: dict[str, str]
    sign: int = 1

    @property
    def reference_diameter(self) -> float:
        """d = z m_t with the transverse module m_t = m_n / cos(beta)."""
        return self.teeth * (self.module / math.cos(self.helix_angle))


def read_gear(
    gear: Component,
    name: str,
    shafts: dict[str, ShaftPart],
    structure: Structure,
    version: tuple[int, int],
) -> GearPart | None:
    """A gear with its data wherever the version keeps them; None, and problems on the account, where it can't be made."""
    account = structure.account
    shaft = shafts.get(structure.shaft_of(gear))
    if shaft is None:
        account.missing(gear, "it must be on a shaft or in the casing, by an assembly relation")
        return None
    data = structure.data_of(gear)
    comments: dict[str, str] = {}
    teeth = account.number(gear, ("number_of_teeth",), "ratio")
    sign = -1 if is_internal(gear) else 1
    if teeth is not None and sign < 0:
        teeth = abs(teeth)
    module = first_of(data, ("normal_module",), "length", account)
    width = first_of(data, ("face_width",), "length", account)
    beta = first_of(data, _HELIX, "angle", account)
    alpha = first_of(data, ("normal_pressure_angle",), "angle", account)
    if module is None:
        transverse = first_of(data, ("transverse_module",), "length", account)
        module = None if transverse is None else transverse * math.cos(beta or 0.0)
    if teeth is None or teeth < 1 or teeth != round(teeth):
        account.missing(gear, "number_of_teeth is needed, a whole number of at least 1")
    if not module or module < 0.0:
        account.missing(gear, "normal_module is needed, above 0")
    if not width or width < 0.0:
        account.missing(gear, "face_width is needed, above 0")
    if not teeth or not module or not width or teeth < 1 or module < 0.0 or width < 0.0:
        return None
    if beta is None:
        beta = 0.0
        comments["kind"] = account.assume(f"gears.{name}.kind", "spur", "the file gives no helix angle")
    if alpha is None or not 0.0 < alpha < math.radians(45.0):
        alpha = math.radians(20.0)
        reason = "the file gives no normal pressure angle: that of ISO 53"
        comments["normal_pressure_angle"] = account.assume(f"gears.{name}.normal_pressure_angle", "20 deg", reason)
    shift = first_of(data, _SHIFT, "ratio", account)
    if shift is None:
        length = first_of(data, _SHIFT_LENGTH, "length", account)
        shift = None if length is None else length / module
    # A gear has one pressure angle and one shift here; where its flanks differ, the first of them counts.
    flanks = [component for component in data if "flank" in component.type]
    for names, kind, key in (
        (("normal_pressure_angle",), "angle", "normal_pressure_angle"),
        (_SHIFT, "ratio", "profile_shift"),
    ):
        values = [value for flank in flanks if (value := account.number(flank, names, kind)) is not None]
        if values and max(values) - min(values) > 1e-6:
            reason = f"left and right flank of {gear} differ: that of the first is taken"
            comments[key] = account.assume(f"{gear.name}.{key}", f"{values[0]:.6g}", reason)
    z = _middle(gear, shaft, width, structure, version, comments)
    if z is None:
        return None
    return GearPart(gear, name, shaft, z, round(teeth), module, alpha, beta, width, shift, comments, sign)


def first_of(data: list[Component], names: tuple[str, ...], kind: str, account: Account) -> float | None:
    """The first value in SI that one of some components has of some attributes."""
    found = (account.number(component, names, kind) for component in data)
    return next((value for value in found if value is not None), None)


def _middle(
    gear: Component,
    shaft: ShaftPart,
    width: float,
    structure: Structure,
    version: tuple[int, int],
    comments: dict[str, str],
) -> float | None:
    """z of the middle of the face.

    The support vector of a gear is its middle in all versions. u_coordinate_on_shaft is the begin of the face in version 1.0
    and its middle from 1.1 on, so the vector counts where there is one.
    """
    account = structure.account
    u = account.number(gear, ("u_coordinate_on_shaft",), "length")
    # z by u as begin and as middle of the face.
    by_u = [] if u is None else [shaft.axis.z(u + width / 2.0), shaft.axis.z(u)]
    z = (by_u[0] if version <= (1, 0) else by_u[1]) if by_u else None
    frame = structure.frame(gear)
    if frame is not None:
        along, x, y = shaft.axis.base.sees(frame.origin).tolist()
        if math.hypot(x - shaft.axis.x, y - shaft.axis.y) < 1e-4 * max(1.0, width) + 1e-5:
            if z is not None and min(abs(along - one) for one in by_u) > 1e-5:
                reason = f"u_coordinate_on_shaft would give {1e3 * z:.6g} mm: the support vector counts"
                comments["at"] = account.assume(f"{gear.name}.at", f"{1e3 * along:.6g} mm", reason)
            z = along
    if z is None:
        account.missing(gear, "its place is needed: support_vector or u_coordinate_on_shaft")
        return None
    return shaft.place(gear, z, account)


def shift_sum(first: GearPart, second: GearPart, distance: float) -> float | None:
    """x_1 + x_2 that brings two gears to a centre distance without backlash, ISO 21771; None where no such gears exist.

    cos(alpha_wt) = a cos(alpha_t) / a_w with a the reference centre distance, and
    x_1 + x_2 = (z_1 + z_2) (inv(alpha_wt) - inv(alpha_t)) / (2 tan(alpha_n)), with z_2, a and a_w < 0 where the second is a ring.
    """
    transverse = math.atan(math.tan(first.pressure_angle) / math.cos(first.helix_angle))
    reference = (first.reference_diameter + second.sign * second.reference_diameter) / 2.0
    cosine = second.sign * reference * math.cos(transverse) / distance
    if not 0.0 < cosine < 1.0:
        return None
    working = math.acos(cosine)
    teeth = first.teeth + second.sign * second.teeth
    return teeth * (involute(working) - involute(transverse)) / (2.0 * math.tan(first.pressure_angle))


def matched(first: GearPart, second: GearPart, pair: Pair, account: Account) -> tuple[GearPart, GearPart] | None:
    """Two gears of a stage with hands and shifts that fit, a ring as the second of them; None where they can't mesh."""
    stage = pair.stage
    if first.sign < 0:
        first, second = second, first
    if first.sign < 0:
        account.missing(stage, "its two gears are rings with teeth inside, and one of them must be an external gear")
        return None
    if abs(first.module - second.module) > 1e-9 or abs(abs(first.helix_angle) - abs(second.helix_angle)) > 1e-6:
        account.missing(stage, "its two gears must have one normal module and one helix angle, and have not")
        return None
    if abs(first.pressure_angle - second.pressure_angle) > 1e-6:
        account.missing(stage, "its two gears must have one normal pressure angle, and have not")
        return None
    if first.shaft.axis.base is not second.shaft.axis.base:
        account.missing(stage, "the axes of its two cylindrical gears must be parallel, and are not")
        return None
    if first.helix_angle * second.helix_angle * second.sign > _SPUR:
        signs = "both helix angles of {} have one sign, and external gears have opposite hands"
        if second.sign < 0:
            signs = "the helix angles of {} have opposite signs, and a ring has the hand of its pinion"
        left = second.helix_angle > 0.0
        note = account.assume(f"gears.{second.name}.hand", "left" if left else "right", signs.format(stage))
        second = replace(second, helix_angle=-second.helix_angle, comments={**second.comments, "hand": note})
    distance = first.shaft.axis.distance(second.shaft.axis)
    stated = account.number(stage, CENTRE_DISTANCE, "length")
    if stated is not None and second.sign < 0:
        stated = abs(stated)
    if stated is not None and abs(stated - distance) > 1e-5:
        account.warnings.append(
            f"{stage} states a centre distance of {1e3 * stated:.6g} mm; its shafts are {1e3 * distance:.6g} mm apart, "
            "which counts"
        )
    needed = shift_sum(first, second, distance) if distance > 0.0 else None
    if needed is None or abs(needed) > 3.0:
        account.missing(stage, f"its shafts are {1e3 * distance:.6g} mm apart, where gears of this size can't mesh")
        return None
    return _with_shifts(first, second, needed, stage, account)


def _with_shifts(
    first: GearPart, second: GearPart, needed: float, stage: Component, account: Account
) -> tuple[GearPart, GearPart] | None:
    """The gears with profile shifts that add up to what their axes need; None where the given ones are far from it."""

    # The profile shifts that are given, or what the centre distance leaves for those that are not.
    def given(part: GearPart, shift: float, reason: str) -> GearPart:
        note = account.assume(f"gears.{part.name}.profile_shift", f"{shift:.6g}", reason)
        return replace(part, shift=shift, comments={**part.comments, "profile_shift": note})

    rest = f"the file gives none: what the axes of {stage} need"
    if first.shift is None and second.shift is None:
        reason = f"the file gives none: half of what the axes of {stage} need"
        return given(first, needed / 2.0, reason), given(second, needed / 2.0, reason)
    if first.shift is None:
        return given(first, needed - (second.shift or 0.0), rest), second
    if second.shift is None:
        return first, given(second, needed - first.shift, rest)
    off = needed - first.shift - second.shift
    if second.sign < 0 and abs(off) > _FIT >= abs(off + 2.0 * second.shift):
        # Some programs count the shift of a ring outwards.
        reason = f"the file says {second.shift:.6g}, which fits the axes of {stage} as {-second.shift:.6g} (ISO 21771)"
        account.warnings.append(f"gears.{second.name}.profile_shift: {reason}")
        return first, given(second, -second.shift, reason)
    # da_w is about m_n dx: near the reference distance a shift moves the axes by itself.
    if abs(off) <= _FIT:
        return first, second
    total = first.shift + second.shift
    if abs(off) > _MENDED:
        shifts = f"profile shifts {first.shift:.6g} and {second.shift:.6g} sum to {total:.4g}"
        account.missing(stage, f"{shifts}, its axes need {needed:.4g}")
        return None
    reason = f"the file says {second.shift:.6g}; with that the gears of {stage} do not fit their axes"
    mended = second.shift + off
    account.warnings.append(f"gears.{second.name}.profile_shift: {reason}; {mended:.6g} is written")
    return first, given(second, mended, reason)


def gear_table(part: GearPart, structure: Structure, material: tuple[str, str]) -> Table:
    """The table of a gear."""
    account = structure.account
    table = Table(f"gears.{part.name}", str(part.component))
    helical = abs(part.helix_angle) > _SPUR
    comments = {"hand": "a positive helix angle is a right hand, ISO 21771"} | part.comments
    values = {
        "shaft": text(part.shaft.name),
        "at": quantity(part.z, "length"),
        "kind": '"helical"' if helical else '"spur"',
        "teeth": str(part.teeth),
        **({"internal": "true"} if part.sign < 0 else {}),
        "normal_module": quantity(part.module, "length"),
        "normal_pressure_angle": quantity(part.pressure_angle, "angle"),
    }
    if helical:
        values["helix_angle"] = quantity(abs(part.helix_angle), "angle")
        values["hand"] = '"right"' if part.helix_angle > 0.0 else '"left"'
    values["width"] = quantity(part.width, "length")
    if part.shift is None:
        reason = "the file gives none, and no stage asks for one"
        comments["profile_shift"] = account.assume(f"{table.header}.profile_shift", "0", reason)
    values["profile_shift"] = number(part.shift or 0.0)
    for key, value in values.items():
        table.add(key, value, comments.get(key, ""))
    root = _add_heights(table, part, structure.data_of(part.component), account)
    if part.sign < 0:
        _add_rim(table, part, root, account)
    elif part.shaft.diameter(part.z) >= part.reference_diameter:
        # A pinion whose shaft is drawn with the diameter of its teeth: its mass is that of the section.
        add_no_mass(
            table, "the section of the shaft there is as large as the reference circle and has the mass", account
        )
    if material[0]:
        table.add("material", text(material[0]), material[1])
    return table


def add_no_mass(table: Table, reason: str, account: Account) -> None:
    """A gear without a mass of its own."""
    comment = account.assume(f"{table.header}.mass", "0 kg", reason)
    for key, kind in (("mass", "mass"), ("polar_inertia", "inertia"), ("diametral_inertia", "inertia")):
        table.add(key, quantity(0.0, kind), comment)


def _add_rim(table: Table, part: GearPart, root: float, account: Account) -> None:
    """What is around the roots (diameter in m) of a ring: up to its shaft's bore, or the section of the shaft itself."""
    bore = part.shaft.bore(part.z)
    outer = part.shaft.diameter(part.z)
    if bore <= root < outer:
        add_no_mass(table, "the section of the shaft there is around the teeth and has the mass", account)
        return
    rim, note = bore, "its rim reaches to the bore of its shaft"
    if bore <= root:
        rim = root + 2.0 * _RIM * part.module
        reason = f"no section of {part.shaft.component} is around its teeth: a rim of {_RIM:g} modules"
        note = account.assume(f"{table.header}.body.outer_diameter", f"{1e3 * rim:.6g} mm", reason)
    table.add("body", row(outer_diameter=quantity(rim, "length")), note)


def _add_heights(table: Table, part: GearPart, data: list[Component], account: Account) -> float:
    """Tip and root: diameters of the gear where they are plausible, else its tool's heights, else ISO 53 by default.

    Returns:
        The root diameter in m.
    """
    tip = first_of(data, ("tip_diameter",), "length", account)
    d = part.reference_diameter
    shift = part.shift or 0.0
    # Diameters of rings are negative in some files.
    addendum = math.nan if tip is None else part.sign * ((abs(tip) - d) / 2.0) / part.module - shift
    if tip is None:
        reason = "the file gives no tip diameter: addendum of one module, ISO 53"
        table.add("addendum_factor", "1", account.assume(f"{table.header}.addendum_factor", "1", reason))
    elif any(_ADDENDUM[0] <= height <= _ADDENDUM[1] for height in (addendum, addendum + shift)):
        table.add("tip_diameter", quantity(abs(tip), "length"))
    else:
        reason = f"the file says {1e3 * tip:.6g} mm, which no tooth of this gear has: by ISO 53"
        value = f"{1e3 * (d + part.sign * 2.0 * part.module * (1.0 + shift)):.6g} mm"
        table.add("addendum_factor", "1", account.assume(f"{table.header}.tip_diameter", value, reason))
    root = first_of(data, ("root_diameter", "root_circle_diameter"), "length", account)
    dedendum = None if root is None else part.sign * (d - abs(root)) / (2.0 * part.module) + shift
    comment = "from the root diameter of the file"
    if dedendum is None or not _DEDENDUM[0] <= dedendum <= _DEDENDUM[1]:
        dedendum = None
        for tool in data:
            if tool.type.endswith("tool"):
                # What the tool's tip cuts is the gear's dedendum.
                found = account.number(tool, ("addendum_coefficient_reference_profile",), "ratio")
                if found is not None and _DEDENDUM[0] <= found <= _DEDENDUM[1]:
                    dedendum = found
                    comment = f"addendum of {tool}"
    if dedendum is None:
        dedendum = 1.25
        reason = "the file gives no root diameter and no tool: dedendum of 1.25 modules, ISO 53"
        comment = account.assume(f"{table.header}.dedendum_factor", "1.25", reason)
    table.add("dedendum_factor", number(dedendum), comment)
    return d - part.sign * 2.0 * part.module * (dedendum - shift)


def mesh_table(stage: Component, name: str, teeth: dict[str, int], account: Account) -> Table:
    """The table of a mesh of two gears with their numbers of teeth; that with fewer is its pinion."""
    table = Table(f"meshes.{name}", str(stage))
    pinion, wheel = sorted(teeth, key=lambda gear: teeth[gear])
    table.add("pinion", text(pinion))
    table.add("gear", text(wheel))
    formula = (
        "the estimate of ISO 10300-1" if stage.type == BEVEL_STAGE else "c_gamma_alpha of ISO 6336-1 by the geometry"
    )
    reason = f"REXS has no mesh stiffness: {formula}"
    table.add("stiffness", '"iso"', account.assume(f"{table.header}.stiffness", "iso", reason))
    return table
