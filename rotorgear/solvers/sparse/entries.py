"""Sums and scalings of a sparse matrix on its entries alone: scipy makes a new matrix, with checks, for each step of them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TypeVar

import numpy as np
import scipy.sparse as sp

Compressed = TypeVar("Compressed", sp.csc_array, sp.csr_array)
_ROWS = 4096  # about thirty columns of this many rows fill the cache of a core


def norm_1(A: sp.csc_array | sp.csr_array) -> float:
    """||A||_1, the largest sum of magnitudes in a column."""
    return float(np.bincount(columns_of(A), np.abs(A.data), minlength=A.shape[1]).max(initial=0.0))


def scaled_norm_1(A: sp.csc_array, scale: np.ndarray) -> float:
    """||diag(scale) A diag(scale)||_1 for a positive scale (n,), without the scaled matrix."""
    sums = np.bincount(columns_of(A), np.abs(A.data) * scale[A.indices], minlength=A.shape[1])
    return float((sums * scale).max(initial=0.0))


def scaled_on_both_sides(A: sp.csc_array, scale: np.ndarray) -> sp.csc_array:
    """diag(scale) A diag(scale) for scale (n,)."""
    scaled = A.copy()
    scaled.data *= scale[A.indices] * np.repeat(scale, np.diff(A.indptr))
    return scaled


def magnitudes(A: Compressed) -> Compressed:
    """|A|, entry by entry."""
    return type(A)((np.abs(A.data), A.indices, A.indptr), shape=A.shape)


def without_zeros(A: sp.csc_array) -> sp.csc_array:
    """A without stored entries that are zero."""
    if np.all(A.data):
        return A
    shorter = A.copy()
    shorter.eliminate_zeros()
    return shorter


def halves(A: sp.csc_array) -> tuple[sp.csc_array, sp.csc_array]:
    """(A + A^T)/2 and (A - A^T)/2."""
    mirror = sp.csc_array(A.T)
    if not (np.array_equal(mirror.indptr, A.indptr) and np.array_equal(mirror.indices, A.indices)):
        return without_zeros(sp.csc_array(0.5 * (A + mirror))), without_zeros(sp.csc_array(0.5 * (A - mirror)))
    even, odd = (
        sp.csc_array((values, A.indices, A.indptr), shape=A.shape)
        for values in (0.5 * (A.data + mirror.data), 0.5 * (A.data - mirror.data))
    )
    return without_zeros(even), without_zeros(odd)


def times(A: sp.csc_array | sp.csr_array | np.ndarray, X: np.ndarray) -> np.ndarray:
    """A X (n, m) of a real A: complex columns as twice as many real ones, at half the cost of making A complex first."""
    if not np.iscomplexobj(X):
        return np.asarray(A @ X)
    return np.asarray((A @ np.ascontiguousarray(X).view(float)).view(complex))


def unit_vectors(n: int, places: np.ndarray) -> np.ndarray:
    """Columns of the identity, (n, k) for places (k,)."""
    columns = np.zeros((n, places.size))
    columns[places, np.arange(places.size)] = 1.0
    return columns


def column_forms(A: sp.sparray | np.ndarray, V: np.ndarray) -> np.ndarray:
    """v^H A v of each column of V (n, m): (m,)."""
    return np.asarray(np.einsum("ij,ij->j", V.conj(), A @ V))


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


def on_one_pattern(*matrices: sp.csc_array | sp.csr_array) -> tuple[np.ndarray, np.ndarray, list[np.ndarray]]:
    """Row starts and columns of the union of some square sparse matrices, and the values of each in it, row by row."""
    n = matrices[0].shape[0]
    entries = [A.tocoo() for A in matrices]
    keys = [one.row.astype(np.int64) * n + one.col for one in entries]
    union = np.unique(np.concatenate(keys))
    first = np.searchsorted(union, n * np.arange(n + 1, dtype=np.int64))
    # numpy counts nothing in whole numbers, also with weights.
    values = [
        np.bincount(np.searchsorted(union, key), one.data, minlength=union.size).astype(float)
        for key, one in zip(keys, entries, strict=True)
    ]
    return first.astype(np.int32), (union % n).astype(np.int32), values


def columns_of(A: sp.csc_array | sp.csr_array) -> np.ndarray:
    """The column of each entry."""
    return A.indices if A.format == "csr" else np.repeat(np.arange(A.shape[1]), np.diff(A.indptr))
