"""Lyapunov exponents of Lorenz's equations, of an oscillator, and of orbits with backlash."""

from __future__ import annotations

from fractions import Fraction
from functools import cache

import numpy as np

from rotorgear.analysis.sweep.classify import exponents
from rotorgear.analysis.sweep.point import at_rest, ready, table_of
from rotorgear.forces.mesh_contact import MeshContact
from rotorgear.forces.rotating_force import RotatingForce
from rotorgear.solvers.batch.flow_exponents import flow_exponents
from rotorgear.solvers.batch.run_block import BatchPlan, Start, run_block
from validation.oscillators import local_system

# zeta, mean force, its amplitude, frequency, backlash, state at phase 0, steps a period, periods that settle and count.
ORBITS = {
    "oscillator": (0.05, 0.0, 0.1, 0.8, False, (0.1, 0.0), 50, 100, 3000),
    "linear": (0.05, 0.1, 0.05, 0.5, True, (1.16637168142, 0.00221238938), 200, 40, 400),
    "one-sided": (0.05, 0.1, 0.05, 0.8, True, (0.73407845091, 0.09773807864), 400, 40, 400),
    "doubled": (0.05, 0.1, 0.2, 1.5, True, (0.9588, 0.2441), 200, 400, 400),
    "chaotic": (0.05, 0.1, 0.8, 1.1, True, (0.5, 0.0), 200, 200, 500),
}
_LANES = 16


def measure(quantity: str, mode: str) -> float:
    """Exponent number `mode` of what `quantity` names, or their "sum", per unit time."""
    found = _lorenz() if quantity == "Lorenz" else _orbit(quantity)
    return float(found.sum() if mode == "sum" else found[int(mode) - 1])


@cache
def _lorenz() -> np.ndarray:
    def slope(y: np.ndarray) -> np.ndarray:
        a, b, c = y.T
        return np.stack([10.0 * (b - a), a * (28.0 - c) - b, a * b - 8.0 / 3.0 * c], axis=1)

    def jacobian(y: np.ndarray) -> np.ndarray:
        a, b, c = y.T
        one = np.ones_like(a)
        rows = [[-10.0 * one, 10.0 * one, 0.0 * one], [28.0 - c, -one, -a], [b, a, -8.0 / 3.0 * one]]
        return np.moveaxis(np.array(rows), 2, 0)

    states = np.array([1.0, 1.0, 20.0]) + np.random.default_rng(3).standard_normal((60, 3))
    return flow_exponents(slope, jacobian, states, 0.01, discard=2000, sample=6000)[0]


@cache
def _orbit(name: str) -> np.ndarray:
    """Both exponents, as the mean over several starts near each other."""
    zeta, mean, amplitude, frequency, parts, (x0, v0), steps, settle, count = ORBITS[name]
    contact = MeshContact(1.0, backlash=2.0, error_mean=1.0) if parts else MeshContact(1.0, gap="bilateral")
    laws = [(contact, [[1.0]]), (RotatingForce(amplitude), [[1.0]])]
    system = local_system([[1.0]], [[2.0 * zeta]], [[0.0]], [mean], laws, speed=frequency)
    point = ready(at_rest(system, [Fraction(1)], (name,)), frequency)
    starts = [Start(np.array([x0 * (1.0 + 1e-3 * i)]), np.array([v0 / frequency])) for i in range(_LANES)]
    orbits = run_block([point.system] * _LANES, starts, [table_of(point, steps)], BatchPlan(steps, settle, count, 2))
    rates = [exponents(orbit.growth, 2.0 * np.pi / frequency)[0] for orbit in orbits]
    return np.asarray(np.mean(rates, axis=0))
