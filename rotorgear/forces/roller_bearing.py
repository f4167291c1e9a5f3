"""Cylindrical roller bearing: line contacts of Z rollers that turn with the cage, and clearance; it carries no axial load.

    delta = x cos phi + y sin phi - s/2,   Q = c_l delta^(10/9) where delta > 0,   c_l = 35948 L^(8/9) (N, mm)

for both rings together, rollers aligned with the raceways (ISO/TS 16281:2008).
Roller j is at phi_j = order * angle + phase + 2 pi j/Z.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from rotorgear.forces.inside import RollingLoads
from rotorgear.forces.law import parameter
from rotorgear.forces.rolling import CAGE, CAGE_SPEED, LINE_CONTACT, TURN, RollingElements, line_pressure, schedule
from rotorgear.solvers.time.compiled import force_function

# Of the parameters behind those of the cage.
ROLLERS, CONTACT, PLAY = range(2, 5)


@force_function
def force(p, s, d, v, F, Kd, Kv, energy):  # type: ignore[no-untyped-def]
    """Forces along x and y of the inner ring on the rollers."""
    count = int(p[ROLLERS])
    F[:] = 0.0
    Kd[:] = 0.0
    Kv[:] = 0.0
    stored = 0.0
    turned = 0.0
    loaded = 0.0
    for j in range(count):
        phi = s[CAGE] + TURN * j / count
        c = np.cos(phi)
        n = np.sin(phi)
        delta = d[0] * c + d[1] * n - p[PLAY]
        if delta <= 0.0:
            continue
        loaded = 1.0
        slope = p[CONTACT] * delta ** (1.0 / 9.0)
        Q = slope * delta
        slope *= 10.0 / 9.0
        F[0] += Q * c
        F[1] += Q * n
        Kd[0] += slope * c * c
        Kd[1] += slope * c * n
        Kd[2] += slope * c * n
        Kd[3] += slope * n * n
        stored += 9.0 / 19.0 * Q * delta
        turned += Q * (d[1] * c - d[0] * n) * s[CAGE_SPEED]
    energy[:] = stored, turned, 0.0, loaded


@dataclass(frozen=True)
class RollerBearing(RollingElements):
    """Cylindrical roller bearing with two relative displacements: x and y of the inner ring against the outer one."""

    title: ClassVar[str] = "cylindrical roller bearing"
    components: ClassVar[int] = 2

    rollers: int = parameter("", "number of rollers Z", least=3)
    length: float = parameter("m", "effective length L of a roller", above=0.0)
    roller_diameter: float = parameter("m", "diameter of a roller, for its pressures; 0: not told", 0.0, least=0.0)
    pitch_diameter: float = parameter("m", "pitch diameter, for the pressures; 0: not told", 0.0, least=0.0)

    @property
    def elements(self) -> int:
        """Z."""
        return self.rollers

    def functions(self) -> tuple[Any, Any]:
        """Return the compiled functions schedule and force."""
        return schedule, force

    def parameters(self) -> np.ndarray:
        """Order, phase, Z, c_l, s/2."""
        constant = LINE_CONTACT * self.length ** (8.0 / 9.0)
        return np.array([self.order, self.phase, self.rollers, constant, 0.5 * self.clearance])

    def inside(self, d: Any, *, angle: float = 0.0, speed: float = 0.0) -> RollingLoads:
        """Loads and pressures of the rollers at displacements d (2,); pressures are NaN where the diameters are not told."""
        constant, play = self.parameters()[CONTACT:]
        row, phi, _, _ = self.places(angle, ((0.0, 1.0),))
        delta = d[0] * np.cos(phi) + d[1] * np.sin(phi) - play
        load = constant * np.maximum(delta, 0.0) ** (10.0 / 9.0)
        inner = outer = np.full(phi.size, np.nan)
        if self.roller_diameter and self.pitch_diameter:
            gamma = self.roller_diameter / self.pitch_diameter
            inner, outer = line_pressure(load, self.length, self.roller_diameter, gamma)
        return RollingLoads(row, phi, np.zeros(phi.size), load, delta, inner, outer)

    @classmethod
    def examples(cls) -> tuple[RollerBearing, ...]:
        """One with clearance that turns."""
        return (cls(6, 13.6e-3, clearance=10e-6, order=0.4, phase=0.1),)
