"""Forced response against closed forms: unbalance, transmission error, phases of meshes, reciprocity, both solvers, refusals."""

from __future__ import annotations

import math
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

import rotorgear as rg
from rotorgear.analysis.response import run_up
from rotorgear.cli.main import app
from rotorgear.results.response import ResponseResult
from tests.overhung import overhung_disk
from tests.paths import MODELS, ROOT

Data = dict[str, Any]


def split_torque(**changes: Any) -> rg.Model:
    data = tomllib.loads((ROOT / "models" / "split_torque.toml").read_text(encoding="utf-8"))
    return rg.Model(**{**data, **changes})


def jeffcott(**parts: Any) -> rg.Model:
    data = tomllib.loads((ROOT / "validation" / "cases" / "jeffcott_rotor" / "model.toml").read_text(encoding="utf-8"))
    return rg.Model(**{**data, "unbalances": {"u": {"shaft": "rotor", "at": "0.5 m", "magnitude": 1e-4}}, **parts})


@pytest.mark.parametrize("q", [0.5, 1.0, 2.0, 1.0 / math.sqrt(1.0 - 2.0 * 0.02**2)])
def test_a_jeffcott_rotor_whirls_as_the_closed_form_says(q: float) -> None:
    wn = 88.976477
    zeta = 0.02
    e = 1e-5
    result = rg.response(jeffcott(), speeds=[q * wn], elements=1)
    got = result.displacement[0, 0, result.places.index("disks.disk")]
    size = e * q**2 / math.hypot(1.0 - q**2, 2.0 * zeta * q)
    lag = math.atan2(2.0 * zeta * q, 1.0 - q**2)
    assert got[0] == pytest.approx(size * np.exp(-1j * lag), rel=1e-6)
    assert got[1] == pytest.approx(-1j * got[0], rel=1e-9)  # a forward circle: y follows x
    assert result.warnings == ()


# --- lumped trains: every shaft is one point, so that all is known by hand ----------------------------------------------

BASE = 0.06
RADIUS = 0.15
J1 = 0.02
J2 = 0.5
K = 4e8


def gear(shaft: str, radius: float, inertia: float, teeth: int | None = None, **more: Any) -> Data:
    found = {
        "shaft": shaft,
        "at": "start",
        "kind": "spur",
        "base_radius": radius,
        "mass": 8.0,
        "polar_inertia": inertia,
        "diametral_inertia": 0.6 * inertia,
    }
    return {**found, **({"teeth": teeth} if teeth else {}), **more}


def torsional_pair(**mesh: Any) -> rg.Model:
    return rg.Model(
        motions=["torsion"],
        operation={"input_shaft": "1", "output_shaft": "2", "speed": 100.0, "torque": 1000.0},
        shafts={"1": {}, "2": {}},
        gears={"p": gear("1", BASE, J1, 24), "g": gear("2", RADIUS, J2, 60)},
        meshes={
            "m": {"pinion": "p", "gear": "g", "stiffness": K, "centre_line_angle": 0.0, "pressure_angle": 0.4, **mesh}
        },
    )


M_E = J1 * J2 / (J1 * RADIUS**2 + J2 * BASE**2)
W_N = math.sqrt(K / M_E)


@pytest.mark.parametrize("q", [0.1, 0.7, 1.0, 1.8])
def test_a_transmission_error_shakes_a_pair_as_one_mass_on_one_spring(q: float) -> None:
    error = {"harmonic": 2, "amplitude": 3e-6, "phase": 0.0}
    model = torsional_pair(transmission_error=[error], damping=2000.0)
    w = q * W_N
    result = rg.response(model, speeds=[w / 48.0])
    assert result.ratio == pytest.approx([48.0])
    k = K + 1j * w * 2000.0
    x = k * 3e-6 / (k - M_E * w**2)
    got = result.transmission_error[0, 0, 0]
    assert abs(got) == pytest.approx(abs(x), rel=1e-9)
    # The rotations approach as the error opens the gap: the teeth carry the inertia alone.
    assert result.mesh_force[0, 0, 0] == pytest.approx(M_E * w**2 * got, rel=1e-9)


