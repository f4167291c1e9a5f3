"""Quantities at the border: numbers are SI, texts carry a unit, and nothing else gets in."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rotorgear.common_units import COMMON_UNITS
from rotorgear.quantity import DIMENSIONS, QuantityError, _factor_by_pint, counted, millimetres, nearest, parse_quantity


@pytest.mark.parametrize(
    ("text", "dimension", "value"),
    [
        ("2.75 mm", "length", 0.00275),
        ("-274mm", "length", -0.274),
        (" .5 m ", "length", 0.5),
        ("25.4 µm", "length", 25.4e-6),
        ("25.4 μm", "length", 25.4e-6),
        ("1 in", "length", 0.0254),
        ("25 deg", "angle", math.radians(25)),
        ("25 °", "angle", math.radians(25)),
        ("100 gon", "angle", math.pi / 2),
        ("16350 rpm", "speed", 16350 * math.pi / 30),
        ("60 1/min", "speed", 2 * math.pi),
        ("2 rev/s", "speed", 4 * math.pi),
        ("1 rad/s", "speed", 1.0),
        ("361 Hz", "frequency", 361.0),
        ("60 cpm", "frequency", 1.0),
        ("2 kHz", "frequency", 2000.0),
        ("206 GPa", "modulus", 206e9),
        ("206 kN/mm²", "modulus", 206e9),
        ("210000 N/mm2", "modulus", 210e9),
        ("7.85 g/cm^3", "density", 7850.0),
        ("7850 kg m^-3", "density", 7850.0),
        ("2.5 MW", "power", 2.5e6),
        ("120 Nm", "torque", 120.0),
        ("3 kN m", "torque", 3000.0),
        ("5 Nmm", "torque", 0.005),
        ("2e8 N/m", "stiffness", 2e8),
        ("20 N/µm", "stiffness", 2e7),
        ("1 N m/deg", "rotational_stiffness", 180 / math.pi),
        ("1e5 Nm", "rotational_stiffness", 1e5),
        ("500 N s/m", "damping", 500.0),
        ("2 N m s/rad", "rotational_damping", 2.0),
        ("0.02 kg m^2", "inertia", 0.02),
        ("0.02 kg·m**2", "inertia", 0.02),
        ("12 1/s", "rate", 12.0),
        ("20 us", "time", 2e-5),
        ("5 %", "ratio", 0.05),
        ("0.05", "ratio", 0.05),
        ("45 degC", "temperature", 318.15),
        ("-10 °C", "temperature", 263.15),
        ("300 K", "temperature", 300.0),
        ("113 degF", "temperature", 318.15),
        ("1.9 kJ/(kg K)", "specific_heat", 1900.0),
    ],
)
def test_a_text_is_read_with_its_unit(text: str, dimension: str, value: float) -> None:
    assert parse_quantity(text, dimension) == pytest.approx(value, rel=1e-14)


@pytest.mark.parametrize("dimension", DIMENSIONS)
def test_every_example_is_a_quantity_of_its_dimension(dimension: str) -> None:
    assert math.isfinite(parse_quantity(DIMENSIONS[dimension].example, dimension))


def test_common_units_are_those_of_pint() -> None:
    # To 1 ulp or so: releases of pint multiply the same definitions in other orders.
    for dimension, units in COMMON_UNITS.items():
        for unit, factor in units.items():
            assert _factor_by_pint(unit, DIMENSIONS[dimension]) == pytest.approx(factor, rel=4e-16, abs=0.0), unit


def test_every_dimension_has_common_units_or_a_table_of_its_own() -> None:
    assert set(DIMENSIONS) == {*COMMON_UNITS, "speed", "frequency", "temperature", "ratio"}


@pytest.mark.parametrize("dimension", DIMENSIONS)
def test_no_example_is_taken_for_another_dimension(dimension: str) -> None:
    shared = {("frequency", "rate"), ("speed", "frequency")}  # Hz is 1/s; rpm are cycles per minute
    shared |= {("torque", "rotational_stiffness")}  # the radian may be left out
    for other, wanted in DIMENSIONS.items():
        if other != dimension and (other, dimension) not in shared and other != "ratio":
            with pytest.raises(QuantityError):
                parse_quantity(wanted.example, dimension)


@pytest.mark.parametrize("value", [0, 1.5, -3, np.float64(2.5), np.int64(7), Fraction(1, 4)])
def test_a_plain_number_is_si(value: Any) -> None:
    result = parse_quantity(value, "length")
    assert type(result) is float
    assert result == float(value)


@pytest.mark.parametrize("value", [True, None, [1.0], {}, b"1 mm", np.bool_(True), 1j])
def test_other_types_are_no_quantities(value: Any) -> None:
    with pytest.raises(QuantityError, match=r"^a length such as '20 mm'$"):
        parse_quantity(value, "length")


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, 10**400, "1e400 mm", 1e31, "1e300 mm"])
def test_numbers_that_calculations_can_not_bear_are_refused(value: Any) -> None:
    with pytest.raises(QuantityError, match=r"a (finite number|number of sensible size): a length such as '20 mm'"):
        parse_quantity(value, "length")


@pytest.mark.parametrize(
    ("text", "dimension"),
    [
        ("20 mm", "angle"),
        ("20 %", "angle"),
        ("50 Hz", "speed"),
        ("5 m %", "length"),
        ("5 m rad", "length"),
        ("20 m2", "length"),
        ("120 N m/rad", "torque"),
        ("12 rpm", "rate"),
        ("5 degC", "angle"),
        ("5 gpa", "modulus"),
        ("5 1", "length"),
        ("mm", "length"),
        ("", "length"),
        ("1 + 1 mm", "length"),
        ("2*3 mm", "length"),
        ("5 (m", "length"),
        ("0x10 mm", "length"),
        ("5 __import__", "length"),
        ("nan mm", "length"),
        ("inf mm", "length"),
        ("1 mm 2 mm", "length"),
        ("٣ mm", "length"),
    ],
)
def test_a_text_of_another_kind_is_refused(text: str, dimension: str) -> None:
    with pytest.raises(QuantityError, match=r"^an? .* such as '"):
        parse_quantity(text, dimension)


def test_a_unit_is_never_calculated_with() -> None:
    for bomb in ("1 10**10**10 m", "1 9**9**9**9*m", "1 " + "(" * 20000 + "m", "1 m^99999"):
        with pytest.raises(QuantityError):
            parse_quantity(bomb, "length")


def test_the_remedy_is_named_where_it_can_be_guessed() -> None:
    for text, remedy in [("2,75 mm", "decimals take a point"), ("20", "a number in SI stands without quotes")]:
        with pytest.raises(QuantityError, match=remedy):
            parse_quantity(text, "length")
    with pytest.raises(QuantityError, match=r"units: rpm, 1/min, rev/min, rev/s, rad/s, deg/s"):
        parse_quantity("50 Hz", "speed")


@given(st.text(max_size=30), st.sampled_from(list(DIMENSIONS)))
@settings(max_examples=200, deadline=None)
def test_no_text_gives_anything_but_a_finite_number_or_a_quantity_error(text: str, dimension: str) -> None:
    for candidate in (text, f"1 {text}"):
        try:
            result = parse_quantity(candidate, dimension)
        except QuantityError:
            continue
        assert math.isfinite(result)


def test_the_nearest_name_ignores_capitals_and_is_empty_for_a_stranger() -> None:
    names = ["helix_angle", "hand", "width"]
    assert nearest("Helix_Angel", names) == "helix_angle"
    assert nearest("HAND", names) == "hand"
    assert nearest("colour", names) == ""
    assert nearest("x", []) == ""


def test_lengths_are_written_in_millimetres_without_a_negative_zero() -> None:
    assert [millimetres(z) for z in (0.0275, -0.0, -0.274, 1e3)] == ["27.5 mm", "0 mm", "-274 mm", "1e+06 mm"]


@pytest.mark.parametrize(
    ("number", "what", "words"),
    [
        (1, "slices", "1 slice"),
        (1, "meshes", "1 mesh"),
        (1, "point_masses", "1 point mass"),
        (1, "branches", "1 branch"),
        (1, "frequencies", "1 frequency"),
        (0, "meshes", "0 meshes"),
        (2, "frequencies", "2 frequencies"),
    ],
)
def test_one_of_a_thing_is_no_plural(number: int, what: str, words: str) -> None:
    assert counted(number, what) == words
