"""Generalised alpha and HHT where the step resolves nothing, and exponential with damping by modes: closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest

from rotorgear.forces.plain_spring import PlainSpring
from rotorgear.solvers.time.exponential import Exponential
from rotorgear.solvers.time.kernel_time import rotation_at
from rotorgear.solvers.time.local_system import Rotation
from rotorgear.solvers.time.newmark import Newmark
from validation.oscillators import integrate, local_system


@pytest.mark.parametrize("rho", [0.0, 0.3, 0.8])
def test_what_generalised_alpha_cannot_resolve_shrinks_by_rho_in_every_step(rho: float) -> None:
    """All three roots of the amplification matrix are -rho at infinite frequency: (E + rho)^3 q = 0."""
    system = local_system(np.eye(1), np.zeros((1, 1)), 1e8 * np.eye(1), [0.0])
    q = integrate(system, Newmark.generalised_alpha(rho), 1.0, 12, [1.0], [0.0]).q[:, 0]
    rest = q[3:] + 3.0 * rho * q[2:-1] + 3.0 * rho**2 * q[1:-2] + rho**3 * q[:-3]
    assert np.abs(rest).max() < 1e-5 * np.abs(q).max()


@pytest.mark.parametrize("alpha", [0.05, 0.25])
def test_what_hht_cannot_resolve_follows_its_three_roots(alpha: float) -> None:
    """Twice (a - 1)/(a + 1), and a/(a - 1)."""
    system = local_system(np.eye(1), np.zeros((1, 1)), 1e8 * np.eye(1), [0.0])
    q = integrate(system, Newmark.hht(alpha), 1.0, 12, [1.0], [0.0]).q[:, 0]
    double = (alpha - 1.0) / (alpha + 1.0)
    _, a, b, c = np.poly([double, double, alpha / (alpha - 1.0)])
    assert np.abs(q[3:] + a * q[2:-1] + b * q[1:-2] + c * q[:-3]).max() < 1e-5 * np.abs(q).max()


@pytest.mark.parametrize("method", [Newmark.generalised_alpha(0.6), Newmark.hht(0.1), Newmark(0.3, 0.6)])
def test_a_spring_as_a_law_is_the_spring_in_the_matrix(method: Newmark) -> None:
    K = np.array([[3.0, -1.0], [-1.0, 2.0]])
    law = PlainSpring(0.7, damping=0.1)
    column = np.array([[1.0], [-1.0]])
    inside = local_system(np.eye(2), 0.1 * column @ column.T, K + 0.7 * column @ column.T, [0.2, 0.0])
    outside = local_system(np.eye(2), np.zeros((2, 2)), K, [0.2, 0.0], [(law, column)])
    one, other = (integrate(each, method, 0.3, 60, [1.0, 0.0], [0.0, 0.5]).q for each in (inside, outside))
    assert other == pytest.approx(one, abs=1e-9)


def test_modal_damping_lets_a_free_oscillation_decay_at_its_ratio_and_takes_the_power_it_says() -> None:
    w = 7.0
    zeta = 0.06
    m = 2.5
    system = local_system(m * np.eye(1), np.zeros((1, 1)), m * w**2 * np.eye(1), [0.0])
    method = Exponential(modal_ratio=zeta)
    found = integrate(system, method, 0.02, 200, [1.0], [0.0])
    own = w * math.sqrt(1.0 - zeta**2)
    decay = np.exp(-zeta * w * found.t)
    exact = decay * (np.cos(own * found.t) + zeta * w / own * np.sin(own * found.t))
    assert found.q[:, 0] == pytest.approx(exact, abs=1e-9)
    (row,) = method.damping_rows(system, 0.0)
    v = 0.3
    assert (row @ [v]) ** 2 == pytest.approx(2.0 * zeta * w * m * v**2, rel=1e-9)


def test_the_angle_is_the_integral_of_the_speed_in_the_loop_and_outside() -> None:
    rotation = Rotation(np.array([0.1, 0.4, 0.5, 1.0]), np.array([20.0, 50.0, 50.0, -10.0]))

    def speed(t: float) -> float:
        return float(np.interp(t, rotation.times, rotation.speeds))

    grid = np.linspace(0.0, 1.3, 130001)
    middle = 0.5 * (grid[1:] + grid[:-1])
    whole = np.concatenate([[0.0], np.cumsum(np.diff(grid) * np.interp(middle, rotation.times, rotation.speeds))])
    for t in (0.03, 0.1, 0.25, 0.4, 0.45, 0.77, 1.0, 1.2):
        angle, rate = rotation_at(t, rotation.table)
        assert rate == pytest.approx(speed(t))
        assert angle == pytest.approx(np.interp(t, grid, whole), abs=1e-6)
        assert rotation.angle(np.array(t)) == pytest.approx(angle, abs=1e-12)
