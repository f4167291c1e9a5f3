"""Statics against closed forms, difference quotients and balances; loops that open, flanks that change, mechanisms."""

from __future__ import annotations

import math
import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.static.forces import imbalance
from rotorgear.analysis.static.static import solved
from rotorgear.elements.shaft_section import cowper
from rotorgear.progress import silent
from rotorgear.results.static import StaticResult
from rotorgear.system.plan import Plan
from tests.paths import ROOT

DOWN = (0.0, -9.81, 0.0)
Data = dict[str, Any]


def data_of(name: str) -> Data:
    return tomllib.loads((ROOT / "models" / f"{name}.toml").read_text(encoding="utf-8"))


def changed(data: Data, address: str, value: Any) -> Data:
    """A copy of the tables of a file with one key set."""
    *path, key = address.split(".")
    copy = {name: dict(part) if isinstance(part, dict) else part for name, part in data.items()}
    here = copy
    for name in path:
        here[name] = dict(here[name])
        here = here[name]
    here[key] = value
    return copy


def beam(**parts: Any) -> rg.Model:
    return rg.Model(
        operation={"input_shaft": "beam", "gravity": DOWN},
        shafts={"beam": {"sections": [{"length": 1.0, "outer_diameter": 0.1}], **parts.pop("shaft", {})}},
        **parts,
    )


def test_a_cantilever_bends_under_its_weight_as_timoshenko_says() -> None:
    model = beam(supports={"wall": {"shaft": "beam", "at": "start", "fixed": ["all"]}})
    steel = model.material_of("beam")
    A = math.pi / 4 * 0.1**2
    inertia = math.pi / 64 * 0.1**4
    load = steel.density * A * 9.81
    kappa = float(cowper(steel.nu, 0.0))
    exact = load / (8.0 * steel.youngs_modulus * inertia) + load / (2.0 * kappa * steel.g * A)
    for elements in (1, 3):  # exact at the nodes for any number
        result = rg.static(model, elements=elements)
        tip = result.nodes.nearest("beam", 1.0)
        assert result.displacement[tip, 1] == pytest.approx(-exact, rel=1e-10)
        assert result.support_force["wall"] == pytest.approx([0, load, 0, -0.5 * load, 0, 0], rel=1e-10, abs=1e-9)


def test_bearings_carry_the_weight_with_the_lever_of_a_simple_beam() -> None:
    stiffness = {"radial": 1e8, "axial": 1e7}
    bearings = {n: {"shaft": "beam", "at": z, "stiffness": stiffness} for n, z in (("a", 0.0), ("b", 0.8))}
    result = rg.static(
        beam(
            bearings=bearings,
            disks={"d": {"shaft": "beam", "at": 0.2, "mass": 50.0, "polar_inertia": 1.0, "diametral_inertia": 0.5}},
        )
    )
    rod = 7850.0 * math.pi / 4 * 0.1**2 * 9.81
    b = (rod * 0.5 + 50.0 * 9.81 * 0.2) / 0.8
    assert result.bearing_force["b"][1] == pytest.approx(b, rel=1e-10)
    assert result.bearing_force["a"][1] == pytest.approx(rod + 50.0 * 9.81 - b, rel=1e-10)
    assert result.bearing_force["a"][2] == pytest.approx(0.0, abs=1e-9)


def test_a_shaft_with_cross_coupled_bearings_moves_sideways_under_its_weight() -> None:
    stiffness = {"radial": 1e8, "xy": 4e7, "yx": -4e7, "axial": 1e7}
    bearings = {n: {"shaft": "beam", "at": n, "stiffness": stiffness} for n in ("start", "end")}
    result = rg.static(beam(bearings=bearings))
    weight = 7850.0 * math.pi / 4 * 0.1**2 * 9.81
    x, y = np.linalg.solve([[1e8, 4e7], [-4e7, 1e8]], [0.0, -0.5 * weight])
    assert result.displacement[0, :2] == pytest.approx([x, y], rel=1e-9)


