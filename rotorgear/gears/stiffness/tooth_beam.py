"""Compliance of a tooth as a beam of varying thickness on an elastic ring, per unit face width, in the transverse plane.

With the load's inclination a1 = phi - theta to the normal of the tooth's middle line, and y0 where its line meets that:
bending int [cos a1 (y0 - y)]^2 / (E I) dy, shear int 1.2 cos^2 a1 / (G A) dy, compression int sin^2 a1 / (E A) dy, from the
root circle to the load over the real outline; and the ring below the tooth,
cos^2 a1 / E [L (u/S)^2 + M (u/S) + P (1 + Q tan^2 a1)], u = y0 - r_f, S = 2 r_f theta_f, with L M P Q polynomials in
h = r_f / r_inner and theta_f. Reference: P. Sainsot, P. Velex, O. Duverger, Journal of Mechanical Design 126 (2004) 748,
for the ring; D. C. H. Yang, J. Y. Lin, Journal of Mechanisms, Transmissions and Automation in Design 109 (1987) 189, for
the energies. Lengths in m, compliance in m^2/N.
"""

from __future__ import annotations

import math

import numpy as np

from rotorgear.gears.geometry.outline import ToothOutline
from rotorgear.gears.stiffness.mesh_stiffness import ToothBody

# Points on involute and on fillet, between which the integrals over the tooth's height are trapezoidal.
_POINTS = 400
_SHEAR = 1.2  # shear correction of a rectangular section
# A / theta^2 + B h^2 + C h / theta + D / theta + E h + F for L, M, P, Q.
_RING = np.array([
    [-5.574e-5, -1.9986e-3, -2.3015e-4, 4.7702e-3, 0.0271, 6.8045],
    [60.111e-5, 28.100e-3, -83.431e-4, -9.9256e-3, 0.1624, 0.9086],
    [-50.952e-5, 185.50e-3, 0.0538e-4, 53.300e-3, 0.2895, 0.9236],
    [-6.2042e-5, 9.0889e-3, -4.0964e-4, 7.8297e-3, -0.1472, 0.6904],
])  # fmt: skip
# The polynomials were fitted for these ranges of h and theta_f.
RING_RATIO = (1.4, 7.0)
RING_ANGLE = (0.01, 0.12)


def tooth_compliance(outline: ToothOutline, body: ToothBody, roll_length: np.ndarray) -> np.ndarray:
    """Approach of the loaded flank point per force per face width (m^2/N), shape (n,), without the contact itself.

    Args:
        outline: the tooth.
        body: material, and the inner radius of the ring; a smaller one than the fit's is taken as the fit's last.
        roll_length: xi (n,) of the loaded points.
    """
    inclination, cut = _load(outline, roll_length)
    return _beam(outline, body, roll_length, inclination, cut) + _ring(outline, body, inclination, cut)


def _load(outline: ToothOutline, roll: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Inclination a1 of the load, and height y0 at which its line meets the tooth's middle line, each (n,)."""
    radius, half = outline.involute(roll)
    inclination = np.arctan(roll / outline.geometry.base_radius) - half
    return inclination, radius * (np.cos(half) - np.sin(half) * np.tan(inclination))


def _beam(
    outline: ToothOutline, body: ToothBody, roll: np.ndarray, inclination: np.ndarray, cut: np.ndarray
) -> np.ndarray:
    """Bending, shear and compression of the tooth, (n,)."""
    # Height and thickness of the tooth from the root circle to the tip.
    fillet = outline.fillet(np.linspace(1.0, 0.0, _POINTS))
    flank = outline.involute(np.linspace(outline.form_roll_length, outline.tip_roll_length, _POINTS)[1:])
    radii = np.concatenate([fillet[0], flank[0]])
    angles = np.concatenate([fillet[1], flank[1]])
    y = radii * np.cos(angles)
    thickness = 2.0 * radii * np.sin(angles)
    E = body.youngs_modulus
    G = body.youngs_modulus / (2.0 * (1.0 + body.poisson_ratio))

    # I = s^3 / 12 and A = s. (y0 - y)^2 is multiplied out, so that one set of integrals serves every loaded point.
    powers = np.stack([_integral(y, y**k / thickness**3) for k in range(3)])
    slender = _integral(y, 1.0 / thickness)
    radius, half = outline.involute(roll)
    load = radius * np.cos(half)
    zeroth, first, second = (np.interp(load, y, power) for power in powers)
    bending = 12.0 / E * np.cos(inclination) ** 2 * (cut**2 * zeroth - 2.0 * cut * first + second)
    rest = _SHEAR * np.cos(inclination) ** 2 / G + np.sin(inclination) ** 2 / E
    return np.asarray(bending + rest * np.interp(load, y, slender))


def _integral(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Integral of y from the first x to each, by the trapezoidal rule, (n,)."""
    return np.concatenate([[0.0], np.cumsum(0.5 * (y[1:] + y[:-1]) * np.diff(x))])


def _ring(outline: ToothOutline, body: ToothBody, inclination: np.ndarray, cut: np.ndarray) -> np.ndarray:
    """Give of the ring below the tooth, (n,)."""
    # A polynomial says nothing outside the range of h that it was fitted for: the range's end stands in there.
    ratio, theta = ring_shape(outline, body)
    h = min(max(ratio, RING_RATIO[0]), RING_RATIO[1])
    L, M, P, Q = _RING @ np.array([theta**-2, h**2, h / theta, 1.0 / theta, h, 1.0])
    arm = (cut - outline.root_radius) / (2.0 * outline.root_radius * theta)
    tangent = np.tan(inclination)
    return np.asarray(
        np.cos(inclination) ** 2 / body.youngs_modulus * (L * arm**2 + M * arm + P * (1.0 + Q * tangent**2))
    )


def ring_shape(outline: ToothOutline, body: ToothBody) -> tuple[float, float]:
    """h = r_f / r_inner (infinite for a solid gear) and half the angle theta_f of the tooth's root."""
    ratio = outline.root_radius / body.inner_radius if body.inner_radius > 0.0 else math.inf
    return ratio, outline.root_half_angle
