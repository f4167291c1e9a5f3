import numpy as np
import pytest
import scipy.sparse as sp

from rotorgear.errors import AnalysisError
from rotorgear.solvers.eigen.eigen import lowest_modes
from rotorgear.solvers.sparse.pencil import LooseDofError
from tests.unit.solvers.spring_chains import bar, clamped_bar_frequencies, copies, free_bar_frequencies

SIZES = [40, 400]  # dense and block Lanczos


def _walls(n: int, **kw):
    k = kw.get("stiffness", 1.0)
    return bar(n, ground={0: k, n - 1: k}, **kw)


def _relative(modes, omega):
    return np.max(np.abs(np.sqrt(modes.eigenvalues) / omega[: modes.eigenvalues.size] - 1.0))


@pytest.mark.parametrize("n", SIZES)
@pytest.mark.parametrize("with_strain", [True, False])
def test_a_chain_between_walls_has_its_closed_form_frequencies(n, with_strain):
    M, K, strain = _walls(n)
    modes = lowest_modes(M, K, count=12, strain=strain if with_strain else None)
    assert modes.method == ("dense" if n == 40 else "block Lanczos")
    assert _relative(modes, clamped_bar_frequencies(n)) < (1e-13 if with_strain else 1e-11)
    assert modes.rigid_count == 0
    assert modes.sturm_count_ok
    assert modes.sturm_count >= 12
    assert np.max(modes.backward_error) < 1e-12
    np.testing.assert_allclose(modes.vectors.T @ (M @ modes.vectors), np.eye(12), atol=1e-13)


@pytest.mark.parametrize("n", SIZES)
@pytest.mark.parametrize("time_unit", [1e-9, 1e-3, 1e9])
def test_the_answer_does_not_depend_on_the_unit_of_time(n, time_unit):
    M, K, strain = _walls(n, stiffness=time_unit**2)
    modes = lowest_modes(M, K, count=8, strain=strain)
    assert _relative(modes, clamped_bar_frequencies(n, stiffness=time_unit**2)) < 1e-13


@pytest.mark.parametrize("n", SIZES)
@pytest.mark.parametrize("length_unit", [1e-6, 1e6])
def test_the_answer_does_not_depend_on_the_unit_of_some_dofs(n, length_unit):
    M, K, strain = _walls(n)
    scale = np.where(np.arange(n) % 2, 1.0, length_unit)
    S = sp.diags_array(scale)
    modes = lowest_modes(S @ M @ S, S @ K @ S, count=8, strain=lambda V: strain(scale[:, None] * V))
    assert _relative(modes, clamped_bar_frequencies(n)) < 1e-13


@pytest.mark.parametrize("n", [8, 100])
@pytest.mark.parametrize("with_strain", [True, False])
def test_twenty_four_rigid_modes_are_found_and_counted(n, with_strain):
    M, K, strain = copies(24, *bar(n))
    modes = lowest_modes(M, K, count=50, strain=strain if with_strain else None)
    assert modes.rigid_count == 24
    assert np.all(modes.eigenvalues[:24] <= 1e-24 if with_strain else modes.eigenvalues[:24] == 0.0)
    expected = np.repeat(free_bar_frequencies(n)[1:4], 24)[:26]
    np.testing.assert_allclose(np.sqrt(modes.eigenvalues[24:]), expected, rtol=1e-13 if with_strain else 1e-11)


def test_each_copy_of_repeated_eigenvalues_is_found_by_the_sparse_solver():
    M, K, strain = copies(10, *_walls(60))
    modes = lowest_modes(M, K, count=35, strain=strain)
    assert modes.method == "block Lanczos"
    np.testing.assert_allclose(np.sqrt(modes.eigenvalues), np.repeat(clamped_bar_frequencies(60), 10)[:35], rtol=1e-13)


