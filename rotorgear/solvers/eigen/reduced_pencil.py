"""All eigenvalues of a small dense pencil s^2 M + s D + K with right and left vectors, lowest |s| first.

The state pencil F - s E with x = [q; s q] is inverted at a real shift sigma, T = (F - sigma E)^-1 E, mu = 1/(s - sigma). With
P = (K + sigma D + sigma^2 M)^-1

    T = [ -P (D + sigma M)             -P M       ]
        [ 1 - sigma P (D + sigma M)    -sigma P M ]

A left vector l of T gives that of the pencil, y^H = -(l_1 + sigma l_2)^H P / mu, and y^H (2 s M + D) q = l^H x.
Tisseur and Meerbergen, SIAM Review 43 (2001) 235, sections 3.4 and 5.1.

Where D is skew and K positive definite, the pencil is that of the Hermitian -i B with a real skew B. B^T B = -B^2 is real, at
less than half the cost, and holds the square of each pair +-theta of -i B twice. Its highest vectors span the states of both;
within them -i B itself is solved, so that neither squares nor eigenvalues that meet cost accuracy.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg as la
from numpy.typing import NDArray
from scipy.linalg.lapack import dgeev, dgeev_lwork

from rotorgear.errors import ConvergenceError
from rotorgear.solvers.sparse.entries import times
from rotorgear.solvers.sparse.factor import single_thread

# Pairs beyond those that are wanted, among which the farthest gap is sought.
_BEYOND = 4
# Least gap between squares, over the largest, that separates a span from the others: rounding turns vectors by eps over it.
_GAP = 1e-9


def largest_pairs(B: NDArray[np.float64], count: int) -> tuple[NDArray[np.float64], NDArray[np.complex128]]:
    """The largest `count` eigenvalues theta (count,) of -i B, descending, and orthonormal vectors (2 m, count).

    Args:
        B: (2 m, 2 m), real and skew.
        count: up to m.
    """
    size = len(B)
    m = size // 2
    span = None
    if count < m:
        squares, X = la.eigh(B.T @ B, driver="evd", check_finite=False)
        # The span ends where the next pair is farthest off: a part of an eigenspace of squares is no eigenspace of B.
        pairs = np.append(squares[::-2], 0.0)
        ends = np.arange(count, min(count + _BEYOND, m) + 1)
        gaps = pairs[ends - 1] - pairs[ends]
        if gaps.max() >= _GAP * pairs[0]:
            span = X[:, 2 * (m - int(ends[np.argmax(gaps)])) :]
    if span is None:
        theta, Y = la.eigh(-1j * B, subset_by_index=(size - count, size - 1), overwrite_a=True, check_finite=False)
        return np.asarray(theta[::-1]), np.asarray(Y[:, ::-1])
    theta, c = la.eigh(-1j * (span.T @ B @ span), driver="evd", check_finite=False)
    largest = slice(None, -count - 1, -1)  # they come in pairs +-theta
    return np.asarray(theta[largest]), np.asarray(times(span, c[:, largest]))


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

    def between(self, other: Pencil, share: float) -> Pencil:
        """This one plus a share of the way to another, for matrices that are linear in a parameter."""
        pairs = ((self.M, other.M), (self.D, other.D), (self.K, other.K))
        return Pencil(*(mine + share * (theirs - mine) for mine, theirs in pairs))


@dataclass(frozen=True)
class Eigen:
    """Eigenpairs of one pencil that oscillate (Im s > 0), lowest |s| first.

    Attributes:
        s: (m,) eigenvalues.
        q: (r, m) right vectors.
        y: (r, m) left vectors, with y_i^H (2 s_i M + D) q_j = delta_ij in clusters.
        real: eigenvalues that do not oscillate, ascending; zero ones left out.
        pencil: what they belong to.
    """

    s: np.ndarray
    q: np.ndarray
    y: np.ndarray
    real: np.ndarray
    pencil: Pencil


def eigen(pencil: Pencil, shift: float, smallest: float, count: int) -> Eigen:
    """The oscillating eigenpairs of a pencil.

    Args:
        pencil: M, D, K (r, r).
        shift: sigma > 0 in rad/s, best near the geometric mean of the lowest and the highest |s| that count.
        smallest: |s| below which an eigenvalue is that of a rigid-body motion and left out.
        count: largest number of oscillating pairs.

    Raises:
        ConvergenceError: K + sigma D + sigma^2 M is singular.
    """
    r = pencil.K.shape[0]
    if r == 0:
        return Eigen(np.zeros(0, complex), np.zeros((0, 0), complex), np.zeros((0, 0), complex), np.zeros(0), pencil)

    conservative = _conservative(pencil, smallest, count)
    if conservative is not None:
        return conservative

    # Time in units of the shift (sigma = 1) and coordinates scaled to unit diagonals: units do not matter.
    diagonal = np.abs(np.diag(pencil.K)) + shift**2 * np.abs(np.diag(pencil.M)) + shift * np.abs(np.diag(pencil.D))
    scale = 1.0 / np.sqrt(np.where(diagonal > 0.0, diagonal, 1.0))
    M = shift**2 * pencil.M * scale[:, None] * scale
    D = shift * pencil.D * scale[:, None] * scale
    K = pencil.K * scale[:, None] * scale
    with single_thread(2 * r):
        try:
            P = np.linalg.inv(K + D + M)
        except np.linalg.LinAlgError:
            raise ConvergenceError("A reduced problem is singular at its shift.") from None
        PD = P @ (D + M)
        PM = P @ M
        T = np.empty((2 * r, 2 * r), order="F")  # as LAPACK takes it, without a copy
        T[:r, :r] = -PD
        T[r:, :r] = np.eye(r) - PD
        T[:r, r:] = -PM
        T[r:, r:] = -PM
        real_part, imaginary_part, left, right, failed = dgeev(T, lwork=int(dgeev_lwork(2 * r)[0]), overwrite_a=True)
    if failed:
        raise ConvergenceError("The eigenvalues of a reduced problem did not converge.")
    mu = real_part + 1j * imaginary_part

    # s = sigma + sigma / mu in these units; mu = 0, to the rounding of T, is a massless coordinate. Rigid
    # motions are too small to count.
    infinite = np.abs(mu) < 1e-14 * np.abs(mu).max()
    s = shift * (1.0 + 1.0 / np.where(infinite, 1.0, mu))
    size = np.abs(s)
    counted = ~infinite & (size > smallest)
    real = counted & (np.abs(s.imag) <= 1e-9 * size)
    chosen = np.flatnonzero(counted & ~real & (s.imag > 0.0))
    chosen = chosen[np.argsort(size[chosen], kind="stable")][:count]

    # Right vectors are the upper half of x, left ones follow from l; both go back to the coordinates of the pencil.
    q = _of_pairs(right, mu, chosen)[:r]
    both = _of_pairs(left, mu, chosen)
    y = -P.T @ (both[:r] + both[r:]) / np.conj(mu[chosen])
    s = s[chosen]
    y = scale[:, None] * y
    q = scale[:, None] * q
    q = q / np.linalg.norm(q, axis=0)
    return Eigen(s, q, _biorthogonal(pencil, s, q, y), np.sort(shift * (1.0 + 1.0 / mu[real]).real), pencil)


def _of_pairs(V: np.ndarray, mu: np.ndarray, chosen: np.ndarray) -> np.ndarray:
    """Complex vectors from LAPACK's real ones: the column of Im mu > 0 of a pair is the real part, the next one the imaginary."""
    upper = mu[chosen].imag > 0.0
    first = np.where(upper, chosen, chosen - 1)
    return np.asarray(V[:, first] + 1j * np.where(upper, 1.0, -1.0) * V[:, first + 1])


