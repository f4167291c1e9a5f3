"""Trains that nothing holds, in time: random ones are all answered, closed forms, units, and what is said of balance."""

from __future__ import annotations

import json

import numpy as np
import pytest

import rotorgear as rg
from tests.free_trains import chain, free_train
from tests.models import spur_pair

DRIFT = "do not balance"


@pytest.mark.parametrize("first", [0, *(pytest.param(first, marks=pytest.mark.long) for first in (50, 100, 150))])
def test_two_hundred_random_free_trains_are_answered_and_keep_their_momentum(first: int) -> None:
    for seed in range(first, first + 50):
        model = free_train(seed)
        run = rg.transient(model, time=2e-3, discard=0.0, steps=100, error_estimate=False)
        assert run.status == "success", seed
        assert np.all(np.isfinite(run.mesh_force)), seed
        assert not any(DRIFT in text for text in run.warnings), seed
        if model.loads:
            continue
        # With base radii as teeth, the one motion without strain turns each shaft by its ratio.
        parts = [
            gear.polar_inertia * model.layout.train.ratio(gear.shaft) * run.history(f"gears.{name} speed fluctuation")
            for name, gear in model.gears.items()
        ]
        whole = sum(gear.polar_inertia * model.layout.train.ratio(gear.shaft) ** 2 for gear in model.gears.values())
        lost = np.abs(np.sum(parts, axis=0)).max()
        light = any(gear.polar_inertia == 0.0 for gear in model.gears.values())
        assert lost < max((1e-3 if light else 1e-7) * np.abs(parts).max(), 1e-7 * whole * abs(run.speed[0])), seed


@pytest.mark.parametrize("inertias", [[3.3e-3, 1.35e-2], [3.3e-3, 0.0, 1.35e-2], [1e-2, 0.0, 0.0, 1e-4]])
def test_the_force_of_an_error_is_that_of_springs_in_series_between_the_ends(inertias: list[float]) -> None:
    # Z = k + i w c of each mesh, m = J r^-2 of the ends: the force is Z_s m_e w^2 E/(Z_s - m_e w^2).
    meshes = len(inertias) - 1
    w = 20.0 * 500.0
    period = 2.0 * np.pi / w
    run = rg.transient(chain(inertias), time=20.0 * period, discard=100.0 * period, steps=400, error_estimate=False)
    series = (2e8 + 4e3j * w) / meshes
    first, last = inertias[0] / 0.03**2, inertias[-1] / (1.5e-3 * (20 + 10 * meshes)) ** 2
    inertia = first * last / (first + last)
    force = series * inertia * w**2 * meshes * 1e-6 / (series - inertia * w**2)
    assert run.force_mean == pytest.approx(np.full(meshes, 20.0 / 0.03), rel=1e-3)
    assert run.force_rms == pytest.approx(np.full(meshes, abs(force) / np.sqrt(2.0)), rel=5e-3)


def test_bodies_without_inertia_move_alike_in_all_units() -> None:
    forces = []
    for mass in (1.0, 0.1, 0.01, 1e-3, 1e3):
        model = chain([2e-3, 0.0, 5e-3, 0.0], mass, backlash=3e-5)
        run = rg.transient(model, time=5e-3, discard=5e-3, steps=100, error_estimate=False)
        assert run.status == "success"
        forces.append(run.force_rms / mass)
    assert np.array(forces) == pytest.approx(np.tile(forces[0], (5, 1)), rel=1e-6)


def test_an_idler_without_inertia_that_parts_carries_what_its_neighbours_press() -> None:
    model = chain([2e-3, 0.0, 5e-3], backlash=3e-5, transmission_error=[{"harmonic": 1, "amplitude": 2e-5}])
    run = rg.transient(model, time=0.02, discard=0.02, steps=400, error_estimate=False)
    assert run.status == "success"
    assert np.all(run.contact_losses > 0)
    first, second = run.mesh_force.T
    assert first == pytest.approx(second, abs=1e-3 * first.max())


