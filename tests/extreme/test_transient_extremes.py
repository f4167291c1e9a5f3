"""Extreme transients: right, or a clear error or warning; never silently wrong."""

from __future__ import annotations

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.transient.transient import transient
from rotorgear.errors import ModelError
from tests.models import spur_pair

SHORT = {"time": 0.05, "discard": 0.1, "steps": 400, "error_estimate": False}


def test_zero_backlash_holds_the_teeth_between_both_flanks() -> None:
    result = transient(spur_pair(meshes__pair__backlash="0 mm", operation__torque="3 N m"), **SHORT)
    assert result.status == "success"
    assert result.contact_time[0, 1] == pytest.approx(0.0, abs=1e-3)  # never apart: one flank hands over to the other
    linear = transient(spur_pair(meshes__pair__contact_damping="adhesive", operation__torque="3 N m"), **SHORT)
    closed = transient(
        spur_pair(meshes__pair__backlash="0 mm", meshes__pair__contact_damping="adhesive", operation__torque="3 N m"),
        **SHORT,
    )
    assert closed.mesh_force.std() == pytest.approx(linear.mesh_force.std(), rel=2e-2)


def test_a_millimetre_of_backlash_under_load_is_one_sided() -> None:
    result = transient(spur_pair(meshes__pair__backlash="1 mm", operation__torque="3 N m"), **SHORT)
    assert result.status == "success"
    assert result.contact_losses[0] > 0
    assert result.contact_time[0, 2] == 0.0


def test_zero_load_rattles_in_the_gap_and_the_mean_force_vanishes() -> None:
    model = spur_pair(meshes__pair__backlash="4 um", operation__torque="0 N m")
    result = transient(model, time=0.2, discard=0.3, steps=400, error_estimate=False)
    assert result.status == "success"
    assert np.all(result.contact_time[0] > 0.01)
    own = result.mesh_force[result.counted]
    assert abs(own.mean()) < 0.05 * own.std() + 1.0
    assert result.dynamic_factor[0] != result.dynamic_factor[0]  # no load, no factor


@pytest.mark.parametrize("flank", ["line", "own normals"])
def test_a_load_that_reverses_moves_contact_to_the_back_flank(flank: str) -> None:
    # The pinion drives at first; then its torque falls and the wheel's inertia and torque push it from behind.
    model = spur_pair(
        operation__torque=None,
        operation__output_shaft=None,
        meshes__pair__backlash="50 um",
        meshes__pair__coast_flank=flank,
        meshes__pair__transmission_error=[],
        loads={
            "drive": {"shaft": "one", "kind": "input", "torque": "100 N m"},
            "take": {"shaft": "two", "kind": "output"},
            "brake": {"shaft": "one", "kind": "output", "torque": "40 N m"},
        },
    )
    stepped = {**model.loads, "drive": model.loads["drive"].model_copy(update={"step_to": 0.0, "step_at": 0.01})}
    model = model.model_copy(update={"loads": stepped})
    result = transient(model, time=0.02, steps=400)
    force = result.mesh_force if flank == "line" else result.mesh_force[:, :1] - result.mesh_force[:, 1:]
    assert force[: len(force) // 3].min() > 0.0
    assert force[-len(force) // 4 :].min() < 0.0


@pytest.mark.long  # steps that resolve such teeth
def test_a_mesh_of_1e12_newton_a_metre_carries_the_static_force_exactly_and_the_dynamic_one_with_an_estimate() -> None:
    still = transient(
        spur_pair(
            meshes__pair__stiffness="1e12 N/m", meshes__pair__transmission_error=[], meshes__pair__backlash="20 um"
        ),
        time=0.01,
    )
    assert still.mesh_force == pytest.approx(200.0 / (0.048 * np.cos(np.radians(20.0))), rel=1e-6)
    shaken = transient(spur_pair(meshes__pair__stiffness="1e12 N/m"), time=0.005, discard=0.002, accuracy=0.02)
    assert shaken.status == "success"
    assert shaken.error_estimate < 0.1 or any("accuracy" in note for note in shaken.warnings)


def test_a_bearing_that_is_never_loaded_does_nothing() -> None:
    rolling = {
        "kind": "roller",
        "elements": 12,
        "element_diameter": "8 mm",
        "length": "8 mm",
        "pitch_diameter": "60 mm",
        "clearance": "0.9 mm",
    }
    spare = {"shaft": "one", "at": "30 mm", "stiffness": {"radial": "1e8 N/m"}, "rolling": rolling}
    with_it = transient(spur_pair(bearings__spare=spare), time=0.02, discard=0.05, steps=200, error_estimate=False)
    without = transient(spur_pair(), time=0.02, discard=0.05, steps=200, error_estimate=False)
    assert np.all(with_it.history("bearings.spare force x") == 0.0)
    assert with_it.mesh_force.std() == pytest.approx(without.mesh_force.std(), rel=1e-2)


def test_torques_that_do_not_balance_are_refused_in_the_model_and_drift_is_told_when_they_come_to_be() -> None:
    with pytest.raises(ModelError, match="balance"):
        spur_pair(
            operation__torque=None,
            operation__output_shaft=None,
            loads={
                "a": {"shaft": "one", "kind": "input", "torque": "100 N m"},
                "b": {"shaft": "two", "kind": "output", "torque": "10 N m"},
            },
        )
    model = spur_pair(
        operation__torque=None,
        operation__output_shaft=None,
        loads={
            "a": {"shaft": "one", "kind": "input", "torque": "100 N m", "step_to": 1.5},
            "b": {"shaft": "two", "kind": "output"},
        },
    )
    result = transient(model, time=0.02, discard=0.05, steps=200)
    assert any("balance" in note for note in result.warnings)


def test_steps_that_are_far_too_large_stay_bounded_and_are_told() -> None:
    result = transient(
        spur_pair(meshes__pair__backlash="20 um", operation__torque="3 N m"),
        steps=3,
        records=3,
        method="newmark",
        time=0.2,
    )
    assert np.all(np.isfinite(result.mesh_force))
    assert result.error_estimate > 0.05 or "smaller step" in result.status
    assert any("smaller step" in note for note in result.warnings)


def test_a_model_without_meshes_and_a_loose_shaft_run_too() -> None:
    loose = rg.Model(
        operation={"input_shaft": "rotor", "speed": "3000 rpm"},
        materials={"steel": {"youngs_modulus": "206 GPa", "poisson_ratio": 0.3, "density": "7850 kg/m^3"}},
        shafts={"rotor": {"material": "steel", "sections": [{"length": "0.5 m", "outer_diameter": "30 mm"}]}},
        unbalances={"u": {"shaft": "rotor", "at": "0.25 m", "magnitude": "1 g mm"}},
        points={"end": {"shaft": "rotor", "at": "end", "direction": "x"}},
    )
    result = transient(loose, time=0.1, steps=1200)
    assert result.status == "success"
    assert np.all(np.isfinite(result.values))
