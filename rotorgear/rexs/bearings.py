"""Bearings of a REXS file, to ground or between two shafts. Placeholders for rigid and for free never become a stiffness.

A rolling bearing of which only a designation or outer dimensions are known has a radial stiffness by E. Krämer, Dynamics of
Rotors and Foundations (Springer 1993), also M. I. Friswell et al., Dynamics of Rotating Machines (Cambridge 2010), section 5.5.4:

    balls    k = k_b Z^(2/3) D^(1/3) f^(1/3) cos^(5/3)(alpha),  k_b = 13e6 N^(2/3) m^(-4/3)
    rollers  k = k_r Z^0.9 l^0.8 f^0.1 cos^1.9(alpha),          k_r = 1.0e9 N^0.9 m^(-1.8)

with Z elements of diameter D and length l, contact angle alpha and static load f, of which the most loaded element takes
s f/(Z cos(alpha)), s = 4.37 of balls and 4.08 of rollers (Stribeck). Under a thrust F all elements take F/(Z sin(alpha)), so that
the same contacts have the axial stiffness

    balls    k = s^(2/3) k_b Z^(2/3) D^(1/3) F^(1/3) sin^(5/3)(alpha)
    rollers  k = s^0.9 k_r Z^0.9 l^0.8 F^0.1 sin^1.9(alpha)

A radial bearing is estimated at a tenth of its radial static rating, with an axial stiffness of 2 tan^2(alpha) times the radial
one, as of elements that are equally loaded; where the file has an axial static rating, and for a thrust bearing, at a tenth of
that. Elements are those of `designations`. The result is an order of size.
"""

from __future__ import annotations

import math
import re
from typing import TypeAlias

from rotorgear.forces.designations import (
    BALLS,
    THRUST,
    bore_of_code,
    designated,
    outer_diameter,
    rolling_elements,
    words_of,
)
from rotorgear.rexs.account import Account
from rotorgear.rexs.document import Component
from rotorgear.rexs.shafts import ShaftPart
from rotorgear.rexs.structure import GEARS, PLANETARY, Structure
from rotorgear.rexs.toml_text import Names, Table, quantity, row, text

_BALL = 13e6
_ROLLER = 1.0e9
# Factors of the static ratings, across and along, ISO 76, in N and mm: times Z D^2 of balls, (1 - D cos(alpha)/d_m) Z l D of
# rollers, and cos(alpha) or sin(alpha).
_RATING = {True: (12.3e6, 49e6), False: (44e6, 220e6)}
_LOAD = 0.1
# Load of the most loaded element of balls and of rollers over the mean, times cos(alpha), without clearance (Stribeck).
_STRIBECK = {True: 4.37, False: 4.08}
# Contact angle of a deep groove bearing under a thrust, and what the flanges of cylindrical rollers are taken for.
_WORKING_ANGLE = math.radians(15.0)
# From here on a bearing carries along the shaft; and from here on nothing across.
_THRUST = math.radians(45.0)
_ALONG = math.radians(89.0)


# Bore, outer diameter and width (nan: not known) in m, and the words that say where they come from.
Size: TypeAlias = tuple[float, float, float, str]


def size_of_designation(designation: str) -> Size | None:
    """Size by a designation such as 6305-2Z, NUP204E, 33014, NA 4908 or K 50x58x25; None where it says none."""
    sizes = re.search(r"(\d+(?:\.\d+)?)\s*[xX*]\s*(\d+(?:\.\d+)?)", designation)
    if sizes:
        bore = 1e-3 * float(sizes[1])
        outer = 1e-3 * float(sizes[2])
        return (bore, outer, math.nan, "designation") if 0.0 < bore < outer else None
    found = designated(designation, anywhere=True)
    if found is not None:
        return found.bore, found.outer, found.width, f"designation {found.name}, ISO 15"
    digits = re.search(r"\d{3,6}", designation)
    if digits is None:
        return None
    bore = bore_of_code(digits[0][-2:])
    outer = outer_diameter(bore, digits[0][-3])
    return None if math.isnan(outer) else (bore, outer, math.nan, "designation, ISO 15")


