"""The modal assurance criterion: how far two shapes agree, whatever their scale (Allemang and Brown 1982).

    MAC(a, b) = |a^H b|^2 / ((a^H a) (b^H b)),

1 for shapes in proportion, 0 for orthogonal ones. Points that one of the two does not know take no part.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray


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
