"""Parts of the comparison with a rig against enumerations, ellipses, planes and an analytic function that is smoothed."""

from __future__ import annotations

import itertools
import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rotorgear.analysis.rig import compare_shapes, frf_misfit
from rotorgear.analysis.rig.compare import compare_lines
from rotorgear.analysis.rig.compare_shapes import _comac, phase_collinearity
from rotorgear.analysis.rig.frf_misfit import FrfMisfit
from rotorgear.analysis.rig.likeness import frac, mac, pairs_by_both
from rotorgear.analysis.rig.measured import MeasuredFrf, _sensor
from rotorgear.analysis.rig.posterior import Posterior, line_noise, spring_shares
from rotorgear.analysis.rig.sensors import best_rows, independence
from rotorgear.results.comparison import RigLine


def cost_of(pairs: dict[int, int], distance: np.ndarray, alike: np.ndarray) -> float:
    """(ln f / sigma)^2 + ((1 - MAC)/0.1)^2 of pairs; 4^2 + 10^2 of each line without one."""
    unknown = np.where(np.isnan(alike), 1.0, alike)
    total = (len(distance) - len(pairs)) * (4.0**2 + 10.0**2)
    return total + sum(distance[i, k] ** 2 + (10.0 * (1.0 - unknown[i, k])) ** 2 for i, k in pairs.items())


@pytest.mark.parametrize("seed", range(6))
def test_lines_and_shapes_are_assigned_as_the_best_of_all_assignments(seed: int) -> None:
    rng = np.random.default_rng(seed)
    rig, modes = np.sort(rng.uniform(80, 200, 3)), np.sort(rng.uniform(80, 200, 4))
    spread = rng.uniform(0.03, 0.09, 4)
    alike = rng.uniform(0.1, 1.0, (3, 4))
    alike[0, 1] = np.nan
    found, cost = pairs_by_both(rig, modes, spread, alike)
    distance = np.abs(np.log(modes / rig[:, None])) / spread
    allowed = (distance <= 4.0) & ~(alike < 0.3)
    every = []
    for chosen in itertools.permutations([0, 1, 2, 3, None, None, None], 3):
        pairs = {i: k for i, k in enumerate(chosen) if k is not None}
        if all(allowed[i, k] for i, k in pairs.items()):
            every.append((cost_of(pairs, distance, alike), pairs))
    least, best = min(every, key=lambda item: item[0])
    assert dict(found) == best
    assert cost == pytest.approx(least, rel=1e-12)


def test_likeness_of_responses_is_the_squared_cosine() -> None:
    a, b = np.array([1.0, 2.0j, -1.0]), np.array([2.0, 1.0j, 3.0])
    cross = abs(np.vdot(a, b)) ** 2
    assert frac(a, b) == pytest.approx(cross / (6.0 * 14.0), rel=1e-14)
    assert mac(a[None], b[None])[0, 0] == pytest.approx(cross / (6.0 * 14.0), rel=1e-14)
    # A point that one does not know counts on neither side.
    assert mac(np.append(a, 5.0)[None], np.append(b, np.nan)[None])[0, 0] == pytest.approx(cross / 84.0, rel=1e-14)
    assert math.isnan(frac(a, 0.0 * b))


@pytest.mark.parametrize(("place", "expected"), [(0.97, "low"), (1.03, "high"), (0.94, ""), (1.06, "")])
def test_modes_just_beyond_the_band_are_met_by_random_lines_inside(place: float, expected: str) -> None:
    """One mode beside the band of 100 to 200 Hz; a random line meets it where |f_mode/f - 1| <= 5 %."""
    mode = 100.0 * place if place < 1.0 else 200.0 * place
    low, high = max(100.0, mode / 1.05), min(200.0, mode / 0.95)
    share = max(0.0, math.log(high / low)) / math.log(2.0)
    found = compare_lines([mode], ["a mode"], [RigLine(150.0)], band=(100.0, 200.0), samples=4000).chance
    assert found.expected_random_matches == pytest.approx(share, abs=4.0 * math.sqrt((share + 1e-12) / 4000))
    assert (found.expected_random_matches > 0.0) == bool(expected)
    assert found.coverage == pytest.approx(share, abs=1e-12)
    assert found.modes_in_band == 0


