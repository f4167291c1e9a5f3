"""Dense pairs by LAPACK itself, and products of real matrices with complex columns."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.linalg as la
import scipy.sparse as sp

from rotorgear.solvers.eigen.shift_invert import symmetric_pair
from rotorgear.solvers.sparse.entries import magnitudes, times


def test_a_symmetric_pair_is_solved_as_scipy_does() -> None:
    draw = np.random.default_rng(5)
    A = draw.standard_normal((12, 12))
    R = draw.standard_normal((12, 12))
    values, V = symmetric_pair(A + A.T, R @ R.T)
    expected, _ = la.eigh(A + A.T, R @ R.T)
    np.testing.assert_allclose(values, expected, rtol=1e-12)
    np.testing.assert_allclose(V.T @ (R @ R.T) @ V, np.eye(12), atol=1e-11)


@pytest.mark.parametrize("B", [-np.eye(3), np.diag([1.0, np.nan, 1.0])])
def test_a_right_matrix_that_is_not_positive_definite_is_refused(B: np.ndarray) -> None:
    with pytest.raises(la.LinAlgError):
        symmetric_pair(np.eye(3), B)


@pytest.mark.parametrize("form", [sp.csc_array, sp.csr_array])
def test_complex_columns_meet_a_real_matrix_as_real_ones(form: type) -> None:
    draw = np.random.default_rng(6)
    dense = draw.standard_normal((5, 4))
    X = (draw.standard_normal((4, 6)) + 1j * draw.standard_normal((4, 6)))[:, ::2]  # not contiguous
    np.testing.assert_allclose(times(form(dense), X), dense @ X, rtol=1e-13)
    np.testing.assert_array_equal(magnitudes(sp.csc_array(dense)).toarray(), np.abs(dense))