@pytest.mark.parametrize("n", SIZES)
@pytest.mark.parametrize("softness", [1e-3, 1e-12])
def test_a_soft_support_is_no_rigid_mode(n, softness):
    M, K, strain = bar(n, stiffness=1e6, ground={n // 2: softness})
    modes = lowest_modes(M, K, count=3, strain=strain)
    assert modes.rigid_count == 0
    assert modes.eigenvalues[0] == pytest.approx(softness / n, rel=1e-3 * softness + 1e-10)


@pytest.mark.parametrize("n", SIZES)
def test_one_soft_and_one_rigid_body_are_told_apart(n):
    M, K, strain = bar(n, stiffness=1e6, ground={0: 1e-6})
    M2, K2, strain2 = bar(n, stiffness=1e6)
    both = sp.csc_array(sp.block_diag([M, M2])), sp.csc_array(sp.block_diag([K, K2]))
    modes = lowest_modes(*both, count=4, strain=lambda V: np.vstack([strain(V[:n]), strain2(V[n:])]))
    assert modes.rigid_count == 1
    assert modes.eigenvalues[1] == pytest.approx(1e-6 / n, rel=1e-9)


@pytest.mark.parametrize("n", SIZES)
def test_below_returns_the_modes_up_to_a_frequency_and_no_others(n):
    M, K, strain = _walls(n)
    omega = clamped_bar_frequencies(n)
    assert lowest_modes(M, K, below=0.5 * (omega[6] + omega[7]), strain=strain).eigenvalues.size == 7
    assert lowest_modes(M, K, below=omega[6], strain=strain).eigenvalues.size == 7
    assert lowest_modes(M, K, below=0.5 * omega[0], strain=strain).eigenvalues.size == 0
    assert lowest_modes(M, K, below=omega[9], count=4, strain=strain).eigenvalues.size == 4


def test_below_counts_rigid_modes():
    M, K, strain = copies(3, *bar(20))
    modes = lowest_modes(M, K, below=1e-3, strain=strain)
    assert modes.eigenvalues.size == modes.rigid_count == 3


def test_all_modes_are_returned_when_more_are_asked_for_than_exist():
    M, K, strain = _walls(12)
    modes = lowest_modes(M, K, count=50, strain=strain)
    assert modes.complete
    assert modes.available == 12
    assert _relative(modes, clamped_bar_frequencies(12)) < 1e-14
    assert not lowest_modes(M, K, count=5).complete


@pytest.mark.parametrize("n", SIZES)
def test_massless_dofs_give_no_modes_and_follow_their_neighbours(n):
    M, K, strain = _walls(n, stiffness=2.0)
    light = np.arange(n) % 2 == 0  # even nodes lose their mass: the odd ones are then joined by springs of stiffness 1
    M = sp.csc_array(sp.diags_array(np.where(light, 0.0, 1.0)))
    modes = lowest_modes(M, K, count=n, strain=strain)
    assert modes.available == modes.eigenvalues.size == n // 2
    last = K[[n - 2]].toarray()[0]
    assert last @ modes.vectors[:, 0] == pytest.approx(0.0, abs=1e-14)
    odd = n // 2
    walls = np.diag(np.full(odd, 2.0)) - np.diag(np.ones(odd - 1), 1) - np.diag(np.ones(odd - 1), -1)
    walls[-1, -1] = 3.0  # the last mass touches the wall through one spring of stiffness 2
    np.testing.assert_allclose(modes.eigenvalues, np.linalg.eigvalsh(walls), rtol=1e-11)


def test_a_mass_of_low_rank_gives_as_many_modes_as_its_rank():
    # Every dof has mass, but not of its own: 1 / lambda are the eigenvalues of B^T K^-1 B for M = B B^T, and no more.
    draw = np.random.default_rng(4)
    B = draw.standard_normal((20, 6))
    _, K, _ = _walls(20)
    modes = lowest_modes(sp.csc_array(B @ B.T), K, count=20)
    assert modes.available == 6
    exact = 1.0 / np.linalg.eigvalsh(B.T @ np.linalg.solve(K.toarray(), B))[::-1]
    np.testing.assert_allclose(modes.eigenvalues, exact, rtol=1e-11)


def test_a_dof_with_neither_mass_nor_stiffness_is_named():
    M, K, _ = _walls(6)
    M = sp.block_diag([M, [[0.0]]])
    K = sp.block_diag([K, [[0.0]]])
    with pytest.raises(LooseDofError) as caught:
        lowest_modes(M, K, count=2)
    assert caught.value.dofs == (6,)


def test_massless_dofs_that_move_together_without_strain_are_named():
    M, K, _ = _walls(6)
    M = sp.block_diag([M, np.zeros((2, 2))])
    K = sp.block_diag([K, [[1.0, -1.0], [-1.0, 1.0]]])
    with pytest.raises(LooseDofError) as caught:
        lowest_modes(M, K, count=2)
    assert set(caught.value.dofs) <= {6, 7}


def test_masses_without_any_springs_are_all_rigid():
    modes = lowest_modes(sp.eye_array(5), sp.csc_array((5, 5)), count=9, strain=lambda V: 0.0 * V)
    assert modes.rigid_count == modes.available == 5


def test_one_mass_on_one_spring():
    modes = lowest_modes(sp.csc_array([[2.0]]), sp.csc_array([[18.0]]), count=1)
    assert modes.eigenvalues[0] == pytest.approx(9.0, rel=1e-15)


@pytest.mark.parametrize("n", SIZES)
def test_a_statically_unstable_stiffness_is_refused(n):
    M, K, _ = _walls(n)
    with pytest.raises(AnalysisError, match="statically unstable"):
        lowest_modes(M, K - 0.1 * sp.eye_array(n), count=2)


def test_an_unsymmetric_stiffness_is_refused():
    with pytest.raises(AnalysisError, match="not symmetric"):
        lowest_modes(sp.eye_array(2), sp.csc_array([[2.0, 1.0], [-1.0, 2.0]]), count=1)


def test_the_same_input_gives_the_same_bits():
    M, K, strain = _walls(400)
    first, second = (lowest_modes(M, K, count=6, strain=strain) for _ in range(2))
    np.testing.assert_array_equal(first.vectors, second.vectors)


@pytest.mark.parametrize(("asked", "match"), [({"count": 0}, "at least 1"), ({"below": -1.0}, "positive")])
def test_senseless_requests_are_refused(asked, match):
    M, K, _ = _walls(5)
    with pytest.raises(AnalysisError, match=match):
        lowest_modes(M, K, **asked)


def test_strains_by_stretches_of_rows_keep_soft_modes_of_a_tall_matrix():
    n = 9000  # rows of several stretches
    M, K, _ = bar(n, 1e6, 1.0, {0: 1e-3})
    S = sp.diags_array([np.full(n - 1, -1e3), np.full(n - 1, 1e3)], offsets=[0, 1], shape=(n - 1, n))
    S = sp.csr_array(sp.vstack([S, sp.csr_array(([np.sqrt(1e-3)], ([0], [0])), shape=(1, n))]))
    as_matrix = lowest_modes(M, K, count=6, strain=S)
    as_function = lowest_modes(M, K, count=6, strain=lambda V: S @ V)
    # The whole bar on its soft spring, and a free bar as good as: closed forms.
    assert as_matrix.rigid_count == 0
    assert as_matrix.eigenvalues[0] == pytest.approx(1e-3 / n, rel=1e-5)
    np.testing.assert_allclose(as_matrix.eigenvalues[1:], 1e6 * free_bar_frequencies(n)[1:6] ** 2, rtol=1e-5)
    np.testing.assert_allclose(as_matrix.eigenvalues, as_function.eigenvalues, rtol=1e-9)


@pytest.mark.parametrize("n", [400, 6000])
def test_lower_modes_of_a_basis_are_accurate_and_its_factor_is_that_of_the_shift(n):
    M, K, strain = bar(n, 1e6, 1.0, {0: 1e6, n - 1: 1e6})
    basis = lowest_modes(M, K, count=26, strain=strain, counted=False)
    exact = 1e6 * clamped_bar_frequencies(n)[:26] ** 2
    np.testing.assert_allclose(basis.eigenvalues[:18], exact[:18], rtol=1e-10)
    np.testing.assert_allclose(basis.eigenvalues, exact, rtol=0.05)
    np.testing.assert_allclose(basis.vectors.T @ (M @ basis.vectors), np.eye(26), atol=1e-12)
    b = np.random.default_rng(1).standard_normal(n)
    np.testing.assert_allclose((K - basis.shift * M) @ basis.factor.solve(b), b, atol=1e-8)
    assert lowest_modes(M, K, count=5, strain=strain).factor is None, "what nobody goes on with is not kept"
