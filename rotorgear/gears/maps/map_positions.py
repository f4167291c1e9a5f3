"""Positions at which a contact map is solved, and the even ones that it keeps.

The approach of a spur pair has a kink wherever a pair comes into contact or leaves it. Positions chosen there and where the curve
of the working load needs them are worth many times as many even ones (64 of a crowned pair 512). The map keeps even ones, so
that a law finds its place in one step:

    delta(F_j; u) = delta(F_w; u) + [delta(F_j; u_i) - delta(F_w; u_i)],

the curve of the working load F_w by cubics between the positions u_i (`cycle_curve.py`), the difference to the others straight
between them: their kinks stand elsewhere. So the approach rises with the load at all positions, as it does at u_i. Helical pairs
have no kinks. Their differences from load to load are cubics too, for helices that share a load carry a third of F_w or twice as
much; held to half of the straight ones at least, so that the approach rises.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rotorgear.gears.loaded.helix_cycles import helix_cycle
from rotorgear.gears.loaded.mesh_cycle import MeshCycle
from rotorgear.gears.stiffness.cycle_curve import CycleCurve
from rotorgear.gears.stiffness.mesh_stiffness import ToothPair

# Even positions that a map keeps of a base pitch.
_KEPT = 256


@dataclass(frozen=True)
class MapPositions:
    """Positions of one base pitch.

    Attributes:
        position: (n,) rising from 0.
        event: (n,) whether curves have a kink there; None where the positions are even and the map keeps them.
        cycle: the contact under the working load there, where it is known.
    """

    position: np.ndarray
    event: np.ndarray | None = None
    cycle: MeshCycle | None = None

    def kept(
        self, approach: np.ndarray, compliance: np.ndarray, moment: np.ndarray, working: int
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Positions (p,) over all base pitches that a map keeps, and its columns there.

        Args:
            approach, compliance, moment: (periods n, l) at these positions of all base pitches, for l loads.
            working: number of the working load.
        """
        n = len(self.position)
        periods = len(approach) // n
        if self.event is None:
            return np.arange(periods * n) / n, approach, compliance, moment
        u = (np.arange(periods)[:, None] + self.position).ravel()
        even = np.arange(periods * _KEPT) / _KEPT

        def straight(values: np.ndarray) -> np.ndarray:
            return np.stack([np.interp(even, u, column, period=float(periods)) for column in values.T], axis=1)

        def smooth(values: np.ndarray) -> np.ndarray:
            assert self.event is not None
            return CycleCurve(u, values, float(periods), np.tile(self.event, periods)).at(even)

        one = approach[:, [working]]
        if self.event.any():
            # Compliances step at events, and moments climb steeply there: between positions they are straight.
            return even, smooth(one) + straight(approach - one), straight(compliance), straight(moment)
        steps = np.diff(approach, axis=1)
        rise = np.cumsum(np.maximum(smooth(steps), 0.5 * straight(steps)), axis=1)
        rise = np.column_stack([np.zeros(len(even)), rise])
        softness = np.maximum(smooth(compliance), 0.5 * straight(compliance))
        return even, smooth(one) + rise - rise[:, [working]], softness, smooth(moment)


def even_positions(count: int) -> MapPositions:
    """So many even positions of a base pitch, which the map keeps."""
    return MapPositions(np.arange(count) / count)


def map_positions(teeth: ToothPair, load: float, count: int) -> MapPositions:
    """So many positions for F_bt = load (N): of a spur pair where its curve needs them, of a helical one even."""
    if teeth.first.helix_angle:
        return MapPositions(np.arange(count) / count, np.zeros(count, bool))
    found = helix_cycle(teeth, load, count)
    event = np.zeros(count, bool) if found.event is None else found.event
    return MapPositions(found.cycle.position, event, found.cycle)
