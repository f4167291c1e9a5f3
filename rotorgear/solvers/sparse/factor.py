"""Sparse factorisations with their guards: A = L D L^T (symmetric, counts negative pivots) and A = L U (general).

By Sylvester's law of inertia the signs of D count the eigenvalues of K x = lambda M x below s when A = K - s M:
Parlett, The Symmetric Eigenvalue Problem, section 3.3 (SIAM 1998).
"""

from __future__ import annotations

from contextlib import AbstractContextManager, nullcontext
from functools import cache, cached_property
from typing import Any, Literal

import numpy as np
import scipy.sparse as sp
from scipy.linalg.lapack import zhetrf
from scipy.sparse.linalg import SuperLU, splu
from threadpoolctl import ThreadpoolController

from rotorgear.errors import ConvergenceError
from rotorgear.solvers.sparse.entries import norm_1

# Unknowns from which a second BLAS thread saves more than it costs.
_THREADS_PAY_FROM = 2000


@cache
def _controller() -> ThreadpoolController:
    """The one controller: it scans the loaded libraries, which takes a millisecond."""
    return ThreadpoolController()


def single_thread(n: int) -> AbstractContextManager[object]:
    """Limit BLAS to one thread while n < 2000 unknowns are solved: more threads only wait for each other."""
    if n >= _THREADS_PAY_FROM or all(library.num_threads == 1 for library in _controller().lib_controllers):
        return nullcontext()
    context: AbstractContextManager[object] = _controller().limit(limits=1)
    return context


class Factor:
    """Sparse LU of a square matrix; `solve(b)` for b (n,) or (n, p), real or complex like the matrix.

    With `order` (n,) the factors are those of A[order][:, order], and `solve` is still that of A.
    """

    def __init__(self, lu: SuperLU, *, is_complex: bool, order: np.ndarray | None = None) -> None:
        self._lu: Any = lu  # the stubs of scipy know fewer types of right-hand sides than SuperLU takes
        self._is_complex = is_complex  # SuperLU itself tells by a copy of all its entries only
        self._order = order

    @property
    def n(self) -> int:
        """Number of unknowns."""
        return int(self._lu.shape[0])

    @property
    def columns(self) -> np.ndarray:
        """Columns (n,) in the order in which they were eliminated."""
        return np.argsort(self._lu.perm_c)

    def solve(self, b: np.ndarray, *, transposed: bool = False) -> np.ndarray:
        """Solve A x = b, or A^T x = b when `transposed`. A real factor accepts a complex b."""
        if self._order is None:
            return self._solved(b, transposed)
        x = self._solved(b[self._order], transposed)
        back = np.empty_like(x)
        back[self._order] = x
        return back

    def _solved(self, b: np.ndarray, transposed: bool) -> np.ndarray:
        trans: Literal["T", "N"] = "T" if transposed else "N"
        if not np.iscomplexobj(b) or self._is_complex:
            return self._solve(b, trans)
        parts = np.ascontiguousarray(b).view(float).reshape(b.shape[0], -1)  # twice as many real columns
        return np.ascontiguousarray(self._solve(parts, trans)).view(complex).reshape(b.shape)

    def _solve(self, b: np.ndarray, trans: Literal["T", "N"]) -> np.ndarray:
        x: np.ndarray = self._lu.solve(np.ascontiguousarray(b) if b.ndim == 1 else np.asfortranarray(b), trans)
        return x


class SymmetricFactor(Factor):
    """A = L D L^T of a symmetric matrix without pivoting, in a fill-reducing order."""

    @cached_property
    def pivots(self) -> np.ndarray:
        """The diagonal of D, in the order of elimination."""
        pivots: np.ndarray = self._lu.U.diagonal()
        return pivots

    def negative_count(self) -> int:
        """Number of negative eigenvalues of a real symmetric or complex Hermitian A (Sylvester's law of inertia)."""
        return int(np.count_nonzero(self.pivots.real < 0.0))

    def pivots_by_row(self) -> np.ndarray:
        """The pivot each row of A met (n,): a tiny one marks a row that depends on rows eliminated before."""
        by_row: np.ndarray = self.pivots[self._lu.perm_r]
        return by_row


