"""Bevel pairs: straight, Zerol and spiral gears on axes that meet, as their pitch cones at the mean cone distance.

    tan d_1 = sin S / (z_2/z_1 + cos S),    d_2 = S - d_1,    r_m = R_m sin d = z m_mn / (2 cos b_m)
    tan a_t = tan a_n / cos b_m,    sin b_b = sin b_m cos a_n,    r_b = r_m cos a_t

At the mean point the teeth push as those of cylindrical gears do, with the pitch line in place of the direction of the axes: base
radius r_b and base helix angle b_b are those of that pair. References: ISO 23509:2016; ISO 10300-1:2014.
"""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class BevelPair:
    """Pitch cones of pinion and gear (m, rad).

    Attributes:
        shaft_angle: S, between the axes away from the apex.
        pitch_angles: d_1 and d_2.
        mean_cone_distance: R_m; mean_radii: r_m of both.
        normal_module: m_mn, at the mean cone distance.
        pressure_angle: a_t, transverse at the mean point; base_helix_angle: b_b.
    """

    shaft_angle: float
    pitch_angles: tuple[float, float]
    mean_cone_distance: float
    mean_radii: tuple[float, float]
    normal_module: float
    pressure_angle: float
    base_helix_angle: float

    @property
    def base_radii(self) -> tuple[float, float]:
        """r_b of both gears."""
        first, second = self.mean_radii
        return first * math.cos(self.pressure_angle), second * math.cos(self.pressure_angle)

    @property
    def mean_distances(self) -> tuple[float, float]:
        """Distance in m of the feet of the mean point on both axes from the apex, R_m cos d."""
        first, second = self.pitch_angles
        return self.mean_cone_distance * math.cos(first), self.mean_cone_distance * math.cos(second)


def bevel_pair(
    teeth: tuple[int, int],
    shaft_angle: float,
    width: float,
    *,
    outer_module: float | None,
    mean_normal_module: float | None,
    spiral_angle: float,
    normal_pressure_angle: float,
) -> BevelPair:
    """Return the pair.

    Args:
        teeth: of pinion and gear.
        shaft_angle: S in rad, above 0 and below pi.
        width: of the common face in m, which lies between the outer and the mean cone distance by half.
        outer_module: transverse, at the outer cone distance, in m; None where the mean normal one is given.
        mean_normal_module: in m.
        spiral_angle: b_m, at the mean cone distance. normal_pressure_angle: a_n.
    """
    first = math.atan2(math.sin(shaft_angle), teeth[1] / teeth[0] + math.cos(shaft_angle))
    second = shaft_angle - first
    if mean_normal_module is None:
        outer = 0.5 * teeth[0] * (outer_module or 0.0) / math.sin(first)
        mean_normal_module = 2.0 * (outer - 0.5 * width) * math.sin(first) * math.cos(spiral_angle) / teeth[0]
    radii = tuple(0.5 * z * mean_normal_module / math.cos(spiral_angle) for z in teeth)
    transverse = math.atan(math.tan(normal_pressure_angle) / math.cos(spiral_angle))
    return BevelPair(
        shaft_angle=shaft_angle,
        pitch_angles=(first, second),
        mean_cone_distance=radii[0] / math.sin(first),
        mean_radii=(radii[0], radii[1]),
        normal_module=mean_normal_module,
        pressure_angle=transverse,
        base_helix_angle=math.asin(math.sin(spiral_angle) * math.cos(normal_pressure_angle)),
    )
