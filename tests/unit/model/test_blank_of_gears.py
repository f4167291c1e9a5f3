"""The blank of a gear from its file: radii from the root circle inward."""

from __future__ import annotations

import math

import pytest

import rotorgear as rg
from tests.paths import MODELS


def test_the_rim_reaches_inward_from_the_root_circle_by_its_thickness() -> None:
    model = rg.load(MODELS / "web_wheel.toml")
    rims = 0
    for name, gear in model.gears.items():
        if gear.body.rim_thickness is None or gear.body.web_thickness is None:
            continue
        rims += 1
        pitch = gear.teeth * gear.normal_module / math.cos(gear.helix_angle or 0.0)
        root = pitch - 2.0 * gear.normal_module * (gear.dedendum_factor - gear.profile_shift)
        blank = model.layout.gear(name).blank
        assert blank.rim_radius == pytest.approx(0.5 * root - gear.body.rim_thickness, rel=1e-12)
        assert blank.bore_radius < blank.hub_radius < blank.rim_radius
    assert rims
