"""Contact map of one helix: the force F(delta, u) along the flank normal over approach and position in the mesh cycle.

The loaded contact is solved at some positions u and loads F_j from zero to well above the working load; each row of the map
is delta(F_j; u), from the first touch (F = 0) on. All flanks, reliefs, pitch errors, corners and separation are in it:

    F = 0 for delta <= delta_0(u),     F rises monotonically with delta above.

Statics, modes and responses linearise about it; transients and sweeps take it as the law of the mesh.
Reference: H. N. Ozguven and D. R. Houser, Journal of Sound and Vibration 125 (1988) 71.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from scipy.interpolate import CubicHermiteSpline, PchipInterpolator

from rotorgear.gears.loaded.mesh_cycle import mesh_cycle
from rotorgear.gears.loaded.tooth_contact import contact_problem
from rotorgear.gears.stiffness.mesh_stiffness import ToothPair

# Positions in a base pitch, and loads as multiples of the working load. Resonances with contact loss reach four to five times it.
POSITIONS = 128
_LOADS = (0.0, 0.01, 0.03, 0.08, 0.15, 0.25, 0.4, 0.6, 0.8, 1.0, 1.25, 1.6, 2.0, 2.5, 3.2, 4.0, 5.0)
# Linear analyses stay near the working load, and helical teeth are smooth over the cycle and over the load.
_NEAR_LOADS = (0.0, 0.15, 0.4, 0.7, 1.0, 1.4, 2.0)
_NEAR_POSITIONS = 64


@dataclass(frozen=True)
class ContactMap:
    """F(delta, u) of one helix along the flank normal.

    Attributes:
        position: (p,) u in base pitches from contact at the pitch point, evenly spaced from 0 over `periods`; along the path
            of contact from approach to recess of the pinion.
        periods: base pitches after which the map repeats: 1, or more where pitch errors make teeth differ.
        load: (l,) forces along the flank normal in N, rising from 0.
        approach: (p, l) approach of the flanks along their normal in m at these loads; the first column is that of first touch.
        warnings: sentences.
        compliance: (p, l) d delta / dF in m/N at these loads but the first; None: it follows from the approaches.
    """

    position: np.ndarray
    periods: int
    load: np.ndarray
    approach: np.ndarray
    warnings: tuple[str, ...] = ()
    compliance: np.ndarray | None = None

    @property
    def largest_load(self) -> float:
        """Force in N up to which the contact was solved; above it the map goes on along its tangent."""
        return float(self.load[-1])

    def no_load(self, u: Any) -> np.ndarray:
        """Approach delta_0 in m at which the first teeth touch, of the shape of u."""
        return np.asarray(np.interp(u, self.position, self.approach[:, 0], period=self.periods))

    def approach_at(self, force: Any, u: Any) -> np.ndarray:
        """Approach in m under a force in N at positions u, both of shapes that broadcast."""
        force, u = np.broadcast_arrays(np.asarray(force, float), np.asarray(u, float))
        last = self.load[-1]
        above = np.maximum(force - last, 0.0)
        at_loads = self._deflection_of_load(np.clip(force, 0.0, last).ravel())
        index, share = self._between(u.ravel())
        each = np.arange(len(share))
        inside = (1.0 - share) * at_loads[index, each] + share * at_loads[(index + 1) % len(self.position), each]
        slope = (1.0 - share) * self._last_slope[index] + share * self._last_slope[(index + 1) % len(self.position)]
        return np.asarray(inside.reshape(force.shape) + above * slope.reshape(force.shape))

    def approaches(self, load: np.ndarray) -> np.ndarray:
        """Approach (p, n) in m at all positions of the map under n loads in N, from 0 to the largest load."""
        return np.asarray(self._deflection_of_load(load))

    def force(self, delta: Any, u: Any) -> np.ndarray:
        """Force in N at approaches delta in m and positions u, both of shapes that broadcast; 0 where no tooth touches."""
        return self._solved(delta, u)[0]

    def stiffness(self, delta: Any, u: Any) -> np.ndarray:
        """Tangent dF/d delta in N/m at approaches delta in m and positions u; 0 where no tooth touches."""
        return self._solved(delta, u)[1]

    def _solved(self, delta: Any, u: Any) -> tuple[np.ndarray, np.ndarray]:
        """Force and tangent: delta(F; u) is monotone in F, so that bisection on it always ends."""
        delta, u = np.broadcast_arrays(np.asarray(delta, float), np.asarray(u, float))
        low = np.zeros(delta.shape)
        high = np.full(delta.shape, self.load[-1])
        while np.any(short := self.approach_at(high, u) < delta):
            high = np.where(short, 2.0 * high, high)
        for _ in range(60):
            middle = 0.5 * (low + high)
            below = self.approach_at(middle, u) < delta
            low = np.where(below, middle, low)
            high = np.where(below, high, middle)
        force = 0.5 * (low + high)
        touches = delta > self.no_load(u)
        step = 1e-4 * np.maximum(force, 1e-3 * self.load[-1])
        rise = self.approach_at(force + step, u) - self.approach_at(np.maximum(force - step, 0.0), u)
        width = step + np.minimum(step, force)
        return np.where(touches, force, 0.0), np.where(touches, width / rise, 0.0)

    def _between(self, u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Position before each u, and the share of the way to the next one."""
        at = np.mod(u / self.periods, 1.0) * len(self.position)
        index = np.minimum(at.astype(int), len(self.position) - 1)
        return index, at - index

    @cached_property
    def _deflection_of_load(self) -> PchipInterpolator | CubicHermiteSpline:
        """delta (p, n) of n loads: monotone, so that no tangent is negative.

        Slopes are held below three times the chords: Fritsch and Carlson, SIAM J. Numer. Anal. 17 (1980) 238.
        """
        if self.compliance is None:
            return PchipInterpolator(self.load, self.approach, axis=1)
        secant = np.diff(self.approach, axis=1) / np.diff(self.load)
        slope = self.compliance.copy()
        # Line contact gives way without bound at first touch: there the curve leaves without curvature.
        slope[:, 0] = 1.5 * secant[:, 0] - 0.5 * slope[:, 1]
        slope[:, 1:] = np.minimum(slope[:, 1:], 3.0 * secant)
        slope[:, :-1] = np.minimum(slope[:, :-1], 3.0 * secant)
        return CubicHermiteSpline(self.load, self.approach, np.maximum(slope, 0.0), axis=1)

    @cached_property
    def _last_slope(self) -> np.ndarray:
        """d delta / dF (p,) at the largest load."""
        return np.asarray(self._deflection_of_load(self.load[-1], 1))


