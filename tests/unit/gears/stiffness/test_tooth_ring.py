"""The elastic ring under a tooth: reciprocity of force and moment at the root, from the energy of its three loads."""

from __future__ import annotations

import math

import numpy as np
import pytest

from rotorgear.gears.geometry.geometry import GearGeometry
from rotorgear.gears.geometry.outline import tooth_outline
from rotorgear.gears.stiffness.energy import tooth_compliance
from rotorgear.gears.stiffness.mesh_stiffness import ToothBody

# Sainsot, Velex and Duverger 2004, table 1: A B C D E F for L, M, P, Q.
TABLE = {
    "L": (-5.574e-5, -1.9986e-3, -2.3015e-4, 4.7702e-3, 0.0271, 6.8045),
    "M": (60.111e-5, 28.100e-3, -83.431e-4, -9.9256e-3, 0.1624, 0.9086),
    "P": (-50.952e-5, 185.50e-3, 0.0538e-4, 53.300e-3, 0.2895, 0.9236),
    "Q": (-6.2042e-5, 9.0889e-3, -4.0964e-4, 7.8297e-3, -0.1472, 0.6904),
}


@pytest.mark.parametrize("share", [0.3, 0.6, 0.9])
def test_a_tooth_gives_by_its_beam_and_by_the_published_ring(share: float) -> None:
    """The beam is what remains of a ring that is stiff: its share is summed over the tooth here, the ring's by its formula."""
    gear = GearGeometry(34, 5e-3, math.radians(20.0), 0.0)
    outline = tooth_outline(gear)
    body = ToothBody(inner_radius=outline.root_radius / 3.0)
    roll = outline.form_roll_length + share * (outline.tip_roll_length - outline.form_roll_length)
    E = body.youngs_modulus
    h = 3.0
    theta = outline.root_half_angle
    L, M, P, Q = (
        A / theta**2 + B * h**2 + C * h / theta + D / theta + F * h + G for A, B, C, D, F, G in TABLE.values()
    )
    radius, half = (float(value) for value in outline.involute(roll))
    tilt = math.atan(roll / gear.base_radius) - half
    top = radius * (math.cos(half) - math.sin(half) * math.tan(tilt))
    arm = (top - outline.root_radius) / (2.0 * outline.root_radius * theta)
    ring = math.cos(tilt) ** 2 / E * (L * arm**2 + M * arm + P * (1.0 + Q * math.tan(tilt) ** 2))

    # The tooth as slabs from the root circle up to the load.
    fillet = outline.fillet(np.linspace(1.0, 0.0, 4000))
    flank = outline.involute(np.linspace(outline.form_roll_length, outline.tip_roll_length, 4000)[1:])
    radii, angles = (np.concatenate(pair) for pair in zip(fillet, flank, strict=True))
    y = radii * np.cos(angles)
    s = 2.0 * radii * np.sin(angles)
    inside = np.linspace(y[0], radius * math.cos(half), 20001)
    middle = 0.5 * (inside[1:] + inside[:-1])
    thick = np.interp(middle, y, s)
    shear = E / (2.0 * (1.0 + body.poisson_ratio))
    slabs = (
        12.0 * (math.cos(tilt) * (top - middle)) ** 2 / (E * thick**3)
        + 1.2 * math.cos(tilt) ** 2 / (shear * thick)
        + math.sin(tilt) ** 2 / (E * thick)
    )
    beam = float(np.sum(slabs * np.diff(inside)))
    found = float(tooth_compliance(outline, body, np.array([roll]))[0])
    assert found / (beam + ring) == pytest.approx(1.0, rel=3e-4)
