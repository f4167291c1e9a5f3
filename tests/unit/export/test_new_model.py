"""Model files begun from those that come with the package."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

import rotorgear as rg
from rotorgear.cli.main import app
from tests.paths import ROOT


def test_every_model_of_the_repository_comes_with_the_package_and_has_a_title() -> None:
    assert [model.name for model in rg.models()] == sorted(file.stem for file in (ROOT / "models").glob("*.toml"))
    assert all(model.title for model in rg.models())


def test_the_command_gives_each_model_one_line_of_80_columns() -> None:
    lines = CliRunner(env={"COLUMNS": "80"}).invoke(app, ["models"]).output.splitlines()
    assert [line.split()[0] for line in lines[: len(rg.models())]] == [model.name for model in rg.models()]
    assert max(map(len, lines)) <= 80


@pytest.mark.parametrize("name", [model.name for model in rg.models()])
def test_a_new_file_is_the_model_with_its_comments_and_reads_alone(name: str, tmp_path: Path) -> None:
    written = rg.new(tmp_path / "mine.toml", name)
    line, _, rest = written[0].read_bytes().partition(b"\n")
    assert line == b"#:schema ./model.schema.json"
    assert rest == (ROOT / "models" / f"{name}.toml").read_bytes()
    assert {file.name for file in tmp_path.iterdir()} == {file.name for file in written}
    assert rg.load(written[0]).title == rg.load(ROOT / "models" / f"{name}.toml").title


def test_meshes_and_rig_lines_are_written_beside_the_model(tmp_path: Path) -> None:
    assert [file.name for file in rg.new(tmp_path / "a.toml", "split_torque_casing")] == [
        "a.toml",
        "split_torque_casing.msh",
        "model.schema.json",
    ]
    assert [file.name for file in rg.new(tmp_path / "split_torque.toml")] == [
        "split_torque.toml",
        "split_torque_rig.csv",
    ]  # the schema is there already


def test_the_mesh_of_a_gear_body_comes_along(tmp_path: Path) -> None:
    assert [file.name for file in rg.new(tmp_path / "b.toml", "elastic_wheel")] == [
        "b.toml",
        "elastic_wheel.inp",
        "model.schema.json",
    ]


def test_editors_find_the_schema_of_the_package_beside_the_model_and_one_that_is_there_stays(tmp_path: Path) -> None:
    beside = rg.new(tmp_path / "b.toml")[-1]
    assert json.loads(beside.read_text(encoding="utf-8")) == rg.schema()
    beside.write_text("{}", encoding="utf-8")
    assert rg.new(tmp_path / "c.toml") == [tmp_path / "c.toml"]
    assert beside.read_text(encoding="utf-8") == "{}"
    assert rg.new(tmp_path / "c.toml", force=True)[-1] == beside
    assert json.loads(beside.read_text(encoding="utf-8")) == rg.schema()


def test_a_file_of_no_model_s_name_begins_as_the_plain_stage(tmp_path: Path) -> None:
    assert rg.load(rg.new(tmp_path / "mine.toml")[0]).title == "Helical stage on two shafts"


def test_nothing_is_overwritten_and_nothing_written_unless_forced(tmp_path: Path) -> None:
    mesh = tmp_path / "split_torque_casing.msh"
    mesh.write_text("mine", encoding="utf-8")
    with pytest.raises(rg.AnalysisError, match=r"split_torque_casing\.msh would be overwritten.*--force"):
        rg.new(tmp_path / "a.toml", "split_torque_casing")
    assert [file.name for file in tmp_path.iterdir()] == [mesh.name]
    rg.new(tmp_path / "a.toml", "split_torque_casing", force=True)
    assert mesh.stat().st_size > 1000


@pytest.mark.parametrize(
    ("path", "source", "said"),
    [
        ("a.toml", "split_torqe", "did you mean 'split_torque'"),
        ("a.json", "split_torque", "ends in .toml"),
    ],
)
def test_a_wrong_name_is_refused_with_the_remedy(path: str, source: str, said: str, tmp_path: Path) -> None:
    with pytest.raises(rg.AnalysisError, match=said):
        rg.new(tmp_path / path, source)
