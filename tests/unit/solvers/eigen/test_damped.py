import mpmath as mp
import numpy as np
import pytest
import scipy.sparse as sp

from rotorgear.errors import AnalysisError
from rotorgear.solvers.eigen.damped import damped_modes
from rotorgear.solvers.sparse.pencil import LooseDofError
from tests.unit.solvers.spring_chains import Beam, bar, clamped_bar_frequencies, copies, exact_eigenvalues

SIZES = [30, 400]  # dense and block Arnoldi


def _modes(M, D, K, **kw):
    return damped_modes(*(sp.csc_array(np.atleast_2d(A)) for A in (M, D, K)), **kw)


def _proportional(omega2: np.ndarray, alpha: float, beta: float) -> np.ndarray:
    """Roots with Im >= 0 of s^2 + (alpha + beta w^2) s + w^2, in ascending size; real roots count singly."""
    c = alpha + beta * omega2
    root = np.sqrt((c / 2) ** 2 - omega2 + 0j)
    far = -c / 2 - np.where(c >= 0, 1, -1) * root.real - 1j * root.imag
    pairs = np.concatenate([omega2 / far, far[root.imag == 0.0]])
    pairs = np.where(pairs.imag < 0, pairs.conj(), pairs)
    return pairs[np.argsort(np.abs(pairs))]


def _walls(n: int):
    return bar(n, ground={0: 1.0, n - 1: 1.0})


def _worst(found, expected):
    return max(np.min(np.abs(expected - value)) / abs(value) for value in found)


def test_an_overdamped_mass_has_two_real_eigenvalues():
    modes = _modes(1.0, 10.0, 9.0, count=5)
    np.testing.assert_allclose(modes.eigenvalues, [-1.0, -9.0], rtol=1e-14)
    assert np.all(modes.eigenvalues.imag == 0.0)
    assert modes.complete


@pytest.mark.parametrize("spin", [0.0, 1.0, 1e5])
def test_gyroscopic_coupling_splits_a_double_mode_into_forward_and_backward(spin):
    k = 4.0
    m = 2.0
    modes = _modes(m * np.eye(2), spin * np.array([[0, 1], [-1, 0]]), k * np.eye(2), count=2)
    half = spin / (2 * m)
    fast = half + np.hypot(half, np.sqrt(k / m))
    np.testing.assert_allclose(modes.eigenvalues.imag, [k / m / fast, fast], rtol=1e-14)
    assert np.all(np.abs(modes.eigenvalues.real) <= 1e-14 * fast)


def test_circulatory_stiffness_makes_a_growing_and_a_dying_whirl():
    modes = _modes(np.eye(2), np.zeros((2, 2)), [[4.0, 1.0], [-1.0, 4.0]], count=2)
    expected = np.sqrt(-4.0 + np.array([1j, -1j]))
    expected = np.where(expected.imag < 0, -expected, expected)
    assert sorted(modes.eigenvalues.real) == pytest.approx(sorted(expected.real), rel=1e-13)
    np.testing.assert_allclose(modes.eigenvalues.imag, expected.imag, rtol=1e-13)


def test_a_negative_stiffness_diverges_and_is_kept():
    np.testing.assert_allclose(sorted(_modes(1.0, 0.0, -4.0).eigenvalues.real), [-2.0, 2.0], rtol=1e-13)


@pytest.mark.parametrize("n", SIZES)
@pytest.mark.parametrize(("alpha", "beta"), [(0.0, 0.0), (1e-3, 1e-3), (0.3, 0.2), (0.0, 5.0), (-1e-3, 0.0)])
def test_a_proportionally_damped_chain_has_its_closed_form_eigenvalues(n, alpha, beta):
    M, K, _ = _walls(n)
    modes = damped_modes(M, alpha * M + beta * K, K, count=12)
    expected = _proportional(clamped_bar_frequencies(n) ** 2, alpha, beta)
    assert modes.eigenvalues.size == 12
    assert modes.method == ("dense" if n == 30 else "block Arnoldi")
    np.testing.assert_allclose(np.abs(modes.eigenvalues), np.abs(expected[:12]), rtol=1e-10)
    assert _worst(modes.eigenvalues, expected) < 1e-10
    assert np.max(modes.backward_error) < 1e-12
    np.testing.assert_allclose(np.abs(modes.vectors).max(axis=0), 1.0, rtol=1e-15)


