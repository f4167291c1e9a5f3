"""Mesh stiffness by potential energy: slices of teeth as beams on an elastic ring, in series with Hertz' contact.

A slice of the pair has 1/k = c_1(xi_1) + c_2(xi_2) + 2 / (pi E*), 1/E* = sum (1 - nu^2)/E; slices of one contact line and
lines of several pairs act in parallel, each by itself. That leaves out that neighbouring slices and teeth share one body:
a preview beside tooth FE, too stiff along the face and too soft where two pairs share a ring. Of a gear with a web it takes the
rim as the ring, held at its inside, and leaves out web and hub: a thinner rim comes out stiffer, and a warning says so.
"""

from __future__ import annotations

import math

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.gears.geometry.outline import ToothOutline, tooth_outline
from rotorgear.gears.stiffness.blank_note import web_left_out
from rotorgear.gears.stiffness.contact_lines import contact_lines
from rotorgear.gears.stiffness.mesh_stiffness import MeshStiffness, ToothPair
from rotorgear.gears.stiffness.tooth_beam import RING_ANGLE, RING_RATIO, ring_shape, tooth_compliance

# Points of the path of contact at which the compliance is computed.
_PATH = 201
# Gauss points along a contact line.
_GAUSS = 12
# Positions within an interval of the period over which the stiffness is averaged.
_FINER = 16


def slice_stiffness(teeth: ToothPair, position: np.ndarray) -> np.ndarray:
    """Stiffness of one pair per face width (N/m^2), shape (n,), touching at positions (n,) from the pitch point."""
    tangent = math.tan(teeth.pair.working_transverse_pressure_angle)
    outlines = _outlines(teeth)
    bodies = (teeth.first_body, teeth.second_body)
    # Roll lengths on both flanks: they add up to the distance between the base tangent points.
    first = teeth.first.base_radius * tangent + position
    second = teeth.second.base_radius * tangent - position
    give = sum(
        tooth_compliance(outline, body, roll)
        for outline, body, roll in zip(outlines, bodies, (first, second), strict=True)
    )
    # Hertz' approach of two cylinders depends on the load by a logarithm only; 2 / (pi E*) is its constant of Yang and Sun.
    contact = 2.0 / math.pi * sum((1.0 - body.poisson_ratio**2) / body.youngs_modulus for body in bodies)
    return np.asarray(1.0 / (give + contact))


def _outlines(teeth: ToothPair) -> tuple[ToothOutline, ToothOutline]:
    return tooth_outline(teeth.first), tooth_outline(teeth.second)


def potential_energy_stiffness(teeth: ToothPair, load: float | None, positions: int) -> MeshStiffness:
    """Sum of all slices in contact over one mesh period; it does not depend on the load.

    Raises:
        AnalysisError: interference, or teeth that can't be cut.
    """
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
    u = (start[:, None] + inside / positions).ravel()
    xi, low, high = contact_lines(teeth, u)
    nodes, weights = np.polynomial.legendre.leggauss(_GAUSS)
    z = 0.5 * (low + high)[..., None] + 0.5 * (high - low)[..., None] * nodes
    along = np.interp(xi[..., None] + z * math.tan(teeth.pair.base_helix_angle), path, per_width)
    total = np.sum(0.5 * (high - low) * (along @ weights), axis=1).reshape(positions, _FINER).mean(axis=1)
    # Where the ring was held: its bore, or the end of the range that the ring formula was fitted for.
    held = [
        outline.root_radius / min(max(ring_shape(outline, body)[0], RING_RATIO[0]), RING_RATIO[1])
        for outline, body in zip(_outlines(teeth), (teeth.first_body, teeth.second_body), strict=True)
    ]
    return MeshStiffness(
        model="potential_energy",
        position=start,
        transverse=total,
        definition="secant",
        helices=1,
        load=load,
        body="; ".join(f"ring held at radius {1e3 * radius:.4g} mm" for radius in held),
        base_helix_angle=teeth.pair.base_helix_angle,
        warnings=_warnings(teeth),
    )


def _warnings(teeth: ToothPair) -> tuple[str, ...]:
    """Where the teeth lie outside what beam and ring formula were made for."""
    sentences = []
    bodies = (teeth.first_body, teeth.second_body)
    pair = teeth.pair
    tangent = math.tan(pair.working_transverse_pressure_angle)
    lowest = (
        teeth.first.base_radius * tangent + pair.start_of_contact,
        teeth.second.base_radius * tangent - pair.end_of_contact,
    )
    for number, (outline, body) in enumerate(zip(_outlines(teeth), bodies, strict=True), 1):
        ratio, angle = ring_shape(outline, body)
        if lowest[number - 1] < outline.form_roll_length - 1e-6 * outline.geometry.base_radius:
            sentences.append(f"gear {number}: contact begins in the fillet, which is taken as involute there")
        if ratio < RING_RATIO[0]:
            sentences.append(
                f"gear {number}: the rim is thinner than the ring formula covers (r_f / r_inner = {ratio:.3g})"
            )
        if not RING_ANGLE[0] <= angle <= RING_ANGLE[1]:
            sentences.append(
                f"gear {number}: theta_f = {angle:.3g} rad is outside 0.01 ... 0.12, the range of the ring formula"
            )
        sentences += web_left_out(f"gear {number}", outline.geometry, body, teeth.width, "the elastic ring")
    return tuple(sentences)
