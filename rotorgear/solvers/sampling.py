"""Points of the unit cube, the same for the same seed, and first-order and total Sobol indices from values at such points.

A and B are two independent samples (n, p), A_j is A with column j of B. With f about its mean and V its variance

    S_j = mean[f(B) (f(A_j) - f(A))] / V,    T_j = mean[(f(A) - f(A_j))^2] / 2 V

(Saltelli et al. 2010, Variance based sensitivity analysis of model output, Computer Physics Communications 181, table 2; the
second is Jansen's of 1999). Errors are standard deviations over bootstrap samples of the n rows.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

_BOOTSTRAPS = 100
SAMPLINGS = ("sobol", "latin", "random")


def unit_points(sampling: str, count: int, dimensions: int, seed: int) -> NDArray[np.float64]:
    """Return points (count, dimensions): scrambled Sobol, a Latin hypercube, or plain random ones."""
    from scipy.stats import qmc

    if sampling == "random":
        return np.random.default_rng(seed).random((count, dimensions))
    if sampling == "latin":
        return np.asarray(qmc.LatinHypercube(dimensions, seed=seed).random(count))
    with warnings.catch_warnings():
        # A number that is no power of two loses balance, not validity.
        warnings.simplefilter("ignore", UserWarning)
        return np.asarray(qmc.Sobol(dimensions, scramble=True, seed=seed).random(count))


@dataclass(frozen=True)
class SobolIndices:
    """Indices of p numbers for m quantities, each (m, p), with standard errors."""

    first: NDArray[np.float64]
    total: NDArray[np.float64]
    first_error: NDArray[np.float64]
    total_error: NDArray[np.float64]


def design(u: NDArray[np.float64]) -> NDArray[np.float64]:
    """Points A, B, A_1 ... A_p, ((p + 2) n, p), from points u (n, 2 p) of the unit cube."""
    p = u.shape[1] // 2
    A = u[:, :p]
    B = u[:, p:]
    return np.vstack([A, B, *(np.where(np.arange(p) == j, B, A) for j in range(p))])


def sobol_indices(values: NDArray[np.float64], numbers: int, seed: int = 0) -> SobolIndices:
    """Return the indices from values ((p + 2) n, m) at the points of a design of p `numbers`."""
    parts = values.reshape(numbers + 2, -1, values.shape[1])
    # About the mean of A and B: the estimator of S_j loses digits by a large common part.
    parts = parts - parts[:2].mean(axis=(0, 1))
    first, total = _indices(parts)
    n = parts.shape[1]
    random = np.random.default_rng(seed)
    again = [_indices(parts[:, random.integers(0, n, n)]) for _ in range(_BOOTSTRAPS)]
    errors = [np.std(np.array(seen), axis=0, ddof=1) for seen in zip(*again, strict=True)]
    return SobolIndices(first, total, errors[0], errors[1])


def _indices(parts: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    a = parts[0]
    b = parts[1]
    variance = np.maximum(np.var(parts[:2].reshape(-1, parts.shape[2]), axis=0), 1e-300)
    first = np.array([np.mean(b * (mixed - a), axis=0) / variance for mixed in parts[2:]])
    total = np.array([np.mean((a - mixed) ** 2, axis=0) / (2.0 * variance) for mixed in parts[2:]])
    return first.T, total.T
