"""Modes with dampers at few places from a basis of undamped ones, against the general solver, and when they are left to it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp

from rotorgear.solvers.eigen.damped import DampedModes, damped_modes
from rotorgear.solvers.eigen.local_damping import locally_damped_modes
from rotorgear.solvers.eigen.quadratic import scaled
from rotorgear.solvers.eigen.undamped_basis import NearUndamped
from rotorgear.solvers.sparse.factor import factor_symmetric
from tests.unit.solvers.eigen.test_gyroscopic import spinning_string

N = 150


def string_on_dampers(spin: float, coefficients: dict[int, float], free: bool = False) -> NearUndamped:
    """Two chains across each other that spin, with dampers at some of their 2 N dofs."""
    problem = spinning_string(N, spin, free)
    C = np.zeros(2 * N)
    C[list(coefficients)] = list(coefficients.values())
    return replace(problem, D=sp.csc_array(problem.D + sp.diags_array(C)))


def in_general(problem: NearUndamped, count: int | None, below: float | None = None) -> DampedModes:
    return damped_modes(problem.M, problem.D, problem.K, count=count, below=below, rigid_vectors=problem.rigid)


@pytest.mark.parametrize("spin", [0.0, 1e-3, 0.05])
@pytest.mark.parametrize(
    "dampers",
    [
        {30: 0.02, N + 30: 0.02},  # equal in both planes: without spin all modes are double
        {30: 0.3, N + 71: 0.01},
        {40: 0.2, 90: 0.2, N + 12: 0.05, N + 100: 0.4},
    ],
)
def test_dampers_at_few_places_give_what_the_general_solver_gives(spin: float, dampers: dict[int, float]) -> None:
    problem = string_on_dampers(spin, dampers)
    found = locally_damped_modes(problem, 12, None)
    assert found is not None
    exact = in_general(problem, 12)
    assert found.eigenvalues == pytest.approx(exact.eigenvalues, rel=1e-9)
    assert found.backward_error.max() < 1e-8
    # Each vector lies in the span of the true ones of its eigenvalue, which may be double.
    for s, v in zip(found.eigenvalues, found.vectors.T, strict=True):
        near = exact.vectors[:, np.abs(exact.eigenvalues - s) < 1e-6 * abs(s)]
        Q = np.linalg.qr(near)[0]
        assert np.linalg.norm(v - Q @ (Q.conj().T @ v)) < 1e-4 * np.linalg.norm(v)


def test_a_limit_and_free_bodies_give_what_the_general_solver_gives() -> None:
    problem = string_on_dampers(0.02, {30: 0.1})
    limit = 0.5 * float(problem.frequencies[11] + problem.frequencies[12])
    found = locally_damped_modes(problem, None, limit)
    assert found is not None
    assert found.eigenvalues == pytest.approx(in_general(problem, None, limit).eigenvalues, rel=1e-9)


@pytest.mark.parametrize("beyond", [1e-8, 1e-6, 1e-4])
def test_a_mode_just_below_the_limit_is_among_those_found(beyond: float) -> None:
    # The small problem has it a little above: only its correction brings it below.
    problem = string_on_dampers(0.02, {30: 0.3, N + 71: 0.1})
    size = np.abs(in_general(problem, 14).eigenvalues)
    for k in range(13):
        limit = float(size[k]) * (1.0 + beyond)
        found = locally_damped_modes(problem, None, limit)
        assert found is not None
        assert len(found.eigenvalues) == np.count_nonzero(size <= limit)


def test_a_motion_that_a_strong_damper_lets_creep_is_left_to_the_general_solver() -> None:
    problem = string_on_dampers(0.02, {30: 1e7})
    creep = in_general(problem, 3).eigenvalues[0]
    assert creep.imag == 0.0
    assert 0.0 < abs(creep) < 1e-5 * problem.frequencies[0]
    assert locally_damped_modes(problem, 12, None) is None


def test_what_a_basis_does_not_hold_is_left_to_the_general_solver() -> None:
    problem = string_on_dampers(0.02, {30: 0.1})
    # A pair is taken out of the basis, and no response brings it back: the count says so.
    odd = np.arange(len(problem.frequencies)) // 2 != 4
    silent = string_on_dampers(0.02, {})
    holed = replace(silent, frequencies=silent.frequencies[odd], modes=silent.modes[:, odd])
    assert locally_damped_modes(silent, 12, None) is not None
    assert locally_damped_modes(holed, 12, None) is None
    # Dampers everywhere, one so strong that motions do not oscillate, and one that a rigid-body motion moves.
    everywhere = replace(problem, D=sp.csc_array(problem.D + 1e-3 * problem.M))
    assert locally_damped_modes(everywhere, 12, None) is None
    assert locally_damped_modes(string_on_dampers(0.02, {30: 40.0}), 12, None) is None
    assert locally_damped_modes(string_on_dampers(0.0, {30: 0.1}, free=True), 12, None) is None


def test_products_with_the_mirror_image_and_backward_errors_are_those_of_the_matrices_themselves() -> None:
    problem = string_on_dampers(0.02, {30: 0.1, N + 71: 0.03})
    rng = np.random.default_rng(8)
    V = rng.standard_normal((2 * N, 3)) + 1j * rng.standard_normal((2 * N, 3))
    products = problem.products(V)
    for found, A in zip(products, (problem.M, problem.D, problem.K), strict=True):
        np.testing.assert_allclose(found, A.toarray() @ V, atol=1e-13)
    np.testing.assert_allclose(problem.mirrored(V, products)[1], problem.D.toarray().T @ V, atol=1e-13)
    s = np.array([0.3j, -0.1 + 1.0j, 2.0])
    scaling = scaled(problem.M, problem.D, problem.K, float(problem.frequencies[0]))
    np.testing.assert_allclose(
        problem.backward_errors(s, V, problem.applied(s, V)),
        scaling.residuals(s / scaling.w0, V / scaling.scale[:, None]),
        rtol=1e-12,
    )


def test_another_low_shift_gives_the_same_modes() -> None:
    problem = string_on_dampers(0.02, {30: 0.1})
    sigma = 0.05 * float(problem.frequencies[0])
    factored = (sigma, factor_symmetric(sp.csc_array(problem.K + sigma**2 * problem.M)))
    found = locally_damped_modes(replace(problem, factored=factored), 12, None)
    assert found is not None
    assert found.eigenvalues == pytest.approx(in_general(problem, 12).eigenvalues, rel=1e-9)
