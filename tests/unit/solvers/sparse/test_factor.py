import numpy as np
import pytest
import scipy.sparse as sp
from threadpoolctl import threadpool_info

from rotorgear.errors import ConvergenceError
from rotorgear.solvers.sparse.factor import (
    factor_general,
    factor_symmetric,
    negative_eigenvalues,
    single_thread,
    solve_error,
)


def _random_symmetric(n: int, seed: int) -> np.ndarray:
    A = np.random.default_rng(seed).standard_normal((n, n))
    return A + A.T


@pytest.mark.parametrize("seed", range(5))
def test_pivot_signs_count_the_negative_eigenvalues(seed):
    A = _random_symmetric(30, seed)
    assert factor_symmetric(sp.csc_array(A)).negative_count() == np.count_nonzero(np.linalg.eigvalsh(A) < 0)


def test_a_symmetric_factor_solves_blocks_and_complex_right_hand_sides():
    A = _random_symmetric(20, 1) + 40 * np.eye(20)
    factor = factor_symmetric(sp.csc_array(A))
    b = np.random.default_rng(2).standard_normal((20, 3)) * (1 + 2j)
    np.testing.assert_allclose(A @ factor.solve(b), b, atol=1e-13)
    np.testing.assert_allclose(A @ factor.solve(b[:, 0].real), b[:, 0].real, atol=1e-13)


def test_a_general_factor_solves_the_transposed_system():
    A = np.random.default_rng(3).standard_normal((15, 15)) + 10 * np.eye(15)
    factor = factor_general(sp.csc_array(A))
    b = np.arange(15.0)
    np.testing.assert_allclose(A.T @ factor.solve(b, transposed=True), b, atol=1e-12)
    assert solve_error(sp.csc_array(A), factor) < 1e-15


def test_pivots_are_returned_in_the_order_of_the_rows():
    diagonal = np.array([3.0, 5.0, 2.0, 7.0])
    np.testing.assert_array_equal(factor_symmetric(sp.csc_array(np.diag(diagonal))).pivots_by_row(), diagonal)


@pytest.mark.parametrize("factor", [factor_symmetric, factor_general])
def test_a_singular_matrix_is_refused_in_a_sentence(factor):
    with pytest.raises(ConvergenceError, match="singular"):
        factor(sp.csc_array(np.diag([1.0, 0.0, 2.0])))


@pytest.mark.parametrize("factor", [factor_symmetric, factor_general])
def test_nan_is_refused_in_a_sentence(factor):
    with pytest.raises(ConvergenceError, match="not finite"):
        factor(sp.csc_array(np.diag([1.0, np.nan])))


def test_a_zero_diagonal_that_needs_row_exchanges_is_refused():
    with pytest.raises(ConvergenceError, match="pivot"):
        factor_symmetric(sp.csc_array([[0.0, 1.0], [1.0, 0.0]]))


def test_small_problems_use_one_thread_and_give_the_threads_back():
    before = [pool["num_threads"] for pool in threadpool_info()]
    with single_thread(100):
        assert all(pool["num_threads"] == 1 for pool in threadpool_info() if pool["user_api"] == "blas")
    assert [pool["num_threads"] for pool in threadpool_info()] == before


@pytest.mark.parametrize("n", [1, 2, 7, 41])
@pytest.mark.parametrize("empty_diagonal", [False, True])
def test_pivots_of_one_and_two_rows_count_the_negative_eigenvalues_of_a_dense_hermitian_matrix(n, empty_diagonal):
    rng = np.random.default_rng(n)
    for _ in range(20):
        A = rng.standard_normal((n, n)) + 1j * rng.standard_normal((n, n))
        A = A + A.conj().T
        if empty_diagonal and n > 1:  # no pivot of one row to begin with
            A[np.arange(n), np.arange(n)] = 0.0
        assert negative_eigenvalues(A) == np.count_nonzero(np.linalg.eigvalsh(A) < 0.0)


def test_the_backward_error_of_another_matrix_factor_has_its_closed_form():
    """A = 2 I with the factor of 6 I: x = b/6, so that |b/3 - b| / (2 |b|/6 + |b|) = 1/2."""
    A = sp.csc_array(2.0 * np.eye(9))
    assert solve_error(A, factor_general(sp.csc_array(3.0 * A))) == pytest.approx(0.5, rel=1e-12)
