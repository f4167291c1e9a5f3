"""Integrators against closed forms, against each other, and at their limits."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp

from rotorgear.errors import AnalysisError, ConvergenceError
from rotorgear.forces.journal_film import JournalFilm
from rotorgear.forces.law import ForceLaw, parameter
from rotorgear.forces.mesh_contact import MeshContact
from rotorgear.forces.plain_spring import PlainSpring
from rotorgear.forces.torque_curve import TorqueCurve
from rotorgear.solvers.time.contact_equilibrium import equilibrium
from rotorgear.solvers.time.exponential import Exponential
from rotorgear.solvers.time.local_system import LocalSystem, Rotation, state_at_rest
from rotorgear.solvers.time.newmark import Newmark
from rotorgear.solvers.time.run import Schedule, run
from validation.oscillators import METHODS, integrate, local_system, order

IMPLICIT = [name for name in METHODS if name != "explicit"]


def damped_pair() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    return np.diag([2.0, 1.0]), np.array([[0.3, -0.1], [-0.1, 0.2]]), np.array([[6.0, -2.0], [-2.0, 4.0]])


def exact(M: np.ndarray, D: np.ndarray, K: np.ndarray, q0: list[float], t: float) -> np.ndarray:
    from scipy.linalg import expm

    A = np.block([[np.zeros((2, 2)), np.eye(2)], [-np.linalg.solve(M, K), -np.linalg.solve(M, D)]])
    return np.asarray(expm(A * t) @ np.array([*q0, 0.0, 0.0]))[:2]


@pytest.mark.parametrize("name", ["exponential", "explicit"])
def test_a_linear_system_is_followed_exactly(name: str) -> None:
    M, D, K = damped_pair()
    motion = integrate(local_system(M, D, K, [0.0, 0.0]), name, 0.25, 40, [1.0, -0.5], [0.0, 0.0])
    assert motion.q[-1] == pytest.approx(exact(M, D, K, [1.0, -0.5], 10.0), abs=1e-8)


@pytest.mark.parametrize("name", [n for n in IMPLICIT if n not in ("exponential", "hht")])
def test_a_linear_system_is_followed_with_order_two(name: str) -> None:
    M, D, K = damped_pair()
    truth = exact(M, D, K, [1.0, -0.5], 10.0)
    counts = (100, 200, 400, 800)
    errors = []
    for n in counts:
        motion = integrate(local_system(M, D, K, [0.0, 0.0]), name, 10.0 / n, n, [1.0, -0.5], [0.0, 0.0])
        errors.append(float(np.abs(motion.q[-1] - truth).max()))
    assert order(counts, errors) == pytest.approx(2.0, abs=0.1)


@pytest.mark.parametrize("name", list(METHODS))
def test_a_free_motion_under_a_constant_force_is_a_parabola(name: str) -> None:
    K = [[1.0, -1.0], [-1.0, 1.0]]
    motion = integrate(
        local_system(np.eye(2), np.zeros((2, 2)), K, [1.0, 1.0]), name, 0.01, 1000, [0.0, 0.0], [0.0, 0.0]
    )
    assert motion.q[-1] == pytest.approx([50.0, 50.0], rel=2e-3 if name == "hht" else 1e-6)


def test_rho_inf_is_what_a_step_leaves_of_the_highest_frequencies() -> None:
    for rho in (0.4, 0.6, 0.8):
        system = local_system([[1.0]], [[0.0]], [[1e12]], [0.0])
        motion = integrate(system, Newmark.generalised_alpha(rho), 1.0, 200, [1.0], [0.0])
        # A double root: n rho^n.
        left = (np.abs(motion.q[200, 0]) / np.abs(motion.q[100, 0])) ** 0.01 / 2.0**0.01
        assert left == pytest.approx(rho, abs=0.02)


@pytest.mark.parametrize("name", IMPLICIT)
def test_a_stiffness_of_a_law_acts_like_that_of_the_structure(name: str) -> None:
    M, D, K = damped_pair()
    whole = integrate(local_system(M, D, K, [1.0, 0.0]), name, 0.05, 300, [0.0, 0.0], [0.0, 0.0])
    split = local_system(M, D, K - np.array([[1.5, 0.0], [0.0, 0.0]]), [1.0, 0.0], [(PlainSpring(1.5), [[1.0], [0.0]])])
    assert integrate(split, name, 0.05, 300, [0.0, 0.0], [0.0, 0.0]).q == pytest.approx(whole.q, abs=1e-9)


def impacts() -> LocalSystem:
    """Two masses that knock at each other and at a wall, with k(t)."""
    between = MeshContact(4.0, 0.05, 0.6, ramp=1e-3, order=1.0, stiffness_cos=(0.3,), error_cos=(0.1,))
    laws = [(between, [[1.0], [-1.0]]), (PlainSpring(2.0, 0.0, 0.02, 0.4), [[0.0], [1.0]])]
    return local_system(np.diag([1.0, 2.0]), 0.02 * np.eye(2), [[1.0, 0.0], [0.0, 0.5]], [0.4, -0.1], laws, speed=1.7)


def test_all_methods_agree_on_impacts_and_converge() -> None:
    truth = integrate(impacts(), "explicit", 0.02, 400, [0.0, 0.0], [0.0, 0.0]).F
    for name in ("average acceleration", "exponential", "generalised alpha"):
        errors = []
        for n in (1, 2, 4, 8):
            F = integrate(impacts(), name, 0.02 / n, 400 * n, [0.0, 0.0], [0.0, 0.0], every=n).F
            errors.append(float(np.sqrt(np.mean((F - truth) ** 2))))
        assert order((1, 2, 4, 8), errors) > 1.7, (name, errors)
        assert errors[-1] < 2e-3 * np.abs(truth).max()


def test_the_equilibrium_holds_still_in_every_method() -> None:
    law = MeshContact(4.0, 0.05, 0.6, ramp=1e-3)
    system = local_system(
        np.diag([1.0, 2.0]), 0.02 * np.eye(2), [[1.0, 0.0], [0.0, 0.5]], [0.4, -0.1], [(law, [[1.0], [-1.0]])]
    )
    rest = equilibrium(system)
    assert rest.converged
    for name in METHODS:
        motion = integrate(system, name, 0.05, 200, list(rest.q), [0.0, 0.0])
        assert motion.q == pytest.approx(np.tile(rest.q, (201, 1)), abs=1e-9)


def test_a_film_that_nothing_loads_takes_no_search_in_any_step() -> None:
    """Its force is rounding of its pressures: no share of itself can be met, and forces would be bisected in each step."""
    law = JournalFilm(0.02, 0.03, 0.04, 60e-6, lobes=3, preload=0.4, around=72, along=6)
    system = local_system(
        np.diag([1.0, 2.0]), 100.0 * np.eye(2), 1e7 * np.eye(2), [0.0, 0.0], [(law, np.eye(2))], 200.0
    )
    assert equilibrium(system).converged
    start = state_at_rest(system, 1e-4, np.zeros(2))
    assert run(system, Newmark(), Schedule(1e-4, 5, 1), start, lambda *_: None) <= 2 * 5


def test_the_equilibrium_finds_the_flank_that_carries() -> None:
    law = MeshContact(4.0, 0.0, 0.6)
    for load, side in ((0.4, 1.0), (-0.4, -1.0), (0.0, 0.0)):
        rest = equilibrium(local_system([[1.0]], [[0.0]], [[1e-6]], [load], [(law, [[1.0]])]))
        assert rest.converged
        assert np.sign(round(law.evaluate(rest.q).force[0], 9)) == side


def test_a_run_up_follows_the_angle_of_its_speeds() -> None:
    rotation = Rotation(np.array([0.0, 2.0]), np.array([1.0, 5.0]))
    assert rotation.angle(np.array([0.0, 1.0, 2.0, 3.0])) == pytest.approx([0.0, 2.0, 6.0, 11.0])
    with pytest.raises(AnalysisError, match="rising times"):
        Rotation(np.array([0.0, 0.0]), np.array([1.0, 5.0]))


def test_a_propeller_torque_lets_the_speed_settle_where_both_torques_are_equal() -> None:
    drive = TorqueCurve(3.0)
    propeller = TorqueCurve(-2.0, power=2.0, reference_speed=10.0)
    system = local_system([[0.1]], [[0.0]], [[0.0]], [0.0], [(drive, [[1.0]]), (propeller, [[1.0]])], speed=10.0)
    for name in ("average acceleration", "exponential"):
        motion = integrate(system, name, 0.002, 4000, [0.0], [0.0])
        assert motion.v[-1, 0] == pytest.approx(10.0 * (np.sqrt(1.5) - 1.0), rel=1e-6)


def test_the_energy_of_undamped_impacts_does_not_drift_in_200_000_steps() -> None:
    law = MeshContact(25.0, backlash=0.5, error_mean=0.25)
    system = local_system(
        np.diag([1.0, 2.0]), np.zeros((2, 2)), [[3.0, -1.0], [-1.0, 2.0]], [0.0, 0.0], [(law, [[1.0], [-1.0]])]
    )
    for name, allowed in (("average acceleration", 1e-3), ("exponential", 1e-3)):
        m = integrate(system, name, 0.005, 200_000, [1.0, -0.6], [0.0, 0.0], every=10)
        energy = 0.5 * np.einsum("ri,ij,rj->r", m.v, system.M.toarray(), m.v) + m.stored
        energy += 0.5 * np.einsum("ri,ij,rj->r", m.q, system.K.toarray(), m.q)
        assert np.abs(energy / energy[0] - 1.0).max() < allowed, name


def test_a_mass_of_nothing_is_refused_by_the_methods_that_need_it() -> None:
    system = local_system(np.diag([1.0, 0.0]), np.zeros((2, 2)), [[2.0, -1.0], [-1.0, 2.0]], [1.0, 0.0])
    for name in ("exponential", "explicit"):
        with pytest.raises(AnalysisError, match="no inertia"):
            integrate(system, name, 0.1, 10, [0.0, 0.0], [0.0, 0.0])
    motion = integrate(system, "average acceleration", 0.01, 400, [0.0, 0.0], [0.0, 0.0])
    assert motion.q[1:, 1] == pytest.approx(0.5 * motion.q[1:, 0], abs=2e-2)


class _Broken(ForceLaw):
    """A law that gives NaN beyond a displacement."""

    title = "broken"
    stiffness: float = parameter("N/m", "k", 1.0)

    def functions(self):  # type: ignore[no-untyped-def]
        from rotorgear.solvers.time.compiled import force_function
        from rotorgear.solvers.time.kernel_contact import no_schedule

        def force(p, s, d, v, F, Kd, Kv, energy):  # type: ignore[no-untyped-def]
            F[0] = d[0] if d[0] < 0.45 else np.nan
            Kd[0] = 1.0
            Kv[0] = 0.0
            energy[0] = 0.0
            energy[1] = 0.0
            energy[2] = 0.0
            energy[3] = 0.0

        global _FUNCTIONS
        if _FUNCTIONS is None:
            _FUNCTIONS = (no_schedule, force_function(force))
        return _FUNCTIONS

    def parameters(self) -> np.ndarray:
        return np.zeros(1)

    @classmethod
    def examples(cls):  # type: ignore[no-untyped-def]
        return (cls(),)


_FUNCTIONS = None


@pytest.mark.parametrize("name", list(METHODS))
def test_nan_in_a_law_stops_the_run_with_a_sentence_and_keeps_what_was_before(name: str) -> None:
    system = local_system([[1.0]], [[0.0]], [[0.0]], [0.3], [(_Broken(), [[1.0]])])
    state = state_at_rest(system, 0.01, np.zeros(1))
    kept = []
    with pytest.raises(ConvergenceError, match="not finite"):
        run(system, METHODS[name], Schedule(0.01, 5000), state, lambda records, _: kept.append(records))
    assert kept
    assert 0 < sum(r.t.size for r in kept) < 5000
    assert all(np.all(np.isfinite(r.F)) for r in kept)


def test_restarting_from_a_state_gives_the_same_trajectory() -> None:
    for name in ("average acceleration", "exponential"):
        whole = integrate(impacts(), name, 0.02, 1000, [0.0, 0.0], [0.0, 0.0])
        system = impacts()
        kept = []
        state = state_at_rest(system, 0.02, np.zeros(2))
        for goal in (300, 1000):
            run(
                system,
                METHODS[name],
                Schedule(0.02, goal),
                state,
                lambda r, _, kept=kept: kept.append(r.F),
                tolerance=1e-13,
            )
            state = state.copy()
        assert np.concatenate(kept) == pytest.approx(whole.F[1:], abs=1e-9)


def test_nearly_equal_overdamped_modes_do_not_spoil_the_exponential_method() -> None:
    M = np.eye(3)
    K = np.diag([4.0, 4.0 + 1e-9, 9.0])
    D = np.diag([1.0, 1.0, 30.0])
    found = integrate(local_system(M, D, K, [0.0] * 3), "exponential", 0.1, 50, [1.0, 1.0, 1.0], [0.0] * 3)
    truth = integrate(local_system(M, D, K, [0.0] * 3), "explicit", 0.1, 50, [1.0, 1.0, 1.0], [0.0] * 3)
    assert found.q == pytest.approx(truth.q, abs=1e-7)


def test_cut_modes_with_residual_vectors_keep_the_static_answer() -> None:
    n = 30
    K = sp.diags_array([2.0 * np.ones(n), -np.ones(n - 1), -np.ones(n - 1)], offsets=[0, 1, -1]).toarray()
    end = np.eye(n)[:, -1:]
    system = local_system(np.eye(n), 0.5 * np.eye(n), K, end[:, 0] * 0.1, [(PlainSpring(0.3), end)])
    static = np.linalg.solve(K + 0.3 * end @ end.T, end[:, 0] * 0.1)
    motion = integrate(system, Exponential(modes=6), 0.2, 3000, [0.0] * n, [0.0] * n, every=3000)
    assert motion.q[-1, -1] == pytest.approx(static[-1], rel=1e-6)
