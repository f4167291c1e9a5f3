"""Counting the eigenvalues below a shift where no pivot on the diagonal exists."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp

from rotorgear.solvers.sparse.pencil import count_below


def equal_bodies(pairs: int, stiffness: float = 1.6e8) -> tuple[sp.csc_array, sp.csc_array]:
    """M and K of so many pairs of equal bodies, each on one spring: eigenvalues 0 and 2 k."""
    K = sp.csc_array(sp.block_diag([stiffness * np.array([[1.0, -1.0], [-1.0, 1.0]])] * pairs))
    return sp.csc_array(sp.eye_array(2 * pairs)), K


@pytest.mark.parametrize("pairs", [1, 3])
def test_halfway_between_the_eigenvalues_of_two_equal_bodies_the_rigid_modes_are_counted(pairs: int) -> None:
    M, K = equal_bodies(pairs)
    assert count_below(M, K, 1.6e8) == pairs
