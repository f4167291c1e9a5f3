"""Curves at positions that are not even: exact harmonics, kinks that are found, and errors that are not smaller than they say."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rotorgear.gears.loaded.cycle_positions import sampled
from rotorgear.gears.loaded.helix_cycles import HelixCycles, contact_events, known_events
from rotorgear.gears.loaded.mesh_cycle import loaded_cycle, mesh_cycle, with_more
from rotorgear.gears.stiffness.cycle_curve import CycleCurve
from tests.unit.gears.tooth_pairs import LOAD, spur

KINK = 0.3137


def kinked(u: np.ndarray) -> np.ndarray:
    """1 at a kink, falling as parabolas to either side: known mean, extremes and harmonics."""
    t = np.mod(u - KINK, 1.0)
    return 1.0 - 3.0 * t + 3.0 * t**2


class Curve:
    """A function in the place of the contact, which gives its kink away or not."""

    def __init__(self, *, tells: bool) -> None:
        self.position = np.empty(0)
        self.tells = tells

    def add(self, positions: np.ndarray) -> np.ndarray:
        self.position = np.sort(np.concatenate([self.position, positions]))
        return np.stack([kinked(positions), np.sin(2.0 * np.pi * positions)], axis=1)

    def events(self) -> tuple[np.ndarray, np.ndarray]:
        if not self.tells:
            return np.empty(0), np.empty(0)
        near = self.position[np.abs(self.position - KINK).argmin()]
        return np.array([KINK]), np.array([near])


def test_harmonics_of_a_kinked_parabola_are_exact_at_uneven_positions() -> None:
    rng = np.random.default_rng(4)
    u = np.sort(np.concatenate([[KINK], rng.uniform(0.0, 1.0, 14)]))
    curve = CycleCurve(u, kinked(u)[:, None], 1.0, u == KINK)
    # 1 - 3 t + 3 t^2 = 1/2 + sum of 3 / (pi n)^2 cos(2 pi n t)
    n = np.arange(1, 9)
    expected = 3.0 / (np.pi * n) ** 2 * np.exp(-2j * np.pi * n * KINK)
    assert curve.mean()[0] == pytest.approx(0.5, abs=1e-12)
    assert curve.harmonics(8)[:, 0] == pytest.approx(expected, abs=1e-12)
    assert curve.at(np.array([0.9, -0.2, 1.77]))[:, 0] == pytest.approx(kinked(np.array([0.9, 0.8, 0.77])), abs=1e-12)


def test_smooth_curves_converge_with_order_three() -> None:
    errors = []
    for n in (20, 40):
        u = (np.arange(n) + 0.3 * np.sin(np.arange(n))) / n
        wave = np.sin(2.0 * np.pi * u)
        curve = CycleCurve(u, wave[:, None], 1.0, np.zeros(n, bool))
        at = np.linspace(0.0, 1.0, 500)
        errors.append(np.abs(curve.at(at)[:, 0] - np.sin(2.0 * np.pi * at)).max())
    assert errors[1] < errors[0] / 6.0


@pytest.mark.parametrize("tells", [True, False])
@pytest.mark.parametrize("count", [8, 16, 32, 64, 256])
def test_no_error_is_larger_than_what_is_said_of_it(count: int, tells: bool) -> None:
    curve = Curve(tells=tells)
    found = sampled(curve.add, curve.events, count, 1.0, np.empty(0), np.array([2, 2]))
    assert len(found.curve.position) == count
    actual = np.array([0.75, 2.0]) - np.ptp(found.curve.values, axis=0)
    assert (actual <= 1.5 * found.peak_to_peak_error() + 1e-9).all()
    n = np.arange(1, 6)
    exact = np.stack([3.0 / (np.pi * n) ** 2 * np.exp(-2j * np.pi * n * KINK), np.where(n == 1, -1j, 0.0)], axis=1)
    assert (np.abs(found.curve.harmonics(5) - exact) <= 1.5 * found.harmonics_error(5) + 1e-9).all()


class Bump:
    """A narrow bump between positions, while events elsewhere ask for all the solutions."""

    PLACE = 0.531

    def __init__(self) -> None:
        self.rounds = 0

    def add(self, positions: np.ndarray) -> np.ndarray:
        from_place = np.mod(positions, 1.0) - self.PLACE
        return (1.0 + 0.2 * np.exp(-((from_place / 0.015) ** 2)))[:, None]

    def events(self) -> tuple[np.ndarray, np.ndarray]:
        self.rounds += 1
        return 0.1 + 0.08 * np.arange(6) / 6.0 + 1e-3 * self.rounds, np.empty(0)


@pytest.mark.parametrize("count", [8, 12, 16])
def test_judges_look_into_wide_intervals_before_they_look_for_events(count: int) -> None:
    """A bump that no kept position has met; the largest pressure of a helical pair was 14 % off and said to be 9 %."""
    bump = Bump()
    found = sampled(bump.add, bump.events, count, 1.0, np.empty(0), np.array([1]))
    actual = 1.2 - found.curve.values.max()
    assert actual > 0.1
    assert actual <= 1.5 * found.largest_error()[0]


def test_a_kink_that_tells_itself_is_met_exactly() -> None:
    curve = Curve(tells=True)
    found = sampled(curve.add, curve.events, 24, 1.0, np.empty(0), np.array([2, 2]))
    assert np.ptp(found.curve.values[:, 0]) == pytest.approx(0.75, abs=1e-3)
    assert found.curve.values[:, 0].max() == pytest.approx(1.0, abs=1e-9)


def test_events_are_where_a_pair_gets_or_loses_its_load() -> None:
    problem, cycle = loaded_cycle(spur(), LOAD, np.arange(12) / 12)
    for _ in range(6):
        guesses, _ = contact_events(cycle, 1.0)
        if not len(guesses):
            break
        cycle = with_more(problem, cycle, np.setdiff1d(guesses, cycle.position))
    events = np.unique(contact_events(cycle, 1.0)[1].round(9))
    assert len(events) == 2  # contact with corners is longer than 1 and shorter than 2 base pitches
    carrying = mesh_cycle(problem, LOAD, np.sort(np.concatenate([events - 1e-4, events + 1e-4])))
    count = sum((share > 0.0).astype(int) for share in carrying.share_by_pair().values())
    assert set(count[:2].tolist()) == set(count[2:].tolist()) == {1, 2}
    # Corners touch before the line of action begins and after it ends.
    assert np.abs(known_events(spur())[:, None] - events).min() > 1e-3


def test_added_positions_are_those_of_one_solution() -> None:
    problem, whole = loaded_cycle(spur(), LOAD, np.arange(24) / 24)
    half = mesh_cycle(problem, LOAD, np.arange(12) / 12)
    both = with_more(problem, half, np.arange(12) / 12 + 1 / 24)
    assert both.position == pytest.approx(whole.position, abs=1e-12)
    assert both.deflection == pytest.approx(whole.deflection, rel=1e-9)
    assert both.contact_ratio == pytest.approx(whole.contact_ratio, abs=1e-9)
    odd = both.chosen(np.arange(1, 24, 2))
    for k, share in odd.share_by_pair().items():
        assert share == pytest.approx(whole.share_by_pair()[k][1::2], abs=1e-9)


def test_the_mean_of_a_step_is_not_swung_by_the_positions_beside_it() -> None:
    """Two positions enclose a step of a half, and the next ones are far away: cubics through all four would swing beyond it."""
    u = np.array([0.0, 0.2, 0.498, 0.502, 0.8, 0.9])
    stepped = np.where(u < 0.5, 1.0, 1.5)[:, None]
    curve = CycleCurve(u, stepped, 1.0, np.zeros(len(u), bool))
    mean = 0.5 * 1.0 + 0.4 * 1.5 + 0.1 * 1.25  # from the last position to the first it falls back
    assert curve.mean_of_steps()[0] == pytest.approx(mean, abs=1e-3)
    assert abs(curve.mean()[0] - mean) > 5e-3
    # Where nothing steps it is the integral of the cubics.
    smooth = CycleCurve(u, np.exp(u)[:, None], 1.0, np.array([True, *(5 * [False])]))
    assert smooth.mean_of_steps()[0] == pytest.approx(smooth.mean()[0], rel=1e-2)


class Smooth:
    """A sine and its second harmonic."""

    def add(self, positions: np.ndarray) -> np.ndarray:
        return (np.sin(2.0 * np.pi * positions) + 0.3 * np.cos(4.0 * np.pi * positions + 0.4))[:, None]

    def events(self) -> tuple[np.ndarray, np.ndarray]:
        return np.empty(0), np.empty(0)


@pytest.mark.parametrize("count", [8, 16, 24])
def test_errors_of_a_smooth_curve_are_told_no_larger_than_some_times_what_they_are(count: int) -> None:
    found = sampled(Smooth().add, Smooth().events, count, 1.0, np.empty(0), np.array([2]))
    actual = np.abs(np.abs(found.curve.harmonics(2)[:, 0]) - [1.0, 0.3]).max()
    assert actual < found.harmonics_error(2).max() < 5.0 * actual


def openings(u: np.ndarray, opening: np.ndarray) -> Any:
    """A cycle of one pair, which has slices where its opening is finite."""
    there = np.flatnonzero(np.isfinite(opening))
    slices = SimpleNamespace(pair=np.zeros(len(there), int), position=there)
    return SimpleNamespace(position=u, slices=slices, opening=opening[there])


@pytest.mark.parametrize("comes", [True, False])
@pytest.mark.parametrize("first", [0, 3])
def test_where_an_opening_is_straight_its_zero_is_met_at_once(comes: bool, first: int) -> None:
    """Of a pair that comes and of one that goes, whether it has slices before the bracket or none."""
    u = np.arange(10) / 10.0
    place = 0.337 if comes else 0.537
    opening = 1e-6 * (place - u if comes else u - place)
    # The rest is in contact or too far away to have slices.
    far = u < 0.1 * first - 0.05 if comes else u > 0.95 - 0.1 * first
    opening[far] = np.inf
    guesses, nearest = contact_events(openings(u, opening), 1.0)
    assert np.abs(guesses - place).min() < 1e-12
    assert nearest[np.abs(guesses - place).argmin()] == pytest.approx(0.3 if comes else 0.5)


def test_a_guess_keeps_away_from_positions_that_are_solved() -> None:
    u = np.arange(10) / 10.0
    opening = np.where(u < 0.35, np.inf, -1e-6)
    opening[3:5] = 1e-6, -1e-26  # as good as zero at a position
    guesses, _ = contact_events(openings(u, opening), 1.0)
    assert np.abs(guesses[:, None] - np.append(u, 1.0)).min() > 5e-5


def test_numbers_of_positions_are_those_they_were_solved_at_but_for_rounding() -> None:
    cycles = HelixCycles((spur(),), LOAD)
    u = np.array([0.0, 0.2, 0.50001, 0.50002, 0.9])
    cycles.cycles.append(SimpleNamespace(position=u))  # type: ignore[arg-type]
    for rounding in (-1e-15, 0.0, 1e-15):
        assert list(cycles.numbers(u + rounding)) == [0, 1, 2, 3, 4]


def test_the_mean_of_steps_of_a_smooth_curve_is_that_of_its_cubics() -> None:
    """Slopes that never exceed three chords are not bounded: extremes stand at positions, others are uneven."""
    u = np.array([0.0, 0.08, 0.13, 0.3, 0.34, 0.5, 0.61, 0.65, 0.8, 0.95])
    curve = CycleCurve(u, np.cos(2.0 * np.pi * u)[:, None], 1.0, np.isin(u, [0.0, 0.5]))
    assert curve.mean_of_steps()[0] == pytest.approx(curve.mean()[0], abs=1e-12)
