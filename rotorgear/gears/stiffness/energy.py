"""Mesh stiffness by potential energy: slices of teeth as beams on an elastic ring, in series with Hertz' contact.

A slice of the pair has 1/k = c_1(xi_1) + c_2(xi_2) + 2 / (pi E*), 1/E* = sum (1 - nu^2)/E; slices of one contact line and
lines of several pairs act in parallel, each by itself. That leaves out that neighbouring slices and teeth share one body:
a preview beside tooth FE, too stiff along the face and too soft where two pairs share a ring. Of a gear with a web it takes the
rim as the ring, held at its inside, and leaves out web and hub: a thinner rim comes out stiffer, and a warning says so.

A tooth is a beam of varying thickness on that ring, per unit face width, in the transverse plane. With the load's inclination
a1 = phi - theta to the normal of the tooth's middle line, and y0 where its line meets that: bending int [cos a1 (y0 - y)]^2 /
(E I) dy, shear int 1.2 cos^2 a1 / (G A) dy, compression int sin^2 a1 / (E A) dy, from the root circle to the load over the
real outline; and the ring below the tooth, cos^2 a1 / E [L (u/S)^2 + M (u/S) + P (1 + Q tan^2 a1)], u = y0 - r_f, S = 2 r_f
theta_f, with L M P Q polynomials in h = r_f / r_inner and theta_f. Reference: P. Sainsot, P. Velex, O. Duverger, Journal of
Mechanical Design 126 (2004) 748, for the ring; D. C. H. Yang, J. Y. Lin, Journal of Mechanisms, Transmissions and Automation
in Design 109 (1987) 189, for the energies. Lengths in m, compliance in m^2/N.
"""

from __future__ import annotations

import math

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.gears.geometry.outline import ToothOutline, tooth_outline
from rotorgear.gears.stiffness.blank_note import web_left_out
from rotorgear.gears.stiffness.contact_lines import contact_lines
from rotorgear.gears.stiffness.mesh_stiffness import MeshStiffness, ToothBody, ToothPair

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
    inclination, cut, height = _load(outline, roll_length)
    # The ring below. A polynomial says nothing outside the range of h that it was fitted for: the range's end stands in there.
    ratio, theta = ring_shape(outline, body)
    h = min(max(ratio, RING_RATIO[0]), RING_RATIO[1])
    L, M, P, Q = _RING @ np.array([theta**-2, h**2, h / theta, 1.0 / theta, h, 1.0])
    arm = (cut - outline.root_radius) / (2.0 * outline.root_radius * theta)
    tangent = np.tan(inclination)
    ring = np.cos(inclination) ** 2 / body.youngs_modulus * (L * arm**2 + M * arm + P * (1.0 + Q * tangent**2))
    return np.asarray(_beam(outline, body, inclination, cut, height) + ring)


