"""A pair that is not symmetric against its line of action drawn by hand: tips, active roots, play."""

from __future__ import annotations

import math

import pytest

from rotorgear.gears.geometry.geometry import GearGeometry
from rotorgear.gears.geometry.pair import pair_geometry

ALPHA = math.radians(20.0)


@pytest.mark.parametrize("extra", [0.0, 0.4e-3])
def test_contact_ends_where_the_tip_circles_cut_the_line_of_action(extra: float) -> None:
    pinion = GearGeometry(21, 3e-3, ALPHA, 0.0, profile_shift=0.25)
    wheel = GearGeometry(67, 3e-3, ALPHA, 0.0, profile_shift=-0.1)
    free = pair_geometry(pinion, wheel, 0.03)
    distance = free.centre_distance + extra
    pair = pair_geometry(pinion, wheel, 0.03, centre_distance=distance)
    bases = [0.5 * 3e-3 * z * math.cos(ALPHA) for z in (21, 67)]
    working = math.acos(sum(bases) / distance)
    tips = [0.5 * 3e-3 * z + 3e-3 * (1.0 + x) for z, x in ((21, 0.25), (67, -0.1))]
    # Along the line of action from the pinion's base tangent point: its own roll lengths.
    length = distance * math.sin(working)
    last = math.sqrt(tips[0] ** 2 - bases[0] ** 2)
    first = length - math.sqrt(tips[1] ** 2 - bases[1] ** 2)
    at_pitch_point = bases[0] * math.tan(working)
    assert pair.start_of_contact == pytest.approx(first - at_pitch_point, rel=1e-9)
    assert pair.end_of_contact == pytest.approx(last - at_pitch_point, rel=1e-9)
    assert pair.transverse_contact_ratio == pytest.approx((last - first) / (math.pi * 3e-3 * math.cos(ALPHA)), rel=1e-9)
    roots = pair.active_root_diameters(pinion, wheel)
    assert roots[0] == pytest.approx(2.0 * math.hypot(bases[0], first), rel=1e-9)
    assert roots[1] == pytest.approx(2.0 * math.hypot(bases[1], length - last), rel=1e-9)
    # Play: the pitch of the working circles less both thicknesses there.
    radii = [base / math.cos(working) for base in bases]

    def thickness(radius: float, z: int, x: float) -> float:
        reference = 0.5 * math.pi + 2.0 * x * math.tan(ALPHA)
        return 2.0 * radius * (reference / z + (math.tan(ALPHA) - ALPHA) - (math.tan(working) - working))

    play = 2.0 * math.pi * radii[0] / 21 - thickness(radii[0], 21, 0.25) - thickness(radii[1], 67, -0.1)
    assert 1e3 * pair.transverse_backlash == pytest.approx(1e3 * play, abs=1e-9)
