"""Involute geometry of one cylindrical gear, and the involute function inv(a) = tan a - a with its inverse.

tan a_t = tan a_n / cos b,  m_t = m_n / cos b,  r_b = z m_t cos a_t / 2,  sin b_b = sin b cos a_n.
A ring with its teeth inside has z < 0, and with it all its diameters and roll lengths: the formulas are then the same.
Reference: ISO 21771-1, Cylindrical involute gears and gear pairs. Lengths in m, angles in rad. Hand and torque
sense have no place here: helix_angle >= 0 always, and the mesh element adds the sign.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from rotorgear.errors import AnalysisError

# Below tan(angle) = 0.5 the series of t - atan(t) is used: the plain difference would lose digits.
_SERIES_LIMIT = 0.5


def _tangent_minus_angle(t: float) -> float:
    """t - atan(t) for t >= 0 with full relative accuracy: t^3/3 - t^5/5 + ... where the difference would cancel."""
    if t >= _SERIES_LIMIT:
        return t - math.atan(t)
    total = 0.0
    power = t**3
    order = 3
    while power / order > 1e-18 * abs(total):
        total += power / order if order % 4 == 3 else -power / order
        power *= t * t
        order += 2
    return total


def involute(angle: float) -> float:
    """Involute function inv(angle) = tan(angle) - angle for 0 <= angle < pi/2 rad; AnalysisError outside."""
    if not 0.0 <= angle < math.pi / 2:
        raise AnalysisError(
            f"The involute function needs an angle from 0 to below 90 deg, not {math.degrees(angle):g} deg."
        )
    return _tangent_minus_angle(math.tan(angle))


def inverse_involute(value: float) -> float:
    """Angle (rad) whose involute function is `value` >= 0, to rounding; AnalysisError for a negative or infinite value.

    Newton on t = tan(angle): f(t) = t - atan(t) - value is convex and increasing, so from the second step on the
    iterates come down to the root monotonically; it ends where rounding stops the descent.
    """
    if not 0.0 <= value < math.inf:
        raise AnalysisError(f"No angle has the involute function {value:g}: give a finite value of zero or more.")
    if value == 0.0:
        return 0.0
    t = 1.44 * math.cbrt(value)  # just below cbrt(3 value), the leading term of the series: left of the root
    t -= (_tangent_minus_angle(t) - value) * (1.0 + t**-2)
    while (lower := t - (_tangent_minus_angle(t) - value) * (1.0 + t**-2)) < t:
        t = lower
    return math.atan(t)


# Below this tip thickness in normal modules a tooth counts as nearly pointed (the customary limit of gear design).
THIN_TIP = 0.2


@dataclass(frozen=True)
class GearGeometry:
    """Tooth data of one gear (one helix of a herringbone gear); ISO 21771-1.

    Values without meaning raise AnalysisError; `check_gear` tells which meaningful values make a bad or an impossible tooth.

    Attributes:
        teeth: z, negative of a ring.
        normal_module: m_n (m).
        normal_pressure_angle: a_n (rad).
        helix_angle: b (rad) at the reference cylinder, 0 or positive.
        profile_shift: x in normal modules; positive makes teeth thicker and tips higher, of a ring as well.
        addendum_factor: h_aP of the basic rack in normal modules.
        dedendum_factor: h_fP of the basic rack in normal modules.
        tip_diameter: d_a (m) as given, negative of a ring; None means d + 2 m_n (h_aP + x). `effective_tip_diameter` is the one
            in force.
        root_radius_factor: rho_fP in normal modules as given; None means that of ISO 53. `tool_tip_radius_factor` is the
            one in force of an external gear; a ring has that of its `cutter`.
        cutter_teeth: of the pinion-type cutter that makes a ring; None for the `cutter`'s own choice.
    """

    teeth: int
    normal_module: float
    normal_pressure_angle: float
    helix_angle: float
    profile_shift: float = 0.0
    addendum_factor: float = 1.0
    dedendum_factor: float = 1.25
    tip_diameter: float | None = None
    root_radius_factor: float | None = None
    cutter_teeth: int | None = None

    def __post_init__(self) -> None:
        if self.teeth == 0 or self.teeth != int(self.teeth):
            raise AnalysisError(f"A gear needs a whole number of teeth, at least one, not {self.teeth}.")
        tip = self.tip_diameter
        lengths = {"normal module": self.normal_module, "tip diameter": -tip if tip and self.is_internal else tip}
        factors = {"addendum factor": self.addendum_factor, "dedendum factor": self.dedendum_factor}
        for name, value in (lengths | factors).items():
            if value is not None and not 0.0 < value < math.inf:
                raise AnalysisError(f"The {name} of a gear must be positive and finite, not {value:g}.")
        if self.root_radius_factor is not None and not 0.0 <= self.root_radius_factor < math.inf:
            raise AnalysisError(f"The root radius factor of a gear must be 0 or more, not {self.root_radius_factor:g}.")
        if not 0.0 < self.normal_pressure_angle < math.pi / 2:
            angle = math.degrees(self.normal_pressure_angle)
            raise AnalysisError(f"The normal pressure angle must lie between 0 and 90 deg, not at {angle:g} deg.")
        if not 0.0 <= self.helix_angle < math.pi / 2:
            angle = math.degrees(self.helix_angle)
            raise AnalysisError(
                f"The helix angle must be 0 or more and below 90 deg, not {angle:g} deg; the hand is given apart."
            )
        if not math.isfinite(self.profile_shift):
            raise AnalysisError(f"The profile shift must be a finite number, not {self.profile_shift:g}.")

    @property
    def is_internal(self) -> bool:
        """Whether it is a ring with its teeth inside."""
        return self.teeth < 0

    @property
    def sign(self) -> int:
        """z / |z|: -1 of a ring, else 1."""
        return -1 if self.is_internal else 1

    @property
    def transverse_module(self) -> float:
        """m_t (m)."""
        return self.normal_module / math.cos(self.helix_angle)

    @property
    def transverse_pressure_angle(self) -> float:
        """a_t (rad)."""
        return math.atan(math.tan(self.normal_pressure_angle) / math.cos(self.helix_angle))

    @property
    def reference_diameter(self) -> float:
        """d (m)."""
        return self.teeth * self.transverse_module

    @property
    def base_radius(self) -> float:
        """r_b (m)."""
        return 0.5 * self.reference_diameter * math.cos(self.transverse_pressure_angle)

    @property
    def base_helix_angle(self) -> float:
        """b_b (rad)."""
        return math.asin(math.sin(self.helix_angle) * math.cos(self.normal_pressure_angle))

    @property
    def effective_tip_diameter(self) -> float:
        """d_a (m): the given tip diameter, or that of the shifted basic rack without tip alteration."""
        if self.tip_diameter is not None:
            return self.tip_diameter
        return self.reference_diameter + 2.0 * self.normal_module * (self.addendum_factor + self.profile_shift)

    @property
    def root_diameter(self) -> float:
        """d_f (m), nominal, without allowance for backlash."""
        return self.reference_diameter - 2.0 * self.normal_module * (self.dedendum_factor - self.profile_shift)

    @property
    def transverse_base_pitch(self) -> float:
        """p_bt (m)."""
        return math.pi * self.transverse_module * math.cos(self.transverse_pressure_angle)

    @property
    def virtual_teeth(self) -> float:
        """z_n = z / (cos^2 b_b cos b), with the sign of z: teeth of the equivalent spur gear in the normal section."""
        return self.teeth / (math.cos(self.base_helix_angle) ** 2 * math.cos(self.helix_angle))

    @property
    def lead(self) -> float:
        """p_z = pi |d| / tan b (m); infinite for a spur gear."""
        return math.pi * abs(self.reference_diameter) / math.tan(self.helix_angle) if self.helix_angle else math.inf

    @property
    def full_radius_factor(self) -> float:
        """Largest rho_fP at which the tool's tip is still as deep as h_fP: its two roundings meet; negative where none is."""
        # A circle of radius rho that touches the rack's flank and its tip line takes rho (1 - sin a) / cos a of that line; half
        # of the land, pi/4 - h_fP tan a, is all there is.
        alpha = self.normal_pressure_angle
        half_land = math.pi / 4 - self.dedendum_factor * math.tan(alpha)
        return half_land * math.cos(alpha) / (1.0 - math.sin(alpha))

    @property
    def tool_tip_radius_factor(self) -> float:
        """rho_fP in force: the given one or that of ISO 53, c_P / (1 - sin a_n), at most the full radius."""
        wanted = self.root_radius_factor
        if wanted is None:
            wanted = (self.dedendum_factor - self.addendum_factor) / (1.0 - math.sin(self.normal_pressure_angle))
        return max(0.0, min(wanted, self.full_radius_factor))

    @property
    def straight_flank_factor(self) -> float:
        """h_FfP: depth of the rack's straight flank below its datum line, h_fP - rho_fP (1 - sin a_n) (ISO 53)."""
        return self.dedendum_factor - self.tool_tip_radius_factor * (1.0 - math.sin(self.normal_pressure_angle))

    @property
    def tool_form_roll_length(self) -> float:
        """xi (m) of the flank point that the end of the rack's straight flank cuts; negative for an undercut tooth."""
        depth = self.normal_module * (self.straight_flank_factor - self.profile_shift)
        sine = math.sin(self.transverse_pressure_angle)
        return 0.5 * self.reference_diameter * sine - depth / sine

    @property
    def minimum_profile_shift(self) -> float:
        """x below which the rack's straight flanks of depth h_FfP (ISO 53) undercut the tooth."""
        half_base = self.teeth * math.sin(self.transverse_pressure_angle) ** 2 / (2.0 * math.cos(self.helix_angle))
        return self.straight_flank_factor - half_base

    @property
    def is_undercut(self) -> bool:
        """Whether the profile shift is below `minimum_profile_shift`; no rack cuts a ring."""
        return not self.is_internal and self.profile_shift < self.minimum_profile_shift

    def transverse_thickness(self, diameter: float) -> float:
        """s_yt (m): arc between the two flanks of a tooth at a diameter; negative where they have crossed.

        s_yt = d_y [(pi/2 + 2 x tan a_n) / z + inv a_t - inv a_yt].

        Raises:
            AnalysisError: a diameter below the base circle, where there is no involute.
        """
        base = 2.0 * self.base_radius
        if not abs(base) <= self.sign * diameter < math.inf:
            raise AnalysisError(
                f"There is no involute at diameter {1e3 * abs(diameter):g} mm: give one of at least the base diameter, "
                f"{1e3 * abs(base):g} mm."
            )
        shift = 2.0 * self.profile_shift * math.tan(self.normal_pressure_angle)
        half_angles = (math.pi / 2 + shift) / self.teeth + involute(self.transverse_pressure_angle)
        return diameter * (half_angles - involute(math.acos(base / diameter)))

    @property
    def transverse_tip_thickness(self) -> float:
        """s_at (m): arc of the tip land in the transverse section."""
        return self.transverse_thickness(self.effective_tip_diameter)

    @property
    def normal_tip_thickness(self) -> float:
        """s_an (m): tip thickness across the tooth, s_at cos b_a with the helix angle at the tip."""
        tip = self.effective_tip_diameter / self.reference_diameter
        return self.transverse_tip_thickness * math.cos(math.atan(math.tan(self.helix_angle) * tip))

    def base_tangent_length(self, teeth_spanned: int) -> float:
        """W_k = m_n cos a_n [(k - 1/2) pi + z inv a_t + 2 x tan a_n] (m): span over k teeth, measured normal to them."""
        normal = (teeth_spanned - 0.5) * math.pi + self.teeth * involute(self.transverse_pressure_angle)
        normal += 2.0 * self.profile_shift * math.tan(self.normal_pressure_angle)
        return self.normal_module * math.cos(self.normal_pressure_angle) * normal