def test_the_forces_of_a_helical_pair_are_those_of_the_text_book() -> None:
    result = rg.static(rg.load(ROOT / "models" / "helical_pair.toml"))
    torque = 60e3 / (2970 * math.pi / 30)
    (contact,) = result.model.layout.mesh("stage").contacts
    tangential = torque / (contact.pinion_base_radius / math.cos(contact.pressure_angle))
    radial = tangential * math.tan(contact.pressure_angle)
    axial = torque / contact.pinion_base_radius * math.tan(contact.base_helix_angle)
    normal = torque / contact.pinion_base_radius / math.cos(contact.base_helix_angle)
    assert result.mesh_force == pytest.approx([normal], rel=1e-9)
    # The wheel stands along +x and the pinion drives counter-clockwise: it is pushed away, up, and towards -z.
    assert result.mesh_force_on_gear[0] == pytest.approx([radial, tangential, -axial], rel=1e-9)
    assert result.mesh_deflection == pytest.approx([normal / 9.4e8], rel=1e-9)


def test_the_axial_force_of_a_helical_mesh_is_right_where_ross_has_36_percent_of_it() -> None:
    """ROSS 2.3 couples with sin(alpha) sin(beta) in place of cos(alpha) sin(beta) in the plane of action."""
    result = rg.static(rg.load(ROOT / "models" / "helical_pair.toml"))
    torque = 60e3 / (2970 * math.pi / 30)
    # By hand, at the working circle: F_a = F_t tan(beta_w), tan(beta_w) = tan(beta) r_w / r.
    (contact,) = result.model.layout.mesh("stage").contacts
    r = 0.5 * 23 * 3e-3 / math.cos(math.radians(20))
    r_w = contact.pinion_base_radius / math.cos(contact.pressure_angle)
    by_hand = torque / r_w * math.tan(math.radians(20)) * r_w / r
    thrust = result.bearing_force["input_left"][2]
    assert -thrust == pytest.approx(
        by_hand, rel=1e-9
    )  # the right-hand driver is pushed to +z: its bearing holds it back
    assert result.bearing_force["output_left"][2] == pytest.approx(by_hand, rel=1e-9)


@pytest.mark.parametrize("name", ["helical_pair", "split_torque"])
def test_every_shaft_and_the_whole_are_in_equilibrium(name: str) -> None:
    data = changed(data_of(name), "operation.gravity", list(DOWN))
    result = rg.static(rg.Model(**data))
    assert result.imbalance < 1e-11
    assert result.error_estimate < 1e-9
    weight = 9.81 * rg.check(result.model).total_mass_kg
    total = sum(value[:3] for value in result.bearing_force.values())
    assert total == pytest.approx([0.0, weight, 0.0], abs=1e-7 * max(weight, 1e5))


def test_the_forces_of_a_split_torque_box_carry_the_torque_of_every_shaft() -> None:
    result = rg.static(rg.load(ROOT / "models" / "split_torque.toml"))
    torque = 2.5e6 / (16350 * math.pi / 30)
    lines = [c for mesh in result.model.layout.meshes for c in mesh.contacts]
    pull = result.mesh_force * np.array([math.cos(c.base_helix_angle) for c in lines])
    mesh = np.array(result.contact_mesh)
    input_torque = sum(
        pull[k] * lines[k].pinion_base_radius for k in np.flatnonzero(np.char.startswith(mesh, "stage_1"))
    )
    assert input_torque == pytest.approx(torque, rel=1e-10)
    for branch in "ab":
        first = mesh == f"stage_1{branch}"
        second = mesh == f"stage_2{branch}"
        wheel = pull[first].sum() * lines[int(np.flatnonzero(first)[0])].gear_base_radius
        assert wheel == pytest.approx(pull[second].sum() * lines[int(np.flatnonzero(second)[0])].pinion_base_radius)
    assert sum(row.share for row in result.shares if row.gear == "bull") == pytest.approx(1.0)
    assert {row.decided_by for row in result.shares} == {"stiffness"}
    assert result.sharing_factor == pytest.approx(2.0 * max(row.share for row in result.shares))