@lru_cache(maxsize=32)  # the helices of a model and its analyses ask for the same maps again and again
def contact_map(teeth: ToothPair, load: float, positions: int = POSITIONS, near: bool = False) -> ContactMap:
    """Solve the loaded contact over the mesh cycle for loads up to five times the working one.

    Args:
        teeth: one helix.
        load: working force (N) along the flank normal.
        positions: in a base pitch.
        near: for linear analyses: of helical teeth fewer loads, up to twice the working one, and fewer positions.

    Raises:
        AnalysisError: teeth that can't be made, meshed or brought into contact.
        ConvergenceError: a position has no solution to the tolerance.
        MissingExtraError: scikit-fem is needed and not installed.
    """
    problem = contact_problem(teeth)
    cosine = float(np.cos(problem.line.base_helix_angle))
    wrong = (*teeth.first_flank.single_teeth, *teeth.second_flank.single_teeth)
    periods = max(wrong) + 2 if wrong else 1
    thin = near and problem.line.base_helix_angle > 0.0
    positions = min(positions, _NEAR_POSITIONS) if thin else positions
    shares = _NEAR_LOADS if thin else _LOADS
    u = np.arange(positions * periods) / positions
    cycles = [mesh_cycle(problem, share * load * cosine, u) for share in shares[1:]]
    # mesh_cycle is transverse: delta_n = delta cos b_b, F_n = F_bt / cos b_b.
    columns = [cycles[0].no_load, *(cycle.deflection for cycle in cycles)]
    warnings = dict.fromkeys(note for cycle in cycles for note in cycle.warnings)
    return ContactMap(
        position=u,
        periods=periods,
        load=load * np.array(shares),
        approach=cosine * np.stack(columns, axis=1),
        warnings=(*problem.warnings, *warnings),
        # F_n = F_bt / cos b_b and delta_n = delta cos b_b: a compliance has cos^2 b_b.
        compliance=cosine**2 * np.stack([np.zeros(len(u)), *(1.0 / cycle.tangent for cycle in cycles)], axis=1),
    )
