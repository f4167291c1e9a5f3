"""Rings with teeth inside: a pair worked by hand in positive lengths, the cutter's fillet, balls, tips that pass each other."""

from __future__ import annotations

import math

import numpy as np
import pytest

from rotorgear.errors import AnalysisError
from rotorgear.gears.geometry.cutter import cutter
from rotorgear.gears.geometry.geometry import GearGeometry, check_gear, involute
from rotorgear.gears.geometry.interference import radial_distance, tip_distance
from rotorgear.gears.geometry.line_of_action import generated_line
from rotorgear.gears.geometry.measure import ball_contact_diameter, ideal_ball_diameter, over_balls, with_allowance
from rotorgear.gears.geometry.outline import root_section, tooth_outline
from rotorgear.gears.geometry.pair import Allowance, normal_backlash, pair_geometry, profile_shift_sum
from rotorgear.gears.stiffness.iso import iso_tooth_stiffness

M = 3e-3
ALPHA = math.radians(20.0)
BETA = math.radians(12.0)
PINION = GearGeometry(23, M, ALPHA, BETA, 0.3)
RING = GearGeometry(-71, M, ALPHA, BETA, -0.1)
ALPHA_T = math.atan(math.tan(ALPHA) / math.cos(BETA))


def test_a_pair_is_that_worked_by_hand_in_positive_lengths() -> None:
    """z_2 - z_1, d - 2 m (h - x) and so on, as text books write internal gears; x of the ring positive towards its axis."""
    module = M / math.cos(BETA)
    bases = [0.5 * z * module * math.cos(ALPHA_T) for z in (23, 71)]
    reference = 71 * module
    assert -RING.reference_diameter == pytest.approx(reference, rel=1e-12)
    assert -RING.base_radius == pytest.approx(bases[1], rel=1e-12)
    assert -RING.effective_tip_diameter == pytest.approx(reference - 2.0 * M * (1.0 - 0.1), rel=1e-12)
    assert -RING.root_diameter == pytest.approx(reference + 2.0 * M * (1.25 + 0.1), rel=1e-12)
    # inv a_w = inv a_t - 2 tan a_n (x_1 + x_2)/(z_2 - z_1): a thicker pinion needs less distance.
    value = math.tan(ALPHA_T) - ALPHA_T - 2.0 * math.tan(ALPHA) * 0.2 / 48
    low, high = 0.1, 0.6
    for _ in range(80):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if math.tan(middle) - middle < value else (low, middle)
    pair = pair_geometry(PINION, RING, 0.03)
    assert pair.working_transverse_pressure_angle == pytest.approx(low, rel=1e-9)
    assert -pair.centre_distance == pytest.approx((bases[1] - bases[0]) / math.cos(low), rel=1e-9)
    assert pair.transverse_backlash == pytest.approx(0.0, abs=1e-15)
    assert profile_shift_sum(PINION, RING, pair.centre_distance) == pytest.approx(0.2, rel=1e-9)
    # Contact ratio: (sqrt(r_a1^2 - r_b1^2) - sqrt(r_a2^2 - r_b2^2) + a sin a_w)/p_bt.
    tips = [0.5 * PINION.effective_tip_diameter, 0.5 * reference - 0.9 * M]
    rolls = [math.sqrt(tip**2 - base**2) for tip, base in zip(tips, bases, strict=True)]
    path = rolls[0] - rolls[1] - pair.centre_distance * math.sin(low)
    pitch = math.pi * module * math.cos(ALPHA_T)
    assert pair.transverse_contact_ratio == pytest.approx(path / pitch, rel=1e-9)
    # The pinion's contact begins at the ring's tip, that of the ring at the pinion's.
    active = pair.active_root_diameters(PINION, RING)
    length = -pair.centre_distance * math.sin(low)
    assert active[0] == pytest.approx(2.0 * math.hypot(bases[0], rolls[1] - length), rel=1e-9)
    assert -active[1] == pytest.approx(2.0 * math.hypot(bases[1], rolls[0] + length), rel=1e-9)


@pytest.mark.parametrize("nearer", [0.0, 50e-6])
def test_backlash_is_the_pitch_less_both_thicknesses_and_grows_as_the_axes_come_together(nearer: float) -> None:
    distance = -pair_geometry(PINION, RING, 0.03).centre_distance - nearer
    angle = math.acos((-RING.base_radius - PINION.base_radius) / distance)
    radii = [PINION.base_radius / math.cos(angle), -RING.base_radius / math.cos(angle)]
    # Thickness at a radius from that at the reference circle; a ring's tooth grows outwards.
    at_reference = [math.pi / 2 + 2.0 * x * math.tan(ALPHA) for x in (0.3, -0.1)]
    opening = involute(ALPHA_T) - involute(angle)
    thickness = [
        2.0 * radii[0] * (at_reference[0] / 23 + opening),
        2.0 * radii[1] * (at_reference[1] / 71 - opening),
    ]
    backlash = 2.0 * math.pi * radii[0] / 23 - sum(thickness)
    assert pair_geometry(PINION, RING, 0.03, -distance).transverse_backlash == pytest.approx(backlash, abs=1e-15)
    assert (backlash > 1e-6) == bool(nearer)
    play = normal_backlash(PINION, RING, -distance, Allowance(-20e-6, -50e-6), Allowance(-30e-6, -70e-6), 10e-6)
    assert play.least < play.mean < play.most
    exact = normal_backlash(PINION, RING, -distance, Allowance(-20e-6), Allowance(-30e-6))
    assert exact.least == pytest.approx(
        backlash * math.cos(angle) * math.cos(RING.base_helix_angle) + 50e-6 * math.cos(ALPHA)
    )


