"""Gearboxes read from REXS: the public sample, and its variants over versions, formats and gaps."""

from __future__ import annotations

import math
import zipfile
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.forces.rolling import contact_ellipses, point_contact
from rotorgear.rexs.document import Component, Document, Relation, Value
from tests.unit.rexs.documents import SAMPLE, bearinx, changed, sample, with_component, without, write_json

MM = "mm"


def imported(document: Document, tmp_path: Path) -> rg.RexsImport:
    return rg.import_rexs(write_json(document, tmp_path / "gearbox.rexsj"))


def model_of(document: Document, tmp_path: Path) -> rg.Model:
    return rg.loads(imported(document, tmp_path).toml)


def test_the_public_sample_has_its_axes_its_ratio_and_its_torques() -> None:
    result = rg.import_rexs(SAMPLE)
    model = rg.loads(result.toml)
    said = rg.check(model)
    assert [1e3 * (row.centre_distance_m or 0.0) for row in said.meshes] == pytest.approx([53.0, 57.0, 77.0], abs=1e-9)
    ratio = (67 / 23) * (76 / 13) * (87 / 14)
    assert 1.0 / abs(said.shafts[-1].speed_ratio) == pytest.approx(ratio, rel=1e-12)
    assert f"{ratio:.2f}" == "105.83"
    assert [f"{row.torque_n_m:.4f}" for row in said.torques] == ["4.7246", "500.0000"]
    assert (result.shafts, result.gears, result.meshes, result.bearings) == (4, 6, 3, 9)
    assert rg.modal(model, modes=3, elements=1).frequency_hz[2] > 100.0


def stiffnesses(model: rg.Model) -> list[float]:
    parts = [*model.bearings.values(), *model.couplings.values()]
    return [abs(entry) for part in parts for row in part.stiffness.as_rows() for entry in row]


@pytest.mark.parametrize("placeholder", ["0.0", "9.999999999999999E22", "1e20", "-1", "1e-3"])
def test_placeholders_for_rigid_and_free_never_reach_a_matrix(placeholder: str, tmp_path: Path) -> None:
    document = sample()
    for bearing in document.of_type("rolling_bearing_with_catalog_geometry"):
        value = Value(placeholder, "N / m")
        tilt = Value("1e+15", "N mm / rad")
        document = changed(document, bearing.id, radial_stiffness=value, axial_stiffness=value, bending_stiffness=tilt)
    found = stiffnesses(model_of(document, tmp_path))
    assert all(entry == 0.0 or 1e6 < entry < 1e10 for entry in found)
    assert found == stiffnesses(model_of(sample(), tmp_path))


def test_a_stiffness_that_a_bearing_can_have_is_taken_in_any_unit(tmp_path: Path) -> None:
    given = changed(
        sample(), "20", radial_stiffness=Value("250", "N / mum"), bending_stiffness=Value("2e6", "N mm / rad")
    )
    stiffness = next(iter(model_of(given, tmp_path).bearings.values())).stiffness
    assert stiffness.as_rows()[0][0] == pytest.approx(2.5e8)
    assert stiffness.as_rows()[3][3] == pytest.approx(2e3)


def test_json_and_an_archive_give_the_model_of_the_xml(tmp_path: Path) -> None:
    whole = rg.import_rexs(SAMPLE)
    with zipfile.ZipFile(tmp_path / "gearbox.rexsz", "w") as archive:
        archive.write(SAMPLE, "inner/gearbox.rexs")
    for other in (imported(sample(), tmp_path), rg.import_rexs(tmp_path / "gearbox.rexsz")):
        assert other.toml.splitlines()[5:] == whole.toml.splitlines()[5:]
        assert other.assumptions == whole.assumptions


def as_later_version(document: Document) -> Document:
    """The sample as 1.4 has it: units by new texts, flanks of another type, gears at their middle, and no support vectors."""
    parts = {}
    for number, part in document.components.items():
        attributes = {
            key: replace(value, unit={"°": "deg", "none": ""}.get(value.unit, value.unit))
            for key, value in part.attributes.items()
            if part.type != "cylindrical_gear" or key not in ("support_vector", "u_axis_vector", "w_axis_vector")
        }
        if part.type == "cylindrical_gear":
            u = float(str(attributes["u_coordinate_on_shaft"].raw)) + 0.5 * float(str(attributes["face_width"].raw))
            attributes["u_coordinate_on_shaft"] = Value(u, MM)
        kind = "cylindrical_gear_flank" if part.type == "flank_geometry" else part.type
        parts[number] = replace(part, type=kind, attributes=attributes)
    return replace(document, version="1.4", components=parts)