def test_a_stiffness_variation_acts_through_the_mean_force() -> None:
    model = torsional_pair(stiffness_variation=[{"harmonic": 1, "amplitude": 0.1}], damping=2000.0)
    w = 0.6 * W_N
    result = rg.response(model, speeds=[w / 24.0])
    mean = 1000.0 / BASE
    assert result.mean_force == pytest.approx([mean])
    k = K + 1j * w * 2000.0
    x = -0.1 * mean / (k - M_E * w**2)
    assert abs(result.transmission_error[0, 0, 0]) == pytest.approx(abs(x), rel=1e-9)
    assert abs(result.mesh_force[0, 0, 0]) == pytest.approx(abs(k * x + 0.1 * mean), rel=1e-9)


def test_the_peak_of_a_mode_with_a_damping_ratio_is_the_closed_form() -> None:
    model = torsional_pair(transmission_error=[{"harmonic": 1, "amplitude": 1e-6}])
    zeta = 0.03
    result = rg.response(model, speeds=[W_N / 24.0], modal_damping=zeta)
    # M_E (x'' + 2 zeta W_N x' + W_N^2 x) = K e
    assert abs(result.transmission_error[0, 0, 0]) == pytest.approx(1e-6 / (2.0 * zeta), rel=1e-9)


@pytest.mark.parametrize("q", [0.1, 0.3, 0.8])
def test_a_damping_ratio_of_all_modes_acts_far_below_them_too(q: float) -> None:
    model = torsional_pair(transmission_error=[{"harmonic": 2, "amplitude": 3e-6}], damping=2000.0)
    model = model.with_("damping.modal_ratio", 0.1)
    w = q * W_N
    result = rg.response(model, speeds=[w / 48.0])
    k = K + 1j * w * 2000.0
    x = k * 3e-6 / (k - M_E * w**2 + 1j * w * 0.2 * W_N * M_E)
    assert abs(result.mesh_force[0, 0, 0]) == pytest.approx(abs(k * (x - 3e-6)), rel=1e-9)
    at = {"frequencies": [q * W_N / (2.0 * math.pi)], "inputs": ["gears.p:torsion"], "outputs": ["gears.p:torsion"]}
    alone, among = (
        rg.frf(model, **{**at, "frequencies": [*at["frequencies"], *more]}).receptance[0] for more in ([], [1e6])
    )
    assert among == pytest.approx(alone, rel=1e-9)


def test_larger_models_say_which_modes_a_damping_ratio_does_not_reach() -> None:
    model = rg.load(MODELS / "flexible_pair.toml").with_("damping.modal_ratio", 0.01)
    slow = rg.response(model, speeds=[10.0], elements=4)
    assert any("the damping ratio of modes above" in text for text in slow.left_out)


def test_the_unbalance_of_a_driven_shaft_acts_at_its_own_speed_where_ross_takes_that_of_the_driving_one() -> None:
    """ROSS 2.3 solves a geared train at the frequency of the driving shaft for the unbalances of all of its shafts."""
    size = 2e-4
    k = 3e7
    c = 500.0
    m = 8.0
    speed = 900.0
    bearing = {"at": "start", "stiffness": {"radial": k}, "damping": {"radial": c}}
    model = rg.Model(
        motions=["bending", "torsion"],
        operation={"input_shaft": "1"},
        shafts={"1": {}, "2": {}},
        gears={"p": gear("1", BASE, J1, 24), "g": gear("2", RADIUS, J2, 60)},
        meshes={"m": {"pinion": "p", "gear": "g", "stiffness": 1e-3, "centre_line_angle": 0.3, "pressure_angle": 0.4}},
        bearings={"a": {"shaft": "1", **bearing}, "b": {"shaft": "2", **bearing}},
        supports={s: {"shaft": s, "at": "start", "stiffness": {"tilt": 1e6}} for s in "12"},
        unbalances={"u": {"shaft": "2", "at": "start", "magnitude": size, "phase": 0.4}},
    )  # the mesh is so soft that the driven shaft is an oscillator by itself
    result = rg.response(model, speeds=[speed])
    w = speed * 24.0 / 60.0
    x = size * w**2 / (k - m * w**2 + 1j * w * c)
    there = result.displacement[0, 0, result.places.index("gears.g")]
    assert result.ratio == pytest.approx([0.4])
    assert result.frequency_hz[0, 0] == pytest.approx(w / (2.0 * math.pi))
    assert abs(there[0]) == pytest.approx(abs(x), rel=1e-8)
    assert there[1] == pytest.approx(1j * there[0], rel=1e-8)  # it turns the other way, and so does its unbalance
    force = result.bearing_force[0, 0, result.bearings.index("b")]
    assert force[:2] == pytest.approx(-(k + 1j * w * c) * there[:2], rel=1e-8)


