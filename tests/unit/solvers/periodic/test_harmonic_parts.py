"""Parts of harmonic balance by themselves: series, sums beside switches, arcs, receptances, static parts, Hill's equation."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

from rotorgear.forces.journal_bearing import JournalBearing
from rotorgear.forces.plain_spring import PlainSpring
from rotorgear.solvers.periodic.arclength import Linear, Walk, at_value, walk
from rotorgear.solvers.periodic.balance import (
    HarmonicGrid,
    balance,
    coefficients,
    samples_of,
    synthesised,
    unknowns,
)
from rotorgear.solvers.periodic.floquet import FINER, basis_of, multipliers, sorted_by_size
from rotorgear.solvers.periodic.plant import Plant, Plants
from rotorgear.solvers.periodic.receptances import Receptances
from rotorgear.solvers.periodic.samples import spectrum
from rotorgear.solvers.periodic.switches import Switches, _jumps, switches_of
from validation.oscillators import local_system

H = 3


def series(c: np.ndarray, phase: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Re sum c_h e^{i h phase}, and its derivative by the phase."""
    h = np.arange(len(c))
    turned = np.exp(1j * np.outer(phase, h))
    return np.real(turned @ c), np.real((1j * h * turned) @ c)


def random_coefficients(m: int, harmonics: int = H, seed: int = 0) -> np.ndarray:
    rng = np.random.default_rng(seed)
    c = rng.normal(size=(harmonics + 1, m)) + 1j * rng.normal(size=(harmonics + 1, m))
    c[0] = c[0].real
    return c


@pytest.mark.parametrize("instants", [8, 24])
def test_series_are_put_together_and_taken_apart(instants: int) -> None:
    grid = HarmonicGrid(H, instants, 0.5)
    assert (grid.doubled.harmonics, grid.doubled.instants, grid.doubled.order) == (6, 2 * instants, 0.5)
    assert grid.frequency(-70.0) == 35.0
    c = random_coefficients(2)
    y = unknowns(c)
    assert y.shape == (2 * (2 * H + 1),)
    assert coefficients(y, grid, 2) == pytest.approx(c)
    # Real parts of all, then the imaginary ones from the first on.
    assert y[2:4] == pytest.approx(c[1].real)
    assert y[8:10] == pytest.approx(c[1].imag)
    w = 35.0
    phase = 2.0 * np.pi * np.arange(instants) / instants
    value, rate = series(c, phase)
    d, v = synthesised(c, w, instants)
    assert d == pytest.approx(value, abs=1e-12)
    assert v == pytest.approx(w * rate, abs=1e-10)
    assert spectrum(d, H) == pytest.approx(c, abs=1e-12)


def pieces(p: float, first: float, second: float) -> float:
    """A smooth function with a jump of 0.7 and a bend of -1.3 at one phase, taken back at another."""
    smooth = np.cos(p) + 0.3 * np.sin(2.0 * p)
    return float(smooth + (0.7 - 1.3 * (p - first) if first <= p < second else 0.0))


@pytest.mark.parametrize("harmonic", [0, 1, 3])
def test_what_a_sum_misses_beside_jumps_is_known_to_the_third_order(harmonic: int) -> None:
    first, second = 1.234, 4.321
    for count in (64, 128):
        s = 2.0 * np.pi / count
        places = np.array([first, second])
        theta = places / s - np.floor(places / s)
        jump = np.array([[0.7], [-(0.7 - 1.3 * (second - first))]])
        rate = np.array([[-1.3], [1.3]])
        switches = Switches(places, theta, s, jump, rate, jump, 2.0 * jump, rate, 2.0 * rate)
        p = s * np.arange(count)
        values = np.array([pieces(x, first, second) for x in p])
        mean = np.mean(values * np.exp(-1j * harmonic * p))

        def part(x: float, of: Any) -> float:
            return pieces(x, first, second) * float(of(harmonic * x))

        exact = quad(part, 0.0, 2.0 * np.pi, (np.cos,), points=[first, second], limit=200)[0]
        exact = exact - 1j * quad(part, 0.0, 2.0 * np.pi, (np.sin,), points=[first, second], limit=200)[0]
        missed = mean - exact / (2.0 * np.pi)
        said = switches.of_forces(4)[harmonic, 0]
        assert abs(missed - said) < min(0.05 * abs(missed), 0.02 * s**3)
        in_d, in_v = switches.of_tangents(4)
        assert in_d[4 + harmonic, 0] == pytest.approx(said)
        assert in_v[4 - harmonic, 0] == pytest.approx(2.0 * np.conj(said))


