"""How far measured and computed modes are alike, and which mode of a model a measured line is.

The modal assurance criterion says how far two shapes agree, whatever their scale (Allemang and Brown 1982),

    MAC(a, b) = |a^H b|^2 / ((a^H a) (b^H b)),

1 for shapes in proportion, 0 for orthogonal ones. Points that one of the two does not know take no part.

Before a test the model predicts ln f with the variance sigma_f^2 + sum_j (J_ij sigma_pj)^2, noise and the spread of its uncertain
numbers. A pair costs the squared distance in units of that, and (1 - MAC) / 0.1 squared for its shapes: a mode whose shape agrees
to 0.9 weighs as much as one that is one standard deviation off. The assignment of all lines together costs least.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rotorgear.solvers.eigen.assignment import assign


def mac(a: ArrayLike, b: ArrayLike) -> NDArray[np.float64]:
    """Return the MAC of each shape of one set with each of another.

    Args:
        a: real or complex displacements at s points (n, s); NaN where unknown.
        b: the same points (m, s).

    Returns:
        MAC (n, m), NaN where two shapes share no point.
    """
    first = np.asarray(a)
    second = np.asarray(b)
    known_a = np.isfinite(first)
    known_b = np.isfinite(second)
    A = np.where(known_a, first, 0.0)
    B = np.where(known_b, second, 0.0)
    cross = np.abs(A.conj() @ B.T) ** 2
    size = (np.abs(A) ** 2 @ known_b.T) * (known_a @ (np.abs(B) ** 2).T)
    return np.where(size > 0.0, cross / np.where(size > 0.0, size, 1.0), np.nan)


def frac(a: NDArray[np.complex128] | NDArray[np.float64], b: NDArray[np.complex128] | NDArray[np.float64]) -> float:
    """|a^H b|^2 / (a^H a b^H b); NaN where one is zero."""
    size = float(np.sum(np.abs(a) ** 2) * np.sum(np.abs(b) ** 2))
    return float(np.abs(np.vdot(a, b)) ** 2) / size if size > 0.0 else float("nan")


_MAC_SCALE = 0.1
# Further away in frequency, or less alike in shape, nothing is paired.
_FARTHEST = 4.0
_LEAST_MAC = 0.3
# No pair that is allowed costs more.
_UNPAIRED = _FARTHEST**2 + _MAC_SCALE**-2


def pairs_of(
    measured_hz: NDArray[np.float64],
    mode_hz: NDArray[np.float64],
    spread: NDArray[np.float64],
    measured_shapes: NDArray[Any],
    mode_shapes: NDArray[Any],
    tolerance: float,
) -> list[tuple[int, int]]:
    """Return (line, mode), ascending in lines.

    Args:
        measured_hz: frequencies of the lines (n,).
        mode_hz: frequencies of the modes (m,).
        spread: standard deviation of ln f of the modes, model and noise together (m,).
        measured_shapes: at s points (n, s), NaN where unknown; s may be 0.
        mode_shapes: the same points (m, s).
        tolerance: largest |f_mode / f_line - 1| where there are no shapes.
    """
    if measured_shapes.size == 0 or not np.isfinite(measured_shapes).any():
        return sorted(assign(measured_hz, mode_hz, tolerance))
    return pairs_by_both(measured_hz, mode_hz, spread, mac(measured_shapes, mode_shapes))[0]


def pairs_by_both(
    measured_hz: NDArray[np.float64],
    mode_hz: NDArray[np.float64],
    spread: NDArray[np.float64],
    alike: NDArray[np.float64],
) -> tuple[list[tuple[int, int]], float]:
    """Return (line, mode), ascending in lines, of least cost, and what they cost with lines that are not paired.

    `alike` is their MAC (n, m), NaN where unknown.
    """
    from scipy.optimize import linear_sum_assignment

    distance = np.abs(np.log(mode_hz[None, :] / measured_hz[:, None])) / spread[None, :]
    cost = distance**2 + (np.nan_to_num(1.0 - alike, nan=0.0) / _MAC_SCALE) ** 2
    allowed = (distance <= _FARTHEST) & ~(alike < _LEAST_MAC)
    # One pair that is not allowed costs more than all allowed ones together.
    outside = 1.0 + min(cost.shape) * _UNPAIRED
    rows, columns = linear_sum_assignment(np.where(allowed, cost, outside))
    pairs = [(int(i), int(k)) for i, k in zip(rows, columns, strict=True) if allowed[i, k]]
    return pairs, float(sum(cost[i, k] for i, k in pairs)) + _UNPAIRED * (len(measured_hz) - len(pairs))
