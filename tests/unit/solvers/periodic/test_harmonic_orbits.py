"""Periodic motions by harmonic balance against the equations of motion: state, forces, watched places, twice the period."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from rotorgear.forces.plain_spring import PlainSpring
from rotorgear.forces.rotating_force import RotatingForce
from rotorgear.solvers.periodic.arclength import at_value
from rotorgear.solvers.periodic.balance import HarmonicGrid
from rotorgear.solvers.periodic.harmonic_orbits import _BASES, _CONTACTS, HarmonicOrbits
from rotorgear.solvers.periodic.plant import Plant, Plants
from rotorgear.solvers.periodic.samples import spectrum
from validation.oscillators import local_system

MASS = np.array([[40.0, 3.0, 0.0], [3.0, 40.0, 0.0], [0.0, 0.0, 20.0]])
STIFFNESS = np.array([[2e7, 0.0, -1e7], [0.0, 3e7, 0.0], [-1e7, 0.0, 4e7]])
DAMPING = np.array([[900.0, 40.0, 0.0], [-40.0, 1500.0, 0.0], [0.0, 0.0, 700.0]])
LOAD = np.array([200.0, -400.0, 100.0])
SPRING = PlainSpring(1e7, 2e16, damping=900.0)
UNBALANCE = RotatingForce(0.02, phase=0.7, power=2.0, plane=True)
WATCHED = np.array([[1.0, 0.0], [0.0, 2.0], [0.5, 0.0]])


def plant_at(p: float) -> Plant:
    """Three masses with an unbalance on two of them and a cubic spring on the third, at 500 to 600 rad/s."""
    laws = [(UNBALANCE, np.eye(3)[:, :2]), (SPRING, np.eye(3)[:, [2]])]
    system = local_system(MASS, DAMPING, STIFFNESS, LOAD.tolist(), laws, 500.0 + 100.0 * p)
    return replace(Plants().of(system), watched=WATCHED)


@pytest.fixture(scope="module")
def solved() -> tuple[HarmonicOrbits, np.ndarray]:
    orbits = HarmonicOrbits(plant_at, HarmonicGrid(5, 32, 1.0), np.array([1e-5, 2e-5, 3e-5]))
    return orbits, at_value(orbits, orbits.start(0.3), 0.3).y


def test_a_solution_fulfils_the_equations_of_motion_of_the_whole_structure(
    solved: tuple[HarmonicOrbits, np.ndarray],
) -> None:
    orbits, y = solved
    plant = plant_at(0.3)
    cycle = orbits.cycle(y, 0.3)
    w = 530.0
    assert cycle.period == pytest.approx(2.0 * np.pi / w)
    # Forces of the laws over a period, as they were asked, are those of the series that is told.
    assert spectrum(cycle.at.F, 5) == pytest.approx(cycle.force, abs=2e-6 * np.abs(cycle.force).max())
    # Harmonic by harmonic: (K - w^2 M + i w D) q = f - B F, without the references of the laws.
    K = plant.K.toarray() - plant.B @ plant.forces.reference_stiffness @ plant.B.T
    D = plant.D.toarray() - plant.B @ plant.forces.reference_damping @ plant.B.T
    q = [
        np.linalg.solve(K + 1j * h * w * D - (h * w) ** 2 * MASS, (LOAD if h == 0 else 0.0) - plant.B @ cycle.force[h])
        for h in range(6)
    ]
    for h in range(6):
        assert plant.B.T @ q[h] == pytest.approx(cycle.displacement[h], abs=2e-9 * np.abs(cycle.displacement).max())
    place, rate = sum(q).real, sum(1j * h * w * q[h] for h in range(6)).real
    found = orbits.state(y, 0.3)
    assert found[0] == pytest.approx(place, rel=1e-6)
    assert found[1] == pytest.approx(rate, rel=1e-6)
    assert cycle.watched[0] == pytest.approx(WATCHED.T @ place, rel=1e-6)
    assert cycle.watched_rate[0] == pytest.approx(WATCHED.T @ rate, rel=1e-6)
    assert cycle.at.d[0] == pytest.approx(plant.B.T @ place, rel=1e-6)
    assert cycle.at.v[0] == pytest.approx(plant.B.T @ rate, rel=1e-6)


def test_derivatives_by_unknowns_and_parameter_are_difference_quotients(
    solved: tuple[HarmonicOrbits, np.ndarray],
) -> None:
    orbits, y = solved
    y = y + 0.05 * np.random.default_rng(2).normal(size=y.size)
    linear = orbits.linear(y, 0.3)
    h = 1e-4
    quotient = [(orbits.residual(y + e, 0.3) - orbits.residual(y - e, 0.3)) / (2.0 * h) for e in h * np.eye(y.size)]
    assert linear.in_y == pytest.approx(np.array(quotient).T, abs=2e-6)
    slope = (orbits.apart().residual(y, 0.3005) - orbits.apart().residual(y, 0.2995)) / 0.001
    assert linear.in_p == pytest.approx(slope, abs=2e-3 * np.abs(slope).max())


def test_a_motion_is_one_of_twice_its_period_and_of_more_harmonics(solved: tuple[HarmonicOrbits, np.ndarray]) -> None:
    orbits, y = solved
    double = orbits.doubled()
    assert (double.grid.harmonics, double.grid.instants, double.grid.order) == (10, 64, 0.5)
    # Of a period that comes twice in a turn, once.
    assert HarmonicOrbits(plant_at, HarmonicGrid(2, 8, 2.0), orbits.scale).doubled().grid.order == 1.0
    wide = orbits.twice(y, double)
    assert np.abs(double.residual(wide, 0.3)).max() < 1e-6
    # Every other harmonic is that of the motion, and the others are zero.
    assert double.coefficients(wide)[::2] == pytest.approx(orbits.coefficients(y))
    assert not double.coefficients(wide)[1::2].any()
    finer = orbits.finer()
    lifted = orbits.lifted(y, finer)
    assert finer.coefficients(lifted)[:6] == pytest.approx(orbits.coefficients(y))
    assert not finer.coefficients(lifted)[6:].any()
    # What is left are harmonics that it had not.
    assert np.abs(finer.residual(lifted, 0.3)).max() < 2e-3 * np.abs(y).max()
    # Multipliers over two periods are the squares of those over one.
    once, square = orbits.multipliers(y, 0.3), double.multipliers(wide, 0.3)
    assert np.sort(np.abs(square)) == pytest.approx(np.sort(np.abs(once) ** 2), abs=2e-3)


def test_unknowns_of_samples_are_those_of_the_motion(solved: tuple[HarmonicOrbits, np.ndarray]) -> None:
    orbits, y = solved
    assert orbits.from_samples(orbits.cycle(y, 0.3).at.d) == pytest.approx(y, abs=1e-9)
    # At rest under its load, with the laws at their mean.
    start = orbits.coefficients(orbits.start(0.3))
    assert not start[1:].any()
    spring = start[0, 2].real
    K = STIFFNESS + np.diag([0.0, 0.0, 1e7 + 2e16 * spring**2])
    assert np.linalg.solve(K, LOAD)[2] == pytest.approx(spring, rel=1e-6)


def test_a_large_basis_reaches_beyond_what_a_contact_alone_would_vibrate_at() -> None:
    """80 masses in a chain; a contact of 5e9 N/m between one of 2 kg and the ground: sqrt(k/m), well above the excitation."""
    n = 80
    mass = np.ones(n)
    mass[30] = 2.0
    chain = 1e10 * (2.0 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1))
    law = PlainSpring(5e9, damping=50.0)

    def plant(p: float) -> Plant:
        return Plants().of(
            local_system(np.diag(mass), 1e-6 * chain, chain, [1.0] * n, [(law, np.eye(n)[:, [30]])], 200.0 + p)
        )

    basis = HarmonicOrbits(plant, HarmonicGrid(3, 16, 1.0), np.array([1e-6])).modes(0.0)
    own = np.sqrt(5e9 / 2.0)
    assert basis.highest >= _CONTACTS * own > _BASES * 200.0
    assert not basis.complete
    assert basis.count < n
    # Orthonormal in M, with the static shape of the contact in it.
    assert basis.V.T @ np.diag(mass) @ basis.V == pytest.approx(np.eye(basis.V.shape[1]), abs=1e-8)
    still = np.linalg.solve(plant(0.0).K.toarray(), np.eye(n)[:, 30])
    inside = basis.V @ (basis.V.T @ (mass * still))
    assert inside == pytest.approx(still, abs=1e-8 * np.abs(still).max())
