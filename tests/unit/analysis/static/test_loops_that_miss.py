"""Loops of gears whose clockings or index errors miss: forces against the least potential energy of springs with backlash."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

import rotorgear as rg
from rotorgear.analysis.common.request import direction_of
from rotorgear.analysis.static.mean_state import mean_state
from rotorgear.note import as_notes
from rotorgear.system.system import flow_system
from tests.paths import ROOT

# Two branches of unlike numbers of teeth from a pinion to a bull gear: 60/20 90/18 = 50/20 90/15.
GEARS = {
    "pinion": ("input", 20, 20.0),
    "wheel_a": ("branch_a", 60, 60.0),
    "wheel_b": ("branch_b", 50, 50.0),
    "second_a": ("branch_a", 18, 36.0),
    "second_b": ("branch_b", 15, 30.0),
    "bull": ("output", 90, 180.0),
}
MESHES = {
    "first_a": ("pinion", "wheel_a", 4e8, 0.4),
    "first_b": ("pinion", "wheel_b", 3e8, -0.9),
    "last_a": ("second_a", "bull", 6e8, 0.2),
    "last_b": ("second_b", "bull", 5e8, 0.7),
}
J = 100e-6
TORQUE = 400.0


def split(speed: float = 100.0, **errors: float) -> rg.Model:
    """The gearbox in torsion, with all clockings 0 and index errors of meshes."""
    text: dict[str, Any] = {
        "schema_version": 1,
        "motions": ["torsion"],
        "operation": {"input_shaft": "input", "output_shaft": "output", "speed": speed, "power": TORQUE * abs(speed)},
        "shafts": {shaft: {} for shaft in ("input", "branch_a", "branch_b", "output")},
        "gears": {
            name: {
                "shaft": shaft,
                "at": "start",
                "kind": "spur",
                "teeth": teeth,
                "base_radius": 1e-3 * radius,
                "mass": 1.0,
                "polar_inertia": 1e-6 * radius**2,
                "diametral_inertia": 1e-6 * radius**2,
                "clocking": 0.0,  # all gears are at their shafts' marks
            }
            for name, (shaft, teeth, radius) in GEARS.items()
        },
        "meshes": {
            name: {
                "pinion": pinion,
                "gear": gear,
                "stiffness": k,
                "centre_line_angle": angle,
                "pressure_angle": 0.349,
                "backlash": J,
                "damping_ratio": 0.1,
                "index_error": errors.get(name, 0.0),
                "phase": 0.0,
            }
            for name, (pinion, gear, k, angle) in MESHES.items()
        },
    }
    return rg.Model(**text)


def closed(speed: float = 100.0, off: float = 0.0) -> tuple[rg.Model, str, str]:
    """The gearbox with a clocking that closes the loop, and `off` (rad) more; the mesh that closes it, and the gear."""
    given = split(speed)
    (loop,) = rg.static(given).assembly
    pinion = MESHES[loop.mesh][0]
    # Each pitch that is missing turns the pinion on.
    there = 2.0 * math.pi / GEARS[pinion][1] * loop.rest_pitches
    return given.with_(f"gears.{pinion}.clocking", there + off), loop.mesh, pinion


def least_energy(errors: dict[str, float]) -> dict[str, float]:
    """Force of each mesh in N, negative on the back flank, where the complementary energy of springs with backlash is least.

    Balanced forces F have one number free, the one that goes round the loop. The approach of a mesh is F / k + e on its working
    flank and F / k + e - j on the other.
    """
    whole = TORQUE / (1e-3 * GEARS["pinion"][2])
    onward = {side: GEARS[f"wheel_{side}"][2] / GEARS[f"second_{side}"][2] for side in "ab"}
    k = np.array([mesh[2] for mesh in MESHES.values()])
    e = np.array([errors.get(name, 0.0) for name in MESHES])

    def balanced(b: float) -> np.ndarray:
        a = whole - b
        return np.array([a, b, onward["a"] * a, onward["b"] * b])

    def energy(b: float) -> float:
        force = balanced(b)
        return float(np.sum(force**2 / (2.0 * k) + np.where(force > 0.0, e, e - J) * force))

    found = minimize_scalar(energy, (0.0, whole), method="golden", tol=1e-12)
    return dict(zip(MESHES, balanced(float(found.x)).tolist(), strict=True))


def forces(result: rg.StaticResult) -> dict[str, float]:
    """Force of each mesh, negative where the gear drives."""
    drivers = dict(zip(result.contact_mesh, result.driver, strict=True))
    return {
        name: float(force) * (1.0 if drivers[name] == MESHES[name][0] else -1.0)
        for name, force in zip(result.contact_mesh, result.mesh_force, strict=True)
    }


@pytest.mark.parametrize("mesh", ["last_b", "first_a"])
@pytest.mark.parametrize("error", [-1000e-6, -400e-6, -150e-6, -50e-6, 0.0, 150e-6, 250e-6, 500e-6, 2000e-6])
def test_a_loop_crosses_its_backlash_where_an_index_error_is_large(mesh: str, error: float) -> None:
    result = rg.static(closed()[0].with_(f"meshes.{mesh}.index_error", error))
    wanted = least_energy({mesh: error})
    size = max(map(abs, wanted.values()))
    assert forces(result) == pytest.approx(wanted, abs=1e-6 * size)
    # The backlash of meshes that carry behind is used, that of meshes that carry before is not; where open ones hang, either.
    told = {fact.part for fact in as_notes(result.left_out) if fact.part.endswith(".backlash")}
    for name, force in wanted.items():
        if abs(force) > 1e-6 * size:
            assert (f"meshes.{name}.backlash" in told) == (force > 0.0)
    carrying = dict(zip(result.contact_mesh, result.carries.tolist(), strict=True))
    assert carrying == {name: abs(force) > 1e-6 * size for name, force in wanted.items()}


@pytest.mark.parametrize("speed", [100.0, -100.0])
@pytest.mark.parametrize("off", [1e-3, -1e-3])
def test_a_clocking_that_misses_a_loop_is_the_index_error_of_its_turn(speed: float, off: float) -> None:
    model, mesh, pinion = closed(speed, off)
    # A tooth that stands ahead in the sense of the torque on the pinion closes its gap earlier.
    sense = np.sign(speed) * (1.0 if mesh.startswith("first") else -1.0)
    error = -sense * 1e-3 * GEARS[pinion][2] * off
    result = rg.static(model)
    assert result.assembly[0].gap_m == pytest.approx(error, rel=1e-9)
    assert forces(result) == pytest.approx(least_energy({mesh: error}), rel=1e-6)
    assert not result.warnings
    known = closed(speed)[0].with_(f"meshes.{mesh}.index_error", error)
    assert forces(result) == pytest.approx(forces(rg.static(known)), rel=1e-9)


@pytest.mark.parametrize("speed", [100.0, -100.0])
@pytest.mark.parametrize("error", [60e-6, -70e-6])
def test_a_gearbox_that_runs_backwards_has_its_errors_on_the_other_side_of_the_teeth(
    speed: float, error: float
) -> None:
    """One gearbox, told by an index error and told by a clocking, forwards and backwards: late there is early here."""
    fitting, mesh, pinion = closed(speed)
    sense = np.sign(speed) * (1.0 if mesh.startswith("first") else -1.0)
    off = -sense * error / (1e-3 * GEARS[pinion][2])
    by_index = fitting.with_(f"meshes.{mesh}.index_error", error)
    by_clocking = closed(speed, off)[0]
    for one in (by_index, by_clocking):
        for turns, there in ((speed, error), (-speed, -error)):
            wanted = least_energy({mesh: there})
            size = max(wanted.values())
            assert forces(rg.static(one, speed=turns)) == pytest.approx(wanted, abs=1e-6 * size)
    back = rg.static(by_index, speed=-speed)
    row = back.parameter.index(f"meshes.{mesh}.index_error")
    h = 1e-7
    there, here = (
        rg.static(fitting.with_(f"meshes.{mesh}.index_error", error + step), speed=-speed) for step in (h, -h)
    )
    assert back.force_derivative[row] == pytest.approx((there.mesh_force - here.mesh_force) / (2.0 * h), rel=1e-6)


@pytest.mark.parametrize("off", [1e-3, -1e-3])
@pytest.mark.parametrize("speed", ["16350 rpm", "-16350 rpm"])
def test_both_helices_of_a_herringbone_feel_the_clocking(off: float, speed: str) -> None:
    model = rg.load(ROOT / "models" / "split_torque.toml").with_("operation.speed", speed)
    (loop,) = rg.static(model).assembly
    names = ("pinion_1", "wheel_a", "wheel_b", "pinion_2a", "bull")
    clocked = {f"gears.{name}.clocking": 0.0 for name in names}
    clocked[f"gears.{loop.gear}.clocking"] = math.radians(loop.clocking_deg) + off
    missed = rg.static(model.with_(clocked))
    pinion = model.layout.gear(loop.gear)
    error = -off * pinion.base_radius * math.cos(pinion.base_helix_angle)
    # The second pinions turn the other way than the input, and are pushed that way.
    error *= -math.copysign(1.0, model.operating_speed or 0.0)
    given = rg.static(model.with_(f"meshes.{loop.mesh}.index_error", error))
    assert missed.mesh_force == pytest.approx(given.mesh_force, rel=1e-9)
    assert np.abs(missed.mesh_force / rg.static(model).mesh_force - 1.0).min() > 0.02


def test_motions_in_time_settle_where_statics_is() -> None:
    model, mesh, _ = closed(off=1e-3)
    for one in (model, closed()[0].with_(f"meshes.{mesh}.index_error", 250e-6)):
        still = rg.static(one)
        moved = rg.transient(one, time="0.02 s", discard="0.1 s", steps=40)
        mean = dict(zip(moved.contact, moved.force_mean.tolist(), strict=True))
        assert mean == pytest.approx(forces(still), rel=1e-3)


def test_a_linear_response_is_about_the_loop_that_misses() -> None:
    model, mesh, _ = closed(off=1e-3)
    error = rg.static(model).assembly[0].gap_m
    known = closed()[0].with_(f"meshes.{mesh}.index_error", error)

    def means(one: rg.Model) -> np.ndarray:
        speed = one.operating_speed
        assert speed is not None
        return mean_state(flow_system(one, direction=direction_of(speed), kind="static"), speed).mean_force

    assert means(model) == pytest.approx(means(known), rel=1e-9)


def test_a_loop_that_misses_by_a_good_part_of_a_pitch_is_not_put_together() -> None:
    model, _, _ = closed(off=0.4 * 2.0 * math.pi / GEARS["second_b"][1])
    result = rg.static(model)
    assert any("can't be put together" in text for text in result.warnings)
    assert result.assembly[0].gap_m == 0.0
    assert forces(result) == pytest.approx(least_energy({}), rel=1e-6)
