"""Ball on raceways against Hertz' solution in the form of Johnson's Contact Mechanics (4.24 to 4.32), solved another way."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

from rotorgear.forces.rolling import contact_ellipses, point_contact

E = 210e9
NU = 0.3


def approach(load: float, along: float, across: float) -> float:
    """Approach under a load of bodies whose gap is (along x^2 + across y^2) / 2, along < across."""
    star = E / (2.0 * (1.0 - NU**2))
    # A/B = (K - E) / ((a/b)^2 E - K) for the half-axes a > b, with the modulus e^2 = 1 - (b/a)^2.

    def rest(slim: float) -> float:
        m = 1.0 - slim**2
        return float((ellipk(m) - ellipe(m)) / (ellipe(m) / slim**2 - ellipk(m)) - along / across)

    slim = brentq(rest, 1e-6, 1.0 - 1e-9, xtol=1e-15)
    m = 1.0 - slim**2
    # A = along / 2 = p0 b (K - E) / (E* e^2 a^2), load = 2/3 pi a b p0
    a = (1.5 * load / math.pi * (ellipk(m) - ellipe(m)) / (star * m * 0.5 * along)) ** (1.0 / 3.0)
    p0 = 1.5 * load / (math.pi * a * slim * a)
    return float(p0 * slim * a / star * ellipk(m))


@pytest.mark.parametrize(("angle", "inner", "outer"), [(0.0, 0.515, 0.54), (0.44, 0.52, 0.53)])
def test_a_ball_between_two_raceways_gives_by_both_contacts_one_after_the_other(
    angle: float, inner: float, outer: float
) -> None:
    D = 14e-3
    pitch = 77e-3
    c = point_contact(contact_ellipses(D, pitch, inner * D, outer * D, angle), E / (1.0 - NU**2))
    load = 900.0
    total = 0.0
    for sign, groove in ((-1.0, inner), (1.0, outer)):
        # In the plane of the bearing the ball runs on the cone of the raceway, convex inside and concave outside.
        radius = (0.5 * pitch + sign * 0.5 * D * math.cos(angle)) / math.cos(angle)
        rolling = 2.0 / D - sign / radius
        closed = 2.0 / D - 1.0 / (groove * D)
        total += approach(load, min(rolling, closed), max(rolling, closed))
    assert c * total**1.5 == pytest.approx(load, rel=1e-9)


def test_the_constant_scales_with_modulus_and_size() -> None:
    small = tuple(contact_ellipses(14e-3, 77e-3, 7.3e-3, 7.5e-3, 0.3))
    large = contact_ellipses(28e-3, 154e-3, 14.6e-3, 15e-3, 0.3)
    one = point_contact(small, E)
    assert point_contact(large, E) == pytest.approx(np.sqrt(2.0) * one, rel=1e-9)
    assert point_contact(small, 2.0 * E) == pytest.approx(2.0 * one, rel=1e-12)
