"""The dynamic stiffness at one frequency and over speeds, against the same one as a dense matrix."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.linalg as la
import scipy.sparse as sp

from rotorgear.solvers.frequency.harmonic import Dynamics, DynamicsOverSpeed, LowRank, projected, stiffness_in_basis


def _damped(ratio: float) -> tuple[Dynamics, np.ndarray]:
    """A skew system of 30 unequal masses whose modes have a damping ratio; with it what this damping is as a matrix."""
    n = 30
    random = np.random.default_rng(2)
    M = np.diag(random.uniform(0.5, 2.0, n))
    k = random.uniform(1e4, 4e4, n + 1)
    K = np.diag(k[1:] + k[:-1]) - np.diag(k[1:-1], 1) - np.diag(k[1:-1], -1)
    G = 2.0 * (np.eye(n, k=1) - np.eye(n, k=-1))
    values, V = la.eigh(K, M)
    w = np.sqrt(values)
    low = LowRank(M @ V, 2.0 * ratio * w, w)
    return Dynamics(*(sp.csc_array(A) for A in (M, G, K)), low), low.P @ np.diag(low.d) @ low.P.T


@pytest.mark.parametrize("ratio", [1e-4, 0.02, 0.6])
def test_few_and_many_modes_that_are_damped_give_the_solution_of_the_whole_matrix(ratio: float) -> None:
    system, added = _damped(ratio)
    f = np.eye(30)[:, [0, 17]] * (1.0 - 0.5j)
    assert system.low_rank is not None
    for w in (3.0, float(system.low_rank.w[11]), 0.5 * float(system.low_rank.w[20] + system.low_rank.w[21]), 2e3):
        Z = system.K.toarray() + 1j * w * (system.D.toarray() + added) - w**2 * system.M.toarray()
        q = system.solve(w, f)
        assert np.abs(q - la.solve(Z, f)).max() <= 1e-11 * np.abs(q).max()
        assert system.relative_residual(w, f, q) <= 1e-14


def test_dynamics_over_speed_are_those_of_each_speed() -> None:
    system, _ = _damped(0.01)
    turning = sp.csc_array(np.eye(30, k=3) - np.eye(30, k=-3))
    skew = sp.csc_array(5.0 * np.eye(30, k=1))
    over = DynamicsOverSpeed(system, turning, skew)
    random = np.random.default_rng(1)
    q = random.standard_normal((30, 3)) + 1j * random.standard_normal((30, 3))
    X = random.standard_normal((30, 4))
    x = np.array([0.0, 7.0, -40.0])
    w = np.array([3.0, 150.0, 80.0])
    still, grown = over.projected(X)
    for k, (speed, value) in enumerate(zip(x, w, strict=True)):
        there = Dynamics(
            system.M, sp.csc_array(system.D + speed * turning), sp.csc_array(system.K + speed * skew), system.low_rank
        )
        assert over.apply(x, w, q)[:, k] == pytest.approx(there.apply(value, q[:, [k]])[:, 0], rel=1e-12)
        pencil = projected(there, X)
        assert still.D + speed * grown.D == pytest.approx(pencil.D, rel=1e-9, abs=1e-9)
        assert still.K + speed * grown.K == pytest.approx(pencil.K, rel=1e-9)
        Z = stiffness_in_basis(pencil, np.array([value]))[0]
        assert X.T @ there.apply(value, X) == pytest.approx(Z, rel=1e-9, abs=1e-6)
