"""Rolling bearings by their designation: type, boundary dimensions of ISO 15 and ISO 104, contact angle, and what rolls inside.

Makers print bore, outer diameter and width; what rolls inside they print for few bearings. `_KNOWN` has those of which number and
size of the elements are published, with the source; of all others they are estimated from the boundary dimensions, by shares that
hold within some 10 % for the bearings that are known. An estimate is said wherever the bearing is used.

The contact angles of a series are those of makers' catalogues; of tapered, spherical and self-aligning bearings they follow from
the printed limit e = 1.5 tan(alpha) of ISO 281.

Radial internal clearances of deep groove ball bearings by bore and class are those of ISO 5753-1:2009, table 1, cylindrical bore.
"""

from __future__ import annotations

import math
import re
from itertools import pairwise
from typing import Any, NamedTuple


def _table(text: str) -> dict[str, tuple[float, ...]]:
    """Rows of numbers by the word before them; nan where there is a point."""
    rows = (line.split() for line in text.strip().splitlines())
    return {name: tuple(math.nan if one == "." else float(one) for one in numbers) for name, *numbers in rows}


# Bores in mm by their code, then outer diameters by the series of diameters (T: of thrust bearings, ISO 104).
_OUTER = _table("""
d 10 12 15 17 20 25 30 35 40 45 50 55 60 65 70 75 80 85 90 95 100 105 110 120 130 140 150 160 170 180 190 200
8 19 21 24 26 32 37 42 47 52 58 65 72 78 85 90 95 100 110 115 120 125 130 140 150 165 175 190 200 215 225 240 250
9 22 24 28 30 37 42 47 55 62 68 72 80 85 90 100 105 110 120 125 130 140 145 150 165 180 190 210 220 230 250 260 280
0 26 28 32 35 42 47 55 62 68 75 80 90 95 100 110 115 125 130 140 145 150 160 170 180 200 210 225 240 260 280 290 310
1 . . . . . . . . 75 80 85 95 100 110 120 125 130 140 150 160 165 175 180 200 210 225 250 270 280 300 320 340
2 30 32 35 40 47 52 62 72 80 85 90 100 110 120 125 130 140 150 160 170 180 190 200 215 230 250 270 290 310 320 340 360
3 35 37 42 47 52 62 72 80 90 100 110 120 130 140 150 160 170 180 190 200 215 225 240 260 280 300 320 340 360 380 400 420
4 . . . 62 72 80 90 100 110 120 130 140 150 160 180 190 200 210 225 240 250 260 280 310 340 . . . . . . .
T1 24 26 28 30 35 42 47 52 60 65 70 78 85 90 95 100 105 110 120 . 135 . 145 155 170 180 190 200 215 225 240 250
T2 26 28 32 35 40 47 52 62 68 73 78 90 95 100 105 110 115 125 135 . 150 . 160 170 190 200 215 225 240 250 270 280
T3 . . . . . 52 60 68 78 85 95 105 110 115 125 135 140 150 155 . 170 . 190 210 225 240 250 270 280 300 320 340
T4 . . . . . 60 70 80 90 100 110 120 130 140 150 160 170 180 190 . 210 . 230 250 270 280 300 320 340 360 380 400
""")
_BORES = _OUTER.pop("d")
# Widths by the series of dimensions; from 20 on those of the cones of tapered bearings (ISO 355), where not 22 or 23.
_WIDTH = _table("""
00 . . 8 8 8 8 9 9 9 10 10 11 11 11 13 13 14 14 16 16 16 18 19 19 22 22 24 25 28 31 31 34
18 5 5 5 5 7 7 7 7 7 7 7 9 10 10 10 10 10 13 13 13 13 13 16 16 18 18 20 20 22 22 24 24
19 6 6 7 7 9 9 9 10 12 12 12 13 13 13 16 16 16 18 18 18 20 20 20 22 24 24 28 28 28 33 33 38
02 9 10 11 12 14 15 16 17 18 19 20 21 22 23 24 25 26 28 30 32 34 36 38 40 40 42 45 48 52 52 55 58
03 11 12 13 14 15 17 19 21 23 25 27 29 31 33 35 37 39 41 43 45 47 49 50 55 58 62 65 68 72 75 78 80
04 . . . 17 19 21 23 25 27 29 31 33 35 37 42 45 48 52 54 55 58 60 65 72 78 . . . . . . .
10 8 8 9 10 12 12 13 14 15 16 16 18 18 18 20 20 22 22 24 24 24 26 28 28 33 33 35 38 42 46 46 51
22 14 14 14 16 18 18 20 23 23 23 23 25 28 31 31 31 33 36 40 43 46 50 53 58 64 68 73 80 86 86 92 98
23 17 17 17 19 21 24 27 31 33 36 40 43 46 48 51 55 58 60 64 67 73 77 80 86 93 102 108 114 120 126 132 138
20 . . . . 15 15 17 18 19 20 20 23 23 23 25 25 29 29 32 32 32 35 38 38 45 45 48 51 57 64 64 70
29 . . . . 12 12 12 14 15 15 15 17 17 17 20 20 20 23 23 23 25 25 25 29 32 32 38 38 38 45 45 51
30 . . . . . 17 20 21 22 24 24 27 27 27 31 31 36 36 39 39 39 . 47 48 55 56 59 . . . . .
31 . . . . . . . . 26 26 26 30 30 34 37 37 37 41 45 49 52 . 56 62 . . . . . . . .
32 . . . . . 22 25 28 32 32 32 35 38 41 41 41 46 49 55 58 63 . . . . . . . . . . .
""")
# Kind of `rolling`, "" where it has none; elements over the difference of the diameters; share of their circle that they fill,
# all rows together; length over the width, or over the diameter where no width is known; and the words.
_TYPES: dict[str, tuple[str, float, float, float, float, str]] = {
    "deep groove": ("ball", 0.3, 0.6, 0.0, 0.0, "deep groove ball"),
    "angular": ("ball", 0.3, 0.88, 0.0, 0.0, "angular contact ball"),
    "double angular": ("", 0.3, 1.5, 0.0, 0.0, "double row angular contact ball"),
    "four-point": ("four-point", 0.3, 0.75, 0.0, 0.0, "four-point contact ball"),
    "self-aligning": ("", 0.24, 1.3, 0.0, 0.0, "self-aligning ball"),
    "cylindrical": ("roller", 0.275, 0.8, 0.63, 1.05, "cylindrical roller"),
    "needle": ("", 0.275, 0.8, 0.63, 3.0, "needle roller"),
    "tapered": ("tapered", 0.25, 0.85, 0.75, 1.4, "tapered roller"),
    "spherical": ("", 0.25, 1.6, 0.4, 0.9, "spherical roller"),
    "thrust ball": ("", 0.4, 0.92, 0.0, 0.0, "thrust ball"),
    "thrust roller": ("", 0.3, 0.8, 0.0, 1.0, "cylindrical roller thrust"),
    "spherical thrust": ("", 0.3, 0.8, 0.0, 1.0, "spherical roller thrust"),
}
# Largest ball over the width of its rings, such as those of series 160.
_WIDEST = 0.8
BALLS = ("deep groove", "angular", "double angular", "four-point", "self-aligning", "thrust ball")
THRUST = ("thrust ball", "thrust roller", "spherical thrust")
# Type, contact angle in degrees (nan: by the letter behind), and series with their series of dimensions, the last digit of which
# is that of the diameters.
_SERIES = {
    series: (kind, angle, size)
    for kind, angle, names in (
        ("deep groove", 0.0, "618:18 619:19 160:00 60:10 62:02 63:03 64:04"),
        ("angular", math.nan, "718:18 719:19 70:10 72:02 73:03"),
        ("double angular", 30.0, "32:2 33:3"),
        ("four-point", 35.0, "QJ0:10 QJ2:02 QJ3:03"),
        ("cylindrical", 0.0, "N2:02 N3:03 N4:04 N10:10 N22:22 N23:23"),
        ("self-aligning", 8.0, "12:02 13:03"),
        ("self-aligning", 12.0, "22:22 23:23"),
        ("tapered", 12.0, "303:03 323:23 330:30"),
        ("tapered", 14.0, "302:02 322:22 329:29"),
        ("tapered", 15.0, "320:20 331:31 332:32"),
        ("tapered", 28.8, "313:03"),
        ("spherical", 7.0, "239:9"),
        ("spherical", 9.5, "213:03 222:22 230:0"),
        ("spherical", 13.0, "223:23 231:1 232:2 240:0 241:1"),
        ("thrust ball", 90.0, "511:T1 512:T2 513:T3 514:T4"),
        ("thrust roller", 90.0, "811:T1 812:T2"),
        ("spherical thrust", 50.0, "292:T2 293:T3 294:T4"),
    )
    for series, size in (name.split(":") for name in names.split())
}
# No maker's name with a designation is longer.
_LONGEST = 100
_FORM = re.compile(
    r"(?<![0-9A-Z])(?P<series>R?N(?:UP|U|J)? ?(?:10|22|23|[234])|QJ ?[023]|[0-9]{2,3})"
    r"(?P<code>[0-9]{2})(?![0-9])[\s-]*(?P<suffix>.*)"
)
# Letters of the contact angle of an angular contact bearing; C before a digit or N is a clearance.
_LETTER = re.compile(r"B|A5|AC|AD|A(?![A-Z])|C(?!\d|N)|E")
_ANGLES = {"B": 40.0, "A5": 25.0, "AC": 25.0, "AD": 25.0, "A": 30.0, "C": 15.0, "E": 25.0}
_NO_LETTER = 40.0
# Number, diameter, pitch diameter, length in mm, and the source.
_KNOWN = {
    "6203": (8, 6.746, 28.50, 0.0, "Case Western Reserve University, Bearing Data Center: 0.2656 and 1.122 in"),
    "6205": (9, 7.940, 39.04, 0.0, "Case Western Reserve University, Bearing Data Center: 0.3126 and 1.537 in"),
    "6211": (10, 14.288, 77.50, 0.0, "number and size that reproduce makers' tables of defect frequencies, BPFO 4.08"),
    "NJ209": (
        15,
        11.0,
        65.5,
        12.0,
        "makers' raceway diameters F_w 54.5 and E_w 76.5 mm; 15 rollers, 16 or 17 in some makes",
    ),
    "7218": (16, 22.225, 125.26, 0.0, "T. A. Harris, Rolling Bearing Analysis, bearing 218"),
}
SERIES = (
    "60, 62, 63, 64, 160, 618, 619, 70, 72, 73, 718, 719, QJ 0 2 3, N NU NJ NUP 2 3 4 10 22 23, "
    "302, 303, 313, 320, 322, 323, 329 to 332"
)


