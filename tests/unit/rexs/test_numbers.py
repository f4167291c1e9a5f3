"""Numbers of an import that differ: all units of the table, speeds stated on any shaft, and estimates of bearings by hand."""

from __future__ import annotations

import math
import re
from pathlib import Path

import pytest

import rotorgear as rg
from rotorgear.forces.designations import rolling_elements
from rotorgear.rexs.bearings import estimated
from rotorgear.rexs.document import FACTORS, Value, factor_of
from tests.unit.rexs.documents import changed, sample, write_json

_PREFIX = {"": 1.0, "M": 1e6, "k": 1e3, "d": 1e-1, "c": 1e-2, "m": 1e-3, "mu": 1e-6, "u": 1e-6, "G": 1e9}
_SYMBOL = {"m": 1.0, "N": 1.0, "Pa": 1.0, "W": 1.0, "g": 1e-3, "s": 1.0, "rad": 1.0}
_WORD = {
    "": 1.0,
    "1": 1.0,
    "min": 60.0,
    "deg": math.radians(1.0),
    "°": math.radians(1.0),
    "degree": math.radians(1.0),
    "in": 25.4e-3,
    "inch": 25.4e-3,
    "t": 1e3,
    "%": 0.01,
}
# What turns once: a number of turns a second is an angle of 2 pi in it.
_TURNS = {
    "1/min": "2pi/min",
    "rpm": "2pi/min",
    "rev/min": "2pi/min",
    "min^-1": "2pi/min",
    "1/s": "2pi/s",
    "Hz": "2pi/s",
}


def _of_symbol(text: str) -> float:
    if text in _WORD:
        return _WORD[text]
    for name, size in _SYMBOL.items():
        prefix = text.removesuffix(name)
        if prefix != text and prefix in _PREFIX:
            return _PREFIX[prefix] * size
    raise AssertionError(f"no symbol {text!r}")


def _in_si(unit: str) -> float:
    """A unit read symbol by symbol."""
    size = 1.0
    for place, product in enumerate(unit.split("/")):
        for text in re.findall(r"2pi|kg(?=m)|kN|MN|N(?=m|$)|[^\d^]+(?:\^\d)?|1", product) or [""]:
            symbol, _, power = text.partition("^")
            value = 2.0 * math.pi if symbol == "2pi" else _of_symbol(symbol) ** int(power or 1)
            size *= 1.0 / value if place else value
    return size


@pytest.mark.parametrize("kind", FACTORS)
def test_every_unit_of_the_table_is_the_product_of_its_symbols(kind: str) -> None:
    for unit, factor in FACTORS[kind].items():
        expected = _in_si(_TURNS.get(unit, unit) if kind == "speed" else unit)
        assert factor == pytest.approx(expected, rel=1e-14), unit


@pytest.mark.parametrize(
    ("kind", "unit", "in_si"),
    [
        ("length", "µm", 1e-6),
        ("angle", "º", math.pi / 180.0),
        ("speed", "1 / min", math.pi / 30.0),
        ("rotational_stiffness", "N mm / °", 0.18 / math.pi),
        ("modulus", "N / mm²", 1e6),
        ("density", "kg / dm³", 1e3),
        ("inertia", "kg * mm^2", 1e-6),
        # Without a unit it is that of the database of REXS.
        ("length", "", 1e-3),
        ("angle", "none", math.pi / 180.0),
        ("speed", "-", math.pi / 30.0),
        ("force", "", 1.0),
        ("rating", "", 1e3),
        ("torque", "", 1.0),
        ("power", "", 1e3),
        ("stiffness", "", 1.0),
        ("rotational_stiffness", "", 1e-3),
        ("modulus", "", 1e6),
        ("density", "", 1e3),
        ("mass", "", 1.0),
        ("inertia", "", 1.0),
        ("ratio", "", 1.0),
    ],
)
def test_spellings_of_a_unit_and_no_unit_at_all(kind: str, unit: str, in_si: float) -> None:
    assert factor_of(kind, unit) == pytest.approx(in_si, rel=1e-14)


# Shafts of the sample, and their speeds over that of the first: three stages, each of which turns the other way.
TURNS = {"4": 1.0, "5": -23 / 67, "36": 23 / 67 * 13 / 76, "54": -23 / 67 * 13 / 76 * 14 / 87}


@pytest.mark.parametrize("stated", TURNS)
@pytest.mark.parametrize("rpm", [37.0, -1400.0])
def test_a_speed_on_any_shaft_is_that_of_the_whole_train(stated: str, rpm: float, tmp_path: Path) -> None:
    document = changed(sample(), "4", rotational_speed=None)
    document = changed(document, stated, rotational_speed=Value(rpm, "1 / min"))
    result = rg.import_rexs(write_json(document, tmp_path / "gearbox.rexsj"))
    model = rg.loads(result.toml)
    found = {row.name: row.speed_rpm for row in rg.check(model).shafts}
    names = dict(zip(TURNS, model.shafts, strict=True))
    for number, turns in TURNS.items():
        assert found[names[number]] == pytest.approx(rpm * turns / TURNS[stated], rel=1e-9)