def test_a_later_version_with_other_units_and_places_gives_the_same_model(tmp_path: Path) -> None:
    old = model_of(sample(), tmp_path)
    new = model_of(as_later_version(sample()), tmp_path)
    assert [gear.at for gear in new.gears.values()] == pytest.approx([gear.at for gear in old.gears.values()])
    assert new.model_copy(update={"gears": old.gears}) == old


def test_shafts_without_a_place_stand_where_their_stages_put_them(tmp_path: Path) -> None:
    document = sample()
    for number in ("5", "36", "54"):
        document = changed(document, number, support_vector=None)
    old = [shaft.position for shaft in model_of(sample(), tmp_path).shafts.values()]
    new = [
        shaft.position
        for shaft in model_of(without(document, "cylindrical_gear", "support_vector"), tmp_path).shafts.values()
    ]
    assert np.array(new) == pytest.approx(np.array(old), abs=1e-12)


def test_a_shaft_drawn_from_its_other_end_is_the_same_shaft(tmp_path: Path) -> None:
    # u' = L - u with the axes u and v turned about: sections, places and the torque change their signs, the gearbox does not.
    document = sample()
    length = 220.0
    frame = {
        "u_axis_vector": Value([-1.0, 0.0, 0.0], MM),
        "support_vector": Value([182.7 + length, -19.008575782311063, -1.026431327759056], MM),
    }
    document = changed(document, "54", **frame)
    for number in [str(k) for k in range(407, 415)]:
        part = document.components[number].attributes
        u = length - float(str(part["u_coordinate_on_shaft"].raw)) - float(str(part["length"].raw))
        document = changed(document, number, u_coordinate_on_shaft=Value(u, MM))
    for number, key in (
        ("66", "u_coordinate_on_shaft_inner_side"),
        ("67", "u_coordinate_on_shaft_inner_side"),
        ("68", "u_coordinate_on_shaft"),
    ):
        document = changed(
            document, number, **{key: Value(length - float(str(document.components[number].attributes[key].raw)), MM)}
        )
    old = rg.modal(model_of(sample(), tmp_path), modes=6, elements=1)
    new = rg.modal(model_of(document, tmp_path), modes=6, elements=1)
    assert new.frequency_hz == pytest.approx(old.frequency_hz, rel=1e-6, abs=1e-3)


def test_missing_profile_shifts_are_those_that_the_axes_need(tmp_path: Path) -> None:
    given = model_of(sample(), tmp_path)
    document = sample()
    for flank in document.of_type("flank_geometry")[2:4]:  # both flanks of the second gear
        document = changed(document, flank.id, addendum_modification_coefficient=None)
    result = imported(document, tmp_path)
    found = list(rg.loads(result.toml).gears.values())[1].profile_shift
    assert found == pytest.approx(list(given.gears.values())[1].profile_shift, abs=2e-4)
    assert any(item.address.endswith("profile_shift") for item in result.assumptions)


def test_all_missing_values_come_in_one_report(tmp_path: Path) -> None:
    document = changed(sample(), "23", number_of_teeth=None, normal_module=Value("x", MM))
    document = changed(document, "34", face_width=Value("11.0", "furlong"))
    document = changed(document, "382", length=None)
    with pytest.raises(rg.ModelError) as caught:
        imported(document, tmp_path)
    said = str(caught.value)
    for words in ("number_of_teeth", "'x'", "'furlong'", "shaft_section 'section [382]'"):
        assert words in said


@pytest.mark.parametrize(
    ("kind", "words"),
    [
        ("worm_stage", "a worm stage"),
        ("hypoid_stage", "a hypoid stage"),
        ("general_gear", "a gear of no stated kind"),
        ("face_gear", "a face gear"),
    ],
)
def test_other_gearing_is_refused_by_its_name(kind: str, words: str, tmp_path: Path) -> None:
    document = with_component(sample(), Component("900", kind, "Stufe 9"))
    with pytest.raises(rg.AnalysisError, match=f"has {words}, {kind} 'Stufe 9'"):
        imported(document, tmp_path)


# Components of a public file of FVA Workbench in their order: a worm stage (version 1.4).
WORM = "worm_stage_gear_data material worm_wheel_hob_tool worm_grinding_disc_tool shaft worm_gear worm_wheel worm_stage"


