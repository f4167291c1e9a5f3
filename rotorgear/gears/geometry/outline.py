"""Transverse outline of a tooth (tip arc, involute, trochoid of the tool's tip, root arc), and its root section.

A rack cuts external teeth, a pinion-type cutter those of a ring (`cutter.py`). The rack's tip is a circle of rho_fP in the normal
section, an ellipse in the transverse one. A point of it with the normal n cuts when n passes through the pitch point: the rack
has then moved by u = Y n_x / n_y - X and the gear has turned by u / r.
Where the straight flank ends above the base circle, the trochoid begins there; below it the tooth is undercut, and the
trochoid begins where it crosses the involute. Reference: F. L. Litvin, A. Fuentes, Gear Geometry and Applied Theory,
chapter on involute gears; ISO 53 for the rack. Lengths in m, angles in rad.

The root section, in which the nominal tooth root stress is taken, lies where the tangent of the fillet makes 30 degrees with
the middle of the tooth, of a ring 60 degrees: thickness s_F, radius of curvature rho_F. A force F_bt per width along the line of
action at roll length xi crosses the middle of the tooth under alpha_F = xi/r_b - psi_b at r_b / cos alpha_F from the axis, psi_b
being half the tooth's angle at the base circle. With h_F from there to the section,

    sigma = F_bt cos alpha_F 6 h_F / s_F^2  Y_S,    L = s_F/h_F,  q_s = s_F/(2 rho_F),
    Y_S = (1.2 + 0.13 L) q_s^(1/(1.21 + 2.3/L)).

Reference: ISO 6336-3:2019, form factor Y_F and stress correction factor Y_S of method B, in the transverse section. Lengths in m.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.gears.geometry.cutter import cutter
from rotorgear.gears.geometry.geometry import GearGeometry, impossible_teeth

TANGENT = math.radians(30.0)
_RING_TANGENT = math.radians(60.0)
_STEP = 1e-4


@dataclass(frozen=True)
class RootSection:
    """The root at the tangent of 30 degrees, of a ring at that of 60.

    Attributes:
        share: place on the fillet, 0 at the form circle and 1 at the root circle.
        radius: of the point from the gear's axis.
        angle: of the point from the middle of the tooth (rad).
        thickness: s_F.
        curvature_radius: rho_F.
    """

    outline: ToothOutline
    share: float
    radius: float
    angle: float
    thickness: float
    curvature_radius: float

    def nominal_stress(self, line_load: float, roll: float) -> float:
        """Stress (Pa) for F_bt per width (N/m) at a roll length of the flank (m)."""
        base = self.outline.geometry.base_radius
        sign = self.outline.geometry.sign
        direction = roll / base - sign * self.outline.base_half_angle
        arm = base / math.cos(direction) - sign * self.radius * math.cos(self.angle)
        slender = self.thickness / arm
        notch = self.thickness / (2.0 * self.curvature_radius)
        correction = (1.2 + 0.13 * slender) * notch ** (1.0 / (1.21 + 2.3 / slender))
        return line_load * math.cos(direction) * 6.0 * arm / self.thickness**2 * correction


def tangent_angle(outline: ToothOutline, share: float) -> float:
    """Angle (rad) of the fillet's tangent to the middle of the tooth, at a share of the fillet from the form circle."""
    share = min(max(share, _STEP), 1.0 - _STEP)
    (x0, x1), (y0, y1) = (np.asarray(values) for values in _point(outline, np.array([share - _STEP, share + _STEP])))
    return math.atan2(x1 - x0, outline.geometry.sign * (y0 - y1))


