"""Geometry of gear pairs against printed and independently computed numbers, textbook tables and identities."""

from __future__ import annotations

import math

import pytest

from rotorgear.errors import AnalysisError
from rotorgear.gears.geometry.geometry import GearGeometry, check_gear
from rotorgear.gears.geometry.pair import (
    pair_geometry,
    profile_shift_sum,
    standard_centre_distance,
    working_centre_distance,
    working_pressure_angle_from_centre,
    working_pressure_angle_from_shifts,
)

MM = 1e-3
deg = math.radians


def gear(
    teeth: int, module_mm: float = 1.0, pressure_deg: float = 20.0, helix_deg: float = 0.0, **more: float
) -> GearGeometry:
    return GearGeometry(teeth, module_mm * MM, deg(pressure_deg), deg(helix_deg), **more)


# Printed digits of the systems 001, 003, 004: teeth, module, helix, width; base radii, distance, both contact ratios.
PRINTED_PAIRS = [
    ((22, 41), 5, 22.0, 120, (55.217, 102.905), 169.869, 1.488, 2.862),
    ((17, 44), 6, 24.43, 75, (52.013, 134.622), 200.996, 1.431, 1.646),
    ((34, 80), 5, 20.86, 54, (84.760, 199.435), 304.991, 1.587, 1.224),
    ((30, 72), 5, 33.27, 54, (82.247, 197.394), 304.989, 1.335, 1.886),
]


@pytest.mark.parametrize(("teeth", "module", "helix", "width", "base", "distance", "eps_a", "eps_b"), PRINTED_PAIRS)
def test_the_published_pairs_have_their_printed_geometry(
    teeth: tuple[int, int],
    module: float,
    helix: float,
    width: float,
    base: tuple[float, float],
    distance: float,
    eps_a: float,
    eps_b: float,
) -> None:
    g1, g2 = (gear(z, module, 20, helix) for z in teeth)
    pair = pair_geometry(g1, g2, width * MM)
    assert (g1.base_radius / MM, g2.base_radius / MM) == pytest.approx(base, abs=5.1e-4)
    assert pair.centre_distance / MM == pytest.approx(distance, abs=5e-4)
    assert pair.transverse_contact_ratio == pytest.approx(eps_a, abs=5e-4)
    assert pair.overlap_ratio == pytest.approx(eps_b, abs=5e-4)
    assert pair.total_contact_ratio == pair.transverse_contact_ratio + pair.overlap_ratio
    assert not pair.interference


def test_the_pairs_001_003_and_004_have_their_remaining_printed_values() -> None:
    assert gear(22, 5, 20, 22).reference_diameter / MM == pytest.approx(118.64, abs=5e-3)
    assert gear(41, 5, 20, 22).reference_diameter / MM == pytest.approx(221.10, abs=5e-3)
    assert math.degrees(gear(17, 6, 20, 24.43).transverse_pressure_angle) == pytest.approx(21.790, abs=5e-4)
    a = pair_geometry(gear(34, 5, 20, 20.86), gear(80, 5, 20, 20.86), 50 * MM)
    b = pair_geometry(gear(30, 5, 20, 33.27), gear(72, 5, 20, 33.27), 50 * MM)
    assert (a.transverse_contact_ratio, b.transverse_contact_ratio) == pytest.approx((1.5866, 1.3350), abs=5e-5)
    assert a.overlap_ratio == pytest.approx(1.13, abs=5e-3)
    assert 1.74 <= b.overlap_ratio < 1.75


def test_the_iso_6336_example_has_its_thirty_digit_pair_data(iso_pair: tuple[GearGeometry, GearGeometry]) -> None:
    pair = pair_geometry(*iso_pair, width=0.1, centre_distance=0.5)
    assert standard_centre_distance(*iso_pair) / MM == pytest.approx(498.847457882, rel=1e-9)
    assert math.degrees(pair.working_transverse_pressure_angle) == pytest.approx(21.0660998047, rel=1e-9)
    assert profile_shift_sum(*iso_pair, 0.5) == pytest.approx(0.145222093651, rel=1e-9)
    assert (pair.end_of_contact - pair.start_of_contact) / MM == pytest.approx(37.8446404628, rel=1e-9)
    assert pair.transverse_contact_ratio == pytest.approx(1.54909009689, rel=1e-9)
    assert pair.overlap_ratio == pytest.approx(1.08336868057, rel=1e-9)
    assert abs(pair.transverse_backlash) < 1e-11  # the shift is given to 12 digits
    assert check_gear(iso_pair[0]) == check_gear(iso_pair[1]) == []


@pytest.mark.parametrize("shift", [-0.3, 0.0, 0.4])
def test_the_centre_distance_and_the_sum_of_shifts_invert_each_other(shift: float) -> None:
    g1 = gear(23, 3, 20, 15, profile_shift=shift)
    g2 = gear(57, 3, 20, 15, profile_shift=0.1)
    distance = working_centre_distance(g1, g2)
    assert profile_shift_sum(g1, g2, distance) == pytest.approx(shift + 0.1, abs=1e-12)
    angle = working_pressure_angle_from_shifts(g1, g2)
    assert working_pressure_angle_from_centre(g1, g2, distance) == pytest.approx(angle, rel=1e-13)
    assert pair_geometry(g1, g2, 0.02).transverse_backlash == 0.0


