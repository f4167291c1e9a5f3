"""Involute geometry of a parallel-axis pair of gears: centre distance, contact ratios, backlash.

inv a_wt = inv a_t + 2 tan a_n (x1 + x2) / (z1 + z2),  a_w = a cos a_t / cos a_wt.

Backlash at zero allowance is j_wt = 2 a_w [inv a_wt(a_w) - inv a_wt(x1 + x2)] at the working circles, along the flank normal
j_bn = j_wt cos a_wt cos b_b. Allowances E_sn of the tooth thickness (negative: thinner) add -(E_sn1 + E_sn2) cos a_n to j_bn
exactly, since cos a_t cos b_b = cos b cos a_n.

A pinion in a ring has the same formulas with z2 < 0: d2, r_b2 and a_w are negative then, and so are roll lengths of the ring.

Reference: ISO 21771-1, Cylindrical involute gears and gear pairs; ISO/TR 10064-2 for allowances. Lengths in m, angles in rad.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from rotorgear.errors import AnalysisError
from rotorgear.gears.geometry.geometry import GearGeometry, inverse_involute, involute


def _require_mates(g1: GearGeometry, g2: GearGeometry) -> None:
    """AnalysisError unless the two gears share the normal module, the normal pressure angle and the helix angle."""
    if g1.is_internal or g1.teeth + g2.teeth == 0 or g2.is_internal != (g1.teeth + g2.teeth < 0):
        raise AnalysisError(
            f"A ring of {abs(g2.teeth)} teeth can't hold a pinion of {abs(g1.teeth)}: it needs more teeth, and is the gear."
        )
    for name in ("normal_module", "normal_pressure_angle", "helix_angle"):
        one = getattr(g1, name)
        two = getattr(g2, name)
        if not math.isclose(one, two, rel_tol=1e-9):
            words = name.replace("_", " ")
            raise AnalysisError(
                f"The two gears of a mesh need the same {words}, but have {one:.9g} and {two:.9g} (m, rad)."
            )


def standard_centre_distance(g1: GearGeometry, g2: GearGeometry) -> float:
    """a = (d1 + d2) / 2 (m); AnalysisError when the gears don't mate."""
    _require_mates(g1, g2)
    return 0.5 * (g1.reference_diameter + g2.reference_diameter)


def working_pressure_angle_from_shifts(g1: GearGeometry, g2: GearGeometry) -> float:
    """a_wt (rad) of the mesh without backlash; AnalysisError when the sum of shifts is too negative for one."""
    _require_mates(g1, g2)
    shifts = 2.0 * math.tan(g1.normal_pressure_angle) * (g1.profile_shift + g2.profile_shift) / (g1.teeth + g2.teeth)
    value = involute(g1.transverse_pressure_angle) + shifts
    if value < 0.0:
        raise AnalysisError(
            f"The profile shifts {g1.profile_shift:g} and {g2.profile_shift:g} are too "
            f"{'large' if g2.is_internal else 'negative'} for {g1.teeth} and {abs(g2.teeth)} teeth to "
            f"mesh at any centre distance: {'lower' if g2.is_internal else 'raise'} one of them."
        )
    return inverse_involute(value)


def working_pressure_angle_from_centre(g1: GearGeometry, g2: GearGeometry, centre_distance: float) -> float:
    """a_wt (rad) at a centre distance (m, negative in a ring): cos a_wt = (r_b1 + r_b2) / a_w.

    Raises:
        AnalysisError: a distance below the sum of the base radii, of a ring below their difference.
    """
    _require_mates(g1, g2)
    least = g1.base_radius + g2.base_radius
    if not abs(least) < g2.sign * centre_distance < math.inf:
        what = "have a difference of" if g2.is_internal else "add up to"
        raise AnalysisError(
            f"A centre distance of {1e3 * abs(centre_distance):.6g} mm is impossible for gears whose base radii {what} "
            f"{1e3 * abs(least):.6g} mm: give a larger one."
        )
    return math.acos(least / centre_distance)


def working_centre_distance(g1: GearGeometry, g2: GearGeometry) -> float:
    """a_w (m) at which the shifted teeth mesh without backlash."""
    return (g1.base_radius + g2.base_radius) / math.cos(working_pressure_angle_from_shifts(g1, g2))


def profile_shift_sum(g1: GearGeometry, g2: GearGeometry, centre_distance: float) -> float:
    """x1 + x2 that gives zero backlash at a centre distance (m); the shifts of the two gears themselves don't enter."""
    difference = involute(working_pressure_angle_from_centre(g1, g2, centre_distance))
    difference -= involute(g1.transverse_pressure_angle)
    return difference * (g1.teeth + g2.teeth) / (2.0 * math.tan(g1.normal_pressure_angle))


