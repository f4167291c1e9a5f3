"""Gyroscopic modes from a basis of undamped ones, against closed forms and the general solver."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp

from rotorgear.solvers.eigen.damped import damped_modes
from rotorgear.solvers.eigen.eigen import lowest_modes
from rotorgear.solvers.eigen.gyroscopic import gyroscopic_modes
from rotorgear.solvers.eigen.undamped_basis import NearUndamped


def spinning_string(n: int, spin: float, free: bool = False) -> NearUndamped:
    """Two equal chains of springs across each other in a frame that spins: s -> i w with w^2 -+ 2 spin w = w_k^2, exactly.

    `free`: without walls, and the spin acts on the left half only, so that nothing decouples.
    """
    ends = 1.0 if free else 2.0
    chain = sp.diags_array(
        [np.r_[ends, 2.0 * np.ones(n - 2), ends], -np.ones(n - 1), -np.ones(n - 1)], offsets=[0, 1, -1]
    )
    S1 = sp.diags_array([np.ones(n - 1), -np.ones(n - 1)], offsets=[0, 1], shape=(n - 1, n)).toarray()
    S1 = S1 if free else np.vstack([S1, np.eye(n)[[0, -1]]])
    zero = np.zeros_like(S1)
    S = np.block([[S1, zero], [zero, S1]])
    K = sp.csc_array(sp.block_diag([chain, chain]))
    M = sp.csc_array(sp.eye_array(2 * n))
    J = 2.0 * spin * sp.eye_array(n)
    G = sp.csc_array(sp.block_array([[None, J], [-J, None]]))
    undamped = lowest_modes(M, K, count=24, strain=lambda V: S @ V)
    r = undamped.rigid_count
    return NearUndamped(
        M,
        G,
        K,
        lambda V: S @ V,
        np.sqrt(undamped.eigenvalues[r:]),
        undamped.vectors[:, r:],
        undamped.vectors[:, :r],
    )


@pytest.mark.parametrize("spin", [0.0, 1e-3, 0.05])
def test_spin_splits_the_modes_of_a_string_as_the_closed_form_says(spin: float) -> None:
    n = 150
    found = gyroscopic_modes(spinning_string(n, spin), 12, None)
    assert found is not None
    own = 2.0 * np.sin(0.5 * np.pi * np.arange(1, n + 1) / (n + 1))
    exact = np.sort(np.concatenate([np.hypot(spin, own) - spin, np.hypot(spin, own) + spin]))[:12]
    assert found.eigenvalues.imag == pytest.approx(exact, rel=1e-11)
    assert not found.eigenvalues.real.any()
    assert found.backward_error.max() < 1e-8


def test_modes_that_spin_brings_down_from_above_the_basis_are_missed_by_no_count() -> None:
    """At a fast spin half of all modes come down below the first ones, more than the basis has: the count says so."""
    n = 150
    slow = gyroscopic_modes(spinning_string(n, 0.02), 12, None)
    fast = gyroscopic_modes(spinning_string(n, 3.0), 12, None)
    assert slow is not None
    assert fast is None


def test_a_basis_without_one_of_the_modes_is_refused_by_the_count() -> None:
    problem = spinning_string(150, 0.02)
    # The fifth pair is taken out of the basis, and no correction brings it back: spin couples a mode with its twin only.
    odd = np.arange(len(problem.frequencies)) // 2 != 4
    holed = replace(problem, frequencies=problem.frequencies[odd], modes=problem.modes[:, odd])
    found = gyroscopic_modes(holed, 12, None)
    assert found is None


def test_a_rigid_body_motion_on_which_the_spin_acts_is_left_to_the_general_solver() -> None:
    assert gyroscopic_modes(spinning_string(100, 0.1, free=True), 12, None) is None
    still = gyroscopic_modes(spinning_string(100, 0.0, free=True), 12, None)
    assert still is not None
    assert still.rigid.sum() == 2


def test_a_limit_gives_what_the_general_solver_gives() -> None:
    problem = spinning_string(100, 0.03)
    limit = float(problem.frequencies[9]) * 1.01
    found = gyroscopic_modes(problem, None, limit)
    general = damped_modes(problem.M, problem.D, problem.K, below=limit)
    assert found is not None
    assert found.eigenvalues.imag == pytest.approx(general.eigenvalues.imag, rel=1e-10)