def test_gears_without_shift_work_at_the_standard_centre_distance() -> None:
    g1 = gear(29, 2.75, 25, 30)
    g2 = gear(113, 2.75, 25, 30)
    pair = pair_geometry(g1, g2, 65 * MM)
    assert pair.centre_distance == pytest.approx(standard_centre_distance(g1, g2), rel=1e-14)
    assert pair.working_helix_angle == pytest.approx(deg(30.0), rel=1e-14)


@pytest.mark.parametrize("change", [-0.2e-3, 0.1e-3, 0.5e-3])
def test_backlash_is_the_working_pitch_less_the_two_working_tooth_thicknesses(change: float) -> None:
    g1 = gear(23, 3, 20, 15, profile_shift=0.3)
    g2 = gear(57, 3, 20, 15, profile_shift=-0.1)
    distance = working_centre_distance(g1, g2) + change
    pair = pair_geometry(g1, g2, 0.02, distance)
    d1, d2 = (2 * distance * g.teeth / (g1.teeth + g2.teeth) for g in (g1, g2))
    gap = math.pi * d1 / g1.teeth - g1.transverse_thickness(d1) - g2.transverse_thickness(d2)
    assert pair.transverse_backlash == pytest.approx(gap, rel=1e-9)
    assert math.copysign(1.0, pair.transverse_backlash) == math.copysign(1.0, change)


def test_backlash_grows_by_twice_the_tangent_of_the_working_pressure_angle() -> None:
    g1 = gear(23, 3, 20, 15, profile_shift=0.3)
    g2 = gear(57, 3, 20, 15)
    distance = working_centre_distance(g1, g2)
    step = 1e-6
    wide, tight = (pair_geometry(g1, g2, 0.02, distance + h).transverse_backlash for h in (step, -step))
    slope = 2 * math.tan(working_pressure_angle_from_shifts(g1, g2))
    assert (wide - tight) / (2 * step) == pytest.approx(slope, rel=1e-8)


def test_normal_backlash_is_the_base_circle_play_seen_along_the_flank_normal() -> None:
    g1 = gear(23, 3, 20, 15)
    g2 = gear(57, 3, 20, 15)
    distance = standard_centre_distance(g1, g2) + 0.2e-3
    pair = pair_geometry(g1, g2, 0.02, distance)
    working_pitch_radius = distance * g1.teeth / (g1.teeth + g2.teeth)
    angle_of_play = pair.transverse_backlash / working_pitch_radius
    assert pair.normal_backlash == pytest.approx(
        angle_of_play * g1.base_radius * math.cos(g1.base_helix_angle), rel=1e-12
    )


# Largest wheel that a pinion of full-depth 20 deg spur teeth meshes with (Shigley, Mechanical Engineering Design).
@pytest.mark.parametrize(("pinion", "largest_wheel"), [(13, 16), (14, 26), (15, 45), (16, 101)])
def test_interference_starts_at_the_textbook_wheel(pinion: int, largest_wheel: int) -> None:
    assert not pair_geometry(gear(pinion), gear(largest_wheel), 0.01).interference
    assert pair_geometry(gear(pinion), gear(largest_wheel + 1), 0.01).interference
    assert pair_geometry(gear(largest_wheel + 1), gear(pinion), 0.01).interference


def test_the_working_helix_has_the_lead_of_the_gear() -> None:
    g1 = gear(23, 3, 20, 15, profile_shift=0.3)
    g2 = gear(57, 3, 20, 15, profile_shift=0.4)
    pair = pair_geometry(g1, g2, 0.02)
    working_diameter = 2 * pair.centre_distance * g1.teeth / (g1.teeth + g2.teeth)
    assert math.tan(pair.working_helix_angle) == pytest.approx(math.pi * working_diameter / g1.lead, rel=1e-12)


def test_swapping_the_gears_mirrors_the_line_of_action() -> None:
    g1 = gear(17, 6, 20, 24.43, profile_shift=0.2)
    g2 = gear(44, 6, 20, 24.43)
    one = pair_geometry(g1, g2, 0.075)
    two = pair_geometry(g2, g1, 0.075)
    assert (two.start_of_contact, two.end_of_contact) == pytest.approx((-one.end_of_contact, -one.start_of_contact))
    assert two.transverse_contact_ratio == pytest.approx(one.transverse_contact_ratio, rel=1e-13)


def test_gears_that_do_not_fit_each_other_are_refused() -> None:
    for other, words in [
        (gear(40, 2.1), "normal module"),
        (gear(40, 2, 25), "pressure"),
        (gear(40, 2, 20, 10), "helix"),
    ]:
        with pytest.raises(AnalysisError, match=words):
            pair_geometry(gear(20, 2), other, 0.02)


def test_impossible_centre_distances_and_shifts_are_refused() -> None:
    g1 = gear(20, 2)
    g2 = gear(40, 2)
    with pytest.raises(AnalysisError, match="base radii add up to"):
        pair_geometry(g1, g2, 0.02, 0.05)
    with pytest.raises(AnalysisError, match="teeth don't meet"):
        pair_geometry(g1, g2, 0.02, 0.066)
    with pytest.raises(AnalysisError, match="too negative"):
        working_centre_distance(gear(20, 2, profile_shift=-1.0), gear(40, 2, profile_shift=-1.0))
    with pytest.raises(AnalysisError, match="face width"):
        pair_geometry(g1, g2, 0.0)
    with pytest.raises(AnalysisError, match="no involute at diameter"):
        g1.transverse_thickness(0.03)
    with pytest.raises(AnalysisError, match="no flank to mesh with"):
        pair_geometry(gear(6, tip_diameter=5 * MM), gear(40), 0.02)
