"""Motions over a period by shooting, with a law of two components behind another: blocks of tangents are told apart."""

from __future__ import annotations

import numpy as np

from rotorgear.forces.journal_bearing import JournalBearing
from rotorgear.forces.plain_spring import PlainSpring
from rotorgear.solvers.periodic.plant import Plant, Plants
from rotorgear.solvers.periodic.shooting import ShootingOrbits
from validation.oscillators import local_system

MASS = 40.0
STIFFNESS = 2e7
DAMPING = 900.0
SPEED = 300.0


def plant_at(p: float, film: bool = True) -> Plant:
    """A mass in a short film across, and one on a spring beside it that a spring joins to the first; p changes the load."""
    K = np.array([[STIFFNESS, 0.0, -STIFFNESS], [0.0, 3e6, 0.0], [-STIFFNESS, 0.0, 2.0 * STIFFNESS]])
    laws = [(PlainSpring(STIFFNESS, damping=DAMPING), np.eye(3)[:, [2]])]
    if film:
        laws.append((JournalBearing(0.02, 30e-3, 20e-3, 60e-6), np.eye(3)[:, :2]))
    load = [200.0 + 50.0 * p, -400.0, 100.0]
    system = local_system(MASS * np.diag([1.0, 1.0, 0.5]), 200.0 * np.eye(3), K, load, laws, SPEED)
    return Plants().of(system)


def test_the_derivative_of_the_map_is_its_difference_quotient() -> None:
    orbits = ShootingOrbits(plant_at, 1.0, np.array([1e-5, 60e-6, 60e-6]), 3, 16)
    y = orbits.start(0.4) + 0.02 * np.random.default_rng(2).standard_normal(orbits.size)
    residual, in_y = orbits.values(y, 0.4)
    h = 1e-6
    quotient = [(orbits.residual(y + step, 0.4) - orbits.residual(y - step, 0.4)) / (2.0 * h) for step in h * np.eye(6)]
    np.testing.assert_allclose(in_y, np.array(quotient).T, atol=1e-6)
    np.testing.assert_allclose(residual, orbits.residual(y, 0.4))
    linear = orbits.linear(y, 0.4)
    slope = (orbits.residual(y, 0.4 + 1e-4) - orbits.residual(y, 0.4 - 1e-4)) / 2e-4
    np.testing.assert_allclose(linear.in_p, slope, atol=1e-6)


def test_the_unknowns_of_a_motion_are_its_displacements_and_velocities_and_the_cycle_goes_on_from_there() -> None:
    orbits = ShootingOrbits(plant_at, 1.0, np.array([1e-5, 60e-6, 60e-6]), 3, 64)
    q, v = np.array([2e-6, -5e-6, 1e-6]), np.array([1e-3, 4e-4, -2e-3])
    y = orbits.from_motion(q, v, plant_at(0.4))
    np.testing.assert_allclose(orbits.state(y, 0.4), (q, v), rtol=1e-12)
    cycle = orbits.cycle(y, 0.4)
    np.testing.assert_allclose(cycle.at.d[0], [q[2], *q[:2]], rtol=1e-9)
    np.testing.assert_allclose(cycle.at.v[0], [v[2], *v[:2]], rtol=1e-9)
    # Over two periods it begins alike, and goes on from where the first one ends.
    double = orbits.doubled()
    both = double.cycle(orbits.twice(y, double), 0.4)
    assert both.period == 2.0 * cycle.period
    np.testing.assert_allclose(both.at.d[:64], cycle.at.d, rtol=1e-7, atol=1e-15)
    np.testing.assert_allclose(both.at.v[:64], cycle.at.v, rtol=1e-6, atol=1e-12)
    assert both.displacement.shape == (7, 3)
    # Velocities are the rates of displacements, by differences over a small part of the period.
    fine = orbits.cycle(y, 0.4, 20_000)
    step = fine.period / 20_000
    rate = (-3.0 * fine.at.d[0] + 4.0 * fine.at.d[1] - fine.at.d[2]) / (2.0 * step)
    np.testing.assert_allclose(rate, [v[2], *v[:2]], rtol=1e-4)


def test_multipliers_of_a_linear_system_are_those_of_its_eigenvalues() -> None:
    orbits = ShootingOrbits(lambda p: plant_at(p, film=False), 1.0, np.array([1e-5]), 3, 16)
    plant = plant_at(0.0, film=False)
    M, D, K = (np.asarray(A.toarray()) for A in (plant.M, plant.D, plant.K))
    inverse = np.linalg.inv(M)
    A = np.block([[np.zeros((3, 3)), np.eye(3)], [-inverse @ K, -inverse @ D]])
    exact = np.exp(np.linalg.eigvals(A) * 2.0 * np.pi / SPEED)
    found = orbits.multipliers(orbits.start(0.0), 0.0)
    np.testing.assert_allclose(np.sort_complex(found), np.sort_complex(exact), atol=1e-8)
    # At rest under its load it stays there.
    assert np.abs(orbits.residual(orbits.start(0.0), 0.0)).max() < 1e-8
