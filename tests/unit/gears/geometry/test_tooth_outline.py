"""The outline of a rack-cut tooth: conjugate to its tool, continuous, and refused with a reason where there is none."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from rotorgear.errors import AnalysisError
from rotorgear.gears.geometry.geometry import GearGeometry
from rotorgear.gears.geometry.outline import tooth_outline

deg = math.radians
SOME = [
    GearGeometry(17, 8e-3, deg(20), deg(15.8), profile_shift=0.145, dedendum_factor=1.4),
    GearGeometry(34, 5e-3, deg(20), 0.0),
    GearGeometry(29, 2.75e-3, deg(25), deg(30)),
    GearGeometry(9, 3e-3, deg(20), deg(10), profile_shift=-0.1),
    GearGeometry(12, 2e-3, deg(20), 0.0, root_radius_factor=0.0),
    GearGeometry(6, 2e-3, deg(14.5), 0.0, profile_shift=0.4),
]


def rack(g: GearGeometry, points: int) -> tuple[np.ndarray, np.ndarray]:
    """Half of a space of the rack in the transverse section, from the tip of the gear's tooth down to the tool's crest."""
    m = g.normal_module
    a = g.normal_pressure_angle
    rho = g.tool_tip_radius_factor
    depth = g.dedendum_factor - rho
    theta = np.linspace(a, math.pi / 2, points)
    x_tip = math.pi / 4 + depth * math.tan(a) + rho * (1 / math.cos(a) - np.cos(theta))
    y_tip = -depth - rho * np.sin(theta)
    y = np.linspace(g.addendum_factor + 0.1, y_tip[0], points)
    x = np.concatenate([math.pi / 4 - y * math.tan(a), x_tip[1:]])
    return m * x / math.cos(g.helix_angle), m * (np.concatenate([y, y_tip[1:]]) + g.profile_shift)


@pytest.mark.parametrize("g", SOME)
def test_the_rack_touches_the_outline_everywhere_and_cuts_into_it_nowhere(g: GearGeometry) -> None:
    outline = tooth_outline(g)
    radius, angle = outline.half(200)
    flank = slice(4, -5)  # without the tip land and the root arc
    x_rack, y_rack = rack(g, 4000)
    order = np.argsort(y_rack)
    gap = np.full(len(radius[flank]), np.inf)
    turn = np.linspace(-1.6, 1.6, 12001) * math.pi / 2 / math.sqrt(g.teeth)
    for phi in turn:  # the gear turns clockwise by phi while the rack moves by r phi
        x = radius[flank] * np.sin(angle[flank] + phi) - 0.5 * g.reference_diameter * phi
        y = radius[flank] * np.cos(angle[flank] + phi) - 0.5 * g.reference_diameter
        inside = y > y_rack.min()
        gap[inside] = np.minimum(gap[inside], (np.interp(y, y_rack[order], x_rack[order]) - x)[inside])
    assert gap.min() > -2e-6 * g.normal_module
    assert gap.max() < 2e-4 * g.normal_module


@pytest.mark.parametrize("g", SOME)
def test_involute_and_trochoid_meet_and_end_on_tip_and_root_circle(g: GearGeometry) -> None:
    outline = tooth_outline(g)
    involute = outline.involute(outline.form_roll_length)
    fillet = outline.fillet(0.0)
    assert involute[0] == pytest.approx(fillet[0], rel=1e-12)
    assert involute[1] == pytest.approx(fillet[1], abs=1e-11)
    assert float(outline.involute(outline.tip_roll_length)[0]) == pytest.approx(outline.tip_radius, rel=1e-14)
    assert float(outline.fillet(1.0)[0]) == pytest.approx(outline.root_radius, rel=1e-14)
    radius, angle = outline.half()
    assert 2 * radius[4] * angle[4] == pytest.approx(g.transverse_tip_thickness, rel=1e-11)
    assert angle[-1] == pytest.approx(math.pi / g.teeth, rel=1e-14)


def test_without_undercut_the_trochoid_continues_the_involute_smoothly() -> None:
    outline = tooth_outline(SOME[0])
    assert not outline.undercut
    step = 1e-6
    radius, angle = outline.fillet(np.array([0.0, step]))
    roll = np.sqrt(radius**2 - SOME[0].base_radius ** 2)
    along = outline.involute(roll)[1]
    assert (angle[1] - along[1]) / (radius[1] - radius[0]) == pytest.approx(0.0, abs=1e-3 / SOME[0].base_radius)


def test_the_form_circle_of_the_iso_example_follows_the_closed_form() -> None:
    g = SOME[0]
    a = g.transverse_pressure_angle
    depth = g.normal_module * (1.4 - g.tool_tip_radius_factor * (1 - math.sin(deg(20))) - 0.145)
    roll = g.base_radius * math.tan(a) - depth / math.sin(a)
    assert tooth_outline(g).form_radius == pytest.approx(math.hypot(roll, g.base_radius), rel=1e-13)


def test_the_root_radius_left_out_is_that_of_iso_53() -> None:
    def radius(dedendum: float, pressure: float = 20) -> float:
        return GearGeometry(30, 1e-3, deg(pressure), 0.0, dedendum_factor=dedendum).tool_tip_radius_factor

    assert (round(radius(1.25), 2), round(radius(1.4), 2), round(radius(1.25, 25), 3)) == (0.38, 0.39, 0.318)


REFUSALS = ("pointed at the tip diameter", "cuts through the root", "cuts the flank up to", "no flank is left")


def test_the_sweep_of_gears_is_drawn_or_refused_with_a_sentence() -> None:
    values = itertools.product(
        (6, 7, 8, 10, 12, 17, 25, 60, 150), np.linspace(-0.6, 0.9, 11), (14.5, 20, 25), (0, 20, 35)
    )
    refused: list[tuple[int, str]] = []
    for teeth, shift, pressure, helix in values:
        g = GearGeometry(teeth, 1e-3, deg(pressure), deg(helix), profile_shift=float(shift))
        try:
            outline = tooth_outline(g)
        except AnalysisError as error:
            refused.append((teeth, str(error)))
            continue
        radius, angle = outline.half()
        assert np.all(np.isfinite(radius))
        assert np.all(angle >= 0.0)
        assert outline.root_radius <= outline.form_radius < outline.tip_radius
        involute = outline.involute(outline.form_roll_length)
        fillet = outline.fillet(0.0)
        assert np.hypot(involute[0] - fillet[0], involute[0] * (involute[1] - fillet[1])) < 1e-10 * g.normal_module
    assert 0 < len(refused) < 80
    for teeth, sentence in refused:
        assert teeth <= 25
        assert any(words in sentence for words in REFUSALS)
