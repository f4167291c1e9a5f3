import numpy as np
import pytest
import scipy.sparse as sp

from rotorgear.errors import AnalysisError
from rotorgear.solvers.sparse.static import UnbalancedLoadError, static_solution
from tests.unit.solvers.spring_chains import Beam, bar, copies


def _residual(K, q, f):
    return np.linalg.norm(K @ q - f) / (abs(K).sum(axis=0).max() * np.linalg.norm(q) + np.linalg.norm(f))


def test_a_supported_chain_stretches_by_its_closed_form():
    M, K, _ = bar(50, stiffness=2.0, ground={0: 2.0})
    f = np.zeros(50)
    f[-1] = 3.0
    np.testing.assert_allclose(static_solution(K, M, f, None), 1.5 * np.arange(1, 51), rtol=1e-12)


def test_a_free_chain_pulled_at_both_ends_stretches_about_its_mass_centre():
    n = 41
    M, K, _ = bar(n, stiffness=2.0, mass=3.0)
    f = np.zeros(n)
    f[0] = -1.0
    f[-1] = 1.0
    q = static_solution(K, M, f, np.ones((n, 1)))
    np.testing.assert_allclose(q, 0.5 * (np.arange(n) - 20), atol=1e-12)


def test_six_free_bodies_take_several_load_cases_at_once():
    M, K, _ = copies(6, *bar(30))
    R = np.kron(np.eye(6), np.ones((30, 1)))
    f = np.random.default_rng(0).standard_normal((180, 4))
    f -= R @ (R.T @ f) / 30
    q = static_solution(K, M, f, R)
    assert q.shape == (180, 4)
    assert _residual(K, q, f) < 1e-14
    np.testing.assert_allclose(R.T @ (M @ q), 0.0, atol=1e-11)


def test_a_free_beam_with_mixed_units_keeps_its_residual_small():
    beam = Beam([0.1] * 20, bending=1e6)
    M, K = beam.matrices()
    x = np.arange(21) * 0.1
    R = np.zeros((42, 2))
    R[0::2, 0] = 1.0
    R[0::2, 1] = x
    R[1::2, 1] = 1.0
    f = np.zeros(42)
    f[0] = 1.0
    f[20] = -2.0
    f[40] = 1.0
    q = static_solution(K, M, f, R)
    assert _residual(K, q, f) < 1e-14
    np.testing.assert_allclose(R.T @ (M @ q), 0.0, atol=1e-13)
    sag = q[20] - 0.5 * (q[0] + q[40])
    assert abs(sag) == pytest.approx(2.0 * 2.0**3 / (48 * 1e6), rel=1e-9)


def test_a_load_that_pushes_a_free_body_is_refused():
    M, K, _ = bar(10)
    f = np.zeros(10)
    f[3] = 1.0
    with pytest.raises(UnbalancedLoadError, match="balance the loads") as caught:
        static_solution(K, M, f, np.ones((10, 1)))
    assert caught.value.imbalance[0] == pytest.approx(1.0)


def test_a_rigid_motion_that_was_not_given_is_refused():
    M, K, _ = bar(10)
    with pytest.raises(AnalysisError, match="rigid-body motion"):
        static_solution(K, M, np.ones(10), None)


def test_a_rigid_motion_without_inertia_is_refused():
    K = sp.csc_array([[1.0, -1.0], [-1.0, 1.0]])
    with pytest.raises(AnalysisError):
        static_solution(K, sp.csc_array((2, 2)), np.array([1.0, -1.0]), np.ones((2, 1)))
