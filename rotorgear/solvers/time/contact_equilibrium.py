"""Static equilibrium with local forces: where a time integration starts.

Newton's method on the m local displacements about the reference stiffness of the laws (solvers/sparse/newton.py).
What the loads do on free motions R is carried by inertia: f - M R (R^T M R)^-1 R^T f.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from rotorgear.solvers.eigen.eigen import lowest_modes
from rotorgear.solvers.sparse.newton import local_equilibrium
from rotorgear.solvers.sparse.nullspace import in_comparable_units, inertia_relief, support_dofs
from rotorgear.solvers.time.local_forces import LocalLaw
from rotorgear.solvers.time.local_system import LocalSystem, local_tangent

# What of the loads on a free motion may be left, relative to the sum of their absolute parts: torques come with six digits.
_BALANCED = 1e-6
# The same of all loads on a motion that they hardly touch: rounding of the motion.
_TOUCHED = 1e-8
# By how much a displacement is changed to see whether a law answers to it, m or rad.
FAR = 1e-2


@dataclass(frozen=True)
class Equilibrium:
    """A static state.

    Attributes:
        q: displacements (n,), M-orthogonal to the free motions.
        converged: whether all local forces are in equilibrium there; if not, q is that with the reference stiffness.
        free: R (n, r), M-orthonormal motions without stiffness.
        force: (m,) local forces; of stiff laws, with more digits than their displacements among q would give.
    """

    q: np.ndarray
    converged: bool
    free: np.ndarray
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


def held_and_unheld(seen: np.ndarray, free: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Motions without strain `free` (n, r) in two sets: what moves the places `seen` (a, r) along them, and what does not."""
    _, sizes, right = np.linalg.svd(seen)
    held = int(np.count_nonzero(sizes > 1e-9 * max(1e-300, float(np.linalg.norm(free)))))
    return free @ right[:held].T, free @ right[held:].T


def equilibrium(system: LocalSystem, free: np.ndarray | None = None) -> Equilibrium:
    """Return the static state at t = 0, at rest relative to the prescribed rotation; `free`: its free motions, where known."""
    K = system.stiffness_about
    M = system.M
    R = free_motions(M, K) if free is None else free
    B = system.B.toarray()
    static = inertia_relief(K, M, R)
    q0 = static(system.load)
    X = static(B) if system.m else np.zeros((system.n, 0))
    forces = system.forces
    k = forces.reference_stiffness
    found = local_equilibrium(
        np.asarray(B.T @ q0), B.T @ X, k, lambda d: local_tangent(system, d, 0.0), extents=forces.extents
    )
    q = q0 + X @ (k @ found.d - found.force) if found.converged else q0
    return Equilibrium(q, found.converged, R, found.force)


def forces_at_rest(system: LocalSystem, laws: tuple[LocalLaw, ...], free: np.ndarray | None = None) -> np.ndarray:
    """Local forces (m,) in the equilibrium with laws in place of the system's own; NaN where there is none.

    `free`: the free motions of the system, where they are known. Both are expanded about the same stiffness, on which nothing
    depends.
    """
    found = equilibrium(replace(system, forces=system.forces.with_laws(laws)), free)
    return found.force if found.converged else np.full(system.m, np.nan)


def unbalanced(system: LocalSystem, R: np.ndarray, force: np.ndarray | None = None) -> bool:
    """Whether loads push a motion that nothing holds: the one criterion, of all analyses in time.

    Each motion moves one body by 1, and what has to follow; the work of the loads on it is compared with the sum of its
    absolute parts. Where no load meets a motion, it balances. Local forces with a reference stiffness are inner ones.

    Args:
        system: with its loads.
        R: (n, r), a basis of its motions without strain.
        force: (m,), local forces; None: the mean ones, of what pulses in time its mean.
    """
    if not R.shape[1]:
        return False
    if force is None:
        force, _ = local_tangent(replace(system, forces=system.forces.mean), np.zeros(system.m), 0.0)
    units = in_comparable_units(np.ones((system.n, 1)), system.stiffness_about, system.M)
    motions = R * units
    motions = motions @ np.linalg.inv(motions[support_dofs(motions)])
    outer = ~np.any(system.forces.reference_stiffness, axis=1)
    loads = np.column_stack([system.load, -system.B[:, outer].toarray() * force[outer]]) / units
    rounding = _TOUCHED * float(np.linalg.norm(loads))
    work = np.abs((motions.T @ loads).sum(axis=1))
    return bool(np.any(work > _BALANCED * (np.abs(motions.T) @ np.abs(loads)).sum(axis=1) + rounding))