@pytest.mark.parametrize(("teeth", "factor"), [(None, None), (41, 0.2), (19, 0.0)])
def test_the_fillet_is_the_envelope_of_the_cutters_tip(teeth: int | None, factor: float | None) -> None:
    ring = GearGeometry(-71, 1.0, ALPHA, BETA, -0.1, root_radius_factor=factor, cutter_teeth=teeth)
    tool = cutter(ring)
    outline = tooth_outline(ring)
    # The rounded edge, sampled, while the cutter rolls in the ring.
    centre = tool.tip_radius - tool.tip_rounding
    around = np.linspace(0.0, 1.5, 400)[:, None] + tool.centre_angle
    x = centre * math.cos(tool.centre_angle) + tool.tip_rounding * np.cos(around)
    y = centre * math.sin(tool.centre_angle) + tool.tip_rounding * np.sin(around)
    turn = np.linspace(-0.35, 0.2, 4001)
    p = x * np.cos(turn) - y * np.sin(turn) + tool.centre_distance
    q = x * np.sin(turn) + y * np.cos(turn)
    angle = np.arctan2(q, p) - turn * tool.teeth / 71
    radius = np.hypot(p, q)
    for share in (0.1, 0.3, 0.6):
        r, tooth = outline.fillet(share)
        near = np.abs(radius - r) < 2e-4
        assert math.pi / 71 - angle[near].max() == pytest.approx(float(tooth), abs=5e-5)
    # It begins on the involute in its direction, and ends at the root circle.
    start = outline.involute(outline.form_roll_length)
    assert np.allclose(outline.fillet(0.0), start, rtol=1e-9)
    assert outline.fillet(1.0)[0] == pytest.approx(-0.5 * ring.root_diameter, rel=1e-12)
    step = np.diff(np.array(outline.fillet(np.array([0.0, 1e-5]))), axis=1).ravel()
    if factor != 0.0:
        flank = np.diff(np.array(outline.involute(outline.form_roll_length + np.array([0.0, -1e-5]))), axis=1).ravel()
        assert step[1] / step[0] == pytest.approx(flank[1] / flank[0], rel=1e-3)


def test_a_ball_touches_both_flanks_of_a_space_at_the_shifted_circle() -> None:
    ring = GearGeometry(-71, 1.0, ALPHA, 0.0, -0.1)
    ball = ideal_ball_diameter(ring)
    assert ball_contact_diameter(ring, ball) == pytest.approx(71.0 + 0.2, rel=1e-9)
    for odd, diameter in ((True, ball), (False, 1.7)):
        g = ring if odd else GearGeometry(-70, 1.0, ALPHA, 0.0, 0.2)
        between = over_balls(g, diameter)
        centre = 0.5 * (between + diameter) / (math.cos(math.pi / 142) if odd else 1.0)
        # Distance of the flank from the ball's centre in the middle of the space.
        radius, angle = tooth_outline(g).involute(np.linspace(-20.0, -5.0, 20001))
        gap = math.pi / abs(g.teeth) - angle
        distance = np.hypot(radius * np.cos(gap) - centre, radius * np.sin(gap))
        assert distance.min() == pytest.approx(0.5 * diameter, abs=1e-7)
    thin = over_balls(with_allowance(ring, -0.01), ball)
    assert thin > over_balls(ring, ball)  # thinner teeth of a ring let balls move outwards
    with pytest.raises(AnalysisError, match="take a smaller one"):
        over_balls(ring, 5.0)


