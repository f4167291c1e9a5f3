"""Values by address: a new model with another value, checked like any other, and clear words where the address is wrong."""

from __future__ import annotations

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.model.address import places_of, tables_of
from tests.paths import ROOT

MODELS = ROOT / "models"


@pytest.fixture(scope="module")
def jeffcott() -> rg.Model:
    return rg.load(MODELS / "jeffcott.toml")


@pytest.fixture(scope="module")
def gearbox() -> rg.Model:
    return rg.load(MODELS / "split_torque.toml")


def test_a_value_is_read_as_in_a_file_and_everything_else_stays(gearbox: rg.Model) -> None:
    name = next(iter(gearbox.bearings))
    other = gearbox.with_(f"bearings.{name}.shaft", gearbox.bearings[name].shaft)
    assert other == gearbox
    faster = gearbox.with_("operation.speed", "3000 rpm")
    assert faster.operation is not None
    assert faster.operation.speed == pytest.approx(314.159265, rel=1e-8)
    assert faster.shafts == gearbox.shafts
    assert gearbox.operation is not None
    assert gearbox.operation.speed != faster.operation.speed


def test_the_frequency_of_a_rotor_follows_its_stiffness_by_the_square_root() -> None:
    # A point mass on an isotropic spring: f = sqrt(k / m) / 2 pi.
    text = """
[shafts.rotor]
material = "steel"
sections = [{ length = "10 mm", outer_diameter = "10 mm" }]
[disks.disk]
shaft = "rotor"
at = "5 mm"
mass = "100 kg"
diametral_inertia = "10 kg m^2"
polar_inertia = "20 kg m^2"
[bearings.only]
shaft = "rotor"
at = "5 mm"
stiffness = { radial = "1e6 N/m" }
"""
    model = rg.loads(text)
    soft = rg.modal(model, fmax=40.0, elements=1).frequency_hz
    stiff = rg.modal(model.with_("bearings.only.stiffness.radial", "4e6 N/m"), fmax=40.0, elements=1).frequency_hz
    held = model.with_("bearings.only.stiffness.axial", "3e6 N/m").with_("bearings.only.stiffness", "4e6 N/m")
    assert np.diag(held.bearings["only"].stiffness.as_rows())[:3] == pytest.approx([4e6, 4e6, 3e6])
    assert stiff[stiff > 1.0][:2] == pytest.approx(2.0 * soft[soft > 1.0][:2], rel=1e-4)


def test_a_place_in_a_list_reads_as_in_an_error(gearbox: rg.Model) -> None:
    shaft = next(iter(gearbox.shafts))
    address = f"shafts.{shaft}.sections[0].outer_diameter"
    assert places_of(tables_of(gearbox), address) == [("shafts", shaft, "sections", 0, "outer_diameter")]
    other = gearbox.with_(address, "77 mm")
    assert other.shafts[shaft].sections[0].outer_diameter == 0.077
    with pytest.raises(rg.ModelError, match=r"sections\[0\].outer_diameter: got '-1 mm', expected a positive length"):
        gearbox.with_(address, "-1 mm")


def test_what_follows_from_a_model_is_derived_anew(gearbox: rg.Model) -> None:
    assert gearbox.operation is not None
    before = gearbox.layout.direction
    other = gearbox.with_("operation.speed", -gearbox.operation.speed)
    assert other.layout.direction == -before
    assert gearbox.layout.direction == before


def test_several_addresses_change_together_and_a_star_means_all(gearbox: rg.Model) -> None:
    # One after the other these would not pass: the model is checked when all of them are in.
    other = gearbox.with_({"meshes.*.stiffness": "3e8 N/m", "title": "softer"})
    assert {mesh.stiffness for mesh in other.meshes.values()} == {3e8}
    assert other.title == "softer"


def test_none_takes_a_key_away_and_a_table_or_part_may_be_set(jeffcott: rg.Model) -> None:
    assert jeffcott.with_("title", "x").with_("title", None).title == ""
    name, bearing = next(iter(jeffcott.bearings.items()))
    assert jeffcott.with_(f"bearings.{name}", bearing) == jeffcott


def test_a_part_may_be_added_and_its_keys_changed_in_one_call(jeffcott: rg.Model) -> None:
    part = {"shaft": "rotor", "at": "0.1 m", "stiffness": {"radial": 1e6, "axial": 1e5}}
    changes = {"bearings.third": part, "bearings.third.at": "0.2 m", "bearings.*.stiffness.radial": "2e6 N/m"}
    other = jeffcott.with_(changes)
    assert (
        other.bearings["third"]
        == jeffcott.with_("bearings.third", {**part, "at": 0.2})
        .with_("bearings.third.stiffness", 2e6)
        .bearings["third"]
    )
    # Neither what was given nor another part that was given the same table is changed.
    assert part["at"] == "0.1 m"
    twins = jeffcott.with_({"bearings.*": part, "bearings.third": part, "bearings.third.stiffness.axial": 9.0})
    assert {name: b.stiffness.axial for name, b in twins.bearings.items() if b.stiffness} == {
        **dict.fromkeys(jeffcott.bearings, 1e5),
        "third": 9.0,
    }
    # A part of the library too, of whose keys one is changed.
    name, bearing = next(iter(jeffcott.bearings.items()))
    moved = jeffcott.with_({"bearings.third": bearing, "bearings.third.at": "0.2 m"})
    assert moved.bearings["third"] == jeffcott.with_(f"bearings.{name}.at", "0.2 m").bearings[name]


@pytest.mark.parametrize(
    ("address", "words"),
    [
        ("bearing.left.at", "the model has no 'bearing' there .did you mean 'bearings'"),
        ("shafts.rotr.material", "the model has no 'rotr' there .did you mean 'rotor'"),
        ("shafts.rotor.materiel", "unknown key .did you mean 'material'"),
        ("shafts.rotor.sections[9].length", "'9' is no place in a list of"),
        ("title.first", "nothing lies below a number or a text"),
    ],
)
def test_a_wrong_address_is_named_with_the_nearest_valid_one(jeffcott: rg.Model, address: str, words: str) -> None:
    with pytest.raises(rg.ModelError, match=words):
        jeffcott.with_(address, "1 mm")


def test_all_wrong_addresses_are_reported_at_once(jeffcott: rg.Model) -> None:
    with pytest.raises(rg.ModelError, match="2 problems"):
        jeffcott.with_({"shaft.rotor.start": 0.0, "bearing.left.at": 0.0})


def test_a_model_and_its_parts_show_themselves_in_a_line(gearbox: rg.Model) -> None:
    assert repr(gearbox).startswith("Model('Split-torque")
    assert "8 gears" in repr(gearbox) or "6 gears" in repr(gearbox)
    assert len(repr(gearbox)) < 200
    assert "<b>Split-torque" in gearbox._repr_html_()
    for table in (gearbox.shafts, gearbox.gears, gearbox.bearings, gearbox.meshes):
        assert all(len(repr(part)) < 300 for part in table.values())
    assert repr(rg.Load(shaft="a", kind="input", torque=2.0)) == "Load(shaft='a', kind='input', torque=2)"