def factor_symmetric(A: sp.csc_array) -> SymmetricFactor:
    """Factor a symmetric sparse matrix without row exchanges, so that the pivot signs are the inertia.

    Without pivoting an indefinite matrix may lose accuracy: check with `solve_error` where that matters.

    Raises:
        ConvergenceError: the matrix is singular, holds NaN, or needs row exchanges.
    """
    return SymmetricFactor(symmetric_superlu(A, "MMD_AT_PLUS_A"), is_complex=np.iscomplexobj(A.data))


def symmetric_superlu(A: sp.csc_array, order: Literal["MMD_AT_PLUS_A", "NATURAL"]) -> SuperLU:
    """SuperLU's factors of a symmetric matrix with all pivots on the diagonal, in minimum degree or in the order it comes in.

    Raises:
        ConvergenceError: the matrix is singular, holds NaN, or needs row exchanges.
    """
    # Threshold 0 keeps every pivot on the diagonal: L U with U = D L^T, whose signs are the inertia.
    lu = _superlu(A, permc_spec=order, diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    if not np.array_equal(lu.perm_r, lu.perm_c):
        raise ConvergenceError(
            f"The symmetric {A.shape[0]} x {A.shape[0]} matrix met a zero pivot; shift it away from its eigenvalues."
        )
    return lu


def negative_eigenvalues(A: np.ndarray) -> int:
    """How many eigenvalues of a dense Hermitian matrix (n, n) are negative, by the pivots of A = L D L^H of Bunch and Kaufman.

    A pivot of two rows is one that has eigenvalues of either sign.
    """
    factored, rows, _ = zhetrf(A, lower=True)
    alone = rows > 0
    return int(np.count_nonzero(factored.diagonal().real[alone] < 0.0)) + int(np.count_nonzero(~alone)) // 2


def factor_general(A: sp.csc_array) -> Factor:
    """Factor a general sparse matrix (real or complex) with partial pivoting that prefers the diagonal.

    Raises:
        ConvergenceError: the matrix is singular or holds NaN.
    """
    # Rows are exchanged only where the diagonal is less than a tenth of its column: the symmetric order keeps its low fill.
    return Factor(_general_superlu(A, "MMD_AT_PLUS_A"), is_complex=np.iscomplexobj(A.data))


def factor_in_order(A: sp.csc_array, order: np.ndarray) -> Factor:
    """Factor a general sparse matrix whose rows and columns already stand in a fill-reducing order (n,) of another's.

    `solve` is that of the other matrix: to look for the order is half of the work where many matrices share a pattern.

    Raises:
        ConvergenceError: the matrix is singular or holds NaN.
    """
    return Factor(_general_superlu(A, "NATURAL"), is_complex=np.iscomplexobj(A.data), order=order)


def _general_superlu(A: sp.csc_array, order: Literal["MMD_AT_PLUS_A", "NATURAL"]) -> SuperLU:
    return _superlu(A, permc_spec=order, diag_pivot_thresh=0.1, options={"SymmetricMode": True})


def solve_error(A: sp.csc_array, factor: Factor) -> float:
    """Backward error ||A x - b|| / (||A||_1 ||x|| + ||b||) of one solve with a fixed b: 1e-16 for a healthy factor."""
    # Random, so that it meets every pivot; fixed, to be repeatable.
    b = np.random.default_rng(7).standard_normal(factor.n)
    x = factor.solve(b)
    return float(np.linalg.norm(A @ x - b) / (norm_1(A) * np.linalg.norm(x) + np.linalg.norm(b)))


def _superlu(A: sp.csc_array, **how: Any) -> SuperLU:
    """SuperLU's factors of a matrix, with its refusals in words."""
    A = sp.csc_array(A)
    if not np.all(np.isfinite(A.data)):
        raise ConvergenceError("The matrix to factor holds entries that are not finite; check the input for NaN.")
    try:
        lu = splu(A, **how)
    except RuntimeError as error:  # SuperLU: "Factor is exactly singular"
        raise ConvergenceError(
            f"The {A.shape[0]} x {A.shape[0]} matrix is singular: some motion meets neither stiffness nor inertia."
        ) from error
    return lu
