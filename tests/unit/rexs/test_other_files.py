"""Gearboxes from REXS of another program and version: load cases, a shaft in a shaft, added masses, coded arrays, gaps."""

from __future__ import annotations

import base64
import json
import struct
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import rotorgear as rg
from rotorgear.rexs.document import Component, Document, Relation, Value
from tests.unit.rexs.documents import BEARINX, SAMPLE, bearinx, changed, sample, with_component, write_json

MM = "mm"
RATIO = (51 / 27) * (34 / 23)


def imported(document: Document, tmp_path: Path) -> rg.RexsImport:
    return rg.import_rexs(write_json(document, tmp_path / "gearbox.rexsj"))


@pytest.mark.parametrize(
    ("case", "rpm", "torque", "force"), [(1, 543.0, 567.0, 456.0), (2, 3456.0, 345.0, 678.0), (4, 789.0, 789.0, 1233.0)]
)
def test_the_public_file_of_version_1_4_has_its_axes_its_ratio_and_its_load_cases(
    case: int, rpm: float, torque: float, force: float
) -> None:
    result = rg.import_rexs(BEARINX, load_case=case)
    model = rg.loads(result.toml)
    said = rg.check(model)
    assert (result.shafts, result.gears, result.meshes, result.bearings) == (3, 4, 2, 6)
    assert [1e3 * (row.centre_distance_m or 0.0) for row in said.meshes] == pytest.approx([190.0, 190.0], abs=1e-9)
    assert said.shafts[0].speed_rpm == pytest.approx(rpm)
    assert said.shafts[2].speed_ratio == pytest.approx(
        1.0 / RATIO, rel=1e-12
    )  # the output stands on the axis of the input
    assert [row.torque_n_m for row in said.torques] == pytest.approx([torque, -torque * RATIO])
    assert model.loads["load_70_force"].force[0] == pytest.approx(force)  # type: ignore[index]
    assert result.left_out == ()


def test_a_needle_bearing_between_two_shafts_holds_them_across_only() -> None:
    model = rg.loads(rg.import_rexs(BEARINX).toml)
    (coupling,) = model.couplings.values()
    assert (coupling.from_shaft, coupling.to_shaft) == ("shaft_6", "shaft_42")
    K = coupling.stiffness.as_rows()
    assert K[0][0] > 1e7
    # Its file says 1e15 N mm/rad for its tilt, which stands for rigid.
    assert [K[k][k] for k in range(2, 6)] == [0.0] * 4


# What programs write for "not set", "unlimited" or "rigid".
PLACEHOLDERS = ("-1", "1e10", "9.999999999999999E22", "NaN", "inf", "-9999")
PLACES = [
    ("shaft_section", "length"),
    ("shaft_section", "outer_diameter_begin"),
    ("shaft_section", "outer_diameter_end"),
    ("shaft_section", "inner_diameter_begin"),
    ("shaft", "support_vector"),
    ("cylindrical_gear", "normal_module"),
    ("cylindrical_gear", "face_width"),
    ("cylindrical_gear", "number_of_teeth"),
    ("cylindrical_gear", "helix_angle_reference_diameter"),
    ("cylindrical_gear", "tip_diameter"),
    ("cylindrical_gear_flank", "normal_pressure_angle"),
    ("material", "elastic_modulus"),
    ("material", "poisson_ratio"),
    ("material", "density"),
    ("concept_bearing", "radial_stiffness"),
    ("concept_bearing", "axial_stiffness"),
    ("concept_bearing", "bending_stiffness"),
    ("rolling_bearing_with_catalog_geometry", "inner_diameter"),
    ("rolling_bearing_with_catalog_geometry", "outer_diameter"),
    ("rolling_bearing_with_catalog_geometry", "catalogue_designation"),
    ("rolling_bearing_with_catalog_geometry", "u_coordinate_on_shaft_inner_side"),
]


@pytest.mark.parametrize(("kind", "name"), PLACES)
def test_a_placeholder_is_reported_or_stands_for_nothing(kind: str, name: str, tmp_path: Path) -> None:
    document = bearinx()
    part = document.of_type(kind)[1]
    unit = (
        part.attributes[name].unit
        if name in part.attributes
        else {"inner_diameter": MM, "outer_diameter": MM}.get(name, "")
    )
    # A missing value is what a placeholder has to come to; where it can't be missing, the import has to refuse it.
    without = _model_or_none(changed(document, part.id, **{name: None}), tmp_path)
    for text in PLACEHOLDERS:
        raw: object = [text] * 3 if name.endswith("_vector") else text
        found = _model_or_none(changed(document, part.id, **{name: Value(raw, unit)}), tmp_path)
        assert found is None or found == without, text


def _model_or_none(document: Document, tmp_path: Path) -> rg.Model | None:
    try:
        return rg.loads(imported(document, tmp_path).toml)
    except rg.RotorgearError:
        return None


@pytest.mark.parametrize("text", PLACEHOLDERS[1:])
def test_a_section_far_from_its_shaft_is_reported_and_no_gap_to_it_is_filled(text: str, tmp_path: Path) -> None:
    document = changed(bearinx(), "22", u_coordinate_on_shaft=Value(text, MM))
    found = _model_or_none(document, tmp_path)
    # NaN stands for no coordinate: then the section follows the one before it, as it does in the file.
    assert found is None or found == _model_or_none(bearinx(), tmp_path)


def test_what_stands_for_no_value_is_said(tmp_path: Path) -> None:
    document = changed(bearinx(), "57", elastic_modulus=Value("NaN", "N / mm^2"))
    result = imported(document, tmp_path)
    assert any("elastic_modulus = nan N / mm^2 stands for no value" in note for note in result.warnings)
    assert any(item.value == "206 GPa" for item in result.assumptions)