class Designation(NamedTuple):
    """What a designation says: name without suffix, type, bore, outer diameter and width (nan: not known) in m; alpha in rad."""

    name: str
    type: str
    bore: float
    outer: float
    width: float
    contact_angle: float
    reason: str


def outer_diameter(bore: float, series: str) -> float:
    """Outer diameter in m at a bore in m, in a series of diameters of ISO 15; between its bores by line, nan outside of them."""
    table = [pair for pair in zip(_BORES, _OUTER.get(series, ()), strict=False) if pair[1] == pair[1]]
    for (d, outer), (d_next, outer_next) in pairwise(table):
        if d <= 1e3 * bore * (1.0 + 1e-9) and 1e3 * bore <= d_next * (1.0 + 1e-9):
            return 1e-3 * (outer + (outer_next - outer) * (1e3 * bore - d) / (d_next - d))
    return math.nan


def bore_of_code(code: str) -> float:
    """Bore in m of the last two digits of a designation."""
    return 1e-3 * (_BORES[int(code)] if int(code) < 4 else 5.0 * int(code))


def designated(text: str, *, anywhere: bool = False) -> Designation | None:
    """What a text such as 6205, 7218 B, QJ 212, NJ209, 30209 or 51108 says; None where its series or bore is not in the tables.

    Args:
        text: with the designation at its begin.
        anywhere: it may stand further behind too, as in "SKF 6205-2Z".
    """
    text = text[:_LONGEST].strip().upper()
    found = _FORM.search(text) if anywhere else _FORM.match(text)
    series = found["series"].replace(" ", "") if found else ""
    kind, angle, size = _SERIES.get(re.sub("^R?N[UJP]*", "N", series), ("", 0.0, ""))
    if found is None or not kind:
        return None
    bore = bore_of_code(found["code"])
    outer = outer_diameter(bore, size if size in _OUTER else size[-1])
    if 1e3 * bore not in [round(d, 6) for d in _BORES] or math.isnan(outer):
        return None
    width = dict(zip(_BORES, _WIDTH.get(size, ()), strict=False)).get(round(1e3 * bore, 6), math.nan)
    reason = f"series {series}"
    if math.isnan(angle):
        letter = _LETTER.match(found["suffix"])
        angle = _ANGLES[letter[0]] if letter else _NO_LETTER
        reason = f"letter {letter[0]}" if letter else "no letter of an angle"
    return Designation(series + found["code"], kind, bore, outer, 1e-3 * width, math.radians(angle), reason)


