"""The split-torque gearbox with contacts that part: order of the methods, and agreement with an explicit reference."""

from __future__ import annotations

import numpy as np
import pytest

from rotorgear.solvers.time.contact_equilibrium import equilibrium
from rotorgear.solvers.time.explicit import Explicit
from rotorgear.solvers.time.exponential import Exponential
from rotorgear.solvers.time.local_system import Integrator, LocalSystem, state_at_rest
from rotorgear.solvers.time.newmark import Newmark
from validation.benchmarks.transient_speed import parting_gearbox, step_of
from validation.oscillators import order

# Steps of a 25th of the mesh period, and how many of them.
COARSE = 8
STEPS = 150


@pytest.fixture(scope="module")
def gearbox() -> LocalSystem:
    return parting_gearbox(share=0.05)


def forces(system: LocalSystem, method: Integrator, finer: int) -> tuple[np.ndarray, np.ndarray]:
    """Contact forces at the coarse steps, and contact losses, with a step so many times finer than the coarse one."""
    h = COARSE * step_of(system) / finer
    state = state_at_rest(system, h, equilibrium(system).q)
    stepper = method.prepare(system, h, float(system.rotation.speeds[0]), 1e-12)
    stepper.start(state)
    found = stepper.advance(state, STEPS * finer, finer)
    assert found.status == 0
    return found.F, state.events[:, 3]


@pytest.mark.long
def test_the_methods_converge_with_their_order_and_agree_with_an_explicit_reference(gearbox: LocalSystem) -> None:
    exponential = Exponential()
    truth, losses = forces(gearbox, exponential, 512)
    assert gearbox.n > 500
    assert gearbox.m == 8
    assert losses.sum() > 10
    size = float(np.sqrt(np.mean((truth - truth.mean(axis=0)) ** 2)))

    def error(F: np.ndarray) -> float:
        return float(np.sqrt(np.mean((F - truth) ** 2))) / size

    for method in (Newmark(), exponential):
        errors = [error(forces(gearbox, method, n)[0]) for n in (4, 8, 16, 32)]
        assert order((4, 8, 16, 32), errors) > 1.7, (method.name, errors)
    for method, finer in ((Newmark(), 128), (exponential, 128), (Explicit(1e-9), 1)):
        assert error(forces(gearbox, method, finer)[0]) < 1e-4, method.name
