"""Teeth to look at: contours of toothed and plain gears, the twist of the helix, and phases by which teeth stand in gaps.

A right-hand helix turns counter-clockwise towards +z, like the thread of a screw: d angle/dz = +tan(beta)/r at the reference
circle, the same as tan(beta_b)/r_b at the base circle. Reference: ISO 21771-1, Cylindrical involute gears and gear pairs.
"""

from __future__ import annotations

import math

import numpy as np

from rotorgear.gears.geometry.geometry import GearGeometry
from rotorgear.model.layout.gear_layout import GearLayout
from rotorgear.model.model import Model
from rotorgear.model.parts.frame import Frame

# Grooves of a plain cylinder, and their width in rad and depth relative to the radius, by which its rotation is seen.
GEAR_GROOVES = 12
DISK_GROOVES = 4
_GROOVE_WIDTH = math.radians(8.0)
_GROOVE_DEPTH = 0.05
# Least share of the pitch that a drawn tip or gap keeps, also where the given sizes leave none.
_LEAST_LAND = 0.03


def toothed_contour(geometry: GearGeometry, flank_points: int) -> tuple[np.ndarray, np.ndarray]:
    """Contour of a gear in the transverse plane, the middle of tooth 0 at angle 0.

    Returns:
        angles and radii, each (teeth, 2 flank_points), counter-clockwise; flanks are involutes down to the base circle, and
        radial from there to the root circle.
    """
    tip = 0.5 * abs(geometry.effective_tip_diameter)
    root = 0.5 * abs(geometry.root_diameter)
    teeth = abs(geometry.teeth)
    pitch = 2.0 * math.pi / teeth
    radius = np.linspace(root, tip, flank_points)
    involute = np.maximum(radius, abs(geometry.base_radius))
    half = np.array([geometry.transverse_thickness(geometry.sign * 2.0 * r) / (2.0 * r) for r in involute])
    # Pointed teeth and closed gaps are refused elsewhere, not in a picture: keep a land.
    half = np.clip(half, _LEAST_LAND * pitch, (0.5 - _LEAST_LAND) * pitch)
    angles = np.concatenate([-half, half[::-1]]) + pitch * np.arange(teeth)[:, None]
    return angles, np.tile(np.concatenate([radius, radius[::-1]]), (teeth, 1))


def grooved_contour(radius: float, grooves: int, arc_points: int) -> tuple[np.ndarray, np.ndarray]:
    """Contour of a plain cylinder with grooves, the first at angle 0; angles and radii, each (k, 1)."""
    pitch = 2.0 * math.pi / grooves
    width = min(_GROOVE_WIDTH, 0.4 * pitch)
    groove = np.array([-0.5, -0.35, 0.35, 0.5]) * width
    arc = np.linspace(0.5 * width, pitch - 0.5 * width, arc_points + 2)[1:-1]
    depth = np.concatenate([[0.0, _GROOVE_DEPTH, _GROOVE_DEPTH, 0.0], np.zeros(arc_points)])
    angles = np.concatenate([groove, arc]) + pitch * np.arange(grooves)[:, None]
    return angles.reshape(-1, 1), np.tile(radius * (1.0 - depth), grooves).reshape(-1, 1)


def twist_rates(gear: GearLayout) -> tuple[float, ...]:
    """d angle/dz in rad/m of each helix of a gear from left to right, positive for a right-hand one."""
    rate = gear.hand * math.tan(gear.base_helix_angle) / gear.base_radius
    return (rate, -rate)[: gear.helices]


def tooth_phases(model: Model, frames: dict[str, Frame]) -> dict[str, float]:
    """Angle in rad of the middle of a tooth in the middle plane of each gear's first helix, so that teeth stand in gaps.

    `frames` says where the shafts are shown. Where meshes close a loop of gears, its last mesh is left as it is.
    """
    phases: dict[str, float] = {}
    first = [mesh.contacts[0] for mesh in model.layout.meshes if mesh.pinion.part.teeth]
    for start in model.gears:
        phases.setdefault(start, 0.0)
        while contact := next((c for c in first if (c.pinion in phases) != (c.gear in phases)), None):
            names = (contact.pinion, contact.gear) if contact.pinion in phases else (contact.gear, contact.pinion)
            known, new = (model.layout.gear(name) for name in names)
            places = {contact.pinion: contact.contact_z, contact.gear: contact.gear_contact_z}
            out, back = (
                # The pinion in a ring has its pitch point away from the ring's axis.
                _direction(frames[one.shaft], frames[mate.shaft].at(mate.z)) + (math.pi if mate.part.internal else 0.0)
                for one, mate in ((known, new), (new, known))
            )
            pitch, mate_pitch = (2.0 * math.pi / (gear.part.teeth or 1) for gear in (known, new))
            ahead = (out - phases[known.name] - _turn(known, places[known.name])) / pitch

            # The mate turns the other way, in a ring the same way: what lies a share of the pitch back here lies the same share
            # ahead there, or back as well.
            sense = -1.0 if known.part.internal or new.part.internal else 1.0
            gap = back + sense * ahead * mate_pitch
            phases[new.name] = gap + 0.5 * mate_pitch - _turn(new, places[new.name])
    return phases


def _direction(frame: Frame, point: np.ndarray) -> float:
    """Angle in rad about a shaft's axis at which a point (3,) of the model lies."""
    x, y, _ = frame.inside(point).tolist()
    return math.atan2(y, x)


def _turn(gear: GearLayout, z: float) -> float:
    """How far the first helix of a gear has turned from its middle plane to z."""
    return twist_rates(gear)[0] * (z - gear.planes[0])


def contour_of(
    model: Model, name: str, radius: float, flank_points: int, arc_points: int
) -> tuple[np.ndarray, np.ndarray]:
    """Contour of a gear: its teeth, or the grooved pitch cylinder of a lumped one."""
    geometry = model.layout.gear(name).geometry
    return toothed_contour(geometry, flank_points) if geometry else grooved_contour(radius, GEAR_GROOVES, arc_points)
