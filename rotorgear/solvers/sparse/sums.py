"""Sums of sparse matrices with weights that change, such as K + i w D - w^2 M over w, factored on one pattern in one order.

scipy makes a new matrix, with checks, for each product and sum of a dynamic stiffness, and SuperLU looks for an order that keeps
the fill low each time; both depend on the pattern only: Davis, Direct Methods for Sparse Linear Systems (SIAM 2006), chapter 7.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import scipy.sparse as sp

from rotorgear.solvers.sparse.entries import on_one_pattern
from rotorgear.solvers.sparse.factor import Factor, factor_general, factor_in_order


class SparseSums:
    """Weighted sums of some square real sparse matrices, at least one."""

    def __init__(self, *parts: sp.csc_array) -> None:
        # Rows of the transposed matrices are columns.
        self._ends, self._rows, values = on_one_pattern(*(part.T for part in parts))
        self._values = np.array(values)
        self._order: np.ndarray | None = None

    def factor(self, weights: Sequence[complex]) -> Factor:
        """Factors of the sum of each part times its weight.

        Raises:
            ConvergenceError: the sum is singular or holds NaN.
        """
        given = np.asarray(weights, complex)
        entries = given.real @ self._values + 1j * (given.imag @ self._values)
        n = len(self._ends) - 1
        A = sp.csc_array((entries, self._rows, self._ends), shape=(n, n))
        if self._order is not None:
            return factor_in_order(A, self._order)
        first = factor_general(A)
        self._order = first.columns
        # Entries are numbered before their rows and columns change places, and are read by these numbers after.
        numbered = sp.csc_array((np.arange(1, entries.size + 1), self._rows, self._ends), shape=(n, n))
        ordered = sp.csc_array(numbered[self._order][:, self._order])
        ordered.sort_indices()
        self._values = self._values[:, ordered.data - 1]
        self._rows = ordered.indices
        self._ends = ordered.indptr
        return first
