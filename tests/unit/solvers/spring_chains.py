"""Chains for the tests of the solvers, and their exact counterparts: bars (1 dof a node), planar beams (2 dofs a node).

Every builder takes the arithmetic as an argument, so that the same lines give the matrices in doubles and in 40 digits.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import mpmath as mp
import numpy as np
import scipy.sparse as sp


def bar(n: int, stiffness: float = 1.0, mass: float = 1.0, ground: dict[int, float] | None = None):
    """M, K, strain of n masses in a row with springs between them and `ground` springs {node: stiffness}."""
    rows = [({i: -np.sqrt(stiffness), i + 1: np.sqrt(stiffness)}) for i in range(n - 1)]
    rows += [{i: np.sqrt(k)} for i, k in (ground or {}).items()]
    S = sp.lil_array((max(len(rows), 1), n))
    for r, row in enumerate(rows):
        for i, value in row.items():
            S[r, i] = value
    S = sp.csr_array(S)
    return sp.csc_array(mass * sp.eye_array(n)), sp.csc_array(S.T @ S), lambda V: S @ V


def clamped_bar_frequencies(n: int, stiffness: float = 1.0, mass: float = 1.0) -> np.ndarray:
    """omega (n,) of n masses between two walls: 2 sqrt(k/m) sin(j pi / (2 n + 2)), j = 1..n."""
    return 2.0 * np.sqrt(stiffness / mass) * np.sin(np.arange(1, n + 1) * np.pi / (2 * n + 2))


def free_bar_frequencies(n: int, stiffness: float = 1.0, mass: float = 1.0) -> np.ndarray:
    """omega (n,) of n free masses: 2 sqrt(k/m) sin(j pi / (2 n)), j = 0..n-1."""
    return 2.0 * np.sqrt(stiffness / mass) * np.sin(np.arange(n) * np.pi / (2 * n))


def copies(count: int, M: sp.csc_array, K: sp.csc_array, strain: Callable):
    """`count` separate copies of a structure in one pair."""
    n = K.shape[0]

    def strains(V: np.ndarray) -> np.ndarray:
        return np.vstack([strain(V[i * n : (i + 1) * n]) for i in range(count)])

    return sp.csc_array(sp.block_diag([M] * count)), sp.csc_array(sp.block_diag([K] * count)), strains


@dataclass
class Beam:
    """Planar Euler-Bernoulli beam, dofs (w, theta) a node, springs on w {node: k}, lumped inertia {node: (m, J)}."""

    lengths: list[float]
    bending: float = 2.0e4
    line_mass: float = 15.0
    springs: dict[int, float] = field(default_factory=dict)
    lumps: dict[int, tuple[float, float]] = field(default_factory=dict)

    @property
    def n(self) -> int:
        """Number of dofs."""
        return 2 * len(self.lengths) + 2

    def matrices(self) -> tuple[sp.csc_array, sp.csc_array]:
        """M, K assembled in doubles, as a finite-element code does."""
        M = np.zeros((self.n, self.n))
        K = np.zeros((self.n, self.n))
        self._assemble(M, K, float)
        return sp.csc_array(M), sp.csc_array(K)

    def exact(self) -> tuple[mp.matrix, mp.matrix]:
        """M, K in the working precision of mpmath, from the same doubles."""
        M = mp.zeros(self.n)
        K = mp.zeros(self.n)
        self._assemble(M, K, mp.mpf)
        return M, K

    def strain(self, V: np.ndarray) -> np.ndarray:
        """S V: bending and shear factor of each element, and the springs; differences are taken before scaling."""
        l = np.array(self.lengths)[:, None]  # noqa: E741
        w = V[0::2]
        turn = V[1::2]
        curvature = np.sqrt(self.bending / l) * np.diff(turn, axis=0)
        sway = np.sqrt(12.0 * self.bending / l**3) * (np.diff(w, axis=0) - 0.5 * l * (turn[1:] + turn[:-1]))
        springs = [np.sqrt(k) * w[i : i + 1] for i, k in self.springs.items()]
        return np.vstack([curvature, sway, *springs])

    def _assemble(self, M, K, number) -> None:
        for e, length in enumerate(self.lengths):
            l = number(length)  # noqa: E741
            EI = number(self.bending)
            m = number(self.line_mass)
            k = [[12, 6 * l, -12, 6 * l], [6 * l, 4 * l**2, -6 * l, 2 * l**2], [-12, -6 * l, 12, -6 * l]]
            k.append([6 * l, 2 * l**2, -6 * l, 4 * l**2])
            c = [[156, 22 * l, 54, -13 * l], [22 * l, 4 * l**2, 13 * l, -3 * l**2], [54, 13 * l, 156, -22 * l]]
            c.append([-13 * l, -3 * l**2, -22 * l, 4 * l**2])
            for i in range(4):
                for j in range(4):
                    K[2 * e + i, 2 * e + j] += EI / l**3 * k[i][j]
                    M[2 * e + i, 2 * e + j] += m * l / 420 * c[i][j]
        for node, stiffness in self.springs.items():
            K[2 * node, 2 * node] += number(stiffness)
        for node, (mass, inertia) in self.lumps.items():
            M[2 * node, 2 * node] += number(mass)
            M[2 * node + 1, 2 * node + 1] += number(inertia)


def exact_eigenvalues(M: mp.matrix, K: mp.matrix) -> list[mp.mpf]:
    """Ascending eigenvalues of K v = lambda M v in the working precision of mpmath, by Cholesky and QR."""
    L = mp.cholesky(M)
    inverse = L**-1
    A = inverse * K * inverse.T
    return sorted(mp.eigsy(0.5 * (A + A.T), eigvals_only=True))
