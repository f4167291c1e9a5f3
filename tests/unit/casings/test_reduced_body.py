"""Numbers of a reduced body by hand: mass anywhere in space, stated errors, damping, and energies of higher orders."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from rotorgear.casings.matrices_file import read_matrices
from rotorgear.casings.mesh_error import _all_orders
from rotorgear.casings.reduced_body import ReducedBody, mass_properties, modal_damping, rigid_motions
from tests.bar_casing import bar_matrices


def test_masses_at_points_have_their_centre_and_their_tensor_of_inertia() -> None:
    rng = np.random.default_rng(2)
    points, mass = rng.normal(size=(5, 3)) + np.array([3.0, -1.0, 2.0]), rng.uniform(0.5, 2.0, 5)
    R = rigid_motions(points)
    found = mass_properties(R.T @ (np.repeat(mass, 3)[:, None] * R))
    centre = mass @ points / mass.sum()
    r = points - centre
    tensor = sum(m * (s @ s * np.eye(3) - np.outer(s, s)) for m, s in zip(mass, r, strict=True))
    assert found[0] == pytest.approx(mass.sum(), rel=1e-12)
    assert found[1] == pytest.approx(centre, rel=1e-12)
    assert found[2] == pytest.approx(tensor, rel=1e-10)
    # Rotations about another point move every place by theta x (r - point).
    about = rigid_motions(points, np.array([0.3, 0.2, -0.7])).reshape(5, 3, 6)
    turn = np.array([0.2, -0.5, 0.9])
    assert about[:, :, 3:] @ turn == pytest.approx(np.cross(turn, points - np.array([0.3, 0.2, -0.7])), abs=1e-12)


def body_of(tmp_path: Path, **more: object) -> ReducedBody:
    np.savez(tmp_path / "bar.npz", **(bar_matrices(np.linspace(0.0, 0.5, 5), 0.04, [0, 4]) | more))  # type: ignore[arg-type]
    return read_matrices(tmp_path / "bar.npz", {}, 0.013, "box")


def test_a_bar_beside_the_axis_has_its_centre_there(tmp_path: Path) -> None:
    moved = np.array([[0.2, -0.1, 0.0], [0.2, -0.1, 0.5]])
    here, there = body_of(tmp_path), body_of(tmp_path, positions=moved)
    assert there.body_mass == pytest.approx(here.body_mass, rel=1e-12)
    assert there.centre == pytest.approx([0.2, -0.1, 0.25], abs=1e-9)
    assert there.inertia == pytest.approx(here.inertia, abs=1e-9 * here.inertia[0, 0])


def test_every_elastic_mode_of_matrices_has_the_damping_ratio_that_is_given(tmp_path: Path) -> None:
    body = body_of(tmp_path)
    frequency, shapes = body.modes()
    C = shapes.T @ body.damping @ shapes
    w = 2.0 * np.pi * frequency[6:]
    assert np.diag(C)[6:] == pytest.approx(2.0 * 0.013 * w, rel=1e-6)
    assert np.abs(C - np.diag(np.diag(C))).max() < 1e-6 * w[-1]
    assert np.abs(np.diag(C)[:6]).max() < 1e-4 * w[0]
    # Two masses on springs: C = M V diag(2 zeta w) V^T M.
    K, M = np.array([[5.0, -2.0], [-2.0, 3.0]]), np.diag([2.0, 0.5])
    damped = modal_damping(M, K, 0.07)
    root = np.linalg.inv(np.sqrt(M))
    values, vectors = np.linalg.eigh(root @ K @ root)
    expected = np.sqrt(M) @ vectors @ np.diag(0.14 * np.sqrt(values)) @ vectors.T @ np.sqrt(M)
    assert damped == pytest.approx(expected, rel=1e-12)


def test_the_stated_error_grows_towards_the_first_mode_that_is_left_out() -> None:
    """lambda q^H E q / (1 - lambda/lambda_left), relative to lambda; no bound beyond."""
    zero = np.zeros((2, 2))
    E = np.array([[3e-9, 1e-9], [1e-9, 2e-9]])
    unknown = {"body_mass": 1.0, "centre": np.zeros(3), "inertia": np.eye(3), "fixed_frequency": np.zeros(0)}
    body = ReducedBody("b", (), np.zeros((0, 3)), zero, zero, zero, None, zero, error=E, left_frequency=50.0, **unknown)  # type: ignore[arg-type]
    q = np.array([0.3 + 0.4j, -0.2j])
    form = 3e-9 * 0.25 + 2e-9 * 0.04 + 2.0 * 1e-9 * (-0.4 * 0.2)
    for hz in (12.0, 30.0):
        value = (2.0 * np.pi * hz) ** 2
        expected = value * form / (1.0 - (hz / 50.0) ** 2)
        assert body.eigenvalue_error(value, q) == pytest.approx(expected, rel=1e-12)
    assert body.eigenvalue_error((2.0 * np.pi * 51.0) ** 2, q) == np.inf


@pytest.mark.parametrize("decay", [2.0, 3.3, 6.0, 17.0])
def test_energies_that_fall_by_a_power_of_the_order_are_summed_up_to_all_orders(decay: float) -> None:
    """What order p leaves is p^-a: S_2 = 1 - 2^-a, S_3 = 2^-a - 3^-a, and 2^-a from order 3 on."""
    second, third, rest = 1.0 - 2.0**-decay, 2.0**-decay - 3.0**-decay, 2.0**-decay
    found = _all_orders(np.array([[7.0 * third]]), np.array([[7.0 * second]]))
    assert found == pytest.approx(np.array([[7.0 * rest]]), rel=1e-3)
    # A faster decay than can be told apart, and a slower one than that beside a crack, count as these.
    assert _all_orders(np.array([[0.0]]), np.array([[0.0]])) == pytest.approx(0.0)
    crack = _all_orders(np.array([[9.0]]), np.array([[1.0]]))
    assert crack == pytest.approx(9.0 / (1.0 - 4.0 / 9.0))
