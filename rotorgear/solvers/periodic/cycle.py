"""One period of a motion, equally spaced: what results read off it, whatever method found it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rotorgear.solvers.periodic.samples import Samples
from rotorgear.solvers.time.statistics import PeriodicCurve


@dataclass(frozen=True)
class Cycle:
    """A period T in s; the motion at N instants; watched displacements and rates (N, p); coefficients of d and F (H + 1, m)."""

    period: float
    at: Samples
    watched: np.ndarray
    watched_rate: np.ndarray
    displacement: np.ndarray
    force: np.ndarray

    def extremes(self) -> np.ndarray:
        """Least and largest local displacements (m, 2), by the cubics through values and rates."""
        return PeriodicCurve(self.period, self.at.d, self.at.v).extremes()


def spectrum(values: np.ndarray, harmonics: int) -> np.ndarray:
    """Coefficients c (H + 1, m) of values (N, m), d(t) = Re sum c_h e^{i h w t}."""
    c = np.fft.rfft(values, axis=0)[: harmonics + 1] / len(values)
    c[1:] *= 2.0
    return np.asarray(c)
