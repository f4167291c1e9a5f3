"""A turning structure with local forces, as equations of its periodic motions take it.

    M q'' + D q' + K q = f + B u,   d = B^T q,   u = k d + c d' - F(d, d', t)

K and D hold the linear reference k, c of the laws and, in D, the gyroscopic terms at the plant's own speed.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from rotorgear.solvers.sparse.nullspace import Solve, inertia_relief
from rotorgear.solvers.time.contact_equilibrium import free_motions
from rotorgear.solvers.time.local_forces import LocalForces
from rotorgear.solvers.time.local_system import LocalSystem

# Strain of a motion, relative to the sums of its parts, below which it is rounding.
_FREE = 1e-9


@dataclass(frozen=True)
class Plant:
    """The structure at one value of a parameter.

    M, C, K, G sparse (n, n), B (n, m), load f (n,), laws, speed in rad/s, watched W (n, p). `C` and `gyroscopic` make
    D = C + speed G; G is None where nothing gyrates. `free`: (n, r), M-orthonormal motions without strain.
    """

    M: sp.csc_array
    C: sp.csc_array
    gyroscopic: sp.csc_array | None
    K: sp.csc_array
    B: np.ndarray
    load: np.ndarray
    forces: LocalForces
    speed: float
    watched: np.ndarray
    free: np.ndarray

    @property
    def m(self) -> int:
        """Number of local displacements."""
        return self.forces.m

    @cached_property
    def D(self) -> sp.csc_array:  # noqa: N802  the equation's own symbol
        """All velocity terms at the plant's speed."""
        return self.C if self.gyroscopic is None else sp.csc_array(self.C + self.speed * self.gyroscopic)

    @cached_property
    def elastic(self) -> tuple[Solve, np.ndarray]:
        """What gives static displacements without the motions `free`, and those (n, m) of unit local forces."""
        solve = inertia_relief(self.K, self.M, self.free)
        return solve, solve(self.B)

    @cached_property
    def static(self) -> StaticSolution:
        """What follows from stiffness and load."""
        solve, X = self.elastic
        q = solve(self.load)
        return StaticSolution(X, q, self.B.T @ X, self.B.T @ q)


@dataclass(frozen=True)
class StaticSolution:
    """Static displacements X (n, m) of unit local forces and q (n,) of the load, and what of them the laws see."""

    X: np.ndarray
    q: np.ndarray
    R: np.ndarray
    d: np.ndarray


PlantAt = Callable[[float], Plant]


class Plants:
    """Makes plants of systems and keeps what they share with the first one and with the last one.

    Systems that differ in speed and load only share their static solution and their motions without strain. No number of a plant
    depends on those made before but the first: a continuation that is broken off goes on to the same digits.
    """

    def __init__(self) -> None:
        self._known: list[tuple[Plant, sp.csc_array]] = []

    def of(self, system: LocalSystem) -> Plant:
        """The plant of a system at the (constant) speed of its rotation."""
        speed = float(system.rotation.speeds[0])
        K = system.stiffness_about
        C = system.damping_about
        alike = [
            old
            for old, places in self._known
            if _alike(old.K, K) and _alike(old.M, system.M) and _alike(places, system.B)
        ]
        if alike:
            old = alike[0]
            C = old.C if _alike(old.C, C) else C
            G = old.gyroscopic if _alike(old.gyroscopic, system.G) else system.G
            plant = Plant(
                old.M, C, G, old.K, old.B, system.load, system.forces, speed, system.watched_vectors, old.free
            )
            # Cached properties of the same arguments.
            plant.__dict__["elastic"] = old.elastic
            if np.array_equal(old.load, system.load):
                plant.__dict__["static"] = old.static
        else:
            B = system.B.toarray()
            # The motions of the first plant, unless they strain this one.
            R = self._known[0][0].free if self._known else np.zeros((system.n, 0))
            kept = R.shape[1] and np.all(np.abs(K @ R) <= _FREE * (abs(K) @ np.abs(R)) + 1e-300)
            free = R if kept else free_motions(system.M, K)
            plant = Plant(system.M, C, system.G, K, B, system.load, system.forces, speed, system.watched_vectors, free)
        self._known = [*self._known[:1], (plant, system.B)]
        return plant


def _alike(A: sp.csc_array | None, B: sp.csc_array | None) -> bool:
    if A is B:
        return True
    if A is None or B is None:
        return False
    return A.nnz == B.nnz and np.array_equal(A.indices, B.indices) and np.array_equal(A.data, B.data)
