"""One-to-one assignment of measured to computed positive numbers, and the share of a band that lies near them.

A pair (r, f) is admissible where |f / r - 1| <= t. The assignment has as many admissible pairs as possible and, among
those, the least sum of |ln(f / r)|: a linear sum assignment whose inadmissible pairs cost more than all admissible ones
together (D. F. Crouse, On implementing 2D rectangular assignment algorithms, IEEE Trans. Aerosp. Electron. Syst. 52
(2016) 1679-1696).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rotorgear.solvers.eigen.one_to_one import least_cost

# 105 on 100 is within 5 %, although 105 / 100 - 1 rounds to more than 0.05.
ROUNDING = 1e-12


def relative_errors(measured: ArrayLike, computed: ArrayLike) -> NDArray[np.float64]:
    """Return f / r - 1, shape (r measured, f computed)."""
    rows = np.asarray(measured, dtype=float)
    columns = np.asarray(computed, dtype=float)
    return columns[None, :] / rows[:, None] - 1.0


def assign(measured: ArrayLike, computed: ArrayLike, tolerance: float) -> list[tuple[int, int]]:
    """Return the admissible pairs (index of measured, index of computed), ascending in frequency.

    Args:
        measured: positive numbers in any order, shape (r,).
        computed: positive numbers in any order, shape (f,).
        tolerance: t, between 0 and 1.
    """
    errors = relative_errors(measured, computed)
    if errors.size == 0:
        return []
    admissible = np.abs(errors) <= tolerance + ROUNDING
    # One inadmissible pair costs more than all admissible ones together: so their number is as large as possible.
    outside = 1.0 + min(errors.shape) * miss_cost(tolerance + ROUNDING)
    rows, columns = least_cost(np.where(admissible, np.abs(np.log1p(errors)), outside))
    kept = admissible[rows, columns]
    rows = rows[kept]
    columns = columns[kept]

    # Uncross the pairs: of all pairings of the same numbers the ascending one is never worse, and it is unique.
    rows = rows[np.argsort(np.asarray(measured)[rows], kind="stable")]
    columns = columns[np.lexsort((columns, np.asarray(computed)[columns]))]
    return [(int(row), int(column)) for row, column in zip(rows, columns, strict=True)]


def miss_cost(tolerance: float) -> float:
    """Return the largest |ln(f / r)| of an admissible pair, -ln(1 - t)."""
    return float(-np.log1p(-tolerance))


def covered_share(computed: ArrayLike, tolerance: float, low: float, high: float) -> float:
    """Return the share of [ln low, ln high] in which some computed f is admissible: f / (1 + t) <= r <= f / (1 - t).

    Exact union of the intervals, sorted and merged.
    """
    values = np.sort(np.asarray(computed, dtype=float))
    starts = np.log(np.clip(values / (1.0 + tolerance), low, high) / low)
    ends = np.log(np.clip(values / (1.0 - tolerance), low, high) / low)
    covered = 0.0
    reached = 0.0
    for start, end in zip(starts, ends, strict=True):
        covered += max(0.0, end - max(start, reached))
        reached = max(reached, end)
    return float(covered / np.log(high / low))