def test_of_several_speeds_the_shaft_that_defines_it_counts(tmp_path: Path) -> None:
    document = changed(sample(), "4", rotational_speed=Value(900.0, "1 / min"), defines_speed=Value("false"))
    document = changed(document, "36", rotational_speed=Value(-50.0, "1 / min"), defines_speed=Value("true"))
    said = rg.check(rg.loads(rg.import_rexs(write_json(document, tmp_path / "gearbox.rexsj")).toml))
    assert said.shafts[0].speed_rpm == pytest.approx(-50.0 / TURNS["36"], rel=1e-9)


SIZE = (0.05, 0.09, 0.02, "dimensions in the file")


@pytest.mark.parametrize("ratings", [(None, None), (47e3, None), (None, 61e3), (47e3, 61e3)])
@pytest.mark.parametrize("degrees", [0.0, 14.0, 40.0, 60.0, 90.0])
@pytest.mark.parametrize("kind", ["deep groove", "cylindrical"])
def test_an_estimate_is_kramers_formula_with_the_static_ratings_of_iso_76(
    kind: str, degrees: float, ratings: tuple[float | None, float | None]
) -> None:
    radial, axial, *_ = estimated(kind, SIZE, ratings, math.radians(degrees), "of the file")
    Z, D, pitch, length = rolling_elements(kind, *SIZE[:3])
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    working = math.radians(degrees or 15.0)
    if kind == "deep groove":
        mm = 1e3 * D
        across = ratings[0] or 12.3 * Z * mm**2 * c
        along = ratings[1] or 49.0 * Z * mm**2 * s

        def stiffness(load: float, direction: float) -> float:
            return 13e6 * Z ** (2 / 3) * D ** (1 / 3) * load ** (1 / 3) * direction ** (5 / 3)

        stribeck = 4.37 ** (2 / 3)
    else:
        area = Z * (1.0 - D * c / pitch) * 1e6 * length * D
        across = ratings[0] or 44.0 * area * c
        along = ratings[1] or 220.0 * area * s

        def stiffness(load: float, direction: float) -> float:
            return 1.0e9 * Z**0.9 * length**0.8 * load**0.1 * direction**1.9

        stribeck = 4.08**0.9
    thrust = stribeck * stiffness(0.1 * along, math.sin(working))
    held = stiffness(0.1 * across, c)
    twice = 2.0 * math.tan(working) ** 2
    if degrees == 90.0:
        assert (radial, axial) == (0.0, pytest.approx(thrust, rel=1e-9))
    elif degrees == 60.0:
        assert (radial, axial) == (pytest.approx(thrust / twice, rel=1e-9), pytest.approx(thrust, rel=1e-9))
    else:
        assert radial == pytest.approx(held, rel=1e-9)
        assert axial == pytest.approx(thrust if ratings[1] else twice * held, rel=1e-9)


# Number of a gear of the sample, its teeth, normal module in mm, helix angle in degrees and profile shift.
GEARS = [("23", 23, 1.0, 30.0, 0.581), ("52", 76, 1.25, 10.0, -0.094)]


@pytest.mark.parametrize(("number", "teeth", "module", "helix", "shift"), GEARS)
@pytest.mark.parametrize(
    ("addendum", "dedendum", "tip_taken", "root_taken"),
    [(0.8, 1.4, True, True), (2.7, 1.0, False, True), (-0.5, 2.7, False, False), (1.3, 0.4, True, False)],
)
def test_diameters_of_tip_and_root_count_where_a_tooth_can_have_them(
    number: str,
    teeth: int,
    module: float,
    helix: float,
    shift: float,
    addendum: float,
    dedendum: float,
    tip_taken: bool,
    root_taken: bool,
    tmp_path: Path,
) -> None:
    reference = teeth * module / math.cos(math.radians(helix))
    tip = reference + 2.0 * module * (addendum + shift)
    root = reference - 2.0 * module * (dedendum - shift)
    document = changed(sample(), number, tip_diameter=Value(tip, "mm"), root_diameter=Value(root, "mm"))
    result = rg.import_rexs(write_json(document, tmp_path / "gearbox.rexsj"))
    gear = next(gear for name, gear in rg.loads(result.toml).gears.items() if name.endswith(f"_{number}"))
    assert gear.tip_diameter == (pytest.approx(1e-3 * tip, rel=1e-9) if tip_taken else None)
    assert gear.dedendum_factor == pytest.approx(dedendum if root_taken else 1.25, rel=1e-9)
    said = {item.address.rpartition(".")[2] for item in result.assumptions if f"_{number}." in item.address}
    assert ("tip_diameter" in said, "dedendum_factor" in said) == (not tip_taken, not root_taken)


@pytest.mark.parametrize("mirrored", [False, True])
def test_a_positive_helix_angle_is_a_right_hand(mirrored: bool, tmp_path: Path) -> None:
    document = sample()
    key = "helix_angle_reference_diameter"
    angles = {}
    for gear in document.of_type("cylindrical_gear"):
        given = gear.attributes[key]
        angle = float(str(given.raw))
        angles[gear.id] = -angle if mirrored else angle
        document = changed(document, gear.id, **{key: Value(angles[gear.id], given.unit)})
    gears = rg.loads(rg.import_rexs(write_json(document, tmp_path / "gearbox.rexsj")).toml).gears
    assert len(gears) == len(angles) == 6
    for name, gear in gears.items():
        angle = angles[name.rpartition("_")[2]]
        assert gear.hand == ("right" if angle > 0.0 else "left")
        assert gear.helix_angle == pytest.approx(math.radians(abs(angle)), rel=1e-9)
