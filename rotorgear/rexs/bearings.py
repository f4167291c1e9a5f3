"""Bearings of a REXS file, to ground or between two shafts. Placeholders for rigid and for free never become a stiffness.

A rolling bearing of which only a designation or outer dimensions are known has a radial stiffness by E. Krämer, Dynamics of
Rotors and Foundations (Springer 1993), also M. I. Friswell et al., Dynamics of Rotating Machines (Cambridge 2010), section 5.5.4:

    balls    k = k_b Z^(2/3) D^(1/3) f^(1/3) cos^(5/3)(alpha),  k_b = 13e6 N^(2/3) m^(-4/3)
    rollers  k = k_r Z^0.9 l^0.8 f^0.1 cos^1.9(alpha),          k_r = 1.0e9 N^0.9 m^(-1.8)

with Z elements of diameter D and length l, contact angle alpha and static load f. Most of these are not known, so that the result
is an order of size: elements of 0.3 times the difference of the diameters, and a load of a tenth of the static rating. Elements
that are equally loaded have an axial stiffness of 2 tan^2(alpha) times the radial one.
"""

from __future__ import annotations

import math
import re
from typing import TypeAlias

from rotorgear.rexs.account import Account
from rotorgear.rexs.document import Component
from rotorgear.rexs.shafts import ShaftPart
from rotorgear.rexs.structure import Structure
from rotorgear.rexs.toml_text import Names, Table, quantity, row, text

_BALL = 13e6
_ROLLER = 1.0e9
# Diameter of the elements over the difference of outer diameter and bore, and the share of their circle that they fill.
_ELEMENT = 0.3
_FILLED = {"ball": 0.6, "roller": 0.8}
# Factors of the static rating, ISO 76: C_0 = 12.3 Z D^2 for balls and 44 (1 - D/d_m) Z l D for rollers, in N and mm.
_RATING = {"ball": 12.3e6, "roller": 44e6}
_LOAD = 0.1
# Contact angle of a deep groove bearing under a thrust.
_WORKING_ANGLE = math.radians(15.0)
# ISO 15: D = d + f d^0.9 in mm by the series of diameters.
_DIAMETER_SERIES = {"7": 0.34, "8": 0.45, "9": 0.62, "0": 0.84, "1": 1.12, "2": 1.48, "3": 1.92, "4": 2.56}
_BORE_CODES = {"00": 10.0, "01": 12.0, "02": 15.0, "03": 17.0}


# Bore and outer diameter in m, and the words that say where they come from.
Size: TypeAlias = tuple[float, float, str]


def size_of_designation(designation: str) -> Size | None:
    """Bore and outer diameter by a designation such as 6305-2Z, NUP204E, 33014 or K 50x58x25; None where it says none."""
    sizes = re.search(r"(\d+(?:\.\d+)?)\s*[xX*]\s*(\d+(?:\.\d+)?)", designation)
    if sizes:
        bore = float(sizes[1])
        outer = float(sizes[2])
        return (1e-3 * bore, 1e-3 * outer, "designation") if 0.0 < bore < outer else None
    digits = re.search(r"\d{3,6}", designation)
    if digits is None:
        return None
    code = digits[0][-2:]
    bore = _BORE_CODES.get(code, 5.0 * float(code))
    series = _DIAMETER_SERIES.get(digits[0][-3])
    if series is None or bore <= 0.0:
        return None
    return 1e-3 * bore, 1e-3 * (bore + series * bore**0.9), "designation, ISO 15"


