"""Complex modes of M q'' + D q' + K q = f, in a basis of real modes, with motions free of stiffness and damping apart.

q = Re(Phi z) + R r with z' = s z + W f and r'' = R^T f, where one z stands for each conjugate pair. The basis holds
all real modes, or the lowest ones and, for the local forces, the residual attachment vectors K^-1 B as dynamic Ritz vectors.
Craig and Kurdila, Fundamentals of Structural Dynamics, 2nd ed. (Wiley 2006), sections 10.3 and 17.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp

from rotorgear.errors import AnalysisError, ConvergenceError
from rotorgear.solvers.eigen.ritz import ritz_residuals
from rotorgear.solvers.sparse.factor import single_thread

_EPS = float(np.finfo(float).eps)
# Condition of the eigenvectors beyond which the exponential would lose ten digits.
_WORST_CONDITION = 1e10
# A rate on a free motion below this share of the largest one is rounding.
_NOISE = 1e-10
# Squares of frequencies within a factor of the lowest that one eigensolution gives M-orthogonal to rounding.
_STEP = 1e4


@dataclass(frozen=True)
class ComplexModes:
    """nz modes and r motions without stiffness and damping.

    Attributes:
        s: (nz,) complex roots in rad/s.
        shapes: Phi (n, nz), with the weight 2 of a conjugate pair.
        basis: V (n, b), M-orthonormal.
        gains: (nz, b), so that W f = gains (V^T f).
        rigid: R (n, r), M-orthonormal.
    """

    s: np.ndarray
    shapes: np.ndarray
    basis: np.ndarray
    gains: np.ndarray
    rigid: np.ndarray


def complex_modes(
    M: sp.csc_array, D: sp.csc_array, K: sp.csc_array, B: np.ndarray, modes: int | None = None, modal_ratio: float = 0.0
) -> ComplexModes:
    """Return the complex modes.

    Args:
        M: (n, n).
        D: (n, n), need not be symmetric.
        K: (n, n), need not be symmetric.
        B: (n, m) where local forces act; matters only where `modes` cuts the basis.
        modes: real modes to keep; all where None.
        modal_ratio: damping ratio added to that of every elastic mode.

    Raises:
        AnalysisError: a dof without inertia.
        ConvergenceError: eigenvectors so near to each other that the modes are worthless.
    """
    with single_thread(0):
        V, R = _real_basis(M, K, B, modes)
        Kb = V.T @ (K @ V)
        Db = V.T @ (D @ V)
        if R.shape[1]:
            # Motions without stiffness that meet velocity terms (rates in 1/s, from either side) are modes, with a root each;
            # those that meet none drift, r'' = R^T f.
            rates = np.vstack([R.T @ (D @ R), V.T @ (D @ R), R.T @ (D.T @ R), V.T @ (D.T @ R)])
            _, sizes, turned = la.svd(rates)
            damped = np.zeros(R.shape[1], bool)
            damped[: sizes.size] = sizes > 10.0 * _NOISE * np.abs(Db).max(initial=1e-300)
            V = np.hstack([R @ turned[damped].T, V])
            R = R @ turned[~damped].T
            Kb = V.T @ (K @ V)
            Db = V.T @ (D @ V)
        if modal_ratio:
            Db = Db + np.diag(2.0 * modal_ratio * np.sqrt(np.maximum(np.diag(Kb), 0.0)))
        s, X, gains = _pairs(Kb, Db)
    return ComplexModes(s, V @ X, V, gains, R)


def _real_basis(M: sp.csc_array, K: sp.csc_array, B: np.ndarray, modes: int | None) -> tuple[np.ndarray, np.ndarray]:
    """Elastic vectors (n, b) and rigid ones (n, r), by eigh(M, K + sigma M), exact for low modes."""
    if np.any(M.diagonal() <= 0.0):
        raise AnalysisError("a degree of freedom has no inertia; the exponential integrator needs it: use newmark")
    dense = M.toarray()
    stiff = K.toarray()
    stiff = 0.5 * (stiff + stiff.T)

    # A shift below all elastic modes, at which rigid ones have the largest mu. The least k_ii / m_ii is a Rayleigh quotient,
    # so the lowest eigenvalue lies below it: a thousandth leaves room for that.
    ratio = np.diag(stiff) / np.diag(dense)
    sigma = 1e-3 * float(ratio[ratio > 0.0].min(initial=1.0)) if np.any(ratio > 0.0) else 1.0
    try:
        mu, V = la.eigh(dense, stiff + sigma * dense)
    except la.LinAlgError:
        raise ConvergenceError("stiffnesses too far apart for dense modes; use the newmark method") from None
    mu = mu[::-1]
    V = V[:, ::-1]
    V = V / np.sqrt(np.maximum(np.einsum("ij,ij->j", V, dense @ V), 1e-300))

    # Rigid is what strains by rounding only: sums of n products err by up to n eps, and n is below a thousand here. One whose
    # eigenvalue is not zero says that rounding hides soft modes.
    strain = np.einsum("ij,ij->j", V, stiff @ V)
    rigid = np.abs(strain) <= 1e3 * _EPS * np.einsum("ij,ij->j", np.abs(V), np.abs(stiff) @ np.abs(V))
    # Dofs that nothing holds carry squares of rounding of the others, which is all of their noise as well.
    rigid |= np.abs(strain) <= (1e3 * _EPS) ** 2 * np.abs(strain).max(initial=0.0)
    lam = 1.0 / mu - sigma
    if np.any(np.abs(lam[rigid]) > sigma):
        raise ConvergenceError("stiffnesses too far apart for dense modes; use the newmark method")
    if np.any(strain[~rigid] < 0.0):
        raise ConvergenceError(
            "a motion has negative stiffness, so that there are no modes to begin with; use the newmark method"
        )
    R = V[:, rigid]
    V = V[:, ~rigid]
    V, lam = _freed_of_slower(dense, stiff, R, V)
    if modes is not None and modes < V.shape[1]:
        # What the modes that are cut give statically under unit local forces, as Ritz vectors with inertia.
        high = V[:, modes:]
        V = np.hstack([V[:, :modes], ritz_residuals(dense, stiff, high @ ((high.T @ B) / lam[modes:, None]))])
    return V, R


def _freed_of_slower(M: np.ndarray, K: np.ndarray, R: np.ndarray, V: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """M-orthonormal modes and their squares from vectors (n, b) in rising order that the eigensolver made orthogonal in K.

    Slow motions hardly show in K, so fast vectors carry shares of them. Freed of all that is slower they are solved anew, and
    those within a step of the lowest are taken.
    """
    slower = R
    squares = [np.zeros(0)]
    while V.shape[1]:
        for _ in range(2):
            V = V - slower @ (slower.T @ (M @ V))
        V = V / np.sqrt(np.einsum("ij,ij->j", V, K @ V))
        mass = V.T @ (M @ V)
        strain = V.T @ (K @ V)
        mu, turned = la.eigh(0.5 * (mass + mass.T), 0.5 * (strain + strain.T))
        V = V @ turned[:, ::-1]
        lam = 1.0 / mu[::-1]
        V = V / np.sqrt(np.einsum("ij,ij->j", V, M @ V))
        count = max(1, int(np.searchsorted(lam, _STEP * lam[0])))
        slower = np.hstack([slower, V[:, :count]])
        V = V[:, count:]
        squares.append(lam[:count])
    return slower[:, R.shape[1] :], np.concatenate(squares)


def _pairs(K: np.ndarray, D: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Roots, shapes (b, nz) and gains (nz, b) of q'' + D q' + K q = f in an orthonormal basis."""
    b = K.shape[0]
    if b == 0:
        return np.zeros(0, complex), np.zeros((0, 0), complex), np.zeros((0, 0), complex)
    diagonal = np.diag(K)

    # Modal damping: K and D are diagonal but for the rounding of V^T D V, and the roots are those of single oscillators.
    off = np.abs(K - np.diag(diagonal)).max()
    if np.abs(D - np.diag(np.diag(D))).max() <= 1e-13 * np.abs(D).max(initial=0.0) and off <= 1e-12 * np.abs(K).max():
        half = 0.5 * np.diag(D)
        root = np.sqrt((half**2 - diagonal).astype(complex))
        if np.all(root.imag > 0.0):
            s = -half + root
            return s, 2.0 * np.eye(b, dtype=complex), np.diag(1.0 / (2.0 * root))

    # In w = [sqrt(k_jj) q_j, q_j'] an undamped structure has orthogonal eigenvectors, whatever its frequencies.
    unit = np.sqrt(np.maximum(diagonal, 1e-12 * np.abs(diagonal).max(initial=1e-300)))
    A = np.zeros((2 * b, 2 * b))
    A[:b, b:] = np.diag(unit)
    A[b:, :b] = -K / unit
    A[b:, b:] = -D
    s, X = la.eig(A)
    condition = float(np.linalg.cond(X, 1))
    if not condition < _WORST_CONDITION:
        raise ConvergenceError(f"complex modes lie too near to each other (condition {condition:.1e}); use newmark")
    Y = la.inv(X)  # left vectors, biorthonormal to X
    kept = s.imag >= 0.0
    weight = np.where(s[kept].imag > 0.0, 2.0, 1.0)
    return s[kept], X[:b, kept] * weight / unit[:, None], Y[kept][:, b:]
