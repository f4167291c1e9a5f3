"""The gear sheet: what it holds, prints, draws and refuses."""

from __future__ import annotations

import json
import tomllib
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import rotorgear as rg
from rotorgear.cli.main import app
from rotorgear.gears.geometry.outline import tooth_outline
from rotorgear.plots.gear_mesh import contact_points, gear_contour
from tests.models import pair_file
from tests.paths import MODELS

PAIR = MODELS / "helical_pair.toml"


def run(*arguments: str) -> tuple[int, str]:
    done = CliRunner().invoke(app, ["gear", *arguments], env={"COLUMNS": "80"})
    return done.exit_code, done.output


def test_all_lines_fit_in_80_columns_and_no_cell_is_broken() -> None:
    code, text = run(str(MODELS / "split_torque.toml"))
    assert code == 0
    assert max(map(len, text.splitlines())) <= 80
    kinds = [line.split() for line in text.splitlines() if line.startswith("kind ")]
    assert kinds == [["kind"] + 4 * ["herringbone"], ["kind"] + 2 * ["herringbone"]]


def test_one_mesh_shows_its_two_gears_only() -> None:
    sheet = rg.gear(rg.load(MODELS / "split_torque.toml"), mesh="stage_2a")
    assert [row.name for row in sheet.meshes] == ["stage_2a"]
    assert {row.name for row in sheet.gears} == {"pinion_2a", "bull"}


def test_the_factor_k_v_needs_the_accuracy_of_both_gears_and_then_comes_by_method_b() -> None:
    data = tomllib.loads(PAIR.read_text(encoding="utf-8"))
    without = rg.gear(rg.Model(**data)).meshes[0]
    assert (without.dynamic_factor, without.dynamic_factor_method) == (None, "K_v: give accuracy_grade of both gears")
    for gear in data["gears"].values():
        gear["accuracy_grade"] = 6
    row = rg.gear(rg.Model(**data)).meshes[0]
    assert row.dynamic_factor_method == "ISO 6336-1 method B"
    assert row.dynamic_factor is not None
    assert 1.0 < row.dynamic_factor < 1.6
    data["gears"]["pinion"]["accuracy_grade"] = 10
    worse = rg.gear(rg.Model(**data)).meshes[0].dynamic_factor
    assert worse is not None
    assert worse > row.dynamic_factor


def test_the_drawn_contours_touch_at_the_contact_points_and_never_overlap() -> None:
    """On the line of action the signed distance of both gears is zero; elsewhere the gap between them is positive."""
    from matplotlib.path import Path as Polygon

    sheet = rg.gear(rg.load(PAIR))
    teeth = sheet.pairs["stage"]
    first = gear_contour(teeth, 1)
    second = gear_contour(teeth, 2)
    for point in contact_points(teeth):
        for contour in (first, second):
            a = contour[:-1]
            b = contour[1:]
            along = np.clip(np.einsum("ij,ij->i", point - a, b - a) / np.einsum("ij,ij->i", b - a, b - a), 0, 1)
            assert np.hypot(*(point - a - along[:, None] * (b - a)).T).min() < 2e-6
    deep = Polygon(first).contains_points(second)
    inside = second[deep]
    a = first[:-1]
    b = first[1:]
    for point in inside:  # chords of the outline may cut in by their sagitta, no more
        along = np.clip(np.einsum("ij,ij->i", point - a, b - a) / np.einsum("ij,ij->i", b - a, b - a), 0, 1)
        assert np.hypot(*(point - a - along[:, None] * (b - a)).T).min() < 2e-6


@pytest.mark.parametrize("ending", [".png", ".svg"])
def test_a_drawing_is_written_whole(tmp_path: Path, ending: str) -> None:
    target = rg.plot.save(rg.plot.gear(rg.gear(rg.load(PAIR))), tmp_path / f"mesh{ending}")
    assert target.stat().st_size > 10_000
    assert list(tmp_path.iterdir()) == [target]