@pytest.mark.parametrize("n", SIZES)
def test_below_returns_all_that_lies_inside_the_circle(n):
    M, K, _ = _walls(n)
    expected = _proportional(clamped_bar_frequencies(n) ** 2, 0.01, 0.01)
    radius = 0.5 * (abs(expected[8]) + abs(expected[9]))
    assert damped_modes(M, 0.01 * M + 0.01 * K, K, below=radius).eigenvalues.size == 9
    assert damped_modes(M, 0.01 * M + 0.01 * K, K, below=radius, count=3).eigenvalues.size == 3
    assert damped_modes(M, 0.01 * M + 0.01 * K, K, below=0.5 * abs(expected[0])).eigenvalues.size == 0


def test_every_copy_of_repeated_eigenvalues_is_found_by_the_sparse_solver():
    M, K, _ = copies(10, *_walls(40))
    modes = damped_modes(M, 0.01 * M + 0.02 * K, K, count=35)
    assert modes.method == "block Arnoldi"
    expected = np.repeat(_proportional(clamped_bar_frequencies(40) ** 2, 0.01, 0.02), 10)[:35]
    np.testing.assert_allclose(modes.eigenvalues, expected, rtol=1e-11)


@pytest.mark.parametrize("n", SIZES)
@pytest.mark.parametrize("unit", [1e-6, 1e6])
def test_units_of_time_and_of_single_dofs_do_not_matter(n, unit):
    M, K, _ = _walls(n)
    S = sp.diags_array(np.where(np.arange(n) % 3, 1.0, unit))
    D = 0.02 * M + 0.01 * K
    plain = damped_modes(M, D, K, count=8).eigenvalues
    scaled = damped_modes(S @ M @ S, S @ D @ S / unit, S @ K @ S / unit**2, count=8).eigenvalues
    np.testing.assert_allclose(scaled * unit, plain, rtol=1e-11)


@pytest.mark.parametrize("n", SIZES)
@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
def test_the_frequency_scale_never_changes_the_answer(n, scale):
    M, K, _ = _walls(n)
    plain = damped_modes(M, 0.02 * M, K, count=8).eigenvalues
    np.testing.assert_allclose(
        damped_modes(M, 0.02 * M, K, count=8, frequency_scale=scale).eigenvalues, plain, rtol=1e-11
    )


@pytest.mark.parametrize("n", SIZES)
def test_a_free_chain_has_one_rigid_row_and_no_noise_pair(n):
    M, K, _ = bar(n)
    modes = damped_modes(M, 0.01 * K, K, count=6, rigid_vectors=np.ones((n, 1)))
    np.testing.assert_array_equal(modes.rigid, [True] + [False] * 5)
    omega2 = (2 * np.sin(np.arange(1, 6) * np.pi / (2 * n))) ** 2
    np.testing.assert_allclose(modes.eigenvalues, np.append(0.0, _proportional(omega2, 0.0, 0.01)[:5]), rtol=1e-11)
    np.testing.assert_allclose(modes.vectors[:, 0], 1.0, rtol=1e-13)


@pytest.mark.parametrize("n", SIZES)
def test_drag_on_a_rigid_motion_leaves_one_zero_and_one_real_eigenvalue(n):
    M, K, _ = bar(n)
    modes = damped_modes(M, 1e-4 * M, K, count=4, rigid_vectors=np.ones((n, 1)))
    assert modes.eigenvalues[0] == 0.0
    assert modes.eigenvalues[1] == pytest.approx(-1e-4, rel=1e-10)
    assert modes.eigenvalues[2].imag == pytest.approx(2 * np.sin(np.pi / (2 * n)), rel=1e-3)
    assert np.max(modes.backward_error) < 1e-13


def test_a_free_gyroscopic_particle_has_two_zeros_and_a_precession():
    modes = _modes(2.0 * np.eye(2), 6.0 * np.array([[0, 1], [-1, 0]]), np.zeros((2, 2)), rigid_vectors=np.eye(2))
    np.testing.assert_allclose(modes.eigenvalues, [0.0, 0.0, 3.0j], atol=1e-14)
    assert modes.vectors[1, 2] / modes.vectors[0, 2] == pytest.approx(-1j, abs=1e-13)  # -9 x + 9 j y = 0