def two_wheels(teeth: int, harmonic: int) -> ResponseResult:
    """A pinion that floats between two wheels, at 0 and 180 degrees."""
    mesh = {
        "pinion": "p",
        "stiffness": K,
        "pressure_angle": 0.4,
        "transmission_error": [{"harmonic": harmonic, "amplitude": 1e-6}],
    }
    shafts = ("0", "a", "b")
    model = rg.Model(
        motions=["bending", "torsion"],
        loads={
            "in": {"shaft": "0", "kind": "input", "torque": 100},
            "one": {"shaft": "a", "kind": "output", "torque": 100 * 60 / teeth / 2},
            "two": {"shaft": "b", "kind": "output"},
        },
        operation={"input_shaft": "0"},
        shafts={name: {} for name in shafts},
        gears={
            "p": gear("0", BASE, J1, teeth),
            "a": gear("a", BASE * 60 / teeth, J2, 60),
            "b": gear("b", BASE * 60 / teeth, J2, 60),
        },
        meshes={
            "ma": {"gear": "a", "centre_line_angle": 0.0, **mesh},
            "mb": {"gear": "b", "centre_line_angle": math.pi, **mesh},
        },
        bearings={name: {"shaft": name, "at": "start", "stiffness": {"radial": 1e8, "tilt": 1e6}} for name in shafts},
    )
    return rg.response(model, speeds=[300.0], modal_damping=0.01)


@pytest.mark.parametrize(("teeth", "harmonic", "in_phase"), [(24, 1, True), (25, 1, False), (25, 2, True)])
def test_teeth_between_two_wheels_decide_whether_a_pinion_shakes_or_turns(
    teeth: int, harmonic: int, in_phase: bool
) -> None:
    result = two_wheels(teeth, harmonic)
    pinion = np.abs(result.displacement[0, 0, result.places.index("gears.p")])
    moves = np.hypot(pinion[0], pinion[1])
    turns = pinion[5] * BASE
    assert (moves < 1e-9 * turns) if in_phase else (turns < 1e-9 * moves)


@pytest.mark.parametrize("stagger", [0.0, 0.5])
def test_a_staggered_herringbone_shakes_along_its_axis_and_one_in_phase_turns(stagger: float) -> None:
    data = tomllib.loads((ROOT / "models" / "split_torque.toml").read_text(encoding="utf-8"))
    for name, mesh in data["meshes"].items():
        own = ({"harmonic": 1, "amplitude": 1e-6},) if name == "stage_1a" else ()
        mesh.update(stagger=stagger, transmission_error=own)
    data["unbalances"] = {}
    result = rg.response(rg.Model(**data), speeds=[0.5], modal_damping=0.05, elements=1)
    left, right = result.mesh_force[0, 0, result.contacts_of("stage_1a")]
    turns = np.angle(right / left)
    assert abs(turns) < 0.3 if stagger == 0.0 else abs(abs(turns) - math.pi) < 0.3


# --- both solvers, tables, error statements ------------------------------------------------------------------------------


def test_the_modal_solution_is_the_direct_one_within_its_own_error_statement() -> None:
    model = split_torque(damping={"modal_ratio": 0.02})
    speeds = list(1712.0 * np.linspace(0.2, 1.2, 12))
    direct, modal = (rg.response(model, speeds=speeds, fmax=5000.0, method=m) for m in ("direct", "modal"))
    assert direct.solver_error < 1e-12
    assert modal.solver_error < 1e-6
    for name in ("mesh_force", "bearing_force"):
        exact = getattr(direct, name)
        apart = np.abs(getattr(modal, name) - exact).max(axis=(1, 2) if name == "mesh_force" else (1, 2, 3))
        assert np.all(apart <= 1e-4 * np.abs(exact).reshape(len(exact), -1).max(axis=1))
    assert 0.0 < modal.error_estimate < 0.02  # frequencies within 1e-3, half-power widths of 4e-2


