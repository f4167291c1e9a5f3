"""The quantities of expected.csv that a forced response at one speed gives: a number for each order, at the first named point."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

import numpy as np

from rotorgear.results.steady.response import ResponseResult


def _displacement(result: ResponseResult) -> np.ndarray:
    """Complex displacement of the first point, (o,)."""
    w = 2.0 * np.pi * result.frequency_hz[:, 0]
    return np.asarray(-result.acceleration[:, 0, 0] / w**2)


FORCED: Mapping[str, Callable[[ResponseResult], np.ndarray]] = MappingProxyType(
    {
        "forced_amplitude_m": lambda result: np.abs(_displacement(result)),
        "forced_lag_rad": lambda result: -np.angle(_displacement(result)),
    }
)
