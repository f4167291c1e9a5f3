"""Corner contact at mesh-in: where the tip of the driven gear meets the driver's flank too early, and how hard.

Under load, or with a base pitch error, the next pair is out of step by a separation e along the line of action. The tip
corner of gear 2 then touches the flank of gear 1 before point A, at D, off the line of action. The normal at D is tangent
to base circle 1 at the polar angle t and passes gear 2 at r_b2' = a_w cos t - r_b1, which is not r_b2; so the flanks meet
with v_s = w1 r_b1 (1 - r_b2' / r_b2). The kinetic energy of the pair goes into the tooth that hits (compliance q_s) and the
pairs that carry (q_r), at the angle theta = |t| - a_wt to each other:

    F_s = v_s sqrt( J1 J2 / [(J1 r_b2'^2 + J2 r_b1^2)(q_s + q_r cos^2 theta)] )

Reference: A. Seireg, D. R. Houser, Evaluation of dynamic factors for spur and helical gears (ASME, 1970), for corner contact;
energy balance as in the usual corner-impact models. Lengths in m, angles in rad.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from rotorgear.errors import AnalysisError
from rotorgear.gears.geometry.involute import involute
from rotorgear.gears.stiffness.mesh_stiffness import ToothPair


@dataclass(frozen=True)
class CornerContact:
    """The early contact of a tip corner.

    Attributes:
        advance: length of roll (m) along the line of action by which contact comes before point A.
        point: D (m), the driver's axis at the origin, the driven gear's at (a_w, 0).
        base_radius: r_b2' (m).
        angle: theta (rad) between the normals at D and of the mesh.
        approach: v_s / (w1 r_b1).
    """

    advance: float
    point: tuple[float, float]
    base_radius: float
    angle: float
    approach: float


def corner_gap(teeth: ToothPair, advance: float) -> float:
    """Gap (m along the line of action) between tip corner and flank when the pair is `advance` (m) of roll before A."""
    return _state(teeth, advance)[0]


def _state(teeth: ToothPair, advance: float) -> tuple[float, float, tuple[float, float]]:
    """Gap, polar angle t of the tangent point of the normal at D, and D."""
    rb1 = teeth.first.base_radius
    rb2 = teeth.second.base_radius
    distance = teeth.pair.centre_distance
    working = teeth.pair.working_transverse_pressure_angle
    start = teeth.pair.start_of_contact
    pitch = rb1 / math.cos(working)
    ax = pitch + start * math.sin(working)
    ay = start * math.cos(working)
    turned = math.atan2(ay, ax - distance) + advance / rb2
    tip = 0.5 * teeth.second.effective_tip_diameter
    x = distance + tip * math.cos(turned)
    y = tip * math.sin(turned)
    radius = math.hypot(x, y)
    first = math.hypot(ax, ay)
    if radius <= rb1:
        raise AnalysisError("The tip corner would meet the driver below its base circle: there is no involute to hit.")
    pressure = math.acos(rb1 / radius)
    flank = math.atan2(ay, ax) + involute(math.acos(min(rb1 / first, 1.0))) - involute(pressure) - advance / rb1
    polar = math.atan2(y, x)
    return rb1 * (polar - flank), polar - pressure, (x, y)


def corner_contact(teeth: ToothPair, separation: float) -> CornerContact:
    """Where the tip corner of gear 2, driven by gear 1, meets the driver's flank at a separation (m) along the line of action.

    Raises:
        AnalysisError: interference, or a separation that is negative or so large that contact comes a base pitch early or
            meets no involute.
    """
    from scipy.optimize import brentq

    if not 0.0 <= separation < math.inf:
        raise AnalysisError(f"The separation at the tip corner must be 0 or more, not {separation:g} m.")
    if teeth.pair.interference:
        raise AnalysisError(
            "A tip reaches past the base tangent point of its mate: there is no start of contact to hit."
        )
    advance = 0.0
    if separation > 0.0:
        step = 1e-3 * teeth.base_pitch
        while corner_gap(teeth, step) < separation:
            if step > teeth.base_pitch:
                raise AnalysisError(
                    f"A separation of {1e6 * separation:.4g} um brings the tip corner into contact more than a base pitch "
                    "too early: corner contact is meant for the give of teeth, give a smaller one."
                )
            step *= 1.5
        advance = float(brentq(lambda s: corner_gap(teeth, s) - separation, 0.0, step, xtol=1e-15, rtol=1e-13))
    _, tangent, point = _state(teeth, advance)
    radius = teeth.pair.centre_distance * math.cos(tangent) - teeth.first.base_radius
    angle = abs(abs(tangent) - teeth.pair.working_transverse_pressure_angle)
    return CornerContact(advance, point, radius, angle, 1.0 - radius / teeth.second.base_radius)


def corner_impact_force(
    teeth: ToothPair,
    separation: float,
    *,
    driver_speed: float,
    driver_inertia: float,
    driven_inertia: float,
    hit_compliance: float,
    carrying_compliance: float,
) -> float:
    """F_s (N), the largest force of the mesh-in impact of gear 2's tip on gear 1.

    Args:
        teeth: gear 1 drives.
        separation: e (m): deflection of the carrying pairs and base pitch error together, along the line of action.
        driver_speed: w1 (rad/s), positive.
        driver_inertia, driven_inertia: J1, J2 (kg m^2) that take part.
        hit_compliance: q_s (m/N) of the tooth pair that hits.
        carrying_compliance: q_r (m/N) of all pairs that carry meanwhile.

    Raises:
        AnalysisError: a value that is not positive, or a corner without contact.
    """
    given = {
        "driver speed": driver_speed,
        "driver inertia": driver_inertia,
        "driven inertia": driven_inertia,
        "compliance of the hit pair": hit_compliance,
    }
    for name, value in given.items():
        if not 0.0 < value < math.inf:
            raise AnalysisError(f"The {name} of a corner impact must be positive and finite, not {value:g}.")
    if not 0.0 <= carrying_compliance < math.inf:
        raise AnalysisError(f"The compliance of the carrying pairs must be 0 or more, not {carrying_compliance:g} m/N.")
    contact = corner_contact(teeth, separation)
    rb1 = teeth.first.base_radius
    velocity = driver_speed * rb1 * contact.approach
    inertia = driver_inertia * contact.base_radius**2 + driven_inertia * rb1**2
    give = hit_compliance + carrying_compliance * math.cos(contact.angle) ** 2
    return velocity * math.sqrt(driver_inertia * driven_inertia / (inertia * give))


def impulse_force(equivalent_mass: float, velocity_change: float, duration: float) -> float:
    """Mean force (N) of a pulse that changes the velocity (m/s) of a mass (kg) within a duration (s): m dv / dt."""
    if not duration > 0.0:
        raise AnalysisError(f"The duration of a pulse must be positive, not {duration:g} s.")
    return equivalent_mass * velocity_change / duration
