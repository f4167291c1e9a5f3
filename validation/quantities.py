"""The quantities of expected.csv: each a number (or a word) for every elastic mode of a modal result."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

import numpy as np

from rotorgear.results.steady.modal import ModalResult


def _log_decrement(result: ModalResult) -> np.ndarray:
    zeta = result.damping_ratio
    return 2.0 * np.pi * zeta / np.sqrt(1.0 - zeta**2)


QUANTITIES: Mapping[str, Callable[[ModalResult], np.ndarray]] = MappingProxyType(
    {
        "frequency_hz": lambda result: result.frequency_hz,
        "frequency_rad_s": lambda result: 2.0 * np.pi * result.frequency_hz,
        "frequency_cpm": lambda result: 60.0 * result.frequency_hz,
        "natural_frequency_hz": lambda result: result.natural_frequency_hz,
        "natural_frequency_rad_s": lambda result: 2.0 * np.pi * result.natural_frequency_hz,
        "damping_ratio": lambda result: result.damping_ratio,
        "log_decrement": _log_decrement,
        "real_part_1_s": lambda result: result.eigenvalues.real,
        "whirl": lambda result: np.array(result.whirl),
    }
)

_UNITS = {"hz": "Hz", "m": "m", "rad": "rad", "rad_s": "rad/s", "cpm": "cpm", "1_s": "1/s"}


def words(quantity: str) -> str:
    """Return a quantity as a reader writes it: frequency_rad_s is "frequency in rad/s"."""
    for end, unit in _UNITS.items():
        if quantity.endswith("_" + end):
            return f"{quantity.removesuffix('_' + end).replace('_', ' ')} in {unit}"
    return quantity.replace("_", " ")


def elastic(result: ModalResult, quantity: str) -> np.ndarray:
    """Values of a quantity for the modes that are not rigid, lowest natural frequency first."""
    return QUANTITIES[quantity](result)[~result.rigid]