@pytest.mark.parametrize("turn", [0.0, 0.4, 2.0])
@pytest.mark.parametrize("ratio", [0.0, 0.3, 1.0])
def test_phase_collinearity_of_an_ellipse_follows_from_its_axes(ratio: float, turn: float) -> None:
    """((1 - r^2)/(1 + r^2))^2, however the shape is turned and scaled."""
    shape = 3.0 * np.exp(1j * turn) * np.array([1.0, 1j * ratio])
    assert phase_collinearity(shape) == pytest.approx(((1.0 - ratio**2) / (1.0 + ratio**2)) ** 2, abs=1e-12)


def test_coordinates_that_disagree_are_found_by_the_sums_over_their_modes() -> None:
    """|sum y phi|^2 over the product of both sums of squares, each shape with the part of its mode that fits it."""
    rng = np.random.default_rng(1)
    shapes = rng.normal(size=(3, 5)) + 1j * rng.normal(size=(3, 5))
    modes = rng.normal(size=(3, 5))
    shapes[1, 2] = np.nan
    cross, rig, own = np.zeros(5), np.zeros(5), np.zeros(5)
    for y, phi in zip(shapes, modes, strict=True):
        known = np.isfinite(y)
        y = np.where(known, y, 0.0) / np.sqrt(np.mean(np.abs(y[known]) ** 2))
        phi = np.where(known, phi, 0.0)
        fit = phi * (phi @ y) / (phi @ phi)
        cross += np.real(np.conj(y) * fit)
        rig += np.abs(y) ** 2
        own += np.abs(fit) ** 2
    found = _comac(list(shapes), [mode[None].astype(complex) for mode in modes], 5)
    assert found == pytest.approx(cross**2 / (rig * own), rel=1e-12)
    assert np.isnan(_comac([shapes[1]], [modes[1][None].astype(complex)], 5)[2])


def test_the_spread_of_what_depends_on_the_numbers_is_that_of_their_covariance() -> None:
    rng = np.random.default_rng(8)
    posterior = Posterior(rng.uniform(0.0, 0.3, (3, 6)), rng.uniform(0.002, 0.01, 3), rng.uniform(0.1, 0.4, 6))
    slopes = rng.normal(size=(4, 6))
    N = np.diag(posterior.noise**-2.0)
    covariance = np.linalg.inv(posterior.jacobian.T @ N @ posterior.jacobian + np.diag(posterior.prior**-2.0))
    expected = np.sqrt(np.diag(slopes @ covariance @ slopes.T))
    assert posterior.spread_of(slopes) == pytest.approx(expected, rel=1e-9)
    assert line_noise(RigLine(250.0, uncertainty_hz=3.0)) == pytest.approx(3.0 / 250.0)
    assert line_noise(RigLine(250.0)) == 0.005
    springs, shares = spring_shares(
        {"bearings.a": [0.1, 0.2, 0.3], "shafts.b": [0.5, 0.5, 0.5], "meshes.c": [0.4, 0.3, 0.2]}, np.array([2, 0])
    )
    assert springs == ["bearings.a", "meshes.c"]
    assert shares == pytest.approx(np.array([[0.3, 0.1], [0.2, 0.4]]))


def test_rows_of_a_plan_are_those_of_projections_whatever_the_scale_of_a_mode() -> None:
    rng = np.random.default_rng(3)
    shapes = rng.normal(size=(9, 3)) * np.array([1.0, 1e-4, 50.0])
    projection = shapes @ np.linalg.solve(shapes.T @ shapes, shapes.T)
    assert independence(shapes) == pytest.approx(np.diag(projection), rel=1e-6)
    # A mode that is the sum of two others adds nothing to the rank.
    assert independence(np.column_stack([shapes, shapes[:, 0] + shapes[:, 2]])).sum() == pytest.approx(3.0)
    scaled = shapes * np.array([7.0, 1e3, 0.2])
    assert np.array_equal(best_rows(shapes, 5), best_rows(scaled, 5))
    # Down to as many rows as modes, one goes after the other: that with the least share.
    kept = np.arange(9)
    while len(kept) > 4:
        part = shapes[kept]
        kept = np.delete(kept, np.argmin(np.diag(part @ np.linalg.solve(part.T @ part, part.T))))
    assert np.array_equal(best_rows(shapes, 4), kept)


