"""Undamped modes of a rotating system from its forms over a basis: K, M symmetric, W G skew.

With the modes T of K and M (T^T M T = 1, T^T K T = L) and g = T^T W G T, the states y = (L^(1/2) a, i w a) obey

    w y = [0  -i L^(1/2); i L^(1/2)  i g] y,

which is Hermitian: frequencies are real, vectors orthonormal in the energy, and the problem is regular where frequencies meet
(Meirovitch 1974, A new method of solution of the eigenvalue problem for gyroscopic systems, AIAA Journal 12). Without
rotation y has two equal halves and a is real.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import scipy.linalg as la
from numpy.typing import NDArray

from rotorgear.analysis.scatter.forms import GYROSCOPIC, MASS, STIFFNESS
from rotorgear.solvers.eigen.reduced_pencil import largest_pairs
from rotorgear.solvers.sparse.entries import times

# Shapes of modes in columns, complex where the system rotates.
Shapes: TypeAlias = NDArray[np.complex128] | NDArray[np.float64]

# Elastic are modes above this share of the scale of the first elastic one of the nominal model.
_RIGID = 1e-4


@dataclass(frozen=True)
class FormModes:
    """m elastic modes in coordinates of a basis of r shapes.

    Attributes:
        omega: natural frequencies in rad/s (m,), ascending.
        q: shapes (r, m), complex where the system rotates; q^H (K + w^2 M) q / 2 = w^2, so that modal mass is 1 at standstill.
    """

    omega: NDArray[np.float64]
    q: Shapes


def modes_of(forms: NDArray[np.float64], count: int, least: float, wide: int) -> FormModes:
    """Return `count` elastic modes.

    Args:
        forms: (a, r, r), the first three K, M and W G.
        count: how many.
        least: frequency in rad/s below which a motion is rigid.
        wide: among so many modes of K and M they are looked for; these carry those of a rotating system.
    """
    K = forms[STIFFNESS]
    M = forms[MASS]
    r = len(K)
    rotates = bool(np.any(forms[GYROSCOPIC]))
    # All modes of so small a problem by divide and conquer cost half of what the lowest cost one by one.
    values, T = la.eigh(0.5 * (K + K.T), 0.5 * (M + M.T), driver="gvd", check_finite=False)
    last = min(r, wide)
    values = values[:last]
    T = T[:, :last]
    elastic = values > least**2
    values = values[elastic]
    T = T[:, elastic]
    if not rotates:
        return FormModes(np.sqrt(values[:count]), T[:, :count])
    root = np.sqrt(values)
    g = T.T @ forms[GYROSCOPIC] @ T
    omega, y = _rotating(root, 0.5 * (g - g.T), min(count, len(root)))
    # y = (L^(1/2) a, i w a) has length 1 where a^H (L + w^2) a = 1: to modal mass 1.
    a = y[: len(root)] / root[:, None] * (np.sqrt(2.0) * omega)
    return FormModes(omega, times(T, a))


def _rotating(root: NDArray[np.float64], g: NDArray[np.float64], count: int) -> tuple[NDArray[np.float64], Shapes]:
    """The lowest `count` positive w (m,) with their orthonormal states y (2 m, count), from L^(1/2) (m,) and g (m, m).

    The matrix is i A with a real skew A = [0  -L^(1/2); L^(1/2)  g], whose inverse B = [b g b  b; -b  0], b = L^(-1/2), needs no
    solution.
    """
    m = len(root)
    b = np.diag(1.0 / root)
    inverse, y = largest_pairs(np.block([[b @ g @ b, b], [-b, np.zeros((m, m))]]), count)
    return 1.0 / inverse, y


def overlaps(K: NDArray[np.float64], M: NDArray[np.float64], first: FormModes, second: FormModes) -> Shapes:
    """Products of modes in the energy of K and M, (m, m'): 1 in size where they are the same mode, each of length 1."""
    K_second = times(K, second.q)
    M_second = times(M, second.q) * second.omega
    one = _energy(first, times(K, first.q), times(M, first.q) * first.omega)
    other = _energy(second, K_second, M_second)
    conjugate = first.q.conj().T
    common: Shapes = np.matmul(conjugate, K_second) + first.omega[:, None] * np.matmul(conjugate, M_second)
    common /= 2.0 * np.sqrt(np.outer(one, other))
    return common


def _energy(modes: FormModes, Kq: Shapes, wMq: Shapes) -> NDArray[np.float64]:
    """q^H (K + w^2 M) q / 2 of each mode (m,)."""
    return np.asarray(0.5 * np.sum(np.real(modes.q.conj() * (Kq + wMq * modes.omega)), axis=0))
