"""The blank as a body of revolution: rigid motions, discs in closed form, polar moment, and what it does beside plane discs."""

from __future__ import annotations

import math

import numpy as np
import pytest

from rotorgear.gears.geometry.blank import BlankShape, solid_blank
from rotorgear.gears.tooth_fe.blank_section import BlankSection, torsional_flexibility

NU = 0.3
WEBBED = BlankShape(
    bore_radius=4.0, rim_radius=12.0, web_thickness=1.5, web_position=1.0, hub_radius=6.0, hub_width=8.0
)


def amplitudes(section: BlankSection, harmonic: int, u: np.ndarray, v: np.ndarray, w: np.ndarray) -> float:
    """Largest force of a motion (U, V, W) of all nodes over the largest stiffness times the largest motion."""
    K = section.free_stiffness(harmonic)
    q = np.stack([u, v, w], -1).ravel()
    return float(np.abs(K @ q).max()) / (float(abs(K).max()) * float(np.abs(q).max()))


def test_rigid_motions_strain_nothing() -> None:
    section = BlankSection(WEBBED, 8.0, 14.0, NU)
    r, z = section.points.T
    none = np.zeros_like(r)
    one = np.ones_like(r)
    assert amplitudes(section, 0, none, none, one) <= 1e-11  # along the axis
    assert amplitudes(section, 0, none, r, none) <= 1e-11  # about it
    assert amplitudes(section, 1, one, -one, none) <= 1e-11  # across: x = cos p, y = -sin p
    assert amplitudes(section, 1, z, -z, -r) <= 1e-11  # about a diameter


@pytest.mark.parametrize("width", [0.5, 30.0])
def test_a_disc_winds_up_as_in_closed_form(width: float) -> None:
    """A torque T over the width b: r phi' = T / (2 pi r^2 b G), phi = T (1/r_i^2 - 1/r_o^2) / (4 pi b G)."""
    G = 0.5 / (1.0 + NU)
    exact = (1.0 / 5.0**2 - 1.0 / 14.0**2) / (4.0 * math.pi * width * G)
    assert torsional_flexibility(solid_blank(5.0), width, 14.0, NU) == pytest.approx(exact, rel=1e-4)


@pytest.mark.parametrize(("nu", "error"), [(0.0, 1e-4), (0.3, 4e-3)])
def test_a_thin_disc_under_pressure_gives_as_in_plane_stress(nu: float, error: float) -> None:
    """u = A r + B / r with B = -A r_i^2 where r_i is held, and s_rr(r_o) = A/(1 - nu) - B/((1 + nu) r_o^2) for E = 1.

    With Poisson's ratio the held bore can't thin, so the disc gives a little less.
    """
    inner = 5.0
    outer = 14.0
    section = BlankSection(solid_blank(inner), 0.05, outer, nu)
    K = section.stiffness(0)
    force = np.zeros(len(K))
    force[::3] = section.weight * 0.05 * outer  # a unit pull over one radian of the circle
    moved = float(section.weight @ np.linalg.solve(K, force)[::3])
    A = 1.0 / (1.0 / (1.0 - nu) + inner**2 / (outer**2 * (1.0 + nu)))
    exact = A * (outer - inner**2 / outer)
    assert exact * (1.0 - error) <= moved <= exact * (1.0 + 1e-9)


def test_the_polar_moment_is_that_of_its_rings() -> None:
    section = BlankSection(WEBBED, 8.0, 14.0, NU)
    one = np.ones(len(section.radius))
    rings = ((12.0, 14.0, 8.0), (6.0, 12.0, 1.5), (4.0, 6.0, 8.0))
    exact = sum(0.5 * math.pi * b * (outer**4 - inner**4) for inner, outer, b in rings)
    assert section.polar_moment(one, one) == pytest.approx(exact, rel=1e-12)


def test_a_thinner_web_winds_up_more_and_wherever_it_stands_alike() -> None:
    def twist(web: float, position: float = 0.0) -> float:
        return torsional_flexibility(BlankShape(4.0, 12.0, web, position, 6.0, 8.0), 8.0, 14.0, NU)

    assert twist(0.5) > twist(1.0) > twist(2.0) > twist(8.0)
    assert twist(8.0) == pytest.approx(torsional_flexibility(solid_blank(4.0), 8.0, 14.0, NU), rel=1e-3)
    assert twist(1.0, 2.0) == pytest.approx(twist(1.0, -2.0), rel=1e-12)


def test_harmonics_between_those_worked_out_follow_a_spline() -> None:
    section = BlankSection(WEBBED, 8.0, 14.0, NU)
    whole = section.stiffnesses(60)
    for harmonic, error in ((3, 1e-12), (17, 1e-4), (44, 1e-4)):
        exact = section.stiffness(harmonic)
        assert np.abs(whole(harmonic) - exact).max() <= error * np.abs(exact).max()
