"""Spans, dimensions over balls and backlash against searches in the true tooth, which know none of the closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.optimize import brentq

from rotorgear.errors import AnalysisError
from rotorgear.gears.geometry.geometry import GearGeometry
from rotorgear.gears.geometry.measure import (
    ball_contact_diameter,
    best_span,
    ideal_ball_diameter,
    normal_thickness,
    over_balls,
    with_allowance,
)
from rotorgear.gears.geometry.pair import Allowance, normal_backlash, pair_geometry, working_centre_distance

deg = math.radians


def base_half_angle(g: GearGeometry) -> float:
    """Half the tooth at the base circle, from s_t at the reference circle by the definition of the involute."""
    thickness = g.transverse_module * (math.pi / 2 + 2 * g.profile_shift * math.tan(g.normal_pressure_angle))
    return thickness / g.reference_diameter + math.tan(g.transverse_pressure_angle) - g.transverse_pressure_angle


def span_diameter(g: GearGeometry, k: int) -> float:
    """Diameter at which the base tangent over k teeth touches the flanks, half of it on either side of the base cylinder."""
    return math.hypot(2.0 * g.base_radius, g.base_tangent_length(k) * math.cos(g.base_helix_angle))


def clearance(g: GearGeometry, centre: float) -> float:
    """Distance from a point on the middle of a space to the helicoid beside it."""
    return nearest(g, centre)[0]


def nearest(g: GearGeometry, centre: float) -> tuple[float, float]:
    """Distance from a point on the middle of a space, at radius `centre`, to the helicoid beside it, and radius of the point
    there, by a refined grid search."""
    turn = 2 * math.pi / g.lead
    half = base_half_angle(g)
    middle = math.pi / g.teeth
    reach = 0.0 if math.isinf(g.lead) else 2 * g.normal_module
    low = np.array([0.0, -reach])
    high = np.array([1.5, reach])
    best = math.inf
    at = 0.0
    for _ in range(9):
        roll = np.linspace(low[0], high[0], 201)[:, None]
        z = np.linspace(low[1], high[1], 201)
        radius = g.base_radius * np.hypot(1, roll)
        angle = half - (roll - np.arctan(roll)) + turn * z
        x = radius * np.cos(angle) - centre * math.cos(middle)
        y = radius * np.sin(angle) - centre * math.sin(middle)
        distance = np.sqrt(x**2 + y**2 + z**2)
        i, j = np.unravel_index(np.argmin(distance), distance.shape)
        best = float(distance[i, j])
        at = float(radius[i, 0])
        size = (high - low) / 16
        point = np.array([roll[i, 0], z[j]])
        low = np.maximum(point - size, [0.0, -reach])
        high = point + size
    return best, at


@pytest.mark.parametrize(
    ("teeth", "helix", "shift"), [(34, 0, 0.0), (17, 0, 0.3), (25, 0, -0.2), (24, 25, 0.2), (29, 30, 0.0)]
)
def test_balls_in_the_spaces_touch_the_true_flanks(teeth: int, helix: float, shift: float) -> None:
    g = GearGeometry(teeth, 2e-3, deg(20), deg(helix), profile_shift=shift)
    ball = ideal_ball_diameter(g)
    centre = brentq(lambda r: clearance(g, r) - 0.5 * ball, 1.001 * g.base_radius, 1.5 * g.base_radius, xtol=1e-14)
    apart = math.pi if teeth % 2 == 0 else math.pi - math.pi / teeth
    assert over_balls(g, ball) == pytest.approx(2 * centre * math.sin(apart / 2) + ball, rel=1e-10)
    touched = 2 * nearest(g, centre)[1]
    assert touched == pytest.approx(g.reference_diameter + 2 * shift * g.normal_module, rel=1e-5)
    assert ball_contact_diameter(g, ball) == pytest.approx(touched, rel=1e-5)


def test_a_ball_that_falls_to_the_bottom_is_refused_with_one_that_fits() -> None:
    g = GearGeometry(40, 3e-3, deg(20), 0.0)
    with pytest.raises(AnalysisError, match="take a larger one, such as 5"):
        over_balls(g, 0.5e-3)


@pytest.mark.parametrize(("teeth", "k", "shift"), [(34, 5, 0.1), (17, 3, 0.3), (80, 10, -0.2)])
def test_a_span_is_an_arc_of_the_base_circle(teeth: int, k: int, shift: float) -> None:
    g = GearGeometry(teeth, 3e-3, deg(20), 0.0, profile_shift=shift)
    arc = g.base_radius * (2 * base_half_angle(g) + 2 * math.pi / teeth * (k - 1))
    assert g.base_tangent_length(k) == pytest.approx(arc, rel=1e-13)


@pytest.mark.parametrize("helix", [0, 20, 33])
@pytest.mark.parametrize("teeth", [12, 34, 113])
def test_the_proposed_span_touches_the_flank_nearest_to_its_middle(teeth: int, helix: float) -> None:
    g = GearGeometry(teeth, 3e-3, deg(20), deg(helix), profile_shift=0.2)
    middle = g.reference_diameter + 2 * 0.2 * g.normal_module
    off = [abs(span_diameter(g, k) - middle) for k in range(1, teeth)]
    assert best_span(g) == 1 + int(np.argmin(off))


def test_an_allowance_thins_the_tooth_by_its_amount_and_leaves_the_tip() -> None:
    g = GearGeometry(31, 4e-3, deg(20), deg(15), profile_shift=0.1)
    thin = with_allowance(g, -60e-6)
    assert normal_thickness(thin) == pytest.approx(normal_thickness(g) - 60e-6, rel=1e-13)
    assert thin.effective_tip_diameter == g.effective_tip_diameter
    assert g.base_tangent_length(4) - thin.base_tangent_length(4) == pytest.approx(60e-6 * math.cos(deg(20)), rel=1e-9)


def test_backlash_by_allowances_is_that_of_the_gears_made_thinner() -> None:
    one, two = (GearGeometry(z, 3e-3, deg(20), deg(20), profile_shift=x) for z, x in ((23, 0.2), (61, 0.1)))
    distance = working_centre_distance(one, two) + 50e-6
    found = normal_backlash(one, two, distance, Allowance(-30e-6, -60e-6), Allowance(-40e-6, -90e-6), 20e-6)
    for got, at, first, second in (
        (found.least, -20e-6, -30e-6, -40e-6),
        (found.mean, 0.0, -45e-6, -65e-6),
        (found.most, 20e-6, -60e-6, -90e-6),
    ):
        pair = pair_geometry(with_allowance(one, first), with_allowance(two, second), 0.04, distance + at)
        # at the working circles, from the definition: pitch less both thicknesses
        angle = pair.working_transverse_pressure_angle
        pitch = 2 * math.pi * one.base_radius / math.cos(angle) / one.teeth
        thick = sum(
            g.transverse_thickness(2 * g.base_radius / math.cos(angle))
            for g in (with_allowance(one, first), with_allowance(two, second))
        )
        play = (pitch - thick) * math.cos(angle) * math.cos(one.base_helix_angle)
        assert got == pytest.approx(play, abs=1e-12)


def test_the_sweep_of_gears_is_measured_without_an_error() -> None:
    from rotorgear.gears.geometry.outline import tooth_outline

    measured = 0
    for teeth in (6, 8, 10, 14, 17, 25, 60, 150):
        for shift in np.linspace(-0.6, 0.9, 6):
            for pressure in (14.5, 20, 25):
                for helix in (0, 20, 35):
                    g = GearGeometry(teeth, 1e-3, deg(pressure), deg(helix), profile_shift=float(shift))
                    try:
                        tooth_outline(g)
                    except AnalysisError:
                        continue
                    value = over_balls(g, ideal_ball_diameter(g))
                    assert value > 2 * g.base_radius
                    assert span_diameter(g, best_span(g)) >= 2 * g.base_radius
                    measured += 1
    assert measured > 350
