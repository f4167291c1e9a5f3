"""Hertz contact of balls with raceways, and line contact of rollers: the constants of a rolling bearing's load and deflection.

Point contact: Q = c_p delta^(3/2), with chi from  1 - 2/(chi^2 - 1) (K/E - 1) - F(rho) = 0  and the approach

    delta = K [4.5 sum_rho Q^2 / (E (pi chi E')^2)]^(1/3),   E' = Y/(1 - nu^2),   K, E of modulus sqrt(1 - 1/chi^2)

Hamrock and Dowson, Ball Bearing Lubrication (Wiley 1981), ch. 3; ISO/TS 16281:2008 prints it with 1.48 in place of
pi/sqrt(4.5) = 1.481.
Line contact: q = 35948 L^(8/9) delta^(10/9) in N and mm for steel, both rings together (ISO/TS 16281).

Largest pressures: p = 3 Q/(2 pi a b) on an ellipse of the half axes a = chi b, b = [2 E/(pi chi)]^(1/3) [3 Q/(sum_rho E')]^(1/3);
p = sqrt(Q sum_rho E'/(2 pi L)) on a line (Harris, Rolling Bearing Analysis, ch. 6; both bodies of one material).
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

# 35948 N/mm^(8/9+10/9) in SI: lengths and deflections in m.
LINE_CONTACT = 35948.0 * 1e3 ** (8.0 / 9.0) * 1e3 ** (10.0 / 9.0)


def point_contact(
    ball_diameter: float,
    pitch_diameter: float,
    inner_radius: float,
    outer_radius: float,
    contact_angle: float,
    youngs_modulus: float = 210e9,
    poisson_ratio: float = 0.3,
) -> float:
    """Return c_p in N/m^1.5 of a ball between both raceways; all lengths in m, the groove radii of inner and outer ring."""
    total = 0.0
    for sum_rho, chi in _rings(ball_diameter, pitch_diameter, inner_radius, outer_radius, contact_angle):
        m = 1.0 - 1.0 / chi**2
        total += ellipk(m) * (sum_rho / (chi**2 * ellipe(m))) ** (1.0 / 3.0)
    stiff = youngs_modulus / (1.0 - poisson_ratio**2)
    return float(np.pi / np.sqrt(4.5) * stiff * total**-1.5)


def point_pressure(
    load: np.ndarray,
    ball_diameter: float,
    pitch_diameter: float,
    inner_radius: float,
    outer_radius: float,
    contact_angle: float,
    youngs_modulus: float = 210e9,
    poisson_ratio: float = 0.3,
) -> tuple[np.ndarray, np.ndarray]:
    """Return the largest pressures in Pa at the inner and the outer ring under loads in N; the rest as for `point_contact`."""
    stiff = youngs_modulus / (1.0 - poisson_ratio**2)
    found = []
    for sum_rho, chi in _rings(ball_diameter, pitch_diameter, inner_radius, outer_radius, contact_angle):
        b = np.cbrt(2.0 * ellipe(1.0 - 1.0 / chi**2) / (np.pi * chi) * 3.0 * np.asarray(load) / (sum_rho * stiff))
        area = np.pi * chi * b**2
        found.append(np.divide(1.5 * np.asarray(load), area, out=np.zeros_like(area), where=area > 0.0))
    return found[0], found[1]


def line_pressure(
    load: np.ndarray,
    length: float,
    roller_diameter: float,
    gamma: float,
    youngs_modulus: float = 210e9,
    poisson_ratio: float = 0.3,
) -> tuple[np.ndarray, np.ndarray]:
    """Return the largest pressures in Pa of a roller at the inner and the outer ring; gamma = D_w cos(alpha)/D_pw."""
    stiff = youngs_modulus / (1.0 - poisson_ratio**2)
    inner, outer = (
        np.sqrt(np.asarray(load) * 2.0 / roller_diameter / (1.0 - side * gamma) * stiff / (2.0 * np.pi * length))
        for side in (1.0, -1.0)
    )
    return inner, outer


def _rings(
    ball_diameter: float, pitch_diameter: float, inner_radius: float, outer_radius: float, contact_angle: float
) -> Iterator[tuple[float, float]]:
    """Yield the sum of curvatures in 1/m and the ratio of the axes of the contact ellipse at the inner and the outer ring."""
    gamma = ball_diameter * np.cos(contact_angle) / pitch_diameter
    for groove, along in ((inner_radius, gamma / (1.0 - gamma)), (outer_radius, -gamma / (1.0 + gamma))):
        total = 2.0 + along - 0.5 * ball_diameter / groove
        difference = (along + 0.5 * ball_diameter / groove) / total
        yield 2.0 / ball_diameter * total, _ellipse(float(difference))


def _ellipse(difference: float) -> float:
    """Ratio of the axes of the contact ellipse, at least 1."""

    def rest(chi: float) -> float:
        m = 1.0 - 1.0 / chi**2
        return float(1.0 - 2.0 / (chi**2 - 1.0) * (ellipk(m) / ellipe(m) - 1.0) - difference)

    return float(brentq(rest, 1.0 + 1e-9, 1e4, xtol=1e-13, rtol=1e-13)) if difference > 1e-9 else 1.0 + 1e-9
