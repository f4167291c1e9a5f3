"""Solutions over a range of frequencies: in a basis they are the direct ones to the error that is stated, where it is proved."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp

from rotorgear.errors import ConvergenceError
from rotorgear.solvers.frequency.frequency_range import TOLERANCE, FrequencyRange
from rotorgear.solvers.frequency.harmonic import Dynamics, LowRank, projected


def chain(n: int, damping: float, skew: float = 0.0) -> Dynamics:
    """Unequal masses on unequal springs, the first one held; `skew` couples neighbours as gyroscopic moments do."""
    random = np.random.default_rng(5)
    m = random.uniform(0.5, 2.0, n)
    k = random.uniform(1e4, 4e4, n)
    K = sp.diags_array([k + np.append(k[1:], 0.0), -k[1:], -k[1:]], offsets=[0, -1, 1])
    G = sp.diags_array([np.full(n - 1, skew), np.full(n - 1, -skew)], offsets=[1, -1])
    return Dynamics(sp.csc_array(sp.diags_array(m)), sp.csc_array(damping * K + G), sp.csc_array(K))


def whole(found: FrequencyRange, count: int) -> np.ndarray:
    """All solutions (p, n, i)."""
    blocks = found.blocks()
    assert np.array_equal(np.concatenate(blocks), np.arange(count))
    return np.concatenate([found.solutions(at) for at in blocks])


@pytest.mark.parametrize(
    ("damping", "skew"), [(1e-5, 0.0), (2e-6, 3.0), (0.0, 5.0)], ids=["damped", "turning", "undamped"]
)
def test_solutions_in_a_basis_are_the_direct_ones(damping: float, skew: float) -> None:
    system = chain(120, damping, skew)
    w = np.linspace(1.0, 20.0, 400)
    f = np.eye(120)[:, [119, 40]]
    found = FrequencyRange(system, w, f)
    q = whole(found, len(w))
    assert "basis" in found.method
    assert 0.0 < found.error <= TOLERANCE
    direct = np.array([system.solve(value, f) for value in w])
    off = np.linalg.norm(q - direct, axis=1) / np.linalg.norm(direct, axis=1)
    assert off.max() < 10.0 * TOLERANCE


@pytest.mark.parametrize("size", [1.0, 2.0**30, 2.0**-30])
def test_a_residual_is_relative_to_the_forces_inside_and_does_not_know_their_size(size: float) -> None:
    system = chain(20, 1e-5, 2.0)
    f = size * np.eye(20)[:, [3, 7]].astype(complex)
    q = system.solve(40.0, f)
    assert system.relative_residual(40.0, f, q) < 1e-13
    # Without the motion all of the force is left over, and nothing else is there to compare it with.
    assert system.relative_residual(40.0, f, 0.0 * q) == 1.0
    off = q.copy()
    off[:, 1] *= 1.0 + 1e-3
    inside = np.abs(system.K) @ np.abs(off) + 40.0**2 * (np.abs(system.M) @ np.abs(off))
    share = 1e-3 * size / (np.linalg.norm(inside[:, 1]) + size)
    assert system.relative_residual(40.0, f, off) == pytest.approx(share, rel=1e-6)


@pytest.mark.parametrize("at_resonance", [False, True])
def test_damping_of_single_modes_acts_as_the_matrix_that_it_stands_for(at_resonance: bool) -> None:
    """Near a resonance of the structure without it too, where the formula divides by next to nothing."""
    plain = chain(24, 1e-5, 2.0)
    P = np.random.default_rng(8).standard_normal((24, 3))
    d = np.array([2.0, 0.5, 7.0])
    f = np.eye(24)[:, [3, 20]]
    assembled = Dynamics(plain.M, sp.csc_array(plain.D + P @ np.diag(d) @ P.T), plain.K)
    squares = np.linalg.eigvals(np.linalg.solve(plain.M.toarray(), plain.K.toarray()))
    w = float(np.sqrt(np.sort(squares.real)[4])) * (1.0 if at_resonance else 0.9)
    if at_resonance:
        plain = Dynamics(plain.M, 0.0 * plain.D, plain.K)
        assembled = Dynamics(plain.M, sp.csc_array(P @ np.diag(d) @ P.T), plain.K)
    low_rank = Dynamics(plain.M, plain.D, plain.K, LowRank(P, d, np.zeros(3)))
    exact = np.linalg.solve((assembled.K + 1j * w * assembled.D - w**2 * assembled.M).toarray(), f)
    np.testing.assert_allclose(low_rank.solve(w, f), exact, rtol=1e-9, atol=1e-11 * np.abs(exact).max())
    pencil = projected(low_rank, np.eye(24))
    np.testing.assert_allclose(pencil.D, assembled.D.toarray(), rtol=1e-12, atol=1e-12)


def test_small_systems_are_solved_all_at_once() -> None:
    system = chain(17, 1e-5, 2.0)
    w = np.linspace(1.0, 300.0, 500)
    f = np.eye(17)[:, [3]]
    found = FrequencyRange(system, w, f)
    direct = np.array([system.solve(value, f) for value in w])
    assert found.error == 0.0
    assert whole(found, len(w)) == pytest.approx(direct, rel=1e-9, abs=1e-12 * np.abs(direct).max())


def test_a_range_with_more_modes_than_a_basis_pays_for_is_solved_directly() -> None:
    system = chain(90, 1e-7)
    w = np.linspace(1.0, 500.0, 100)
    found = FrequencyRange(system, w, np.eye(90)[:, [89]])
    assert "every frequency" in found.method
    assert whole(found, len(w))[7] == pytest.approx(system.solve(float(w[7]), np.eye(90)[:, [89]]), rel=1e-12)


def test_an_undamped_resonance_to_the_last_digit_is_refused() -> None:
    system = Dynamics(*(sp.csc_array(np.diag(values)) for values in ([1.0, 1.0], [0.0, 0.0], [4.0, 9.0])))
    with pytest.raises(ConvergenceError, match="undamped resonance"):
        whole(FrequencyRange(system, np.array([1.0, 2.0, 2.5]), np.ones((2, 1))), 3)
