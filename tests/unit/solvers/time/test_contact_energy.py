"""Contact that parts keeps its energy, whatever the step: x'' + x + s max(x - 1, 0) = 0 from x = -3."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp

from rotorgear.forces.mesh_contact import MeshContact
from rotorgear.solvers.time.exponential import Exponential
from rotorgear.solvers.time.local_forces import gather
from rotorgear.solvers.time.local_system import Integrator, LocalSystem, MotionState, Rotation, state_at_rest
from rotorgear.solvers.time.newmark import Newmark
from rotorgear.solvers.time.run import Schedule, run

PERIODS = 5


def oscillator(stiffness: float, damping: float = 0.0, kind: str = "non-adhesive") -> LocalSystem:
    law = MeshContact(stiffness, damping, gap="unilateral", error_mean=1.0, contact_damping=kind, ramp=1e-9)
    one = sp.csc_array(np.eye(1))
    return LocalSystem(one, 0.0 * one, one, one, gather((law,)), np.zeros(1), Rotation.constant(1.0))


def period(stiffness: float) -> float:
    """Free flight up to x = 1 and down again, and a part of a sine about the contact's own centre."""
    rate = np.sqrt(1.0 + stiffness)
    free = 2.0 * (np.pi - np.arccos(1.0 / 3.0))
    return float(free + (np.pi - 2.0 * np.arctan2(1.0 / (1.0 + stiffness), np.sqrt(8.0) / rate)) / rate)


def energies(system: LocalSystem, method: Integrator, h: float, steps: int) -> tuple[np.ndarray, MotionState]:
    state = state_at_rest(system, h, np.array([-3.0]))
    found: list[np.ndarray] = []

    def receive(records, state):  # type: ignore[no-untyped-def]
        q, v = (records.rows(kind, np.eye(1))[:, 0] for kind in "qv")
        found.append(0.5 * v**2 + 0.5 * q**2 + records.energy[:, 0, 0])

    run(system, method, Schedule(h, steps), state, receive)
    return np.concatenate(found), state


@pytest.mark.parametrize("method", [Newmark(), Exponential()], ids=["newmark", "exponential"])
@pytest.mark.parametrize("stiffness", [1.0, 1e2, 1e4, 1e6])
def test_stiff_contact_neither_gains_nor_loses_energy(method: Integrator, stiffness: float) -> None:
    energy, state = energies(oscillator(stiffness), method, period(stiffness) / 200.0, 200 * PERIODS)
    assert np.abs(energy / 4.5 - 1.0).max() < 1e-8 * PERIODS
    if stiffness < 1e6:  # at 1e6 the contact lasts a tenth of a step
        assert state.events[0, 3] == PERIODS


@pytest.mark.parametrize("kind", ["non-adhesive", "adhesive", "penetration"])
@pytest.mark.parametrize("method", [Newmark(), Exponential()], ids=["newmark", "exponential"])
def test_damping_that_jumps_only_takes_energy_and_every_step_ends(method: Integrator, kind: str) -> None:
    damping = 1.0 if kind == "penetration" else 50.0
    energy, _ = energies(oscillator(1e4, damping, kind), method, period(1e4) / 200.0, 200 * PERIODS)
    assert np.diff(energy).max() < 1e-9
    assert energy[-1] < 0.9 * energy[0]


def test_the_period_of_a_resolved_contact_is_the_closed_form_with_second_order() -> None:
    errors = []
    for count in (400, 800):
        system = oscillator(100.0)
        state = state_at_rest(system, 1.0, np.array([-3.0]))
        run(system, Newmark(), Schedule(period(100.0) / count, count), state, lambda records, state: None)
        errors.append(abs(state.v[0]))  # at x = -3 again, with no speed
    assert errors[1] < 0.02
    assert 2.5 < errors[0] / errors[1] < 6.0


@pytest.mark.parametrize("method", [Newmark(), Exponential()], ids=["newmark", "exponential"])
def test_the_impulse_of_impacts_is_that_of_the_momentum_where_no_step_sees_them(method: Integrator) -> None:
    system = oscillator(1e8)
    h = period(1e8) / 50.0
    state = state_at_rest(system, h, np.array([-3.0]))
    springs = 0.0

    def receive(records, state):  # type: ignore[no-untyped-def]
        nonlocal springs
        q = np.concatenate([[-3.0], records.rows("q", np.eye(1))[:, 0]])
        springs += h * float((0.5 * (q[1:] + q[:-1])).sum())

    run(system, method, Schedule(h, 50), state, receive)
    impulse = h * (state.gathered.sums[0, 0] + state.gathered.level[0] * 50)
    assert impulse == pytest.approx(2.0 * np.sqrt(8.0), rel=0.1)
    if isinstance(method, Newmark):
        assert impulse == pytest.approx(-springs - state.v[0], rel=1e-9)
