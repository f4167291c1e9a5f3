"""The modal assurance criterion."""

from __future__ import annotations

import numpy as np

import rotorgear as rg


def test_mac_is_one_for_any_scale_and_phase_and_zero_for_orthogonal_shapes():
    random = np.random.default_rng(2)
    a = random.standard_normal((3, 5))
    np.testing.assert_allclose(np.diag(rg.mac(a, a * np.exp(1j * np.arange(3))[:, None] * 7.0)), 1.0, rtol=1e-14)
    basis = np.linalg.qr(random.standard_normal((5, 5)))[0]
    np.testing.assert_allclose(rg.mac(basis, basis), np.eye(5), atol=1e-30)


def test_points_that_one_shape_does_not_know_take_no_part():
    a = np.array([[1.0, 2.0, np.nan]])
    np.testing.assert_allclose(rg.mac(a, [[2.0, 4.0, -9.0]]), 1.0)
    assert np.isnan(rg.mac([[np.nan, np.nan, 1.0]], [[1.0, 1.0, np.nan]])).all()