def test_jumps_are_led_to_the_switch_from_both_sides() -> None:
    """-g is 2 + 3 x before and 5 - x behind, at one and two steps; entries of other laws do not jump."""
    step = 1e-3
    before, after = (lambda x: -(2.0 + 3.0 * x)), (lambda x: -(5.0 - x))
    values = np.array([before(-step), before(-2.0 * step), after(step), after(2.0 * step)])
    beside = np.repeat(values[:, None, None], 2, axis=2)
    jump, rate = _jumps(beside, np.array([[True, False]]), step)
    assert jump == pytest.approx(np.array([[3.0, 0.0]]))
    assert rate == pytest.approx(np.array([[-4.0, 0.0]]))


class Ellipse:
    """4 (y - p)^2 + (p - 0.5)^2 = 0.3^2."""

    def residual(self, y: np.ndarray, p: float) -> np.ndarray:
        return np.array([4.0 * (y[0] - p) ** 2 + (p - 0.5) ** 2 - 0.09])

    def linear(self, y: np.ndarray, p: float) -> Linear:
        slope = 8.0 * (y[0] - p)
        return Linear(self.residual(y, p), np.array([[slope]]), np.array([-slope + 2.0 * (p - 0.5)]))

    def prepare_at(self, p: float) -> None:
        """Nothing is approximated."""


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_a_closed_branch_is_followed_round_both_of_its_folds(sense: float) -> None:
    start = at_value(Ellipse(), np.array([0.66]), 0.5, sense)
    assert start.z == pytest.approx([0.65, 0.5])
    assert np.sign(start.tangent[1]) == sense
    nodes = [start]
    plan = Walk(longest=0.05, most=200)
    end = walk(Ellipse(), start, 0.01, plan, lambda node: nodes.append(node) is None)
    assert end.ended == "closed"
    z = np.array([node.z for node in nodes])
    assert 4.0 * (z[:, 0] - z[:, 1]) ** 2 + (z[:, 1] - 0.5) ** 2 == pytest.approx(np.full(len(z), 0.09), abs=1e-9)
    steps = np.linalg.norm(np.diff(z, axis=0), axis=1)
    assert steps[0] == pytest.approx(0.01, rel=0.05)
    # No longer than allowed, and as long as that where the curve is straight.
    assert 0.03 < steps.max() < 0.06
    for node in nodes:
        y, p = node.z
        gradient = np.array([8.0 * (y - p), -8.0 * (y - p) + 2.0 * (p - 0.5)])
        assert node.tangent @ gradient == pytest.approx(0.0, abs=1e-9)
        assert np.linalg.norm(node.tangent) == pytest.approx(1.0)
    assert z[:, 1].min() == pytest.approx(0.2, abs=3e-3)
    assert z[:, 1].max() == pytest.approx(0.8, abs=3e-3)


@pytest.mark.parametrize(("sense", "edge"), [(1.0, 0.7), (-1.0, 0.35)])
def test_a_walk_ends_at_the_end_of_its_range(sense: float, edge: float) -> None:
    start = at_value(Ellipse(), np.array([0.66]), 0.5, sense)
    nodes = []
    end = walk(Ellipse(), start, 0.02, Walk(longest=0.05, low=0.35, high=0.7), lambda node: nodes.append(node) is None)
    assert end.ended == "end"
    assert end.here.p == pytest.approx(edge, abs=1e-12)
    assert end.here.y[0] == pytest.approx(edge + 0.5 * np.sqrt(0.09 - (edge - 0.5) ** 2), rel=1e-9)
    assert end.here.tangent[1] * sense > 0.0
    assert walk(Ellipse(), start, 0.02, Walk(most=3), lambda node: True).ended == "most"
    assert walk(Ellipse(), start, 0.02, Walk(), lambda node: False).ended == "stopped"