def estimated(
    kind: str, size: Size, ratings: tuple[float | None, float | None], contact_angle: float, reason: str
) -> tuple[float, float, str, str]:
    """Radial and axial stiffness in N/m of a type of bearing by its size, and what each was estimated from.

    Args:
        kind: of `designations`, such as "deep groove" or "thrust ball".
        size: bore, outer diameter and width.
        ratings: radial and axial static rating in N, each None where the file has none: by ISO 76.
        contact_angle: in rad; 0: none across, a working angle along the shaft.
        reason: where that angle is from.
    """
    bore, outer, width, source = size
    balls = kind in BALLS
    count, element, pitch, length = rolling_elements(kind, bore, outer, width)
    across, along = math.cos(contact_angle), math.sin(contact_angle)
    area = count * element * (element if balls else length * (1.0 - element * across / pitch))
    radial_rating, axial_rating = (
        given if given and given > 0.0 else factor * area * part
        for given, factor, part in zip(ratings, _RATING[balls], (across, along), strict=True)
    )
    # Of elements that all point along the load.
    power = 2.0 / 3.0 if balls else 0.9
    own = _BALL * (count**2 * element) ** (1.0 / 3.0) if balls else _ROLLER * count**0.9 * length**0.8
    radial = own * (_LOAD * radial_rating) ** (1.0 - power) * across ** (1.0 + power)
    angle = f"alpha = {math.degrees(contact_angle or _WORKING_ANGLE):.4g} deg ({reason})"
    words = f"2 tan²(alpha) of the radial one, {angle}"
    axial = 2.0 * math.tan(contact_angle or _WORKING_ANGLE) ** 2 * radial
    if ratings[1] or contact_angle >= _THRUST:
        direction = math.sin(contact_angle or _WORKING_ANGLE)
        axial = _STRIBECK[balls] ** power * own * (_LOAD * axial_rating) ** (1.0 - power) * direction ** (1.0 + power)
        rating = "axial static rating of the file" if ratings[1] else "axial static rating by ISO 76"
        words = f"a thrust of {_LOAD * axial_rating:.2g} N, a tenth of the {rating}, {angle}"
    if contact_angle >= _THRUST:
        radial = axial / (2.0 * math.tan(contact_angle) ** 2) if contact_angle < _ALONG else 0.0
    inside = (
        f"{words_of(kind)} bearing, Krämer's formula with {count} of {1e3 * element:.2g} mm, from {1e3 * bore:.4g} x "
        f"{1e3 * outer:.4g} mm ({source})"
    )
    load = f"{_LOAD * radial_rating:.2g} N"
    if contact_angle >= _THRUST:
        load = "the axial one over 2 tan²(alpha)" if radial else "carries nothing across"
    return radial, axial, f"{inside}, {load}" + (f", {angle}" if contact_angle else ""), f"{inside}, {words}"


