"""Low-discrepancy points of the unit cube, seeded: the same for the same seed wherever they are used."""

from __future__ import annotations

import warnings

import numpy as np
from numpy.typing import NDArray

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
