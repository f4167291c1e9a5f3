"""The Krylov basis stays nearly orthonormal where passes over the whole of it are left out, and goes when its owner goes."""

from __future__ import annotations

import gc
import weakref

import numpy as np
import pytest
import scipy.sparse as sp

from rotorgear.solvers.eigen.krylov import BlockKrylov
from rotorgear.solvers.eigen.shift_invert import ShiftInvert, shifted_operator
from tests.unit.solvers.spring_chains import bar, clamped_bar_frequencies, copies


def _operator(count: int, n: int, mass: float) -> ShiftInvert:
    """Shift and invert of `count` separate bars between walls, with a mass that rises along each bar where `mass` is not 1."""
    M, K, strain = bar(n, 1e6, 1.0, {0: 1e6, n - 1: 1e6})
    M, K, _ = copies(count, M, K, strain)
    weight = sp.diags_array(np.tile(np.geomspace(1.0, mass, n), count))
    return shifted_operator(sp.csc_array(weight @ M), K)


@pytest.mark.parametrize(("count", "n", "mass"), [(1, 2000, 1.0), (3, 700, 1.0), (1, 300, 1e6), (6, 60, 1e-4)])
def test_passes_that_are_left_out_cost_no_orthogonality_that_counts(count: int, n: int, mass: float) -> None:
    operator = _operator(count, n, mass)
    krylov = operator.krylov
    left_out = []
    estimated = krylov._drift_of
    krylov._drift_of = lambda gram: left_out.append(estimated(gram)) or left_out[-1]
    while krylov.size < 120 and not krylov.exhausted:
        krylov.expand()
    V = krylov.basis
    lost = np.abs(V.T @ (operator.mass @ V) - np.eye(krylov.size)).max()
    assert min(left_out) < 1e-9, "some pass was left out"
    assert lost < 1e-9
    # The estimate is a bound, though no strict one.
    assert lost < 10.0 * max(drift for drift in left_out if drift <= 1e-9)


def test_eigenvalues_of_a_basis_with_fewer_passes_are_exact_to_rounding() -> None:
    n = 3000
    operator = _operator(1, n, 1.0)
    krylov = operator.krylov
    while krylov.size < 80:
        krylov.expand()
    values, Y, residuals = operator.ritz(20)
    exact = (1e3 * clamped_bar_frequencies(n)[:20]) ** 2
    assert residuals.max() < 1e-9
    np.testing.assert_allclose(values, exact, rtol=1e-10)
    V = krylov.polished(Y)
    assert V.flags.c_contiguous
    np.testing.assert_allclose(
        V, operator.apply(krylov.basis @ Y), atol=1e-9 * np.abs(V).max(), err_msg="T V Y without applying T"
    )


def test_a_basis_goes_with_its_operator_without_a_look_for_garbage() -> None:
    operator = _operator(1, 300, 1.0)
    basis = weakref.ref(operator.krylov)
    gc.disable()
    try:
        del operator
        assert basis() is None, "a circle of references would keep the largest arrays there are"
    finally:
        gc.enable()


def test_arnoldi_takes_all_passes() -> None:
    rng = np.random.default_rng(4)
    A = rng.standard_normal((200, 200))
    krylov = BlockKrylov(lambda X: A @ X, 200, 3)
    while krylov.size < 90:
        krylov.expand()
    V = krylov.basis
    assert np.abs(V.T @ V - np.eye(krylov.size)).max() < 1e-13
    np.testing.assert_allclose(krylov.projection, V.T @ (A @ V), atol=1e-11)
