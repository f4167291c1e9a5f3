"""Bevel stages from REXS: axes that meet in space, gears on their cones, and the forces of their teeth."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.rexs.document import Component, Document, Relation, Value
from rotorgear.rexs.read import read_document
from tests.paths import ROOT
from tests.unit.rexs.documents import changed, with_component, write_json

BEVEL = ROOT / "tests" / "rexs_files" / "bevel_1.4.rexs"
MM = "mm"
PINION, WHEEL, STAGE = "9", "10", "11"
APEX = np.array([310.0, 12.0, -8.0])  # u, v, w in mm


def document() -> Document:
    return read_document(BEVEL)


def imported(document: Document, tmp_path: Path) -> rg.RexsImport:
    return rg.import_rexs(write_json(document, tmp_path / "gearbox.rexsj"))


def model_of(document: Document, tmp_path: Path) -> rg.Model:
    return rg.loads(imported(document, tmp_path).toml)


def of_cone(model: rg.Model) -> list[tuple[float, float]]:
    """Axial force on each gear, away from the apex, and radial force towards its own axis."""
    (mesh,) = model.layout.meshes
    force = rg.static(model).mesh_force_on_gear[0]
    frames = [model.shafts[gear.shaft].frame for gear in mesh.gears]
    apex = 1e-3 * APEX[[1, 2, 0]]
    on_wheel = frames[1].axes @ np.ravel(force)[:3]
    found = []
    for gear, frame, push in zip(mesh.gears, frames, (-on_wheel, on_wheel), strict=True):
        away = frame.at(gear.z) - apex
        away /= np.linalg.norm(away)
        other = next(f for f in frames if f is not frame)
        # The mean point lies on the side of the other shaft's gear.
        out = other.at(mesh.gear.z if frame is frames[0] else mesh.pinion.z) - apex
        out -= (out @ away) * away
        found.append((float(push @ away), -float(push @ out / np.linalg.norm(out))))
    return found


@pytest.mark.parametrize(
    ("sense", "wanted"),
    [
        # The axis leads from the apex to the gear, u of the shaft to the apex.
        (-1.0, [(4084.9729, 711.2614), (711.2614, 4084.9729)]),
        (1.0, [(-2383.1390, 3393.1614), (3393.1614, -2383.1390)]),
    ],
)
def test_the_teeth_of_the_file_push_as_those_of_the_formula(
    sense: float, wanted: list[tuple[float, float]], tmp_path: Path
) -> None:
    """17/41 teeth, 35 deg of spiral, right hand, 5000 N along the pitch circles of 80 mm."""
    base = document()
    base = changed(base, "4", rotational_speed=Value(1500.0 * sense, "1 / min"))
    base = changed(base, "16", torque_around_u_axis=Value(200.0 * sense, "N m"))
    found = of_cone(model_of(base, tmp_path))
    assert np.array(found) == pytest.approx(np.array(wanted), rel=1e-7)


def test_axes_stand_where_the_file_has_them_and_speeds_follow_from_the_teeth(tmp_path: Path) -> None:
    model = model_of(document(), tmp_path)
    wheel = model.shafts["wheel_shaft"].frame
    # u of the wheel's shaft points along -w of the gear unit, which is y of the model.
    assert wheel.axes[:, 2] == pytest.approx((0.0, -1.0, 0.0), abs=1e-12)
    start = wheel.at(model.shafts["wheel_shaft"].start)
    assert 1e3 * start == pytest.approx((12.0, 142.0, 310.0), abs=1e-9)
    # Both u lead to the apex, so that the pair turns as an external one.
    assert model.layout.train.ratio("wheel_shaft") == pytest.approx(-17 / 41, rel=1e-15)
    torques = {row.name: row.torque_n_m for row in rg.check(model).torques}
    assert abs(torques["loads.output"] or 0.0) == pytest.approx(200.0 * 41 / 17)


def test_where_the_gear_unit_itself_stands_changes_nothing(tmp_path: Path) -> None:
    moved = changed(
        document(),
        "1",
        support_vector=Value([130.0, -70.0, 45.0], MM),
        u_axis_vector=Value([0.0, 1.0, 0.0], MM),
        w_axis_vector=Value([1.0, 0.0, 0.0], MM),
    )
    assert model_of(moved, tmp_path) == model_of(document(), tmp_path)


def test_a_shaft_drawn_from_its_other_end_is_the_same_shaft(tmp_path: Path) -> None:
    base = document()
    turned = changed(
        base, "7", support_vector=Value([310.0, 12.0, -178.0], MM), u_axis_vector=Value([0.0, 0.0, 1.0], MM)
    )
    for number, key in (("14", "_inner_side"), ("15", "_inner_side"), ("17", ""), (WHEEL, "")):
        name = f"u_coordinate_on_shaft{key}"
        turned = changed(
            turned, number, **{name: Value(320.0 - float(str(base.components[number].attributes[name].raw)), MM)}
        )
    old = rg.modal(model_of(base, tmp_path), modes=8, elements=1).frequency_hz
    new = rg.modal(model_of(turned, tmp_path), modes=8, elements=1).frequency_hz
    assert new[1:] == pytest.approx(old[1:], rel=1e-7)


@pytest.mark.parametrize("degrees", [62.0, 90.0, 104.0])
def test_a_shaft_angle_is_that_of_the_axes(degrees: float, tmp_path: Path) -> None:
    model = model_of(at_angle(degrees), tmp_path)
    (mesh,) = model.layout.meshes
    assert mesh.bevel is not None
    assert math.degrees(mesh.bevel.shaft_angle) == pytest.approx(degrees, abs=1e-7)
    assert rg.static(model).mesh_force[0] > 0.0


def at_angle(degrees: float) -> Document:
    """The stage with axes at another angle, and the wheel on its cone again."""
    S = math.radians(degrees)
    first = math.atan2(math.sin(S), 41 / 17 + math.cos(S))
    R = 40.0 / math.sin(first)
    # From the apex the pinion's gear lies along -u; the wheel's axis is S away from there.
    axis = np.array([-math.cos(S), 0.0, math.sin(S)])
    across = np.array([math.sin(S), 0.0, math.cos(S)])
    distance = R * math.cos(S - first)
    base = changed(
        document(),
        "7",
        support_vector=Value((APEX + 200.0 * axis).tolist(), MM),
        u_axis_vector=Value((-axis).tolist(), MM),
        w_axis_vector=Value(across.tolist(), MM),
    )
    place = APEX + distance * axis
    base = changed(
        base, WHEEL, support_vector=Value(place.tolist(), MM), u_coordinate_on_shaft=Value(200.0 - distance, MM)
    )
    foot = R * math.cos(first)
    return changed(
        base,
        PINION,
        support_vector=Value((APEX - [foot, 0.0, 0.0]).tolist(), MM),
        u_coordinate_on_shaft=Value(280.0 - foot, MM),
    )


def test_hands_are_those_of_the_words_or_of_the_signs(tmp_path: Path) -> None:
    base = document()
    given = model_of(base, tmp_path)
    signs = base
    for number in (PINION, WHEEL):
        signs = changed(signs, number, spiral_angle_pitch_direction=None)
    assert model_of(signs, tmp_path) == given
    words = changed(base, WHEEL, mean_spiral_angle=Value(35.0, "deg"))
    assert model_of(words, tmp_path) == given
    one = changed(base, WHEEL, spiral_angle_pitch_direction=Value("right"))
    result = imported(one, tmp_path)
    assert rg.loads(result.toml) == given
    assert any(item.address == "gears.wheel.hand" and item.value == "left" for item in result.assumptions)


def test_a_gear_beside_its_cone_is_put_on_it_with_a_warning(tmp_path: Path) -> None:
    base = document()
    off = changed(base, WHEEL, support_vector=Value([310.0, 12.0, 33.0], MM))
    result = imported(off, tmp_path)
    assert rg.loads(result.toml).gears["wheel"].at == pytest.approx(-0.032, abs=1e-12)
    assert any("on its cone it stands at -32 mm" in note for note in result.warnings)


def test_an_outer_module_stands_in_place_of_the_mean_one(tmp_path: Path) -> None:
    base = document()
    mean = float(str(base.components[PINION].attributes["mean_normal_module"].raw)) / math.cos(math.radians(35.0))
    R = 40.0 / math.sin(math.atan(17 / 41))
    outer = Value(mean * (R + 17.0) / R, MM)
    for number in (PINION, WHEEL):
        base = changed(base, number, mean_normal_module=None, outer_transverse_module=outer)
    (mesh,) = model_of(base, tmp_path).layout.meshes
    assert mesh.bevel is not None
    assert 2e3 * mesh.bevel.mean_radii[0] == pytest.approx(80.0, rel=1e-9)


@pytest.mark.parametrize(
    ("number", "attributes", "words"),
    [
        (
            STAGE,
            {"hypoid_offset": Value(25.0, MM)},
            "its axes pass each other at 25 mm, and hypoid pairs are not built",
        ),
        (
            "7",
            {"support_vector": Value([310.0, 15.0, 142.0], MM)},
            "its axes pass each other at 3 mm, and hypoid pairs",
        ),
        (
            "7",
            {"u_axis_vector": Value([1.0, 0.0, 0.0], MM), "w_axis_vector": Value([0.0, 0.0, 1.0], MM)},
            "are parallel",
        ),
        (WHEEL, {"support_vector": Value([310.0, 12.0, 82.0], MM)}, "foot of its mean point on the axis, and is 50 mm"),
        (PINION, {"mean_normal_module": None}, "mean_normal_module or outer_transverse_module is needed, above 0"),
        (WHEEL, {"face_width": Value("wide", MM)}, "bevel_gear 'Wheel' (id 10): face_width"),
    ],
)
def test_what_is_no_bevel_pair_is_told_with_its_address(
    number: str, attributes: dict[str, Value | None], words: str, tmp_path: Path
) -> None:
    with pytest.raises(rg.ModelError) as caught:
        imported(changed(document(), number, **attributes), tmp_path)
    assert words in str(caught.value)


def test_a_force_along_an_inclined_shaft_pushes_it_along_its_axis(tmp_path: Path) -> None:
    force = Component(
        "900",
        "external_load",
        "Thrust",
        {"force_u_direction": Value(700.0, "N"), "u_coordinate_on_shaft": Value(300.0, MM)},
    )
    base = with_component(at_angle(62.0), force)
    base = replace(base, relations=(*base.relations, Relation("assembly", (("assembly", "7"), ("part", "900")))))
    with_, without = (rg.static(model_of(one, tmp_path)) for one in (base, at_angle(62.0)))
    assert with_.bearing_force["wheel_left"][2] - without.bearing_force["wheel_left"][2] == pytest.approx(
        -700.0, rel=1e-9
    )


def test_an_eccentric_mass_of_an_inclined_shaft_has_its_direction_from_the_shafts_own_x(tmp_path: Path) -> None:
    # v of the wheel's shaft is x of it, w is y.
    mass = Component(
        "900",
        "additional_mass",
        "Flywheel",
        {
            "mass_of_component": Value(2.0, "kg"),
            "u_coordinate_on_shaft": Value(300.0, MM),
            "eccentricity_vector": Value([0.0, 0.3, 0.4], MM),
            "reference_component_for_position": Value("7"),
            "support_vector": Value([300.0, 0.0, 0.0], MM),
        },
    )
    base = with_component(at_angle(62.0), mass)
    base = replace(base, relations=(*base.relations, Relation("assembly", (("assembly", "7"), ("part", "900")))))
    (unbalance,) = model_of(base, tmp_path).unbalances.values()
    assert unbalance.magnitude == pytest.approx(1e-3)
    assert unbalance.phase == pytest.approx(math.atan2(0.4, 0.3))