@dataclass(frozen=True)
class PairGeometry:
    """A parallel-axis pair of gears at its centre distance, one helix; lengths in m, angles in rad.

    Attributes:
        centre_distance: a_w, negative of a pinion in a ring.
        working_transverse_pressure_angle: a_wt.
        working_helix_angle: b_w, at the working pitch circles.
        base_helix_angle: b_b.
        transverse_contact_ratio: eps_alpha; only nominal with interference.
        overlap_ratio: eps_beta.
        start_of_contact: SAP, where the tip of gear 2 meets the flank: xi on the line of action from the pitch point,
            positive from the base tangent point of gear 1 towards that of gear 2.
        end_of_contact: EAP, where the tip of gear 1 leaves, as xi.
        interference: whether a tip reaches past the base tangent point of its mate; the flank of a ring has none on this line.
        transverse_backlash: j_wt, an arc at the working pitch circles; negative where the teeth would have to overlap.
    """

    centre_distance: float
    working_transverse_pressure_angle: float
    working_helix_angle: float
    base_helix_angle: float
    transverse_contact_ratio: float
    overlap_ratio: float
    start_of_contact: float
    end_of_contact: float
    interference: bool
    transverse_backlash: float

    @property
    def total_contact_ratio(self) -> float:
        """eps_gamma = eps_alpha + eps_beta."""
        return self.transverse_contact_ratio + self.overlap_ratio

    @property
    def normal_backlash(self) -> float:
        """j_bn = j_wt cos a_wt cos b_b (m): play between the two flanks along the flank normal."""
        transverse = self.transverse_backlash * math.cos(self.working_transverse_pressure_angle)
        return transverse * math.cos(self.base_helix_angle)

    def active_root_diameters(self, g1: GearGeometry, g2: GearGeometry) -> tuple[float, float]:
        """d_Nf of both gears (m): where contact with the mate's tip begins; the base diameter with interference.

        That of a ring is negative as all its diameters.
        """
        tangent = math.tan(self.working_transverse_pressure_angle)
        first = max(g1.base_radius * tangent + self.start_of_contact, 0.0)
        second = max(g2.sign * (g2.base_radius * tangent - self.end_of_contact), 0.0)
        return 2.0 * math.hypot(g1.base_radius, first), 2.0 * g2.sign * math.hypot(g2.base_radius, second)


def _path_beyond_pitch_point(g: GearGeometry, angle: float) -> float:
    """Length of action (m) from the pitch point to where the tip circle of g cuts the line of action at angle a_wt."""
    tip = 0.5 * g.effective_tip_diameter
    if abs(tip) <= abs(g.base_radius):
        raise AnalysisError(
            f"The tip diameter of {2e3 * abs(tip):.6g} mm is not above the base diameter of {2e3 * abs(g.base_radius):.6g} mm: "
            "there is no flank to mesh with."
        )
    # sqrt(r_a^2 - r_b^2) as a product, which keeps its digits for a short flank.
    return g.sign * math.sqrt((tip - g.base_radius) * (tip + g.base_radius)) - g.base_radius * math.tan(angle)


def pair_geometry(
    g1: GearGeometry, g2: GearGeometry, width: float, centre_distance: float | None = None
) -> PairGeometry:
    """Geometry of the mesh of g1 and g2 over the width (m) of one helix, at a centre distance (m) or without backlash.

    eps_alpha = (EAP - SAP) / p_bt, eps_beta = width sin b / (pi m_n). The backlash is the working pitch less the two
    working tooth thicknesses, j_wt = 2 a_w [inv a_wt(a_w) - inv a_wt(x1 + x2)]: zero at the working centre distance.

    Raises:
        AnalysisError: gears that don't mate, a centre distance too small, or so large that the teeth don't meet.
    """
    if not 0.0 < width < math.inf:
        raise AnalysisError(f"The common face width of a mesh must be positive and finite, not {width:g} m.")
    free = working_pressure_angle_from_shifts(g1, g2)
    if centre_distance is None:
        angle = free
        distance = working_centre_distance(g1, g2)
    else:
        angle = working_pressure_angle_from_centre(g1, g2, centre_distance)
        distance = centre_distance
    end = _path_beyond_pitch_point(g1, angle)
    start = -_path_beyond_pitch_point(g2, angle)
    if end <= start:
        raise AnalysisError(
            f"At a centre distance of {1e3 * abs(distance):.6g} mm the teeth don't meet: "
            f"{'increase' if g2.is_internal else 'reduce'} it, or make the teeth higher at their tips."
        )
    # The lead is the same at every cylinder, so tan b grows with its radius: d_w / d = cos a_t / cos a_wt.
    stretch = math.cos(g1.transverse_pressure_angle) / math.cos(angle)
    return PairGeometry(
        centre_distance=distance,
        working_transverse_pressure_angle=angle,
        working_helix_angle=math.atan(math.tan(g1.helix_angle) * stretch),
        base_helix_angle=g1.base_helix_angle,
        transverse_contact_ratio=(end - start) / g1.transverse_base_pitch,
        overlap_ratio=width * math.sin(g1.helix_angle) / (math.pi * g1.normal_module),
        start_of_contact=start,
        end_of_contact=end,
        interference=-start > g1.base_radius * math.tan(angle)
        or (not g2.is_internal and end > g2.base_radius * math.tan(angle)),
        transverse_backlash=2.0 * distance * (involute(angle) - involute(free)),
    )


@dataclass(frozen=True)
class Allowance:
    """Upper and lower allowance E_sns >= E_sni (m) of the normal tooth thickness at the reference cylinder; 0 or negative."""

    upper: float = 0.0
    lower: float = 0.0

    @property
    def mean(self) -> float:
        """Middle of the two (m)."""
        return 0.5 * (self.upper + self.lower)


@dataclass(frozen=True)
class Backlash:
    """Normal backlash j_bn (m) along the flank normal: smallest, mean and largest; negative where teeth jam."""

    least: float
    mean: float
    most: float


def normal_backlash(
    g1: GearGeometry,
    g2: GearGeometry,
    centre_distance: float,
    first: Allowance = Allowance(),
    second: Allowance = Allowance(),
    centre_allowance: float = 0.0,
) -> Backlash:
    """Normal backlash of a pair at a centre distance (m), which may deviate by +- centre_allowance (m)."""

    def at(distance: float, allowances: float) -> float:
        pair = pair_geometry(g1, g2, 1.0, distance)  # the width is that of the overlap ratio only
        return pair.normal_backlash - allowances * math.cos(g1.normal_pressure_angle)

    return Backlash(
        least=at(centre_distance - centre_allowance, first.upper + second.upper),
        mean=at(centre_distance, first.mean + second.mean),
        most=at(centre_distance + centre_allowance, first.lower + second.lower),
    )
