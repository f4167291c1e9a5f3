"""Powers and torques on shafts at other speeds, and what supports hold at the end of a rigid stretch: statics by hand."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.system.system import System
from tests.models import lumped_gear, lumped_pair

RADII = {"a": 0.05, "b": 0.12, "c": 0.03, "d": 0.1}  # one - two - three
SPEED = 150.0


def train(speed: float, loads: dict[str, Any]) -> rg.Model:
    shafts = {"a": "one", "b": "two", "c": "two", "d": "three"}
    return rg.Model(
        motions=["torsion"],
        operation={"input_shaft": "one", "speed": speed},
        shafts={name: {} for name in ("one", "two", "three")},
        gears={name: lumped_gear(shafts[name], radius) for name, radius in RADII.items()},
        meshes={
            "first": {"pinion": "a", "gear": "b", "stiffness": 1e8, "centre_line_angle": 0.2, "pressure_angle": 0.35},
            "second": {"pinion": "c", "gear": "d", "stiffness": 2e8, "centre_line_angle": 1.1, "pressure_angle": 0.35},
        },
        loads=loads,
    )


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_powers_become_torques_at_the_speed_of_their_own_shafts(sense: float) -> None:
    loads = {
        "drive": {"shaft": "one", "kind": "input", "power": "30 kW"},
        "pump": {"shaft": "two", "kind": "output", "power": "10 kW"},
        "mill": {"shaft": "three", "kind": "output"},
    }
    result = rg.static(train(sense * SPEED, loads))
    speeds = [SPEED, SPEED * 0.05 / 0.12, SPEED * 0.05 / 0.12 * 0.03 / 0.1]
    # Power over the speed of the flanks along the line of action.
    assert result.mesh_force == pytest.approx([30e3 / (speeds[0] * 0.05), 20e3 / (speeds[1] * 0.03)], rel=1e-9)
    torques = [result.torque[f"loads.{name}"] for name in ("drive", "pump", "mill")]
    expected = [sense * 30e3 / speeds[0], sense * 10e3 / speeds[1], -sense * 20e3 / speeds[2]]
    assert torques == pytest.approx(expected, rel=1e-9)


def test_a_generator_that_drives_backwards_takes_its_power_from_the_last_shaft() -> None:
    loads = {
        "turbine": {"shaft": "three", "kind": "input", "torque": 400.0},
        "generator": {"shaft": "one", "kind": "output"},
    }
    result = rg.static(train(SPEED, loads))
    ratio = 0.05 / 0.12 * 0.03 / 0.1
    assert result.torque["loads.generator"] == pytest.approx(-400.0 * ratio, rel=1e-9)
    assert result.mesh_force == pytest.approx([400.0 * ratio / 0.05, 400.0 / 0.1], rel=1e-9)


def test_a_support_holds_force_and_moment_of_a_weight_at_the_end_of_a_rigid_stretch() -> None:
    model = rg.Model(
        operation={"input_shaft": "rotor", "gravity": [2.0, -9.81, 0.5]},
        materials={"light": {"youngs_modulus": 2e11, "poisson_ratio": 0.3, "density": 1e-6}},
        shafts={
            "rotor": {
                "start": 0.2,
                "material": "light",
                "sections": [
                    {"length": 0.7, "outer_diameter": 0.05, "rigid": True},
                    {"length": 0.1, "outer_diameter": 0.05},
                ],
            }
        },
        disks={"disk": {"shaft": "rotor", "at": "end", "mass": 8.0, "polar_inertia": 0.1, "diametral_inertia": 0.1}},
        supports={"wall": {"shaft": "rotor", "at": "start", "fixed": ["all"]}},
    )
    held = rg.static(model).support_force["wall"]
    weight = 8.0 * np.array([2.0, -9.81, 0.5])
    moment = np.cross([0.0, 0.0, 0.8], weight)
    assert held == pytest.approx([*-weight, *-moment], abs=1e-4)


@pytest.mark.parametrize("count", [1, 3])
def test_the_weight_of_a_shaft_is_carried_by_its_bearings_by_their_levers(count: int) -> None:
    bearing = {"shaft": "rotor", "stiffness": {"radial": 1e8, "axial": 1e8}}
    model = rg.Model(
        operation={"input_shaft": "rotor", "gravity": [0.0, -9.81, 0.0]},
        materials={"steel": {"youngs_modulus": 2e11, "poisson_ratio": 0.3, "density": 7800.0}},
        shafts={
            "rotor": {
                "material": "steel",
                "sections": [{"length": 0.6, "outer_diameter": 0.08}, {"length": 0.4, "outer_diameter": 0.05}],
            }
        },
        bearings={"left": {"at": "start", **bearing}, "right": {"at": 0.8, **bearing}},
    )
    held = rg.static(model, elements=count).bearing_force
    weights = [7800.0 * math.pi / 4 * d**2 * L * 9.81 for d, L in ((0.08, 0.6), (0.05, 0.4))]
    right = (weights[0] * 0.3 + weights[1] * 0.8) / 0.8
    assert held["right"][1] == pytest.approx(right, rel=1e-6)
    assert held["left"][1] == pytest.approx(sum(weights) - right, rel=1e-6)


@pytest.mark.parametrize(("driver", "radius"), [("one", 0.06), ("two", 0.15)])
def test_the_mean_force_of_a_helical_mesh_is_torque_over_its_arm_whichever_gear_is_given_the_torque(
    driver: str, radius: float
) -> None:
    other = {"one": "two", "two": "one"}[driver]
    model = lumped_pair(
        lumped_gear("one", 0.06, "right"),
        lumped_gear("two", 0.15, "left"),
        {},
        operation={"input_shaft": driver, "output_shaft": other, "torque": 100.0, "speed": 50.0},
    )
    (force,) = System(model).state.forces
    assert force.normal_force == pytest.approx(100.0 / (radius * math.cos(0.4)), rel=1e-9)
    assert force.pinion_drives is (driver == "one")