class Beside(FrfMisfit):
    """A misfit without a model: its responses are given."""

    def __init__(self, hz: np.ndarray, measured: np.ndarray, own: np.ndarray, noise: float) -> None:
        self.frequency_hz = hz
        self.measured = measured
        self._noise = noise
        self._own = own
        self._names = tuple(f"pair {k}" for k in range(len(measured)))

    def computed(self, x: Any, modes: Any) -> np.ndarray:
        return self._own


NOTHING: Any = None


@pytest.mark.parametrize("even", [True, False])
def test_a_smoothed_response_is_that_of_a_more_damped_resonance(even: bool) -> None:
    """The mean of an analytic function with weights w/((f - f_0)^2 + w^2) is its value at f_0 - i w (Poisson)."""
    hz = np.linspace(20.0, 380.0, 3601) if even else np.geomspace(20.0, 380.0, 3601)
    pole = 120.0 + 1.5j
    loose = 0.3
    S = Beside(hz, np.ones((1, 1)), np.ones((1, 1)), 0.01)._smoothing(loose)
    assert S.sum(axis=1) == pytest.approx(np.ones(len(hz)), rel=1e-12)
    smooth = S @ (1.0 / (hz - pole))
    for place in (100.0, 120.0, 130.0):
        k = int(np.argmin(np.abs(hz - place)))
        width = 0.2 * loose * hz[k]
        # Of the tails of the weights beyond the band there are some percent.
        assert smooth[k] == pytest.approx(1.0 / (hz[k] - 1j * width - pole), rel=0.05)


@pytest.mark.parametrize("loose", [0.0, 0.4])
def test_the_noise_of_a_response_grows_where_it_is_small_and_where_trust_is_enlarged(loose: float) -> None:
    hz = np.linspace(50.0, 90.0, 41)
    rng = np.random.default_rng(2)
    rig = np.exp(rng.normal(size=(2, 41)) * 2.0) * np.exp(1j * rng.uniform(0.0, 0.3, (2, 41)))
    own = 1.3 * rig * np.exp(0.2j)
    misfit = Beside(hz, rig, own, 0.07)
    residual, sigma = misfit.residual(NOTHING, NOTHING, loose)
    assert residual[:, :41] == pytest.approx(np.full((2, 41), -math.log(1.3)), rel=1e-9)
    assert residual[:, 41:] == pytest.approx(np.full((2, 41), -0.2), rel=1e-9)
    smooth = rig @ misfit._smoothing(loose).T
    floor = 0.01 * np.sqrt(np.mean(np.abs(rig) ** 2, axis=1))[:, None]
    expected = 0.07 / math.sqrt(2.0) * np.sqrt(1.0 + (floor / np.abs(smooth)) ** 2)
    if loose:
        neighbours = 41 * 0.2 * loose / math.log(90.0 / 50.0)
        expected = np.sqrt(neighbours) * np.hypot(expected, 0.5 * loose)
    assert sigma == pytest.approx(np.hstack([expected, expected]), rel=1e-12)


@pytest.mark.parametrize(
    ("factor", "words"),
    [
        (1.0, ""),
        (19.0, ""),
        (1 / 19.0, ""),
        (21.0, "times as large"),
        (1 / 21.0, "times as large"),
        (-1.0, "other sign"),
    ],
)
def test_responses_of_another_size_or_sign_are_doubted(factor: float, words: str) -> None:
    hz = np.linspace(50.0, 90.0, 41)
    own = 1.0 / (70.0**2 - hz**2 + 8j * hz)[None]
    notes = [str(note) for note in Beside(hz, factor * own, own, 0.05).doubts(NOTHING, NOTHING)]
    assert len(notes) == bool(words)
    assert all(words in note for note in notes)


