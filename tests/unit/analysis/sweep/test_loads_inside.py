"""Loads inside couplings and shafts in sweeps: those of a linear response where nothing parts, of orbits where teeth do."""

from __future__ import annotations

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.sweep.inside import load_errors, load_scatter, with_reduction
from tests.unit.analysis.orbits.test_loads_inside import driven
from tests.unit.analysis.static.test_static import data_of

SPEED = {"operation.speed": ["9000 rpm"]}


def test_loads_of_teeth_that_stay_in_touch_are_those_of_the_response() -> None:
    data = driven().model_dump(exclude_none=True)
    for key in ("backlash", "stiffness_variation"):
        data["meshes"]["pair"].pop(key)
    data["meshes"]["pair"]["transmission_error"] = [
        {"harmonic": n, "amplitude": a * 1e-6, "phase": 0.3 * n} for n, a in ((1, 0.3), (2, 0.2))
    ]
    model = rg.Model(**data)
    swept = rg.sweep(model, SPEED, discard=300, sample=8, exponents=1)
    assert swept.load_points == ("torque",)
    assert swept.load_unit == ("N m",)
    mean, rms, largest, smallest = swept.load_statistics[0, 0, 0]
    orders = rg.response(model, speeds=["9000 rpm"]).internal_load[:, 0, 0]
    error = swept.load_error[0, 0, 0]
    assert np.all(error < 1e-3 * rms)
    assert abs(mean + 10.0) <= max(error[0], 1e-9)
    assert abs(rms - np.sqrt(0.5 * np.sum(np.abs(orders) ** 2))) <= 3.0 * error[1] + 1e-9
    turn = np.real(np.exp(2j * np.pi * np.outer(np.arange(3600) / 3600, (1, 2))) @ orders)
    assert abs(largest - mean - turn.max()) <= 3.0 * error[2] + 1e-6 * rms
    assert abs(mean - smallest + turn.min()) <= 3.0 * error[3] + 1e-6 * rms
    assert "Load at torque" in swept.text()
    assert not any("points." in note for note in swept.left_out)


@pytest.mark.long
def test_loads_behind_teeth_that_part_are_those_of_orbits() -> None:
    swept = rg.sweep(driven(), SPEED, discard=200, sample=40)
    orbit = rg.orbits(driven(), {"operation.speed": "9000 rpm:9001 rpm"}, step=0.5)
    off = np.abs(swept.load_statistics[0, 0] - orbit.load_statistics[0])
    assert np.all(off <= 3.0 * (swept.load_error[0, 0] + orbit.load_error[0]) + 1e-9)


@pytest.mark.long
def test_loads_of_a_reduced_system_are_right_to_their_error() -> None:
    data = data_of("flexible_pair")
    data["operation"]["torque"] = "300 N m"
    data["damping"] = {"rayleigh_alpha": 300.0, "rayleigh_beta": 1e-6}
    data["points"] = {
        "t": {"shaft": "output", "at": "30 mm", "quantity": "torque"},
        "s": {"shaft": "input", "at": "30 mm", "quantity": "shear", "direction": "y"},
    }
    model = rg.Model(**data)
    few, many = (
        rg.sweep(model, {"operation.speed": ["6000 rpm"]}, modes=n, discard=60, sample=8, exponents=0) for n in (26, 44)
    )
    assert few.reduction is not None
    assert few.reduction.loads > 1e-3
    assert many.reduction is not None
    assert many.reduction.loads < few.reduction.loads
    off = np.abs(few.load_statistics - many.load_statistics)[0, 0]
    assert np.all(off <= 3.0 * (few.load_error + many.load_error)[0, 0])
    assert np.all(few.load_error[0, 0, :, 1] < 0.2 * few.load_statistics[0, 0, :, 1])


def test_errors_of_statistics_come_from_finer_steps_or_from_windows() -> None:
    own = np.array([[10.0, 1.0, 12.0, 8.0]])
    np.testing.assert_allclose(load_errors(own, own + 8e-3, 0.0, (0.1, 0.3)), 9e-3)
    assert np.all(load_errors(own, own + 8e-3, 0.1, (0.1, 0.3)) >= 0.1 * np.array([12.0, 1.0, 12.0, 12.0]))
    both = with_reduction(np.zeros((1, 4)), own, 0.1)
    np.testing.assert_allclose(both, [[0.0, 0.1, 0.2, 0.2]])
    rng = np.random.default_rng(3)
    values = rng.normal(5.0, 2.0, (8, 50000))
    windows = np.stack([values.mean(axis=1), values.std(axis=1), values.max(axis=1), values.min(axis=1)], axis=-1)
    whole = np.array([[values.mean(), values.std(), values.max(), values.min()]])
    draws = rng.integers(0, 8, (400, 8))
    mean, rms, *_ = load_scatter(whole, windows[:, None], draws)[0]
    # Two means of 400,000 values differ by 1.96 sqrt(2) 2 / sqrt(400,000) in nineteen cases of twenty.
    assert 0.3 < mean / 8.8e-3 < 2.0
    assert 0.3 < rms / 6.2e-3 < 2.5
