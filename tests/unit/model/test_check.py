"""Checks of the model as a whole: all mistakes at once, and nothing that only follows from another one."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from rotorgear.errors import ModelError
from rotorgear.model.model import Model
from rotorgear.model.parts.gear import Gear
from rotorgear.model.parts.mesh import Mesh
from rotorgear.model.parts.operation import Operation
from rotorgear.model.parts.shaft import Disk, Section, Shaft
from rotorgear.model.parts.supports import Bearing, StiffnessMatrix

Data = dict[str, Any]
Find = Callable[[Data], list[str]]


def test_a_broken_shaft_hides_nothing_of_what_stands_on_it_and_causes_nothing(pair: Data, addresses: Find) -> None:
    pair["shafts"]["input"]["sections"][0]["length"] = "-1 mm"
    pair["gears"]["pinion"].pop("hand")
    pair["bearings"]["input_left"]["stiffness"] = {}
    assert addresses(pair) == [
        "shafts.input.sections[0].length",
        "gears.pinion.hand",
        "bearings.input_left.stiffness",
    ]


def test_a_misspelt_name_is_found_beside_a_broken_part(pair: Data, addresses: Find) -> None:
    pair["gears"]["wheel"]["width"] = "28 deg"
    pair["bearings"]["input_left"]["shaft"] = "inputt"
    assert addresses(pair) == ["gears.wheel.width", "bearings.input_left.shaft"]


def test_names_in_a_part_with_a_wrong_number_are_checked_all_the_same(pair: Data, addresses: Find) -> None:
    pair["bearings"]["input_left"] |= {"shaft": "inputt", "damping": [5]}
    assert addresses(pair) == ["bearings.input_left.damping", "bearings.input_left.shaft"]


def test_a_misspelt_required_key_is_one_mistake_and_its_value_is_used(pair: Data, addresses: Find) -> None:
    section = pair["shafts"]["input"]["sections"][0]
    section["lenght"] = section.pop("length")
    assert addresses(pair) == ["shafts.input.sections[0].lenght"]
    pair["bearings"]["input_right"]["at"] = "201 mm"
    assert addresses(pair) == ["shafts.input.sections[0].lenght", "bearings.input_right.at"]


def test_a_misspelt_table_is_looked_into(pair: Data, addresses: Find) -> None:
    pair["gear"] = pair.pop("gears")
    pair["gear"]["wheel"]["teeth"] = -5
    assert addresses(pair) == ["gear", "gears.wheel.teeth"]


def test_a_key_of_no_known_meaning_leaves_its_part_unjudged(pair: Data, addresses: Find) -> None:
    pair["bearings"]["input_left"]["stiffness"] = {"qqq": 1}
    assert addresses(pair) == ["bearings.input_left.stiffness.qqq"]


def test_a_table_that_is_no_table_says_nothing_about_the_names_in_it(pair: Data, addresses: Find) -> None:
    pair["gears"] = 3
    assert addresses(pair) == ["gears"]
    pair["shafts"] = "two"
    assert addresses(pair) == ["shafts", "gears"]


def test_a_missing_table_of_shafts_is_one_mistake(pair: Data, addresses: Find) -> None:
    del pair["shafts"]
    assert addresses(pair) == ["shafts"]
    pair["shafts"] = {}
    assert addresses(pair) == ["shafts"]


def test_a_wrong_material_does_not_keep_its_shaft_from_being_checked(pair: Data, addresses: Find) -> None:
    pair["materials"] = {"alloy": {"youngs_modulus": "200 GPa", "density": "8 kg"}}
    pair["shafts"]["input"]["material"] = "alloy"
    pair["shafts"]["output"]["material"] = "steal"
    pair["gears"]["wheel"]["body"]["bore"] = "200 mm"
    assert addresses(pair) == ["materials.alloy.density", "shafts.output.material", "gears.wheel"]


def test_a_wrong_mesh_does_not_make_a_load_hang_in_the_air(pair: Data, addresses: Find) -> None:
    pair["gears"]["wheel"]["hand"] = "right"
    assert addresses(pair) == ["meshes.stage"]
    pair["meshes"]["stage"]["stiffness"] = "4e8 N"
    assert addresses(pair) == ["meshes.stage.stiffness"]


def test_a_wrong_body_and_a_wrong_mesh_are_both_found(pair: Data, addresses: Find) -> None:
    pair["gears"]["wheel"]["body"]["bore"] = "200 mm"
    pair["shafts"]["output"]["position"] = ["110 mm", 0]
    assert addresses(pair) == ["meshes.stage", "gears.wheel"]


def test_a_wrong_operating_point_is_found_beside_a_wrong_mesh_and_silences_the_balance(
    pair: Data, addresses: Find
) -> None:
    pair["gears"]["wheel"]["hand"] = "right"
    del pair["operation"]["speed"]
    assert addresses(pair) == ["operation.power", "meshes.stage"]


def test_a_load_of_unknown_size_says_nothing_about_the_balance(pair: Data, addresses: Find) -> None:
    pair["operation"].pop("power")
    pair["loads"] = {
        "motor": {"shaft": "input", "kind": "input", "torque": "100 N m"},
        "mill": {"shaft": "output", "kind": "output", "torque": "250 N"},
    }
    assert addresses(pair) == ["loads.mill.torque"]
    pair["loads"]["mill"]["torque"] = "250 N m"
    assert addresses(pair) == ["loads"]
    pair["loads"]["mill"]["torque"] = "300 N m"
    Model(**pair)


def test_an_output_that_would_have_to_drive_is_refused(pair: Data, addresses: Find) -> None:
    pair["operation"].pop("power")
    pair["loads"] = {
        "mill": {"shaft": "output", "kind": "output", "torque": "250 N m"},
        "fan": {"shaft": "input", "kind": "output"},
    }
    assert addresses(pair) == ["loads.fan"]


def test_a_newer_file_is_judged_by_its_version_only(pair: Data, addresses: Find) -> None:
    pair |= {"schema_version": 2, "gears": 5, "springs": {}}
    assert addresses(pair) == ["schema_version"]


def test_names_that_would_read_as_addresses_are_refused(pair: Data, addresses: Find) -> None:
    for number, name in enumerate(["a.b", "a[0]", "a/b", "", " a", "-", "x" * 61, "a\nb", '"']):
        pair["point_masses"] = {name: {"shaft": "input", "at": 0, "mass": 1}}
        assert len(addresses(pair)) == 1, number
    for name in ["input left", "Welle_groß", "2", "a-b"]:
        pair["point_masses"] = {name: {"shaft": "input", "at": 0, "mass": 1}}
        Model(**pair)


def test_axes_may_miss_the_centre_distance_by_a_twentieth_of_the_module_and_no_more(
    pair: Data, addresses: Find
) -> None:
    exact = 102.161  # mm
    for offset, fits in [(0.09, True), (-0.09, True), (0.11, False), (-0.11, False)]:
        pair["shafts"]["output"]["position"] = [f"{exact + offset} mm", "0 mm"]
        if fits:
            Model(**pair)
        else:
            assert addresses(pair) == ["meshes.stage"]


def test_a_profile_shift_moves_the_axes(pair: Data, addresses: Find) -> None:
    pair["gears"]["pinion"]["profile_shift"] = 0.4
    assert addresses(pair) == ["meshes.stage"]
    pair["gears"]["wheel"]["profile_shift"] = -0.4
    Model(**pair)
    pair["gears"]["pinion"]["profile_shift"] = pair["gears"]["wheel"]["profile_shift"] = -1.2
    assert addresses(pair) == ["meshes.stage"]


def test_base_circles_that_overlap_are_refused_for_lumped_gears_without_an_angle(
    everything: Data, addresses: Find
) -> None:
    for shaft, x in (("point", "0 mm"), ("fan", "150 mm")):
        everything["shafts"][shaft]["position"] = [x, "500 mm"]
    for gear in ("idler", "driven"):
        del everything["gears"][gear]["transverse_pressure_angle"]
    for key in ("centre_line_angle", "pressure_angle"):
        del everything["meshes"]["lumped"][key]
    assert addresses(everything) == ["meshes.lumped"]
    everything["shafts"]["fan"]["position"] = ["150.01 mm", "500 mm"]
    Model(**everything)


def test_a_torsion_only_model_needs_no_positions(pair: Data, addresses: Find) -> None:
    del pair["shafts"]["output"]["position"]
    assert addresses(pair) == ["meshes.stage.centre_line_angle"]
    pair["motions"] = ["torsion"]
    Model(**pair)


def test_the_angle_of_a_centre_line_is_not_given_beside_positions(pair: Data, addresses: Find) -> None:
    pair["meshes"]["stage"] |= {"centre_line_angle": "0 deg", "pressure_angle": "20 deg"}
    assert addresses(pair) == ["meshes.stage.centre_line_angle", "meshes.stage.pressure_angle"]


def test_a_section_that_tapers_below_its_bore_is_refused_once(pair: Data, addresses: Find) -> None:
    pair["shafts"]["input"]["sections"][0] |= {"bore": "20 mm", "outer_diameter_end": "20 mm"}
    assert addresses(pair) == ["shafts.input.sections[0].bore_end"]


def test_python_objects_give_the_same_report_as_a_file(pair: Data) -> None:
    pair["meshes"]["stage"]["gear"] = "whel"
    pair["bearings"]["input_right"]["at"] = "201 mm"
    pair["shafts"]["output"]["material"] = "steal"
    objects = {
        "operation": Operation(**pair["operation"]),
        "shafts": {name: Shaft(**part) for name, part in pair["shafts"].items()},
        "gears": {name: Gear(**part) for name, part in pair["gears"].items()},
        "meshes": {name: Mesh(**part) for name, part in pair["meshes"].items()},
        "bearings": {name: Bearing(**part) for name, part in pair["bearings"].items()},
    }
    reports = []
    for data in (pair, objects):
        with pytest.raises(ModelError) as caught:
            Model(**data)
        reports.append(caught.value.problems)
    assert reports[0] == reports[1]
    assert len(reports[0]) == 3


def test_objects_and_tables_may_be_mixed_and_the_objects_survive_a_mistake_beside_them(
    pair: Data, addresses: Find
) -> None:
    pair["operation"] = Operation(input_shaft="inptu")
    pair["title"] = 5
    pair["shafts"]["input"]["sections"] = [Section(length=0.2, outer_diameter=0.04)]
    assert addresses(pair) == ["title", "operation.input_shaft"]


def test_a_single_part_tells_its_mistakes_as_a_model_error() -> None:
    with pytest.raises(ModelError) as caught:
        Shaft(sections=[{"lenght": "20 mm", "outer_diameter": "-40 mm"}], materail="steel")
    assert str(caught.value) == (
        "Shaft: 3 problems\n"
        "  sections[0].outer_diameter: got '-40 mm', expected a positive length such as '20 mm'\n"
        "  sections[0].lenght: unknown key (did you mean 'length'?)\n"
        "  materail: unknown key (did you mean 'material'?)"
    )
    with pytest.raises(ModelError, match=r"^Disk: 1 problem\n  shaft: missing \(required: name of the shaft\)"):
        Disk(at=0.0)
    with pytest.raises(ModelError, match="got 'x', expected a stiffness"):
        Bearing(shaft="a", at="start", stiffness=StiffnessMatrix(radial="x"))


def test_parts_are_frozen() -> None:
    shaft = Shaft()
    with pytest.raises(Exception, match="frozen"):
        shaft.start = 1.0  # type: ignore[misc]
