"""Groups of dofs that do not act on each other."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from rotorgear.system.components import independent_groups


def chain(*springs: float) -> sp.csc_array:
    """Masses in a row; a spring of stiffness 0 is an entry, too."""
    rows = []
    columns = []
    values = []
    for k, stiffness in enumerate(springs):
        rows += [k, k + 1, k, k + 1]
        columns += [k, k + 1, k + 1, k]
        values += [stiffness, stiffness, -stiffness, -stiffness]
    n = len(springs) + 1
    return sp.csc_array((values, (rows, columns)), shape=(n, n))


def test_entries_that_are_zero_join_nothing() -> None:
    K = chain(1.0, 0.0, 1.0, 1.0)
    M = sp.csc_array(sp.eye_array(5))
    before = K.copy()
    for matrices in ([K], [M, K], [K, M], [K, -K]):
        assert [list(group) for group in independent_groups(matrices)] == [[2, 3, 4], [0, 1]]
    assert np.array_equal(K.indices, before.indices)
    assert np.array_equal(K.data, before.data)


def test_a_matrix_that_holds_all_dofs_together_is_one_group() -> None:
    M = sp.csc_array(sp.eye_array(4))
    assert [list(group) for group in independent_groups([M, chain(1.0, -2.0, 1e-30)])] == [[0, 1, 2, 3]]