def test_turning_a_mirror_symmetric_gearbox_the_other_way_exchanges_its_branches() -> None:
    data = data_of("split_torque")
    forwards = rg.static(rg.Model(**data))
    for gear in data["gears"].values():  # a mirror exchanges hands as well
        gear["hand"] = {"left": "right", "right": "left"}[gear["hand"]]
    backwards = rg.static(rg.Model(**data), speed="-16350 rpm")

    def share(result: StaticResult, mesh: str) -> float:
        return next(row.share for row in result.shares if row.mesh == mesh)

    assert share(forwards, "stage_1a") == pytest.approx(share(backwards, "stage_1b"), rel=1e-9)
    assert abs(share(forwards, "stage_1a") - 0.5) > 0.01


def test_where_the_loads_alone_decide_a_share_the_table_says_so() -> None:
    """One pinion drives two wheels with a machine each: the torques of the machines decide."""
    gear = {"at": "start", "kind": "spur", "base_radius": 0.1, "mass": 1, "polar_inertia": 1, "diametral_inertia": 1}
    mesh = {"pinion": "p", "stiffness": 1e8, "centre_line_angle": 0.0, "pressure_angle": 0.4}
    loads = {
        "in": {"shaft": "0", "kind": "input", "torque": 100},
        "one": {"shaft": "1", "kind": "output", "torque": 70},
        "two": {"shaft": "2", "kind": "output"},
    }
    model = rg.Model(
        motions=["torsion"],
        shafts={"0": {}, "1": {}, "2": {}},
        loads=loads,
        gears={"p": {**gear, "shaft": "0"}, "a": {**gear, "shaft": "1"}, "b": {**gear, "shaft": "2"}},
        meshes={"ma": {**mesh, "gear": "a"}, "mb": {**mesh, "gear": "b"}},
    )
    result = rg.static(model)
    assert [row.share for row in result.shares] == pytest.approx([0.7, 0.3])
    assert {row.decided_by for row in result.shares} == {"loads"}
    assert result.mesh_force == pytest.approx([700.0, 300.0])


# --- sensitivities ------------------------------------------------------------------------------------------------


def difference(data: Data, address: str, centre: float, step: float) -> np.ndarray:
    """Central difference quotient of all contact forces."""
    up, down = (rg.static(rg.Model(**changed(data, address, centre + d))).mesh_force for d in (step, -step))
    return np.asarray((up - down) / (2.0 * step))


@pytest.mark.parametrize(
    ("parameter", "address", "centre", "step", "factor"),
    [
        ("meshes.stage_2a.index_error", "meshes.stage_2a.index_error", 0.0, 1e-6, 1.0),
        ("meshes.stage_1b.helix_index_error", "meshes.stage_1b.helix_index_error", 0.0, 1e-6, 1.0),
        ("meshes.stage_1a.stiffness", "meshes.stage_1a.stiffness", 5.63e8, 5.63e4, 5.63e8),
        ("bearings.output_right.stiffness", "bearings.output_right.stiffness", 2.87e8, 2.87e4, 2.87e8),
    ],
)
def test_a_sensitivity_is_the_difference_quotient(
    parameter: str, address: str, centre: float, step: float, factor: float
) -> None:
    data = data_of("split_torque")
    result = rg.static(rg.Model(**data))
    k = result.parameter.index(parameter)
    if parameter.startswith("bearings"):
        address += ".radial"
    quotient = difference(data, address, centre, step) * factor
    assert result.force_derivative[k] == pytest.approx(quotient, rel=1e-5, abs=1e-6 * np.abs(quotient).max())


def test_the_sensitivity_to_a_shafts_stiffness_is_that_to_its_modulus() -> None:
    data = data_of("split_torque")
    k = rg.static(rg.Model(**data)).parameter.index("shafts.branch_a.stiffness")
    derivative = rg.static(rg.Model(**data)).force_derivative[k]

    def forces(scale: float) -> np.ndarray:
        material = {"youngs_modulus": 206e9 * scale, "poisson_ratio": 0.3, "density": 7850.0}
        own = changed(changed(data, "materials.own", material), "shafts.branch_a.material", "own")
        return rg.static(rg.Model(**own)).mesh_force

    quotient = (forces(1.0 + 1e-4) - forces(1.0 - 1e-4)) / 2e-4
    assert derivative == pytest.approx(quotient, rel=1e-5, abs=1e-6 * np.abs(quotient).max())