def test_a_rigid_motion_coupled_to_an_elastic_one_by_gyroscopic_terms_drifts_with_it():
    g = 5.0  # x is free, y held by a spring: a steady drift of x bends y, so zero is double and s^2 = -(k + g^2)
    modes = _modes(np.eye(2), g * np.array([[0, 1], [-1, 0]]), np.diag([0.0, 7.0]), rigid_vectors=[[1.0], [0.0]])
    np.testing.assert_allclose(modes.eigenvalues, [0.0, 1j * np.sqrt(7.0 + g**2)], rtol=1e-14)
    assert np.max(modes.backward_error) < 1e-15


def test_a_rigid_motion_of_an_unsymmetric_stiffness_is_deflated_with_its_left_vector():
    K = np.array([[1.0, -1.0, 0.0], [-1.0, 3.0, -2.0], [0.3, -2.3, 2.0]])  # rows sum to zero, columns do not
    modes = _modes(np.eye(3), np.zeros((3, 3)), K, rigid_vectors=np.ones((3, 1)))
    roots = np.linalg.eigvals(K)
    expected = np.sort(np.sqrt(roots[np.abs(roots) > 1e-8].astype(complex)).real)
    np.testing.assert_allclose(modes.eigenvalues.imag, np.append(0.0, expected), rtol=1e-13)


def test_rigid_copies_count_once_each_in_the_sparse_solver():
    M, K, _ = copies(6, *bar(70))
    R = np.kron(np.eye(6), np.ones((70, 1)))
    modes = damped_modes(M, 0.1 * K, K, count=12, rigid_vectors=R)
    assert np.count_nonzero(modes.rigid) == 6
    np.testing.assert_allclose(np.abs(modes.eigenvalues[6:]), 2 * np.sin(np.pi / 140), rtol=1e-11)
    assert np.count_nonzero(damped_modes(M, 0.1 * K, K, count=4, rigid_vectors=R).rigid) == 4


def test_a_rigid_motion_that_was_not_given_is_refused():
    M, K, _ = bar(20)
    with pytest.raises(AnalysisError, match="rigid-body motion"):
        damped_modes(M, 0.01 * K, K, count=3)


def test_a_strained_vector_given_as_rigid_is_refused():
    M, K, _ = bar(20)
    with pytest.raises(AnalysisError, match="strained"):
        damped_modes(M, 0.01 * K, K, count=3, rigid_vectors=np.arange(20.0)[:, None])


@pytest.mark.parametrize("damper", [0.0, 3.0])
def test_massless_dofs_add_a_real_eigenvalue_each_where_damped_and_none_else(damper):
    # mass 1 on spring 1 to the wall, and a massless joint on springs 1 (to the mass) and 1 (to the wall) with a damper
    M = np.diag([1.0, 0.0])
    D = np.diag([0.1, damper])
    K = np.array([[2.0, -1.0], [-1.0, 2.0]])
    modes = _modes(M, D, K)
    roots = np.roots(np.trim_zeros(np.polysub(np.polymul([1, 0.1, 2], [damper, 2]), [1.0]), "f"))
    expected = roots[roots.imag >= 0]
    np.testing.assert_allclose(modes.eigenvalues, expected[np.argsort(np.abs(expected))], rtol=1e-13)
    assert modes.complete


def test_a_dof_with_nothing_is_named():
    with pytest.raises(LooseDofError) as caught:
        _modes(np.diag([1.0, 0.0]), np.zeros((2, 2)), np.diag([1.0, 0.0]))
    assert caught.value.dofs == (1,)


def test_a_beam_on_bearings_of_ten_to_the_thirteenth_is_exact_to_eleven_digits():
    beam = Beam([0.1] * 8, springs={1: 1e13, 7: 1e8})
    with mp.workdps(40):
        omega2 = np.array([float(value) for value in exact_eigenvalues(*beam.exact())])
    M, K = beam.matrices()
    modes = damped_modes(M, 2.0 * M + 1e-6 * K, K, count=8)
    assert _worst(modes.eigenvalues, _proportional(omega2, 2.0, 1e-6)) < 1e-11


