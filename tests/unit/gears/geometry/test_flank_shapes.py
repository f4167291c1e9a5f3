"""Depths of flank modifications against their shapes drawn by hand, at places where no two shapes agree."""

from __future__ import annotations

import numpy as np
import pytest

from rotorgear.gears.geometry.flank import FlankModification

WIDTH = 0.04
FORM = 0.010
TIP = 0.030


def depth(flank: FlankModification, roll: float, share: float) -> float:
    """Depth at a roll length, and at a share of the half width from the middle of the face."""
    return float(flank.depth(np.array(roll), np.array(0.5 * share * WIDTH), FORM, TIP, WIDTH))


@pytest.mark.parametrize(("share", "part"), [(0.0, 0.0), (0.5, 0.25), (-0.5, 0.25), (0.8, 0.64), (-1.0, 1.0)])
def test_crowning_is_a_parabola_over_the_face(share: float, part: float) -> None:
    assert depth(FlankModification(crowning=8e-6), 0.02, share) == pytest.approx(8e-6 * part, abs=1e-18)


@pytest.mark.parametrize(("share", "part"), [(0.0, -0.0), (0.5, 0.25), (-0.5, -0.25), (1.0, 0.5), (-1.0, -0.5)])
def test_a_helix_slope_turns_the_flank_about_the_middle_of_the_face(share: float, part: float) -> None:
    assert depth(FlankModification(helix_slope=6e-6), 0.02, share) == pytest.approx(6e-6 * part, abs=1e-18)


@pytest.mark.parametrize("exponent", [1.0, 2.0])
def test_reliefs_grow_from_where_they_start_to_the_ends_of_the_involute(exponent: float) -> None:
    flank = FlankModification(
        tip_relief=20e-6, tip_relief_length=8e-3, root_relief=12e-6, root_relief_length=4e-3, relief_exponent=exponent
    )
    assert depth(flank, TIP, 0.3) == pytest.approx(20e-6)
    assert depth(flank, TIP - 2e-3, 0.3) == pytest.approx(20e-6 * 0.75**exponent)
    assert depth(flank, TIP - 8e-3, 0.3) == pytest.approx(0.0, abs=1e-18)
    assert depth(flank, 0.018, 0.3) == 0.0
    assert depth(flank, FORM + 1e-3, 0.3) == pytest.approx(12e-6 * 0.75**exponent)
    assert depth(flank, FORM, 0.3) == pytest.approx(12e-6)


def test_an_end_relief_falls_from_both_ends_over_its_length() -> None:
    flank = FlankModification(end_relief=10e-6, end_relief_length=5e-3)
    for share, part in ((1.0, 1.0), (-1.0, 1.0), (0.875, 0.5), (-0.875, 0.5), (0.75, 0.0), (0.0, 0.0)):
        assert depth(flank, 0.02, share) == pytest.approx(10e-6 * part, abs=1e-17)


def test_reliefs_stay_as_deep_as_they_are_beyond_the_ends_of_involute_and_face() -> None:
    """Of a gear that is wider than its mate, or whose tip reaches beyond the last contact."""
    lengths = {"tip_relief_length": 8e-3, "root_relief_length": 4e-3, "end_relief_length": 5e-3}
    flank = FlankModification(tip_relief=20e-6, root_relief=12e-6, end_relief=10e-6, relief_exponent=2.0, **lengths)
    assert depth(flank, TIP + 1e-3, 0.3) == pytest.approx(20e-6, rel=1e-12)
    assert depth(flank, FORM - 3e-3, 0.3) == pytest.approx(12e-6, rel=1e-12)
    assert depth(flank, 0.02, -1.2) == pytest.approx(10e-6, rel=1e-12)
    assert depth(flank, TIP + 1e-3, 1.2) == pytest.approx(30e-6, rel=1e-12)


@pytest.mark.parametrize("seed", range(8))
def test_no_point_of_a_flank_is_deeper_than_its_bound(seed: int) -> None:
    names = ("profile_crowning", "profile_slope", "crowning", "helix_slope", "bias")
    draw = np.random.default_rng(seed).uniform(-10e-6, 10e-6, len(names))
    flank = FlankModification(
        tip_relief=9e-6,
        tip_relief_length=8e-3,
        end_relief=4e-6,
        end_relief_length=5e-3,
        **dict(zip(names, draw, strict=True)),
    )
    roll, z = np.meshgrid(np.linspace(FORM, TIP, 41), np.linspace(-0.5 * WIDTH, 0.5 * WIDTH, 41))
    size = np.abs(flank.depth(roll, z, FORM, TIP, WIDTH)).max()
    assert size <= flank.largest


def test_pitch_errors_belong_to_their_teeth_all_round_the_gear() -> None:
    flank = FlankModification(pitch_error=((0, 4e-6), (3, -2e-6)))
    found = flank.pitch_depth(np.array([0, 1, 3, 10, 13, -7, -10]), 10)
    assert found == pytest.approx([4e-6, 0.0, -2e-6, 4e-6, -2e-6, -2e-6, 4e-6])
