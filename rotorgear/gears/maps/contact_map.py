"""Contact map of one helix: the force F(delta, u) along the flank normal over approach and position in the mesh cycle.

The loaded contact is solved at some positions u and loads F_j from zero to well above the working load; each row of the map
is delta(F_j; u), from the first touch (F = 0) on. All flanks, reliefs, pitch errors, corners and separation are in it:

    F = 0 for delta <= delta_0(u),     F rises monotonically with delta above.

Between loads delta(F) is a cubic with the exact tangents of the contact at both ends, as far as it stays monotone (Fritsch and
Carlson); between positions it is linear. Above the largest load it goes on along its tangent.

Statics, modes and responses linearise about it; transients and sweeps take it as the law of the mesh.
References: H. N. Ozguven and D. R. Houser, Journal of Sound and Vibration 125 (1988) 71;
F. N. Fritsch and R. E. Carlson, SIAM Journal on Numerical Analysis 17 (1980) 238.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy.interpolate import CubicHermiteSpline, PchipInterpolator

# Points that are solved together: their loads and slopes take memory.
_TOGETHER = 8192
# Positions whose cubics are made together.
_BLOCK = 512


@dataclass(frozen=True)
class ContactMap:
    """F(delta, u) of one helix along the flank normal.

    Attributes:
        position: (p,) u in base pitches from contact at the pitch point, evenly spaced from 0 over `periods`; along the path
            of contact from approach to recess of the pinion.
        periods: base pitches after which the map repeats: 1, or the turns of the gears whose teeth have pitch errors.
        load: (l,) forces along the flank normal in N, rising from 0.
        approach: (p, l) approach of the flanks along their normal in m at these loads; the first column is that of first touch.
        warnings: sentences.
        compliance: (p, l) d delta / dF in m/N at these loads; None: that of a monotone interpolation (PCHIP).
        moment: (p, l) M in N m of the forces about the middle of the face at these loads; None where nothing varies along it.
        error: largest difference in m along the flank normal to contacts solved between its positions and loads; NaN without
            any.
    """

    position: np.ndarray
    periods: int
    load: np.ndarray
    approach: np.ndarray
    warnings: tuple[str, ...] = ()
    compliance: np.ndarray | None = None
    moment: np.ndarray | None = None
    error: float = float("nan")

    @property
    def largest_load(self) -> float:
        """Force in N up to which the contact was solved; above it the map goes on along its tangent."""
        return float(self.load[-1])

    def beyond(self, force: Any) -> str | None:
        """A sentence where the largest of some forces (N) lies above the loads of the map; None where none does."""
        most = float(np.max(force))
        if most <= self.largest_load:
            return None
        return (
            f"the mesh force reaches {most:.3g} N, and the loaded teeth were solved up to {self.largest_load:.3g} N; above it "
            "they count as stiff as there"
        )

    def no_load(self, u: Any) -> np.ndarray:
        """Approach delta_0 in m at which the first teeth touch, of the shape of u."""
        u = np.asarray(u, float)
        return np.asarray(self._knots(u.ravel())[0][:, 0].reshape(u.shape))

    def at_loads(self, u: np.ndarray) -> np.ndarray:
        """Approach (r, l) in m at r positions u under the loads of the map."""
        return self._knots(u)[0]

    def approach_at(self, force: Any, u: Any) -> np.ndarray:
        """Approach in m under a force in N at positions u, both of shapes that broadcast."""
        force, u = np.broadcast_arrays(np.asarray(force, float), np.asarray(u, float))
        F = force.ravel()
        knots, slopes = self._knots(u.ravel())
        piece = np.clip(np.searchsorted(self.load, F, side="right") - 1, 0, len(self.load) - 2)
        inside = self._cubic(knots, slopes, piece, np.clip(F, 0.0, self.largest_load))[0]
        return np.asarray((inside + np.maximum(F - self.largest_load, 0.0) * slopes[:, -1]).reshape(force.shape))

    def approaches(self, load: np.ndarray) -> np.ndarray:
        """Approach (p, n) in m at all positions of the map under n loads in N, from 0 to the largest load."""
        found = np.empty((len(self.approach), len(load)))
        # By blocks: the coefficients of all cubics take four times the map.
        for first in range(0, len(found), _BLOCK):
            some = slice(first, first + _BLOCK)
            found[some] = CubicHermiteSpline(self.load, self.approach[some], self.slopes[some], axis=1)(load)
        return found

    def curves(self, load: np.ndarray, u: np.ndarray) -> np.ndarray:
        """Approach (r, n) in m at r positions u under n loads in N, from 0 to the largest load of the map."""
        return np.asarray(CubicHermiteSpline(self.load, *self._knots(u), axis=1)(load))

    def force(self, delta: Any, u: Any) -> np.ndarray:
        """Force in N at approaches delta in m and positions u, both of shapes that broadcast; 0 where no tooth touches."""
        return self._solved(delta, u)[0]

    def stiffness(self, delta: Any, u: Any) -> np.ndarray:
        """Tangent dF/d delta in N/m at approaches delta in m and positions u; 0 where no tooth touches."""
        return self._solved(delta, u)[1]

    def _solved(self, delta: Any, u: Any) -> tuple[np.ndarray, np.ndarray]:
        delta, u = np.broadcast_arrays(np.asarray(delta, float), np.asarray(u, float))
        d = delta.ravel()
        at = u.ravel()
        found = np.empty((2, len(d)))
        for first in range(0, len(d), _TOGETHER):
            some = slice(first, first + _TOGETHER)
            found[:, some] = self._solved_together(d[some], at[some])
        return found[0].reshape(delta.shape), found[1].reshape(delta.shape)

    def _solved_together(self, d: np.ndarray, u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Force and tangent: the piece between two loads in which delta lies, then its cubic by Newton's method in brackets."""
        knots, slopes = self._knots(u)
        piece = np.clip(np.sum(knots <= d[:, None], axis=1) - 1, 0, len(self.load) - 2)
        low = self.load[piece]
        high = self.load[piece + 1]
        F = 0.5 * (low + high)
        for _ in range(60):
            value, slope = self._cubic(knots, slopes, piece, F)
            short = value < d
            low = np.where(short, F, low)
            high = np.where(short, high, F)
            # A flat place of the cubic must not divide by zero: the bracket takes over.
            step = F + (d - value) / np.maximum(slope, 1e-300)
            F_next = np.where((step > low) & (step < high), step, 0.5 * (low + high))
            if np.all(np.abs(F_next - F) <= 1e-15 * self.largest_load):
                break
            F = F_next
        slope = self._cubic(knots, slopes, piece, F)[1]
        above = d > knots[:, -1]
        F = np.where(above, self.largest_load + (d - knots[:, -1]) / slopes[:, -1], F)
        slope = np.where(above, slopes[:, -1], slope)
        touches = d > knots[:, 0]
        return np.where(touches, F, 0.0), np.where(touches, 1.0 / slope, 0.0)

    def _knots(self, u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Approaches and slopes (n, l) at the loads, at positions u (n,)."""
        at = np.mod(u / self.periods, 1.0) * len(self.position)
        index = np.minimum(at.astype(int), len(self.position) - 1)
        share = (at - index)[:, None]
        following = (index + 1) % len(self.position)
        slope = self.slopes
        return (
            (1.0 - share) * self.approach[index] + share * self.approach[following],
            (1.0 - share) * slope[index] + share * slope[following],
        )

    def _cubic(
        self, knots: np.ndarray, slopes: np.ndarray, piece: np.ndarray, force: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Hermite's cubic and its derivative at forces (n,) between loads `piece` and the next."""
        each = np.arange(len(piece))
        width = self.load[piece + 1] - self.load[piece]
        t = (force - self.load[piece]) / width
        first = knots[each, piece]
        rise = knots[each, piece + 1] - first
        start = width * slopes[each, piece]
        end = width * slopes[each, piece + 1]
        value = first + t * (start + t * (3.0 * rise - 2.0 * start - end + t * (start + end - 2.0 * rise)))
        derivative = start + t * (2.0 * (3.0 * rise - 2.0 * start - end) + 3.0 * t * (start + end - 2.0 * rise))
        return value, derivative / width

    @cached_property
    def slopes(self) -> np.ndarray:
        """Slopes (p, l) with which every cubic rises: within three times the chords beside them (Fritsch and Carlson)."""
        if self.compliance is None:
            return np.asarray(PchipInterpolator(self.load, self.approach, axis=1)(self.load, 1))
        chord = np.diff(self.approach, axis=1) / np.diff(self.load)
        most = 3.0 * np.minimum(
            np.concatenate([chord[:, :1], chord], axis=1), np.concatenate([chord, chord[:, -1:]], axis=1)
        )
        return np.minimum(self.compliance, most)
