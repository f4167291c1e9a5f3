"""What journal bearings of finite length share, fixed or of tilting pads: size, grid, shell, where their film does not hold."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from typing import Any, ClassVar

import numpy as np

from rotorgear.forces.law import parameter, refuse
from rotorgear.forces.oil_film import OilFilm

# Beyond these the equation or the grid does not describe the film: diameters, share of the clearance, Taylor's number.
_LONGEST = 2.0
_DEEPEST = 0.95
_TAYLOR = 41.2


@dataclass(frozen=True)
class JournalOil(OilFilm):
    """A journal of radius R in a film of length L."""

    grid: ClassVar[tuple[str, ...]] = ("around", "along")

    radius: float = parameter("m", "radius R of the journal", above=0.0)
    length: float = parameter("m", "length L of the bearing", above=0.0)
    clearance: float = parameter("m", "radial clearance c where the gap is least: of lobes, or at pivots", above=0.0)
    _: KW_ONLY
    preload: float = parameter("", "preload m of lobes or pads", 0.0, least=0.0, below=1.0)
    cavitation: str = parameter("", "how the film cavitates", "reynolds", choices=("reynolds", "half_sommerfeld"))
    around: int = parameter("", "cells of the grid around the circle, over all lobes or pads", 240, least=24, most=2000)
    along: int = parameter("", "cells over half the length", 12, least=2, most=200)
    contact: float = parameter(
        "", "displacement over c at which the journal lies on the shell", 0.95, above=0.0, below=1.0
    )
    wall: float = parameter("N/m", "stiffness of the shell", 1e9, least=0.0)

    def check(self) -> None:
        """The bearing is not longer than the grid serves."""
        if self.length > 2.0 * _LONGEST * self.radius:
            raise refuse(self, "length", f"at most {_LONGEST:g} diameters, beyond which shafts bend in their bearing")

    @property
    def cells(self) -> str:
        """Around the journal and along all of it."""
        return f"{self.around} x {2 * self.along}"

    @property
    def components(self) -> int:
        """Two."""
        return 2

    @property
    def extents(self) -> np.ndarray:
        """The clearance, over which pressures around the journal change."""
        return np.full(2, self.clearance)

    @property
    def pad_clearance(self) -> float:
        """Radius of a lobe or pad less that of the journal, c/(1 - m) in m."""
        return self.clearance / (1.0 - self.preload)

    def of_grid(self, around: int, follows: bool, pads: list[tuple[float, float, float]]) -> np.ndarray:
        """Parameters in the order of journal_pressure.py.

        Args:
            around: cells of a pad. follows: whether the inlet does. pads: start, extent and place of the least gap of each.
        """
        own = [self.viscosity, self.radius, self.length, self.clearance, self.order, self.contact, self.wall]
        cut = float(self.cavitation == "half_sommerfeld")
        each = [value for pad in pads for value in pad]
        return np.array([*own, self.preload, around, self.along, cut, float(follows), len(pads), *each])

    def beyond(self, d: Any, speed: float) -> str:
        """Heat, turbulence by Taylor's number, and an eccentricity near the shell."""
        if hot := self.too_hot():
            return hot
        omega = abs(self.order * speed)
        reynolds = self.density * omega * self.radius * self.clearance / self.viscosity
        most = _TAYLOR * np.sqrt(self.radius / self.clearance)
        if reynolds > most:
            return (
                f"the film is turbulent (Reynolds' number {reynolds:.4g}, laminar up to {most:.4g}), which is not modelled; "
                "check viscosity and clearance"
            )
        eccentricity = float(np.hypot(*d)) / self.clearance
        if eccentricity > _DEEPEST:
            return (
                f"the journal runs at {eccentricity:.3g} of the clearance, where the film is too thin for this model (at most "
                f"{_DEEPEST:g}); check load, viscosity, clearance and speed"
            )
        return ""
