"""Pairs of least cost are those of a full solver, and come without it where nothing competes."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from rotorgear.solvers.eigen.one_to_one import least_cost


def best_of_all(cost: np.ndarray) -> float:
    """The least cost over all pairings, one by one."""
    wide = cost if cost.shape[0] <= cost.shape[1] else cost.T
    rows = np.arange(len(wide))
    return min(
        float(wide[rows, list(columns)].sum()) for columns in itertools.permutations(range(wide.shape[1]), len(wide))
    )


@pytest.mark.parametrize("shape", [(4, 4), (3, 5), (5, 3), (1, 4)])
@pytest.mark.parametrize("nearly", [True, False], ids=["one for each", "they compete"])
def test_pairs_cost_the_least_of_all_pairings(shape: tuple[int, int], nearly: bool) -> None:
    random = np.random.default_rng(7)
    for _ in range(20):
        cost = random.uniform(size=shape)
        if nearly:
            for row, column in enumerate(random.permutation(max(shape))[: min(shape)]):
                cost[(row, column) if shape[0] <= shape[1] else (column, row)] *= 1e-3
        rows, columns = least_cost(cost)
        assert len(rows) == min(shape)
        assert list(rows) == sorted(set(rows.tolist()))
        assert len(set(columns.tolist())) == len(columns)
        assert cost[rows, columns].sum() == pytest.approx(best_of_all(cost), rel=1e-12)


def test_equal_costs_and_none_at_all_are_left_to_the_solver() -> None:
    _, columns = least_cost(np.array([[1.0, 1.0], [1.0, 1.0]]))
    assert sorted(columns.tolist()) == [0, 1]
    assert [len(part) for part in least_cost(np.zeros((0, 3)))] == [0, 0]


def test_numbers_that_are_none_are_refused() -> None:
    with pytest.raises(ValueError, match="invalid numeric"):
        least_cost(np.array([[np.nan, 1.0], [1.0, 2.0]]))
