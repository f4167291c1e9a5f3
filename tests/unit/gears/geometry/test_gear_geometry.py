"""Geometry of single gears against printed and independently computed numbers, textbook tables and identities."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import pytest

from rotorgear.errors import AnalysisError
from rotorgear.gears.geometry.geometry import GearGeometry, check_gear, inverse_involute, involute
from rotorgear.gears.geometry.pair import (
    pair_geometry,
)

MM = 1e-3
deg = math.radians


def gear(
    teeth: int, module_mm: float = 1.0, pressure_deg: float = 20.0, helix_deg: float = 0.0, **more: float
) -> GearGeometry:
    return GearGeometry(teeth, module_mm * MM, deg(pressure_deg), deg(helix_deg), **more)


@pytest.mark.parametrize(
    ("teeth", "module", "base_radius"),
    [(29, 2.75, 0.04054040103), (113, 2.75, 0.1579677695), (26, 4.25, 0.05617196632), (125, 4.25, 0.2700575304)],
)
def test_the_split_torque_gears_have_the_frozen_base_radii_and_angles(
    teeth: int, module: float, base_radius: float
) -> None:
    g = gear(teeth, module, 25, 30)
    assert g.base_radius == pytest.approx(base_radius, rel=5e-10)
    assert math.degrees(g.transverse_pressure_angle) == pytest.approx(28.30005243, abs=5e-9)
    assert math.degrees(g.base_helix_angle) == pytest.approx(26.94621526, abs=5e-9)
    assert check_gear(g) == []


def test_the_iso_6336_example_has_its_thirty_digit_gear_data(iso_pair: tuple[GearGeometry, GearGeometry]) -> None:
    pinion, wheel = iso_pair
    found = [pinion.reference_diameter, wheel.reference_diameter, 2 * pinion.base_radius, 2 * wheel.base_radius]
    assert [d / MM for d in found] == pytest.approx(
        [141.340113066, 856.354802697, 132.198569201, 800.967801631], rel=1e-9
    )
    assert math.degrees(pinion.transverse_pressure_angle) == pytest.approx(20.7197117659, rel=1e-9)
    assert math.degrees(pinion.base_helix_angle) == pytest.approx(14.824534684, rel=1e-9)
    assert pinion.transverse_base_pitch / MM == pytest.approx(24.4302384599, rel=1e-9)
    assert (pinion.virtual_teeth, wheel.virtual_teeth) == pytest.approx((18.9051229999, 114.542804058), rel=1e-9)
    assert pinion.base_tangent_length(3) / MM == pytest.approx(61.9631938018, rel=1e-9)


# Fewest full-depth spur teeth that a rack doesn't undercut: 2 / sin^2(pressure angle), rounded up; same source.
@pytest.mark.parametrize(("pressure", "fewest"), [(14.5, 32), (20.0, 18), (25.0, 12)])
def test_undercut_starts_at_the_textbook_tooth_number(pressure: float, fewest: int) -> None:
    assert not gear(fewest, pressure_deg=pressure).is_undercut
    assert gear(fewest - 1, pressure_deg=pressure).is_undercut
    assert any("undercut" in text for text in check_gear(gear(fewest - 1, pressure_deg=pressure)))


def test_at_the_minimum_profile_shift_the_rack_flank_ends_on_the_base_tangent_point() -> None:
    g = gear(9, 2, 20, 25)
    g = dataclasses.replace(g, profile_shift=g.minimum_profile_shift)
    depth = g.normal_module * (g.addendum_factor - g.profile_shift)
    roll_below_pitch_point = depth / math.sin(g.transverse_pressure_angle)
    assert roll_below_pitch_point == pytest.approx(g.base_radius * math.tan(g.transverse_pressure_angle), rel=1e-13)
    assert not g.is_undercut


def test_tooth_thickness_follows_the_string_construction_of_the_involute() -> None:
    g = gear(21, 4, 20, 18, profile_shift=0.2)

    def polar(unwound: float) -> tuple[float, float]:
        x = g.base_radius * (math.cos(unwound) + unwound * math.sin(unwound))
        y = g.base_radius * (math.sin(unwound) - unwound * math.cos(unwound))
        return 2 * math.hypot(x, y), math.atan2(y, x)

    (d1, angle1), (d2, angle2) = polar(0.3), polar(0.7)
    lost = g.transverse_thickness(d1) / d1 - g.transverse_thickness(d2) / d2
    assert lost == pytest.approx(angle2 - angle1, rel=1e-12)
    reference = g.transverse_module * (math.pi / 2 + 2 * 0.2 * math.tan(deg(20)))
    assert g.transverse_thickness(g.reference_diameter) == pytest.approx(reference, rel=1e-13)


def test_teeth_are_reported_as_pointed_exactly_where_the_flanks_cross() -> None:
    g = gear(20, 2)
    cross = 2 * g.base_radius / math.cos(inverse_involute(math.pi / 2 / 20 + involute(deg(20))))
    below, above = (dataclasses.replace(g, tip_diameter=cross * f) for f in (0.999, 1.001))
    assert below.normal_tip_thickness > 0 > above.normal_tip_thickness
    assert "pointed below the tip diameter" in check_gear(above)[0]
    assert "nearly pointed" in check_gear(below)[0]


def test_tip_thickness_across_a_helical_tooth_uses_the_helix_angle_at_the_tip() -> None:
    g = gear(29, 2.75, 25, 30)
    at_tip = math.atan(math.pi * g.effective_tip_diameter / g.lead)
    assert g.normal_tip_thickness == pytest.approx(g.transverse_tip_thickness * math.cos(at_tip), rel=1e-13)


def test_a_spur_gear_is_the_limit_without_helix() -> None:
    g = gear(34, 5)
    assert (g.lead, g.base_helix_angle, g.virtual_teeth) == (math.inf, 0.0, 34.0)
    assert pair_geometry(g, gear(80, 5), 0.05).overlap_ratio == 0.0
    assert (g.effective_tip_diameter / MM, g.root_diameter / MM) == pytest.approx((180.0, 157.5), rel=1e-14)


def test_the_tip_diameter_follows_the_profile_shift_unless_it_is_given() -> None:
    assert gear(20, 2, profile_shift=0.5).effective_tip_diameter / MM == pytest.approx(46.0)
    assert gear(20, 2, profile_shift=0.5, tip_diameter=0.045).effective_tip_diameter == 0.045


def test_a_profile_shift_moves_tip_and_root_outwards_together() -> None:
    plain = gear(20, 2)
    shifted = gear(20, 2, profile_shift=0.5)
    assert (shifted.root_diameter - plain.root_diameter) / MM == pytest.approx(2.0)
    assert (shifted.effective_tip_diameter - shifted.root_diameter) / MM == pytest.approx(2 * 2 * 2.25)


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"teeth": 0}, "whole number of teeth"),
        ({"teeth": 17.5}, "whole number of teeth"),
        ({"normal_module": 0.0}, "normal module"),
        ({"normal_pressure_angle": math.pi / 2}, "normal pressure angle"),
        ({"helix_angle": -0.1}, "hand is given apart"),
        ({"profile_shift": math.nan}, "profile shift"),
        ({"tip_diameter": -0.1}, "tip diameter"),
        ({"addendum_factor": 0.0}, "addendum factor"),
    ],
)
def test_values_without_meaning_are_refused_by_name(values: dict[str, Any], words: str) -> None:
    with pytest.raises(AnalysisError, match=words):
        dataclasses.replace(gear(20, 2), **values)


@pytest.mark.parametrize(
    ("g", "words"),
    [
        (gear(2), "root diameter"),
        (gear(40, tip_diameter=37 * MM), "there is no tooth"),
        (gear(6, tip_diameter=5 * MM), "no flank is left"),
    ],
)
def test_circles_in_the_wrong_order_are_reported_alone(g: GearGeometry, words: str) -> None:
    (text,) = check_gear(g)
    assert words in text