# A stiffness outside these bounds, in N/m and in N m/rad, is a placeholder for rigid (1e20, 1e23) or for free (0).
_STIFFNESS = (1e4, 1e11)
_TILT = (1.0, 1e9)
# A power of ten from here on, in the unit of the file, is a placeholder too: no computation or measurement gives exactly that.
_ROUND = 1e10
# Two statements of one place differ by no more, in m.
_ONE_PLACE = 1e-5
# A bore that differs from the diameter of its shaft by more than this share is not the bore of the bearing.
_FITS = 0.35
# Radial stiffness in N/m of a bearing of which neither kind nor size is known.
_UNKNOWN = 2e8
# Outer diameter over bore of shafts beside the table, where the shaft's diameter is all that is known.
_OUTER_OVER_BORE = 1.8
# Types by words of the file, the first that all stand there.
_TYPE_WORDS = (
    (("axial", "spherical"), "spherical thrust"),
    (("axial", "roller"), "thrust roller"),
    (("axial", "needle"), "thrust roller"),
    (("axial",), "thrust ball"),
    (("thrust", "roller"), "thrust roller"),
    (("thrust",), "thrust ball"),
    (("tapered",), "tapered"),
    (("taper_roller",), "tapered"),
    (("spherical",), "spherical"),
    (("barrel",), "spherical"),
    (("needle",), "needle"),
    (("roller",), "cylindrical"),
    (("cylindrical",), "cylindrical"),
    (("four_point",), "four-point"),
    (("self_aligning",), "self-aligning"),
    (("angular",), "angular"),
    (("ball",), "deep groove"),
)
# Contact angle in rad by the type, where neither the file nor the designation has one.
_TYPE_ANGLES = {
    "angular": math.radians(40.0),
    "double angular": math.radians(30.0),
    "four-point": math.radians(35.0),
    "self-aligning": math.radians(10.0),
    "tapered": math.radians(14.0),
    "spherical": math.radians(11.0),
    "thrust ball": 0.5 * math.pi,
    "thrust roller": 0.5 * math.pi,
    "spherical thrust": math.radians(50.0),
}
# Types that words for balls and for rollers leave open.
_LIKE = {"deep groove": BALLS, "cylindrical": ("cylindrical", "tapered", "spherical", *THRUST[1:])}
_AXIAL_RATINGS = (
    "axial_static_load_rating",
    "static_axial_load_rating",
    "static_load_rating_axial",
    "axial_static_capacity",
    "static_axial_capacity",
    "static_capacity_axial",
)
_PLAIN_WORDS = ("plain", "journal", "slide", "sliding", "hydrodynamic")
_HELD_WORDS = ("both_directions", "positive", "negative", "true")
_FREE_WORDS = ("no_direction", "none", "false", "no")


def is_bearing(component: Component) -> bool:
    """Whether a component is a bearing, and not the data of one."""
    return "bearing" in component.type and not component.type.endswith(
        ("_row", "_data", "_ring", "_contact", "_data_set")
    )


def is_coupling(component: Component) -> bool:
    """Whether a component joins two shafts."""
    return component.type in ("coupling", "fixed_coupling", "switchable_coupling", "feather_key_connection") or (
        component.type.endswith(("interference_fit", "spline_connection"))
    )


# A shaft and z on it in m; None for the casing.
Seat: TypeAlias = tuple[ShaftPart, float] | None


def seats(part: Component, shafts: dict[str, ShaftPart], structure: Structure) -> list[Seat]:
    """Inner and outer side of a bearing or a coupling."""
    account = structure.account
    found: list[Seat] = []
    at = "u_coordinate_on_shaft"
    for roles, names in (
        (("inner_part", "side_1", "assembly"), (f"{at}_inner_side", f"{at}_side_1", at)),
        (("outer_part", "side_2"), (f"{at}_outer_side", f"{at}_side_2")),
    ):
        shaft = shafts.get(structure.shaft_of(part, *roles))
        if shaft is None:
            found.append(None)
            continue
        u = account.number(part, names, "length")
        frame = structure.frame(part)
        by_vector = None if frame is None else float(shaft.axis.base.sees(frame.origin)[0])
        z = by_vector if u is None else shaft.axis.z(u)
        if z is None:
            account.missing(part, f"its place on {shaft.component} is needed: {names[0]} or support_vector")
            z = shaft.start
        elif by_vector is not None and not found and abs(z - by_vector) > _ONE_PLACE:
            account.warnings.append(
                f"{part}: its support_vector is at {1e3 * by_vector:.6g} mm along the gear unit, its coordinate on the "
                f"shaft at {1e3 * z:.6g} mm, which counts"
            )
        found.append((shaft, shaft.place(part, z, account)))
    return found


