"""Undamped modes of a rotating system from its forms over a basis: K, M symmetric, W G skew.

With the modes T of K and M (T^T M T = 1, T^T K T = L) and g = T^T W G T, the states y = (L^(1/2) a, i w a) obey

    w y = [0  -i L^(1/2); i L^(1/2)  i g] y,

which is Hermitian: frequencies are real, vectors orthonormal in the energy, and the problem is regular where frequencies meet
(Meirovitch 1974, A new method of solution of the eigenvalue problem for gyroscopic systems, AIAA Journal 12). Without
rotation y has two equal halves and a is real.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg as la
from numpy.typing import NDArray

from rotorgear.analysis.scatter.forms import GYROSCOPIC, MASS, STIFFNESS

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
    q: NDArray[np.complex128] | NDArray[np.float64]


def modes_of(forms: NDArray[np.float64], count: int, least: float, wide: int) -> FormModes:
    """Return `count` elastic modes.

    Args:
        forms: (a, r, r), the first three K, M and W G.
        count: how many.
        least: frequency in rad/s below which a motion is rigid.
        wide: so many modes of K and M carry those of the rotating system.
    """
    K = forms[STIFFNESS]
    M = forms[MASS]
    r = len(K)
    rotates = bool(np.any(forms[GYROSCOPIC]))
    # All modes of so small a problem by divide and conquer cost half of what the lowest cost one by one.
    values, T = la.eigh(0.5 * (K + K.T), 0.5 * (M + M.T), driver="gvd", check_finite=False)
    last = min(r, wide if rotates else count + 6)
    values = values[:last]
    T = T[:, :last]
    elastic = values > least**2
    values = values[elastic]
    T = T[:, elastic]
    if not rotates:
        return FormModes(np.sqrt(values[:count]), T[:, :count])
    root = np.sqrt(values)
    g = T.T @ forms[GYROSCOPIC] @ T
    m = len(root)
    H = np.zeros((2 * m, 2 * m), dtype=complex)
    H[:m, m:] = np.diag(-1j * root)
    H[m:, :m] = np.diag(1j * root)
    H[m:, m:] = 0.5j * (g - g.T)
    # Frequencies come in pairs +-w: the positive ones are the upper half, ascending.
    omega, y = la.eigh(H, subset_by_index=(m, min(m + count, 2 * m) - 1), check_finite=False)
    # y = (L^(1/2) a, i w a) has length 1 where a^H (L + w^2) a = 1: to modal mass 1.
    a = y[:m] / root[:, None] * (np.sqrt(2.0) * omega)
    return FormModes(omega, T @ a)


def overlaps(
    K: NDArray[np.float64], M: NDArray[np.float64], first: FormModes, second: FormModes
) -> NDArray[np.complex128] | NDArray[np.float64]:
    """Products of modes in the energy of K and M, (m, m'): 1 in size where they are the same mode, each of length 1."""

    def product(a: FormModes, b: FormModes) -> NDArray[np.complex128]:
        kinetic = a.omega[:, None] * b.omega[None, :] * (a.q.conj().T @ (M @ b.q))
        return np.asarray(0.5 * (a.q.conj().T @ (K @ b.q) + kinetic))

    one = np.sqrt(np.real(np.diag(product(first, first))))
    K_other = K @ second.q
    M_other = M @ second.q
    square = np.sum(second.q.conj() * K_other, axis=0) + second.omega**2 * np.sum(second.q.conj() * M_other, axis=0)
    other = np.sqrt(np.real(0.5 * square))
    return np.asarray(product(first, second) / np.outer(one, other))