def test_gyroscopic_beams_at_high_spin_agree_with_forty_digits():
    beam = Beam([0.2] * 3, springs={0: 1e13, 3: 1e7})
    M1, K1 = (A.toarray() for A in beam.matrices())
    n = beam.n
    spin = 1e5
    polar = np.diag(np.tile([0.0, 2e-3], beam.n // 2))
    M = np.kron(np.eye(2), M1)
    K = np.kron(np.eye(2), K1)
    D = np.kron([[0.0, spin], [-spin, 0.0]], polar) + 1e-6 * K
    modes = _modes(M, D, K, count=2 * n)
    with mp.workdps(40):
        inverse = mp.matrix(M) ** -1
        A = mp.zeros(4 * n)
        A[: 2 * n, 2 * n :] = mp.eye(2 * n)
        A[2 * n :, : 2 * n] = -inverse * mp.matrix(K)
        A[2 * n :, 2 * n :] = -inverse * mp.matrix(D)
        exact = np.array([complex(value) for value in mp.eig(A, left=False, right=False)])
    assert modes.eigenvalues.size == 2 * n
    assert _worst(modes.eigenvalues, exact) < 1e-11


def test_the_sparse_solver_agrees_with_the_dense_one_on_a_gyroscopic_damped_chain(monkeypatch):
    n = 240
    M, K, _ = copies(2, *_walls(n // 2))
    G = sp.csc_array(sp.kron(sp.csc_array([[0.0, 1.0], [-1.0, 0.0]]), sp.diags_array(np.linspace(0.0, 0.3, n // 2))))
    C = sp.diags_array(np.where(np.arange(n) % 60 == 7, 0.5, 0.0))
    sparse = damped_modes(M, C + G, K, count=24)
    monkeypatch.setattr("rotorgear.solvers.eigen.damped._DENSE_UP_TO", 1000)
    dense = damped_modes(M, C + G, K, count=24)
    assert (sparse.method, dense.method) == ("block Arnoldi", "dense")
    np.testing.assert_allclose(sparse.eigenvalues, dense.eigenvalues, rtol=1e-11)


@pytest.mark.parametrize(("asked", "match"), [({"count": 0}, "at least 1"), ({"below": 0.0}, "positive")])
def test_senseless_requests_are_refused(asked, match):
    with pytest.raises(AnalysisError, match=match):
        _modes(1.0, 0.0, 1.0, **asked)


@pytest.mark.parametrize("seed", range(12))
def test_double_real_roots_stand_twice(seed: int) -> None:
    # Two equal planes with motions that do not oscillate, seen in other coordinates: rounding makes pairs of their roots.
    rng = np.random.default_rng(seed)
    k = np.tile(10.0 ** rng.uniform(0.0, 3.0, 8), 2)
    c = np.tile(np.concatenate([10.0 ** rng.uniform(1.0, 3.0, 3), np.zeros(5)]), 2)
    Q = np.linalg.qr(rng.standard_normal((16, 16)))[0]
    K, C = (0.5 * (A + A.T) for A in ((Q * k) @ Q.T, (Q * c) @ Q.T))
    exact = np.concatenate([np.roots([1.0, ci, ki]) for ci, ki in zip(c, k, strict=True)])
    found = damped_modes(sp.csc_array(np.eye(16)), sp.csc_array(C), sp.csc_array(K), dense=True).eigenvalues
    assert np.sort(found[found.imag == 0.0].real) == pytest.approx(np.sort(exact[exact.imag == 0.0].real), rel=1e-9)


@pytest.mark.parametrize("eta", [0.3, 3.0])
def test_the_lowest_of_eigenvalues_that_gather_without_end_are_found(eta: float) -> None:
    """A chain with D = eta K: s^2 + eta w^2 s + w^2 = 0, overdamped ones at -1/eta."""
    n = 200
    k = float(n) ** 2
    K = sp.csc_array(sp.diags([-k * np.ones(n - 1), 2.0 * k * np.ones(n), -k * np.ones(n - 1)], [-1, 0, 1]))
    found = damped_modes(sp.csc_array(sp.eye(n)), sp.csc_array(eta * K), K, count=4).eigenvalues[:4]
    w2 = 4.0 * k * np.sin(np.arange(1, n + 1) * np.pi / (2.0 * (n + 1))) ** 2
    root = np.sqrt((0.5 * eta * w2) ** 2 - w2 + 0j)
    exact = np.concatenate([-0.5 * eta * w2 + root, -0.5 * eta * w2 - root])
    exact = exact[exact.imag >= 0.0]
    exact = exact[np.argsort(np.abs(exact))][:4]
    np.testing.assert_allclose(np.sort_complex(found), np.sort_complex(exact), rtol=1e-8)