def bearing_table(
    part: Component, names: Names, shafts: dict[str, ShaftPart], structure: Structure, pin: ShaftPart | None = None
) -> Table | None:
    """Table of a bearing to ground or on a planet's pin, or of a coupling where it sits between two other shafts.

    Args:
        part: the bearing. names: taken so far.
        shafts: of the model by number. structure: of the file.
        pin: shaft of the file inside of it that stands rigidly on a carrier.

    Returns:
        The table; None where the bearing has no shaft.
    """
    account = structure.account
    sides = seats(part, shafts, structure)
    planet = next((seat for seat in sides if seat is not None and seat[0].pins is not None), None)
    if planet is not None and None not in sides and not all(seat and seat[0].pins for seat in sides):
        # A planet's bearing stands on its carrier, whichever part of it the file names.
        sides = [planet, None]
    inner, outer = sides
    name = names.of(part.name, "bearing", part.id)
    seat = inner or outer
    if seat is None:
        account.missing(part, "it must sit on a shaft, by a side relation with an inner_part or an outer_part")
        return None
    designation = account.text(part, "catalogue_designation", "name", "designation", "bearing_designation")
    remark = f"{part}, {designation}" if designation and designation != part.name else str(part)
    if inner is not None and outer is not None:
        table = between(f"couplings.{name}", remark, inner, outer)
    else:
        table = seat[0].table(f"bearings.{name}", remark, seat[1])
    u = account.number(part, ("u_coordinate_on_shaft_inner_side", "u_coordinate_on_shaft_side_1"), "length")
    d = seat[0].diameter(seat[1]) if pin is None else pin.diameter(pin.axis.z(u or 0.0))
    stiffness, reasons = _stiffness(part, d, designation, table.header, structure)
    if not stiffness:
        account.left_out.append(f"{part}: it holds nothing, by radial_force_absorption and axial_force_absorption")
        return None
    table.add("stiffness", row(**stiffness), "\n".join(reasons))
    return table


def _stiffness(
    part: Component, d: float, designation: str, header: str, structure: Structure
) -> tuple[dict[str, str], list[str]]:
    """Stiffness by direction of a bearing around d in m, and comments that say which of it the file did not give."""
    account = structure.account
    radial = given_stiffness(part, ("radial_stiffness",), "stiffness", account)
    axial = given_stiffness(part, ("axial_stiffness",), "stiffness", account)
    tilt = given_stiffness(part, ("bending_stiffness", "tilting_stiffness"), "rotational_stiffness", account)
    takes_radial = account.truth(part, "radial_force_absorption") is not False
    takes_axial = _takes_axial(part, designation, structure)
    guessed = (0.0, 0.0, "", "")
    if (takes_radial and radial is None) or (takes_axial and axial is None):
        guessed = _guess(part, d, designation, structure)
    one_way = account.text(part, "axial_force_absorption") in ("positive", "negative")
    of_axial = guessed[3] + ("; held both ways, not one" if one_way else "")
    stiffness: dict[str, str] = {}
    reasons: list[str] = []
    for key, takes, value, guess, why in (
        ("radial", takes_radial, radial, guessed[0], guessed[2]),
        ("axial", takes_axial, axial, guessed[1], of_axial),
    ):
        if not takes:
            continue
        if value is None and not guess:
            account.left_out.append(f"{part}: its {key} stiffness: {why}")
            continue
        if value is None:
            value = float(f"{guess:.3g}")
            address = f"{header}.stiffness.{key}"
            reasons.append(account.assume(address, f"{value:.3g} N/m", f"none in the file: {why}"))
        stiffness[key] = quantity(value, "stiffness")
    if tilt is not None:
        stiffness["tilt"] = quantity(tilt, "rotational_stiffness")
    return stiffness, reasons


def between(header: str, remark: str, first: tuple[ShaftPart, float], second: tuple[ShaftPart, float]) -> Table:
    """The table of what joins two shafts."""
    table = Table(header, remark)
    for side, (shaft, z) in (("from", first), ("to", second)):
        table.add(f"{side}_shaft", text(shaft.name))
        table.add(f"{side}_at", quantity(z, "length"))
    return table


def given_stiffness(part: Component, names: tuple[str, ...], kind: str, account: Account) -> float | None:
    """A stiffness of the file; None where there is none, or a placeholder for rigid or free."""
    value = account.number(part, names, kind)
    bounds = _STIFFNESS if kind == "stiffness" else _TILT
    if value is None or not bounds[0] <= value <= bounds[1]:
        return None
    for name in names:
        written = account.plain_number(part, name)
        if written is not None and written >= _ROUND:
            exponent = math.log10(written)
            if abs(exponent - round(exponent)) < 1e-9:
                return None
    return value