def _point(outline: ToothOutline, share: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Points (n,) of the fillet: across the tooth and along its middle."""
    radius, angle = outline.fillet(share)
    return radius * np.sin(angle), radius * np.cos(angle)


def root_section(outline: ToothOutline) -> RootSection:
    """Section at the 30 degree tangent of a tooth, at that of 60 of a ring's."""
    from scipy.optimize import brentq  # here: it loads much, and models without gears have no need of it

    ends = (2.0 * _STEP, 1.0 - 2.0 * _STEP)
    wanted = _RING_TANGENT if outline.geometry.is_internal else TANGENT
    steeper = [tangent_angle(outline, share) - wanted for share in ends]
    # A short fillet may have no such tangent: then its nearer end stands for it.
    if steeper[0] * steeper[1] < 0.0:
        share = float(brentq(lambda at: tangent_angle(outline, at) - wanted, *ends, xtol=1e-12))
    else:
        share = ends[0] if abs(steeper[0]) < abs(steeper[1]) else ends[1]
    radius, angle = (float(value) for value in outline.fillet(share))
    x, y = _point(outline, np.array([share - 20 * _STEP, share, share + 20 * _STEP]).clip(0.0, 1.0))
    # Radius of the circle through three neighbours: a b c / (4 area).
    sides = [math.hypot(x[i] - x[j], y[i] - y[j]) for i, j in ((0, 1), (1, 2), (2, 0))]
    area = 0.5 * abs((x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]))
    return RootSection(outline, share, radius, angle, 2.0 * radius * math.sin(angle), math.prod(sides) / (4.0 * area))


# Points along the trochoid at which the crossing with the involute is looked for before it is refined.
_SCAN = 801
# Thinner tips, in normal modules, are refused.
LEAST_TIP = 0.02


@dataclass(frozen=True)
class ToothOutline:
    """One flank of a tooth from its tip to the middle of the gap, in polar coordinates about the gear's axis.

    Angles are measured from the middle of the tooth, positive on the flank that is described; the other one mirrors it. Radii
    are positive; roll lengths of a ring are negative as its base radius is, so that they rise from form circle to tip, too.

    Attributes:
        geometry: the gear.
        tip_radius: r_a.
        root_radius: r_f.
        form_radius: where involute and trochoid meet.
        form_roll_length: xi_F along the line of action from the base tangent point, sqrt(r_F^2 - r_b^2), with the sign of z.
        base_half_angle: half the tooth's angle at the base circle.
        form_tool_angle: angle of the rack's tip normal that cuts the form circle; pi/2 cuts the root circle.
        undercut: whether the trochoid cuts away involute.
    """

    geometry: GearGeometry
    tip_radius: float
    root_radius: float
    form_radius: float
    form_roll_length: float
    base_half_angle: float
    form_tool_angle: float
    undercut: bool

    @property
    def tip_roll_length(self) -> float:
        """xi_a (m), with the sign of z."""
        return self.geometry.sign * math.sqrt(self.tip_radius**2 - self.geometry.base_radius**2)

    @property
    def rounding_share(self) -> float:
        """Length that a rounding of the tip edge takes off tip arc and flank, over its radius.

        Flank and tip arc enclose 90 deg + alpha_a, alpha_a being the transverse profile angle at the tip. A circle that touches
        both begins at radius / tan((90 deg + alpha_a)/2) from the edge on either.
        """
        edge = 0.5 * math.pi + math.atan(self.tip_roll_length / self.geometry.base_radius)
        return 1.0 / math.tan(0.5 * edge)

    def tip_form_roll_length(self, rounding: float = 0.0, chamfer: float = 0.0) -> float:
        """xi_Fa (m), where the involute ends below a rounding (radius, m) or a chamfer (radial height, m) of the tip edge.

        Along the flank the rounding takes off the arc (xi_a^2 - xi_Fa^2)/(2 r_b).
        """
        base = self.geometry.base_radius
        sign = self.geometry.sign
        radius = self.tip_radius - sign * chamfer
        square = (radius - base) * (radius + base) - 2.0 * base * rounding * self.rounding_share
        return sign * math.sqrt(max(square, 0.0))

    @property
    def root_half_angle(self) -> float:
        """Angle at which the trochoid reaches the root circle; pi/|z| where no root arc is left."""
        return float(self.fillet(1.0)[1])

    def involute(self, roll_length: np.ndarray | float) -> tuple[np.ndarray, np.ndarray]:
        """Radii (n,) and angles (n,) of flank points by their roll length xi = sqrt(r^2 - r_b^2), with the sign of z, (n,)."""
        roll = np.asarray(roll_length, float)
        turned = roll / self.geometry.base_radius
        opening = self.geometry.sign * (turned - np.arctan(turned))
        return np.hypot(roll, self.geometry.base_radius), self.base_half_angle - opening

    def fillet(self, share: np.ndarray | float) -> tuple[np.ndarray, np.ndarray]:
        """Radii (n,) and angles (n,) of the trochoid; share (n,) runs from 0 at the form circle to 1 at the root circle."""
        if self.geometry.is_internal:
            return cutter(self.geometry).fillet(share)
        first = self.form_tool_angle
        return trochoid(self.geometry, first + (0.5 * math.pi - first) * np.asarray(share, float))

    def half(self, points: int = 30) -> tuple[np.ndarray, np.ndarray]:
        """Radii and angles (n,) from the middle of the tip to the middle of the gap, with `points` on involute and fillet."""
        roll = np.linspace(self.tip_roll_length, self.form_roll_length, points)
        flank = self.involute(roll)
        fillet = self.fillet(np.linspace(0.0, 1.0, points)[1:])
        tip = np.linspace(0.0, flank[1][0], 5)[:-1]
        root = np.linspace(fillet[1][-1], math.pi / abs(self.geometry.teeth), 5)[1:]
        radii = np.concatenate([np.full(4, self.tip_radius), flank[0], fillet[0], np.full(4, self.root_radius)])
        return radii, np.concatenate([tip, flank[1], fillet[1], root])

    def tooth(self, points: int = 30) -> tuple[np.ndarray, np.ndarray]:
        """Radii and angles (n,) of a whole pitch, counter-clockwise from the middle of one gap to that of the next."""
        radii, angles = self.half(points)
        return np.concatenate([radii[::-1], radii[1:]]), np.concatenate([-angles[::-1], angles[1:]])


