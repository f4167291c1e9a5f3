"""Where the tips of a pinion and of its ring meet beside the line of action, and whether the pinion can be put in from inside.

With teeth in contact, the corners of both tips pass the point where the two tip circles cross. With d1 and d2 the angles of
that point about both axes from the pitch point, the ring's corner is ahead of the pinion's there by the angle

    g = (z1/z2) (d1 + inv a_a1 - inv a_w) - (d2 + inv a_a2 - inv a_w),  cos d1 = (r_a2^2 - r_a1^2 - a^2)/(2 a r_a1),
    cos d2 = (r_a2^2 - r_a1^2 + a^2)/(2 a r_a2),

about the ring's axis. A pinion that is moved out along the line of centres passes the ring's tips where the corners come nearest
at the same height, r_a1 sin d1 = r_a2 sin d2 with sin^2 d1 = (1 - (cos a_a1 / cos a_a2)^2)/(1 - (z1/z2)^2); g has the same form.
Reference: KHK Stock Gears, Gear Technical Reference, internal gears (trochoid and trimming interference). All z, r, a and m
are positive here. Lengths in m, angles in rad.
"""

from __future__ import annotations

import math

from rotorgear.gears.geometry.geometry import GearGeometry, involute
from rotorgear.gears.geometry.pair import PairGeometry


def tip_distance(pinion: GearGeometry, ring: GearGeometry, pair: PairGeometry) -> float:
    """Arc (m) on the ring's tip circle by which the tips pass each other; negative where they would cut each other."""
    small, large = _tips(pinion, ring)
    distance = abs(pair.centre_distance)
    first = (large**2 - small**2 - distance**2) / (2.0 * distance * small)
    second = (large**2 - small**2 + distance**2) / (2.0 * distance * large)
    # Tip circles that don't cross have no corner to meet.
    if first >= 1.0:
        return math.inf
    return _arc(pinion, ring, pair, math.acos(max(first, -1.0)), math.acos(max(second, -1.0)))


def radial_distance(pinion: GearGeometry, ring: GearGeometry, pair: PairGeometry) -> float:
    """Arc (m) on the ring's tip circle by which the tips pass each other while the pinion is put in along the line of centres."""
    small, large = _tips(pinion, ring)
    ratio = pinion.teeth / abs(ring.teeth)
    # cos a_a1 / cos a_a2 = (r_b1 / r_a1) / (r_b2 / r_a2)
    square = (1.0 - (ratio * large / small) ** 2) / (1.0 - ratio**2)
    if square <= 0.0:
        return math.inf
    sine = math.sqrt(min(square, 1.0))
    return _arc(pinion, ring, pair, math.asin(sine), math.asin(min(sine * small / large, 1.0)))


def _tips(pinion: GearGeometry, ring: GearGeometry) -> tuple[float, float]:
    """Tip radii of both."""
    return 0.5 * pinion.effective_tip_diameter, 0.5 * abs(ring.effective_tip_diameter)


def _arc(pinion: GearGeometry, ring: GearGeometry, pair: PairGeometry, first: float, second: float) -> float:
    """g as an arc on the ring's tip circle, for the angles d1 and d2."""
    working = involute(pair.working_transverse_pressure_angle)
    opened = [involute(math.acos(2.0 * g.base_radius / g.effective_tip_diameter)) - working for g in (pinion, ring)]
    ahead = (first + opened[0]) * pinion.teeth / abs(ring.teeth) - (second + opened[1])
    return ahead * 0.5 * abs(ring.effective_tip_diameter)
