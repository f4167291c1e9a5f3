"""Equilibrium with local forces by Newton's method and continuation."""

from __future__ import annotations

import numpy as np
import pytest

from rotorgear.solvers.sparse.newton import Laws, local_equilibrium


def contacts(k: np.ndarray, gap: np.ndarray) -> Laws:
    """Springs that push beyond a gap to each side."""

    def laws(d: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        beyond = d - np.clip(d, -gap, gap)
        return k * beyond, np.diag(np.where(beyond != 0.0, k, 0.0))

    return laws


def condensed(S: np.ndarray, k: np.ndarray, load: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """d0 and A of a structure with the stiffness S between its local displacements."""
    A = np.linalg.inv(S + k)
    return A @ load, A


def test_linear_forces_are_settled_without_a_step() -> None:
    k = np.diag([3.0, 5.0])
    d0, A = condensed(np.array([[2.0, -1.0], [-1.0, 2.0]]), k, np.array([1.0, -2.0]))
    found = local_equilibrium(d0, A, k, lambda d: (k @ d, k), evaluations=1)
    assert found.converged
    assert np.array_equal(found.d, d0)


def test_any_stiffness_to_expand_about_leads_to_the_same_equilibrium() -> None:
    S = np.array([[4.0, -1.0], [-1.0, 3.0]])
    load = np.array([2.0, 1.0])

    def laws(d: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return d + d**3, np.diag(1.0 + 3.0 * d**2)

    for size in (1e-3, 1.0, 1e3):
        k = size * np.eye(2)
        found = local_equilibrium(*condensed(S, k, load), k, laws)
        assert found.converged
        assert S @ found.d + laws(found.d)[0] == pytest.approx(load, rel=1e-8)


def test_gaps_in_a_free_structure_are_crossed_however_stiff_their_walls_are() -> None:
    # Nothing but the contact holds the motion, and the linear start lies within the gap.
    for stiffness in 10.0 ** np.arange(-6.0, 10.0):
        for load in (1.0, -1.0):
            k = np.array([[stiffness]])
            d0, A = condensed(np.zeros((1, 1)), k, np.array([load]))
            found = local_equilibrium(d0, A, k, contacts(np.array([stiffness]), np.array([3e-2])))
            assert found.converged, stiffness
            assert found.force == pytest.approx([load], rel=1e-5)


def test_many_contacts_find_the_one_minimum_of_their_energy() -> None:
    # Convex energies have one minimum, and there the forces balance: random networks, some of them only just held.
    generator = np.random.default_rng(3)
    for _ in range(60):
        m = int(generator.integers(1, 9))
        shape = generator.standard_normal((m, m))
        S = shape[:, : max(1, m // 2)] @ shape[:, : max(1, m // 2)].T + 1e-6 * np.eye(m)
        k = 10.0 ** generator.uniform(-2, 4, m)
        laws = contacts(k, generator.uniform(0.0, 1.0, m))
        load = generator.standard_normal(m)
        found = local_equilibrium(*condensed(S, np.diag(k), load), np.diag(k), laws)
        assert found.converged
        assert S @ found.d + laws(found.d)[0] == pytest.approx(load, abs=1e-6)


def test_an_equilibrium_that_does_not_exist_is_said_not_to_be_found() -> None:
    k = np.eye(1)
    found = local_equilibrium(
        np.array([2.0]), np.eye(1), k, lambda d: (np.tanh(d), np.diag(1.0 / np.cosh(np.clip(d, -50, 50)) ** 2))
    )
    assert not found.converged


def test_forces_that_are_rounding_of_their_parts_are_settled() -> None:
    pull = 1e6
    k = np.diag([1e7])

    def laws(d: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        # Two sides that pull against each other; what they leave is never nothing at all.
        left = pull + 0.5e7 * d
        right = pull * (1.0 + 1e-15) - 0.5e7 * d
        return left - right, k

    d0, A = condensed(np.array([[1e7]]), k, np.zeros(1))
    assert not local_equilibrium(d0, A, k, laws, evaluations=200).converged
    found = local_equilibrium(d0, A, k, laws, extents=np.array([2.0 * pull / 1e7]))
    assert found.converged
    assert abs(found.d[0]) <= 1e-15 * pull / 1e7


def test_the_search_ends_after_its_evaluations() -> None:
    asked = []

    def laws(d: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        asked.append(d)
        return 2.0 - d + np.copysign(1.0, d - 0.3), np.zeros(
            (1, 1)
        )  # 1 N too much on one side, too little on the other

    d0, A = condensed(np.array([[1.0]]), np.eye(1), np.array([2.0]))
    assert not local_equilibrium(d0, A, np.eye(1), laws, evaluations=50).converged
    assert len(asked) == 51  # and where it began, whose forces are told