def _takes_axial(part: Component, designation: str, structure: Structure) -> bool:
    account = structure.account
    rows = structure.parts_of(part, "rolling_bearing_row")
    words = [account.text(part, "axial_force_absorption")]
    words += [account.text(row_, "axial_force_absorption_of_row") for row_ in rows]
    for word in map(str.lower, words):
        if word in (*_FREE_WORDS, *_HELD_WORDS):
            return word in _HELD_WORDS
    # Where the file says nothing, the type decides: cylindrical rollers N and NU and needles move freely along the shaft.
    letters = designation.upper()
    return (
        _kind(part, designation, structure)[0] not in ("plain", "unknown", "needle", "cylindrical") or "NUP" in letters
    )


def _kind(part: Component, designation: str, structure: Structure) -> tuple[str, float, str]:
    """Type of a bearing, "plain" or "unknown", its contact angle in rad (0: none), and where that is from."""
    account = structure.account
    words = f"{account.text(part, 'bearing_type', 'type_of_bearing')} {part.type}".lower()
    if any(word in words for word in _PLAIN_WORDS):
        return "plain", 0.0, ""
    by_words = next((kind for need, kind in _TYPE_WORDS if all(word in words for word in need)), "")
    found = designated(designation, anywhere=True) or designated(part.name, anywhere=True)
    # A word of the file that says no more than balls or rollers leaves the rest to the designation.
    general = by_words in ("", "deep groove", "cylindrical")
    if found is not None and (found.type == by_words or (general and (not by_words or found.type in _LIKE[by_words]))):
        return found.type, found.contact_angle, found.reason
    letters = designation.upper().replace("NOT A CATALOGUE BEARING:", "").strip()
    if not by_words and letters.startswith(("N", "K", "HK", "RN")):
        by_words = "cylindrical" if letters.startswith("N") and not letters.startswith("NA") else "needle"
    return by_words or "unknown", _TYPE_ANGLES.get(by_words, 0.0), f"usual of a {by_words} bearing"


def _guess(part: Component, d: float, designation: str, structure: Structure) -> tuple[float, float, str, str]:
    """Estimated radial and axial stiffness in N/m of a bearing around d in m, and the words that say from what."""
    account = structure.account
    kind, angle, reason = _kind(part, designation or part.name, structure)
    by_designation = size_of_designation(designation or part.name)
    if kind in ("plain", "unknown") and by_designation is None:
        words = f"a placeholder of {_UNKNOWN:.0e} N/m for a bearing of unknown size and kind"
        return _UNKNOWN, _UNKNOWN / 10.0, words, f"a tenth of {words}"
    bore = account.number(part, ("inner_diameter", "bore_diameter"), "length")
    outer = account.number(part, ("outer_diameter",), "length")
    width = account.number(part, ("width",), "length") or math.nan
    stated = (bore, outer, width, "dimensions in the file") if bore and outer and 0.0 < bore < outer else None
    by_table = outer_diameter(d, "2")
    outside = _OUTER_OVER_BORE * d if math.isnan(by_table) else by_table
    by_shaft = (d, outside, math.nan, "diameter of the shaft, series 2 of ISO 15")
    sizes = filter(None, (stated, by_designation, size_of_designation(part.name)))
    size = next((item for item in sizes if abs(item[0] - d) <= _FITS * d), by_shaft)
    radial_rating = account.number(
        part, ("static_capacity", "static_load_rating", "radial_static_load_rating"), "rating"
    )
    axial_rating = account.number(part, _AXIAL_RATINGS, "rating")
    rows = structure.parts_of(part, "rolling_bearing_row")
    for one in (part, *rows):
        given = account.number(one, ("pressure_angle", "contact_angle"), "angle")
        if given and 0.0 < abs(given) <= 0.5 * math.pi + 1e-9:
            angle, reason = abs(given), "of the file"
            break
    if kind in THRUST or angle >= _THRUST:
        axial_rating = axial_rating or radial_rating
    if kind in ("plain", "unknown"):
        kind = "deep groove"
    if not angle:
        reason = "thrust by flanges" if kind in ("cylindrical", "needle") else "a deep groove bearing under a thrust"
    return estimated(kind, size, (radial_rating, axial_rating), angle, reason)


