"""All eigenvalues of a small dense pencil s^2 M + s D + K with right and left vectors, lowest |s| first.

The state pencil F - s E with x = [q; s q] is inverted at a real shift sigma, T = (F - sigma E)^-1 E, mu = 1/(s - sigma). With
P = (K + sigma D + sigma^2 M)^-1

    T = [ -P (D + sigma M)             -P M       ]
        [ 1 - sigma P (D + sigma M)    -sigma P M ]

A left vector l of T gives that of the pencil, y^H = -(l_1 + sigma l_2)^H P / mu, and y^H (2 s M + D) q = l^H x.
Tisseur and Meerbergen, SIAM Review 43 (2001) 235, sections 3.4 and 5.1.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg as la

from rotorgear.errors import ConvergenceError
from rotorgear.solvers.sparse.factor import single_thread

# Eigenvalues this close to each other are one cluster, whose vectors are made biorthogonal together.
_CLUSTER = 1e-7


@dataclass(frozen=True)
class Pencil:
    """Dense M, D and K (r, r) at one speed; D holds damping and gyroscopic terms, K may be non-symmetric."""

    M: np.ndarray
    D: np.ndarray
    K: np.ndarray

    def at(self, s: complex) -> np.ndarray:
        """s^2 M + s D + K."""
        return np.asarray(s * s * self.M + s * self.D + self.K)


@dataclass(frozen=True)
class Eigen:
    """Eigenpairs of one pencil that oscillate (Im s > 0), lowest |s| first.

    Attributes
    ----------
    s : (m,) eigenvalues; q : (r, m) right vectors, y : (r, m) left ones, with y_i^H (2 s_i M + D) q_j = delta_ij in clusters.
    real : eigenvalues that do not oscillate, ascending; zero ones left out.
    pencil : what they belong to.
    """

    s: np.ndarray
    q: np.ndarray
    y: np.ndarray
    real: np.ndarray
    pencil: Pencil


def eigen(pencil: Pencil, shift: float, smallest: float, count: int) -> Eigen:
    """The oscillating eigenpairs of a pencil.

    Parameters
    ----------
    pencil : M, D, K (r, r).
    shift : sigma > 0 in rad/s, best near the geometric mean of the lowest and the highest |s| that count.
    smallest : |s| below which an eigenvalue is that of a rigid motion and left out.
    count : so many oscillating pairs at most.

    Raises
    ------
    ConvergenceError
        K + sigma D + sigma^2 M is singular.
    """
    r = pencil.K.shape[0]
    if r == 0:
        return Eigen(np.zeros(0, complex), np.zeros((0, 0), complex), np.zeros((0, 0), complex), np.zeros(0), pencil)
    with single_thread(2 * r):
        T, P, scale = _inverted(pencil, shift)
        mu, L, X = la.eig(T, left=True, right=True, check_finite=False)
    infinite = np.abs(mu) < 1e-14 * np.abs(mu).max()
    s = shift * (1.0 + 1.0 / np.where(infinite, 1.0, mu))
    size = np.abs(s)
    counted = ~infinite & (size > smallest)
    real = counted & (np.abs(s.imag) <= 1e-9 * size)
    chosen = np.flatnonzero(counted & ~real & (s.imag > 0.0))
    chosen = chosen[np.argsort(size[chosen], kind="stable")][:count]
    q = X[:r, chosen]
    l1 = L[:r, chosen]
    l2 = L[r:, chosen]
    y = -P.T @ (l1 + l2) / np.conj(mu[chosen])
    s = s[chosen]
    y = scale[:, None] * y
    q = scale[:, None] * q
    q = q / np.linalg.norm(q, axis=0)
    return Eigen(s, q, _biorthogonal(pencil, s, q, y), np.sort(shift * (1.0 + 1.0 / mu[real]).real), pencil)


def _inverted(pencil: Pencil, shift: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """T and P in time scaled by the shift and coordinates scaled to unit diagonals, and the scale of the coordinates."""
    diagonal = np.abs(np.diag(pencil.K)) + shift**2 * np.abs(np.diag(pencil.M)) + shift * np.abs(np.diag(pencil.D))
    scale = 1.0 / np.sqrt(np.where(diagonal > 0.0, diagonal, 1.0))
    M, D, K = (
        factor * A * scale[:, None] * scale for factor, A in ((shift**2, pencil.M), (shift, pencil.D), (1.0, pencil.K))
    )
    try:
        P = la.inv(K + D + M, check_finite=False)
    except la.LinAlgError:
        raise ConvergenceError("A reduced problem is singular at its shift.") from None
    PD = P @ (D + M)
    PM = P @ M
    return np.block([[-PD, -PM], [np.eye(len(K)) - PD, -PM]]), P, scale


def _biorthogonal(pencil: Pencil, s: np.ndarray, q: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Left vectors scaled to y_i^H ((s_i + s_j) M + D) q_j = delta_ij inside each cluster of eigenvalues."""
    y = y.copy()
    for own in clusters(s):
        if len(own) == 1:
            k = own[0]
            y[:, k] /= np.conj(y[:, k].conj() @ (2.0 * s[k] * (pencil.M @ q[:, k]) + pencil.D @ q[:, k]))
            continue
        product = y[:, own].conj().T @ (2.0 * np.mean(s[own]) * pencil.M + pencil.D) @ q[:, own]
        y[:, own] = y[:, own] @ np.linalg.pinv(product).conj().T
    return y


def clusters(s: np.ndarray, tolerance: float = _CLUSTER) -> list[np.ndarray]:
    """Numbers of the eigenvalues (m,), ascending in |s|, that lie within a relative tolerance of each other, group by group."""
    found: list[list[int]] = []
    for k in range(len(s)):
        near = [g for g in found[-6:] if np.min(np.abs(s[g] - s[k])) <= tolerance * abs(s[k])]
        if near:
            near[-1].append(k)
        else:
            found.append([k])
    return [np.array(group) for group in found]
