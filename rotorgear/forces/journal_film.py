"""Journal bearing of finite length, plain or with lobes: Reynolds' equation on a grid, as journal_pressure.py solves it.

A plain bearing needs a line where fresh oil comes in at p = 0. It is at `inlet`, or follows the widest gap: then statics look
for the equilibrium with it, and linear analyses and motions in time take it to stay there.

Lobes: c_p = c/(1 - m), preload m, and the gap of the centred journal is least at `offset` of the arc of a lobe in the sense of
rotation.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np

from rotorgear.forces.inside import FilmField
from rotorgear.forces.journal_pressure import AROUND, FIRST, force, pad_film
from rotorgear.forces.law import parameter, refuse
from rotorgear.forces.oil_film import TURN, JournalOil
from rotorgear.forces.shell import schedule


@dataclass(frozen=True)
class JournalFilm(JournalOil):
    """Journal bearing, plain or with lobes, by Reynolds' equation on a grid."""

    title: ClassVar[str] = "journal bearing"

    lobes: int = parameter("", "number of lobes; 1: plain", 1, least=1, most=8)
    arc: float = parameter("rad", "extent of a lobe; 0: all of its share of the circle", 0.0, least=0.0)
    at: float = parameter("rad", "angle of the middle of the first lobe, from +x about +z", 0.0)
    offset: float = parameter("", "place of the least gap in the arc of a lobe", 0.5, least=0.0, most=1.0)
    inlet: float = parameter("rad", "angle of the inlet of a plain bearing that does not follow the gap", 0.0)
    follows: bool = parameter("", "whether the inlet of a plain bearing follows the widest gap", False)

    def check(self) -> None:
        """Lobes fit around the journal, and the bearing is not longer than the grid serves."""
        super().check()
        if self.lobes == 1 and (self.preload or (self.arc and abs(self.arc - TURN) > 1e-9)):
            raise refuse(self, "lobes", "at least 2 with a preload or an arc")
        if self.lobes * self.arc > TURN * (1.0 + 1e-9):
            raise refuse(self, "arc", "lobes that fit around the journal")

    def functions(self) -> tuple[Any, Any]:
        """Return the compiled functions schedule and force."""
        return schedule, force

    def parameters(self) -> np.ndarray:
        """What the grid needs, then start, extent and place of the least gap of each pad."""
        extent = (self.arc or TURN / self.lobes) if self.lobes > 1 else TURN
        place = self.offset if self.order >= 0.0 else 1.0 - self.offset
        pads = []
        for k in range(self.lobes):
            start = self.at + TURN * k / self.lobes - 0.5 * extent if self.lobes > 1 else self.inlet
            pads.append((start, extent, start + place * extent))
        return self.of_grid(max(self.around // self.lobes, 12), self.follows and self.lobes == 1, pads)

    def settled(self, d: Any) -> JournalFilm:
        """The bearing with its inlet where the widest gap is at displacements d (2,)."""
        if not self.follows or self.lobes > 1:
            return self
        return replace(self, follows=False, inlet=float(np.arctan2(-d[1], -d[0])))

    def left_out(self) -> tuple[str, ...]:
        """What the film leaves out."""
        return (f"{self.heat_left_out}, turbulence and tilt of the journal in its film",)

    def rough(self) -> JournalFilm:
        """The same on a grid that knows the stiffness to some 10 %."""
        return replace(self, around=min(self.around, max(36, 12 * self.lobes)), along=min(self.along, 3))

    def inside(self, d: Any, *, angle: float = 0.0, speed: float = 0.0) -> FilmField:
        """Pressure, gap, side flow and power loss with the journal at rest at displacements d (2,)."""
        return self.field_at(d, (0.0, 0.0), speed)

    def field_at(self, d: Any, v: Any, speed: float) -> FilmField:
        """The film at a speed of the reference with the journal at displacements d and velocities v (2,)."""
        p = self.settled(d).parameters()
        around = int(p[AROUND])
        c_pad = self.pad_clearance
        pads = []
        for start, extent, least in p[FIRST:].reshape(-1, 3):
            pressure = np.zeros((around - 1, self.along))
            none = (np.zeros(2), np.zeros(4), np.zeros(4))
            pad_film(p, self.order * speed, d[0], d[1], v[0], v[1], start, extent, least, *none, pressure)
            t = start + extent * np.arange(1, around) / around
            h = c_pad - d[0] * np.cos(t) - d[1] * np.sin(t) - self.preload * c_pad * np.cos(t - least)
            pads.append((t, h, pressure, extent))
        return self.film_field(pads, speed)

    @classmethod
    def examples(cls) -> tuple[JournalFilm, ...]:
        """A plain bearing with a groove, one whose inlet follows, and three lobes."""
        return (
            cls(0.02, 25e-3, 25e-3, 50e-6, inlet=2.0, around=60, along=4),
            cls(0.02, 25e-3, 25e-3, 50e-6, follows=True, around=60, along=4),
            cls(0.02, 25e-3, 25e-3, 50e-6, lobes=3, arc=1.9, preload=0.5, around=60, along=4),
        )
