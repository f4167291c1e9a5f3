"""Contact that pushes and never pulls, against its conditions and another solver."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.optimize as so

from rotorgear.errors import ConvergenceError
from rotorgear.solvers.contact.unilateral import unilateral


def compliance(n: int, seed: int) -> np.ndarray:
    rng = np.random.default_rng(seed)
    A = rng.normal(size=(n, n))
    return np.asarray(A @ A.T + 0.05 * np.eye(n))


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("spread", [0.0, 0.1, 3.0, 100.0])
def test_forces_push_gaps_stay_open_and_the_sum_is_the_load(seed: int, spread: float) -> None:
    C = compliance(20, seed)
    gap = spread * np.random.default_rng(seed + 50).normal(size=20)
    force, approach = unilateral(C, gap, 2.0)
    opening = C @ force + gap - approach
    scale = abs(approach) + np.abs(gap).max()
    assert force.sum() == pytest.approx(2.0, rel=1e-10)
    assert force.min() >= 0.0
    assert opening.min() >= -1e-9 * scale
    assert np.abs(opening[force > 0.0]).max() <= 1e-9 * scale


def test_the_same_forces_as_a_general_least_squares_solver() -> None:
    C = compliance(25, 3)
    gap = np.random.default_rng(1).normal(size=25)
    force, approach = unilateral(C, gap, 1.5)
    # For the approach found, the forces minimise f'Cf/2 + f'(gap - approach) over f >= 0.
    L = np.linalg.cholesky(C)
    other, _ = so.nnls(L.T, np.linalg.solve(L, approach - gap))
    assert np.abs(force - other).max() <= 1e-8 * force.max()


def test_any_start_leads_to_the_same_contact() -> None:
    C = compliance(15, 4)
    gap = np.random.default_rng(2).normal(size=15)
    first, _ = unilateral(C, gap, 1.0)
    for seed in range(5):
        start = np.random.default_rng(seed).random(15) > 0.5
        assert unilateral(C, gap, 1.0, start)[0] == pytest.approx(first, abs=1e-12)


def test_a_compliance_that_is_not_positive_is_refused() -> None:
    C = np.array([[1.0, 2.0], [2.0, 1.0]])
    with pytest.raises(ConvergenceError, match="not positive definite"):
        unilateral(C, np.zeros(2), 1.0)


@pytest.mark.parametrize("away", [1e3, 1e6])
def test_bodies_that_start_farther_apart_meet_with_the_same_forces(away: float) -> None:
    C = compliance(20, 6)
    gap = 3.0 * np.random.default_rng(7).normal(size=20)
    start = np.zeros(20, bool)
    start[np.argmin(gap)] = True
    force, approach = unilateral(C, gap, 2.0)
    assert np.sum(force > 0.0) > 1
    other, farther = unilateral(C, gap + away, 2.0, start)
    assert other == pytest.approx(force, abs=1e-13 * away * 2.0)
    assert farther - away == pytest.approx(approach, abs=1e-9 * away)
