"""Small systems with local forces for the cases of group D, and their integration by the methods of the package."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp

from rotorgear.forces.law import ForceLaw
from rotorgear.solvers.time.explicit import Explicit
from rotorgear.solvers.time.exponential import Exponential
from rotorgear.solvers.time.local_forces import gather
from rotorgear.solvers.time.local_system import (
    Integrator,
    LocalSystem,
    MotionState,
    Records,
    Rotation,
    local_values,
    state_at_rest,
)
from rotorgear.solvers.time.newmark import Newmark
from rotorgear.solvers.time.run import Schedule, run

METHODS: dict[str, Integrator] = {
    "average acceleration": Newmark(),
    "linear acceleration": Newmark(1.0 / 6.0, 0.5),
    "exponential": Exponential(),
    "generalised alpha": Newmark.generalised_alpha(0.95),
    "hht": Newmark.hht(0.05),
    "explicit": Explicit(),
}


@dataclass(frozen=True)
class Motion:
    """Records of a run with all steps: time (r,), q, v, a (r, n), local forces (r, m), energy of the laws (r,)."""

    t: np.ndarray
    q: np.ndarray
    v: np.ndarray
    a: np.ndarray
    F: np.ndarray
    stored: np.ndarray


def local_system(
    M: Any, D: Any, K: Any, load: Sequence[float], laws: Sequence[tuple[ForceLaw, Any]] = (), speed: float = 0.0
) -> LocalSystem:
    """A system from dense matrices, and laws with their columns (n, k)."""
    M, D, K = (sp.csc_array(np.atleast_2d(np.asarray(A, float))) for A in (M, D, K))
    columns = np.hstack(
        [np.zeros((M.shape[0], 0)), *(np.asarray(column, float).reshape(M.shape[0], -1) for _, column in laws)]
    )
    forces = gather(tuple(law for law, _ in laws))
    return LocalSystem(M, D, K, sp.csc_array(columns), forces, np.array(load, float), Rotation.constant(speed))


def integrate(
    system: LocalSystem,
    method: str | Integrator,
    h: float,
    steps: int,
    q0: Sequence[float],
    v0: Sequence[float],
    every: int = 1,
) -> Motion:
    """Run from a state and keep every `every`-th step, with the start as the first record."""
    integrator = METHODS[method] if isinstance(method, str) else method
    state = state_at_rest(system, h, np.array(q0, float), np.array(v0, float))
    n = system.n
    found = [
        (
            np.zeros(1),
            state.q[None].copy(),
            state.v[None].copy(),
            state.a[None].copy(),
            state.F[None].copy(),
            _stored(system, state),
        )
    ]

    def keep(records: Records, _: MotionState) -> None:
        rows = [records.rows(kind, np.eye(n)) for kind in "qva"]
        found.append((records.t, *rows, records.F, records.energy[:, :, 0].sum(axis=1)))

    run(system, integrator, Schedule(h, steps, every), state, keep, tolerance=1e-13)
    return Motion(*(np.concatenate(parts) for parts in zip(*found, strict=True)))


def _stored(system: LocalSystem, state: MotionState) -> np.ndarray:
    return local_values(system, state.q, state.v, 0.0)[1].reshape(-1, 4)[:, 0].sum(keepdims=True)


def crossings(t: np.ndarray, x: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Times of the maxima of x: where v falls through zero, from the cubic through v and its slope at both sides."""
    i = np.flatnonzero((v[:-1] > 0.0) & (v[1:] <= 0.0))
    return np.asarray(t[i] + (t[i + 1] - t[i]) * v[i] / (v[i] - v[i + 1]))


def order(steps: Sequence[int], errors: Sequence[float]) -> float:
    """Mean order of errors over numbers of steps: the slope of a line through their logarithms."""
    return -float(np.polyfit(np.log(steps), np.log(np.maximum(errors, 1e-300)), 1)[0])
