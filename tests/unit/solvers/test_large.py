"""Factorisation of large positive definite matrices: every order that is installed gives one answer."""

from __future__ import annotations

import importlib.util

import numpy as np
import pytest
import scipy.sparse as sp

from rotorgear.errors import AnalysisError, ConvergenceError
from rotorgear.solvers.sparse.large import Solver, best_solver, factor_positive, forecast

PACKAGES = {"pardiso": "pypardiso", "metis": "pymetis", "mmd": "scipy"}
HERE: list[Solver] = [name for name in ("pardiso", "metis", "mmd") if importlib.util.find_spec(PACKAGES[name])]  # type: ignore[misc]


def grid(n: int) -> sp.csr_array:
    """Three unknowns at each node of an n x n grid of springs, coupled at the node."""
    line = sp.diags_array([-np.ones(n - 1), 2.1 * np.ones(n), -np.ones(n - 1)], offsets=[-1, 0, 1])
    plane = sp.kron(line, sp.eye_array(n)) + sp.kron(sp.eye_array(n), line)
    return sp.csr_array(sp.kron(plane, np.array([[2.0, 0.3, 0.1], [0.3, 1.5, 0.2], [0.1, 0.2, 1.0]])))


@pytest.mark.parametrize("solver", HERE)
def test_every_solver_that_is_installed_solves(solver: Solver) -> None:
    A = grid(12)
    X = np.random.default_rng(1).standard_normal((A.shape[0], 4))
    solve = factor_positive(A, 3, "test", solver=solver)
    np.testing.assert_allclose(solve(A @ X), X, atol=1e-10)
    np.testing.assert_allclose(solve(A @ X[:, 0]), X[:, 0], atol=1e-10)


def test_a_long_factorisation_is_forecast_before_it_starts_and_one_without_memory_is_refused() -> None:
    assert forecast(139_000, "mmd")[0] == pytest.approx(65.0)
    assert forecast(139_000, "metis")[1] < forecast(139_000, "mmd")[1]
    huge = sp.csr_array((10**9, 10**9))
    with pytest.raises(AnalysisError, match=r"takes about .* GB, and this machine has .* install pymetis"):
        factor_positive(huge, 3, "casings.box", solver="mmd")


def test_a_singular_matrix_is_told() -> None:
    with pytest.raises(ConvergenceError, match="singular"):
        factor_positive(sp.csr_array(np.diag([1.0, 0.0, 1.0])), 3, "test", solver="mmd")


def test_the_best_that_is_installed_is_taken() -> None:
    assert best_solver() == HERE[0]
