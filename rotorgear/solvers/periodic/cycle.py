"""One period of a motion, equally spaced: what results read off it, whatever method found it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rotorgear.solvers.periodic.samples import Samples


@dataclass(frozen=True)
class Cycle:
    """A period T in s; the motion at N instants; watched displacements (N, p); coefficients of d and F (H + 1, m)."""

    period: float
    at: Samples
    watched: np.ndarray
    displacement: np.ndarray
    force: np.ndarray

    def extremes(self) -> np.ndarray:
        """Least and largest local displacements (m, 2), by the cubics through values and rates."""
        d = self.at.d
        v = self.at.v
        h = self.period / len(d)
        d1 = np.roll(d, -1, axis=0)
        v1 = np.roll(v, -1, axis=0)
        # d(s) = d + s (h v) + s^2 b + s^3 a on 0 <= s <= 1.
        a = 2.0 * (d - d1) + h * (v + v1)
        b = 3.0 * (d1 - d) - h * (2.0 * v + v1)
        root = np.sqrt(np.maximum(b * b - 3.0 * a * h * v, 0.0))
        found = [d]
        for sign in (1.0, -1.0):
            q = -(b + sign * root)
            with np.errstate(divide="ignore", invalid="ignore"):
                for s in (q / (3.0 * a), h * v / np.where(q == 0.0, np.nan, q)):
                    inside = (s > 0.0) & (s < 1.0)
                    s = np.where(inside, s, 0.0)
                    found.append(d + s * (h * v + s * (b + s * a)))
        stacked = np.concatenate(found)
        return np.column_stack([stacked.min(axis=0), stacked.max(axis=0)])


def spectrum(values: np.ndarray, harmonics: int) -> np.ndarray:
    """Coefficients c (H + 1, m) of values (N, m), d(t) = Re sum c_h e^{i h w t}."""
    c = np.fft.rfft(values, axis=0)[: harmonics + 1] / len(values)
    c[1:] *= 2.0
    return np.asarray(c)
