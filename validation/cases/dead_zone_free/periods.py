"""Free vibration through a dead zone: periods and energy."""

from __future__ import annotations

from functools import cache

import numpy as np

from rotorgear.forces.mesh_contact import MeshContact
from validation.oscillators import crossings, integrate, local_system, order

_PERIODS = 10
# No whole number of steps makes a period, so that the kinks lie at another place of the step each time.
_SHIFT = 0.382
# Kink inside of the motion: (force, start, exact period, law).
_A = 1.25
_F = 0.5
_V = np.sqrt(_A**2 - _F**2)
_CASES = {
    "centred": (0.0, 3.0, 2.0 * np.pi + 2.0, MeshContact(1.0, backlash=2.0, error_mean=1.0)),
    "preloaded": (_F, _F + _A, 2.0 * _V / _F + 2.0 * np.pi - 2.0 * np.arccos(_F / _A), MeshContact(1.0, backlash=1e3)),
}


def measure(quantity: str, mode: str) -> float:
    """Period with so many steps in it, mean order of its error from 1000 to 8000 steps, or what energy does in 100 periods."""
    case, _, rest = mode.partition(", ")
    method, _, steps = rest.partition(", ")
    if quantity == "period":
        return _period(case, method, int(steps))
    if quantity == "order of the period":
        counts = np.geomspace(1000, 8000, 9).astype(int).tolist()
        return order(counts, [abs(_period(case, method, n) / _CASES[case][2] - 1.0) for n in counts])
    energy = _energy(case, method, int(steps))
    change = energy / energy[0] - 1.0
    if quantity == "largest change of energy":
        return float(np.abs(change).max())
    means = [part.mean() for part in np.array_split(change, 100)]
    return abs(float(np.polyfit(np.arange(100), means, 1)[0]))


def _run(case: str, method: str, steps: int, periods: float):  # type: ignore[no-untyped-def]
    force, start, exact, law = _CASES[case]
    system = local_system([[1.0]], [[0.0]], [[0.0]], [force], [(law, [[1.0]])])
    return integrate(system, method, exact / (steps + _SHIFT), int(periods * (steps + _SHIFT)), [start], [0.0])


@cache
def _period(case: str, method: str, steps: int) -> float:
    motion = _run(case, method, steps, _PERIODS + 0.3)
    return float(crossings(motion.t, motion.q[:, 0], motion.v[:, 0])[_PERIODS - 1] / _PERIODS)


@cache
def _energy(case: str, method: str, steps: int) -> np.ndarray:
    motion = _run(case, method, steps, 100.0)
    return np.asarray(0.5 * motion.v[:, 0] ** 2 + motion.stored - _CASES[case][0] * motion.q[:, 0])
