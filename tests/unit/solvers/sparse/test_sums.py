"""Sums of sparse matrices with changing weights, against the same sums of dense ones."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp

from rotorgear.errors import ConvergenceError
from rotorgear.solvers.sparse.sums import SparseSums


def _parts(n: int = 40) -> list[sp.csc_array]:
    """Matrices of unlike patterns: a diagonal, a band that is not symmetric, and a few entries far off it."""
    random = np.random.default_rng(3)
    band = sp.diags_array(
        [random.random(n - 2) + 1.0, 9.0 + random.random(n), random.random(n - 1)], offsets=(-2, 0, 1)
    )
    far = sp.coo_array((random.random(5), (random.integers(0, n, 5), random.integers(0, n, 5))), shape=(n, n))
    return [sp.csc_array(sp.diags_array(1.0 + random.random(n))), sp.csc_array(band), sp.csc_array(far)]


@pytest.mark.parametrize("transposed", [False, True])
def test_factors_of_each_sum_solve_it_and_not_the_one_before(transposed: bool) -> None:
    parts = _parts()
    sums = SparseSums(*parts)
    b = np.random.default_rng(4).standard_normal((40, 2)) * (1.0 + 2.0j)
    for weights in ((-2.0, 1.0, 0.5j), (1.0j, 3.0 - 1.0j, 2.0), (0.0, 1.0, 0.0)):
        dense = sum(w * A.toarray() for w, A in zip(weights, parts, strict=True))
        x = sums.factor(weights).solve(b, transposed=transposed)
        np.testing.assert_allclose((dense.T if transposed else dense) @ x, b, rtol=0.0, atol=1e-13)


def test_a_sum_that_is_singular_is_refused_before_and_after_the_order_is_known() -> None:
    sums = SparseSums(*_parts())
    for _ in range(2):
        with pytest.raises(ConvergenceError, match="singular"):
            sums.factor((0.0, 0.0, 0.0))
        sums.factor((1.0, 1.0, 1.0))
