"""A bevel pair, two spur and two herringbone meshes on five shafts in space: a helicopter's gearbox up to its collector."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import pytest

import rotorgear as rg

TORQUE = 500.0
# Between the axes of input and bevel shaft, in rad; the apex stands on the axis of the bevel shaft.
ANGLE = np.radians(80.0)
INPUT_AXIS = [float(np.sin(ANGLE)), 0.0, float(np.cos(ANGLE))]
APEX = [0.28897956, 0.0, 0.05]


def shaft(start: float, length: float, diameter: float, position: list[float], **more: Any) -> dict[str, Any]:
    return {"start": start, "position": position, "sections": [{"length": length, "outer_diameter": diameter}], **more}


def bearing(on: str, at: float, axial: float = 0.0) -> dict[str, Any]:
    return {"shaft": on, "at": at, "stiffness": {"radial": 2e8, **({"axial": axial} if axial else {})}}


def helicopter() -> rg.Model:
    body = {"mass": 1.0, "polar_inertia": 2e-3, "diametral_inertia": 1e-3}
    bevel = {
        "kind": "bevel",
        "spiral_angle": "35 deg",
        "width": 0.03,
        "mean_normal_module": 0.069 / 23.0 * np.cos(np.radians(35.0)),
    }
    spur = {"kind": "spur", "normal_module": 2e-3, "width": 0.03}
    double = {"kind": "herringbone", "normal_module": 2.5e-3, "helix_angle": "25 deg", "width": 0.03, "gap": 0.012}
    branches = {"branch_a": 0.0724545372, "branch_b": -0.0724545372}
    gears = {
        "bevel_pinion": {"shaft": "input", "at": 0.0989948, "teeth": 23, "hand": "left", **bevel, **body},
        "bevel_wheel": {"shaft": "bevel", "at": 0.1011661, "teeth": 61, "hand": "right", **bevel, **body},
        "split": {"shaft": "bevel", "at": 0.02, "teeth": 31, **spur},
        "bull": {"shaft": "collector", "at": -0.06, "teeth": 143, "hand": "left", **double},
    }
    meshes = {"bevel": ("bevel_pinion", "bevel_wheel")}
    for name in branches:
        gears[f"wheel_{name}"] = {"shaft": name, "at": 0.02, "teeth": 67, **spur}
        gears[f"pinion_{name}"] = {"shaft": name, "at": -0.06, "teeth": 27, "hand": "right", **double}
        meshes |= {f"split_{name}": ("split", f"wheel_{name}"), f"collect_{name}": (f"pinion_{name}", "bull")}
    bearings = {
        "input_front": bearing("input", 0.128),
        "input_rear": bearing("input", 0.215, 2e8),
        "bevel_bottom": bearing("bevel", -0.01),
        "bevel_top": bearing("bevel", 0.146, 3e8),
        "collector_top": bearing("collector", -0.01, 2e8),
        "collector_bottom": bearing("collector", -0.111),
    }
    for name in branches:
        bearings |= {f"{name}_top": bearing(name, 0.045, 1e6), f"{name}_bottom": bearing(name, -0.111)}
    return rg.Model(
        operation={"input_shaft": "input", "output_shaft": "collector", "speed": 2000.0, "torque": TORQUE},
        shafts={
            "input": shaft(0.076, 0.18, 0.045, APEX, axis=INPUT_AXIS),
            "bevel": shaft(-0.024, 0.18, 0.05, [APEX[0], 0.0]),
            "collector": shaft(-0.16, 0.2, 0.11, [0.0, 0.0]),
            **{name: shaft(-0.124, 0.18, 0.045, [0.222992136, y]) for name, y in branches.items()},
        },
        gears=gears,
        meshes={name: {"pinion": one, "gear": other, "stiffness": 6e8} for name, (one, other) in meshes.items()},
        bearings=bearings,
    )


def test_speeds_are_the_fractions_of_the_teeth() -> None:
    ratios = helicopter().layout.train.ratios
    assert ratios["bevel"] == Fraction(-23, 61)
    assert ratios["branch_a"] == ratios["branch_b"] == Fraction(713, 4087)
    assert ratios["collector"] == Fraction(-19251, 584441)


def test_equal_branches_carry_equal_forces_by_the_torque_flow() -> None:
    forces: dict[str, float] = {}
    for line in helicopter().torque_flow().forces:
        forces[line.contact.mesh] = forces.get(line.contact.mesh, 0.0) + line.normal_force
    # F_n = F_t / (cos alpha_n cos beta), at the mean cone and at the pitch circles.
    of_bevel = TORQUE / 0.0345 / np.cos(np.radians(20.0)) / np.cos(np.radians(35.0))
    assert forces["bevel"] == pytest.approx(of_bevel, rel=1e-9)
    on_bevel_shaft = TORQUE * 61.0 / 23.0
    of_split = on_bevel_shaft / 2.0 / (0.031 * np.cos(np.radians(20.0)))
    on_branch = on_bevel_shaft / 2.0 * 67.0 / 31.0
    radius = 27.0 * 2.5e-3 / 2.0 / np.cos(np.radians(25.0))
    of_collect = on_branch / radius / np.cos(np.radians(20.0)) / np.cos(np.radians(25.0))
    for name in ("branch_a", "branch_b"):
        assert forces[f"split_{name}"] == pytest.approx(of_split, rel=1e-9)
        assert forces[f"collect_{name}"] == pytest.approx(of_collect, rel=1e-9)


def test_the_bearings_hold_the_torques_of_both_ends_in_space() -> None:
    model = helicopter()
    result = rg.static(model, elements=1)
    force = np.zeros(3)
    moment = np.zeros(3)
    for name, part in model.bearings.items():
        frame = model.shafts[part.shaft].frame
        on_shaft = frame.axes @ result.bearing_force[name][:3]
        force += on_shaft
        moment += np.cross(frame.at(model.layout.place(f"bearings.{name}").z), on_shaft)
    output = TORQUE * 584441.0 / 19251.0
    assert np.abs(force).max() < 1e-7 * np.abs(result.mesh_force).max()
    assert moment == pytest.approx(
        -(TORQUE * np.array(INPUT_AXIS) + output * np.array([0.0, 0.0, 1.0])), abs=1e-6 * output
    )