def test_of_many_frequencies_evenly_chosen_ones_count_and_that_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(frf_misfit, "MOST_FREQUENCIES", 5)
    monkeypatch.setattr(frf_misfit, "ReceptanceModel", lambda *given: None)
    hz = np.linspace(10.0, 90.0, 9)
    for count, kept in ((9, hz[::2]), (5, hz[:5])):
        given = MeasuredFrf(hz[:count], ("a", "b"), ("b", "b"), np.arange(2 * count).reshape(2, -1) + 1j, ())
        found = FrfMisfit(NOTHING, given, 0.1, 0.0)
        assert found.frequency_hz == pytest.approx(kept)
        assert len(found.notes) == (count > 5)
        if count > 5:
            assert np.array_equal(found.measured, given.receptance[:, ::2])
            assert "5 of 9 frequencies" in str(found.notes[0])


def test_one_number_by_several_lines_weighs_them_by_their_variances() -> None:
    posterior = Posterior(np.full((4, 1), 0.5), np.array([0.01, 0.02, 0.04, 0.08]), np.array([0.3]))
    weights = (0.5 / posterior.noise) ** 2
    sigma = 1.0 / math.sqrt(weights.sum() + 0.3**-2)
    assert posterior.sigma[0] == pytest.approx(sigma, rel=1e-12)
    residual = 0.5 * 0.1 * np.ones(4)
    assert posterior.estimate(residual)[0] == pytest.approx(0.1 * weights.sum() * sigma**2, rel=1e-12)


def test_random_lists_fill_the_band_of_the_lines_and_their_shapes_are_mixed_from_unit_ones(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    drawn: list[np.ndarray] = []
    mixed: list[np.ndarray] = []

    def pairs(hz: np.ndarray, *rest: Any) -> tuple[list[tuple[int, int]], float]:
        drawn.append(hz)
        return [(0, 1)] if hz[0] > 150.0 else [], float(hz[0])

    def likeness(shapes: np.ndarray) -> np.ndarray:
        mixed.append(shapes)
        return np.full((2, 3), 0.95)

    monkeypatch.setattr(compare_shapes, "pairs_by_both", pairs)
    rng = np.random.default_rng(1)
    points = (rng.normal(size=(3, 4)) + 1j * rng.normal(size=(3, 4))) * np.array([1.0, 100.0, 0.0])[:, None]
    modes: Any = SimpleNamespace(hz=np.array([90.0, 160.0, 300.0]), at_points=points, likeness=likeness)
    rig = np.array([120.0, 210.0])
    found = compare_shapes._chance(modes, rig, np.full((2, 3), 0.9), np.ones(3), 0.05, 400, 7)
    assert np.array_equal(drawn[0], rig)
    lists = np.array(drawn[1:])
    low, high = 120.0 / 1.05, 210.0 * 1.05
    assert low <= lists.min() < 1.01 * low
    assert 0.99 * high < lists.max() <= high
    # Evenly over the logarithm.
    share = np.log(lists / low) / math.log(high / low)
    assert share.mean() == pytest.approx(0.5, abs=0.04)
    # One match where the first line is above 150 Hz and within 5 % of the mode at 160.
    first = lists[:, 0]
    matched = (first > 150.0) & (np.abs(160.0 / first - 1.0) <= 0.05)
    assert found.expected == pytest.approx(matched.mean())
    assert found.probability_as_close == pytest.approx((1 + np.count_nonzero(first <= 120.0)) / 401)
    # Each mode has the same part in random shapes, but one that no sensor sees.
    shapes = np.vstack(mixed)
    assert np.mean(np.abs(shapes) ** 2, axis=0).sum() == pytest.approx(2.0, rel=0.15)


@pytest.mark.parametrize(("direction", "sign", "expected"), [(2, 1, 1.0), (-2, 1, -1.0), (2, -1, -1.0), (-2, -1, 1.0)])
def test_signs_of_a_freedom_and_of_its_sensor_multiply(direction: int, sign: int, expected: float) -> None:
    sensor: Any = SimpleNamespace(sign=sign)
    assert _sensor((5, direction), {(5, 1): sensor}) == (sensor, expected)
    assert _sensor((6, direction), {(5, 1): sensor}) == (None, math.copysign(1.0, direction))
