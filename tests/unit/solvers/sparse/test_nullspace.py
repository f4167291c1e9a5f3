"""Supports of systems that move freely: a motion without strain is stopped where it is, not where rounding is large."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import scipy.linalg as la
import scipy.sparse as sp

from rotorgear.solvers.sparse import nullspace
from rotorgear.solvers.sparse.nullspace import (
    in_comparable_units,
    inertia_relief,
    left_null_space,
    orthonormal_motions,
    support_dofs,
    supported_solver,
)


@pytest.mark.parametrize("rounding", [0.0, 1e-15])
def test_a_lone_rotation_is_supported_beside_stiff_springs(rounding: float) -> None:
    # A rotor that nothing holds from turning, 1e-4 kg m^2, beside two masses on springs, 1e9 N/m.
    K = sp.csc_array(np.array([[2e9, -1e9, 0.0], [-1e9, 1e9, 0.0], [0.0, 0.0, 0.0]]))
    M = sp.csc_array(np.diag([1.0, 2.0, 1e-4]))
    R = np.array([[rounding], [-rounding], [100.0]])
    solve = supported_solver(K, in_comparable_units(R, K, M), left_null_space(K, M, R))
    np.testing.assert_allclose(solve(np.array([0.0, 3.0, 0.0])), [3e-9, 6e-9, 0.0], rtol=1e-12)


def test_a_free_chain_is_supported_at_one_of_its_ends() -> None:
    K = sp.csc_array(np.array([[1e6, -1e6], [-1e6, 1e6]]))
    M = sp.csc_array(np.diag([1.0, 3.0]))
    R = np.full((2, 1), 0.5)
    found = supported_solver(K, in_comparable_units(R, K, M), left_null_space(K, M, R))(np.array([1.0, -1.0]))
    assert found[0] - found[1] == pytest.approx(1e-6)


def test_bodies_that_nothing_joins_are_supported_each_by_itself(monkeypatch: pytest.MonkeyPatch) -> None:
    # Seed 202267: 200 loose shafts took 3 s for the QR of all their motions together.
    draw = np.random.default_rng(0)
    bodies = 40
    order = draw.permutation(12 * bodies)
    R = np.zeros((12 * bodies, 6 * bodies))
    for k in range(bodies):
        R[order[12 * k : 12 * k + 12], 6 * k : 6 * k + 6] = draw.normal(size=(12, 6))
    R = R[:, draw.permutation(6 * bodies)]
    shapes = []
    qr = la.qr

    def seen(A: np.ndarray, **options: Any) -> Any:
        shapes.append(A.shape)
        return qr(A, **options)

    monkeypatch.setattr(nullspace.la, "qr", seen)
    dofs = support_dofs(R)
    assert set(shapes) == {(6, 12)}
    assert [np.isin(order[12 * k : 12 * k + 12], dofs).sum() for k in range(bodies)] == [6] * bodies
    Q = orthonormal_motions(R)
    np.testing.assert_allclose(Q.T @ Q, np.eye(6 * bodies), atol=1e-13)
    np.testing.assert_allclose(Q @ (Q.T @ R), R, atol=1e-12)
    assert np.array_equal(Q != 0.0, R != 0.0)


def test_a_motion_that_moves_nothing_is_no_body_of_its_own() -> None:
    R = np.array([[1.0, 0.0], [1.0, 0.0], [0.0, 0.0]])
    assert len(support_dofs(R)) == 2
    assert orthonormal_motions(R).shape == (3, 2)


def test_under_inertia_relief_the_rest_of_a_load_bends_and_no_momentum_is_left() -> None:
    """A free chain of unequal masses on unequal springs, pushed at one end: m a carries the push, and the rest is statics."""
    k = np.array([3e6, 1e6, 2e6])
    m = np.array([1.0, 4.0, 2.0, 0.5])
    stretch = np.diff(np.eye(4), axis=0)
    K = stretch.T @ np.diag(k) @ stretch
    R = np.ones((4, 1)) / np.sqrt(m.sum())
    f = np.array([[7.0, 0.0], [0.0, -2.0], [0.0, 0.0], [0.0, 5.0]])
    q = inertia_relief(sp.csc_array(K), sp.csc_array(np.diag(m)), R)(f)
    np.testing.assert_allclose(K @ q, f - np.outer(m, f.sum(axis=0)) / m.sum(), atol=1e-12)
    np.testing.assert_allclose(m @ q, 0.0, atol=1e-18)
    # The springs one after the other carry the push less what the masses before them take.
    carried = 7.0 - np.cumsum(m)[:3] * 7.0 / m.sum()
    np.testing.assert_allclose(-np.diff(q[:, 0]), carried / k, rtol=1e-12)
