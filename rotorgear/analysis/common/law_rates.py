"""How fast the forces of laws vary: the circular frequencies of their harmonics."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from rotorgear.solvers.time.local_forces import LocalLaw

# Harmonics of a law that are looked at, at most.
_HARMONICS = 10


def rates(laws: Sequence[LocalLaw], speed: float) -> np.ndarray:
    """Rad/s of all harmonics of all laws that matter, up to the 10th, at a speed of the reference in rad/s, each once."""
    frequencies = [
        each.order * abs(speed) * harmonic
        for law in laws
        for each in law.repeats()
        for harmonic in range(1, min(each.harmonics, _HARMONICS) + 1)
    ]
    return np.unique(np.round([w for w in frequencies if w > 0.0], 6))
