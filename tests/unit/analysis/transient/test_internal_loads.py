"""Loads inside shafts in time: at rest those of statics, in motion in balance with what acts at each place."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from tests.unit.analysis.response.test_internal_loads import shaken
from tests.unit.analysis.static.test_internal_loads import SIX, chain, geared, read_everywhere


def read(result: rg.TransientResult, number: int, side: str = "") -> np.ndarray:
    """Histories (r, 6) of the loads at a place."""
    return np.array([result.history(f"points.{side}{number}_{q}_{axis} {q}") for q, axis in SIX]).T


def test_what_does_not_move_has_the_loads_of_statics() -> None:
    model = read_everywhere(geared(), [("output", 0.051), ("input", -0.093)])
    still = rg.static(model)
    result = rg.transient(model, time="2 ms", discard="0 ms", steps=20, error_estimate=False, method="newmark")
    for name in model.points:
        if model.points[name].quantity is None:
            continue
        channel = result.channel.index(f"points.{name} {model.points[name].quantity}")
        for value in (result.value_mean[channel], *result.value_range[channel], result.values[-1, channel]):
            assert value == pytest.approx(still.load_at(name), rel=1e-6, abs=1e-5)


def on_both_sides(places: list[tuple[str, float]]) -> rg.Model:
    data = shaken()
    data["damping"] = {"rayleigh_alpha": 3.0, "rayleigh_beta": 2e-6}
    model = rg.Model(**data)
    for side in ("left", "right"):
        points = read_everywhere({**data, "points": {}}, places, side=side).points
        model = model.with_(
            {f"points.{side}{name}": point.model_dump(exclude_none=True) for name, point in points.items()}
        )
    return model


def test_loads_in_motion_are_in_balance_at_every_record() -> None:
    model = on_both_sides([("output", 0.0471), ("input", -0.0931), ("output", 0.06), ("input", 0.03)])
    result = rg.transient(model, time="4 ms", discard="1 ms", steps=40, error_estimate=False, method="exponential")
    loads = {(side, n): read(result, n, side) for side in ("left", "right") for n in range(4)}
    size = max(np.abs(load).max() for load in loads.values())
    for n in (0, 1):
        np.testing.assert_allclose(loads["left", n], loads["right", n], rtol=0.0, atol=1e-9 * size)
    # Channels tell the force of the shaft on its bearings.
    on_bearing = np.array([result.history(f"bearings.output_right force {axis}") for axis in "xy"]).T
    jump = loads["left", 2] - loads["right", 2]
    np.testing.assert_allclose(jump[:, :2], -on_bearing, rtol=0.0, atol=1e-9 * size)
    W = 2970.0 * math.pi / 30.0
    angle = W * result.time + math.radians(70.0)
    unbalance = 50e-6 * W**2 * np.column_stack([np.cos(angle), np.sin(angle)])
    jump = loads["left", 3] - loads["right", 3]
    np.testing.assert_allclose(jump[:, :2], unbalance, rtol=0.0, atol=1e-9 * size)


def test_loads_of_newmarks_method_are_in_balance_to_second_order() -> None:
    model = on_both_sides([("output", 0.0471)])

    def apart(steps: int) -> float:
        result = rg.transient(model, time="4 ms", discard="1 ms", steps=steps, error_estimate=False, method="newmark")
        return float(np.abs(read(result, 0, "left") - read(result, 0, "right")).max())

    assert apart(320) < apart(80) / 10.0


def test_a_chain_with_a_pulsing_motor_has_the_torques_of_its_inertias() -> None:
    data = chain(900.0, 2e9, 45.0)
    data["operation"] = {"input_shaft": "s0", "speed": 30.0}
    data["loads"] = {
        "motor": {"kind": "input", "shaft": "s0", "torque": 17.0, "ripple": 0.5, "ripple_order": 2.0},
        "brake": {"kind": "output", "shaft": "s3", "torque": 17.0},
    }
    data["points"] |= {f"a{k}": {"on": f"disks.s{k}", "direction": "torsion"} for k in range(4)}
    options: dict[str, Any] = {"time": "0.5 s", "discard": "0 s", "error_estimate": False, "method": "exponential"}
    result = rg.transient(rg.Model(**data), **options)
    angular = np.array([result.history(f"points.a{k} acceleration") for k in range(4)])
    first, second, third = (result.history(f"points.c{k} torque") for k in range(3))
    size = np.abs(first).max()
    assert np.ptp(first) > 1.0
    # J a = load from the right, less that from the left, and the brake.
    np.testing.assert_allclose(0.1 * angular[3], -third - 17.0, rtol=0.0, atol=1e-9 * size)
    np.testing.assert_allclose(0.1 * angular[1], second - first, rtol=0.0, atol=1e-6 * size)


def test_a_run_up_reads_torques_and_refuses_what_gyroscopic_moments_take_part_in() -> None:
    model = read_everywhere(geared(), [("output", 0.051)])
    options: dict[str, Any] = {"speed": [(0.0, 200.0), (0.01, 300.0)], "time": "2 ms", "steps": 10}
    with pytest.raises(rg.AnalysisError, match=r"points\.0_shear_x: gyroscopic moments"):
        rg.transient(model, error_estimate=False, **options)
    kept = {name: point for name, point in model.points.items() if point.quantity in ("torque", "axial")}
    torque = rg.Model(**{**geared(), "points": kept})
    assert "points.0_torque_x torque" in rg.transient(torque, error_estimate=False, **options).channel
