"""Sensors along a pinned beam: where they tell sines apart best, and which sines they take for each other."""

from __future__ import annotations

from functools import cache

import numpy as np

import rotorgear as rg

LENGTH = 2.0
DIAMETER = 0.02
E = 210e9
DENSITY = 7850.0
# Places for sensors are those of massless collars, so many in all.
PLACES = 39


def measure(quantity: str, mode: str) -> float:
    """A place over the length, or a MAC."""
    if quantity.startswith("place of sensor"):
        count = int(quantity.split()[-1])
        return float(places(count)[int(mode) - 1])
    first, second = (int(number) for number in mode.split("-"))
    if quantity == "MAC among modes at 4 sensors":
        found = comparison()
        return float(found.model_auto_mac[of_sine(first), of_sine(second)])
    if quantity == "MAC of a sine and a mode":
        return float(comparison().mac[first - 1, of_sine(second)])
    raise ValueError(quantity)


def beam(collars: int) -> rg.Model:
    """A thin beam, pinned along x and free along y, with collars that divide it evenly."""
    at = [LENGTH * k / (collars + 1) for k in range(1, collars + 1)]
    pinned = {"shaft": "beam", "stiffness": {"x": 1e12}}
    return rg.Model(
        motions=["bending"],
        materials={"steel": {"youngs_modulus": E, "poisson_ratio": 0.3, "density": DENSITY}},
        shafts={
            "beam": {
                "material": "steel",
                "shear_deformation": False,
                "sections": [{"length": LENGTH, "outer_diameter": DIAMETER}],
            }
        },
        bearings={"left": {**pinned, "at": "start"}, "right": {**pinned, "at": "end"}},
        disks={
            f"collar_{k}": {
                "shaft": "beam",
                "at": z,
                "mass": 1e-9,
                "polar_inertia": 1e-15,
                "diametral_inertia": 1e-15,
            }
            for k, z in enumerate(at, start=1)
        },
    )


def sine_hz(k: int) -> float:
    """Natural frequency of the k-th sine in Hz: (k pi / L)^2 sqrt(E I / rho A) / 2 pi, with I / A = d^2 / 16."""
    return float((k * np.pi / LENGTH) ** 2 * np.sqrt(E / DENSITY) * DIAMETER / 4.0 / (2.0 * np.pi))


@cache
def places(count: int) -> np.ndarray:
    """Places over the length of so many sensors for so many sines, ascending."""
    plan = rg.sensors(
        beam(PLACES), count=count, fmax=1.2 * sine_hz(count), candidates="disks.*", directions="x", elements=1
    )
    return np.sort([sensor.position[2] for sensor in plan.sensors]) / LENGTH


@cache
def comparison() -> rg.ShapeComparison:
    """Sines as measured shapes at four collars, beside the modes of the beam."""
    model = beam(4)
    points = tuple(f"disks.collar_{k}:x" for k in range(1, 5))
    sines = np.array([[np.sin(k * np.pi * j / 5) for j in range(1, 5)] for k in range(1, 5)])
    lines = tuple(rg.RigLine(sine_hz(k)) for k in range(1, 5))
    return rg.compare_shapes(
        rg.modal(model, fmax=1.1 * sine_hz(7), elements=2), rg.Measured(lines, points, sines.astype(complex)), samples=1
    )


def of_sine(k: int) -> int:
    """Number of the mode that is the k-th sine."""
    return int(np.argmin(np.abs(np.log(comparison().mode_hz / sine_hz(k)))))
