"""Bathe's two masses by the average acceleration method, and what Newmark's methods make of the period of one mass."""

from __future__ import annotations

import numpy as np

from rotorgear.forces.mesh_contact import MeshContact
from validation.oscillators import integrate, local_system

_STEP = 0.28
_STEPS = 12
_METHOD = {"average": "average acceleration", "linear": "linear acceleration"}


def measure(quantity: str, mode: str) -> float:
    """Displacement after a step; frequency ratio w_num/w at w dt; largest change of energy in 1e5 steps."""
    if quantity.startswith("displacement"):
        system = local_system(np.diag([2.0, 1.0]), np.zeros((2, 2)), [[6.0, -2.0], [-2.0, 4.0]], [0.0, 10.0])
        motion = integrate(system, "average acceleration", _STEP, _STEPS, [0.0, 0.0], [0.0, 0.0])
        return float(motion.q[int(mode), int(quantity.split()[-1]) - 1])
    method, step = mode.split(" at ") if " at " in mode else (mode, "0.5")
    # Half of the stiffness as a local force, so that the condensed Newton iteration is in the loop.
    system = local_system([[1.0]], [[0.0]], [[0.5]], [0.0], [(MeshContact(0.5, gap="bilateral"), [[1.0]])])
    long = quantity != "frequency over exact"
    motion = integrate(system, _METHOD[method], float(step), 100_000 if long else 2, [1.0], [0.0])
    q = motion.q[:, 0]
    if not long:
        return float(np.arccos((q[0] + q[2]) / (2.0 * q[1])) / float(step))
    energy = 0.5 * motion.v[:, 0] ** 2 + 0.25 * q**2 + motion.stored
    return float(np.abs(energy[1:] / 0.5 - 1.0).max())