def test_orders_in_a_basis_and_direct_ones_stand_in_their_places(monkeypatch: pytest.MonkeyPatch) -> None:
    # Every second order is solved directly.
    unbalances = {
        name: {"shaft": name, "at": at, "magnitude": 1e-4}
        for name, at in {"input": "0.05 m", "output": "0.2 m"}.items()
    }
    model = split_torque(unbalances=unbalances)
    wish: Data = {"speeds": [500.0, 900.0, 1600.0], "fmax": 5000.0, "elements": 1}
    plain = rg.response(model, **wish, method="direct")
    turns = iter([True, False] * len(plain.orders))
    monkeypatch.setattr(run_up, "_DIRECT_UP_TO", 0)
    monkeypatch.setattr(run_up, "_FEW_SPEEDS", 0)
    monkeypatch.setattr(run_up, "basis_pays", lambda *_: next(turns))
    mixed = rg.response(model, **wish)
    assert f"; {len(plain.orders) // 2} orders by direct" in mixed.method
    for one, other in zip(plain.mesh_force, mixed.mesh_force, strict=True):
        assert np.abs(one - other).max() <= 1e-5 * np.abs(one).max()


def test_the_error_estimate_is_of_the_size_of_the_error() -> None:
    model = split_torque(damping={"modal_ratio": 0.02})
    speeds = [1000.0, 1712.0]
    coarse, exact = (
        rg.response(model, speeds=speeds, fmax=5000.0, **how) for how in ({"elements": 1}, {"accuracy": 1e-7})
    )
    found = np.abs(coarse.mesh_force - exact.mesh_force).max() / np.abs(exact.mesh_force).max()
    assert found < 3.0 * coarse.error_estimate
    assert coarse.error_estimate < 30.0 * found


def test_all_forces_of_an_order_hold_the_inertia() -> None:
    """Bearing forces and unbalance together accelerate the masses: sums over all nodes, by M."""
    model = split_torque()
    result = rg.response(model, speeds=[300.0], elements=2, method="direct", shape_speed=300.0)
    system = rg.System(model, elements=2)
    moved = np.zeros((system.dofs.transform.shape[0], 2))
    for axis in range(2):
        moved[axis : 6 * len(system.nodes) : 6, axis] = 1.0
    whole = system.dofs.transform.T @ moved
    order = result.orders.index("shaft input 1x")
    q = system.dofs.transform.T @ result.shapes[: len(system.nodes), :, order].reshape(-1)
    accelerated = -(300.0**2) * (whole.T @ (system.mass @ q))
    push = 30e-6 * 300.0**2 * np.array([1.0, -1.0j])
    assert result.bearing_force[order, 0, :, :2].sum(axis=0) + push == pytest.approx(
        accelerated, rel=1e-6, abs=1e-6 * abs(push[0])
    )


def test_a_bearing_with_a_table_acts_with_its_value_at_the_speed() -> None:
    rows = [
        {"speed": s, "stiffness": {"radial": k, "axial": 1e7}, "damping": {"radial": 300.0}}
        for s, k in ((50, 1e6), (250, 9e6))
    ]
    shared: Data = {
        "operation": {"input_shaft": "r"},
        "shafts": {"r": {"sections": [{"length": 0.8, "outer_diameter": 0.03}]}},
        "disks": {"d": {"shaft": "r", "at": 0.3, "mass": 12.0, "polar_inertia": 0.1, "diametral_inertia": 0.06}},
        "unbalances": {"u": {"shaft": "r", "at": 0.3, "magnitude": 1e-4}},
    }

    def solved(bearing: Data) -> np.ndarray:
        bearings = {n: {"shaft": "r", "at": n, **bearing} for n in ("start", "end")}
        return rg.response(rg.Model(**shared, bearings=bearings), speeds=[150.0], elements=3).bearing_force

    constant = {"stiffness": {"radial": 5e6, "axial": 1e7}, "damping": {"radial": 300.0}}
    assert solved({"table": rows}) == pytest.approx(solved(constant), rel=1e-9)


def test_a_damping_ratio_needs_no_symmetric_bearings() -> None:
    """With k_xy = -k_yx the modes are real still, and an isotropic rotor whirls as k - m w^2 + i (c w +- k_xy) says."""
    k = 1e6
    cross = 2e4
    m = 10.0
    w = 300.0
    model = rg.Model(
        motions=["bending"],
        operation={"input_shaft": "r"},
        shafts={"r": {}},
        disks={"d": {"shaft": "r", "at": "start", "mass": m, "polar_inertia": 0.0, "diametral_inertia": 0.01}},
        bearings={
            "b": {"shaft": "r", "at": "start", "stiffness": {"radial": k, "xy": cross, "yx": -cross, "tilt": 1e5}}
        },
        unbalances={"u": {"shaft": "r", "at": "start", "magnitude": 1e-4}},
    )
    result = rg.response(model, speeds=[w], modal_damping=0.05)
    c = 2.0 * 0.05 * math.sqrt(k * m)
    x = 1e-4 * w**2 / (k - m * w**2 + 1j * (c * w - cross))
    assert result.displacement[0, 0, 0, 0] == pytest.approx(x, rel=1e-9)


