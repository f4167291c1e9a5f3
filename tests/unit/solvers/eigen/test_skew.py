"""Largest pairs of skew matrices against the complex Hermitian problem: plain, in clusters, and over a wide spread."""

from __future__ import annotations

import numpy as np
import pytest

from rotorgear.solvers.eigen.reduced_pencil import largest_pairs

WELL_SPREAD = np.linspace(1.0, 0.1, 30)
CLUSTERS = np.repeat([1.0, 0.7, 0.5, 0.2, 0.1], 6)
WIDE = np.logspace(0.0, -6.0, 30)


def skew(theta: np.ndarray) -> np.ndarray:
    """A dense skew matrix whose -i B has the eigenvalues +-theta."""
    m = len(theta)
    Q = np.linalg.qr(np.random.default_rng(3).standard_normal((2 * m, 2 * m)))[0]
    B = np.zeros((2 * m, 2 * m))
    B[range(m), range(m, 2 * m)] = theta
    B = Q @ (B - B.T) @ Q.T
    return 0.5 * (B - B.T)


@pytest.mark.parametrize("theta", [WELL_SPREAD, CLUSTERS, WIDE], ids=["spread", "clusters", "wide"])
@pytest.mark.parametrize("count", [1, 8, 25, 30])
@pytest.mark.parametrize("unit", [2.0**-30, 1.0, 2.0**30])
def test_pairs_are_those_of_the_hermitian_matrix_in_any_unit(theta, count, unit):
    B = unit * skew(theta)
    found, Y = largest_pairs(B, count)
    assert found / unit == pytest.approx(np.sort(theta)[::-1][:count], abs=1e-14)
    assert np.abs(-1j * B @ Y - Y * found).max() < 1e-13 * unit
    assert np.abs(Y.conj().T @ Y - np.eye(count)).max() < 1e-13
