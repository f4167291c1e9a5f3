"""Forces in rigid directions of bearings as a structure moves: what is missing for equilibrium without these conditions,

    F = P (f - M E a - (D + W G) E v - (K + N) E q),

with the matrices and loads of the `released` system, whose dofs are E q, and P that finds F from what acts through conditions.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from rotorgear.system.internal_loads import LoadRows
from rotorgear.system.system import System


def rigid_rows(system: System, speed: float = 0.0) -> LoadRows:
    """Rows (p, n) of the forces of all rigid directions of bearings, at a reference speed in rad/s; loads act beside them."""
    free = system.released
    P = from_loads(system)

    def rows(A: sp.csc_array) -> np.ndarray:
        return -np.asarray((P @ A) @ system.followers)

    still = free.circulatory(speed)
    # With tables nothing is asked for beside this speed.
    grown = free.circulatory(speed + 1.0) - still if not free.has_tables else sp.csc_array(still.shape)
    return LoadRows(
        q=rows(free.stiffness(speed) + still),
        v=rows(free.damping(speed) + speed * free.gyroscopic),
        a=rows(free.mass),
        weight=np.zeros(len(P)),
        per_speed=(rows(grown), rows(free.gyroscopic)),
    )


def from_loads(system: System) -> np.ndarray:
    """P (p, b) of these directions: their forces by loads on the dofs of the released system, which rest."""
    return system.conditions.from_missing[system.conditions.of_bearings]


def on_shafts(system: System) -> list[tuple[str, int]]:
    """Name of the bearing and number of the direction of each of them; the force on the shaft is -F along it."""
    kept = system.conditions
    return [(kept.parts[k].removeprefix("bearings."), kept.components[k]) for k in kept.of_bearings]