def trochoid(g: GearGeometry, tool_angle: np.ndarray | float) -> tuple[np.ndarray, np.ndarray]:
    """Radii (n,) and angles (n,) from the tooth's middle that the tool's tip cuts, by the angle (n,) of its normal.

    The angle lies in the normal section: a_n where flank and tip circle of the tool touch, pi/2 at its crest.
    """
    # Centre of the tool's rounded tip in the normal section, from the middle of the tooth and from the datum line.
    theta = np.asarray(tool_angle, float)
    m = g.normal_module
    alpha = g.normal_pressure_angle
    beta = g.helix_angle
    rho = g.tool_tip_radius_factor
    below = g.dedendum_factor - rho
    centre = math.pi / 4 + below * math.tan(alpha) + rho / math.cos(alpha)
    # The cutting point of the tool in the transverse section, which stretches the circle to an ellipse by 1 / cos b.
    x = m * (centre - rho * np.cos(theta)) / math.cos(beta)
    y = m * (g.profile_shift - below - rho * np.sin(theta))
    reference = 0.5 * g.reference_diameter
    # Its normal passes through the pitch point after the rack has moved by u; the gear has turned by u / r meanwhile.
    moved = y * np.cos(theta) * math.cos(beta) / np.sin(theta) - x
    across = x + moved
    up = reference + y
    return np.hypot(across, up), np.arctan2(across, up) - moved / reference


def tooth_outline(g: GearGeometry) -> ToothOutline:
    """Outline of a gear's tooth.

    Raises:
        AnalysisError: circles in the wrong order, a pointed tooth, or one that the tool cuts through.
    """
    if wrong := impossible_teeth(g):
        raise AnalysisError(wrong[0])
    if g.is_internal:
        return _ring_outline(g)
    tip = 0.5 * g.effective_tip_diameter
    base_half = (math.pi / 2 + 2.0 * g.profile_shift * math.tan(g.normal_pressure_angle)) / g.teeth + (
        math.tan(g.transverse_pressure_angle) - g.transverse_pressure_angle
    )
    _require_tip(g)
    # The involute begins where the rack's straight flank ends; a negative roll length is that of an undercut tooth.
    roll = g.tool_form_roll_length
    angle = g.normal_pressure_angle
    undercut = False
    if roll < 0.0:
        roll, angle = _crossing(g, base_half)
        undercut = True
    form = math.hypot(roll, g.base_radius)
    if form >= tip:
        raise AnalysisError(
            f"The tool's tip cuts the flank up to the diameter of {2e3 * form:.6g} mm, beyond the tip diameter of "
            f"{2e3 * tip:.6g} mm: no involute is left; use more teeth, more profile shift or a smaller dedendum."
        )
    outline = ToothOutline(g, tip, 0.5 * g.root_diameter, form, roll, base_half, angle, undercut)
    # A trochoid that crosses the middle of the tooth has cut it off.
    if np.min(outline.fillet(np.linspace(0.0, 1.0, 101))[1]) <= 0.0:
        raise AnalysisError(_cut_through(g))
    return outline