def impossible_teeth(g: GearGeometry) -> list[str]:
    """Sentences on circles in the wrong order; any of them means that there is no tooth to speak of."""
    tip, root, base = (1e3 * d for d in (g.effective_tip_diameter, g.root_diameter, 2.0 * g.base_radius))
    if g.is_internal:
        if tip >= 0.0:
            return ["The teeth of the ring reach to its axis: use more teeth or a smaller addendum or profile shift."]
        if root >= tip:
            return [
                f"The tip diameter of {-tip:.6g} mm is not below the root diameter of {-root:.6g} mm: there is no tooth."
            ]
        if tip >= base:
            return [
                f"The tip diameter of {-tip:.6g} mm is not above the base diameter of {-base:.6g} mm, where the involutes of a "
                f"ring end: give a larger tip_diameter, more teeth, or less addendum or profile shift."
            ]
        return []
    if g.full_radius_factor < 0.0:
        return [
            f"The basic rack is pointed before it is {g.dedendum_factor:.6g} normal modules deep: "
            "use a smaller dedendum or pressure angle."
        ]
    if root <= 0.0:
        return [f"The root diameter is {root:.6g} mm, not positive: use more teeth or a smaller dedendum."]
    if tip <= root:
        return [f"The tip diameter of {tip:.6g} mm is not above the root diameter of {root:.6g} mm: there is no tooth."]
    if tip <= base:
        return [f"The tip diameter of {tip:.6g} mm is not above the base diameter of {base:.6g} mm: no flank is left."]
    return []


def check_gear(g: GearGeometry) -> list[str]:
    """What is impossible or unfavourable about a gear's teeth, one sentence each; empty when nothing is."""
    if sentences := impossible_teeth(g):
        return sentences
    thickness = g.normal_tip_thickness
    if thickness <= 0.0:
        sentences.append(
            f"The teeth are pointed {'above' if g.is_internal else 'below'} the tip diameter of "
            f"{1e3 * abs(g.effective_tip_diameter):.6g} mm: "
            "reduce the tip diameter, the addendum or the profile shift."
        )
    elif thickness < THIN_TIP * g.normal_module:
        sentences.append(
            f"The teeth are nearly pointed: {1e3 * thickness:.3g} mm thick at the tip, "
            f"less than {THIN_TIP:g} normal modules."
        )
    if g.is_undercut:
        sentences.append(
            f"The teeth are undercut: the profile shift {g.profile_shift:.4g} is below the least one, "
            f"{g.minimum_profile_shift:.4g}; use more teeth or more profile shift."
        )
    return sentences