def gyroscopic_pairs(M: np.ndarray, G: np.ndarray, K: np.ndarray, most: int) -> tuple[np.ndarray, np.ndarray]:
    """The lowest `most` frequencies w (m,) of K + i w G - w^2 M with G skew, in rad/s, and vectors (r, m).

    With K = L L^T, u = L^T v, g = L^-1 G L^-T and N^2 = L^-1 M L^-T it is that of a skew matrix, several times cheaper than a
    general one:

           [  g  N ] [ u ]     1  [ u ]
        -i [ -N  0 ] [ z ]  =  -  [ z ].
                               w

    Raises:
        LinAlgError: K is not positive definite.
    """
    L = la.cholesky(K, lower=True, check_finite=False)

    def reduced(A: np.ndarray) -> np.ndarray:
        left = la.solve_triangular(L, A, lower=True, check_finite=False)
        return np.asarray(la.solve_triangular(L, left.T, lower=True, check_finite=False).T)

    squares, Q = np.linalg.eigh(reduced(M))
    N = (Q * np.sqrt(np.maximum(squares, 0.0))) @ Q.T
    r = len(N)
    g = reduced(G)
    inverse, U = largest_pairs(np.block([[0.5 * (g - g.T), N], [-N, np.zeros((r, r))]]), min(most, r))
    found = inverse > 0.0
    vectors = la.solve_triangular(L, U[:r, found], lower=True, trans="T", check_finite=False)
    return 1.0 / inverse[found], np.asarray(vectors)