def test_teeth_too_stiff_for_modes_are_left_to_newmark() -> None:
    model = chain([3.2e-3, 3.2e-3], stiffness=1e14, damping=100.0)
    run = rg.transient(model, time=2e-3, discard=0.0, records=80)
    assert run.method.startswith("Newmark")
    assert "exponential" in run.reason


def rotor(**changes: object) -> rg.Model:
    """A disk between two springs, with its weight and without a torque."""
    spring = {"stiffness": {"radial": 3e7}, "damping": {"radial": 2e3}, "shaft": "rotor"}
    return rg.Model.model_validate(
        {
            "schema_version": 1,
            "title": "Disk",
            "motions": ["bending", "torsion"],
            "materials": {"steel": {"youngs_modulus": 2.1e11, "poisson_ratio": 0.3, "density": 7850.0}},
            "operation": {"input_shaft": "rotor", "speed": 200.0, "gravity": [0.0, -9.81, 0.0]},
            "shafts": {
                "rotor": {"material": "steel", "sections": [{"length": 0.7, "outer_diameter": 0.045}]},
                "loose": {"start": 1.0, "material": "steel", "sections": [{"length": 0.1, "outer_diameter": 0.03}]},
            },
            "disks": {
                "disk": {"shaft": "rotor", "at": 0.3, "mass": 12.0, "polar_inertia": 0.1, "diametral_inertia": 0.06}
            },
            "bearings": {
                "left": spring | {"at": "start"},
                "right": spring | {"at": "end"},
                "third": spring | {"shaft": "loose", "at": "start"},
                "fourth": spring | {"shaft": "loose", "at": "end"},
            },
        }
        | changes
    )


# A torque that pulses about zero is at its largest when the run begins.
@pytest.mark.parametrize("moment", [{}, {"order": 2.0}, {"frequency": 40.0, "phase": 0.4}])
def test_weight_and_a_torque_that_pulses_about_zero_do_not_drift(moment: dict[str, float]) -> None:
    loads = {"pulse": {"shaft": "rotor", "at": "end", "moment": [0.0, 0.0, 7.0]} | moment} if moment else {}
    run = rg.transient(rotor(loads=loads), time=0.05, discard=0.0, steps=200, error_estimate=False)
    assert not any(DRIFT in text for text in run.warnings)


def test_a_mean_torque_on_a_shaft_that_nothing_holds_is_said_once() -> None:
    loads = {"push": {"shaft": "loose", "at": "end", "moment": [0.0, 0.0, 0.3]}}
    run = rg.transient(rotor(loads=loads), time=0.02, discard=0.0, steps=200, error_estimate=False)
    assert sum(DRIFT in text for text in run.warnings) == 1


def test_a_sweep_of_shafts_with_weight_and_no_torque_does_not_drift() -> None:
    still = {"operation": {"input_shaft": "one", "speed": "1500 rpm", "gravity": ["0 m/s^2", "-9.81 m/s^2", "0 m/s^2"]}}
    found = rg.sweep(
        spur_pair(**still), {"operation.speed": ["1500 rpm"]}, discard=4, sample=4, elements=1, exponents=0
    )
    assert not any(DRIFT in text for text in found.warnings)


@pytest.mark.parametrize(("moment", "count"), [({}, 1), ({"order": 1.0}, 0)])
def test_a_sweep_says_once_that_a_shaft_drifts_under_a_mean_torque(moment: dict[str, float], count: int) -> None:
    model = chain([3e-3, 8e-3], backlash=3e-5)
    data = json.loads(model.model_dump_json(exclude_unset=True))
    data["shafts"]["loose"] = {}
    data["disks"] = {
        "disk": {"shaft": "loose", "at": "start", "mass": 1.0, "polar_inertia": 2e-3, "diametral_inertia": 1e-3}
    }
    data["loads"] = {"push": {"shaft": "loose", "at": "start", "moment": [0.0, 0.0, 0.3], "order_of": "s0"} | moment}
    if not moment:
        del data["loads"]["push"]["order_of"]
    found = rg.sweep(
        rg.Model.model_validate(data), {"operation.speed": [450.0, 500.0]}, discard=4, sample=4, exponents=0
    )
    assert sum(DRIFT in text for text in found.warnings) == count
