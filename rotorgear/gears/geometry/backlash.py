"""Backlash of a pair from its centre distance and the allowances of tooth thickness.

At zero allowance j_wt = 2 a_w [inv a_wt(a_w) - inv a_wt(x1 + x2)] at the working circles, along the flank normal
j_bn = j_wt cos a_wt cos b_b. Thickness allowances E_sn (negative: thinner) add -(E_sn1 + E_sn2) cos a_n to j_bn exactly,
since cos a_t cos b_b = cos b cos a_n. Reference: ISO 21771-1; ISO/TR 10064-2 for the terms. Lengths in m.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from rotorgear.gears.geometry.geometry import GearGeometry
from rotorgear.gears.geometry.pair import pair_geometry


@dataclass(frozen=True)
class Allowance:
    """Upper and lower allowance E_sns >= E_sni (m) of the normal tooth thickness at the reference cylinder; 0 or negative."""

    upper: float = 0.0
    lower: float = 0.0

    @property
    def mean(self) -> float:
        """Middle of the two (m)."""
        return 0.5 * (self.upper + self.lower)


@dataclass(frozen=True)
class Backlash:
    """Normal backlash j_bn (m) along the flank normal: smallest, mean and largest; negative where teeth jam."""

    least: float
    mean: float
    most: float


def normal_backlash(
    g1: GearGeometry,
    g2: GearGeometry,
    centre_distance: float,
    first: Allowance = Allowance(),
    second: Allowance = Allowance(),
    centre_allowance: float = 0.0,
) -> Backlash:
    """Normal backlash of a pair at a centre distance (m), which may deviate by +- centre_allowance (m)."""

    def at(distance: float, allowances: float) -> float:
        pair = pair_geometry(g1, g2, 1.0, distance)  # the width is that of the overlap ratio only
        return pair.normal_backlash - allowances * math.cos(g1.normal_pressure_angle)

    return Backlash(
        least=at(centre_distance - centre_allowance, first.upper + second.upper),
        mean=at(centre_distance, first.mean + second.mean),
        most=at(centre_distance + centre_allowance, first.lower + second.lower),
    )
