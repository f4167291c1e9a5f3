"""Largest eigenvalues of the Hermitian -i B of a real skew B, mostly in real arithmetic.

B^T B = -B^2 is real, at less than half the cost, and holds the square of each pair +-theta of -i B twice. Its highest vectors
span the states of both; within them -i B itself is solved, so that neither squares nor eigenvalues that meet cost accuracy.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg as la
from numpy.typing import NDArray

from rotorgear.solvers.sparse.entries import times

# Pairs beyond those that are wanted, among which the farthest gap is sought.
_BEYOND = 4
# Least gap between squares, of the largest, that parts a span from the rest: rounding turns vectors by eps over it.
_GAP = 1e-9


def largest_pairs(B: NDArray[np.float64], count: int) -> tuple[NDArray[np.float64], NDArray[np.complex128]]:
    """The largest `count` eigenvalues theta (count,) of -i B, descending, and orthonormal vectors (2 m, count).

    Args:
        B: (2 m, 2 m), real and skew.
        count: up to m.
    """
    size = len(B)
    span = _span(B, count)
    if span is None:
        top = (size - count, size - 1)
        theta, Y = la.eigh(-1j * B, subset_by_index=top, overwrite_a=True, check_finite=False)
        return np.asarray(theta[::-1]), np.asarray(Y[:, ::-1])
    theta, c = la.eigh(-1j * (span.T @ B @ span), driver="evd", check_finite=False)
    largest = slice(None, -count - 1, -1)  # they come in pairs +-theta
    return np.asarray(theta[largest]), np.asarray(times(span, c[:, largest]))


def _span(B: NDArray[np.float64], count: int) -> NDArray[np.float64] | None:
    """Real orthonormal vectors (2 m, k) that span the states of the `count` largest pairs; None where no gap parts them."""
    m = len(B) // 2
    if count >= m:
        return None
    squares, X = la.eigh(B.T @ B, driver="evd", check_finite=False)
    # The span ends where the next pair is farthest off: part of an eigenspace of squares is none of B.
    pairs = np.append(squares[::-2], 0.0)
    ends = np.arange(count, min(count + _BEYOND, m) + 1)
    gaps = pairs[ends - 1] - pairs[ends]
    end = int(ends[np.argmax(gaps)])
    if gaps.max() < _GAP * pairs[0]:
        return None
    return np.asarray(X[:, 2 * (m - end) :])