def estimated(kind: str, size: Size, static_rating: float | None, contact_angle: float) -> tuple[float, float, str]:
    """Radial and axial stiffness in N/m of a "ball" or "roller" bearing by its size, and what they were estimated from.

    Args:
        kind: of its elements.
        size: bore and outer diameter.
        static_rating: C_0 in N, or None: by ISO 76.
        contact_angle: in rad; of the axial stiffness, where 0, that of a deep groove bearing under a thrust.
    """
    bore, outer, source = size
    element = _ELEMENT * (outer - bore)
    pitch = 0.5 * (outer + bore)
    count = max(4.0, math.floor(_FILLED[kind] * math.pi * pitch / element))
    if not static_rating or static_rating <= 0.0:
        shape = 1.0 if kind == "ball" else 1.0 - element / pitch
        static_rating = _RATING[kind] * shape * count * element**2
    load = _LOAD * static_rating
    tilt = math.cos(contact_angle)
    if kind == "ball":
        radial = _BALL * count ** (2.0 / 3.0) * element ** (1.0 / 3.0) * load ** (1.0 / 3.0) * tilt ** (5.0 / 3.0)
    else:
        radial = _ROLLER * count**0.9 * element**0.8 * load**0.1 * tilt**1.9
    axial = 2.0 * math.tan(contact_angle or _WORKING_ANGLE) ** 2 * radial
    words = (
        f"{kind}s by Krämer's formula with {count:.0f} of {1e3 * element:.2g} mm and {load:.2g} N, from {1e3 * bore:.4g} x "
        f"{1e3 * outer:.4g} mm ({source})"
    )
    return radial, axial, words


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
# Outer diameter over bore where the shaft's diameter is all that is known.
_SERIES_2 = 1.48
_ROLLER_WORDS = ("roller", "needle", "barrel", "tapered", "cylindrical")
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


def _sides(part: Component, shafts: dict[str, ShaftPart], structure: Structure) -> list[Seat]:
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
        by_vector = None if frame is None else float(structure.place(frame)[0])
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


def bearing_table(part: Component, names: Names, shafts: dict[str, ShaftPart], structure: Structure) -> Table | None:
    """Table of a bearing to ground, or of a coupling where it sits between two shafts; None where it has no shaft."""
    account = structure.account
    inner, outer = _sides(part, shafts, structure)
    name = names.of(part.name, "bearing", part.id)
    seat = inner or outer
    if seat is None:
        account.missing(part, "it must sit on a shaft, by a side relation with an inner_part or an outer_part")
        return None
    designation = account.text(part, "catalogue_designation", "name", "designation", "bearing_designation")
    remark = f"{part}, {designation}" if designation and designation != part.name else str(part)
    if inner is not None and outer is not None:
        table = _between(f"couplings.{name}", remark, inner, outer)
    else:
        table = seat[0].table(f"bearings.{name}", remark, seat[1])
    radial = _given(part, ("radial_stiffness",), "stiffness", account)
    axial = _given(part, ("axial_stiffness",), "stiffness", account)
    tilt = _given(part, ("bending_stiffness", "tilting_stiffness"), "rotational_stiffness", account)
    takes_radial = account.truth(part, "radial_force_absorption") is not False
    takes_axial = _takes_axial(part, designation, structure)
    guessed = (0.0, 0.0, "")
    if (takes_radial and radial is None) or (takes_axial and axial is None):
        guessed = _guess(part, seat, designation, structure)
    one_way = account.text(part, "axial_force_absorption") in ("positive", "negative")
    of_radial = "2 tan²(alpha) of the radial one" + ("; held both ways, not one" if one_way else "")
    # Stiffness by direction; the comment says which of it the file did not give.
    stiffness: dict[str, str] = {}
    reasons: list[str] = []
    for key, takes, value, guess, why in (
        ("radial", takes_radial, radial, guessed[0], guessed[2]),
        ("axial", takes_axial, axial, guessed[1], of_radial),
    ):
        if not takes:
            continue
        if value is None:
            value = float(f"{guess:.3g}")
            address = f"{table.header}.stiffness.{key}"
            reasons.append(account.assume(address, f"{value:.3g} N/m", f"none in the file: {why}"))
        stiffness[key] = quantity(value, "stiffness")
    if tilt is not None:
        stiffness["tilt"] = quantity(tilt, "rotational_stiffness")
    if not stiffness:
        account.left_out.append(f"{part}: it holds nothing, by radial_force_absorption and axial_force_absorption")
        return None
    table.add("stiffness", row(**stiffness), "\n".join(reasons))
    return table


def _between(header: str, remark: str, first: tuple[ShaftPart, float], second: tuple[ShaftPart, float]) -> Table:
    """The table of what joins two shafts."""
    table = Table(header, remark)
    for side, (shaft, z) in (("from", first), ("to", second)):
        table.add(f"{side}_shaft", text(shaft.name))
        table.add(f"{side}_at", quantity(z, "length"))
    return table


def _given(part: Component, names: tuple[str, ...], kind: str, account: Account) -> float | None:
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
    # Where the file says nothing, the kind decides: cylindrical rollers N and NU and needles move freely along the shaft.
    return _kind(part, designation, structure) == "ball" or "tapered" in account.text(part, "bearing_type")


