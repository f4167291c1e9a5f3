"""What a gear is measured by: tooth thickness, span over teeth, dimension over balls or pins.

Base tangent: W_k = m_n cos a_n [(k - 1/2) pi + z inv a_t + 2 x tan a_n].
Over balls of diameter D: inv a_K = D / (z m_n cos a_n) - eta_b with half the space at the base circle,
eta_b = (pi/2 - 2 x tan a_n) / z - inv a_t; the centres lie on d_K = d_b / cos a_K, and M = d_K + D, or
M = d_K cos(pi / 2z) + D for an odd number of teeth. With z < 0 the same gives the dimension between balls of a ring, as -M.
Reference: ISO 21771-1. Lengths in m, angles in rad.
"""

from __future__ import annotations

import math
from dataclasses import replace

from rotorgear.errors import AnalysisError
from rotorgear.gears.geometry.geometry import GearGeometry, inverse_involute, involute


def normal_thickness(g: GearGeometry) -> float:
    """s_n (m): tooth thickness at the reference cylinder, normal to the tooth, without allowance."""
    return g.normal_module * (math.pi / 2 + 2.0 * g.profile_shift * math.tan(g.normal_pressure_angle))


def with_allowance(g: GearGeometry, allowance: float) -> GearGeometry:
    """The gear with its normal tooth thickness changed by an allowance (m, negative: thinner), as a generating shift x_E."""
    change = allowance / (2.0 * g.normal_module * math.tan(g.normal_pressure_angle))
    return replace(g, profile_shift=g.profile_shift + change, tip_diameter=g.effective_tip_diameter)


def _space_half_angle(g: GearGeometry) -> float:
    """eta_b (rad): half the tooth space at the base circle, negative where it is closed there; of a ring less than 0."""
    shift = 2.0 * g.profile_shift * math.tan(g.normal_pressure_angle)
    return (math.pi / 2 - shift) / g.teeth - involute(g.transverse_pressure_angle)


def _base_length(g: GearGeometry) -> float:
    """z m_n cos a_n (m): base diameter of a spur gear; with cos b_b of a helical one; with the sign of z."""
    return g.teeth * g.normal_module * math.cos(g.normal_pressure_angle)


def ideal_ball_diameter(g: GearGeometry) -> float:
    """D_M (m) of the ball that touches the flanks at the cylinder d + 2 x m_n, or near the base circle where that is inside.

    With the roll angle t of the touched points and T = tan^2 b_b, a_K solves a_K - t - eta_b + (tan a_K - t) T = 0, and
    D = (tan a_K - t) z m_n cos a_n / cos^2 b_b: the normal from the ball's centre is D/2 long, D/2 cos b_b of it transverse.
    """
    # Where the cylinder d + 2 x m_n lies inside the base circle, the ball touches a thousandth outside it, on the involute.
    shifted = abs(g.reference_diameter + 2.0 * g.profile_shift * g.normal_module)
    middle = max(shifted, 2.0 * abs(g.base_radius) * (1.0 + 1e-3))
    touch = math.sqrt((middle / (2.0 * g.base_radius)) ** 2 - 1.0)
    slant = math.tan(g.base_helix_angle) ** 2
    space = _space_half_angle(g)
    # The ball's centre is farther out than where it touches, in a ring nearer to the axis.
    low, high = (0.0, math.atan(touch)) if g.is_internal else (math.atan(touch), 0.5 * math.pi)
    # The left side grows with a_K throughout, from below 0 at its least; bisection to the last digit (2^-60) can't fail.
    for _ in range(60):
        centre = 0.5 * (low + high)
        if centre - touch - space + (math.tan(centre) - touch) * slant < 0.0:
            low = centre
        else:
            high = centre
    return _base_length(g) * (math.tan(low) - touch) / math.cos(g.base_helix_angle) ** 2


def ball_contact_diameter(g: GearGeometry, ball_diameter: float) -> float:
    """Diameter (m) at which a ball touches the flanks: its roll length is r_b tan a_K - D/2 cos b_b.

    Raises:
        AnalysisError: a ball that touches no flanks.
    """
    centre = (g.sign * over_balls(g, ball_diameter) - ball_diameter) / _oddness(g)
    roll = math.sqrt(max(centre**2 - (2.0 * g.base_radius) ** 2, 0.0))
    return math.hypot(2.0 * g.base_radius, roll - g.sign * ball_diameter * math.cos(g.base_helix_angle))


def over_balls(g: GearGeometry, ball_diameter: float) -> float:
    """M_dK (m): dimension over two balls (of a spur gear, two pins) in opposite spaces; of a ring between them.

    Raises:
        AnalysisError: a ball so small that it falls to the bottom of the space, or too large for that of a ring.
    """
    value = ball_diameter / _base_length(g) - _space_half_angle(g)
    if value <= 0.0:
        raise AnalysisError(
            f"A ball of {1e3 * ball_diameter:.6g} mm touches no flanks of this gear: take a "
            f"{'smaller' if g.is_internal else 'larger'} one, such as {1e3 * ideal_ball_diameter(g):.4g} mm."
        )
    return g.sign * (ball_diameter + 2.0 * g.base_radius / math.cos(inverse_involute(value)) * _oddness(g))


def _oddness(g: GearGeometry) -> float:
    """1 for an even number of teeth; cos(pi / 2z) for an odd one, whose spaces don't stand opposite."""
    return math.cos(math.pi / (2.0 * g.teeth)) if g.teeth % 2 else 1.0


def best_span(g: GearGeometry) -> int:
    """Number of teeth k whose base tangent touches the flanks nearest to the cylinder d + 2 x m_n."""
    middle = max(g.reference_diameter + 2.0 * g.profile_shift * g.normal_module, 2.0 * g.base_radius)
    touch = math.sqrt((middle / (2.0 * g.base_radius)) ** 2 - 1.0) / math.cos(g.base_helix_angle) ** 2
    shift = 2.0 * g.profile_shift * math.tan(g.normal_pressure_angle) / g.teeth
    # A tangent that touches at this cylinder is W_k = z m_n cos a_n tan a_y / cos^2 b_b long; solved for k.
    k = round(g.teeth / math.pi * (touch - shift - involute(g.transverse_pressure_angle)) + 0.5)
    return max(1, min(k, g.teeth - 1)) if g.teeth > 1 else 1


def span_width(g: GearGeometry, teeth_spanned: int) -> float:
    """Least face width (m) on which a base tangent over k teeth can be measured: W_k sin b_b."""
    return g.base_tangent_length(teeth_spanned) * math.sin(g.base_helix_angle)