MASS = np.array([[40.0, 3.0, 0.0], [3.0, 40.0, 0.0], [0.0, 0.0, 20.0]])
GYRO = np.array([[0.0, 5.0, 0.0], [-5.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
SPEED = 300.0


def plant(gap: float = 0.0, speed: float = SPEED, film: bool = True) -> Plant:
    """Three masses; a film with two components stands before a spring with a cubic term and a clearance."""
    K = np.array([[2e7, 0.0, -1e7], [0.0, 3e6, 0.0], [-1e7, 0.0, 4e7]])
    laws: list[Any] = [(JournalBearing(0.02, 30e-3, 20e-3, 60e-6), np.eye(3)[:, :2])] if film else []
    laws.append((PlainSpring(1e7, 3e17, damping=900.0, gap=gap), np.eye(3)[:, [2]]))
    D = 200.0 * np.diag([1.0, 2.0, 0.5]) + speed * GYRO
    return Plants().of(local_system(MASS, D, K, [200.0, -400.0, 100.0], laws, speed))


def test_forces_in_balance_are_the_series_of_what_laws_have_beyond_their_reference() -> None:
    own = plant()
    grid = HarmonicGrid(H, 64, 1.0)
    c = 4e-6 * random_coefficients(own.m, seed=3)
    u, tangent = balance(c, own, grid)
    samples = samples_of(c, own, grid, 64)
    # Where the film cavitates sums are mended beside its kinks, which is little at 64 instants.
    assert samples.t == pytest.approx(2.0 * np.pi / SPEED * np.arange(64) / 64)
    k, damping = own.forces.reference_stiffness, own.forces.reference_damping
    rest = samples.d @ k.T + samples.v @ damping.T - samples.F
    phase = SPEED * samples.t
    for h in range(H + 1):
        share = (2.0 if h else 1.0) * np.mean(rest * np.exp(-1j * h * phase)[:, None], axis=0)
        assert u[h] == pytest.approx(share, rel=1e-6, abs=1e-6 * np.abs(u).max())
    # Derivatives by all unknowns are difference quotients.
    y = unknowns(c)
    for j in range(len(y)):
        step = 1e-10 * np.eye(len(y))[j]
        more, less = (balance(coefficients(y + s * step, grid, own.m), own, grid, tangents=False)[0] for s in (1, -1))
        quotient = (more - less) / 2e-10
        column = tangent.reshape(H + 1, own.m, -1)[:, :, j]
        assert column == pytest.approx(quotient, rel=2e-4, abs=2e-4 * np.abs(quotient).max())


def test_tangents_change_continuously_where_a_clearance_closes() -> None:
    own = plant(gap=3e-6, film=False)
    grid = HarmonicGrid(H, 48, 1.0)
    c = np.zeros((H + 1, 1), complex)
    c[1], c[2] = 9e-6, 2e-6j
    u, tangent = balance(c, own, grid)
    exact, exact_tangent = balance(c, own, HarmonicGrid(H, 4096, 1.0))
    assert u == pytest.approx(exact, abs=2e-3 * np.abs(exact).max())
    assert tangent == pytest.approx(exact_tangent, abs=0.02 * np.abs(exact_tangent).max())


@pytest.mark.parametrize("gap", [0.0, 3e-6])
def test_multipliers_are_those_of_the_variational_equation(gap: float) -> None:
    """M x'' + D x' + (K + B [k(t) - k] B^T) x = 0 along a given motion, by an integrator of its own: Hill's equation."""
    own = plant(gap=gap, film=False)
    grid = HarmonicGrid(H, 64, 1.0)
    c = np.zeros((H + 1, 1), complex)
    c[0], c[1], c[2] = 1e-6, 9e-6, 2e-6j
    fine = samples_of(c, own, grid, 1024 * FINER)
    found = multipliers(own, basis_of(own, 1e5), fine, switches_of(c, fine, own, SPEED))
    inverse = np.linalg.inv(MASS)
    D, K, B = own.D.toarray(), own.K.toarray(), own.B

    def rate(t: float, flat: np.ndarray) -> np.ndarray:
        x = flat.reshape(6, 6)
        d = series(c, np.array([SPEED * t]))[0][0, 0]
        # Of the law k x + k3 x^3 + c v, x being what d is beyond the clearance; k and c stand in K and D.
        touches = abs(d) > gap
        stiffer = (3.0 * 3e17 * (abs(d) - gap) ** 2 if touches else -1e7) * B @ B.T
        return np.vstack([x[3:], -inverse @ ((K + stiffer) @ x[:3] + D @ x[3:])]).ravel()

    period = 2.0 * np.pi / SPEED
    motion = solve_ivp(rate, (0.0, period), np.eye(6).ravel(), rtol=1e-8, atol=1e-10, max_step=period / 400)
    exact = sorted_by_size(np.linalg.eigvals(motion.y[:, -1].reshape(6, 6)))
    assert np.abs(found) == pytest.approx(np.abs(exact), abs=1e-3)
    assert np.sort(found.real) == pytest.approx(np.sort(exact.real), abs=1e-3)


def test_what_floats_is_displaced_without_its_free_motion() -> None:
    """Two masses on one spring: K q is the load less what accelerates both, and q has no part of the translation."""
    M, K = np.diag([2.0, 5.0]), 1e6 * np.array([[1.0, -1.0], [-1.0, 1.0]])
    law = PlainSpring(1e3, damping=10.0)
    own = Plants().of(local_system(M, np.zeros((2, 2)), K, [30.0, 4.0], [(law, [[1.0], [-1.0]])], 10.0))
    K = own.K.toarray()
    free = own.free
    assert free.T @ M @ free == pytest.approx(np.eye(1))
    assert np.abs(K @ free).max() < 1e-6
    for q, f in ((own.static.q, own.load), (own.static.X[:, 0], own.B[:, 0])):
        assert (free.T @ M @ q)[0] == pytest.approx(0.0, abs=1e-15)
        assert K @ q == pytest.approx(f - M @ free @ (free.T @ f), abs=1e-9 * np.abs(f).max())
    assert own.static.d == pytest.approx(own.B.T @ own.static.q)
    assert pytest.approx(own.B.T @ own.static.X) == own.static.R


@pytest.mark.parametrize("order", [1.0, 0.5])
def test_receptances_between_exact_values_are_those_of_the_whole_system(order: float) -> None:
    known = Receptances(H, order)
    for place, speed in enumerate((280.0, 300.0, 320.0)):
        X = known.exact(plant(speed=speed), float(place))
        h = 2
        w = (h + 1) * order * speed
        own = plant(speed=speed)
        Z = own.K.toarray() + 1j * w * own.D.toarray() - w**2 * MASS
        assert X[h] == pytest.approx(np.linalg.solve(Z, np.hstack([own.B, own.watched])), rel=1e-9)
    own = plant(speed=307.0)
    assert known.frequencies(own) == pytest.approx(order * 307.0 * np.arange(1, H + 1))
    R = known.near(own)
    assert R[0] == pytest.approx(own.B.T @ np.linalg.solve(own.K.toarray(), own.B))
    for h in range(1, H + 1):
        w = h * order * 307.0
        Z = own.K.toarray() + 1j * w * own.D.toarray() - w**2 * MASS
        assert R[h] == pytest.approx(own.B.T @ np.linalg.solve(Z, own.B), rel=1e-8)
    assert known.holds_for(own, 1.35)
    assert not known.holds_for(own, 2.6)
    assert not Receptances(H, order).holds_for(own, 1.0)
