"""Static equilibrium with local forces: where a time integration starts.

About the reference stiffness k, q = q0 + X (k d - F(d)) with X = (K + B k B^T)^-1 B, so d - d0 + A (F(d) - k d) = 0,
A = B^T X, which Newton's method solves on m unknowns.
What the loads do on free motions R is carried by inertia: f - M R (R^T M R)^-1 R^T f.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from rotorgear.solvers.eigen.eigen import lowest_modes
from rotorgear.solvers.sparse.nullspace import SupportedSolver, left_null_space
from rotorgear.solvers.time.local_forces import LocalLaw, gather
from rotorgear.solvers.time.local_system import LocalSystem, local_tangent, local_values

_ITERATIONS = 80
_TOLERANCE = 1e-10
# Iterations in a row that do not bring the residual down: all contacts are open, say, and nothing says where to go.
_STUCK = 3


@dataclass(frozen=True)
class Equilibrium:
    """A static state.

    Attributes:
        q: displacements (n,), M-orthogonal to the free motions.
        converged: whether all local forces are in equilibrium there; if not, q is that with the reference stiffness.
        free: R (n, r), M-orthonormal motions without stiffness.
        drift: (r,) acceleration of each free motion under the loads, 0 where they balance.
    """

    q: np.ndarray
    converged: bool
    free: np.ndarray
    drift: np.ndarray


def free_motions(M: sp.csc_array, K: sp.csc_array) -> np.ndarray:
    """M-orthonormal motions (n, r) without strain; symmetric part of K only."""
    symmetric = sp.csc_array(0.5 * (K + K.T))
    count = min(M.shape[0], 8)
    while True:
        found = lowest_modes(M, symmetric, count=count)
        if found.rigid_count < count or count == M.shape[0] or found.complete:
            return np.asarray(found.vectors[:, : found.rigid_count])
        count = min(2 * count, M.shape[0])


def equilibrium(system: LocalSystem, free: np.ndarray | None = None) -> Equilibrium:
    """Return the static state at t = 0, at rest relative to the prescribed rotation; `free`: its free motions, where known."""
    K = system.stiffness_about
    M = system.M
    R = free_motions(M, K) if free is None else free
    B = system.B.toarray()
    solver = SupportedSolver(K, R * np.sqrt(np.maximum(K.diagonal(), 1e-300))[:, None], left_null_space(K, M, R))

    def settled(f: np.ndarray) -> np.ndarray:
        q = solver.solve(f - M @ (R @ (R.T @ f)))
        return np.asarray(q - R @ (R.T @ (M @ q)))

    q0 = settled(system.load)
    X = settled(B) if system.m else np.zeros((system.n, 0))
    linear = np.asarray(B.T @ q0)
    A = B.T @ X
    d, F, converged = _local(system, linear, A, linear)
    if not converged:  # within a gap nothing says where to go
        d, F, converged = _local(system, linear, A, _beyond_gaps(system, linear))
    if not converged:
        return Equilibrium(q0, False, R, R.T @ system.load)
    pushed = system.forces.reference_stiffness @ d - F
    return Equilibrium(q0 + X @ pushed, True, R, R.T @ (system.load - B @ F))


def still_forces(system: LocalSystem, laws: tuple[LocalLaw, ...], free: np.ndarray | None = None) -> np.ndarray:
    """Local forces (m,) in the equilibrium with laws in place of the system's own; NaN where there is none.

    The free motions of the system serve where they are known and the laws have its reference stiffness.
    """
    still = replace(system, forces=gather(laws))
    same = np.array_equal(still.forces.reference_stiffness, system.forces.reference_stiffness)
    rest = equilibrium(still, free if same else None)
    if not rest.converged:
        return np.full(system.m, np.nan)
    return local_values(still, rest.q, np.zeros(still.n), 0.0)[0]


def _beyond_gaps(system: LocalSystem, d0: np.ndarray) -> np.ndarray:
    """Displacements (m,) with the contacts that the loads open on their back flanks."""
    d = d0.copy()
    for law, at in zip(system.forces.laws, system.forces.first, strict=False):
        if getattr(law, "gap", "") == "line" and d0[at] < 0.0:
            d[at] -= law.backlash  # type: ignore[attr-defined]
    return d


def _local(
    system: LocalSystem, d0: np.ndarray, A: np.ndarray, start: np.ndarray
) -> tuple[np.ndarray, np.ndarray, bool]:
    """Newton's method for d - d0 + A (F(d) - k d) = 0 with a shortened step where a full one does not bring it down."""
    k = system.forces.reference_stiffness
    d = start.copy()

    def residual(d: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        F, Kd = local_tangent(system, d, 0.0)
        return d - d0 + A @ (F - k @ d), F, Kd

    r, F, Kd = residual(d)
    stuck = 0
    for _ in range(_ITERATIONS):
        size = np.abs(d0).max(initial=0.0) + np.abs(A @ F).max(initial=0.0)
        if not np.all(np.isfinite(r)):
            break
        if np.abs(r).max(initial=0.0) <= _TOLERANCE * size:
            return d, F, True
        step = np.linalg.lstsq(np.eye(d.size) + A @ (Kd - k), -r, rcond=1e-14)[0]
        share = 1.0
        while True:
            trial = d + share * step
            r_new, F_new, Kd_new = residual(trial)
            if np.linalg.norm(r_new) < (1.0 - 1e-4 * share) * np.linalg.norm(r) or share < 1e-3:
                break
            share *= 0.5
        stuck = stuck + 1 if np.linalg.norm(r_new) > (1.0 - 1e-6) * np.linalg.norm(r) else 0
        d = trial
        r = r_new
        F = F_new
        Kd = Kd_new
        if stuck == _STUCK:
            break
    return d0, local_tangent(system, d0, 0.0)[0], False
