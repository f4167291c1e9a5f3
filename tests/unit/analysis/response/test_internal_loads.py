"""Loads inside shafts in vibration: a continuous rod, and the balance of what acts at each place of a geared pair."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from tests.unit.analysis.static.test_internal_loads import SIX, geared, read_everywhere

OMEGA = 2970.0 * math.pi / 30.0


def shaken() -> dict[str, Any]:
    """The geared pair with unbalances, transmission error, and damping of every kind."""
    data = geared()
    data["unbalances"] = {
        "u": {"shaft": "output", "at": "100 mm", "magnitude": "500 g mm", "phase": "20 deg"},
        "v": {"shaft": "input", "at": "30 mm", "magnitude": "50 g mm", "phase": "70 deg"},
    }
    data["meshes"]["stage"]["transmission_error"] = [{"harmonic": 1, "amplitude": "3 um", "phase": "10 deg"}]
    data["damping"] = {"rayleigh_alpha": "3 1/s", "rayleigh_beta": "2 us", "modal_ratio": 0.01}
    data["shafts"]["output"]["internal_damping"] = "1 us"
    return data


def both_sides(data: dict[str, Any], places: list[tuple[str, float]]) -> tuple[rg.ResponseResult, np.ndarray]:
    """A run-up, and the loads (2, o, s, place, 6) left and right of each place."""
    model = rg.Model(**data)
    for side in ("left", "right"):
        read = read_everywhere({**data, "points": {}}, places, side=side)
        more = {f"{side}_{name}": point.model_dump(exclude_none=True) for name, point in read.points.items()}
        model = model.with_({f"points.{name}": point for name, point in more.items()})
    result = rg.response(model, points=4)
    loads = np.array(
        [
            [
                [
                    result.internal_load[:, :, result.load_points.index(f"{side}_{n}_{quantity}_{axis}")]
                    for quantity, axis in SIX
                ]
                for n in range(len(places))
            ]
            for side in ("left", "right")
        ]
    )
    return result, np.moveaxis(loads, (1, 2), (3, 4))


def test_loads_on_both_sides_of_a_place_are_equal_in_vibration() -> None:
    rng = np.random.default_rng(3)
    places = [("input", float(z)) for z in rng.uniform(-0.15, 0.08, 5)]
    places += [("output", float(z)) for z in rng.uniform(-0.08, 0.15, 5)]
    result, loads = both_sides(shaken(), places)
    size = np.abs(loads).max(axis=(0, 3), keepdims=True)
    assert np.all(np.abs(loads[0] - loads[1]) <= 1e-9 * size.max(axis=(4,), keepdims=True))
    assert len(result.load_points) == 120


def test_a_load_jumps_at_a_place_by_what_acts_there() -> None:
    places = [("output", 0.06), ("output", 0.1), ("input", 0.03), ("input", -0.05)]
    result, loads = both_sides(shaken(), places)
    jump = loads[0] - loads[1]
    size = np.abs(loads).max(axis=(0, 3, 4))
    for n, bearing in ((0, "output_right"), (3, "input_left")):
        force = result.bearing_force[:, :, result.bearings.index(bearing)]
        assert np.all(np.abs(jump[:, :, n, :3] - force) <= 1e-9 * size[..., None])
    for n, shaft, magnitude, phase in ((1, "output", 500e-6, 20.0), (2, "input", 50e-6, 70.0)):
        o = result.orders.index(f"shaft {shaft} 1x")
        W = result.speeds * result.model.layout.train.ratio(shaft)
        x = magnitude * W**2 * np.exp(1j * math.radians(phase))
        y = -1j * x  # a quarter turn behind where the shaft turns about +z, else both turn the other way
        x, y = (x, y) if W[0] > 0.0 else (x.conj(), y.conj())
        assert np.all(np.abs(jump[o, :, n, 0] - x) <= 1e-9 * size[o])
        assert np.all(np.abs(jump[o, :, n, 1] - y) <= 1e-9 * size[o])


def rod(**point: Any) -> rg.Model:
    return rg.Model(
        motions=("torsion",),
        operation={"input_shaft": "rod", "speed": OMEGA},
        shafts={"rod": {"sections": [{"length": 0.7, "outer_diameter": 0.03}]}},
        supports={"wall": {"shaft": "rod", "at": "start", "fixed": ["torsion"]}},
        points={
            "gauge": {"shaft": "rod", "at": 0.263, "quantity": "torque", **point},
            "tip": {"shaft": "rod", "at": "end", "direction": "torsion"},
        },
    )


def exact(model: rg.Model, hz: np.ndarray) -> np.ndarray:
    """Torque inside a fixed and free rod at 0.263 m under a unit torque at its end of 0.7 m: cos(kz) / cos(kL)."""
    steel = model.material_of("rod")
    k = 2.0 * np.pi * hz * math.sqrt(steel.density / steel.g)
    return np.cos(k * 0.263) / np.cos(k * 0.7)


def test_the_torque_inside_a_rod_is_that_of_the_continuum_to_the_stated_error() -> None:
    model = rod()
    hz = np.array([40.0, 700.0, 1500.0, 2600.0, 4100.0])
    for options in ({}, {"accuracy": 1e-7}, {"elements": 3}):
        result = rg.frf(model, hz, inputs=["tip"], outputs=["gauge", "tip"], **options)
        assert result.output_units == ("N m", "rad")
        assert result.unit(0, 0) == "N m/(N m)"
        error = np.abs(result.receptance[:, 0, 0] - exact(model, hz)).max() / np.abs(exact(model, hz)).max()
        assert error <= 2.0 * result.error_estimate
    side = rg.frf(rod(side="left"), hz, inputs=["tip"], outputs=["gauge"])
    right = rg.frf(rod(side="right"), hz, inputs=["tip"], outputs=["gauge"])
    np.testing.assert_allclose(side.receptance, right.receptance, rtol=1e-9)


def test_many_frequencies_in_a_basis_read_the_loads_of_direct_solutions() -> None:
    model = read_everywhere(shaken(), [("output", 0.051)])
    options: dict[str, Any] = {"inputs": ["housing_input"], "outputs": [f"0_{q}_{a}" for q, a in SIX], "elements": 5}
    hz = np.linspace(10.0, 3000.0, 240)
    many = rg.frf(model, hz, **options)
    some = np.r_[hz[::30], hz[-1]]  # modes are damped up to a multiple of the highest
    few = rg.frf(model, some, **options)
    assert "basis" in many.method
    size = np.abs(many.receptance).max(axis=0)
    chosen = many.receptance[np.searchsorted(hz, some)]
    assert np.all(np.abs(chosen - few.receptance) <= 1e-6 * size)


@pytest.mark.parametrize("full", [False, True])
def test_a_state_space_reads_the_loads_of_the_frequency_response(full: bool) -> None:
    model = read_everywhere(shaken(), [("output", 0.051), ("input", -0.09)])
    outputs = [f"{n}_{q}_{a}" for n in (0, 1) for q, a in SIX]
    hz = np.array([3.0, 170.0, 420.0, 990.0])
    options: dict[str, Any] = {"inputs": ["housing_input"], "outputs": [*outputs, "housing_output"], "speed": OMEGA}
    system = rg.state_space(model, fmax=1000.0, elements=1, full=full, **options)
    assert system.output_units[:6] == ("N", "N", "N", "N m", "N m", "N m")
    whole = rg.frf(model, hz, elements=1, **options).receptance
    size = np.abs(whole).max(axis=0)
    error = max(system.reduction_error, 1e-9)
    assert np.all(np.abs(system.receptance(hz) - whole) <= error * size)
    A, B, C, D = system.first_order()
    w = 2j * np.pi * hz
    first = np.array([C @ np.linalg.solve(s * np.eye(len(A)) - A, B) + D for s in w])
    assert np.all(np.abs(first - whole) <= 10.0 * error * size)
    assert np.any(D)


def test_a_load_is_no_place_for_a_force() -> None:
    with pytest.raises(rg.AnalysisError, match="reads a load inside"):
        rg.frf(rod(), np.array([10.0]), inputs=["gauge"], outputs=["tip"])