def test_what_is_refused_leaves_nothing_behind(tmp_path: Path) -> None:
    for arguments, words in (
        ((str(PAIR), "--mesh", "stge"), "There is no mesh 'stge'"),
        ((str(PAIR), "--plot", str(tmp_path / "mesh.jpg")), "a plot is written as PNG, SVG or PDF"),
        ((str(MODELS / "jeffcott.toml"),), "has no gears with teeth"),
    ):
        from rotorgear.errors import RotorgearError

        done = CliRunner().invoke(app, ["gear", *arguments, "--json", str(tmp_path / "sheet.json")])
        assert isinstance(done.exception, RotorgearError)
        assert words in str(done.exception)
    assert list(tmp_path.iterdir()) == []


def test_the_json_holds_plain_finite_numbers(tmp_path: Path) -> None:
    target = tmp_path / "sheet.json"
    assert run(str(PAIR), "--json", str(target))[0] == 0
    data = json.loads(target.read_text(encoding="utf-8"))
    assert data["analysis"] == "gear"
    row = data["meshes"][0]
    assert row["total_contact_ratio"] == pytest.approx(
        row["transverse_contact_ratio"] + row["overlap_ratio"], rel=1e-14
    )


def test_a_pinion_with_two_mates_is_told_that_k_v_knows_one() -> None:
    data = tomllib.loads((MODELS / "split_torque.toml").read_text(encoding="utf-8"))
    for gear in data["gears"].values():
        gear["accuracy_grade"] = 5
    rows = {row.name: row for row in rg.gear(rg.Model(**data)).meshes}
    assert "'pinion_1' has other mates too" in " ".join(rows["stage_1a"].warnings)
    assert "'wheel_a'" not in " ".join(rows["stage_1a"].warnings)
    assert rows["stage_1a"].dynamic_factor == pytest.approx(rows["stage_1b"].dynamic_factor, rel=1e-6)


def test_without_a_torque_the_sheet_has_all_but_the_stiffness_of_loaded_teeth_and_says_so() -> None:
    bare = rg.gear(rg.loads(pair_file(torque="")))
    loaded = rg.gear(rg.loads(pair_file(mesh='stiffness = "tooth_fe"\ntooth_fe = { preset = "preview" }')))
    assert bare.gears == loaded.gears
    assert bare.meshes[0].iso_mesh_stiffness_n_per_m2 == loaded.meshes[0].iso_mesh_stiffness_n_per_m2
    assert bare.meshes[0].stiffness_n_per_m is None
    assert "meshes.pair: the stiffness of 'tooth_fe' is that of loaded teeth" in " ".join(bare.left_out)
    assert loaded.left_out == ()
    assert "mean, normal" not in bare.text()
    assert "mean, normal" in loaded.text()


def test_of_an_undercut_pair_the_contact_ratio_of_the_involute_that_is_left_stands_beside_that_of_the_tips() -> None:
    """Path from form circle to form circle by hand: contact starts where the pinion's involute begins."""
    data = tomllib.loads(pair_file(torque=""))
    data["gears"]["pinion"]["teeth"] = 10
    data["shafts"]["two"]["position"] = ["225 mm", "0 mm"]
    data["shafts"]["one"]["sections"] = [{"length": "300 mm", "outer_diameter": "25 mm"}]
    row = rg.gear(rg.Model(**data)).meshes[0]
    teeth = rg.gear(rg.Model(**data)).pairs["pair"]
    form = tooth_outline(teeth.first).form_radius
    start = np.sqrt(form**2 - teeth.first.base_radius**2)
    end = np.sqrt((0.5 * teeth.first.effective_tip_diameter) ** 2 - teeth.first.base_radius**2)
    assert row.involute_contact_ratio == pytest.approx((end - start) / teeth.first.transverse_base_pitch, rel=1e-12)
    assert row.involute_contact_ratio < row.transverse_contact_ratio - 0.1
    assert "of the involute left" in rg.gear(rg.Model(**data)).text()
    assert "of the involute left" not in rg.gear(rg.load(PAIR)).text()
