"""Rolling bearings by their designation: boundary dimensions of ISO 15 and ISO 355 series, and what rolls inside.

Makers print bore, outer diameter and width; what rolls inside they print for few bearings. `_KNOWN` has those of which number and
size of the elements are published, with the source; of all others they are estimated from the boundary dimensions, by shares that
hold within some 10 % for the bearings that are known. An estimate is said wherever the bearing is used.

Radial internal clearances of deep groove ball bearings by bore and class are those of ISO 5753-1:2009, table 1, cylindrical bore.
"""

from __future__ import annotations

import math
import re
from typing import Any

# Outer diameter in mm over the bore code, by the series of diameters: 0 light, 2 medium, 3 heavy (ISO 15; makers' catalogues).
_BORES = {"00": 10.0, "01": 12.0, "02": 15.0, "03": 17.0}
_OUTER = {
    "0": (26, 28, 32, 35, 42, 47, 55, 62, 68, 75, 80, 90, 95, 100, 110, 115, 125, 130, 140, 145, 150),
    "2": (30, 32, 35, 40, 47, 52, 62, 72, 80, 85, 90, 100, 110, 120, 125, 130, 140, 150, 160, 170, 180),
    "3": (35, 37, 42, 47, 52, 62, 72, 80, 90, 100, 110, 120, 130, 140, 150, 160, 170, 180, 190, 200, 215),
}
# Elements over the difference of the diameters, share of their circle that they fill, length over diameter.
_SHARES = {
    "ball": (0.3, 0.6, None),
    "angular": (0.3, 0.88, None),
    "four-point": (0.3, 0.75, None),
    "roller": (0.275, 0.8, 1.05),
    "tapered": (0.25, 0.85, 1.4),
}
_ANGLES = {"B": 40.0, "AC": 25.0, "A": 30.0, "E": 25.0, "C": 15.0, "": 40.0}
_TAPERED_ANGLES = {"302": 14.0, "303": 12.0, "313": 28.8, "320": 15.0, "322": 14.0, "323": 12.0}
_FOUR_POINT_ANGLE = 35.0
# Number, diameter, pitch diameter in mm, and the source.
_KNOWN = {
    "6203": (8, 6.746, 28.50, "Case Western Reserve University, Bearing Data Center: 0.2656 and 1.122 in"),
    "6205": (9, 7.940, 39.04, "Case Western Reserve University, Bearing Data Center: 0.3126 and 1.537 in"),
    "6211": (10, 14.288, 77.50, "number and size that reproduce makers' tables of defect frequencies, BPFO 4.08"),
    "NJ209": (15, 11.0, 65.5, "makers' raceway diameters F_w 54.5 and E_w 76.5 mm; 15 rollers, 16 or 17 in some makes"),
    "7218": (16, 22.225, 125.26, "T. A. Harris, Rolling Bearing Analysis, bearing 218"),
}
SERIES = "60, 62, 63, 70, 72, 73, QJ 0 2 3, N NU NJ NUP 2 and 3, 302, 303, 313, 320, 322, 323"
_FORM = re.compile(
    r"(?P<series>6[023]|7[023]|QJ ?[023]|N[UJ]?P? ?[23]|3[0-3][023])(?P<code>\d\d)(?!\d)\s*(?P<suffix>[A-Z]{0,2})"
)


def inner_geometry(designation: str) -> tuple[dict[str, Any], str]:
    """What rolls in a bearing such as 6205, 7218 B, QJ 212, NJ209 or 30209, and where that is published.

    Returns:
        Keys of `rolling` in SI and radians, none for a designation that is not in the tables, and the source; "" of an estimate.
    """
    found = _FORM.match(designation.strip().upper())
    series = found["series"].replace(" ", "") if found else ""
    number = int(found["code"]) if found else 0
    outers = _OUTER.get(series[-1:], ())
    known_tapered = series in _TAPERED_ANGLES and number >= 3
    if found is None or number >= len(outers) or (series[0] == "3" and not known_tapered):
        return {}, ""
    name = series + found["code"]
    bore = _BORES.get(found["code"], 5.0 * number)
    outer = float(outers[number])
    kind, shape, angle = {
        "6": ("ball", "ball", None),
        "7": ("ball", "angular", _ANGLES.get(found["suffix"], 40.0)),
        "Q": ("four-point", "four-point", _FOUR_POINT_ANGLE),
        "N": ("roller", "roller", None),
        "3": ("tapered", "tapered", _TAPERED_ANGLES.get(series)),
    }[series[0]]
    share, filled, slender = _SHARES[shape]
    element = share * (outer - bore)
    pitch = 0.5 * (outer + bore)
    estimate = (round(filled * math.pi * pitch / element), element, pitch, "")
    count, element, pitch, source = _KNOWN.get(name, estimate)
    sizes = {"element_diameter": 1e-3 * element, "pitch_diameter": 1e-3 * pitch}
    if slender is not None:
        sizes["length"] = 1e-3 * (12.0 if name == "NJ209" else slender * element)
    if angle is not None:
        sizes["contact_angle"] = math.radians(angle)
    return {"kind": kind, "elements": count, **sizes}, source


CLASSES = ("C2", "CN", "C3", "C4", "C5")
# Bore up to and including, mm; least and largest clearance of each class, um. The first row begins above 10 mm.
_FROM = 10.0
_TABLE = (
    (18.0, (0, 9), (3, 18), (11, 25), (18, 33), (25, 45)),
    (24.0, (0, 10), (5, 20), (13, 28), (20, 36), (28, 48)),
    (30.0, (1, 11), (5, 20), (13, 28), (23, 41), (30, 53)),
    (40.0, (1, 11), (6, 20), (15, 33), (28, 46), (40, 64)),
    (50.0, (1, 11), (6, 23), (18, 36), (30, 51), (45, 73)),
    (65.0, (1, 15), (8, 28), (23, 43), (38, 61), (55, 90)),
    (80.0, (1, 15), (10, 30), (25, 51), (46, 71), (65, 105)),
    (100.0, (1, 18), (12, 36), (30, 58), (53, 84), (75, 120)),
    (120.0, (2, 20), (15, 41), (36, 66), (61, 97), (90, 140)),
)


def class_clearance(bore: float, name: str) -> tuple[float, float] | None:
    """Return the least and the largest clearance in m of a class at a bore in m; None where the table has no such bore."""
    if not 1e3 * bore > _FROM:
        return None
    for most, *classes in _TABLE:
        if 1e3 * bore <= most * (1.0 + 1e-12):
            least, largest = classes[CLASSES.index(name)]
            return 1e-6 * least, 1e-6 * largest
    return None
