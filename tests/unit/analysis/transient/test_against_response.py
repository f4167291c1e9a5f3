"""Steady transients against the response in frequency, amplitude and phase: two methods that share the matrices only.

Nothing stands at a value without a sense: phases are not 0, the stagger is a quarter of a pitch, the second shaft turns
against the first at another speed, and the gear drives as well.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.results.response import ResponseResult
from rotorgear.results.transient import TransientResult
from tests.models import spur_pair

HEAVY = {name: {"radial": "2e4 N s/m", "axial": "1e4 N s/m"} for name in "abcd"}


def herringbone(**changes: Any) -> rg.Model:
    """A herringbone pair whose helices are a quarter of a pitch apart, with unbalances on both shafts."""
    gear = {"kind": "herringbone", "helix_angle": "25 deg", "gap": "20 mm", "nodes": 2}
    own = {f"gears__{name}__{key}": value for name in ("pinion", "wheel") for key, value in gear.items()}
    own |= {
        "gears__pinion__hand": "right",
        "gears__wheel__hand": "left",
        "shafts__two__position": ["100 mm", "86.7801 mm"],
        "meshes__pair__transmission_error": [
            {"harmonic": 1, "amplitude": "2 um", "phase": "35 deg"},
            {"harmonic": 2, "amplitude": "1 um", "phase": "-70 deg"},
        ],
        "meshes__pair__damping_ratio": None,
        "meshes__pair__damping": "6e3 N s/m",
        "meshes__pair__stagger": 0.25,
        "damping__rayleigh_beta": None,
        "damping__rayleigh_alpha": "60 1/s",
        "unbalances": {
            "u": {"shaft": "one", "at": "40 mm", "magnitude": "300 g mm", "phase": "50 deg"},
            "w": {"shaft": "two", "at": "80 mm", "magnitude": "500 g mm", "phase": "-20 deg"},
        },
    }
    own |= {f"bearings__{name}__damping": value for name, value in HEAVY.items()}
    for shaft, d in (("one", "40 mm"), ("two", "50 mm")):
        own[f"shafts__{shaft}__sections"] = [{"length": "120 mm", "outer_diameter": d}]
    return spur_pair(**{**own, **changes})


def amplitudes(result: TransientResult, values: np.ndarray, frequencies: np.ndarray) -> np.ndarray:
    """Complex amplitudes (f, c) of Re(x e^{iwt}) in values (t, c) beside their mean, by least squares."""
    t = result.time[result.counted]
    angle = 2.0 * np.pi * np.outer(t, frequencies)
    waves = np.hstack([np.ones((t.size, 1)), np.cos(angle), -np.sin(angle)])
    found = np.linalg.lstsq(waves, values[result.counted], rcond=None)[0][1:]
    return np.asarray(found[: len(frequencies)] + 1j * found[len(frequencies) :])


def assert_agree(model: rg.Model, speed: float, orders: int, rel: float) -> None:
    """Forces of meshes and bearings, transmission errors and approaches of every order.

    What an order hardly moves is held to the size of the others.
    """
    linear: ResponseResult = rg.response(model, speeds=[speed], elements=1, method="direct")
    assert len(linear.orders) == orders
    result = rg.transient(
        model,
        speed=speed,
        time=0.06,
        discard=0.1,
        steps=100,
        records=25,
        method="newmark",
        elements=1,
        error_estimate=False,
    )
    assert result.contact_losses.sum() == 0
    frequencies = linear.frequency_hz[:, 0]
    mesh = amplitudes(result, result.mesh_force, frequencies)
    held = np.array([result.history(f"bearings.{name} force {axis}") for name in linear.bearings for axis in "xy"]).T
    bearing = amplitudes(result, held, frequencies)  # of the shaft on the bearing
    for kind, found, expected in (
        ("mesh", mesh, linear.mesh_force[:, 0]),
        (
            "transmission error",
            amplitudes(result, result.transmission_error, frequencies),
            linear.transmission_error[:, 0],
        ),
        ("approach", amplitudes(result, result.approach, frequencies), linear.approach[:, 0]),
        ("bearing", bearing, -linear.bearing_force[:, 0, :, :2].reshape(orders, -1)),
    ):
        for o, name in enumerate(linear.orders):
            size = max(np.abs(expected[o]).max(), 0.02 * np.abs(expected).max())
            assert np.abs(found[o] - expected[o]).max() < rel * size, (kind, name)


@pytest.mark.parametrize("driver", ["one", "two"])
@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_a_steady_transient_is_the_response_in_amplitude_and_phase(driver: str, sense: float) -> None:
    model = herringbone(
        operation__input_shaft=driver,
        operation__output_shaft={"one": "two", "two": "one"}[driver],
        operation__torque="300 N m",
    )
    assert_agree(model, sense * 300.0 * (1.0 if driver == "one" else 24.0 / 36.0), 4, 0.02)


def test_a_bearing_carries_its_share_of_the_damping_in_proportion_to_the_stiffness_in_both() -> None:
    # beta w = 0.3 at the mesh frequency: without that share the forces of the bearings differ by several per cent.
    model = herringbone(
        operation__torque="300 N m", damping__rayleigh_alpha="0 1/s", damping__rayleigh_beta="4e-5 s", unbalances={}
    )
    assert_agree(model, 300.0, 2, 0.02)


@pytest.mark.parametrize("driver", ["one", "two"])
def test_a_corner_impact_stands_at_the_same_place_of_the_mesh_cycle_in_both(driver: str) -> None:
    model = herringbone(
        operation__input_shaft=driver,
        operation__output_shaft={"one": "two", "two": "one"}[driver],
        operation__torque="300 N m",
        meshes__pair__transmission_error=[],
        meshes__pair__corner_impact={"force": "50 N", "duration": 0.7, "at": 0.2},
        unbalances={},
    )
    linear = rg.response(model, speeds=[300.0], elements=1, method="direct")
    strongest = int(np.argmax(np.abs(linear.mesh_force[:, 0]).max(axis=1)))
    result = rg.transient(
        model,
        speed=300.0,
        time=0.03,
        discard=0.1,
        steps=100,
        records=50,
        method="newmark",
        elements=1,
        error_estimate=False,
    )
    found = amplitudes(result, result.mesh_force, linear.frequency_hz[:, 0])[strongest]
    expected = linear.mesh_force[strongest, 0]
    assert np.abs(found - expected).max() < 0.02 * np.abs(expected).max()


def test_a_small_variation_of_the_stiffness_acts_with_its_phase_in_both() -> None:
    model = herringbone(
        operation__torque="300 N m",
        meshes__pair__transmission_error=[],
        meshes__pair__stiffness_variation=[{"harmonic": 1, "amplitude": 1e-3, "phase": "65 deg"}],
        unbalances={},
    )
    assert_agree(model, 300.0, 1, 0.02)


@pytest.mark.parametrize("method", ["newmark", "exponential"])
def test_ranges_of_transmission_error_and_approach_are_those_of_all_steps(method: str) -> None:
    """Steps that are not recorded count as well, and a cubic between them: whatever is recorded, the range is the same."""
    how: dict[str, Any] = {"time": 0.002, "discard": 0.001, "steps": 60, "elements": 1, "error_estimate": False}
    model = herringbone(damping__rayleigh_alpha=None)
    few = rg.transient(model, records=5, method=method, **how)
    every = rg.transient(model, records=60, method=method, **how)
    for name in ("transmission_error", "approach"):
        records = getattr(every, name)[every.counted]
        expected = np.stack([records.min(axis=0), records.max(axis=0)], axis=1)
        size = np.ptp(expected, axis=1).max()
        found = getattr(few, f"{name}_range")
        assert found == pytest.approx(getattr(every, f"{name}_range"), rel=1e-12)
        # Between steps lies more than at them, by the square of the step at most.
        beyond = (found - expected) * [-1.0, 1.0]
        assert -1e-12 * size < beyond.min() <= beyond.max() < 0.01 * size
    assert np.ptp(few.approach[few.counted], axis=0).max() < 0.999 * np.ptp(few.approach_range, axis=1).max()


def test_where_only_torsion_moves_transmission_error_and_approach_are_one() -> None:
    model = spur_pair(motions=["torsion"])
    result = rg.transient(model, time=0.01, discard=0.0, steps=60, elements=1, method="newmark", error_estimate=False)
    assert np.ptp(result.approach) > 1e-6
    assert result.transmission_error == pytest.approx(result.approach, abs=1e-9 * np.ptp(result.approach))
