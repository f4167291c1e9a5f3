"""Tapered, four-point and paired bearings: sums of single rows, closed forms, and bearings by designation."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.forces.ball_bearing import BallBearing
from rotorgear.forces.designations import designated, inner_geometry
from rotorgear.forces.roller_bearing import RollerBearing
from rotorgear.forces.rolling import LINE_CONTACT
from rotorgear.forces.tapered_bearing import SlicedRollers, TaperedBearing

BALL = BallBearing(12, 14e-3, 77e-3, contact_angle=0.44, clearance=0.0, phase=0.1)
TAPERED = TaperedBearing(17, 14e-3, 10e-3, 65e-3, 0.27, phase=0.1, slices=7)
STATE = np.array([11e-6, -7e-6, 9e-6, 2e-4, -3e-4])


def moved(place: float) -> np.ndarray:
    """Displacements of a row at a place along the shaft from those of the middle of its bearing, (5, 5)."""
    T = np.eye(5)
    T[0, 4] = place
    T[1, 3] = -place
    return T


@pytest.mark.parametrize("single", [BALL, TAPERED], ids=["ball", "tapered"])
@pytest.mark.parametrize(("arrangement", "sides"), [("O", (1, -1)), ("X", (-1, 1)), ("tandem", (1, 1))])
def test_a_pair_is_the_sum_of_its_rows(single, arrangement, sides):
    pair = replace(single, arrangement=arrangement, row_distance=30e-3)
    force = np.zeros(5)
    stiffness = np.zeros((5, 5))
    for place, side in zip((-15e-3, 15e-3), sides, strict=True):
        T = moved(place)
        row = replace(single, contact_angle=side * single.contact_angle).evaluate(T @ STATE)
        force += T.T @ row.force
        stiffness += T.T @ row.in_displacement @ T
    value = pair.evaluate(STATE)
    assert value.force == pytest.approx(force, rel=1e-12)
    assert value.in_displacement == pytest.approx(stiffness, rel=1e-11)
    assert value.in_displacement == pytest.approx(value.in_displacement.T, rel=1e-10)


def test_an_o_arrangement_resists_tilting_more_than_an_x_arrangement():
    tilts = []
    for arrangement in ("O", "X"):
        pair = replace(BALL, arrangement=arrangement, row_distance=30e-3, preload=5e-6)
        tilts.append(pair.evaluate(np.zeros(5)).in_displacement[3, 3])
    # The lines of contact meet the axis at +-(l/2 +- R tan a): the stiffness goes as the square, here (15 + 18)^2 to (15 - 18)^2.
    assert tilts[0] > 10.0 * tilts[1]


def test_preload_of_a_pair_is_the_force_of_each_row_and_doubles_the_axial_stiffness():
    for single in (BALL, TAPERED):
        row = single.pressed_by(800.0)
        pair = replace(single, arrangement="O", row_distance=30e-3).pressed_by(800.0)
        alone = row.evaluate(np.zeros(5))
        both = pair.evaluate(np.zeros(5))
        assert alone.force[2] == pytest.approx(800.0, rel=1e-9)
        assert both.force == pytest.approx(np.zeros(5), abs=1e-7)
        assert both.in_displacement[2, 2] == pytest.approx(2.0 * alone.in_displacement[2, 2], rel=1e-9)


def test_a_four_point_bearing_is_two_diagonals():
    four = replace(BALL, arrangement="four-point")
    both = [replace(BALL, contact_angle=side * BALL.contact_angle).evaluate(STATE).force for side in (1, -1)]
    assert four.evaluate(STATE).force == pytest.approx(sum(both), rel=1e-12)
    # A push along the shaft alone is carried by one of them, as by an angular contact bearing.
    push = np.array([0.0, 0.0, 20e-6, 0.0, 0.0])
    assert four.evaluate(push).force[2] == pytest.approx(BALL.evaluate(push).force[2], rel=1e-12)
    inside = four.inside(push)
    assert set(inside.row[inside.load > 0.0]) == {1}


def test_a_tapered_bearing_under_an_axial_load_has_the_closed_form():
    z = 30e-6
    a = TAPERED.contact_angle
    c = LINE_CONTACT * TAPERED.length ** (8.0 / 9.0)
    F = 17 * np.sin(a) * c * (z * np.sin(a)) ** (10.0 / 9.0)
    value = TAPERED.evaluate([0.0, 0.0, z, 0.0, 0.0])
    assert value.force[2] == pytest.approx(F, rel=1e-12)
    assert value.in_displacement[2, 2] == pytest.approx(10.0 / 9.0 * F / z, rel=1e-12)
    assert replace(TAPERED, contact_angle=-a).evaluate([0.0, 0.0, -z, 0.0, 0.0]).force[2] == pytest.approx(-F)


def test_without_an_angle_it_is_the_cylindrical_bearing_and_resists_tilting():
    sliced = SlicedRollers(6, 13.6e-3, 11e-3, 65e-3, clearance=10e-6, slices=9)
    plain = RollerBearing(6, 13.6e-3, clearance=10e-6)
    d = np.array([9.93244e-6, 0.0, 0.0, 0.0, 0.0])
    assert sliced.evaluate(d).force[:2] == pytest.approx(plain.evaluate(d[:2]).force, rel=1e-12)
    assert sliced.evaluate(d).force[0] == pytest.approx(1000.0, rel=1e-4)
    # Loads vary linearly along the roller: for the softening law the tilting stiffness is that of an area, k L^2/12.
    fine = replace(sliced, slices=200).evaluate(d).in_displacement
    assert fine[4, 4] == pytest.approx(fine[0, 0] * sliced.length**2 / 12.0, rel=1e-4)


def test_slices_converge_with_order_two():
    d = np.array([12e-6, 3e-6, 9e-6, 2e-4, 5e-4])
    exact = replace(TAPERED, slices=200).evaluate(d).force
    errors = [np.abs(replace(TAPERED, slices=n).evaluate(d).force - exact).max() for n in (4, 8, 16)]
    assert errors[0] / errors[2] > 8.0


@pytest.mark.parametrize(
    ("designation", "count", "element", "pitch", "kind", "estimated"),
    [
        ("6211", 10, 14.288, 77.5, "ball", False),
        ("NJ209", 15, 11.0, 65.5, "roller", False),
        ("7218 B", 16, 22.225, 125.26, "ball", False),
        ("QJ 209", 13, 12.0, 65.0, "four-point", True),
        ("30209", 17, 10.0, 65.0, "tapered", True),
    ],
)
def test_a_designation_says_what_rolls(designation, count, element, pitch, kind, estimated):
    found, source = inner_geometry(designation)
    assert (found["elements"], found["kind"], source == "") == (count, kind, estimated)
    assert 1e3 * found["element_diameter"] == pytest.approx(element)
    assert 1e3 * found["pitch_diameter"] == pytest.approx(pitch)


@pytest.mark.parametrize("designation", ["62206", "SKF 6206", "6288", "22210", "51108", "2210", "33102"])
def test_a_designation_that_rolling_elements_do_not_have_is_not_taken_for_one_that_begins_so(designation):
    assert inner_geometry(designation) == ({}, "")


@pytest.mark.parametrize(
    ("designation", "bore", "outer", "width"),
    # Boundary dimensions that makers print.
    [
        ("NU 2208", 40, 80, 23),
        ("NU 220", 100, 180, 34),
        ("N 1012", 60, 95, 18),
        ("NJ 2312", 60, 130, 46),
        ("NUP 415", 75, 190, 45),
        ("6003", 17, 35, 10),
        ("6408", 40, 110, 27),
        ("16012", 60, 95, 11),
        ("61815", 75, 95, 10),
        ("61906", 30, 47, 9),
        ("6224", 120, 215, 40),
        ("7310 BEP", 50, 110, 27),
        ("30313", 65, 140, 33),
        ("32016 X", 80, 125, 29),
        ("33114", 70, 120, 37),
        ("33208", 40, 80, 32),
        ("32915", 75, 105, 20),
        ("22316 E", 80, 170, 58),
        ("1208", 40, 80, 18),
        ("2308", 40, 90, 33),
        ("24026", 130, 200, None),
        ("23928", 140, 190, None),
        ("23236", 180, 320, None),
        ("24122", 110, 180, None),
        ("51112", 60, 85, None),
        ("51210", 50, 78, None),
        ("51315", 75, 135, None),
        ("51416", 80, 170, None),
        ("29420 E", 100, 210, None),
    ],
)
def test_a_designation_has_the_boundary_dimensions_of_its_series(designation, bore, outer, width):
    found = designated("maker's " + designation, anywhere=True)
    assert found is not None
    assert (1e3 * found.bore, 1e3 * found.outer) == (pytest.approx(bore), pytest.approx(outer))
    if width is not None:
        assert 1e3 * found.width == pytest.approx(width)


@pytest.mark.parametrize(
    ("designation", "degrees", "reason"),
    [
        ("7310 CD", 15, "letter C"),
        ("7012-C-T-P4S", 15, "letter C"),
        ("7306 A5", 25, "letter A5"),
        ("7306 ACD", 25, "letter AC"),
        ("7306 A", 30, "letter A"),
        ("7306 AW", 40, "no letter of an angle"),
        ("7306 BECBP", 40, "letter B"),
        ("7306 C3", 40, "no letter of an angle"),
        ("7306 CN", 40, "no letter of an angle"),
        ("71912 E", 25, "letter E"),
    ],
)
def test_the_letters_behind_an_angular_contact_bearing_are_those_of_makers(designation, degrees, reason):
    found = designated(designation)
    assert (math.degrees(found.contact_angle), found.reason) == (pytest.approx(degrees), reason)


def test_rollers_of_wider_bearings_are_longer():
    lengths = [inner_geometry(name)[0]["length"] for name in ("NU 1010", "NU 210", "NU 2210")]
    assert lengths == sorted(lengths)
    assert inner_geometry("32213")[0]["length"] > 1.2 * inner_geometry("30213")[0]["length"]
    # Balls of thin bearings fit between the faces of their rings.
    assert inner_geometry("16014")[0]["element_diameter"] < 0.013


def test_shares_of_the_estimate_are_near_the_bearings_that_are_known():
    from rotorgear.forces import designations

    for name, (count, element, pitch, *_) in list(designations._KNOWN.items()):
        known = dict(designations._KNOWN)
        designations._KNOWN.pop(name)
        try:
            keys, _ = inner_geometry(name)
        finally:
            designations._KNOWN.update(known)
        assert keys["elements"] == pytest.approx(count, abs=1.01)
        assert 1e3 * keys["element_diameter"] == pytest.approx(element, rel=0.1)
        assert 1e3 * keys["pitch_diameter"] == pytest.approx(pitch, rel=0.02)


TEXT = """
[operation]
input_shaft = "rotor"
speed = "3000 rpm"
gravity = ["0 m/s^2", "-9.81 m/s^2", "0 m/s^2"]
[shafts.rotor]
sections = [{ length = "200 mm", outer_diameter = "45 mm" }]
[bearings.front]
shaft = "rotor"
at = "start"
rolling = { %s }
[bearings.rear]
shaft = "rotor"
at = "end"
rolling = { designation = "NJ209", slices = 11 }
[loads.pull]
shaft = "rotor"
at = "60 mm"
force = ["0 N", "-2 kN", "300 N"]
"""


def test_a_pair_by_designation_carries_its_shaft_and_says_what_is_estimated():
    model = rg.loads(TEXT % 'designation = "30209", arrangement = "O", row_distance = "25 mm", preload_force = "500 N"')
    sheet = rg.bearing(model, "front", stability=False, speeds=["3000 rpm"])
    assert sheet.law == "tapered roller bearing"
    assert {row.row for row in sheet.rolling_elements} == {1, 2}
    assert sheet.bearing_load[2] == pytest.approx(300.0, rel=1e-9)
    assert any("elements estimated" in note for note in sheet.warnings)
    assert not any("NJ209" in note for note in sheet.warnings)


def test_given_elements_take_the_place_of_estimated_ones_and_a_published_angle_is_said():
    given = 'designation = "6210", elements = 11, element_diameter = "12.7 mm", pitch_diameter = "70.5 mm"'
    law = rg.loads(TEXT % given).bearings["front"].rolling
    assert (law.elements, law.element_diameter, law.pitch_diameter) == pytest.approx((11, 12.7e-3, 70.5e-3))
    assert law.estimate == ("", "", "")
    angular = rg.loads(TEXT % 'designation = "7310 CD"').bearings["front"].rolling
    assert "15 deg (letter C)" in angular.estimate[2]
    assert "elements estimated" in angular.estimate[0]
    known = rg.loads(TEXT % 'designation = "7218"').bearings["front"].rolling
    assert known.estimate[2] == "7218: 40 deg (no letter of an angle)"


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        ('designation = "1209"', "got '1209', expected a designation of the series .* self-aligning ball bearing"),
        ('designation = "6288"', r"front\.rolling\.designation: got '6288', expected a designation of the series"),
        ('designation = "6210", element_diameter = "21 mm", elements = 8', "between its bore 50 mm and outside 90 mm"),
        ('designation = "6211", elements = 9', "10 as 6211 has it"),
        ('designation = "7218 B", arrangement = "O"', "row_distance"),
        ('designation = "6211", arrangement = "X", row_distance = "20 mm"', "with their contact_angle"),
        ('designation = "6211", slices = 4', "slices of a roller"),
        (
            'kind = "tapered", elements = 17, element_diameter = "10 mm", pitch_diameter = "65 mm", length = "14 mm"',
            "an angle of a tapered bearing",
        ),
    ],
)
def test_what_does_not_go_together_is_refused(keys, said):
    with pytest.raises(rg.RotorgearError, match=said):
        rg.loads(TEXT % keys)


def test_another_designation_fills_again_what_the_former_one_filled():
    model = rg.loads(TEXT % 'designation = "6209", clearance_class = "C3"')
    ball = model.with_("bearings.front.rolling.designation", "6211").bearings["front"].rolling
    assert ball == rg.loads(TEXT % 'designation = "6211", clearance_class = "C3"').bearings["front"].rolling
    assert (model.bearings["front"].rolling.bore, ball.bore) == (0.045, 0.055)
    # What the file says stays.
    given = rg.loads(TEXT % 'designation = "6210", elements = 11').with_("bearings.front.rolling.designation", "6212")
    assert given == rg.loads(TEXT % 'designation = "6212", elements = 11')


@pytest.mark.parametrize(
    ("designation", "diameters", "warned"),
    [
        ("6209", (45, 45), False),
        ("6209", (45, 50), False),
        ("6209", (50, 45), False),
        ("6209", (44.5, 44.5), False),
        ("6210", (45, 45), True),
        ("6210", (45, 55), True),
    ],
)
def test_a_bore_that_does_not_fit_its_seat_is_warned_of(designation, diameters, warned):
    left, right = (f'{{ length = "100 mm", outer_diameter = "{d} mm" }}' for d in diameters)
    text = TEXT.replace('{ length = "200 mm", outer_diameter = "45 mm" }', f"{left}, {right}")
    text = text.replace('at = "start"', 'at = "100 mm"') % f'designation = "{designation}"'
    said = [str(note) for note in rg.check(rg.loads(text)).warnings]
    assert any("front.rolling.designation (a bore of 50 mm on a shaft of" in note for note in said) == warned


def test_a_bore_beside_another_designation_is_refused():
    with pytest.raises(rg.ModelError, match="bore: got 40 mm beside designation = '6209', expected 45 mm"):
        rg.loads(TEXT % 'designation = "6209", clearance_class = "C3", bore = "40 mm"')


@pytest.mark.parametrize("row", [TAPERED, replace(TAPERED, contact_angle=-0.4, preload=6e-6, clearance=4e-6)])
def test_loads_inside_add_up_to_the_force_and_press_as_cylinders_on_the_cones_of_their_raceways(row):
    inside = row.inside(STATE)
    a, side = abs(row.contact_angle), np.sign(row.contact_angle)
    phi = 0.1 + 2.0 * np.pi * np.arange(17) / 17
    way = np.array([np.cos(a) * np.cos(phi), np.cos(a) * np.sin(phi), np.full(17, side * np.sin(a))])
    assert way @ inside.load == pytest.approx(row.evaluate(STATE).force[:3], rel=1e-12)
    # Of seven slices the middles of the outer ones are 3/7 of the length off the middle of the roller.
    psi = STATE[3] * np.sin(phi) - STATE[4] * np.cos(phi)
    played = 0.5 * row.clearance * np.cos(a) - row.preload * np.sin(a)
    middle = STATE[:3] @ way + psi * side * 0.5 * row.pitch_diameter * np.sin(a) - played
    worst = middle + np.abs(psi) * 3.0 / 7.0 * row.length
    per_length = LINE_CONTACT * row.length ** (-1.0 / 9.0) * np.maximum(worst, 0.0) ** (10.0 / 9.0)
    assert 0 < np.count_nonzero(inside.load) < 17
    for pressure, outward in ((inside.inner_pressure, -1.0), (inside.outer_pressure, 1.0)):
        # In the plane across the roller its raceway has the radius of the cone, convex inside and concave outside.
        cone = (0.5 * row.pitch_diameter + outward * 0.5 * row.roller_diameter * np.cos(a)) / np.cos(a)
        curvature = 2.0 / row.roller_diameter - outward / cone
        hertz = np.sqrt(per_length * curvature * 210e9 / (1.0 - 0.3**2) / (2.0 * np.pi))
        assert pressure == pytest.approx(hertz, rel=1e-12)