def test_the_sensitivity_to_a_centre_line_is_that_of_a_model_given_by_angles() -> None:
    data = data_of("split_torque")
    # The same box without positions: each mesh says its own angle.
    for shaft in data["shafts"].values():
        del shaft["position"]
    angles = {"stage_1a": 60.0, "stage_1b": -60.0, "stage_2a": -31.8, "stage_2b": 31.8}
    for mesh, angle in angles.items():
        data["meshes"][mesh]["centre_line_angle"] = math.radians(angle)
    result = rg.static(rg.Model(**data))
    k = result.parameter.index("meshes.stage_2a.centre_line_angle")
    quotient = difference(data, "meshes.stage_2a.centre_line_angle", math.radians(-31.8), 1e-4)
    assert result.force_derivative[k] == pytest.approx(quotient, rel=1e-5, abs=1e-6 * np.abs(quotient).max())


# --- flanks, gaps, mechanisms -------------------------------------------------------------------------------------


def test_a_branch_whose_index_error_is_too_large_carries_nothing_and_the_other_all() -> None:
    # It opens at some 430 um; where its flanks stand farther apart than both backlashes of the branch, it jams on the other side.
    data = changed(data_of("split_torque"), "meshes.stage_2a.index_error", "600 um")
    result = rg.static(rg.Model(**data))
    share = {row.mesh: row.share for row in result.shares}
    force = {mesh: result.mesh_force[result.contacts_of(mesh)].sum() for mesh in result.model.meshes}
    assert force["stage_2a"] == 0.0
    assert force["stage_1a"] == pytest.approx(0.0, abs=1e-6 * force["stage_1b"])
    assert share.get("stage_1b", 1.0) == pytest.approx(1.0, abs=1e-6)
    assert any("stage_2a" in text and "stand apart" in text for text in result.warnings)
    before = rg.static(rg.Model(**data_of("split_torque")))
    assert force["stage_2b"] == pytest.approx(before.mesh_force[4:].sum(), rel=1e-9)


def test_a_model_that_is_a_mechanism_gets_one_clear_sentence() -> None:
    data = data_of("helical_pair")
    for name in ("input_left", "output_left"):
        data["bearings"][name]["stiffness"] = {"radial": "2e8 N/m"}
    with pytest.raises(rg.AnalysisError) as caught:
        rg.static(rg.Model(**data))
    text = str(caught.value)
    assert "mechanism" in text
    assert " in z" in text
    assert "\n" not in text


def test_a_model_without_loads_is_refused_in_a_sentence() -> None:
    with pytest.raises(rg.AnalysisError, match="nothing loads the model"):
        rg.static(rg.load(ROOT / "models" / "jeffcott.toml"))


def test_springs_that_hold_turning_shafts_in_torsion_carry_no_torque_and_are_named() -> None:
    result = rg.static(rg.load(ROOT / "models" / "split_torque.toml"))
    assert not result.support_force["drive"].any()
    assert any("supports.drive" in text for text in result.left_out)


# --- phases and assembly ------------------------------------------------------------------------------------------


def test_two_wheels_around_a_pinion_run_with_the_phase_of_its_teeth_between_them() -> None:
    result = rg.static(rg.load(ROOT / "models" / "split_torque.toml"))
    between = 29 * 120.0 / 360.0  # pitches of the pinion between two centre lines 120 deg apart
    difference = result.mesh_phase["stage_1b"] - result.mesh_phase["stage_1a"]
    assert (difference - between) % 1.0 == pytest.approx(0.0, abs=1e-6) or (difference - between) % 1.0 > 1.0 - 1e-6


