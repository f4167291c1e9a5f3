"""Sums and scalings of a sparse matrix on its entries alone: scipy makes a new matrix, with checks, for each step of them."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp


def norm_1(A: sp.csc_array | sp.csr_array) -> float:
    """||A||_1, the largest sum of magnitudes in a column."""
    sums = np.bincount(_columns(A), np.abs(A.data), minlength=A.shape[1])
    return float(sums.max(initial=0.0))


def scaled_on_both_sides(A: sp.csc_array, scale: np.ndarray) -> sp.csc_array:
    """diag(scale) A diag(scale) for scale (n,)."""
    scaled = A.copy()
    scaled.data *= scale[A.indices] * np.repeat(scale, np.diff(A.indptr))
    return scaled


def magnitudes(A: sp.csc_array) -> sp.csc_array:
    """|A|, entry by entry."""
    return sp.csc_array((np.abs(A.data), A.indices, A.indptr), shape=A.shape)


def times(A: sp.csc_array | sp.csr_array | np.ndarray, X: np.ndarray) -> np.ndarray:
    """A X (n, m) of a real A: complex columns as twice as many real ones, at half the cost of making A complex first."""
    if not np.iscomplexobj(X):
        return np.asarray(A @ X)
    return np.asarray((A @ np.ascontiguousarray(X).view(float)).view(complex))


def _columns(A: sp.csc_array | sp.csr_array) -> np.ndarray:
    """The column of each entry."""
    return A.indices if A.format == "csr" else np.repeat(np.arange(A.shape[1]), np.diff(A.indptr))
