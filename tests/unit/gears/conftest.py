"""The pair that several test files measure against."""

from __future__ import annotations

import math

import pytest

from rotorgear.gears.geometry.geometry import GearGeometry

MM = 1e-3
deg = math.radians


@pytest.fixture
def iso_pair() -> tuple[GearGeometry, GearGeometry]:
    """Example 1 of ISO/TR 6336-30, the pinion with the shift that fits the centre distance of 500 mm."""
    pinion = GearGeometry(
        17, 8 * MM, deg(20), deg(15.8), profile_shift=0.145222093651, dedendum_factor=1.4, tip_diameter=159.66 * MM
    )
    return pinion, GearGeometry(103, 8 * MM, deg(20), deg(15.8), dedendum_factor=1.4, tip_diameter=872.35 * MM)
