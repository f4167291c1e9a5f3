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

import rotorgear as rg
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


@dataclass(frozen=True)
class LoadedImpact:
    """Impact of a half pair by the account's formula: largest force (N), that with q_r = 0, velocity (m/s), q_s and q_r (m/N).

    Of the teeth the mean stiffness and its peak to peak (N/m).
    """

    force: float
    alone: float
    velocity: float
    hit: float
    carrying: float
    stiffness: float
    peak_to_peak: float


def loaded_teeth_impact(
    model: rg.Model,
    torque: float,
    gears: tuple[GearGeometry, GearGeometry, PairGeometry],
    speed: float,
    error: float = 0.0,
) -> LoadedImpact:
    """The formula with what finite elements of the teeth in contact give: q_s of the pair that carries most at its best position,
    q_r of all the others there, v_s from their static deflection.

    Args:
        model: with the mesh "left". torque: on its pinion (N m). gears: its geometry. speed: of the pinion (rad/s).
        error: of the teeth (m), by which they meet earlier still.
    """
    one, two, mesh = gears
    teeth = _loaded_teeth(model, torque)
    contact = corner_contact(one, two, mesh, speed, torque / one.base_radius / teeth.mean_stiffness + error)
    most = max(float(np.nanmax(share)) for share in teeth.helix[0].share.values())
    hit = 1.0 / (most * teeth.mean_stiffness)
    carrying = 1.0 / ((1.0 - most) * teeth.mean_stiffness)
    names = model.meshes["left"]
    inertia = tuple(model.gears[name].polar_inertia or 0.0 for name in (names.pinion, names.gear))
    force, alone = (
        impact_force(contact, (inertia[0], inertia[1]), one.base_radius, hit, q_r) for q_r in (carrying, 0.0)
    )
    return LoadedImpact(
        force, alone, contact.velocity, hit, carrying, teeth.mean_stiffness, teeth.peak_to_peak_stiffness
    )


def _loaded_teeth(model: rg.Model, torque: float) -> rg.MeshResult:
    """One mesh cycle of finite elements, kept for the errors that are tried on it."""
    key = (model.model_dump_json(), torque)
    if key not in _KNOWN:
        _KNOWN[key] = rg.mesh(model, "left", stiffness="tooth_fe", torque=torque, estimate=False)
    return _KNOWN[key]


_KNOWN: dict[tuple[str, float], rg.MeshResult] = {}
