"""The trajectory of one small system, trajectory within its periods."""

from __future__ import annotations

import numpy as np

from rotorgear.solvers.batch.arguments import ColumnValues, PathSpan, PathSystem
from rotorgear.solvers.batch.columns import NEVER
from rotorgear.solvers.batch.own_laws import acting_laws
from rotorgear.solvers.batch.run_block import Start
from rotorgear.solvers.batch.small_system import SmallSystem


def trajectory(
    system: SmallSystem, start: Start, table: np.ndarray, steps: int, periods: int, every: int = 1, begun: int = 0
) -> np.ndarray:
    """Run on from a state over common periods, by the steps of `run_block`.

    Args:
        table: of what depends on time, (2 turns steps + 1, m, 4).
        steps: in a period of the fastest excitation. periods: common ones. every: steps between two records.
        begun: common periods before the start, for laws that go on from one to the next, such as rolling elements.

    Returns:
        Displacement in m, velocity in m/s and force in N of each local displacement, (periods turns steps / every, m, 3); the
        first record is the state to start from.

    Raises:
        ValueError: `every` does not divide the steps of a common period.
    """
    from rotorgear.solvers.batch.kernel_trajectory import trajectory

    length, rest = divmod(system.turns * steps, every)
    if rest:
        raise ValueError(f"{system.turns * steps} steps in a common period are no multiple of {every}")
    c = system.columns
    out = np.empty((periods * length, c.kind.size, 3))
    state = np.concatenate([start.z, start.dz])
    trajectory(
        PathSpan(steps, every, begun * system.turns * steps),
        PathSystem(*(np.ascontiguousarray(x, dtype=float) for x in (system.K, system.D, system.B, system.load))),
        ColumnValues(c.kind, c.mode, c.jumps, c.counted, bool(np.any(c.jumps != NEVER)), c.values),
        np.ascontiguousarray(table),
        acting_laws(system.own, system.own.forces.parameters, np.array([system.own.turn, system.w])),
        state,
        out,
    )
    return out * np.array([1.0, system.w, system.w**2])
