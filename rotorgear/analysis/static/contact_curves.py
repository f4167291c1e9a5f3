"""Force over approach of a contact at one position of its cycle: F(delta), or (F, M)(delta, tilt) along a face."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from rotorgear.forces.law import ForceLaw
    from rotorgear.gears.maps.contact_map import ContactMap

# A curve F(delta) at one position is straight between so many points to each step of load of its map.
_FINER = 8


@dataclass(frozen=True)
class MapTable:
    """A contact over the p positions of a cycle.

    Attributes:
        contact_map: its map.
        place: (p,) places u on it; None where the mean of the map holds.
        approach: (p, l) at the loads of the map and one far above.
        gap: index error in m.
    """

    contact_map: ContactMap
    place: np.ndarray | None
    approach: np.ndarray
    gap: float

    def curves(self, positions: np.ndarray) -> list[Curve]:
        """F(delta) at some positions (r,), given by their numbers."""
        steps = np.arange(_FINER) / _FINER
        load = self.contact_map.load
        fine = np.append((load[:-1, None] + np.diff(load)[:, None] * steps).ravel(), load[-1])
        far = 10.0 * load[-1]
        if self.place is None:
            everywhere = self.contact_map.position
            approach = self.contact_map.curves(fine, everywhere).mean(axis=0)
            beyond = self.contact_map.approach_at(far, everywhere).mean()
            return [Curve(self.gap + np.append(approach, beyond), np.append(fine, far))] * len(positions)
        u = self.place[positions]
        beyond = self.contact_map.approach_at(far, u)
        approach = np.column_stack([self.contact_map.curves(fine, u), beyond])
        return [Curve(self.gap + row, np.append(fine, far)) for row in approach]


@dataclass(frozen=True)
class FaceTable:
    """A contact along its face over a cycle: its law, places u (p,) on it, and approaches (p, a) that tell positions apart."""

    law: ForceLaw
    place: np.ndarray
    approach: np.ndarray

    def curves(self, positions: np.ndarray) -> list[FaceCurve]:
        """(F, M)(delta, tilt) at some positions (r,), given by their numbers."""
        return [FaceCurve(self.law, float(u)) for u in self.place[positions]]


@dataclass(frozen=True)
class FaceCurve:
    """(F, M)(delta, tilt) of a contact at a place u on its map."""

    law: ForceLaw
    place: float

    def force(self, d: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Force in N and moment in N m, and their tangents (2, 2), at an approach and a tilt (2,)."""
        found = self.law.evaluate(d, angle=2.0 * math.pi * self.place)
        return found.force, found.in_displacement


@dataclass(frozen=True)
class Curve:
    """F(delta) of a contact at one position, straight between points: approach (n,) in m, rising, and load (n,) in N."""

    approach: np.ndarray
    load: np.ndarray

    def force(self, d: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Force (1,) in N and tangent (1, 1) in N/m at an approach (1,)."""
        delta = float(d[0])
        if delta <= self.approach[0]:
            return np.zeros(1), np.zeros((1, 1))
        i = min(int(np.searchsorted(self.approach, delta)), len(self.load) - 1)
        slope = float((self.load[i] - self.load[i - 1]) / (self.approach[i] - self.approach[i - 1]))
        return np.array([self.load[i - 1] + slope * (delta - self.approach[i - 1])]), np.array([[slope]])
