"""Forces of the laws against formulas written out by hand, away from the values where a sign or a factor drops out."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad

from rotorgear.forces.ball_bearing import BallBearing
from rotorgear.forces.mesh_contact import MeshContact
from rotorgear.forces.mesh_friction import MeshFriction
from rotorgear.forces.roller_bearing import RollerBearing
from rotorgear.forces.rotating_force import RotatingForce
from rotorgear.forces.tabulated_force import TabulatedForce
from rotorgear.forces.torque_curve import TorqueCurve

# --- force that turns ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("order", [1.0, -0.4, 2.5])
def test_an_unbalance_is_the_centripetal_force_of_a_mass_that_turns_with_its_own_shaft(order: float) -> None:
    mass = 0.02
    radius = 0.03
    start = 0.7
    speed = 90.0
    law = RotatingForce(mass * radius, order, start, 2.0, plane=True)

    def place(t: float) -> np.ndarray:
        angle = order * speed * t + start
        return radius * np.array([math.cos(angle), math.sin(angle)])

    h = 1e-5
    for t in (0.0, 0.013, 0.05):
        acceleration = (place(t + h) - 2.0 * place(t) + place(t - h)) / h**2
        # The law's force acts against the displacement: that on the structure is minus it, and minus m a.
        given = law.evaluate(np.zeros(2), 0.0, angle=speed * t, speed=speed).force
        assert given == pytest.approx(mass * acceleration, rel=1e-4)


def test_a_force_without_power_does_not_know_the_speed() -> None:
    law = RotatingForce(80.0, 3.0, 0.4)
    for speed in (0.0, 50.0, -300.0):
        assert law.evaluate([0.0], angle=0.9, speed=speed).force[0] == pytest.approx(-80.0 * math.cos(3.0 * 0.9 + 0.4))


# --- torque of a machine ------------------------------------------------------------------------------------------------


def test_a_propeller_takes_the_square_of_its_own_speed_and_its_ripple_and_step_multiply() -> None:
    law = TorqueCurve(
        -800.0, -0.2, 2.0, 30.0, damping=3.0, ripple=0.1, order=4.0, phase=0.3, step=0.4, step_time=1.0, step_rise=0.5
    )
    for time, share in (
        (0.5, 1.0),
        (1.125, 1.0 - 0.6 * 0.5 * (1.0 - math.cos(math.pi / 4.0))),
        (1.25, 0.7),
        (3.0, 0.4),
    ):
        slow = 2.5  # rad/s beside the mean speed
        own = -0.2 * 200.0 + slow
        torque = -800.0 * share * (1.0 + 0.1 * math.cos(4.0 * 0.8 + 0.3)) * (own / 30.0) ** 2
        found = law.evaluate([0.0], [slow], time=time, angle=0.8, speed=200.0)
        assert found.force[0] == pytest.approx(-torque + 3.0 * slow, rel=1e-12)


# --- tooth contact ------------------------------------------------------------------------------------------------------


def test_harmonics_of_stiffness_and_error_stand_where_the_mesh_phase_says() -> None:
    law = MeshContact(
        3e8,
        gap="bilateral",
        order=-20.0,
        phase=0.4,
        stiffness_cos=(0.1, 0.05),
        stiffness_sin=(0.2, -0.03),
        error_mean=1e-6,
        error_cos=(2e-6, 1e-6),
        error_sin=(3e-6, -4e-6),
    )
    for angle in (0.0, 0.05, 0.11):
        p = -20.0 * angle + 0.4
        k = 3e8 * (1.0 + 0.1 * math.cos(p) + 0.05 * math.cos(2 * p) + 0.2 * math.sin(p) - 0.03 * math.sin(2 * p))
        e = 1e-6 + 2e-6 * math.cos(p) + 1e-6 * math.cos(2 * p) + 3e-6 * math.sin(p) - 4e-6 * math.sin(2 * p)
        assert law.evaluate([5e-6], angle=angle, speed=10.0).force[0] == pytest.approx(k * (5e-6 - e), rel=1e-12)


def test_pieces_are_straight_between_their_ends_and_the_mean_of_both_on_a_jump() -> None:
    law = MeshContact(1e8, gap="bilateral", order=1.0, pieces=((0.0, 0.8, 1.0), (0.4, 1.2, 1.5), (0.9, 0.6, 0.7)))

    def k(share: float) -> float:
        return law.evaluate([1e-6], angle=2.0 * math.pi * share).force[0] / 1e2

    assert k(0.1) == pytest.approx(0.85, rel=1e-9)
    assert k(0.3) == pytest.approx(0.95, rel=1e-9)
    assert k(0.5) == pytest.approx(1.26, rel=1e-9)
    assert k(0.95) == pytest.approx(0.65, rel=1e-9)
    assert k(0.4) == pytest.approx(0.5 * (1.0 + 1.2), rel=1e-6)
    assert k(0.9) == pytest.approx(0.5 * (1.5 + 0.6), rel=1e-6)
    assert k(1.0) == pytest.approx(0.5 * (0.8 + 0.7), rel=1e-6)
    assert law.reference_stiffness()[0, 0] == pytest.approx(1e8 * (0.4 * 0.9 + 0.5 * 1.35 + 0.1 * 0.65), rel=1e-12)


def test_a_corner_impact_is_half_a_sine_that_comes_earlier_by_its_phase() -> None:
    law = MeshContact(0.0, order=1.0, impact=50.0, impact_share=0.2, impact_phase=0.3)
    for share in np.linspace(0.001, 0.999, 37):
        since = (share + 0.3) % 1.0
        expected = 50.0 * math.sin(math.pi * since / 0.2) if since < 0.2 else 0.0
        assert law.evaluate([0.0], angle=2.0 * math.pi * share).force[0] == pytest.approx(expected, abs=1e-9)


def test_damping_acts_on_the_rate_of_the_depth_which_the_error_moves_too() -> None:
    law = MeshContact(3e8, 900.0, gap="bilateral", order=20.0, phase=0.2, error_cos=(2e-6,), error_sin=(1e-6,))
    speed = 70.0

    def error(t: float) -> float:
        p = 20.0 * speed * t + 0.2
        return 2e-6 * math.cos(p) + 1e-6 * math.sin(p)

    rate = (error(1e-7) - error(-1e-7)) / 2e-7
    found = law.evaluate([4e-6], [3e-3], speed=speed)
    assert found.force[0] == pytest.approx(3e8 * (4e-6 - error(0.0)) + 900.0 * (3e-3 - rate), rel=1e-6)


def test_the_back_flank_carries_behind_the_backlash_and_pushes_the_other_way() -> None:
    law = MeshContact(2e8, backlash=30e-6, error_mean=5e-6)
    for d, force in ((7e-6, 2e8 * 2e-6), (4e-6, 0.0), (-24e-6, 0.0), (-27e-6, -2e8 * 2e-6)):
        assert law.evaluate([d]).force[0] == pytest.approx(force, rel=1e-9)
    assert [law.evaluate([d]).contact for d in (7e-6, 0.0, -27e-6)] == [1, 0, -1]


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_damping_by_penetration_grows_with_the_depth_and_no_damping_pulls(side: float) -> None:
    law = MeshContact(2e8, 800.0, 30e-6, contact_damping="penetration", ramp=4e-6)
    depth = 3e-6
    place = depth if side > 0 else -30e-6 - depth
    assert law.evaluate([place], [side * 0.01]).force[0] == pytest.approx(
        side * (2e8 * depth + 800.0 * depth / 4e-6 * 0.01), rel=1e-9
    )
    for kind, least in (("penetration", 0.0), ("non-adhesive", 0.0), ("adhesive", 2e8 * depth - 800.0 * 0.75 * 9.0)):
        own = replace(law, contact_damping=kind)
        assert side * own.evaluate([place], [-side * 9.0]).force[0] == pytest.approx(least, rel=1e-9, abs=1e-9)


# --- friction -----------------------------------------------------------------------------------------------------------

NORMAL = MeshContact(2e8, gap="bilateral", order=20.0, phase=0.9)


def places(pitch: float, start: float, end: float, cycle: float) -> list[float]:
    """Contacts between the ends of the path, one base pitch apart, one of them at the pitch point at cycle 0."""
    return [xi for n in range(-5, 6) if start <= (xi := (cycle + n) * pitch) <= end]


@pytest.mark.parametrize("angle", [0.0, 0.07, 0.2])
def test_friction_by_benedict_and_kelley_is_what_their_formula_gives_by_hand(angle: float) -> None:
    pitch = 8e-3
    start = -5e-3
    end = 6.5e-3
    law = MeshFriction(NORMAL, pitch, start, end, closing=1.6, viscosity=25.0, line_load=3e5, rolling=0.03, smooth=1e-9)
    speed = 250.0
    found = law.evaluate([10e-6, 0.0, 0.0], 0.0, angle=angle, speed=speed).force
    N = 2e8 * 10e-6
    there = places(pitch, start, end, (20.0 * angle + 0.9) / (2.0 * math.pi))
    force = moment = 0.0
    for xi in there:
        slide = abs(xi * 1.6 * speed)
        roll = 0.03 * speed
        mu = 0.0127 * math.log10(29.66 * 3e5 / (25.0 * slide * roll**2))
        assert 0.01 < mu < 0.1
        force += math.copysign(mu * N / len(there), xi)
        moment += abs(xi) * mu * N / len(there)
    assert found[1:] == pytest.approx([force, moment], rel=1e-9)


def test_friction_stands_against_the_sliding_of_each_contact() -> None:
    pitch = 8e-3
    law = MeshFriction(NORMAL, pitch, -5e-3, 6.5e-3, closing=1.6, coefficient=0.06, smooth=0.02)
    for angle in (0.0, 0.07, 0.2):
        d = [10e-6, 0.0, 0.0]
        v = [0.0, 0.013, -2.0]
        there = places(pitch, -5e-3, 6.5e-3, (20.0 * angle + 0.9) / (2.0 * math.pi))
        shares = [0.06 * 2e3 / len(there) * math.tanh((xi * 1.6 * 4.0 + v[1] + xi * v[2]) / 0.02) for xi in there]
        found = law.evaluate(d, v, angle=angle, speed=4.0)
        assert found.force == pytest.approx([0.0, sum(shares), sum(x * s for x, s in zip(there, shares, strict=True))])


def test_helical_friction_is_the_mean_over_slices_whose_contact_lags_across_the_face() -> None:
    pitch = 8e-3
    start = -5e-3
    end = 6.5e-3
    law = MeshFriction(NORMAL, pitch, start, end, closing=1.6, coefficient=0.05, overlap=0.8, smooth=1e-9)
    for angle in (0.03, 0.2):
        lines = [
            places(pitch, start, end, (20.0 * angle + 0.9) / (2.0 * math.pi) - 0.8 * ((i + 0.5) / 9 - 0.5))
            for i in range(9)
        ]
        each = 0.05 * 2e3 / sum(map(len, lines))
        moment = each * sum(abs(xi) for line in lines for xi in line)
        force = each * sum(math.copysign(1.0, xi) for line in lines for xi in line)
        found = law.evaluate([10e-6, 0.0, 0.0], 0.0, angle=angle, speed=4.0).force
        assert found == pytest.approx([0.0, force, moment])


# --- rolling bearings ---------------------------------------------------------------------------------------------------


def ball_energy(bearing: BallBearing, d: np.ndarray, angle: float) -> float:
    """2/5 c_p sum delta^(5/2) from the distance of the groove centres in space, of a ring that is moved as a rigid body."""
    first = bearing.inner_groove * bearing.ball_diameter
    second = bearing.outer_groove * bearing.ball_diameter
    A = first + second - bearing.ball_diameter
    a0 = bearing.contact_angle
    # Ball circle of radius D_pw/2; the inner groove's centre lies outwards of the ball, the outer one's inwards.
    middle = first - 0.5 * bearing.ball_diameter
    cosine = (A * math.cos(a0) - 0.5 * bearing.clearance) / A
    inner = 0.5 * bearing.pitch_diameter + middle * cosine
    outer = inner - (A * math.cos(a0) - 0.5 * bearing.clearance)
    total = 0.0
    for j in range(bearing.balls):
        phi = bearing.order * angle + bearing.phase + 2.0 * math.pi * j / bearing.balls
        across = np.array([math.cos(phi), math.sin(phi), 0.0])
        centre = inner * across
        moved = centre + d[:3] + np.cross([d[3], d[4], 0.0], centre) + [0.0, 0.0, A * math.sin(a0)]
        # in the plane of the ball
        u = moved @ across - outer
        delta = math.hypot(u, moved[2]) - A
        total += 0.4 * bearing.contact_constant * max(delta, 0.0) ** 2.5
    return total


@pytest.mark.parametrize(
    "bearing",
    [
        BallBearing(7, 11.5e-3, 43.5e-3, 0.515, 0.54, clearance=10e-6, order=0.4, phase=0.2),
        BallBearing(9, 14e-3, 77e-3, 0.515, 0.56, contact_angle=0.44, order=-0.4),
    ],
)
def test_a_ball_bearing_pushes_as_the_energy_of_its_contacts_falls(bearing: BallBearing) -> None:
    rng = np.random.default_rng(4)
    for _ in range(3):
        d = np.array([30e-6, 30e-6, 25e-6, 4e-4, 4e-4]) * rng.uniform(0.4, 1.0, 5) * rng.choice([-1.0, 1.0], 5)
        found = bearing.evaluate(d, angle=0.9)
        assert found.stored == pytest.approx(ball_energy(bearing, d, 0.9), rel=1e-9)
        for i in range(5):
            step = np.zeros(5)
            step[i] = 1e-9 if i < 3 else 1e-8
            slope = (ball_energy(bearing, d + step, 0.9) - ball_energy(bearing, d - step, 0.9)) / (2.0 * step[i])
            assert found.force[i] == pytest.approx(slope, rel=1e-4, abs=1e-4 * np.abs(found.force[:3]).max())


def test_roller_forces_are_the_sum_over_the_rollers_that_are_pressed() -> None:
    law = RollerBearing(9, 12e-3, clearance=8e-6, order=-0.4, phase=0.3)
    d = np.array([20e-6, -12e-6])
    force = np.zeros(2)
    for j in range(9):
        phi = -0.4 * 0.7 + 0.3 + 2.0 * math.pi * j / 9
        direction = np.array([math.cos(phi), math.sin(phi)])
        delta = 1e3 * max(float(direction @ d) - 4e-6, 0.0)  # mm
        force += 35948.0 * 12.0 ** (8.0 / 9.0) * delta ** (10.0 / 9.0) * direction
    assert law.evaluate(d, angle=0.7).force == pytest.approx(force, rel=1e-6)


def test_the_power_that_turning_rollers_put_in_is_the_change_of_energy_with_the_cage_angle() -> None:
    for law, d in (
        (RollerBearing(9, 12e-3, clearance=8e-6, order=-0.4, phase=0.3), np.array([20e-6, -12e-6])),
        (BallBearing(7, 11.5e-3, 43.5e-3, order=0.4, phase=0.2), np.array([20e-6, -12e-6, 9e-6, 2e-4, -3e-4])),
    ):
        h = 1e-5
        slope = (law.evaluate(d, angle=0.7 + h).stored - law.evaluate(d, angle=0.7 - h).stored) / (2.0 * h)
        assert law.evaluate(d, angle=0.7, speed=50.0).power_in == pytest.approx(50.0 * slope, rel=1e-5)


def test_the_mean_of_a_contact_is_the_mean_over_its_cycle() -> None:
    law = MeshContact(
        1e8, gap="bilateral", order=1.0, pieces=((0.0, 0.8, 1.0), (0.4, 1.2, 1.5)), error_mean=2e-6, error_cos=(1e-6,)
    )
    mean = quad(lambda u: law.evaluate([1e-6], angle=2 * math.pi * u).in_displacement[0, 0], 0.0, 1.0, points=[0.4])[0]
    still = law.mean().evaluate([5e-6], angle=1.0)
    assert still.in_displacement[0, 0] == pytest.approx(mean, rel=1e-6)
    assert still.force[0] == pytest.approx(mean * 3e-6, rel=1e-6)


# --- tables -------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("order", [1.0, -0.6])
def test_a_table_over_the_angle_that_begins_late_goes_on_straight_into_the_next_turn(order: float) -> None:
    places = (0.9, 2.0, 5.1)
    values = (10.0, 40.0, -20.0)
    law = TabulatedForce(places, values, True, order)
    for angle in np.linspace(-9.0, 9.0, 43):
        expected = np.interp(order * angle, places, values, period=2.0 * math.pi)
        assert law.evaluate([0.0], angle=angle).force[0] == pytest.approx(-expected, abs=1e-12)


def test_a_table_over_time_stays_at_its_ends() -> None:
    places = (0.2, 0.5, 1.1)
    values = (3.0, 70.0, -20.0)
    law = TabulatedForce(places, values)
    for time in (-1.0, 0.1, 0.2, 0.3, 0.5, 0.9, 1.1, 7.0):
        expected = np.interp(time, places, values)
        assert law.evaluate([0.0], time=time).force[0] == pytest.approx(-expected, abs=1e-12)