def _kind(part: Component, designation: str, structure: Structure) -> str:
    account = structure.account
    words = f"{account.text(part, 'bearing_type', 'type_of_bearing')} {part.type}".lower()
    if any(word in words for word in _PLAIN_WORDS):
        return "plain"
    if "ball" in words:
        return "ball"
    if any(word in words for word in _ROLLER_WORDS):
        return "roller"
    letters = designation.upper().replace("NOT A CATALOGUE BEARING:", "").strip()
    first = letters[:1]
    if letters.startswith(("N", "K", "HK", "RN")) or (first in ("2", "3") and len(letters) > 4):
        return "roller"
    return "ball" if first in ("6", "7", "1") else "unknown"


def _guess(
    part: Component, seat: tuple[ShaftPart, float], designation: str, structure: Structure
) -> tuple[float, float, str]:
    """Estimated radial and axial stiffness in N/m, and the words that say from what."""
    account = structure.account
    kind = _kind(part, designation or part.name, structure)
    by_designation = size_of_designation(designation or part.name)
    if kind in ("plain", "unknown") and by_designation is None:
        return _UNKNOWN, _UNKNOWN / 10.0, f"a placeholder of {_UNKNOWN:.0e} N/m for a bearing of unknown size and kind"
    bore = account.number(part, ("inner_diameter", "bore_diameter"), "length")
    outer = account.number(part, ("outer_diameter",), "length")
    stated = (bore, outer, "dimensions in the file") if bore and outer and 0.0 < bore < outer else None
    d = seat[0].diameter(seat[1])
    by_shaft = (d, d + 1e-3 * _SERIES_2 * (1e3 * d) ** 0.9, "diameter of the shaft, series 2 of ISO 15")
    sizes = filter(None, (stated, by_designation, size_of_designation(part.name)))
    size = next((item for item in sizes if abs(item[0] - d) <= _FITS * d), by_shaft)
    rating = account.number(part, ("static_capacity", "static_load_rating", "radial_static_load_rating"), "rating")
    rows = structure.parts_of(part, "rolling_bearing_row")
    angles = [angle for row_ in rows if (angle := account.number(row_, ("pressure_angle", "contact_angle"), "angle"))]
    angle = angles[0] if angles and 0.0 < abs(angles[0]) < math.radians(60.0) else 0.0
    return estimated("roller" if kind == "roller" else "ball", size, rating, abs(angle))


def coupling_table(part: Component, names: Names, shafts: dict[str, ShaftPart], structure: Structure) -> Table | None:
    """Table of a coupling between two coaxial shafts; None where it joins no two shafts, or is open."""
    account = structure.account
    inner, outer = _sides(part, shafts, structure)
    if inner is None or outer is None:
        account.left_out.append(f"{part}: it does not join two shafts")
        return None
    if account.truth(part, "is_engaged") is False or account.truth(part, "is_closed") is False:
        account.left_out.append(f"{part}: it is open")
        return None
    table = _between(f"couplings.{names.of(part.name, 'coupling', part.id)}", str(part), inner, outer)
    # A stub of steel, as long as thick, in place of what is rigid or not said: K = G I_p / d, E I / d, E A / d, 12 E I / d^3.
    d = min(inner[0].diameter(inner[1]), outer[0].diameter(outer[1]))
    inertia = math.pi * d**4 / 64.0
    reason = f"none in the file: a steel stub of {1e3 * d:.4g} mm, as long as thick"
    values = {}
    notes = []
    for key, kind, attributes, stub in (
        ("radial", "stiffness", ("radial_stiffness",), 12.0 * 206e9 * inertia / d**3),
        ("axial", "stiffness", ("axial_stiffness",), 206e9 * math.pi * d / 4.0),
        ("tilt", "rotational_stiffness", ("bending_stiffness",), 206e9 * inertia / d),
        ("torsion", "rotational_stiffness", ("rotational_stiffness", "torsional_stiffness"), 79e9 * 2.0 * inertia / d),
    ):
        found = _given(part, attributes, kind, account)
        if found is None:
            found = float(f"{stub:.4g}")
            notes.append(account.assume(f"{table.header}.stiffness.{key}", f"{found:.3g}", reason))
        values[key] = quantity(found, kind)
    table.add("stiffness", row(**values), notes[0] if notes else "")
    return table