def coupling_table(part: Component, names: Names, shafts: dict[str, ShaftPart], structure: Structure) -> Table | None:
    """Table of a coupling between two coaxial shafts, or of the support of a shaft that one holds to the casing.

    None where it does neither, or is open.
    """
    account = structure.account
    if is_open(part, structure):
        account.left_out.append(f"{part}: it is open")
        return None
    inner, outer = seats(part, shafts, structure)
    name = names.of(part.name, "coupling", part.id)
    if inner is not None and outer is not None:
        table = between(f"couplings.{name}", str(part), inner, outer)
        d = min(inner[0].diameter(inner[1]), outer[0].diameter(outer[1]))
    elif (seat := inner or outer) is not None and holds(part, structure):
        table = seat[0].table(f"supports.{name}", f"{part}, which holds the shaft to the casing", seat[1])
        d = seat[0].diameter(seat[1])
    else:
        account.left_out.append(f"{part}: it does not join two shafts")
        return None
    add_stub(table, d, account, part)
    return table


# Stiffnesses of a coupling: their kind, and their attributes over the versions.
COUPLING_STIFFNESS = {
    "radial": ("stiffness", ("radial_stiffness",)),
    "axial": ("stiffness", ("axial_stiffness",)),
    "tilt": ("rotational_stiffness", ("bending_stiffness",)),
    "torsion": ("rotational_stiffness", ("rotational_stiffness", "torsional_stiffness")),
}


def is_open(part: Component, structure: Structure) -> bool:
    """Whether a coupling or a brake is not engaged, in the gear of the file where it has several."""
    gear = next((structure.account.number(unit, ("gear_shift_index",), "ratio") for unit in structure.units), None)
    return any(
        structure.account.truth(part, key, round(gear or 1.0) - 1) is False for key in ("is_engaged", "is_closed")
    )


def holds(part: Component, structure: Structure) -> bool:
    """Whether a coupling joins a shaft to the casing of a gearbox with planetary stages, or a shaft without gears."""
    sides = structure.beside(part)
    shafts = [side.id for side in sides if side.type == "shaft"]
    if len(shafts) != 1 or not any(side.type == "gear_casing" for side in sides) or is_open(part, structure):
        return False
    document = structure.document
    toothed = any(structure.shaft_of(gear) == shafts[0] for gear in document.of_type(*GEARS))
    return not toothed or bool(document.of_type(PLANETARY))


def add_stub(table: Table, d: float, account: Account, part: Component | None = None) -> None:
    """The stiffness of a coupling; what its component does not say is that of a steel stub of diameter d in m, as long as thick.

    K = G I_p / d, E I / d, E A / d, 12 E I / d^3.
    """
    inertia = math.pi * d**4 / 64.0
    reason = f"none in the file: a steel stub of {1e3 * d:.4g} mm, as long as thick"
    values = {}
    notes = []
    stub = {
        "radial": 12.0 * 206e9 * inertia / d**3,
        "axial": 206e9 * math.pi * d / 4.0,
        "tilt": 206e9 * inertia / d,
        "torsion": 79e9 * 2.0 * inertia / d,
    }
    for key, (kind, attributes) in COUPLING_STIFFNESS.items():
        found = None if part is None else given_stiffness(part, attributes, kind, account)
        if found is None:
            found = float(f"{stub[key]:.4g}")
            notes.append(account.assume(f"{table.header}.stiffness.{key}", f"{found:.3g}", reason))
        values[key] = quantity(found, kind)
    table.add("stiffness", row(**values), notes[0] if notes else "")