def test_tips_pass_each_other_as_corners_that_are_turned_and_moved_step_by_step() -> None:
    pinion = GearGeometry(40, 1.0, ALPHA, 0.0, 0.1, addendum_factor=0.8)
    for z in (47, 52, 66):
        ring = GearGeometry(-z, 1.0, ALPHA, 0.0, -0.05, addendum_factor=0.8)
        pair = pair_geometry(pinion, ring, 1.0)
        small, large = 0.5 * pinion.effective_tip_diameter, -0.5 * ring.effective_tip_diameter
        working = involute(pair.working_transverse_pressure_angle)
        behind = involute(math.acos(pinion.base_radius / small)) - working
        before = working - involute(math.acos(-ring.base_radius / large))
        # The pinion drives: its corner stands at turn - behind, that of the ring at turn z_1/z + before.
        turn = np.linspace(0.0, 1.5, 200001)
        x = small * np.cos(turn - behind) - pair.centre_distance
        y = small * np.sin(turn - behind)
        inside = np.flatnonzero(np.hypot(x, y) < large)[0]
        gap = turn[inside] * 40 / z + before - math.atan2(y[inside], x[inside])
        assert tip_distance(pinion, ring, pair) == pytest.approx(gap * large, abs=2e-4)
        # Moved along the line of centres a corner keeps its height: it passes that of the ring where both are as high.
        height = small * np.sin(turn[turn < 0.9 + behind] - behind)
        corner = turn[: len(height)] * 40 / z + before - np.arcsin(np.clip(height / large, -1.0, 1.0))
        assert radial_distance(pinion, ring, pair) == pytest.approx(corner[height > 0.0].min() * large, abs=1e-4)


def test_impossible_rings_say_why() -> None:
    assert "not above the base diameter" in check_gear(GearGeometry(-30, M, ALPHA, 0.0))[0]
    assert "not below the root diameter" in check_gear(GearGeometry(-71, M, ALPHA, 0.0, tip_diameter=-0.23))[0]
    with pytest.raises(AnalysisError, match="can't hold a pinion of 80"):
        pair_geometry(GearGeometry(80, M, ALPHA, BETA), RING, 0.03)
    with pytest.raises(AnalysisError, match="cutter of 80 teeth does not go into a ring of 71"):
        tooth_outline(GearGeometry(-71, M, ALPHA, 0.0, cutter_teeth=80))
    with pytest.raises(AnalysisError, match="have a difference of"):
        pair_geometry(PINION, RING, 0.03, -0.05)
    with pytest.raises(AnalysisError, match="cutter_teeth of a larger cutter"):
        tooth_outline(GearGeometry(-36, M, ALPHA, 0.0, cutter_teeth=8))


def test_the_line_of_action_ends_at_the_form_circles() -> None:
    pair = pair_geometry(PINION, RING, 0.03)
    line = generated_line(PINION, RING, pair)
    start, end = pair.start_of_contact + line.pitch_point, pair.end_of_contact + line.pitch_point
    forms = [tooth_outline(g).form_roll_length for g in (PINION, RING)]
    assert line.start == pytest.approx(max(start, forms[0]), rel=1e-12)
    assert line.end == pytest.approx(min(end, line.length - forms[1]), rel=1e-12)
    assert line.interference == (start < forms[0] or end > line.length - forms[1])


def test_iso_takes_a_ring_for_a_rack_with_its_profile_shift() -> None:
    z = 23 / (math.cos(RING.base_helix_angle) ** 2 * math.cos(BETA))
    q = 0.04723 + 0.15551 / z - 0.00635 * 0.3 - 0.11654 * 0.3 / z + 0.00193 * 0.1 + 0.00529 * 0.09 + 0.00182 * 0.01
    found = iso_tooth_stiffness(PINION, RING, 1.7)
    assert found.theoretical == pytest.approx(1e9 / q, rel=1e-12)
    assert found.single == pytest.approx(1e9 / q * 0.8 * (1.0 + 0.5 * (1.2 - 1.25)) * math.cos(BETA), rel=1e-12)
    assert iso_tooth_stiffness(RING, PINION, 1.7).theoretical == found.theoretical


def test_the_root_section_of_a_ring_is_that_of_sixty_degrees_with_its_lever_from_the_outside() -> None:
    outline = tooth_outline(RING)
    section = root_section(outline)
    radius, angle = outline.fillet(section.share + np.array([-1e-3, 0.0, 1e-3]))
    across = radius * np.sin(angle)
    height = radius * np.cos(angle)
    assert math.degrees(math.atan2(across[2] - across[0], height[2] - height[0])) == pytest.approx(60.0, abs=0.1)
    assert section.thickness == pytest.approx(2.0 * across[1], rel=1e-9)
    # The normal of a flank point meets the middle of the tooth; the lever runs from there to the section.
    roll = outline.tip_roll_length
    r, half = (float(value) for value in outline.involute(roll))
    normal = half + math.acos(-RING.base_radius / r)  # of the line of force to the normal of the middle
    met = r * math.cos(half) + r * math.sin(half) * math.tan(normal)
    arm = height[1] - met
    slender = section.thickness / arm
    notch = (1.2 + 0.13 * slender) * (section.thickness / (2.0 * section.curvature_radius)) ** (
        1 / (1.21 + 2.3 / slender)
    )
    wanted = 2e5 * math.cos(normal) * 6.0 * arm / section.thickness**2 * notch
    assert section.nominal_stress(2e5, roll) == pytest.approx(wanted, rel=1e-9)
