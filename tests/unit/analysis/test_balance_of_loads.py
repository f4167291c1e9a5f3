"""Loads inside shafts at 50 random places, read on both sides of each: equal to rounding where nothing acts, in all analyses."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from tests.unit.analysis.response.test_internal_loads import shaken
from tests.unit.analysis.static.test_internal_loads import SIX, read_everywhere
from tests.unit.analysis.static.test_static import data_of

SIDES = ("left", "right")
SPEED = 311.0
HZ = np.array([170.0, 990.0])


def between(rng: np.random.Generator, first: float, last: float) -> np.ndarray:
    """25 random places, one in each of 25 even stretches, none at the end of its own: no element is so short that rounding of a
    motion, or the steps that follow it, are those of that element."""
    return first + (np.arange(25) + rng.uniform(0.1, 0.9, 25)) * (last - first) / 25.0


@cache
def geared(in_time: bool = False) -> rg.Model:
    """A helical pair on stepped and tapered shafts, shaken by all that can, with six loads on both sides of 50 places."""
    data = shaken()
    data["damping"] = {"rayleigh_alpha": 3.0, "rayleigh_beta": 2e-6}
    rng = np.random.default_rng(23)
    ends = (("input", -0.15, 0.08), ("output", -0.08, 0.15))
    places = [
        (shaft, float(z))
        for shaft, first, last in ends
        for z in (between(rng, first, last) if in_time else rng.uniform(first, last, 25))
    ]
    points = {}
    for side in SIDES:
        read = read_everywhere({**data, "points": {}}, places, side=side)
        points |= {f"{side}_{name}": point for name, point in read.points.items()}
    return rg.Model(**{**data, "points": {**data.get("points", {}), **points}})


NAMES = [[f"{side}_{n}_{quantity}_{axis}" for n in range(50) for quantity, axis in SIX] for side in SIDES]


def apart(loads: np.ndarray) -> float:
    """Largest difference of loads (2, ..., 300) on both sides, relative to the largest force or moment."""
    loads = loads.reshape(*loads.shape[:-1], 50, 6)
    off, size = (np.abs(x).reshape(-1, 50, 6).max(axis=(0, 1)) for x in (loads[0] - loads[1], loads[0]))
    kinds = (slice(0, 3), slice(3, 6))
    assert all(size[kind].min() > 0.0 for kind in kinds)
    return max(float(off[kind].max() / size[kind].max()) for kind in kinds)


def test_responses() -> None:
    result = rg.response(geared(), speeds=[200.0, SPEED], elements=1, method="direct")
    at = np.array([[result.load_points.index(name) for name in names] for names in NAMES])
    assert apart(np.moveaxis(result.internal_load[:, :, at], 2, 0)) < 1e-9


@pytest.mark.long
def test_frequency_responses_and_state_spaces() -> None:
    names = [*NAMES[0], *NAMES[1]]
    options: dict[str, Any] = {"inputs": ["housing_input"], "outputs": names, "elements": 1, "speed": SPEED}
    whole = rg.frf(geared(), HZ, **options).receptance
    space = rg.state_space(geared(), fmax=1000.0, full=True, **options).receptance(HZ)
    for found in (whole, space):
        assert apart(np.moveaxis(found[:, :, 0].reshape(len(HZ), 2, 300), 1, 0)) < 1e-9


@pytest.mark.long
def test_motions_in_time() -> None:
    options: dict[str, Any] = {"time": "0.4 ms", "discard": "0 ms", "steps": 20, "error_estimate": False}
    result = rg.transient(geared(in_time=True), method="exponential", elements=1, **options)
    values = [[result.history(f"points.{name} {name.split('_')[2]}") for name in names] for names in NAMES]
    assert apart(np.moveaxis(np.array(values), 1, 2)) < 1e-9


@cache
def rods() -> rg.Model:
    """Two stepped rods in torsion with a spur pair that parts, and torques on both sides of 50 places."""
    data = data_of("backlash_pair")
    sections = [{"length": 0.4, "outer_diameter": 0.05}, {"length": 0.3, "outer_diameter": 0.04}]
    data["shafts"] = {name: {"sections": sections} for name in "ab"}
    data["disks"] = {name: {"shaft": name, "at": "end", "polar_inertia": 0.01} for name in "ab"}
    data["damping"] = {"rayleigh_alpha": 20.0}
    rng = np.random.default_rng(5)
    places = {shaft: between(rng, 0.0, 0.7) for shaft in "ab"}
    data["points"] = {
        f"{side}_{shaft}{n}": {"shaft": shaft, "at": float(z), "quantity": "torque", "side": side}
        for side in SIDES
        for shaft in "ab"
        for n, z in enumerate(places[shaft])
    }
    return rg.Model(**data)


@pytest.mark.parametrize("analysis", ["sweep", pytest.param("orbits", marks=pytest.mark.long)])
def test_motions_that_settle(analysis: str) -> None:
    if analysis == "sweep":
        found = rg.sweep(rods(), {"operation.speed": ["9000 rpm"]}, discard=3, sample=2, exponents=0, elements=1)
        loads = found.load_statistics[0, 0]
    else:
        found = rg.orbits(rods(), {"operation.speed": "9000 rpm:9001 rpm"}, step=0.5, elements=1)
        loads = found.load_statistics[0]
    left, right = loads.reshape(2, 50, 4)
    assert np.ptp(left[:, 1]) > 1e-3
    np.testing.assert_allclose(left, right, rtol=0.0, atol=1e-9 * np.abs(left).max())
