"""Loads, contact angles and pressures inside ball and cylindrical roller bearings: virtual work, Hertz's contacts, preload."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

from rotorgear.forces.ball_bearing import BallBearing
from rotorgear.forces.roller_bearing import RollerBearing
from rotorgear.forces.rolling import contact_ellipses, point_pressure

SINGLE = BallBearing(12, 14e-3, 77e-3, contact_angle=0.44, clearance=6e-6, preload=3e-6, order=0.4, phase=0.3)
BALLS = {
    "single": SINGLE,
    "other side": replace(SINGLE, contact_angle=-0.44, preload=-3e-6),
    "pair": replace(SINGLE, arrangement="O", row_distance=0.022),
    "four-point": BallBearing(10, 14e-3, 77e-3, contact_angle=0.6, clearance=8e-6, arrangement="four-point"),
    "deep groove": BallBearing(7, 11.5e-3, 43.5e-3, 0.515, 0.54, clearance=10e-6, order=0.4, phase=0.2),
}
STATE = np.array([22e-6, -9e-6, 14e-6, 3e-4, -5e-4])
MODULUS = SINGLE.youngs_modulus / (1.0 - SINGLE.poisson_ratio**2)


@pytest.mark.parametrize("name", BALLS)
@pytest.mark.parametrize("angle", [0.0, 2.3])
def test_loads_of_balls_do_the_work_of_the_force_along_their_deflections(name: str, angle: float) -> None:
    """F = sum of Q d(delta)/dd, force and moments; a load points where its ball gives way fastest."""
    law = BALLS[name]
    state = STATE * (np.array([1.0, 1.0, -1.0, 1.0, 1.0]) if name == "other side" else 1.0)
    inside = law.inside(state, angle=angle)
    h = 1e-9
    slopes = np.array(
        [
            (law.inside(state + e, angle=angle).deflection - law.inside(state - e, angle=angle).deflection) / (2.0 * h)
            for e in h * np.eye(5)
        ]
    )
    assert slopes @ inside.load == pytest.approx(law.evaluate(state, angle=angle).force, rel=1e-6, abs=1e-3)
    carries = inside.load > 0.0
    assert 0 < np.count_nonzero(carries) < carries.size
    assert slopes[0, carries] == pytest.approx((np.cos(inside.angle) * np.cos(inside.contact_angle))[carries], rel=1e-6)
    assert slopes[1, carries] == pytest.approx((np.sin(inside.angle) * np.cos(inside.contact_angle))[carries], rel=1e-6)
    assert slopes[2, carries] == pytest.approx(np.sin(inside.contact_angle)[carries], rel=1e-6)
    assert not inside.contact_angle[~carries].any()
    assert np.all(inside.deflection[~carries] <= 0.0)
    # The cage has turned by its order of the shaft's angle.
    first = law.phase + law.order * angle
    assert np.cos(inside.angle[0] - first) == pytest.approx(1.0, abs=1e-12)


def ellipse(kappa: float, load: float, total: float) -> float:
    """Largest pressure of a contact whose ellipse is kappa times as long as wide, Hertz: a = (6 k^2 E Q/(pi rho E'))^(1/3)."""
    E = ellipe(1.0 - kappa**-2)
    long = np.cbrt(6.0 * kappa**2 * E * load / (np.pi * total * MODULUS))
    return float(1.5 * load / (np.pi * long * long / kappa))


def test_a_sphere_on_a_sphere_has_the_pressure_of_hertz() -> None:
    radius, load = 9e-3, 700.0
    (found,) = point_pressure(np.array([load]), [(2.0 / radius, 1.0 + 1e-9)], MODULUS)
    assert found[0] == pytest.approx(np.cbrt(6.0 * load * (0.5 * MODULUS) ** 2 / (np.pi**3 * radius**2)), rel=1e-6)
    assert point_pressure(np.array([0.0]), [(2.0 / radius, 3.0)], MODULUS)[0][0] == 0.0


def test_balls_press_as_ellipses_of_their_curvatures() -> None:
    law = BALLS["single"]
    inside = law.inside(STATE)
    D, pitch, a0 = law.ball_diameter, law.pitch_diameter, law.contact_angle
    for pressure, groove, outward in (
        (inside.inner_pressure, law.inner_groove * D, -1.0),
        (inside.outer_pressure, law.outer_groove * D, 1.0),
    ):
        # Across the raceway the groove, along it a circle of the radius of the contact over cos(alpha).
        way = 0.5 * (pitch + outward * D * np.cos(a0)) / np.cos(a0)
        along, across = 2.0 / D - outward / way, 2.0 / D - 1.0 / groove
        total, difference = along + across, (along - across) / (along + across)

        def rest(kappa: float, difference: float = difference) -> float:
            m = 1.0 - kappa**-2
            K, E = ellipk(m), ellipe(m)
            return float(((kappa**2 + 1.0) * E - 2.0 * K) / ((kappa**2 - 1.0) * E) - difference)

        kappa = brentq(rest, 1.001, 200.0, xtol=1e-12)
        ours = list(contact_ellipses(D, pitch, law.inner_groove * D, law.outer_groove * D, a0))[0 if outward < 0 else 1]
        assert ours == pytest.approx((total, kappa), rel=1e-8)
        for load, found in zip(inside.load, pressure, strict=True):
            assert found == pytest.approx(ellipse(kappa, load, total) if load else 0.0, rel=1e-7)


def test_a_preload_by_force_is_that_of_the_rows_at_rest() -> None:
    for name in ("single", "other side"):
        pressed = replace(BALLS[name], preload=0.0).pressed_by(850.0)
        assert abs(pressed.evaluate(np.zeros(5)).force[2]) == pytest.approx(850.0, rel=1e-9)
        assert np.sign(pressed.preload) == np.sign(pressed.contact_angle)


def test_rollers_carry_across_and_press_as_lines() -> None:
    law = RollerBearing(13, 11e-3, 9e-3, 52e-3, clearance=12e-6, order=0.4, phase=0.1)
    d = np.array([25e-6, -13e-6])
    inside = law.inside(d, angle=1.7)
    way = np.array([np.cos(inside.angle), np.sin(inside.angle)])
    assert way @ inside.load == pytest.approx(law.evaluate(d, angle=1.7).force, rel=1e-12)
    assert inside.deflection == pytest.approx(way.T @ d - 6e-6, rel=1e-12)
    assert 0 < np.count_nonzero(inside.load) < 13
    assert np.cos(inside.angle[0] - 0.1 - 0.4 * 1.7) == pytest.approx(1.0, abs=1e-12)
    for pressure, outward in ((inside.inner_pressure, -1.0), (inside.outer_pressure, 1.0)):
        curvature = 2.0 / 9e-3 - outward / (0.5 * (52e-3 + outward * 9e-3))
        hertz = np.sqrt(inside.load / 11e-3 * curvature * 210e9 / (1.0 - 0.3**2) / (2.0 * np.pi))
        assert pressure == pytest.approx(hertz, rel=1e-12)
    untold = replace(law, pitch_diameter=0.0).inside(d)
    assert np.isnan(untold.inner_pressure).all()
