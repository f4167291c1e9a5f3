"""Static equilibrium with local forces: where a time integration starts.

Newton's method on the m local displacements about the reference stiffness of the laws (solvers/sparse/newton.py).
What the loads do on free motions R is carried by inertia: f - M R (R^T M R)^-1 R^T f.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from rotorgear.solvers.eigen.eigen import lowest_modes
from rotorgear.solvers.sparse.newton import settle
from rotorgear.solvers.sparse.nullspace import SupportedSolver, in_comparable_units, left_null_space
from rotorgear.solvers.time.local_forces import LocalLaw, gather
from rotorgear.solvers.time.local_system import LocalSystem, local_tangent


@dataclass(frozen=True)
class Equilibrium:
    """A static state.

    Attributes:
        q: displacements (n,), M-orthogonal to the free motions.
        converged: whether all local forces are in equilibrium there; if not, q is that with the reference stiffness.
        free: R (n, r), M-orthonormal motions without stiffness.
        drift: (r,) acceleration of each free motion under the loads, 0 where they balance.
        force: (m,) local forces; of stiff laws, with more digits than their displacements among q would give.
    """

    q: np.ndarray
    converged: bool
    free: np.ndarray
    drift: np.ndarray
    force: np.ndarray


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
    solver = SupportedSolver(K, in_comparable_units(R, K, M), left_null_space(K, M, R))

    def settled(f: np.ndarray) -> np.ndarray:
        q = solver.solve(f - M @ (R @ (R.T @ f)))
        return np.asarray(q - R @ (R.T @ (M @ q)))

    q0 = settled(system.load)
    X = settled(B) if system.m else np.zeros((system.n, 0))
    forces = system.forces
    k = forces.reference_stiffness
    found = settle(np.asarray(B.T @ q0), B.T @ X, k, lambda d: local_tangent(system, d, 0.0), extents=forces.extents)
    if not found.converged:
        return Equilibrium(q0, False, R, R.T @ system.load, found.force)
    q = q0 + X @ (k @ found.d - found.force)
    return Equilibrium(q, True, R, R.T @ (system.load - B @ found.force), found.force)


def still_forces(system: LocalSystem, laws: tuple[LocalLaw, ...], free: np.ndarray | None = None) -> np.ndarray:
    """Local forces (m,) in the equilibrium with laws in place of the system's own; NaN where there is none.

    `free`: the free motions of the system, where they are known. Both are expanded about the same stiffness, on which nothing
    depends.
    """
    forces = replace(gather(laws), reference_stiffness=system.forces.reference_stiffness)
    rest = equilibrium(replace(system, forces=forces), free)
    return rest.force if rest.converged else np.full(system.m, np.nan)
