"""Sums and scalings of a sparse matrix on its entries alone: scipy makes a new matrix, with checks, for each step of them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TypeVar

import numpy as np
import scipy.sparse as sp

Compressed = TypeVar("Compressed", sp.csc_array, sp.csr_array)
_ROWS = 4096  # some thirty columns of so many rows fill the cache of a core


def norm_1(A: sp.csc_array | sp.csr_array) -> float:
    """||A||_1, the largest sum of magnitudes in a column."""
    sums = np.bincount(_columns(A), np.abs(A.data), minlength=A.shape[1])
    return float(sums.max(initial=0.0))


def scaled_on_both_sides(A: sp.csc_array, scale: np.ndarray) -> sp.csc_array:
    """diag(scale) A diag(scale) for scale (n,)."""
    scaled = A.copy()
    scaled.data *= scale[A.indices] * np.repeat(scale, np.diff(A.indptr))
    return scaled


def magnitudes(A: Compressed) -> Compressed:
    """|A|, entry by entry."""
    return type(A)((np.abs(A.data), A.indices, A.indptr), shape=A.shape)


def times(A: sp.csc_array | sp.csr_array | np.ndarray, X: np.ndarray) -> np.ndarray:
    """A X (n, m) of a real A: complex columns as twice as many real ones, at half the cost of making A complex first."""
    if not np.iscomplexobj(X):
        return np.asarray(A @ X)
    return np.asarray((A @ np.ascontiguousarray(X).view(float)).view(complex))


def stretches(n: int) -> Iterator[slice]:
    """Rows 0 to n in stretches that stay in the cache: a tall result is then written once, without temporaries of its size."""
    for first in range(0, n, _ROWS):
        yield slice(first, min(first + _ROWS, n))


def row_products(A: sp.csr_array, X: np.ndarray) -> Iterator[tuple[slice, np.ndarray]]:
    """A X by stretches of rows: which rows, and their product (r, m) with X (n, m), best stored by rows."""
    if A.shape[0] <= _ROWS:
        yield slice(None), A @ X
        return
    for rows in stretches(A.shape[0]):
        ends = A.indptr[rows.start : rows.stop + 1]
        entries = slice(ends[0], ends[-1])
        part = sp.csr_array((A.data[entries], A.indices[entries], ends - ends[0]), shape=(len(ends) - 1, A.shape[1]))
        yield rows, part @ X


def _columns(A: sp.csc_array | sp.csr_array) -> np.ndarray:
    """The column of each entry."""
    return A.indices if A.format == "csr" else np.repeat(np.arange(A.shape[1]), np.diff(A.indptr))
