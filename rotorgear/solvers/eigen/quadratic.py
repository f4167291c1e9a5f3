"""The quadratic pencil Q(lambda) = lambda^2 M + lambda D + K, scaled, linearised and inverted at a real shift.

With p = lambda q the state x = [q; p] satisfies lambda x = A x, and y = (A - sigma)^-1 x needs one n x n factor only:
(K + sigma D + sigma^2 M) y_q = -(D + sigma M) x_q - M x_p,   y_p = x_q + sigma y_q.
Dofs are scaled to unit diagonals and time to a frequency w0, so that units do not matter.
Tisseur and Meerbergen, SIAM Review 43 (2001) 235, sections 3.4 and 5.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp

from rotorgear.errors import AnalysisError, ConvergenceError
from rotorgear.solvers.eigen.krylov import BlockKrylov
from rotorgear.solvers.sparse.entries import column_forms, norm_1, scaled_on_both_sides, times, unit_vectors
from rotorgear.solvers.sparse.factor import Factor, factor_general
from rotorgear.solvers.sparse.nullspace import left_null_space, supported_solver
from rotorgear.solvers.sparse.pencil import EPS, LooseDofError


@dataclass(frozen=True)
class Quadratic:
    """Scaled M, D, K (n, n): q = scale * q_scaled and lambda = w0 * lambda_scaled."""

    M: sp.csc_array
    D: sp.csc_array
    K: sp.csc_array
    scale: np.ndarray
    w0: float

    @property
    def n(self) -> int:
        """Number of dofs."""
        return int(self.K.shape[0])

    @cached_property
    def _norms(self) -> tuple[float, float, float]:
        """||M||_1, ||D||_1 and ||K||_1."""
        return norm_1(self.M), norm_1(self.D), norm_1(self.K)

    def at(self, z: complex) -> sp.csc_array:
        """Q(z) = z^2 M + z D + K; real for a real z."""
        return sp.csc_array(z * z * self.M + z * self.D + self.K)

    def forms(self, V: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """v^H M v, v^H D v and v^H K v of each column of V (n, k): three times (k,)."""
        return column_forms(self.M, V), column_forms(self.D, V), column_forms(self.K, V)

    def residuals(self, values: np.ndarray, V: np.ndarray) -> np.ndarray:
        """Backward errors ||Q(z) v|| / ((|z|^2 ||M||_1 + |z| ||D||_1 + ||K||_1) ||v||) of scaled pairs: (m,)."""
        left = times(self.M, V) * values**2 + times(self.D, V) * values + times(self.K, V)
        mass, velocity, stiffness = self._norms
        size = np.abs(values) ** 2 * mass + np.abs(values) * velocity + stiffness
        size = np.maximum(size * np.linalg.norm(V, axis=0), np.finfo(float).tiny)  # K = 0 leaves no residual either
        errors: np.ndarray = np.linalg.norm(left, axis=0) / size
        return errors


def corrected(values: np.ndarray, trust: np.ndarray, forms: tuple[np.ndarray, np.ndarray, np.ndarray]) -> np.ndarray:
    """Roots z (k,) of z^2 a + z b + c next to the given ones, a, b, c = v^H M v, v^H D v, v^H K v: errors of v count twice.

    That is so where v is its own left vector (no damping), and nearly so with little damping. A step of more than `trust`
    relative to z is not taken.
    """
    a, b, c = forms
    slope = 2.0 * values * a + b
    step = (values * (values * a + b) + c) / np.where(slope == 0.0, 1.0, slope)
    taken = (slope != 0.0) & (np.abs(step) <= trust * np.abs(values))
    return np.asarray(np.where(taken, values - step, values))


def scaled(M: sp.csc_array, D: sp.csc_array, K: sp.csc_array, w0: float) -> Quadratic:
    """Scale dofs by 1/sqrt(|k_ii| + w0 |d_ii| + w0^2 m_ii) and time by w0.

    Raises:
        LooseDofError: some dof has no stiffness, damping and inertia of its own.
    """
    diagonal = np.abs(K.diagonal()) + w0 * np.abs(D.diagonal()) + w0**2 * np.abs(M.diagonal())
    if np.any(diagonal <= 0.0):
        raise LooseDofError(np.flatnonzero(diagonal <= 0.0))
    scale = 1.0 / np.sqrt(diagonal)
    return Quadratic(
        M=scaled_on_both_sides(M, w0 * scale),
        D=scaled_on_both_sides(D, np.sqrt(w0) * scale),
        K=scaled_on_both_sides(K, scale),
        scale=scale,
        w0=w0,
    )


class InverseState:
    """T = (A - sigma)^-1 on states (2n, k), with the zero eigenvalues of the rigid-body motions projected out.

    `krylov` is its block Krylov basis so far, in balanced coordinates (`apply_balanced`).
    """

    def __init__(self, quadratic: Quadratic, sigma: float, rigid: np.ndarray, block: int) -> None:
        self.quadratic = quadratic
        self.sigma = sigma
        self.factor: Factor = factor_general(quadratic.at(sigma))
        self._first = sp.csr_array(quadratic.D + sigma * quadratic.M)
        self._second = sp.csr_array(quadratic.M)
        self.zeros = zero_states(quadratic, rigid)
        inertia = np.maximum(quadratic.M.diagonal(), 0.0)
        # A massless dof has a speed that weighs nothing; rounding of the heaviest stands in, so that B can be inverted.
        self._balance = np.sqrt(np.maximum(inertia, EPS * inertia.max(initial=0.0)))[:, None]
        self.krylov = BlockKrylov(self.apply_balanced, 2 * quadratic.n, block)

    def apply(self, x: np.ndarray) -> np.ndarray:
        """T x (2n, k)."""
        n = self.quadratic.n
        q = -self.factor.solve(self._first @ x[:n] + self._second @ x[n:])
        return np.vstack([q, x[:n] + self.sigma * q])

    def apply_balanced(self, y: np.ndarray) -> np.ndarray:
        """B T B^-1 y without its part in the zero eigenspace, B = diag(1, sqrt(M_ii)): norms are then nearly energies.

        In energies T is normal but for damping. Without B speeds outweigh displacements, and Ritz values stray among the
        converged ones.
        """
        n = self.quadratic.n
        x = self.apply(self.unbalanced(y))
        if self.zeros.shape[1]:
            x = x - self.zeros @ (self.zeros.T @ x)
        return np.vstack([x[:n], self._balance * x[n:]])

    def unbalanced(self, y: np.ndarray) -> np.ndarray:
        """B^-1 y (2n, k)."""
        n = self.quadratic.n
        return np.vstack([y[:n], y[n:] / self._balance])

    def ritz(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """mu (m,) in descending size, coordinates (m, m) in the Krylov basis, residuals relative to |mu| (m,)."""
        mu, Y = np.linalg.eig(self.krylov.projection)
        order = np.argsort(-np.abs(mu), kind="stable")
        mu = mu[order]
        Y = Y[:, order]
        keep = np.abs(mu) > EPS * np.abs(mu[:1]).max(initial=0.0)
        return mu[keep], Y[:, keep], self.krylov.residuals(Y[:, keep]) / np.abs(mu[keep])

    def restored(self, mu: np.ndarray, X: np.ndarray, known: np.ndarray) -> np.ndarray:
        """Eigenvectors (2n, k) of T from those X of T projected off the invariant subspace `known` (2n, z).

        With T Z = Z H and T x = mu x + Z b the eigenvector is x + Z c, (mu - H) c = b.
        """
        if known.shape[1] == 0:
            return X
        H = known.T @ self.apply(known)
        coupling = known.T @ self.apply(X)
        shifted = mu[:, None, None] * np.eye(H.shape[0]) - H
        try:
            restored: np.ndarray = X + known @ np.linalg.solve(shifted, coupling.T[:, :, None])[:, :, 0].T
        except np.linalg.LinAlgError as error:
            raise ConvergenceError(
                "A mode can't be told from a rigid-body motion: some part is held by less than the rounding of the others."
            ) from error
        return restored


def zero_states(quadratic: Quadratic, rigid: np.ndarray) -> np.ndarray:
    """Orthonormal basis (2n, z) of the states whose eigenvalue is exactly zero, given K @ rigid = 0.

    Each rigid-body motion R c is one. If D R c does no work on rigid-body motions (L^T D R c = 0, L^T K = 0) it may also drift,
    q = R c t + q1 with K q1 = -D R c: a second state, the pair of a defective double zero.

    Raises:
        AnalysisError: the rigid vectors are strained, or a drift has no inertia.
    """
    K = quadratic.K
    D = quadratic.D
    M = quadratic.M
    if rigid.shape[1] == 0:
        return np.zeros((2 * quadratic.n, 0))
    R = np.linalg.qr(rigid)[0]
    if np.any(np.abs(K @ R) > 1e-6 * norm_1(K)):
        raise AnalysisError("A vector that was given as a rigid-body motion is strained by the stiffness.")
    L = left_null_space(K, M, R)
    U, size, W = la.svd(L.T @ (D @ R))
    # R carries rounding of EPS in every dof, so a drag up to EPS |D| is none, wherever the exact R moves no damper.
    noise = 100.0 * EPS * norm_1(D)
    rank = int(np.count_nonzero(size > max(noise, EPS**2)))
    drift = R @ W[rank:].T
    first = np.vstack([R, np.zeros_like(R)])
    if drift.shape[1] == 0:
        return first
    follow = supported_solver(K, R, L)(-(D @ drift))
    # Condition 1e12: what solves with it would keep four digits, and an inertia so small beside others is that of rounding.
    if np.linalg.cond((L @ U[:, rank:]).T @ (M @ drift + D @ follow)) > 1e12:
        raise AnalysisError("A rigid-body motion has no inertia: give the parts that it moves a mass or a support.")
    return np.linalg.qr(np.hstack([first, np.vstack([follow, drift])]))[0]


def infinite_states(quadratic: Quadratic) -> np.ndarray:
    """Orthonormal basis (2n, z) of the states whose eigenvalue is infinite: those of the massless dofs.

    [0; e] for each massless dof e; and where D does no work on a combination N c of them (N^T D N c = 0) also
    [N c; -M^+ D N c], the pair of a defective double infinity. The drift pairs of `zero_states` with K and M exchanged.

    Raises:
        LooseDofError: massless, undamped dofs have no stiffness.
    """
    n = quadratic.n
    massless = np.flatnonzero(quadratic.M.diagonal() <= 0.0)
    if massless.size == 0:
        return np.zeros((2 * n, 0))
    N = unit_vectors(n, massless)
    DN = quadratic.D @ N
    U, size, W = la.svd(N.T @ DN)
    rank = int(np.count_nonzero(size > 100 * EPS * max(abs(quadratic.D).max(), EPS)))
    free = W[rank:].T
    massive = np.setdiff1d(np.arange(n), massless)
    follow = np.zeros((n, free.shape[1]))
    if massive.size and free.shape[1]:
        mass = factor_general(sp.csc_array(quadratic.M[massive][:, massive]))
        follow[massive] = -mass.solve(DN[massive] @ free)
    held = (N @ U[:, rank:]).T @ (quadratic.K @ (N @ free) + quadratic.D @ follow)
    if free.shape[1] and np.linalg.cond(held) > 1e12:
        raise LooseDofError(massless)
    first = np.vstack([np.zeros_like(N), N])
    return np.linalg.qr(np.hstack([first, np.vstack([N @ free, follow])]))[0]


# Largest step of a refinement relative to the eigenvalue.
_LONGEST_STEP = 0.1
# Convergence is quadratic: after a step as small as this only rounding is left.
_LAST_STEP = 1e-10
_MOST_STEPS = 5


def newton(quadratic: Quadratic, value: complex, vector: np.ndarray) -> tuple[complex, np.ndarray]:
    """The eigenpair of a pencil next to a pair that rounding has blurred; a real pair stays real."""
    real = value.imag == 0.0
    return inverse_iteration(
        value.real if real else value,
        vector.real if real else vector,
        lambda z: factor_general(quadratic.at(z)),
        lambda z, v: 2.0 * z * (quadratic.M @ v) + quadratic.D @ v,
    )


def inverse_iteration(
    z: complex,
    v: np.ndarray,
    factored: Callable[[complex], Factor],
    slope: Callable[[complex, np.ndarray], np.ndarray],
) -> tuple[complex, np.ndarray]:
    """Inverse iteration on a matrix Q over z itself: Q(z) u = Q'(z) v, z <- z - (v^H v)/(v^H u).

    Quadratic convergence. Tisseur and Meerbergen, section 5.
    A step that leads away from the pair that was given is not taken: it belongs to another one.

    Args:
        z, v: the start, v (n,).
        factored: factors of Q(z), with a ConvergenceError where it is singular. slope: Q'(z) v, (n,).

    Returns:
        Eigenvalue and unit vector.
    """
    for _ in range(_MOST_STEPS):
        v = v / np.linalg.norm(v)
        try:
            factor = factored(z)
        except ConvergenceError:
            break  # Q(z) is singular to the last bit: z is the eigenvalue
        u = factor.solve(slope(z, v))
        step = 1.0 / np.vdot(v, u)
        if abs(step) > _LONGEST_STEP * abs(z):
            break
        z = z - step
        v = u
        if abs(step) <= _LAST_STEP * abs(z):
            break
    return complex(z), v / np.linalg.norm(v) + 0j


def first_guess(M: sp.csc_array, D: sp.csc_array, K: sp.csc_array) -> float:
    """A frequency in rad/s below most of those of the matrices, to start the search from."""
    for A, power in ((M, 0.5), (D, 1.0)):
        inertia = np.abs(A.diagonal())
        stiffness = np.abs(K.diagonal())
        both = (inertia > 0.0) & (stiffness > 0.0)
        if np.any(both):
            # A diagonal has the stiffest spring of its dof in it: the lowest frequencies lie decades below.
            return float((1e-8 * np.median(stiffness[both] / inertia[both])) ** power)
    return 1.0