def test_a_worm_file_is_refused_by_its_stage(tmp_path: Path) -> None:
    parts = "".join(f'<component id="{i}" name="Teil [{i}]" type="{kind}"/>' for i, kind in enumerate(WORM.split()))
    text = f'<?xml version="1.0"?><model version="1.4"><relations/><components>{parts}</components></model>'
    (tmp_path / "file.rexs").write_text(text, encoding="utf-8")
    with pytest.raises(rg.AnalysisError, match="the file has a worm stage, "):
        rg.import_rexs(tmp_path / "file.rexs")


def test_a_document_type_is_refused_before_any_entity_expands(tmp_path: Path) -> None:
    bomb = '<?xml version="1.0"?><!DOCTYPE m [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;">]><model version="1.0">&b;</model>'
    (tmp_path / "bomb.rexs").write_text(bomb, encoding="utf-8")
    with pytest.raises(rg.AnalysisError, match="DOCTYPE"):
        rg.import_rexs(tmp_path / "bomb.rexs")


@pytest.mark.parametrize(
    "content", [b"", b"[]", b"{}", b"<a/>", b"<model", b'{"model": [1]}', b"PK\x03\x04rest", b"\x00\x01"]
)
def test_what_is_no_rexs_is_refused_in_a_sentence(content: bytes, tmp_path: Path) -> None:
    (tmp_path / "file.rexs").write_bytes(content)
    with pytest.raises(rg.RotorgearError):
        rg.import_rexs(tmp_path / "file.rexs")


def test_a_bearing_between_two_shafts_couples_them_without_torsion(tmp_path: Path) -> None:
    document = sample()
    shaft = document.components["4"]
    inner = replace(
        shaft, id="901", name="Inner", attributes={**shaft.attributes, "rotational_speed": Value("0", "1 / min")}
    )
    section = Component("902", "shaft_section", "", {"length": Value(30, MM), "outer_diameter_begin": Value(10, MM)})
    bearing = Component(
        "903",
        "concept_bearing",
        "Pilot",
        {"u_coordinate_on_shaft_inner_side": Value(15, MM), "u_coordinate_on_shaft_outer_side": Value(15, MM)},
    )
    for part in (inner, section, bearing):
        document = with_component(document, part)
    sides = (("assembly", "903"), ("inner_part", "901"), ("outer_part", "4"))
    more = (Relation("assembly", (("assembly", "901"), ("part", "902"))), Relation("side", sides))
    result = imported(replace(document, relations=(*document.relations, *more)), tmp_path)
    assert "[couplings.pilot]" in result.toml
    assert "torsion" not in result.toml


def test_a_load_case_takes_the_place_of_the_values_of_its_components(tmp_path: Path) -> None:
    cases = (
        (
            "1",
            {
                "4": {"rotational_speed": Value(2800.0, "1 / min")},
                "22": {"torque_around_u_axis": Value(2000.0, "N mm")},
            },
        ),
        ("7", {"22": {"torque_around_u_axis": Value(-1.0, "N m")}}),
    )
    path = write_json(replace(sample(), load_cases=cases), tmp_path / "cases.rexsj")
    first = rg.check(rg.loads(rg.import_rexs(path).toml))
    assert first.shafts[0].speed_rpm == pytest.approx(2800.0)
    assert first.torques[0].torque_n_m == pytest.approx(2.0)
    braked = rg.check(rg.loads(rg.import_rexs(path, load_case=7).toml))
    # A torque against the speed takes power, so that the other end drives.
    assert [row.shaft for row in braked.torques if (row.power_w or 0.0) < 0.0] == ["anw_4"]
    with pytest.raises(rg.AnalysisError, match="no load case '3'; it has: 1, 7"):
        rg.import_rexs(path, load_case=3)


@pytest.mark.parametrize(
    ("designation", "bore", "outer"),
    [("6305-2Z", 25, 62), ("NUP204-E-XL-TVP2", 20, 47), ("33014", 70, 110), ("6202", 15, 35), ("K 50x58x25", 50, 58)],
)
def test_a_designation_says_bore_and_outer_diameter(designation: str, bore: float, outer: float) -> None:
    from rotorgear.rexs.bearings import size_of_designation

    size = size_of_designation(designation)
    assert size is not None
    assert 1e3 * size[0] == pytest.approx(bore)
    assert 1e3 * size[1] == pytest.approx(outer)


def bearing_33(tmp_path: Path, **attributes: Value) -> tuple[rg.RexsImport, rg.Model]:
    """The bearing of the shaft of 50 mm of the second sample, with other attributes."""
    result = imported(changed(bearinx(), "33", **attributes), tmp_path)
    return result, rg.loads(result.toml)


