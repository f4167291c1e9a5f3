"""A basis in which metres and radians count alike: what was added lies in it, and the unit of a dof changes nothing."""

from __future__ import annotations

import numpy as np
import pytest

from rotorgear.solvers.eigen.undamped_basis import ScaledBasis

N = 12
WEIGHT = np.geomspace(1e-3, 1e3, N)


def complex_modes(count: int, seed: int = 2) -> np.ndarray:
    draw = np.random.default_rng(seed)
    return (draw.standard_normal((N, count)) + 1j * draw.standard_normal((N, count))) / WEIGHT[:, None]


def left_over(basis: ScaledBasis, V: np.ndarray) -> np.ndarray:
    """Share of vectors beside the span, (m,), in scaled coordinates."""
    scaled = basis.basis * WEIGHT[:, None]
    parts = V * WEIGHT[:, None]
    return np.linalg.norm(parts - scaled @ (scaled.T @ parts), axis=0) / np.linalg.norm(parts, axis=0)


def assert_orthonormal(basis: ScaledBasis) -> None:
    scaled = basis.basis * WEIGHT[:, None]
    np.testing.assert_allclose(scaled.T @ scaled, np.eye(basis.size), atol=1e-13)


@pytest.mark.parametrize("began", [False, True])
def test_modes_and_corrections_that_were_added_lie_in_the_basis(began: bool) -> None:
    first = complex_modes(2, 5).real if began else None
    basis = ScaledBasis(WEIGHT, first)
    V = complex_modes(3)
    assert basis.add_modes(V, 1e-10) == 6
    assert left_over(basis, V).max() < 1e-12
    if first is not None:
        assert left_over(basis, first).max() < 1e-12
        # The first column has the direction of the first vector.
        first_column = basis.basis[:, 0] * WEIGHT
        assert abs(first_column @ (first[:, 0] * WEIGHT)) == pytest.approx(
            np.linalg.norm(first[:, 0] * WEIGHT), rel=1e-12
        )
    more = 1e-6 * complex_modes(2, 9)
    basis.add_corrections(more, basis.sizes(V[:, :2]), 0.0)
    assert left_over(basis, more).max() < 1e-6
    assert_orthonormal(basis)


def test_modes_that_are_there_and_real_ones_of_any_phase_cost_no_columns_twice() -> None:
    basis = ScaledBasis(WEIGHT)
    real = complex_modes(3).real * np.exp(1j * np.array([0.3, 2.0, -1.1]))
    assert basis.add_modes(real, 1e-10) == 3
    assert basis.add_modes(1e5 * real, 1e-10) == 0
    assert basis.add_modes(complex_modes(1, 7) + real[:, :1], 1e-10) == 2
    assert_orthonormal(basis)


def test_units_of_single_dofs_change_nothing() -> None:
    """Coordinates q / unit have the weight times the unit; the basis follows them."""
    unit = np.geomspace(1e4, 1e-2, N)
    V = complex_modes(2)
    here, there = ScaledBasis(WEIGHT), ScaledBasis(WEIGHT * unit)
    for basis, vectors in ((here, V), (there, V / unit[:, None])):
        basis.add_modes(vectors, 1e-10)
    np.testing.assert_allclose(there.basis * unit[:, None], here.basis, rtol=1e-9, atol=1e-12 / WEIGHT.min())
    np.testing.assert_allclose(there.sizes(V / unit[:, None]), here.sizes(V), rtol=1e-12)
    np.testing.assert_allclose(here.sizes(V), np.sqrt((np.abs(V * WEIGHT[:, None]) ** 2).sum(axis=0)), rtol=1e-12)