def test_the_gear_that_closes_a_loop_does_close_it() -> None:
    data = data_of("split_torque")
    (loop,) = rg.static(rg.Model(**data)).assembly
    assert (loop.mesh, loop.gear) == ("stage_2b", "pinion_2b")
    for gear in ("wheel_a", "wheel_b", "pinion_2a"):
        data = changed(data, f"gears.{gear}.clocking", 0.0)
    given = changed(data, "gears.pinion_2b.clocking", math.radians(loop.clocking_deg))
    given = changed(given, "gears.bull.clocking", 0.0)
    (closed,) = rg.static(rg.Model(**given)).assembly
    assert (closed.gear, closed.rest_pitches) == ("", pytest.approx(0.0, abs=1e-6))
    wrong = changed(given, "gears.pinion_2b.clocking", 0.0)
    result = rg.static(rg.Model(**wrong))
    assert result.assembly[0].rest_pitches == pytest.approx(loop.rest_pitches, abs=1e-9)
    assert any("can't be put together" in text for text in result.warnings)


def test_a_result_comes_back_from_its_file(tmp_path: Path) -> None:
    result = rg.static(rg.load(ROOT / "models" / "split_torque.toml"))
    back = rg.read(rg.save(result, tmp_path / "static.h5"))
    assert back.to_dict() == result.to_dict()
    assert np.array_equal(back.displacement, result.displacement)


def test_a_moment_that_is_missing_is_not_hidden_by_large_forces() -> None:
    # A moment is judged beside the largest moment, or the largest force at the size of the model: 5 kN at .3 m.
    model = rg.loads(
        "operation = { input_shaft = 's' }\n"
        "shafts.s = { sections = [{ length = '300 mm', outer_diameter = '40 mm' }] }\n"
        "bearings.a = { shaft = 's', at = 'start', stiffness = { radial = 1e8, axial = 1e8, torsion = 1e4 } }\n"
        "bearings.b = { shaft = 's', at = 'end', stiffness = { radial = 1e8 } }\n"
        "loads.w = { shaft = 's', at = '150 mm', force = [0.0, -5000.0, 0.0], moment = [20.0, 0.0, 0.0] }\n"
    )
    found = solved(model, Plan(2), None, silent)
    assert imbalance(found) < 1e-10
    missing = np.zeros_like(found.loads)
    missing[3] = 1e-3
    by_moment = imbalance(replace(found, loads=found.loads + missing))
    assert by_moment == pytest.approx(1e-3 / (5000.0 * 0.3), rel=0.01)
    missing[3] = 0.0
    missing[0] = 1e-3
    assert imbalance(replace(found, loads=found.loads + missing)) == pytest.approx(1e-3 / 5000.0, rel=0.01)


def test_reactions_of_fixed_ends_carry_the_weight_of_a_shaft_with_internal_damping_at_speed() -> None:
    model = rg.loads(
        "operation = { input_shaft = 's', speed = '6000 rpm', gravity = [0.0, -9.81, 0.0] }\n"
        "shafts.s = { internal_damping = 2e-4, sections = [{ length = '600 mm', outer_diameter = '30 mm' }] }\n"
        "disks.d = { shaft = 's', at = '350 mm', mass = 20.0, polar_inertia = 0.2, diametral_inertia = 0.1 }\n"
        "supports.a = { shaft = 's', at = 'start', fixed = ['x', 'y', 'z', 'torsion'] }\n"
        "supports.b = { shaft = 's', at = 'end', fixed = ['x', 'y'] }\n"
    )
    result = rg.static(model)
    disk = 20.0 * 9.81
    shaft = 7850.0 * np.pi * 0.015**2 * 0.6 * 9.81
    # The shaft's rotation turns its deflection sideways, and no force: reactions are those of a beam on two ends.
    assert abs(result.displacement[:, 0]).max() > 1e-2 * abs(result.displacement[:, 1]).max()
    assert result.support_force["a"][:2] == pytest.approx([0.0, disk * 250.0 / 600.0 + shaft / 2.0], rel=1e-6, abs=1e-6)
    assert result.support_force["b"][:2] == pytest.approx([0.0, disk * 350.0 / 600.0 + shaft / 2.0], rel=1e-6, abs=1e-6)
    assert result.imbalance < 1e-10
