"""Stiffness of a rolling bearing of which only a designation or outer dimensions are known.

Radial stiffness by E. Krämer, Dynamics of Rotors and Foundations (Springer 1993), also M. I. Friswell et al., Dynamics of
Rotating Machines (Cambridge 2010), section 5.5.4:

    balls    k = k_b Z^(2/3) D^(1/3) f^(1/3) cos^(5/3)(alpha),  k_b = 13e6 N^(2/3) m^(-4/3)
    rollers  k = k_r Z^0.9 l^0.8 f^0.1 cos^1.9(alpha),          k_r = 1.0e9 N^0.9 m^(-1.8)

with Z elements of diameter D and length l, contact angle alpha and static load f. Most of these are not known, so that the result
is an order of size: elements of 0.3 times the difference of the diameters, and a load of a tenth of the static rating. Elements
that are equally loaded have an axial stiffness of 2 tan^2(alpha) times the radial one.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

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


@dataclass(frozen=True)
class BearingSize:
    """Bore and outer diameter in m, and the words that say where they come from."""

    bore: float
    outer: float
    source: str


def size_of_designation(designation: str) -> BearingSize | None:
    """Bore and outer diameter by a designation such as 6305-2Z, NUP204E, 33014 or K 50x58x25; None where it says none."""
    sizes = re.search(r"(\d+(?:\.\d+)?)\s*[xX*]\s*(\d+(?:\.\d+)?)", designation)
    if sizes:
        bore = float(sizes[1])
        outer = float(sizes[2])
        return BearingSize(1e-3 * bore, 1e-3 * outer, "designation") if 0.0 < bore < outer else None
    digits = re.search(r"\d{3,6}", designation)
    if digits is None:
        return None
    code = digits[0][-2:]
    bore = _BORE_CODES.get(code, 5.0 * float(code))
    series = _DIAMETER_SERIES.get(digits[0][-3])
    if series is None or bore <= 0.0:
        return None
    return BearingSize(1e-3 * bore, 1e-3 * (bore + series * bore**0.9), "designation, ISO 15")


@dataclass(frozen=True)
class Estimate:
    """Radial and axial stiffness in N/m, and what they were estimated from."""

    radial: float
    axial: float
    words: str


def estimated(kind: str, size: BearingSize, static_rating: float | None, contact_angle: float) -> Estimate:
    """Stiffness of a "ball" or "roller" bearing by its size.

    Args:
        kind: of its elements.
        size: bore and outer diameter.
        static_rating: C_0 in N, or None: by ISO 76.
        contact_angle: in rad; of the axial stiffness, where 0, that of a deep groove bearing under a thrust.
    """
    element = _ELEMENT * (size.outer - size.bore)
    pitch = 0.5 * (size.outer + size.bore)
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
        f"{kind}s by Krämer's formula with {count:.0f} of {1e3 * element:.2g} mm and {load:.2g} N, from {1e3 * size.bore:.4g} x "
        f"{1e3 * size.outer:.4g} mm ({size.source})"
    )
    return Estimate(radial, axial, words)
