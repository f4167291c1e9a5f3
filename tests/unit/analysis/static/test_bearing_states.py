"""Rolling bearings in equilibrium under a load: published deflections, tangents, and what analyses print of them."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq

import rotorgear as rg
from rotorgear.forces.ball_bearing import BallBearing
from tests.models import disk_in_bearing

BALLS = 'kind = "ball", elements = 7, element_diameter = "11.5 mm", pitch_diameter = "43.5 mm"'
ROLLERS = 'kind = "roller", elements = 15, element_diameter = "11 mm", pitch_diameter = "65.5 mm", length = "12 mm"'


def rotor(rolling: str, load: str, speed: str = "0 rpm") -> rg.Model:
    """A rigid disk in one bearing, which can move across only."""
    return disk_in_bearing(f"rolling = {{ {rolling} }}", load, speed=speed)


def test_a_ball_bearing_under_a_ball_has_the_deflection_of_the_standard():
    # minzhun/ISO16281: 15.1101 um of a commercial code; tangent 1.5 F/delta.
    result = rg.static(rotor(BALLS, '["1 kN", "0 N", "0 N"]'))
    moved = result.place_displacement["bearings.front"][0]
    assert moved == pytest.approx(15.1101e-6, rel=1e-4)
    assert result.laws[0].stiffness[0, 0] == pytest.approx(1.5 * 1000.0 / moved, rel=1e-6)
    assert not result.laws[0].averaged
    assert "bearings.front 0 1000 15.11 99.27" in " ".join(str(result).split())


def test_a_roller_bearing_has_the_deflection_of_its_line_contacts():
    result = rg.static(rotor(ROLLERS, '["1 kN", "0 N", "0 N"]'))
    assert result.place_displacement["bearings.front"][0] == pytest.approx(1.68913e-6, rel=4e-6)
    assert result.laws[0].stiffness[0, 0] == pytest.approx(657.80e6, rel=4e-6)
    assert np.abs(result.laws[0].stiffness - result.laws[0].stiffness.T).max() <= 1e-10 * 657.8e6


def test_a_pure_moment_tilts_a_ball_bearing_as_the_sum_over_its_balls_says():
    """M = sum c_p delta^1.5 w/s R_i sin phi with w = R_i tilt sin phi, s = sqrt(A^2 + w^2), delta = s - A, summed here anew."""
    z, d, pitch = 7, 11.5e-3, 43.5e-3
    c_p = 333375.588 * 1e3**1.5  # of the published cases, N/m^1.5
    A = 0.05 * d
    R = 0.5 * pitch + 0.02 * d

    def moment(tilt: float) -> float:
        w = R * tilt * np.sin(2.0 * np.pi * np.arange(z) / z)
        s = np.hypot(A, w)
        return float(np.sum(c_p * (s - A) ** 1.5 * w / s * R * np.sin(2.0 * np.pi * np.arange(z) / z)))

    model = rotor(BALLS, "[0.0, 0.0, 0.0]").with_(
        {"supports.guide.fixed": ["x", "y", "z"], "loads.pull.moment": [5.0, 0.0, 0.0]}
    )
    law = rg.static(model).laws[0]
    assert law.force[3] == pytest.approx(5.0, rel=1e-9)
    assert moment(law.displacement[3]) == pytest.approx(
        5.0, rel=2e-3
    )  # the standard's rounded constant, as for a force
    assert abs(law.displacement[4]) < 1e-6 * abs(law.displacement[3])


def test_linear_analyses_print_the_state_that_they_are_about():
    model = rotor(BALLS, '["0 N", "1 kN", "0 N"]', "3000 rpm")
    found = rg.modal(model)
    (law,) = found.laws
    assert law == rg.static(model).laws[0]
    assert law.averaged
    assert law.part == "bearings.front"
    assert law.deflection == pytest.approx(15.19e-6, abs=5e-9)
    assert law.load == pytest.approx(1000.0, rel=1e-9)
    assert "linear about the static equilibrium at 3000 rpm" in found.method
    assert not any("bearings.front" in note for note in found.left_out)  # nothing of it is left out
    assert "15.19" in found.text(laws=True)
    assert "15.19" not in found.text()
    assert "15.19" not in found.text()
    assert [row["part"] for row in found.rows("laws")] == ["bearings.front"]


def test_an_angular_contact_bearing_has_the_state_of_the_handbook():
    """Harris 218 (Z 16, D 22.225, dm 125.26 mm, f 0.5232, 40 deg) at 17.8 kN, with the handbook's constant K = 896.7 N/mm^2.

    That constant, read from a chart, is c_p = K D^2 / A^1.5 = 422977 N/mm^1.5; Hertz on the same geometry is 10 % stiffer.
    """
    distance = 2.0 * (0.5232 - 0.5) * 22.225
    law = BallBearing(
        balls=16,
        ball_diameter=22.225e-3,
        pitch_diameter=125.26e-3,
        inner_groove=0.5232,
        outer_groove=0.5232,
        contact_angle=np.radians(40.0),
        order=0.43,
        contact=896.7 * 22.225**2 / distance**1.5 * 1e3**1.5,
    )
    pushed = brentq(lambda z: law.linearised([0, 0, z, 0, 0], speed=1.0).force[2] - 17800.0, 1e-6, 1e-3, xtol=1e-15)
    state = law.linearised([0, 0, pushed, 0, 0], speed=1.0)
    angle = np.arctan2(law.distance * np.sin(np.radians(40.0)) + pushed, law.distance * np.cos(np.radians(40.0)))
    assert np.degrees(angle) == pytest.approx(41.59, abs=0.005)
    assert 17800.0 / 16.0 / np.sin(angle) == pytest.approx(1676.0, abs=0.5)
    assert pushed == pytest.approx(0.0383e-3, abs=5e-8)
    published = [4.548e8, 4.548e8, 7.220e8, 1.434e6, 1.434e6]
    np.testing.assert_allclose(np.diag(state.stiffness), published, rtol=2e-4)
    assert state.stiffness[0, 4] == pytest.approx(-2.473e7, rel=2e-4)
    assert np.abs(state.stiffness - state.stiffness.T).max() <= 1e-10 * 7.22e8


def test_an_angular_contact_bearing_takes_its_load_from_either_side():
    contact = (
        'kind = "ball", elements = 12, element_diameter = "14 mm", pitch_diameter = "77 mm", contact_angle = "{} deg"'
    )
    law = BallBearing(12, 14e-3, 77e-3, contact_angle=np.radians(25.0), order=0.4)
    alone = brentq(lambda z: law.linearised([0, 0, z, 0, 0], speed=1.0).force[2] - 500.0, 1e-7, 1e-3, xtol=1e-15)
    stiffness = law.linearised([0, 0, alone, 0, 0], speed=1.0).stiffness
    for angle in (25, -25):
        result = rg.static(
            rotor(contact.format(angle), "[0.0, 0.0, 0.0]", "3000 rpm").with_(
                {
                    "supports.guide.fixed": ["tilt_x", "tilt_y"],
                    "loads.pull.force": [0.0, 0.0, 500.0 * np.sign(angle)],
                }
            )
        )
        assert result.place_displacement["bearings.front"][2] == pytest.approx(np.sign(angle) * alone, rel=1e-8)
        np.testing.assert_allclose(np.diag(result.laws[0].stiffness)[:3], np.diag(stiffness)[:3], rtol=1e-8)
