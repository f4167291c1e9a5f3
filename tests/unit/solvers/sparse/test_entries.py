"""Sums and scalings on the entries of a sparse matrix give what scipy's products give."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp

from rotorgear.solvers.sparse.entries import norm_1, row_products, scaled_on_both_sides, stretches


@pytest.mark.parametrize("kind", [sp.csc_array, sp.csr_array])
def test_the_norm_is_the_largest_sum_of_a_column(kind: type) -> None:
    A = np.array([[1.0, -2.0, 0.0], [0.0, 3.0, 0.0], [-4.5, 0.0, 0.0]])
    assert norm_1(kind(A)) == 5.5 == np.linalg.norm(A, 1)
    assert norm_1(kind((3, 3))) == 0.0


def test_scaling_on_both_sides_leaves_the_matrix_itself_alone() -> None:
    rows, columns = np.nonzero(np.random.default_rng(1).random((7, 7)) < 0.4)
    A = sp.csc_array((1.0 + rows + 7.0 * columns, (rows, columns)), shape=(7, 7))
    before = A.toarray()
    scale = np.linspace(0.5, 3.0, 7)
    scaled = scaled_on_both_sides(A, scale)
    np.testing.assert_allclose(scaled.toarray(), scale[:, None] * before * scale, rtol=1e-15)
    scaled.data[:] = 0.0
    scaled.indices[:] = 0
    assert np.array_equal(A.toarray(), before)


@pytest.mark.parametrize("rows", [0, 3, 4096, 4097, 10_000])
def test_products_by_stretches_of_rows_are_the_product(rows: int) -> None:
    rng = np.random.default_rng(2)
    A = sp.csr_array(sp.random_array((rows, 50), density=0.1, rng=rng))
    X = rng.standard_normal((50, 3))
    product = np.full((rows, 3), np.nan)
    for part, values in row_products(A, X):
        product[part] = values
    assert np.array_equal(product, A @ X)
    assert [k for part in stretches(rows) for k in range(rows)[part]] == list(range(rows))
