"""What K x = lambda M x must satisfy before it is solved, and how far its rounding can be trusted.

Elementwise |fl(K v) - K v| <= eps |K||v|, so the Rayleigh quotient of a stored K carries the noise
eps |v|^T |K| |v| / (v^T M v): Higham, Accuracy and Stability of Numerical Algorithms, 2nd ed., section 3.5.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import scipy.sparse as sp

from rotorgear.errors import AnalysisError, ConvergenceError
from rotorgear.solvers.sparse.entries import norm_1, row_products
from rotorgear.solvers.sparse.factor import SymmetricFactor, factor_symmetric, solve_error

EPS = float(np.finfo(float).eps)
EDGE = 1e-9  # a mode whose frequency is this close above a limit counts as on it
_SYMMETRY = 1e-9  # an entry may differ from its mirror image by this share of sqrt(a_ii a_jj)
_LIFT = 4.0 * EPS  # added to diagonals, relative to them, so that an exactly zero pivot shows as a tiny one
_ZERO_PIVOT = 100.0 * EPS  # pivots below this share of the diagonal are rounding
_DENSE_UP_TO = 250  # unknowns up to which all eigenvalues of one matrix cost milliseconds
_SURE = 1e-12  # eigenvalues of a matrix with rows of size 1 above this have the sign that they show
_ACCURATE = 1e-9  # backward error of a solve up to which the pivots' signs are believed
# Columns that are taken together of a matrix too tall for the cache, and the entries that it holds.
_FEW_COLUMNS = 8
_IN_CACHE = 100_000
Strain = Callable[[np.ndarray], np.ndarray] | sp.csr_array  # V (n, m) -> S V (p, m), or S itself


class LooseDofError(AnalysisError):
    """Some dof has neither inertia nor stiffness. `dofs` holds the indices, for upper floors to name."""

    def __init__(self, dofs: np.ndarray) -> None:
        self.dofs: tuple[int, ...] = tuple(int(dof) for dof in dofs)
        listed = ", ".join(str(dof) for dof in self.dofs[:10])
        super().__init__(
            f"Degrees of freedom {listed} move with neither inertia nor stiffness; give them one of the two or fix them."
        )


def check_pencil(M: sp.csc_array, K: sp.csc_array) -> np.ndarray:
    """Refuse what is no symmetric pair without loose dofs; return the indices of the massless dofs.

    Raises:
        AnalysisError: shapes differ, entries are not finite, or a matrix is not symmetric.
        LooseDofError: massless dofs can move among themselves without strain.
    """
    if M.shape != K.shape or K.shape[0] != K.shape[1]:
        raise AnalysisError(f"M {M.shape} and K {K.shape} must be square and of one size.")
    check_finite(M=M, K=K)
    for name, A in (("M", M), ("K", K)):
        # No entry may differ from its mirror image by more than a share of sqrt(a_ii a_jj).
        mirror = A.T.tocsc()
        if np.array_equal(mirror.indices, A.indices) and np.array_equal(mirror.data, A.data):
            continue
        skew = sp.coo_array(abs(A - mirror))
        scale = np.sqrt(np.abs(A.diagonal()))
        if np.any(skew.data > _SYMMETRY * (scale[skew.row] * scale[skew.col])):
            raise AnalysisError(f"{name} is not symmetric: use the damped solver for circulatory or gyroscopic terms.")

    # A semidefinite pencil is singular exactly when the massless block of K is: one of its pivots is then zero.
    massless = np.flatnonzero(M.diagonal() <= 0.0)
    if massless.size:
        block = sp.csc_array(K[massless][:, massless])
        diagonal = block.diagonal()
        if np.any(diagonal <= 0.0):
            raise LooseDofError(massless[diagonal <= 0.0])
        lifted = sp.csc_array(block + sp.diags_array(_LIFT * diagonal))
        loose = factor_symmetric(lifted).pivots_by_row() < _ZERO_PIVOT * diagonal
        if np.any(loose):
            raise LooseDofError(massless[loose])
    return massless


def check_finite(**matrices: sp.csc_array) -> None:
    """Refuse matrices, given by their names, with entries that are not finite (AnalysisError)."""
    for name, A in matrices.items():
        if not np.all(np.isfinite(A.data)):
            raise AnalysisError(f"{name} holds entries that are not finite; check the input for NaN.")


def check_wanted(count: int | None, below: float | None) -> None:
    """Refuse a number of modes below 1 and a highest frequency `below` (rad/s) that is not positive (AnalysisError)."""
    if count is not None and count < 1:
        raise AnalysisError(f"The number of modes must be at least 1, got {count}.")
    if below is not None and not below > 0.0:
        raise AnalysisError(f"The highest frequency wanted must be positive, got {below} rad/s.")


def rounding_noise(size_K: sp.csr_array | sp.csc_array, V: np.ndarray, shift: float = 0.0) -> np.ndarray:
    """Noise of the Rayleigh quotients (m,) of M-normal columns of V (n, m) for a K of doubles, size_K = |K|."""
    noise = np.zeros(V.shape[1])
    together = max(_FEW_COLUMNS, _IN_CACHE // max(V.shape[0], 1))
    for first in range(0, V.shape[1], together):
        size = np.abs(V[:, first : first + together], order="C")
        noise[first : first + together] = np.einsum("ij,ij->j", size, size_K @ size)
    return np.asarray(EPS * (noise + abs(shift)))


def backward_errors(M: sp.csr_array, K: sp.csr_array, values: np.ndarray, V: np.ndarray) -> np.ndarray:
    """||K v - lambda M v|| / ((||K||_1 + |lambda| ||M||_1) ||v||) of each pair: (m,)."""
    squares = np.zeros(V.shape[1])
    for (_, force), (_, heavy) in zip(row_products(K, V), row_products(M, V), strict=True):
        heavy *= values
        force -= heavy
        squares += np.einsum("ij,ij->j", force, force)
    size = (norm_1(K) + np.abs(values) * norm_1(M)) * np.sqrt(np.einsum("ij,ij->j", V, V))
    errors: np.ndarray = np.sqrt(squares) / np.maximum(size, np.finfo(float).tiny)  # K = 0 leaves no residual either
    return errors


def count_below(M: sp.csc_array, K: sp.csc_array, shift: float) -> int:
    """Number of eigenvalues of K x = lambda M x below the shift, from the signs of the pivots of K - shift M.

    Two equal bodies on one spring have a zero diagonal halfway between their two eigenvalues: no pivot on the diagonal then
    exists, however far the shift is from both. A small pencil then falls back on the eigenvalues of K - shift M itself.

    Raises:
        ConvergenceError: the factors stay inaccurate when the shift is moved by a billionth or so: it lies in a cluster of
            eigenvalues.
    """
    # On an eigenvalue the factors without pivoting blow up; a nudge that passes no other eigenvalue does not change the count.
    for nudge in (0.0, 1e-9, -1e-9, 1e-8, -1e-8):
        A = sp.csc_array(K - shift * (1.0 + nudge) * M)
        try:
            factor: SymmetricFactor = factor_symmetric(A)
        except ConvergenceError:
            continue
        if solve_error(A, factor) < _ACCURATE:
            return factor.negative_count()
    if K.shape[0] <= _DENSE_UP_TO:
        # Scaling the dofs leaves the signs (Sylvester), and makes rounding relative to the stiffness and inertia of each.
        size = np.sqrt(np.abs(K.diagonal()) + abs(shift) * M.diagonal())
        signs = np.linalg.eigvalsh((K - shift * M).toarray() / size / size[:, None])
        if np.abs(signs).min() > _SURE:
            return int(np.count_nonzero(signs < 0.0))
    raise ConvergenceError(f"No accurate factors of K - {shift:.6g} M: the shift lies in a cluster of eigenvalues.")