def _require_tip(g: GearGeometry) -> None:
    """AnalysisError for a tooth that is all but pointed at its tip."""
    if g.normal_tip_thickness < LEAST_TIP * g.normal_module:
        remedy = (
            "give a larger tip diameter or less addendum" if g.is_internal else "reduce the tip diameter, the addendum"
        )
        raise AnalysisError(
            f"The teeth are pointed at the tip diameter of {1e3 * abs(g.effective_tip_diameter):.6g} mm, or all but "
            f"(thinner than {LEAST_TIP:g} normal modules): {remedy} or {'more' if g.is_internal else 'the'} profile shift."
        )


def _ring_outline(g: GearGeometry) -> ToothOutline:
    """Outline of a ring's tooth, whose fillet is that of its cutter."""
    _require_tip(g)
    tool = cutter(g)
    tip = 0.5 * abs(g.effective_tip_diameter)
    roll = tool.ring_form_roll_length
    form = math.hypot(roll, g.base_radius)
    if form <= tip:
        raise AnalysisError(
            f"The rounding of the cutter's tip ends the flank at the diameter of {2e3 * form:.6g} mm, inside the tip diameter of "
            f"{2e3 * tip:.6g} mm: no involute is left; use a smaller root_radius_factor or more dedendum."
        )
    outline = ToothOutline(
        geometry=g,
        tip_radius=tip,
        root_radius=0.5 * abs(g.root_diameter),
        form_radius=form,
        form_roll_length=-roll,
        # Half the angle of the tooth at a diameter is this and inv a_y: teeth of a ring grow outwards.
        base_half_angle=-((math.pi / 2 + 2.0 * g.profile_shift * math.tan(g.normal_pressure_angle)) / g.teeth)
        - (math.tan(g.transverse_pressure_angle) - g.transverse_pressure_angle),
        form_tool_angle=0.5 * math.pi,
        undercut=False,
    )
    # Below its base circle the cutter has no flank: what the ring's tip would meet there is not made by it.
    reached = -outline.tip_roll_length - tool.centre_distance * math.sin(tool.pressure_angle)
    if reached < 0.0:
        raise AnalysisError(
            f"A cutter of {tool.teeth} teeth has no involute where it would cut the tip of this ring: give cutter_teeth of a "
            "larger cutter, or a larger tip diameter."
        )
    return outline


def _cut_through(g: GearGeometry) -> str:
    return (
        f"The tool cuts through the root of the tooth (z = {g.teeth}, x = {g.profile_shift:.4g}): "
        "use more teeth or more profile shift."
    )


def _crossing(g: GearGeometry, base_half_angle: float) -> tuple[float, float]:
    """Roll length and tool angle where the trochoid of an undercut tooth crosses the involute."""

    def roll(theta: float) -> float:
        radius = float(trochoid(g, theta)[0])
        return math.sqrt(max(radius - g.base_radius, 0.0) * (radius + g.base_radius))

    def outside(theta: float) -> float:
        """How far the trochoid lies outside the involute, as an angle; below the base circle, outside its first point."""
        turned = roll(theta) / g.base_radius
        return float(trochoid(g, theta)[1]) - (base_half_angle - (turned - math.atan(turned)))

    # Scan first: there may be two crossings, of which the outermost counts. The cube makes the scan dense at the flank's end,
    # since a slight undercut takes place within a small angle.
    first = g.normal_pressure_angle
    angles = first + (0.5 * math.pi - first) * np.linspace(1.0, 0.0, _SCAN) ** 3
    radii, halves = trochoid(g, angles)
    turned = np.sqrt(np.maximum(radii - g.base_radius, 0.0) * (radii + g.base_radius)) / g.base_radius
    gap = halves - (base_half_angle - (turned - np.arctan(turned)))
    inside = np.flatnonzero((gap < 0.0) & (radii > g.base_radius))
    if len(inside) == 0:  # undercut by less than the scan sees: the trochoid meets the involute at its foot
        return 0.0, g.normal_pressure_angle
    last = int(inside[-1])
    if last == _SCAN - 1:
        raise AnalysisError(_cut_through(g))
    from scipy.optimize import brentq

    angle = brentq(outside, angles[last + 1], angles[last], xtol=1e-15, rtol=1e-14)
    return roll(angle), float(angle)
