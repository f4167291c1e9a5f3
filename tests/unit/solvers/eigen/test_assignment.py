"""One-to-one assignment against every possible assignment, and the covered share against closed forms."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from rotorgear.solvers.eigen.assignment import assign, covered_share, miss_cost


def best_by_enumeration(measured: list[float], computed: list[float], tolerance: float) -> tuple[int, float]:
    """Return (number of admissible pairs, least sum of |log|) over all one-to-one assignments."""
    best = (0, 0.0)
    columns: list[int | None] = [*range(len(computed)), *[None] * len(measured)]
    for chosen in set(itertools.permutations(columns, len(measured))):
        pairs = [(r, computed[c]) for r, c in zip(measured, chosen, strict=True) if c is not None]
        kept = [abs(math.log(f / r)) for r, f in pairs if abs(f / r - 1) <= tolerance]
        if len(kept) > best[0] or (len(kept) == best[0] and sum(kept) < best[1]):
            best = (len(kept), sum(kept))
    return best


def test_the_nearest_mode_is_given_up_where_that_lets_two_lines_match():
    # Greedy gives 100 to 101 (1 %) and leaves 102 with 97 (-4.9 %), outside 4 %.
    assert assign([100.0, 102.0], [97.0, 101.0], 0.04) == [(0, 0), (1, 1)]


def test_a_far_pair_does_not_pull_near_pairs_apart():
    # Without the cap, the line at 1000 would drag the whole assignment along.
    assert assign([100.0, 1000.0], [100.1, 101.0], 0.05) == [(0, 0)]


@pytest.mark.parametrize("seed", range(12))
def test_no_other_assignment_matches_more_lines_or_lies_closer(seed):
    random = np.random.default_rng(seed)
    measured = list(100 * np.exp(random.uniform(0, 0.3, 3)))
    computed = list(100 * np.exp(random.uniform(0, 0.3, 4)))
    pairs = assign(measured, computed, 0.05)
    count, distance = best_by_enumeration(measured, computed, 0.05)
    assert len(pairs) == count
    assert math.fsum(abs(math.log(computed[c] / measured[r])) for r, c in pairs) == pytest.approx(distance, abs=1e-12)


def test_pairs_never_cross():
    # Both modes above both lines: crossing costs the same sum of logs, so only the order can decide.
    assert assign([101.0, 100.0], [104.0, 103.0], 0.05) == [(1, 1), (0, 0)]


def test_a_round_five_percent_is_within_five_percent():
    assert 105 / 100 - 1 > 0.05
    assert assign([100.0], [105.0], 0.05) == [(0, 0)]
    assert assign([100.0], [95.0], 0.05) == [(0, 0)]


def test_nothing_matches_an_empty_list():
    assert assign([100.0], [], 0.05) == []


def test_a_single_mode_covers_the_log_width_of_its_interval():
    expected = math.log(1.05 / 0.95) / math.log(10.0)
    assert covered_share([300.0], 0.05, 100.0, 1000.0) == pytest.approx(expected, rel=1e-14)


def test_an_interval_at_the_edge_counts_only_inside_the_band():
    assert covered_share([100.0], 0.05, 100.0, 1000.0) == pytest.approx(miss_cost(0.05) / math.log(10.0), rel=1e-12)
    assert covered_share([1.0, 5000.0], 0.05, 100.0, 1000.0) == 0.0


def test_overlapping_intervals_count_once():
    expected = math.log((303.0 / 0.95) / (300.0 / 1.05)) / math.log(10.0)
    assert covered_share([303.0, 300.0], 0.05, 100.0, 1000.0) == pytest.approx(expected, rel=1e-14)


def test_a_dense_list_covers_the_whole_band_and_a_slightly_sparser_one_does_not():
    touching = 1.05 / 0.95
    dense = 100.0 * (0.999 * touching) ** np.arange(40)
    sparse = 100.0 * (1.001 * touching) ** np.arange(40)
    assert covered_share(dense, 0.05, 100.0, 1000.0) == pytest.approx(1.0, abs=1e-14)
    assert covered_share(sparse, 0.05, 100.0, 1000.0) < 0.995


def test_the_covered_share_is_the_share_of_points_that_have_an_admissible_partner():
    modes = np.random.default_rng(1).uniform(100.0, 1000.0, 9)
    points = np.geomspace(100.0, 1000.0, 200_001)
    near = (np.abs(modes[None, :] / points[:, None] - 1.0) <= 0.03).any(axis=1)
    assert covered_share(modes, 0.03, 100.0, 1000.0) == pytest.approx(near.mean(), abs=1e-4)
