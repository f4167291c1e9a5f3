"""Supports of systems that move freely: a motion without strain is stopped where it is, not where rounding is large."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp

from rotorgear.solvers.sparse.nullspace import SupportedSolver, in_comparable_units, left_null_space


@pytest.mark.parametrize("rounding", [0.0, 1e-15])
def test_a_lone_rotation_is_supported_beside_stiff_springs(rounding: float) -> None:
    # A rotor that nothing holds from turning, 1e-4 kg m^2, beside two masses on springs, 1e9 N/m.
    K = sp.csc_array(np.array([[2e9, -1e9, 0.0], [-1e9, 1e9, 0.0], [0.0, 0.0, 0.0]]))
    M = sp.csc_array(np.diag([1.0, 2.0, 1e-4]))
    R = np.array([[rounding], [-rounding], [100.0]])
    solver = SupportedSolver(K, in_comparable_units(R, K, M), left_null_space(K, M, R))
    np.testing.assert_allclose(solver.solve(np.array([0.0, 3.0, 0.0])), [3e-9, 6e-9, 0.0], rtol=1e-12)


def test_a_free_chain_is_supported_at_one_of_its_ends() -> None:
    K = sp.csc_array(np.array([[1e6, -1e6], [-1e6, 1e6]]))
    M = sp.csc_array(np.diag([1.0, 3.0]))
    R = np.full((2, 1), 0.5)
    found = SupportedSolver(K, in_comparable_units(R, K, M), left_null_space(K, M, R)).solve(np.array([1.0, -1.0]))
    assert found[0] - found[1] == pytest.approx(1e-6)
