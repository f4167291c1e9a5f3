"""Matrices that are polynomials of the speed, and roots next to given ones, against formulas written out."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp

from rotorgear.solvers.eigen.quadratic import corrected
from rotorgear.solvers.eigen.synchronous import Affine


def parts(seed: int = 3) -> list[np.ndarray]:
    return list(np.random.default_rng(seed).standard_normal((6, 4, 4)))


@pytest.mark.parametrize("speed", [0.0, 1.7, -2.3])
def test_matrices_at_a_speed_are_their_polynomials(speed: float) -> None:
    M, D0, D1, K0, K1, K2 = parts()
    family = Affine(*map(sp.csc_array, (M, D0, D1, K0, K1, K2)), 1.0, 5.0)
    D, K = family.at(speed)
    np.testing.assert_allclose(D.toarray(), D0 + speed * D1, atol=1e-14)
    np.testing.assert_allclose(K.toarray(), K0 + speed * K1 + speed**2 * K2, atol=1e-14)
    dofs = np.array([0, 2])
    np.testing.assert_array_equal(family.cut(dofs).at(speed)[1].toarray(), K.toarray()[np.ix_(dofs, dofs)])


def test_terms_that_grow_with_the_square_of_a_synchronous_root_are_those_of_the_whole() -> None:
    """With s = i p W, s^2 M + s D(W) + K(W) = K_0 + s (D_0 - i K_1/p) + s^2 (p^2 M - i p D_1 - K_2)/p^2."""
    M, D0, D1, K0, K1, K2 = parts(5)
    family = Affine(*map(sp.csc_array, (M, D0, D1, K0, K1, K2)), 1.0, 5.0)
    order, speed = 1.5, 2.2
    s = 1j * order * speed
    D, K = (A.toarray() for A in family.at(speed))
    whole = s**2 * M + s * D + K
    found = K0 + s * (D0 - 1j * K1 / order) + (s / order) ** 2 * family.inertia(order).toarray()
    np.testing.assert_allclose(found, whole, atol=1e-12)


def test_a_step_to_the_root_of_a_quadratic_is_newtons_and_is_taken_up_to_the_trust() -> None:
    roots = np.array([-0.1 + 2.0j, -0.3 + 5.0j, -1.0 + 0.5j])
    a = np.array([1.0, 2.0, 0.5])
    forms = (a + 0j, -2.0 * a * roots.real + 0j, a * np.abs(roots) ** 2 + 0j)
    off = roots * (1.0 + 1e-5)
    near = corrected(off, np.full(3, 1e-3), forms)
    np.testing.assert_allclose(near, roots, rtol=1e-8)
    np.testing.assert_array_equal(corrected(off, np.full(3, 1e-7), forms), off)
