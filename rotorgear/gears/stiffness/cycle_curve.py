"""A curve over the mesh cycle from values at positions that need not be even: a cubic between each two of them.

Between positions u_i and u_i+1, h apart, stands Hermite's cubic. Its slope at a position is that of the parabola through it and
its neighbours; at an event, where a pair comes into contact or leaves it, the curve has a kink, and each side has the slope of
the parabola through the event and the two positions on its own side. So the error is of order h^3 on either side of a kink.

    f = mean + sum over n of Re(c_n e^(2 pi i n u)),     c_n = (2/P) integral of f e^(-2 pi i n u) du,

over the length P of the cycle in base pitches, are integrals of the cubics themselves: nothing is folded back into low orders,
as it is where a discrete transform of even positions meets a kink.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

# Positions nearer to each other than this, in base pitches, enclose an event.
NEAR = 1e-5
# Gauss-Legendre places in an interval: they are exact to rounding up to orders that turn by four periods within it.
_PLACES = 24


@dataclass(frozen=True)
class CycleCurve:
    """Curves that repeat.

    Attributes:
        position: (n,) rising, less than one cycle long.
        values: (n, c) of c curves.
        period: length P of the cycle in base pitches.
        event: (n,) whether the curve has a kink there.
    """

    position: np.ndarray
    values: np.ndarray
    period: float
    event: np.ndarray

    @cached_property
    def width(self) -> np.ndarray:
        """Length (n,) of the interval from each position to the next one."""
        return np.asarray(np.diff(self.position, append=self.position[0] + self.period))

    @cached_property
    def _slopes(self) -> tuple[np.ndarray, np.ndarray]:
        """Slopes (n, c) at the beginning and at the end of each interval."""
        h = self.width[:, None]
        chord = (np.roll(self.values, -1, axis=0) - self.values) / h
        before = np.roll(chord, 1, axis=0)
        h_before = np.roll(h, 1, axis=0)
        after = np.roll(chord, -1, axis=0)
        h_after = np.roll(h, -1, axis=0)
        smooth = (h * before + h_before * chord) / (h + h_before)
        # Parabolas that stay on one side of an event, and chords between two events.
        # So do positions with a step or a kink between them that is nearer than any smooth curve needs them.
        near = h <= NEAR
        kink = self.event[:, None] | near | np.roll(near, 1, axis=0)
        next_kink = np.roll(kink, -1, axis=0)
        forward = np.where(next_kink, chord, chord + (chord - after) * h / (h + h_after))
        backward = np.where(kink, chord, chord + (chord - before) * h / (h + h_before))
        return np.where(kink, forward, smooth), np.where(next_kink, backward, np.roll(smooth, -1, axis=0))

    def within(self, share: np.ndarray) -> np.ndarray:
        """Values (n, s, c) in all intervals, at shares (s,) of their lengths."""
        t = share[:, None]
        first = self.values[:, None]
        rise = np.roll(self.values, -1, axis=0)[:, None] - first
        start, end = (slope[:, None] * self.width[:, None, None] for slope in self._slopes)
        return np.asarray(first + t * (start + t * (3.0 * rise - 2.0 * start - end + t * (start + end - 2.0 * rise))))

    def at(self, position: np.ndarray) -> np.ndarray:
        """Values (m, c) at any positions (m,)."""
        u = np.mod(position - self.position[0], self.period) + self.position[0]
        i = np.clip(np.searchsorted(self.position, u, side="right") - 1, 0, None)
        t = ((u - self.position[i]) / self.width[i])[:, None]
        first = self.values[i]
        rise = self.values[(i + 1) % len(self.position)] - first
        start, end = (slope[i] * self.width[i, None] for slope in self._slopes)
        return np.asarray(first + t * (start + t * (3.0 * rise - 2.0 * start - end + t * (start + end - 2.0 * rise))))

    def mean(self) -> np.ndarray:
        """Means (c,) over the cycle: the integral of Hermite's cubic is exact, h (f_0 + f_1)/2 + h^2 (f'_0 - f'_1)/12."""
        h = self.width[:, None]
        start, end = self._slopes
        pieces = 0.5 * h * (self.values + np.roll(self.values, -1, axis=0)) + h**2 * (start - end) / 12.0
        return np.asarray(pieces.sum(axis=0) / self.period)

    def mean_of_steps(self) -> np.ndarray:
        """Means (c,) of curves that step where pairs come and go, as tangents do: cubics that stay between their ends.

        Slopes of up to three times the chord, of its sign, keep them there (Fritsch and Carlson); without that bound a cubic
        beside a step swings, by more than the mean of a crowned pair forgives (1.7 %).
        """
        h = self.width[:, None]
        rise = np.roll(self.values, -1, axis=0) - self.values
        chord = rise / h
        start, end = (
            np.where(slope * chord > 0.0, np.sign(chord) * np.minimum(np.abs(slope), 3.0 * np.abs(chord)), 0.0)
            for slope in self._slopes
        )
        pieces = h * (self.values + 0.5 * rise) + h**2 * (start - end) / 12.0
        return np.asarray(pieces.sum(axis=0) / self.period)

    def harmonics(self, count: int) -> np.ndarray:
        """Complex amplitudes c_n (count, c) at the orders 1 to `count` of the mesh; whole periods only."""
        x, weight = np.polynomial.legendre.leggauss(_PLACES)
        share = 0.5 * (x + 1.0)
        values = self.within(share) * (0.5 * weight[:, None] * self.width[:, None, None])
        u = self.position[:, None] + share * self.width[:, None]
        wave = np.exp(-2j * np.pi * np.arange(1, count + 1)[:, None, None] * u)
        return np.asarray(2.0 / self.period * np.einsum("nis,isc->nc", wave, values))
