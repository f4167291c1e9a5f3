"""Numbers of a system by hand: modes that are damped, contacts as lines, centrifugal loads of planets on their pins."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rotorgear.errors import AnalysisError
from rotorgear.solvers.time.sisters import sister_turn
from rotorgear.system.contacts import ContactLines
from rotorgear.system.damped_range import all_damped, damped_up_to, undamped_above
from rotorgear.system.planets import PinLoad


def sized(n: int, coarsest: int) -> Any:
    return SimpleNamespace(n=n, with_plan=lambda plan: SimpleNamespace(n=coarsest))


@pytest.mark.parametrize(
    ("n", "coarsest", "all_of_them"),
    [(60, 30, True), (61, 60, True), (600, 60, True), (601, 60, False), (90, 61, False)],
)
def test_the_coarsest_mesh_decides_whether_all_modes_are_damped(n: int, coarsest: int, all_of_them: bool) -> None:
    system = sized(n, coarsest)
    assert all_damped(system) == all_of_them
    assert damped_up_to(system, 200.0) == (np.inf if all_of_them else 300.0)


def test_what_is_not_damped_is_said_in_hertz() -> None:
    (sentence,) = undamped_above(2.0 * np.pi * 321.0, 0.01)
    assert "above 321 Hz, 1.5 times" in sentence
    assert undamped_above(np.inf, 0.01) == undamped_above(1.0, 0.0) == ()


def test_contacts_press_where_flanks_have_closed_their_gap_and_damp_against_their_carrier() -> None:
    rng = np.random.default_rng(1)
    n, c = 5, 3
    v, tilt = rng.normal(size=(2, n, c))
    k, kt = np.array([2e8, 3e8, 5e8]), np.array([1e4, 0.0, 3e4])
    gap, start, couple = np.array([1e-6, 2e-6, -3e-6]), np.array([10.0, 0.0, -7.0]), np.array([0.5, 0.0, -0.2])
    damping = np.array([100.0, 300.0, 700.0])
    lines = ContactLines((), v, v, tilt, tilt, v, k, damping, gap, kt, start, couple, sister_turn(np.arange(3) * 2.1))
    q = 1e-6 * rng.normal(size=n)
    for i in range(c):
        assert lines.force(q)[i] == pytest.approx(start[i] + k[i] * (v[:, i] @ q - gap[i]), rel=1e-12)
        assert lines.moment(q)[i] == pytest.approx(couple[i] + kt[i] * (tilt[:, i] @ q), rel=1e-12)
    s = rng.normal(size=(2, c)) + 1j * rng.normal(size=(2, c))
    w, speed = np.array([30.0, 70.0]), 11.0
    assert lines.turning is not None
    # The rate that the teeth feel: s' of what stands still, less what the carrier turns on.
    rate = 1j * w[:, None] * s - speed * (lines.turning @ s.T).T
    assert lines.forces(s, w, speed) == pytest.approx(k * s + damping * rate, rel=1e-12)


def test_a_pattern_over_the_planets_is_turned_on_by_a_quarter_and_further_classes_stay() -> None:
    angles = 0.3 + 2.0 * np.pi * np.arange(5) / 5
    T = sister_turn(angles)
    # T = -d/d psi of the first class.
    assert T @ np.cos(angles - 0.7) == pytest.approx(np.sin(angles - 0.7))
    assert T @ np.sin(angles - 0.7) == pytest.approx(-np.cos(angles - 0.7))
    for other in (np.ones(5), np.cos(2.0 * angles), np.sin(2.0 * angles)):
        assert T @ other == pytest.approx(np.zeros(5), abs=1e-12)


def test_the_load_of_a_planet_on_its_pin_grows_with_its_way_out() -> None:
    """m on a spring k at radius r: (k - m W^2) d = m W^2 r, f = m W^2 (r + d) = k d; none is held above sqrt(k/m)."""
    m, k, r = 2.0, 8e6, 0.15
    planets: Any = SimpleNamespace(radius=r, planets=("p#1", "p#2", "p#3"), carrier="k", shaft="c")
    # f r (1 - e e') of three arms at 120 deg on the rotations of the carrier.
    arms = [np.array([np.cos(a), np.sin(a), 0.0]) for a in 2.0 * np.pi * np.arange(3) / 3]
    lever = np.sum([r * (np.eye(3) - np.outer(e, e)) for e in arms], axis=0)
    load = PinLoad(planets, 4, lever[None], np.array([[k]]), np.array([[-m]]), np.array([m]), m)
    for W in (10.0, -300.0, 1500.0):
        way = m * W**2 * r / (k - m * W**2)
        assert load.force(W) == pytest.approx(m * W**2 * (r + way), rel=1e-12)
        assert load.force(W) == pytest.approx(k * way, rel=1e-12)
    with pytest.raises(AnalysisError, match="centrifugal load grows faster"):
        load.force(2100.0)
    square = load.group_per_square(0.25).matrices.modulus_per_square
    assert square is not None
    assert square[0] == pytest.approx(m * r * lever, abs=1e-12)
    beyond = load.group(load.beyond(0.25 * 4000.0)).matrices.modulus
    assert beyond is not None
    assert beyond[0] == pytest.approx((load.force(1000.0) - m * 1000.0**2 * r) * lever, abs=1e-6)
    # A planet that stays on its pin.
    empty = np.zeros((0, 0))
    assert PinLoad(planets, 4, lever[None], empty, empty, np.zeros(0), m).force(-20.0) == pytest.approx(400.0 * m * r)
