"""Sums and scalings on the entries of a sparse matrix give what scipy's products give."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp

from rotorgear.solvers.sparse.entries import (
    halves,
    norm_1,
    row_products,
    scaled_norm_1,
    scaled_on_both_sides,
    stretches,
    without_zeros,
)


def scattered(shape: tuple[int, int], density: float, rng: np.random.Generator) -> np.ndarray:
    """A matrix with about this share of entries that are not zero."""
    return np.where(rng.random(shape) < density, rng.standard_normal(shape), 0.0)


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
    A = sp.csr_array(scattered((rows, 50), 0.1, rng))
    X = rng.standard_normal((50, 3))
    product = np.full((rows, 3), np.nan)
    for part, values in row_products(A, X):
        product[part] = values
    assert np.array_equal(product, A @ X)
    assert [k for part in stretches(rows) for k in range(rows)[part]] == list(range(rows))


def test_halves_and_scaled_norms_are_what_dense_matrices_give() -> None:
    rng = np.random.default_rng(5)
    for density in (0.1, 1.0):  # with one pattern for A and its mirror image, and with two
        A = sp.csc_array(scattered((9, 9), density, rng))
        dense = A.toarray()
        even, odd = halves(A)
        assert np.array_equal(even.toarray(), 0.5 * (dense + dense.T))
        assert np.array_equal(odd.toarray(), 0.5 * (dense - dense.T))
        assert odd.data.all(), "no zero is stored"
        scale = np.geomspace(1e-3, 10.0, 9)
        assert scaled_norm_1(A, scale) == pytest.approx(np.linalg.norm(scale[:, None] * dense * scale, 1), rel=1e-14)


def test_zeros_are_left_out_and_the_matrix_itself_stays() -> None:
    A = sp.csc_array((np.array([1.0, 0.0, 2.0, 0.0]), np.array([0, 2, 1, 0]), np.array([0, 2, 3, 4])), shape=(3, 3))
    before = A.toarray()
    shorter = without_zeros(A)
    assert shorter.nnz == 2
    assert A.nnz == 4
    assert np.array_equal(shorter.toarray(), before)
    assert without_zeros(shorter) is shorter
