"""Pairs of least cost in all, without a solver where each row's cheapest column is another one."""

from __future__ import annotations

import numpy as np


def least_cost(cost: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Rows and columns (k,) of the pairs of least cost in all, each row and column in one pair at most; k = min(r, c).

    No pairing costs less than the least entries of all rows together. Where these are unique and stand in different columns, they
    are the only answer; otherwise it is that of scipy's solver, which takes half a second to load.

    Args:
        cost: of each pair, (r, c).
    """
    if cost.shape[0] <= cost.shape[1]:
        columns = _cheapest(cost)
        if columns is not None:
            return np.arange(len(columns)), columns
    else:
        rows = _cheapest(cost.T)
        if rows is not None:
            order = np.argsort(rows)
            return rows[order], order
    from scipy.optimize import linear_sum_assignment

    rows, columns = linear_sum_assignment(cost)
    return rows, columns


def _cheapest(cost: np.ndarray) -> np.ndarray | None:
    """The cheapest column of each row; None where one has two, or two have the same."""
    if not cost.size:
        return None
    columns = np.argmin(cost, axis=1)
    least = cost[np.arange(len(cost)), columns]
    alone = np.all(np.count_nonzero(cost == least[:, None], axis=1) == 1)
    return columns if alone and len(set(columns.tolist())) == len(columns) else None