# The Hermitian problem gives 1/w to the rounding of the largest: w errs by eps w/w_min, here 2e-11.
_HERMITIAN_SPREAD = 1e5


def _conservative(pencil: Pencil, smallest: float, count: int) -> Eigen | None:
    """The pairs of a pencil with skew D and positive definite K, which are their own left vectors; None for another one."""
    K = 0.5 * (pencil.K + pencil.K.T)
    if np.any(pencil.D + pencil.D.T) or np.abs(pencil.K - K).max() > 1e-14 * np.abs(K).max():
        return None
    scale = 1.0 / np.sqrt(np.maximum(np.diag(K), np.finfo(float).tiny))
    both = scale[:, None] * scale
    try:
        with single_thread(2 * len(K)):
            w, q = gyroscopic_pairs(pencil.M * both, pencil.D * both, K * both, count)
    except la.LinAlgError:  # rigid-body motions among the coordinates
        return None
    if not len(w) or w[0] <= smallest or w[-1] > _HERMITIAN_SPREAD * w[0]:
        return None
    s = 1j * w
    q = scale[:, None] * q
    q = q / np.linalg.norm(q, axis=0)
    return Eigen(s, q, _biorthogonal(pencil, s, q, q), np.zeros(0), pencil)


def _biorthogonal(pencil: Pencil, s: np.ndarray, q: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Left vectors scaled to y_i^H ((s_i + s_j) M + D) q_j = delta_ij inside each cluster of eigenvalues."""
    y = y.copy()
    groups = clusters(s)
    alone = np.array([group[0] for group in groups if len(group) == 1], dtype=int)
    slope = 2.0 * s[alone] * (pencil.M @ q[:, alone]) + pencil.D @ q[:, alone]
    y[:, alone] /= np.einsum("rm,rm->m", y[:, alone], slope.conj())
    for close in groups:
        if len(close) > 1:
            product = y[:, close].conj().T @ (2.0 * np.mean(s[close]) * pencil.M + pencil.D) @ q[:, close]
            y[:, close] = y[:, close] @ np.linalg.pinv(product).conj().T
    return y


def clusters(s: np.ndarray, tolerance: float = _CLUSTER) -> list[np.ndarray]:
    """Numbers of the eigenvalues (m,), ascending in |s|, that lie within a relative tolerance of each other, group by group."""
    if not len(s):
        return []
    # Ascending in size only, groups of one size and other phases interleave: each joins the latest group with a near member.
    near = np.tril(np.abs(s[:, None] - s) <= tolerance * np.abs(s)[:, None], -1)
    group = np.arange(len(s))
    if not near.any():
        return list(group[:, None])
    for k in np.flatnonzero(near.any(axis=1)):
        group[k] = group[near[k]].max()
    order = np.argsort(group, kind="stable")
    return np.split(order, np.flatnonzero(np.diff(group[order])) + 1)
