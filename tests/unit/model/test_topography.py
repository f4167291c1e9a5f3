"""Measured flanks from CSV files: the same as the shapes they hold, on the right side and tooth, and clear errors."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.teeth.request import mesh_request
from rotorgear.gears.geometry.outline import tooth_outline
from rotorgear.gears.loaded.mesh_cycle import loaded_cycle
from rotorgear.model.layout.mesh_layout import mirrored
from tests.models import pair_file

PREVIEW = 'stiffness = "tooth_fe"\ntooth_fe = { preset = "preview" }'
OUTLINE = tooth_outline(rg.gear(rg.loads(pair_file(torque=""))).pairs["pair"].first)
FORM = 1e3 * OUTLINE.form_roll_length
TIP = 1e3 * OUTLINE.tip_roll_length
HEAD = "roll_length_mm,z_mm,deviation_um"


def loaded(folder: Path, flank: str, helix: float = 0.0, **given: str) -> rg.Model:
    file = folder / "pair.toml"
    text = pair_file(helix, "helical" if helix else "spur", mesh=PREVIEW, pinion=f"flank = {{ {flank} }}", **given)
    file.write_text(text)
    return rg.load(file)


def curve(model: rg.Model, torque: float = 1000.0, periods: int = 1) -> np.ndarray:
    """Transmission error at 12 even positions of each mesh period."""
    request = mesh_request(model, None, None, torque, {})
    assert request.teeth is not None
    teeth = request.teeth if request.senses[0] > 0 else mirrored(request.teeth)
    return loaded_cycle(teeth, request.base_force, np.arange(12 * periods) / 12)[1].deflection


@pytest.mark.parametrize(
    ("flank", "depth"),
    [
        ('profile_slope = "12 um"', (-6.0, -6.0, 6.0, 6.0)),
        ('helix_slope = "12 um"', (-6.0, 6.0, -6.0, 6.0)),
        ('bias = "24 um"', (6.0, -6.0, -6.0, 6.0)),
    ],
)
def test_a_shape_that_was_measured_acts_as_the_shape_given_by_its_amount(
    tmp_path: Path, flank: str, depth: tuple[float, ...]
) -> None:
    corners = ((FORM, -27), (FORM, 27), (TIP, -27), (TIP, 27))
    rows = [f"{roll!r},{z},{-value}" for (roll, z), value in zip(corners, depth, strict=True)]
    (tmp_path / "flank.csv").write_text("\n".join([HEAD, *rows]))
    measured = curve(loaded(tmp_path, 'topography = "flank.csv"'))
    assert measured == pytest.approx(curve(loaded(tmp_path, flank)), rel=1e-9)
    assert abs(measured - curve(loaded(tmp_path, ""))).max() > 1e-7


def test_a_bias_acts_the_other_way_on_the_flanks_of_the_other_hand(tmp_path: Path) -> None:
    right = loaded(tmp_path, 'bias = "30 um"', 20.86)
    left = loaded(tmp_path, 'bias = "-30 um"', 20.86, hand=("left", "right"))  # type: ignore[arg-type]
    assert curve(left) == pytest.approx(curve(right), rel=1e-12)
    other = loaded(tmp_path, 'bias = "30 um"', 20.86, hand=("left", "right"))  # type: ignore[arg-type]
    assert abs(curve(other) / curve(right) - 1.0).max() > 1e-4


@pytest.mark.parametrize(("torque", "side"), [(1000.0, "left"), (-1000.0, "right")])
def test_the_flank_that_works_is_the_left_one_where_the_torque_is_positive(
    tmp_path: Path, torque: float, side: str
) -> None:
    """A tooth that points to +y and is pushed along -x by a torque about +z works with its flank at -x: the left one."""
    rows = [f"{roll!r},0,{value},{side}" for roll, value in ((FORM, 6.0), (TIP, -6.0))]
    (tmp_path / "flank.csv").write_text("\n".join([f"{HEAD},flank", *rows]))
    both = curve(loaded(tmp_path, 'topography = "flank.csv"'), torque)
    assert both == pytest.approx(curve(loaded(tmp_path, 'profile_slope = "12 um"'), torque), rel=1e-9)
    idle = curve(loaded(tmp_path, 'topography = "flank.csv"'), -torque)
    assert idle == pytest.approx(curve(loaded(tmp_path, ""), -torque), rel=1e-12)


def test_a_tooth_of_its_own_is_a_pitch_error_where_it_stands_back_all_over(tmp_path: Path) -> None:
    (tmp_path / "flank.csv").write_text("# machine\ntooth;diameter (mm);z (mm);deviation [µm]\n2;170;0;-8\n")
    own = loaded(tmp_path, 'topography = "flank.csv"')
    measured = curve(own, periods=4)
    assert measured == pytest.approx(curve(loaded(tmp_path, 'pitch_errors = { "2" = "8 um" }'), periods=4), rel=1e-9)
    # The cycle goes on until the tooth has passed.
    assert rg.mesh(own, torque=1000.0, positions=8, estimate=False).periods == 4


def test_the_model_keeps_the_numbers_and_needs_the_file_no_more(tmp_path: Path) -> None:
    (tmp_path / "flank.csv").write_text(f"{HEAD}\n{FORM!r},0,1\n{TIP!r},0,-1\n")
    model = loaded(tmp_path, 'topography = "flank.csv"')
    (tmp_path / "flank.csv").unlink()
    again = rg.Model(**model.model_dump())
    assert again == model
    assert curve(again) == pytest.approx(curve(model), rel=1e-12)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "a header and at least one point"),
        (HEAD, "a header and at least one point"),
        ("roll_length_mm,z_mm\n1,2", "one of deviation"),
        ("roll_length_mm,diameter_mm,z_mm,deviation_um\n1,2,3,4", "one column of roll_length or diameter"),
        ("roll_length,z_mm,deviation_um\n1,2,3", "the unit of 'roll_length' in its header"),
        ("rol_length_mm,z_mm,deviation_um\n1,2,3", "did you mean 'roll_length'?"),
        (f"{HEAD},z_mm\n1,2,3,4", "'z' twice"),
        (f"{HEAD}\n30,0", "3 cells in each row; flank.csv:2 has 2"),
        (f"{HEAD}\n30,0,x", "a number as deviation; flank.csv:2 has 'x'"),
        (f"{HEAD}\n30,0,nan", "a number as deviation"),
        (f"{HEAD}\n30,0,1\n30,0,2", "each point of a flank once; flank.csv:3"),
        (f"{HEAD}\n30,0,1\n30,5,1\n35,0,2", "lacks 1 of 2 x 2 points, the first 35 mm at z = 5 mm"),
        (f"{HEAD},tooth\n30,0,1,one", "the number of a tooth"),
        (f"{HEAD},flank\n30,0,1,upper", "left or right"),
        (f"{HEAD},tooth\n30,0,1,34", "from 0 to 33"),
        ("roll_length_m,z_mm,deviation_um\n30,0,1", "roll lengths of the flank"),
        ("roll_length_mm,z_mm,deviation_mm\n30,0,4", "deviations up to 0.2 normal modules"),
        ("diameter_mm,z_mm,deviation_um\n30,0,4", "diameters of the flank"),
    ],
)
def test_what_is_wrong_in_a_file_is_said_with_its_place(tmp_path: Path, text: str, said: str) -> None:
    (tmp_path / "flank.csv").write_text(text)
    with pytest.raises(rg.ModelError) as error:
        loaded(tmp_path, 'topography = "flank.csv"')
    assert said in str(error.value)
    assert "gears.pinion.flank.topography" in str(error.value)


def test_a_file_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(rg.ModelError, match=r"gears\.pinion\.flank\.topography.*there is no"):
        loaded(tmp_path, 'topography = "other.csv"')


def test_a_chamfered_tip_ends_the_path_of_contact_as_a_smaller_tip_does(tmp_path: Path) -> None:
    chamfer = 'tip_chamfer = "0.8 mm"'
    chamfered = rg.mesh(loaded(tmp_path, chamfer), positions=12, estimate=False).helix[0]
    shorter = pair_file(mesh=PREVIEW, pinion='tip_diameter = "178.4 mm"')
    smaller = rg.mesh(rg.loads(shorter), positions=12, estimate=False).helix[0]
    plain = rg.mesh(loaded(tmp_path, ""), positions=12, estimate=False).helix[0]
    assert chamfered.geometric_contact_ratio == pytest.approx(smaller.geometric_contact_ratio, rel=1e-12)
    assert chamfered.geometric_contact_ratio < plain.geometric_contact_ratio - 0.05
    # The bodies differ by the tip that the chamfer leaves beside the path, which is felt at the tip alone.
    e = curve(loaded(tmp_path, chamfer))
    assert e.mean() == pytest.approx(curve(rg.loads(shorter)).mean(), rel=0.01)
    assert abs(e / curve(loaded(tmp_path, "")) - 1.0).max() > 0.02