def with_mass(document: Document, **attributes: Value) -> Document:
    """The 1.4 file with an additional mass on its first shaft."""
    document = with_component(document, Component("900", "additional_mass", "Mass point [7]", attributes))
    return replace(
        document, relations=(*document.relations, Relation("assembly", (("assembly", "12"), ("part", "900"))))
    )


def test_an_additional_mass_is_a_disk_or_a_point_with_the_unbalance_of_its_eccentricity(tmp_path: Path) -> None:
    e = Value([0.0, 0.3, 0.4], MM)
    place = {"u_coordinate_on_shaft": Value(45.0, MM), "mass_of_component": Value(50.0, "kg"), "eccentricity_vector": e}
    inertia = {f"moment_of_inertia_{axis}_axis": Value(0.0, "kg m^2") for axis in "uvw"}
    model = rg.loads(imported(with_mass(bearinx(), **place, **inertia), tmp_path).toml)
    (point,) = model.point_masses.values()
    assert (point.shaft, point.at, point.mass) == ("shaft_6", pytest.approx(-0.025), 50.0)
    (unbalance,) = model.unbalances.values()
    assert unbalance.magnitude == pytest.approx(50.0 * 0.5e-3)
    assert unbalance.phase == pytest.approx(0.9272952180016122)  # v is x, w is y: atan2(4, 3)

    inertia = {
        f"moment_of_inertia_{axis}_axis": Value(value, "") for axis, value in zip("uvw", (3.0, 1.5, 1.7), strict=True)
    }
    result = imported(
        with_mass(bearinx(), **{**place, "eccentricity_vector": Value([0, 0, 0], MM)}, **inertia), tmp_path
    )
    model = rg.loads(result.toml)
    (disk,) = model.disks.values()
    assert (disk.mass, disk.polar_inertia, disk.diametral_inertia) == pytest.approx((50.0, 3.0, 1.6))
    assert not model.unbalances
    assert any("1.5 about v, 1.7 kg m^2 about w" in item.reason for item in result.assumptions)


def test_a_load_rating_without_a_unit_is_in_kilonewtons_as_in_the_data_base_of_the_format(tmp_path: Path) -> None:
    models = [
        rg.loads(imported(changed(sample(), "20", static_capacity=value), tmp_path).toml)
        for value in (Value("11.4", "kN"), Value("11.4", ""), Value("11400", "N"))
    ]
    assert models[0] == models[1] == models[2]


@pytest.mark.parametrize(("code", "letter"), [("float32", "f"), ("float64", "d")])
def test_coded_arrays_are_those_that_are_written_out(code: str, letter: str, tmp_path: Path) -> None:
    plain = rg.loads(rg.import_rexs(BEARINX).toml)
    coded = base64.b64encode(struct.pack(f"<3{letter}", -25.0, 0.0, -190.0)).decode()
    written = "<array><c>-25</c><c>0</c><c>-190</c></array>"
    text = BEARINX.read_text(encoding="utf-8")
    assert text.count(written) == 1
    xml = tmp_path / "coded.rexs"
    xml.write_text(text.replace(written, f'<array code="{code}">{coded}</array>'), encoding="utf-8")
    assert rg.loads(rg.import_rexs(xml).toml) == plain.model_copy(update={"title": "Gear unit [1] of coded.rexs"})

    path = write_json(bearinx(), tmp_path / "coded.rexsj")
    whole: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    (shaft,) = (item for item in whole["model"]["components"] if item["id"] == 13)
    (entry,) = (item for item in shaft["attributes"] if item["id"] == "support_vector")
    del entry["floating_point_array"]
    entry["floating_point_array_coded"] = {"code": code, "value": coded}
    path.write_text(json.dumps(whole), encoding="utf-8")
    assert rg.loads(rg.import_rexs(path).toml).shafts == plain.shafts


def test_values_in_another_file_are_asked_for_by_its_name(tmp_path: Path) -> None:
    shaft = Component("900", "shaft", "Kept elsewhere", {"data_source": Value("./database_shaft.rexs")})
    with pytest.raises(rg.ModelError, match=r"are in './database_shaft.rexs', which is not read"):
        imported(with_component(bearinx(), shaft), tmp_path)


def test_a_bearing_without_plausible_size_takes_that_of_its_seat(tmp_path: Path) -> None:
    said = imported(changed(bearinx(), "33", catalogue_designation=Value("9999999")), tmp_path)
    other = changed(bearinx(), "33", catalogue_designation=Value("unknown ball"))
    other = replace(other, components={**other.components, "33": replace(other.components["33"], name="no size")})
    assert "from 50 x" in said.toml.partition("id 33)")[2].partition("stiffness =")[0]
    assert "diameter of the shaft" in imported(other, tmp_path).toml.partition("id 33)")[2].partition("stiffness =")[0]


def test_two_components_of_one_id_are_refused_by_their_names(tmp_path: Path) -> None:
    text = SAMPLE.read_text(encoding="utf-8")
    path = tmp_path / "twice.rexs"
    path.write_text(text.replace('<component id="6"', '<component id="23"', 1), encoding="utf-8")
    with pytest.raises(rg.RotorgearError, match="two components have the id 23: cylindrical_"):
        rg.import_rexs(path)


def test_the_files_in_the_tests_are_those_of_their_sources() -> None:
    for path in (SAMPLE, BEARINX):
        assert "Apache" in path.read_text(encoding="utf-8")[:900]
