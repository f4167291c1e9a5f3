"""Slopes, crownings, bias, rounded tips and measured flanks against their formulas."""

from __future__ import annotations

import math

import numpy as np
import pytest

from rotorgear.gears.geometry.flank import FlankGrid, FlankModification
from rotorgear.gears.geometry.outline import tooth_outline
from rotorgear.model.layout.mesh_layout import mirrored
from tests.unit.gears.tooth_pairs import spur

WIDTH = 0.04
FORM = 0.010
TIP = 0.030
S = np.array([-0.5, -0.3, 0.0, 0.2, 0.5])[:, None]
T = np.array([-0.5, -0.1, 0.0, 0.4, 0.5])[None, :]
GRID = FlankGrid((0.01, 0.02, 0.03), (-0.02, 0.01, 0.02), ((1e-6, 2e-6, 3e-6), (4e-6, 6e-6, 8e-6), (0.0, 1e-6, 5e-6)))


def depth(flank: FlankModification) -> np.ndarray:
    return flank.depth(0.5 * (FORM + TIP) + S * (TIP - FORM), T * WIDTH, FORM, TIP, WIDTH)


@pytest.mark.parametrize(
    ("flank", "wanted"),
    [
        (FlankModification(profile_slope=6e-6), 6e-6 * S + 0 * T),
        (FlankModification(profile_crowning=5e-6), 5e-6 * 4 * S**2 + 0 * T),
        (FlankModification(helix_slope=-7e-6), -7e-6 * T + 0 * S),
        (FlankModification(crowning=3e-6), 3e-6 * 4 * T**2 + 0 * S),
        (FlankModification(bias=8e-6), 8e-6 * S * T),
    ],
    ids=["profile slope", "profile crowning", "helix slope", "lead crowning", "bias"],
)
def test_each_depth_is_its_formula(flank: FlankModification, wanted: np.ndarray) -> None:
    assert depth(flank) == pytest.approx(wanted, abs=1e-20)
    assert abs(wanted).max() <= flank.largest


def test_the_mirrored_flank_is_that_of_the_other_end_of_the_face() -> None:
    flank = FlankModification(
        helix_slope=4e-6,
        bias=8e-6,
        crowning=2e-6,
        profile_slope=3e-6,
        topography=GRID,
        tooth_topography=((2, GRID),),
        pitch_error=((1, 3e-6),),
    )
    roll = np.array([[0.011], [0.024], [0.029]])
    z = np.array([[-0.019, -0.004, 0.015]])
    tooth = np.array([0, 2, 5])

    def whole(flank: FlankModification, z: np.ndarray) -> np.ndarray:
        return flank.depth(roll, z, FORM, TIP, WIDTH) + flank.measured_depth(roll, z, tooth, 7)

    assert whole(flank.mirrored(), -z) == pytest.approx(whole(flank, z), abs=1e-20)
    assert abs(whole(flank.mirrored(), z) - whole(flank, z)).max() > 1e-6
    assert flank.mirrored().mirrored() == flank
    teeth = spur(first_flank=flank, misalignment=2e-6)
    assert mirrored(teeth).first_flank == flank.mirrored()
    assert mirrored(teeth).misalignment == -2e-6


def test_a_measured_flank_is_linear_between_its_points_and_goes_on_at_its_border() -> None:
    found = GRID.at(np.array([0.01, 0.015, 0.025, 0.05, 0.0]), np.array([-0.02, -0.005, 0.015, 0.05, -0.05]))
    assert found == pytest.approx([1e-6, 0.25 * (1 + 2 + 4 + 6) * 1e-6, 0.25 * (6 + 8 + 1 + 5) * 1e-6, 5e-6, 1e-6])
    assert GRID.along_face
    assert not FlankGrid((0.01, 0.02), (0.0,), ((1e-6,), (2e-6,))).along_face


def test_one_tooth_may_have_a_topography_of_its_own_all_round_the_gear() -> None:
    flank = FlankModification(tooth_topography=((3, FlankGrid((0.01,), (0.0,), ((5e-6,),))),))
    tooth = np.array([3, 4, -7, 13])
    roll = np.full((4, 1), 0.02)
    assert flank.measured_depth(roll, np.zeros((1, 1)), tooth, 10)[:, 0] == pytest.approx([5e-6, 0.0, 5e-6, 5e-6])
    assert flank.single_teeth == (3,)


def test_a_rounded_tip_touches_flank_and_tip_arc_and_a_chamfer_ends_at_its_height() -> None:
    """The circle through both ends of the rounding, drawn with straight edges: exact for a small radius."""
    outline = tooth_outline(spur().first)
    base = outline.geometry.base_radius
    chamfer = 0.4e-3
    assert math.hypot(base, outline.tip_form_roll_length(chamfer=chamfer)) == pytest.approx(
        outline.tip_radius - chamfer, rel=1e-12
    )
    radius = 1e-6
    tip = outline.tip_roll_length
    arc = (tip**2 - outline.tip_form_roll_length(rounding=radius) ** 2) / (2.0 * base)
    profile_angle = math.acos(base / outline.tip_radius)
    # Centre of a circle at the distance rho from both edges; its foot on the flank lies at rho cot(half the angle).
    half = 0.5 * (0.5 * math.pi + profile_angle)
    centre = radius / math.sin(half)
    assert arc == pytest.approx(math.sqrt(centre**2 - radius**2), rel=1e-6)
