"""Equilibria of structures that may be free to move: closed forms, several load cases, and what is refused."""

import numpy as np
import pytest

from rotorgear.errors import AnalysisError
from rotorgear.solvers.sparse.nullspace import StaticSolver, UnbalancedLoadError
from tests.unit.solvers.spring_chains import Beam, bar, copies


def _residual(K, q, f):
    return np.linalg.norm(K @ q - f) / (abs(K).sum(axis=0).max() * np.linalg.norm(q) + np.linalg.norm(f))


def test_a_supported_chain_stretches_by_its_closed_form():
    _, K, _ = bar(50, stiffness=2.0, ground={0: 2.0})
    f = np.zeros((50, 1))
    f[-1] = 3.0
    q = StaticSolver(K, np.zeros((50, 0))).solve(f)
    np.testing.assert_allclose(q[:, 0], 1.5 * np.arange(1, 51), rtol=1e-12)


def test_a_free_chain_pulled_at_both_ends_stretches_evenly():
    n = 41
    _, K, _ = bar(n, stiffness=2.0, mass=3.0)
    f = np.zeros((n, 1))
    f[0] = -1.0
    f[-1] = 1.0
    q = StaticSolver(K, np.ones((n, 1))).solve(f)[:, 0]
    np.testing.assert_allclose(q - q.mean(), 0.5 * (np.arange(n) - 20), atol=1e-12)


def test_six_free_bodies_take_several_load_cases_at_once():
    _, K, _ = copies(6, *bar(30))
    R = np.kron(np.eye(6), np.ones((30, 1)))
    f = np.random.default_rng(0).standard_normal((180, 4))
    f -= R @ (R.T @ f) / 30
    q = StaticSolver(K, R).solve(f)
    assert q.shape == (180, 4)
    assert _residual(K, q, f) < 1e-14


def test_a_free_beam_with_mixed_units_keeps_its_residual_small():
    beam = Beam([0.1] * 20, bending=1e6)
    _, K = beam.matrices()
    R = np.zeros((42, 2))
    R[0::2, 0] = 1.0
    R[0::2, 1] = np.arange(21) * 0.1
    R[1::2, 1] = 1.0
    f = np.zeros((42, 1))
    f[0] = 1.0
    f[20] = -2.0
    f[40] = 1.0
    q = StaticSolver(K, R).solve(f)[:, 0]
    assert _residual(K, q, f[:, 0]) < 1e-14
    sag = q[20] - 0.5 * (q[0] + q[40])
    assert abs(sag) == pytest.approx(2.0 * 2.0**3 / (48 * 1e6), rel=1e-9)


def test_a_load_that_pushes_a_free_body_is_refused_unless_something_carries_it():
    _, K, _ = bar(10)
    f = np.zeros((10, 1))
    f[3] = 1.0
    free = StaticSolver(K, np.ones((10, 1)))
    with pytest.raises(UnbalancedLoadError, match="balance the loads") as caught:
        free.solve(f)
    assert caught.value.imbalance[0] == pytest.approx(1.0)
    # What carries it takes shares in proportion to the stiffness of each dof.
    q = free.solve(f, carried=True)
    np.testing.assert_allclose((f - K @ q)[:, 0], K.diagonal() / K.diagonal().sum(), atol=1e-13)


def test_a_free_motion_that_was_not_given_is_refused():
    _, K, _ = bar(10)
    with pytest.raises(AnalysisError):
        StaticSolver(K, np.zeros((10, 0))).solve(np.ones((10, 1)))