def test_a_bearing_of_huge_stiffness_is_a_pin() -> None:
    data = tomllib.loads((ROOT / "validation" / "cases" / "jeffcott_rotor" / "model.toml").read_text(encoding="utf-8"))
    bearings = {n: {"shaft": "rotor", "at": n, "stiffness": {"radial": 1e15}} for n in ("start", "end")}
    supports = {"dashpot": data["supports"]["dashpot"]}
    stiff = rg.response(jeffcott(bearings=bearings, supports=supports), speeds=[60.0], elements=1)
    pinned = rg.response(jeffcott(), speeds=[60.0], elements=1)
    place = pinned.places.index("disks.disk")
    at = stiff.displacement[0, 0, stiff.places.index("disks.disk")]
    assert at[:2] == pytest.approx(pinned.displacement[0, 0, place, :2], rel=1e-7)


# --- frequency responses -------------------------------------------------------------------------------------------------


def test_receptances_of_a_gearbox_at_standstill_are_reciprocal() -> None:
    places = ["gears.bull:y", "bearings.input_left:x", "gears.wheel_a:torsion", "gears.pinion_2b:z"]
    result = rg.frf(
        split_torque(), [40.0, 333.0, 1500.0], inputs=places, outputs=places, modal_damping=0.01, elements=1
    )
    H = result.receptance
    assert pytest.approx(H.transpose(0, 2, 1), rel=1e-8, abs=1e-10 * np.abs(H).max()) == H
    drive = H[:, range(4), range(4)]
    assert np.all(drive.imag < 0.0)  # a force at its own place puts power in
    assert result.residual < 1e-12


def test_a_turning_rotor_is_reciprocal_with_one_that_turns_the_other_way() -> None:
    model = rg.load(ROOT / "models" / "jeffcott.toml")
    places = ["disks.disk:x", "bearings.left:y"]
    one, other = (
        rg.frf(model, [15.0, 30.0, 90.0], inputs=places, outputs=places, speed=s, elements=2)
        for s in ("6000 rpm", "-6000 rpm")
    )
    assert one.receptance == pytest.approx(other.receptance.transpose(0, 2, 1), rel=1e-8, abs=1e-18)


def test_a_receptance_is_that_of_mass_spring_and_dashpot_and_meets_statics() -> None:
    result = rg.frf(jeffcott(), [0.01, 5.0, 14.161], inputs=["disks.disk:x"], outputs=["disks.disk:x"], elements=1)
    w = 2.0 * math.pi * result.frequency_hz
    exact = 1.0 / (79168.13487 - 10.0 * w**2 + 1j * w * 35.59059)
    assert result.receptance[:, 0, 0] == pytest.approx(exact, rel=1e-6)
    assert result.of("accelerance")[:, 0, 0] == pytest.approx(-(w**2) * exact, rel=1e-6, abs=0)


# --- refusals, files ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("wish", "words"),
    [
        ({"speeds": [0.0, 10.0]}, "none of them 0"),
        ({"speeds": [-10.0, 10.0]}, "one sense"),
        ({"speeds": []}, "at least one"),
        ({"speeds": ["10 mm"]}, "speed"),
        ({"fmax": 1e-3}, "no order is as low"),
        ({"method": "magic"}, "modal"),
        ({"modal_damping": 1.5}, "damping ratio"),
        ({"shape_speed": -10.0}, "sense"),
        ({"elements": 0}, "at least 1"),
    ],
)
def test_a_wish_that_makes_no_sense_is_refused_in_a_sentence(wish: Data, words: str) -> None:
    with pytest.raises(rg.AnalysisError, match=words) as caught:
        rg.response(jeffcott(), **{"speeds": [10.0], **wish})
    assert "\n" not in str(caught.value)


def test_a_model_that_nothing_excites_is_refused() -> None:
    with pytest.raises(rg.AnalysisError, match="nothing excites"):
        rg.response(jeffcott(unbalances={}), speeds=[10.0])


