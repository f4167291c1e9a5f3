"""Section of the tooth root at the 30 degree tangent, and the nominal tooth root stress there.

The section stands where the tangent of the fillet makes 30 degrees with the middle of the tooth: thickness s_F, radius of
curvature rho_F. A force F_bt per width along the line of action at roll length xi crosses the middle of the tooth under
alpha_F = xi/r_b - psi_b at r_b / cos alpha_F from the axis, psi_b being half the tooth's angle at the base circle. With h_F from
there to the section,

    sigma = F_bt cos alpha_F 6 h_F / s_F^2  Y_S,    L = s_F/h_F,  q_s = s_F/(2 rho_F),
    Y_S = (1.2 + 0.13 L) q_s^(1/(1.21 + 2.3/L)).

Reference: ISO 6336-3:2019, form factor Y_F and stress correction factor Y_S of method B, in the transverse section. Lengths in m.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from rotorgear.gears.geometry.outline import ToothOutline

TANGENT = math.radians(30.0)
_STEP = 1e-4


@dataclass(frozen=True)
class RootSection:
    """The root at the 30 degree tangent.

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
        direction = roll / base - self.outline.base_half_angle
        arm = base / math.cos(direction) - self.radius * math.cos(self.angle)
        slender = self.thickness / arm
        notch = self.thickness / (2.0 * self.curvature_radius)
        correction = (1.2 + 0.13 * slender) * notch ** (1.0 / (1.21 + 2.3 / slender))
        return line_load * math.cos(direction) * 6.0 * arm / self.thickness**2 * correction


def tangent_angle(outline: ToothOutline, share: float) -> float:
    """Angle (rad) of the fillet's tangent to the middle of the tooth, at a share of the fillet from the form circle."""
    share = min(max(share, _STEP), 1.0 - _STEP)
    (x0, x1), (y0, y1) = (np.asarray(values) for values in _point(outline, np.array([share - _STEP, share + _STEP])))
    return math.atan2(x1 - x0, y0 - y1)


def _point(outline: ToothOutline, share: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Points (n,) of the fillet: across the tooth and along its middle."""
    radius, angle = outline.fillet(share)
    return radius * np.sin(angle), radius * np.cos(angle)


def root_section(outline: ToothOutline) -> RootSection:
    """Section at the 30 degree tangent of a tooth."""
    ends = (2.0 * _STEP, 1.0 - 2.0 * _STEP)
    steeper = [tangent_angle(outline, share) - TANGENT for share in ends]
    # A short fillet may have no such tangent: then its nearer end stands for it.
    if steeper[0] * steeper[1] < 0.0:
        share = float(brentq(lambda at: tangent_angle(outline, at) - TANGENT, *ends, xtol=1e-12))
    else:
        share = ends[0] if abs(steeper[0]) < abs(steeper[1]) else ends[1]
    radius, angle = (float(value) for value in outline.fillet(share))
    x, y = _point(outline, np.array([share - 20 * _STEP, share, share + 20 * _STEP]).clip(0.0, 1.0))
    # Radius of the circle through three neighbours: a b c / (4 area).
    sides = [math.hypot(x[i] - x[j], y[i] - y[j]) for i, j in ((0, 1), (1, 2), (2, 0))]
    area = 0.5 * abs((x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]))
    return RootSection(outline, share, radius, angle, 2.0 * radius * math.sin(angle), math.prod(sides) / (4.0 * area))