def _load(outline: ToothOutline, roll: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Inclination a1 of the load, height y0 at which its line meets the tooth's middle line, and its own height, each (n,)."""
    radius, half = outline.involute(roll)
    inclination = np.arctan(roll / outline.geometry.base_radius) - half
    return inclination, radius * (np.cos(half) - np.sin(half) * np.tan(inclination)), radius * np.cos(half)


def _beam(
    outline: ToothOutline, body: ToothBody, inclination: np.ndarray, cut: np.ndarray, height: np.ndarray
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
    zeroth, first, second = (np.interp(height, y, _integral(y, y**k / thickness**3)) for k in range(3))
    bending = 12.0 / E * np.cos(inclination) ** 2 * (cut**2 * zeroth - 2.0 * cut * first + second)
    rest = _SHEAR * np.cos(inclination) ** 2 / G + np.sin(inclination) ** 2 / E
    return np.asarray(bending + rest * np.interp(height, y, _integral(y, 1.0 / thickness)))


def _integral(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Integral of y from the first x to each, by the trapezoidal rule, (n,)."""
    return np.concatenate([[0.0], np.cumsum(0.5 * (y[1:] + y[:-1]) * np.diff(x))])


def ring_shape(outline: ToothOutline, body: ToothBody) -> tuple[float, float]:
    """h = r_f / r_inner (infinite for a solid gear) and half the angle theta_f of the tooth's root."""
    ratio = outline.root_radius / body.inner_radius if body.inner_radius > 0.0 else math.inf
    return ratio, outline.root_half_angle


# Points of the path of contact at which the compliance is computed.
_PATH = 201
# Gauss points along a contact line.
_GAUSS = 12
# Positions within an interval of the period over which the stiffness is averaged.
_FINER = 16


def slice_stiffness(teeth: ToothPair, position: np.ndarray) -> np.ndarray:
    """Stiffness of one pair per face width (N/m^2), shape (n,), touching at positions (n,) from the pitch point."""
    tangent = math.tan(teeth.pair.working_transverse_pressure_angle)
    bodies = (teeth.first_body, teeth.second_body)
    # Roll lengths on both flanks: they add up to the distance between the base tangent points.
    first = teeth.first.base_radius * tangent + position
    second = teeth.second.base_radius * tangent - position
    give = sum(
        tooth_compliance(tooth_outline(g), body, roll)
        for g, body, roll in zip((teeth.first, teeth.second), bodies, (first, second), strict=True)
    )
    # Hertz' approach of two cylinders depends on the load by a logarithm only; 2 / (pi E*) is its constant of Yang and Sun.
    contact = 2.0 / math.pi * sum((1.0 - body.poisson_ratio**2) / body.youngs_modulus for body in bodies)
    return np.asarray(1.0 / (give + contact))


def potential_energy_stiffness(teeth: ToothPair, load: float | None, positions: int) -> MeshStiffness:
    """Sum of all slices in contact over one mesh period; it does not depend on the load.

    Raises:
        AnalysisError: a ring, interference, or teeth that can't be cut.
    """
    if teeth.second.is_internal:
        raise AnalysisError(
            "the stiffness model 'potential_energy' has no ring with its teeth inside: its formulas are of external teeth; use "
            "'iso', 'contact_line' or a number."
        )
    if teeth.pair.interference:
        raise AnalysisError(
            "a tip reaches past the base tangent point of its mate (interference), where the tooth has no involute to "
            "compute a stiffness of: reduce the tip diameter, or use more teeth or profile shift."
        )
    path = np.linspace(teeth.pair.start_of_contact, teeth.pair.end_of_contact, _PATH)
    per_width = slice_stiffness(teeth, path)
    # Each value is a mean over its interval: a jump, where a pair of spur teeth enters, then counts by the share of the interval
    # behind it, wherever the positions happen to fall.
    inside = (np.arange(_FINER) + 0.5) / _FINER - 0.5
    start = np.arange(positions) / positions
    xi, low, high = contact_lines(teeth, (start[:, None] + inside / positions).ravel())
    nodes, weights = np.polynomial.legendre.leggauss(_GAUSS)
    z = 0.5 * (low + high)[..., None] + 0.5 * (high - low)[..., None] * nodes
    along = np.interp(xi[..., None] + z * math.tan(teeth.pair.base_helix_angle), path, per_width)
    total = np.sum(0.5 * (high - low) * (along @ weights), axis=1).reshape(positions, _FINER).mean(axis=1)
    held = []
    notes: list[str] = []
    tangent = math.tan(teeth.pair.working_transverse_pressure_angle)
    lowest = (
        teeth.first.base_radius * tangent + teeth.pair.start_of_contact,
        teeth.second.base_radius * tangent - teeth.pair.end_of_contact,
    )
    bodies = (teeth.first_body, teeth.second_body)
    for number, (g, body, roll) in enumerate(zip((teeth.first, teeth.second), bodies, lowest, strict=True), 1):
        outline = tooth_outline(g)
        ratio, angle = ring_shape(outline, body)
        # The ring is held at its bore, or at the end of the range that its formula was fitted for.
        radius = outline.root_radius / min(max(ratio, RING_RATIO[0]), RING_RATIO[1])
        held.append(f"ring held at radius {1e3 * radius:.4g} mm")
        if roll < outline.form_roll_length - 1e-6 * g.base_radius:
            notes.append(f"gear {number}: contact begins in the fillet, which is taken as involute there")
        if ratio < RING_RATIO[0]:
            notes.append(
                f"gear {number}: the rim is thinner than the ring formula covers (r_f / r_inner = {ratio:.3g})"
            )
        if not RING_ANGLE[0] <= angle <= RING_ANGLE[1]:
            notes.append(
                f"gear {number}: theta_f = {angle:.3g} rad is outside 0.01 ... 0.12, the range of the ring formula"
            )
        notes += web_left_out(f"gear {number}", g, body, teeth.width, "the elastic ring")
    return MeshStiffness(
        model="potential_energy",
        position=start,
        transverse=total,
        definition="secant",
        load=load,
        body="; ".join(held),
        base_helix_angle=teeth.pair.base_helix_angle,
        warnings=tuple(notes),
    )
