"""Forced vibration of a gear pair with backlash: period-1 orbits from their exact start."""

from __future__ import annotations

from functools import cache

import numpy as np

from rotorgear.forces.mesh_contact import MeshContact
from rotorgear.forces.rotating_force import RotatingForce
from validation.oscillators import integrate, local_system, order

# zeta, mean force, its amplitude, frequency, and the exact state at phase 0 with xmax, xmin, rms about the mean.
ORBITS = {
    "linear": (0.05, 0.1, 0.05, 0.5, 1.16637168142, 0.00221238938),
    "one-sided": (0.05, 0.1, 0.05, 0.8, 0.73407845091, 0.09773807864),
    "grazing": (0.05, 0.1, 0.05, 1.2, 0.99612216833, 0.03200336833),
    "two-sided": (0.05, 0.1, 0.2, 0.6, 1.70117087596, 1.10566172688),
    "symmetric": (0.05, 0.0, 0.3, 0.5, 1.93094570727, 0.53549018655),
}
_SETTLE = 40


def measure(quantity: str, mode: str) -> float:
    """xmax, xmin or rms of an orbit with so many steps a period; or the mean order of the state after one period."""
    name, method, *steps = mode.split(", ")
    if quantity == "order of the state":
        counts = [200, 400, 800, 1600, 3200]
        return order(counts, [_closure(name, method, n) for n in counts])
    x = _orbit(name, method, int(steps[0]))
    if quantity == "rms":
        return float(np.sqrt(np.mean((x[1:] - x[1:].mean()) ** 2)))
    return float(x.max() if quantity == "xmax" else x.min())


def _run(name: str, method: str, steps: int, periods: int):  # type: ignore[no-untyped-def]
    zeta, mean, amplitude, frequency, x0, v0 = ORBITS[name]
    laws = [(MeshContact(1.0, backlash=2.0, error_mean=1.0), [[1.0]]), (RotatingForce(amplitude), [[1.0]])]
    system = local_system([[1.0]], [[2.0 * zeta]], [[0.0]], [mean], laws, speed=frequency)
    return integrate(system, method, 2.0 * np.pi / frequency / steps, periods * steps, [x0], [v0])


@cache
def _orbit(name: str, method: str, steps: int) -> np.ndarray:
    return np.asarray(_run(name, method, steps, _SETTLE).q[-steps - 1 :, 0])


def _closure(name: str, method: str, steps: int) -> float:
    motion = _run(name, method, steps, 1)
    _, _, _, _, x0, v0 = ORBITS[name]
    return float(np.hypot(motion.q[-1, 0] - x0, motion.v[-1, 0] - v0))
