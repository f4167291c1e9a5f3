"""Static equilibrium with local forces: where a time integration starts.

Newton's method on the m local displacements about the reference stiffness of the laws (solvers/sparse/newton.py).
What the loads do on free motions R is carried by inertia: f - M R (R^T M R)^-1 R^T f.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from rotorgear.solvers.eigen.eigen import lowest_modes
from rotorgear.solvers.sparse.newton import local_equilibrium
from rotorgear.solvers.sparse.nullspace import in_comparable_units, inertia_relief, support_dofs
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


class Expanded:
    """A system about the reference stiffness of its laws, made ready for any loads, and any laws of that reference.

    Args:
        system: M, K, B and the reference stiffness. free: its free motions (n, r), where they are known.
    """

    def __init__(self, system: LocalSystem, free: np.ndarray | None = None) -> None:
        self._about = system.M, system.stiffness_about
        self.free = free_motions(*self._about) if free is None else free
        self._static = inertia_relief(system.stiffness_about, system.M, self.free)
        self._B = B = system.B.toarray()
        self._X = self._static(B) if system.m else np.zeros((system.n, 0))
        self._A = B.T @ self._X

    def equilibrium(self, system: LocalSystem) -> Equilibrium:
        """The static state of a system with these matrices at t = 0, at rest relative to the prescribed rotation."""
        q0 = self._static(system.load)
        k = system.forces.reference_stiffness
        found = local_equilibrium(
            np.asarray(self._B.T @ q0),
            self._A,
            k,
            lambda d: local_tangent(system, d, 0.0),
            extents=system.forces.extents,
        )
        q = q0 + self._X @ (k @ found.d - found.force) if found.converged else q0
        return Equilibrium(q, found.converged, self.free, found.force)

    @cached_property
    def separate(self) -> Separate:
        """The free motions, body by body."""
        return separate_motions(self._about, self.free)


# Free motions (n, r) of one body by 1 each, with what has to follow, in comparable units, and these units (n, 1).
Separate = tuple[np.ndarray, np.ndarray]


def separate_motions(about: tuple[sp.csc_array, sp.csc_array], R: np.ndarray) -> Separate:
    """The motions R (n, r) without strain of mass and stiffness (n, n), body by body."""
    M, K = about
    units = in_comparable_units(np.ones((len(R), 1)), K, M)
    motions = R * units
    return motions @ np.linalg.inv(motions[support_dofs(motions)]), units


def equilibrium(system: LocalSystem, free: np.ndarray | None = None) -> Equilibrium:
    """Return the static state at t = 0, at rest relative to the prescribed rotation; `free`: its free motions, where known."""
    return Expanded(system, free).equilibrium(system)


def unbalanced(
    system: LocalSystem, R: np.ndarray, force: np.ndarray | None = None, separate: Separate | None = None
) -> bool:
    """Whether loads push a motion that nothing holds: the one criterion, of all analyses in time.

    Each motion moves one body by 1, and what has to follow; the work of the loads on it is compared with the sum of its
    absolute parts. Where no load meets a motion, it balances. Local forces with a reference stiffness are inner ones.

    Args:
        system: with its loads.
        R: (n, r), a basis of its motions without strain.
        force: (m,), local forces; None: the mean ones, of what pulses in time its mean.
        separate: the motions body by body, where they are known.
    """
    if not R.shape[1]:
        return False
    if force is None:
        force, _ = local_tangent(replace(system, forces=system.forces.mean), np.zeros(system.m), 0.0)
    motions, units = separate or separate_motions((system.M, system.stiffness_about), R)
    outer = ~np.any(system.forces.reference_stiffness, axis=1)
    # Without laws of that kind there is nothing to pick out of B, which takes longer than all the rest.
    laws = -system.B[:, outer].toarray() * force[outer] if outer.any() else np.zeros((system.n, 0))
    loads = np.column_stack([system.load, laws]) / units
    rounding = _TOUCHED * float(np.linalg.norm(loads))
    work = np.abs((motions.T @ loads).sum(axis=1))
    return bool(np.any(work > _BALANCED * (np.abs(motions.T) @ np.abs(loads)).sum(axis=1) + rounding))