def rolling_elements(kind: str, bore: float, outer: float, width: float = math.nan) -> tuple[int, float, float, float]:
    """Estimate number, diameter, pitch diameter and length (0 of balls) in m of what rolls in a bearing of a type."""
    _, share, filled, of_width, of_diameter, _ = _TYPES[kind]
    element = share * (outer - bore)
    if kind in BALLS and not math.isnan(width):
        element = min(element, _WIDEST * width)
    pitch = 0.5 * (outer + bore)
    length = of_diameter * element if math.isnan(width) else of_width * width
    return max(4, round(filled * math.pi * pitch / element)), element, pitch, length


def words_of(kind: str) -> str:
    """A type of bearing in words, in the singular."""
    return _TYPES[kind][-1]


def inner_geometry(designation: str) -> tuple[dict[str, Any], str]:
    """What rolls in a bearing such as 6205, 7218 B, QJ 212, NJ209 or 30209, and where that is published.

    Returns:
        Keys of `rolling` in SI and radians, none for a designation that is not in the tables or of a type that `rolling` does not
        have, and the source; "" of an estimate.
    """
    found = designated(designation)
    kind = _TYPES[found.type][0] if found else ""
    if found is None or not kind:
        return {}, ""
    if found.name in _KNOWN:
        count, *sizes, source = _KNOWN[found.name]
        element, pitch, length = (1e-3 * size for size in sizes)
    else:
        count, element, pitch, length = rolling_elements(found.type, found.bore, found.outer, found.width)
        source = ""
    keys: dict[str, Any] = {"kind": kind, "elements": count, "element_diameter": element, "pitch_diameter": pitch}
    if length:
        keys["length"] = length
    if found.contact_angle:
        keys["contact_angle"] = found.contact_angle
    return keys, source


def bore_of(designation: str | None) -> float | None:
    """Bore in m that a designation says; None of none, or of one that is not in the tables."""
    found = designated(designation) if designation else None
    return found.bore if found else None


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
