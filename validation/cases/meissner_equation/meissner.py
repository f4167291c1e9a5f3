"""Growth of a free vibration whose stiffness jumps between two values (Meissner's equation)."""

from __future__ import annotations

from functools import cache

import numpy as np

from rotorgear.forces.mesh_contact import MeshContact
from validation.oscillators import integrate, local_system, order

_EXACT = {"2, 0.5, 0": 1.2208951442, "1, 0.5, 0": 1.0558514244, "2, 0.5, 0.03": 1.1111552}
_PERIODS = 160


def measure(quantity: str, mode: str) -> float:
    """Growth in a period with 1000 steps, or its mean order from 250 to 2000 steps; `mode`: W, duty, zeta; method."""
    setting, method = mode.split("; ")
    if quantity == "growth in a period":
        return _growth(setting, method, 1000)
    counts = [250, 500, 1000, 2000]
    return order(counts, [abs(_growth(setting, method, n) / _EXACT[setting] - 1.0) for n in counts])


@cache
def _growth(setting: str, method: str, steps: int) -> float:
    frequency, duty, zeta = map(float, setting.split(", "))
    law = MeshContact(1.0, gap="bilateral", order=1.0, pieces=((0.0, 1.2, 1.2), (duty, 0.8, 0.8)))
    system = local_system([[1.0]], [[2.0 * zeta]], [[0.0]], [0.0], [(law, [[1.0]])], speed=frequency)
    motion = integrate(system, method, 2.0 * np.pi / frequency / steps, _PERIODS * steps, [1.0], [0.3], every=steps)
    size = np.hypot(motion.q[:, 0], motion.v[:, 0])
    return float(size[-1] / size[-2])
