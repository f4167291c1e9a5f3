"""Bevel gears on their shafts: where their axes meet, and on which side of that point each gear stands."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rotorgear.gears.geometry.bevel import BevelPair, bevel_pair
from rotorgear.model.parts.frame import Frame

if TYPE_CHECKING:
    from rotorgear.model.parts.gear import Gear
    from rotorgear.model.parts.shaft import Shaft

# Axes within this angle (rad) of each other do not meet.
_PARALLEL = 1e-6


@dataclass(frozen=True)
class Meeting:
    """Where the axes of a bevel pair meet; of pinion and gear in this order.

    Attributes:
        apex: z in m on each shaft of the point that is nearest to the other axis.
        sides: +1 where z of the shaft leads away from the apex at the gear, -1 where it leads to it.
        shaft_angle: between the axes away from the apex, in rad.
        directions: to the pitch point from each axis, in rad about z of the shaft from its x.
        apart: distance of the axes in m.
    """

    apex: tuple[float, float]
    sides: tuple[int, int]
    shaft_angle: float
    directions: tuple[float, float]
    apart: float


def meeting(shafts: tuple[Shaft, Shaft], places: tuple[float, float]) -> Meeting | None:
    """Where two axes meet, seen by gears at some z (m) of them; None of axes that are parallel."""
    first, second = (shaft.frame for shaft in shafts)
    seen = first.sees(second)
    origin, line = seen.origin, seen.axes[:, 2]
    across = math.hypot(line[0], line[1])
    if across < _PARALLEL:
        return None
    # The point u of the second axis that is nearest to the first one has its foot there at origin_z + u line_z.
    u = -(origin[0] * line[0] + origin[1] * line[1]) / across**2
    apex = (float(origin[2] + u * line[2]), float(u))
    apart = origin + u * line
    one, two = (1 if z >= at else -1 for z, at in zip(places, apex, strict=True))
    directions = (_across(first, two * second.axes[:, 2]), _across(second, one * first.axes[:, 2]))
    return Meeting(
        apex=apex,
        sides=(one, two),
        shaft_angle=math.atan2(across, one * two * float(line[2])),
        directions=directions,
        apart=math.hypot(apart[0], apart[1]),
    )


def _across(frame: Frame, direction: np.ndarray) -> float:
    """Angle about a shaft's axis of a direction (3,) of the model."""
    x, y, _ = (frame.axes.T @ direction).tolist()
    return math.atan2(y, x)


def pair_of(met: Meeting, pinion: Gear, gear: Gear) -> BevelPair:
    """The pitch cones of two gears whose teeth and modules are in order."""
    return bevel_pair(
        (pinion.teeth or 1, gear.teeth or 1),
        met.shaft_angle,
        min(pinion.width or 0.0, gear.width or 0.0),
        outer_module=pinion.outer_module,
        mean_normal_module=pinion.mean_normal_module,
        spiral_angle=pinion.spiral_angle,
        normal_pressure_angle=pinion.normal_pressure_angle,
    )
