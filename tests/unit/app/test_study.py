"""A model file under the hand: what it shows of its keys, what a change writes, and what is refused."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest

import rotorgear as rg
from rotorgear.app.study import Study, spelled
from rotorgear.errors import AnalysisError, RotorgearError
from rotorgear.files.write import WriteError
from tests.paths import ROOT

TEXT = """\
# a rotor on two bearings
schema_version = 1
title = "<script>alert(1)</script> & **bold**"

[operation]
input_shaft = "rotor"
speed = "3000 rpm" # of the grid

[shafts.rotor]
material = "steel"
sections = [
    { length = "400 mm", outer_diameter = "40 mm" }, # left
    { length = "300 mm", outer_diameter = "50 mm" },
]

[disks.wheel]
shaft = "rotor"
at = "400 mm"
mass = 12.5
polar_inertia = 0.1
diametral_inertia = 0.06

[bearings.left]
shaft = "rotor"
at = "start"
stiffness = { radial = "2e7 N/m", axial = "1e7 N/m" }

[bearings.right]
shaft = "rotor"
at = "end"
stiffness = { radial = "3e7 N/m" }
"""


@pytest.fixture
def study(tmp_path: Path) -> Study:
    path = tmp_path / "rotor.toml"
    path.write_text(TEXT, encoding="utf-8")
    return Study(path)


def test_keys_have_what_the_schema_says_of_them(study: Study) -> None:
    assert study.parts[:4] == ["", "operation", "shafts.rotor", "disks.wheel"]
    fields = {field.address: field for field in study.fields("shafts.rotor")}
    length = fields["shafts.rotor.sections[1].length"]
    assert (length.text, length.unit, length.bounds, length.is_number) == ("300 mm", "m", "> 0", True)
    assert length.meaning == "length along z"
    lumped = fields["shafts.rotor.mass_matrix"]
    assert (lumped.given, lumped.choices) == (False, ("consistent", "lumped"))
    power = {field.address: field for field in study.fields("operation")}["operation.power"]
    assert (power.given, power.unit, power.bounds) == (False, "W", "≥ 0")
    left = {field.address: field for field in study.fields("bearings.left")}
    assert left["bearings.left.stiffness.radial"].is_number
    assert not left["bearings.left.at"].is_number
    assert "or start, end" in left["bearings.left.at"].meaning
    assert [field.address for field in study.fields("") if field.given] == ["title"]


@pytest.mark.parametrize("model", ["ev_reducer", "planetary", "two_stage_casing", "helicopter", "jeffcott"])
def test_every_key_of_a_shipped_file_has_a_field_with_its_meaning(model: str) -> None:
    study = Study(ROOT / "models" / f"{model}.toml")
    for part in study.parts:
        fields = study.fields(part)
        assert any(field.given for field in fields) or not part, part
        assert all(field.meaning for field in fields if field.given), [f.address for f in fields if not f.meaning]


def test_a_change_is_one_line_and_undo_takes_it_back(study: Study) -> None:
    assert study.change("shafts.rotor.sections[0].outer_diameter", "45 mm")
    assert study.difference == [
        '-    { length = "400 mm", outer_diameter = "40 mm" }, # left',
        '+    { length = "400 mm", outer_diameter = "45 mm" }, # left',
    ]
    assert study.change("operation.speed", "3600 rpm")
    assert '+speed = "3600 rpm" # of the grid' in study.difference
    assert len(study.difference) == 4
    assert study.model == rg.loads(study.text)
    study.undo()
    study.undo()
    assert (study.text, study.can_undo, study.difference) == (TEXT, False, [])
    assert study.change("disks.wheel.mass", "13")
    assert "mass = 13\n" in study.text
    assert study.change("shafts.rotor.internal_damping", "1e-5 s")
    assert study.change("shafts.rotor.internal_damping", None)
    assert "internal_damping" not in study.text


def test_a_bad_value_waits_with_the_sentence_of_the_file(study: Study) -> None:
    assert not study.change("disks.wheel.mass", "-3")
    with pytest.raises(rg.ModelError) as told:
        rg.loads(TEXT.replace("mass = 12.5", "mass = -3"), "rotor.toml")
    assert list(map(str, study.problems)) == list(map(str, told.value.problems))
    assert (study.text, study.waiting) == (TEXT, {"disks.wheel.mass": -3})
    assert study.change("disks.wheel.mass", "3")
    assert not study.problems
    assert not study.waiting
    assert not study.change("bearings.left.pedestal.mass", "3")  # the file has no pedestal to write it into
    assert [str(one) for one in study.problems] == [
        "bearings.left.pedestal.mass: the file does not spell this value out: it can't be written there"
    ]


def test_two_changes_that_only_fit_together_are_taken_together(study: Study) -> None:
    assert not study.change("disks.wheel.at", "800 mm")  # beyond the shaft's end
    assert study.change("shafts.rotor.sections[1].length", "500 mm")
    assert 'at = "800 mm"' in study.text
    assert 'length = "500 mm"' in study.text
    assert not study.change("disks.wheel.at", "900.1 mm")
    study.undo()
    assert not study.problems
    assert 'at = "800 mm"' in study.text


def test_a_dragged_number_keeps_its_unit_and_nothing_else_is_kept(study: Study) -> None:
    field = next(one for one in study.fields("bearings.left") if one.key == "radial")
    assert [study.dragged(field, factor) for factor in (1.0, 2.0, 1.0 / 3.0)] == [
        "20000000 N/m",
        "40000000 N/m",
        "6667000 N/m",
    ]
    whole = Study(ROOT / "models" / "planetary.toml")
    teeth = next(one for one in whole.fields("gears.sun") if one.key == "teeth")
    assert whole.dragged(teeth, 1.01) == teeth.text
    assert whole.dragged(teeth, 2.0) == str(2 * int(teeth.text))
    trial = study.trial(field.address, study.dragged(field, 2.0))
    assert trial == study.model.with_("bearings.left.stiffness.radial", 4e7)
    assert (study.text, study.can_undo) == (TEXT, False)
    with pytest.raises(RotorgearError):
        study.trial(field.address, "-1 N/m")


def test_saving_writes_the_file_unless_another_program_did(study: Study) -> None:
    study.change("disks.wheel.mass", "13")
    assert rg.load(study.save()) == study.model
    assert study.difference == []
    study.path.write_text(TEXT, encoding="utf-8")
    study.change("disks.wheel.mass", "14")
    with pytest.raises(WriteError, match="another program has changed it"):
        study.save()
    assert study.path.read_text(encoding="utf-8") == TEXT


def test_no_path_comes_from_the_browser(study: Study, tmp_path_factory: pytest.TempPathFactory) -> None:
    elsewhere = tmp_path_factory.mktemp("elsewhere") / "rig.csv"
    elsewhere.write_text("frequency_hz\n30\n", encoding="utf-8")
    (study.folder / "own.csv").write_text("frequency_hz\n30\n", encoding="utf-8")
    (study.folder / "link.csv").symlink_to(elsewhere)
    assert study.rigs == ["own.csv"]  # a link that leads out of the folder is no file of it
    assert study.rig("own.csv") == study.folder / "own.csv"
    for name in (str(elsewhere), "../elsewhere/rig.csv", "link.csv", "rotor.toml", "./own.csv", ""):
        with pytest.raises(AnalysisError, match="no file of a rig in the folder"):
            study.rig(name)


def test_a_file_outside_the_folder_is_not_read_for_the_page(study: Study) -> None:
    before = study.text
    for name in ("/etc/passwd", "../secret.csv", "in/../../secret.csv"):
        assert not study.change("loads", {"turn": {"shaft": "rotor", "at": "start", "history": name}})
        assert [str(one) for one in study.problems] == [
            f"{name}: a file that the page names lies in the folder of the model"
        ]
        study.undo()
    assert study.text == before


def test_texts_in_a_list_are_spelled_as_toml_reads_them() -> None:
    texts = ['"quoted"', "a\\b", "°C"]
    assert tomllib.loads(f"value = {spelled(texts)}")["value"] == texts
