"""Flank modifications and settings of loaded teeth that can't be are reported with their address."""

from __future__ import annotations

import pytest

import rotorgear as rg
from tests.models import pair_file


@pytest.mark.parametrize(
    ("pinion", "mesh", "said"),
    [
        ('flank = { root_relief = "5 um" }', "", "flank.root_relief_diameter"),
        ('flank = { root_relief_diameter = "165 mm" }', "", "flank.root_relief"),
        ('flank = { root_relief = "5 um", root_relief_diameter = "300 mm" }', "", "a diameter on the involute"),
        ('flank = { end_relief = "5 um" }', "", "flank.end_relief_length"),
        ('flank = { end_relief = "5 um", end_relief_length = "40 mm" }', "", "up to half of the face, 27 mm"),
        ('flank = { crowning = "2 mm" }', "", "up to 0.2 normal modules"),
        ('flank = { helix_slope = "-2 mm" }', "", "up to 0.2 normal modules"),
        ('flank = { pitch_errors = { "34" = "5 um" } }', "", "from '0' to '33'"),
        ('flank = { pitch_errors = { "first" = "5 um" } }', "", "the number of a tooth"),
        ('flank = { profile_crowning = "2 mm" }', "", "flank.profile_crowning"),
        ('flank = { profile_slope = "-2 mm" }', "", "flank.profile_slope"),
        ('flank = { bias = "2 mm" }', "", "flank.bias"),
        ('flank = { tip_rounding = "0.1 mm", tip_chamfer = "0.1 mm" }', "", "rounded or chamfered"),
        ('flank = { tip_chamfer = "20 mm" }', "", "less than the height of the involute"),
        ('flank = { tip_rounding = "4 mm" }', "", "meet in the middle of the tip"),
        (
            'tip_relief = "9 um"\ntip_relief_diameter = "179 mm"\nflank = { tip_chamfer = "1 mm" }',
            "",
            "to below 178 mm",
        ),
        ("", "stagger = 0.5", "herringbone gears"),
        ("", "tooth_fe = { pitches = 4 }", "an odd number"),
        ("", 'tooth_fe = { preset = "finest" }', "preset"),
    ],
)
def test_what_cannot_be_is_said_with_its_address(pinion: str, mesh: str, said: str) -> None:
    text = pair_file(pinion=pinion, mesh=f'stiffness = "tooth_fe"\n{mesh}')
    with pytest.raises(rg.ModelError) as error:
        rg.loads(text)
    assert said in str(error.value)


def test_modifications_that_can_be_are_taken() -> None:
    flank = 'flank = { root_relief = "5 um", root_relief_diameter = "168 mm", end_relief = "5 um", end_relief_length = "8 mm" }'
    assert rg.loads(pair_file(pinion=flank)).gears["pinion"].flank.root_relief == pytest.approx(5e-6)


def test_an_amount_of_nothing_is_an_amount() -> None:
    """A study from 0 on keeps the place where the relief starts."""
    none = 'tip_relief = "0 um"\ntip_relief_diameter = "179 mm"\n'
    none += 'flank = { root_relief = "0 um", root_relief_diameter = "168 mm", end_relief = "0 um", end_relief_length = "8 mm" }'
    assert rg.loads(pair_file(pinion=none)).gears["pinion"].tip_relief == 0.0
    with pytest.raises(rg.ModelError, match=r"tip_relief"):
        rg.loads(pair_file(pinion='tip_relief_diameter = "179 mm"'))