def test_a_contact_that_is_open_in_the_mean_state_is_refused() -> None:
    data = tomllib.loads((ROOT / "models" / "split_torque.toml").read_text(encoding="utf-8"))
    data["meshes"]["stage_2a"]["index_error"] = "900 um"
    with pytest.raises(rg.AnalysisError, match=r"stage_[12]a carries nothing"):
        rg.response(rg.Model(**data), speeds=[1000.0])


def test_an_unknown_place_is_refused_with_those_that_are_there() -> None:
    with pytest.raises(rg.AnalysisError, match="output_bearing_y"):
        rg.frf(split_torque(), [10.0], inputs=["nowhere"], outputs=["output_bearing_y"])
    with pytest.raises(rg.AnalysisError, match="can't move"):
        rg.frf(jeffcott(), [10.0], inputs=["disks.disk:z"], outputs=["disks.disk:x"])


def test_an_undamped_run_up_says_that_its_peaks_are_accidents() -> None:
    pins = {n: {"shaft": "rotor", "at": n, "fixed": ["x", "y"]} for n in ("start", "end")}
    result = rg.response(jeffcott(supports=pins), speeds=[60.0, 120.0])
    assert any("nothing damps" in text for text in result.warnings)
    # Each of the remedies that the sentence names is one.
    assert any("damping, or modal_ratio under [damping], or --modal-damping" in text for text in result.warnings)
    soft = {"shaft": "rotor", "at": "0.5 m", "stiffness": {"radial": 1e5}, "damping": {"radial": 9.0}}
    remedies: tuple[tuple[dict[str, Any], dict[str, Any]], ...] = (
        ({"bearings.soft": soft}, {}),
        ({"damping.modal_ratio": 0.01}, {}),
        ({}, {"modal_damping": 0.01}),
    )
    for changes, options in remedies:
        damped = rg.response(jeffcott(supports=pins).with_(changes), speeds=[60.0, 120.0], **options)
        assert not any("nothing damps the model" in text for text in damped.warnings)


def test_teeth_that_would_part_are_warned_about() -> None:
    error = [{"harmonic": 1, "amplitude": 1e-5}]
    strong = rg.response(torsional_pair(transmission_error=error, damping=2000.0), speeds=[0.95 * W_N / 24, W_N / 24])
    assert np.abs(strong.mesh_force).max() > strong.mean_force[0]
    assert any("teeth part" in text and "2 of 2 speeds" in text for text in strong.warnings)
    weak = rg.response(torsional_pair(transmission_error=error, damping=2000.0), speeds=[0.1 * W_N / 24])
    assert not any("teeth part" in text for text in weak.warnings)


def test_speeds_that_step_over_a_resonance_are_warned_about() -> None:
    result = rg.response(jeffcott(), speeds=[60.0, 120.0])
    assert any("half power" in text for text in result.warnings)


def test_results_come_back_from_their_files(tmp_path: Path) -> None:
    run = rg.response(jeffcott(), speeds=[60.0, 61.0])
    frf = rg.frf(jeffcott(), [5.0, 6.0], inputs=["disks.disk:x"], outputs=["disks.disk:y"])
    for result in (run, frf):
        back = rg.read(rg.save(result, tmp_path / "result.h5"))
        assert back.to_dict() == result.to_dict()
    assert np.array_equal(rg.read(rg.save(run, tmp_path / "run.h5")).shapes, run.shapes)


def test_speeds_on_the_command_line_have_units() -> None:
    model = str(ROOT / "models" / "split_torque.toml")
    said = CliRunner(env={"COLUMNS": "80"}).invoke(app, ["response", model, "--speeds", "9000 rpm,1000 rad/s"])
    assert said.exit_code == 0, said.output
    assert "9000 to 9549.3 rpm" in " ".join(said.output.split())


def test_damping_of_modes_is_that_of_the_same_modes_on_a_finer_mesh() -> None:
    # A mesh of 52 degrees of freedom, and one of 70: damping by modes must not change with their number.
    peaks = [
        rg.response(overhung_disk(), points=31, modal_damping=0.01, accuracy=accuracy, method="direct")
        for accuracy in (1e-6, 1e-8)
    ]
    assert peaks[0].dofs < 60 < peaks[1].dofs
    coarse, fine = (np.abs(found.bearing_force) for found in peaks)
    assert np.abs(coarse - fine).max() < 1.2 * peaks[0].error_estimate * fine.max()
