"""Impact of a tooth that comes into contact early, by the formula of the 12-dof account with what loaded teeth give.

    F_s = v_s sqrt( I_1 I_2 / ((I_1 r'_b2^2 + I_2 r_b1^2) (q_s + q_r cos^2 theta)) )

The account gives neither v_s nor q_s, q_r. Here the teeth in contact yield by the static deflection; a tip corner of the driven
gear then meets the pinion's flank before the line of action, at the place D where the gap that the kinematics leave is as wide as
that deflection, and v_s is the rate at which the gap closes there. Errors of the teeth, which would add to it, are not given.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from rotorgear.gears.geometry.geometry import GearGeometry
from rotorgear.gears.geometry.pair import PairGeometry


@dataclass(frozen=True)
class CornerContact:
    """Where a tip corner meets early: velocity (m/s) along the normal there, its angle theta (rad) to the line of action, and the
    arm r'_b2 (m) that the gear has about it."""

    velocity: float
    angle: float
    arm: float


def corner_contact(
    pinion: GearGeometry, gear: GearGeometry, mesh: PairGeometry, speed: float, deflection: float
) -> CornerContact:
    """First contact of the driven gear's tip corner in the transverse plane.

    Args:
        pinion, gear: both gears, the pinion drives. mesh: their mesh. speed: of the pinion (rad/s).
        deflection: of the loaded teeth along the line of action (m).
    """
    rb1 = pinion.base_radius
    ratio = gear.teeth / pinion.teeth
    tip = 0.5 * gear.effective_tip_diameter
    on_line = math.acos(gear.base_radius / tip) - mesh.working_transverse_pressure_angle

    def place(early: float) -> tuple[np.ndarray, float, float]:
        """Corner as seen from the pinion's centre, its radius and the angle of its pinion flank's foot."""
        at = on_line + early
        corner = np.array([mesh.centre_distance - tip * math.cos(at), tip * math.sin(at)])
        radius = float(np.hypot(*corner))
        pressure = math.acos(min(rb1 / radius, 1.0))
        return corner, radius, math.atan2(corner[1], corner[0]) - math.tan(pressure) + pressure

    foot = place(0.0)[2]

    def gap(early: float) -> float:
        """Along the base circle of the pinion, with the gear's angle `early` before the line of action."""
        return rb1 * (place(early)[2] - foot - ratio * early)

    # The gap opens with the square of the angle; the corner stays outside the base circle of the pinion.
    furthest = 0.25 * 2.0 * math.pi / gear.teeth
    early = brentq(lambda angle: abs(gap(angle)) - deflection, 1e-9, furthest, xtol=1e-12)
    step = 1e-6
    rate = abs(gap(early + step) - gap(early - step)) / (2.0 * step)
    corner, _, _ = place(early)
    normal = _normal(corner, rb1)
    angle = math.acos(min(abs(float(normal @ _normal(place(0.0)[0], rb1))), 1.0))
    from_gear = corner - np.array([mesh.centre_distance, 0.0])
    arm = abs(float(from_gear[0] * normal[1] - from_gear[1] * normal[0]))
    return CornerContact(rate * speed / ratio, angle, arm)


def _normal(corner: np.ndarray, base_radius: float) -> np.ndarray:
    """Unit vector along the tangent from a place to the pinion's base circle, which is the normal of its flank there."""
    radius = float(np.hypot(*corner))
    turn = math.atan2(corner[1], corner[0]) + math.acos(min(base_radius / radius, 1.0))
    return np.array([-math.sin(turn), math.cos(turn)])


def impact_force(
    contact: CornerContact, inertia: tuple[float, float], base_radius: float, hit: float, carrying: float
) -> float:
    """F_s (N) of the account; `hit` q_s and `carrying` q_r in m/N, `inertia` of pinion and gear in kg m^2."""
    one, two = inertia
    mass = one * two / (one * contact.arm**2 + two * base_radius**2)
    return contact.velocity * math.sqrt(mass / (hit + carrying * math.cos(contact.angle) ** 2))
