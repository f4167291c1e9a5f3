"""`rotorgear check` shows the layout of a model, and says which description of a bearing is used where."""

from __future__ import annotations

import pytest
from typer.testing import CliRunner

import rotorgear as rg
from rotorgear.analysis.common.left_out import left_out
from rotorgear.cli.main import app
from rotorgear.system.system import System
from tests.models import spur_pair
from tests.paths import ROOT

ROLLING = {
    "kind": "ball",
    "elements": 9,
    "element_diameter": "10 mm",
    "pitch_diameter": "50 mm",
    "clearance": "20 um",
}


def test_gears_and_places_stand_where_their_shafts_carry_them() -> None:
    found = rg.check(rg.load(ROOT / "models" / "split_torque.toml"))
    bull = next(row for row in found.gears if row.name == "bull")
    assert bull.z_m == pytest.approx((0.1715, 0.2865), rel=1e-12)
    assert bull.shaft == "output"
    closing = {row.name: row.clocking_deg for row in found.gears if row.clocking_deg}
    # Both branches turn into one wheel: one pinion is put on its shaft so that the loop closes.
    assert list(closing) == ["pinion_2b"]
    assert abs(closing["pinion_2b"]) <= 180.0 / 26
    right = [row for row in found.places if row.shaft == "output"]
    assert [row.z_m for row in right] == sorted(row.z_m for row in right)
    assert {row.part: row.z_m for row in right}["disks.output_coupling"] == pytest.approx(0.504, rel=1e-12)


def test_phases_of_meshes_are_those_of_statics() -> None:
    model = rg.load(ROOT / "models" / "split_torque.toml")
    static = rg.static(model, elements=1)
    for row in rg.check(model).meshes:
        assert row.phase_pitches == pytest.approx([static.mesh_phase[row.name]] * 2, rel=1e-12)


@pytest.mark.parametrize("name", ["split_torque", "geared_pair", "backlash_pair"])
def test_the_tables_of_check_fit_80_columns(name: str) -> None:
    ran = CliRunner(env={"COLUMNS": "80"}).invoke(app, ["check", str(ROOT / "models" / f"{name}.toml")])
    assert ran.exit_code == 0
    assert max(map(len, ran.output.splitlines())) <= 80


def test_a_bearing_with_rolling_elements_and_stiffness_says_which_counts() -> None:
    model = spur_pair(bearings__a__rolling=ROLLING)
    linear = "bearings.a.rolling: the stiffness carries; transients and sweeps take the rolling elements"
    assert linear in rg.check(model).left_out
    assert linear in rg.static(model, elements=1).left_out
    assert linear in rg.modal(model, modes=4, elements=1).left_out
    assert linear in rg.response(model, speeds=["1500 rpm"], elements=1).left_out
    said = left_out(System(model, 1), "time", 150.0)
    assert any(
        note.part == "bearings.a.stiffness" and "the rolling elements carry; statics and linear" in note
        for note in said
    )
    assert not any(".rolling" in note for note in rg.check(spur_pair()).left_out)