def of_33(found: tuple[rg.RexsImport, rg.Model]) -> tuple[float, float, str]:
    """Its radial and axial stiffness, and its comment."""
    result, model = found
    text = result.toml.partition("id 33)")[2].partition("stiffness =")
    name = result.toml.partition("id 33)")[2].partition("[bearings.")[2].partition("]")[0]
    matrix = model.bearings[name].stiffness
    return matrix.radial or 0.0, matrix.axial or 0.0, text[0]


@pytest.mark.parametrize(
    ("designation", "kind", "degrees", "reason"),
    [
        ("33010", "radial_tapered_roller_bearing", 12.0, "series 330"),
        ("7210 CD", "radial_angular_contact_ball_bearing", 15.0, "letter C"),
        ("7210 BEP", "radial_angular_contact_ball_bearing", 40.0, "letter B"),
        ("QJ 210", "radial_four_point_contact_ball_bearing", 35.0, "series QJ2"),
        ("22210 E", "radial_spherical_roller_bearing", 9.5, "series 222"),
        ("without a number", "radial_tapered_roller_bearing", 14.0, "usual of a tapered bearing"),
    ],
)
def test_an_imported_bearing_has_the_angle_of_its_type_and_says_why(
    designation: str, kind: str, degrees: float, reason: str, tmp_path: Path
) -> None:
    given = {"catalogue_designation": Value(designation), "bearing_type": Value(kind)}
    radial, axial, said = of_33(bearing_33(tmp_path, **given))
    assert axial / radial == pytest.approx(2.0 * math.tan(math.radians(degrees)) ** 2, rel=0.01)
    assert f"alpha = {degrees:g} deg ({reason})" in said


def test_an_angle_of_the_file_counts_up_to_a_thrust_bearing(tmp_path: Path) -> None:
    angle = Value("60", "deg")
    radial, axial, said = of_33(bearing_33(tmp_path, contact_angle=angle, static_capacity=Value("80", "kN")))
    assert axial / radial == pytest.approx(6.0, rel=0.01)
    assert "alpha = 60 deg (of the file)" in said
    assert "a thrust of 8e+03 N" in said


@pytest.mark.parametrize("name", ["axial_static_load_rating", "static_capacity"])
def test_a_thrust_bearing_is_as_stiff_along_as_balls_that_share_its_load(name: str, tmp_path: Path) -> None:
    given = {"catalogue_designation": Value("51210"), "bearing_type": Value("axial_grooved_ball_bearing")}
    radial, axial, said = of_33(bearing_33(tmp_path, **given, **{name: Value("134", "kN")}))
    assert radial == 0.0
    assert "from 50 x 78 mm" in said
    # Hertz contacts of the same balls in grooves of .52 D, equally loaded along the shaft.
    count, ball, pitch = 17, 11.2e-3, 64e-3
    steel = 210e9 / (1.0 - 0.3**2)
    c = point_contact(contact_ellipses(ball, pitch, 0.52 * ball, 0.52 * ball, 0.5 * math.pi), steel)
    load = 13.4e3
    hertz = 1.5 * load / (load / count / c) ** (2.0 / 3.0)
    assert f"{count} of {1e3 * ball:.2g} mm" in said
    assert axial == pytest.approx(hertz, rel=0.1)


def test_the_axial_static_rating_of_a_radial_bearing_is_used(tmp_path: Path) -> None:
    given = {"catalogue_designation": Value("7210 B")}
    plain = of_33(bearing_33(tmp_path, **given))
    one = of_33(bearing_33(tmp_path, **given, axial_static_load_rating=Value("60", "kN")))
    two = of_33(bearing_33(tmp_path, **given, axial_static_load_rating=Value("120", "kN")))
    assert one[0] == plain[0]
    assert two[1] / one[1] == pytest.approx(2.0 ** (1.0 / 3.0), rel=0.01)
    assert "axial static rating of the file" in one[2]


def test_a_written_model_file_loads_and_is_not_overwritten_unasked(tmp_path: Path) -> None:
    from typer.testing import CliRunner

    from rotorgear.cli.main import app

    out = tmp_path / "gearbox.toml"
    first = CliRunner().invoke(app, ["import", str(SAMPLE), "-o", str(out)])
    assert first.exit_code == 0
    assert "34 assumptions" in first.output
    assert rg.check(rg.load(out)).shafts
    again = CliRunner().invoke(app, ["import", str(SAMPLE), "-o", str(out)])
    assert isinstance(again.exception, rg.AnalysisError)
