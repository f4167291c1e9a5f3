"""Roller bearing whose loads vary along its rollers: tapered, in one row or a pair, or cylindrical with tilting rings.

The raceway of the outer ring makes the contact angle a with the shaft. A roller is cut into n slices, the middle of each at x
along it, and presses with

    delta = (u - s/2) cos a + sigma (z + p) sin a + psi m,   m = sigma R sin a - l cos a - x
    u = x_s cos phi + y_s sin phi,   psi = tx sin phi - ty cos phi,   Q = sum (c_l/n) delta^(10/9) where delta > 0

for both rings together, c_l = 35948 L^(8/9) (N, mm; ISO/TS 16281:2008), R = D_pw/2, l and sigma the place of the row and the
side of the push it takes (rolling.py), s the radial play and p the preload. delta is linear in the displacements and F the
gradient of the energy 9/19 sum (c_l/n) delta^(19/9): the law is conservative except for the motion of the rollers. With a = 0 it
is the cylindrical bearing of roller_bearing.py, which resists tilting.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np

from rotorgear.forces.inside import RollingLoads
from rotorgear.forces.law import parameter, refuse
from rotorgear.forces.rolling import (
    CAGE,
    CAGE_SPEED,
    LINE_CONTACT,
    TURN,
    RollingElements,
    line_pressure,
    rows_of,
    schedule,
)
from rotorgear.solvers.time.compiled import force_function

# Of the parameters behind those of the cage; then place and side of each row.
ROLLERS, CONTACT, PLAY, COSINE, SINE, PRELOAD, ARM, LENGTH, SLICES, ROWS, FIRST = range(2, 13)


@force_function
def force(p, s, d, v, F, Kd, Kv, energy):  # type: ignore[no-untyped-def]
    """Forces along x, y, z and moments about x, y of the inner ring on the rollers."""
    count = int(p[ROLLERS])
    slices = int(p[SLICES])
    F[:] = 0.0
    Kd[:] = 0.0
    Kv[:] = 0.0
    stored = 0.0
    turned = 0.0
    loaded = 0.0
    g = np.zeros(5)
    for j in range(count * int(p[ROWS])):
        row = j // count
        place = p[FIRST + 2 * row]
        side = p[FIRST + 2 * row + 1]
        phi = s[CAGE] + TURN * j / count
        c = np.cos(phi)
        n = np.sin(phi)
        g[0] = p[COSINE] * c
        g[1] = p[COSINE] * n
        g[2] = side * p[SINE]
        psi = d[3] * n - d[4] * c
        middle = g[0] * d[0] + g[1] * d[1] + g[2] * d[2] + p[SINE] * p[PRELOAD] - p[COSINE] * p[PLAY]
        for k in range(slices):
            x = p[LENGTH] * ((k + 0.5) / slices - 0.5)
            arm = side * p[ARM] * p[SINE] - place * p[COSINE] - x
            delta = middle + psi * arm
            if delta <= 0.0:
                continue
            loaded = 1.0
            g[3] = arm * n
            g[4] = -arm * c
            slope = p[CONTACT] / slices * delta ** (1.0 / 9.0)
            Q = slope * delta
            slope *= 10.0 / 9.0
            for i in range(5):
                F[i] += Q * g[i]
                for m in range(5):
                    Kd[5 * i + m] += slope * g[i] * g[m]
            stored += 9.0 / 19.0 * Q * delta
            turn = p[COSINE] * (d[1] * c - d[0] * n) + arm * (d[3] * c + d[4] * n)
            turned += Q * turn * s[CAGE_SPEED]
    energy[:] = stored, turned, 0.0, loaded


@dataclass(frozen=True)
class TaperedBearing(RollingElements):
    """Roller bearing of one or two rows, whose loads vary along its rollers."""

    title: ClassVar[str] = "tapered roller bearing"

    rollers: int = parameter("", "number of rollers Z of a row", least=3)
    length: float = parameter("m", "effective length L of a roller", above=0.0)
    roller_diameter: float = parameter("m", "diameter of a roller in its middle", above=0.0)
    pitch_diameter: float = parameter("m", "pitch diameter D_pw, of the middles of the rollers", above=0.0)
    contact_angle: float = parameter(
        "rad",
        "angle a of the outer raceway with the shaft; of one row its sign is that of the axial load it takes",
        0.0,
    )
    preload: float = parameter("m", "axial displacement by which each row is pressed together", 0.0, least=0.0)
    slices: int = parameter("", "slices of a roller", 21, least=1, most=200)
    arrangement: str = parameter(
        "", "rows and the sides that they press to", "single", choices=("single", "O", "X", "tandem")
    )
    row_distance: float = parameter("m", "distance of the two rows of a pair", 0.0, least=0.0)

    def check(self) -> None:
        """Rollers fit into the bearing, and rows have an angle."""
        if not self.roller_diameter < self.pitch_diameter:
            raise refuse(self, "roller_diameter", "a diameter below the pitch diameter")
        if self.arrangement != "single" and not self.contact_angle > 0.0:
            raise refuse(self, "contact_angle", "above 0 where rows press to both sides or together")

    @property
    def elements(self) -> int:
        """Z."""
        return self.rollers

    @property
    def _rows(self) -> tuple[tuple[float, float], ...]:
        if self.arrangement == "single":
            return ((0.0, -1.0 if self.contact_angle < 0.0 else 1.0),)
        return rows_of(self.arrangement, self.row_distance)

    def functions(self) -> tuple[Any, Any]:
        """Return the compiled functions schedule and force."""
        return schedule, force

    def parameters(self) -> np.ndarray:
        """Order, phase, Z, c_l, s/2, cos a, sin |a|, p, R, L, slices, number of rows, and place and side of each."""
        a = abs(self.contact_angle)
        constant = LINE_CONTACT * self.length ** (8.0 / 9.0)
        own = [self.order, self.phase, self.rollers, constant, 0.5 * self.clearance, np.cos(a), np.sin(a), self.preload]
        own += [0.5 * self.pitch_diameter, self.length, self.slices, len(self._rows)]
        return np.array([*own, *(value for row in self._rows for value in row)])

    def pressed_by(self, force: float) -> TaperedBearing:
        """The bearing with the preload that an axial force in N on a row gives."""
        constant, play, cosine, sine = self.parameters()[CONTACT : SINE + 1]
        delta = (force / (self.rollers * sine * constant)) ** 0.9
        return replace(self, preload=float((delta + cosine * play) / sine))

    def left_out(self) -> tuple[str, ...]:
        """What the rollers leave out."""
        return ("crowning of rollers, the rib that guides them, and play that differs between its ends",)

    def inside(self, d: Any, *, angle: float = 0.0, speed: float = 0.0) -> RollingLoads:
        """Loads and pressures of the rollers at displacements d (5,): deflections in the middle, pressures of the worst slice."""
        constant, play, cosine, sine, preload, radius = self.parameters()[CONTACT : ARM + 1]
        row, phi, place, side = self.places(angle, self._rows)
        psi = d[3] * np.sin(phi) - d[4] * np.cos(phi)
        arm = side * radius * sine - place * cosine
        across = cosine * (d[0] * np.cos(phi) + d[1] * np.sin(phi) - play)
        middle = across + sine * (side * d[2] + preload) + psi * arm
        x = self.length * ((np.arange(self.slices) + 0.5) / self.slices - 0.5)
        each = constant * np.maximum(middle[:, None] - psi[:, None] * x, 0.0) ** (10.0 / 9.0)
        load = each.mean(axis=1)
        gamma = self.roller_diameter * cosine / self.pitch_diameter
        inner, outer = line_pressure(each.max(axis=1), self.length, self.roller_diameter, gamma)
        at = np.where(load > 0.0, side * abs(self.contact_angle), 0.0)
        return RollingLoads(row, phi, at, load, middle, inner, outer)

    @classmethod
    def examples(cls) -> tuple[TaperedBearing, ...]:
        """One row with preload that turns, and a pair in O arrangement."""
        return (
            cls(17, 14e-3, 10e-3, 65e-3, 0.27, preload=40e-6, order=0.4, phase=0.2, slices=5),
            cls(17, 14e-3, 10e-3, 65e-3, 0.27, preload=10e-6, order=0.4, slices=5, arrangement="O", row_distance=0.03),
        )


@dataclass(frozen=True)
class SlicedRollers(TaperedBearing):
    """Cylindrical rollers whose loads vary along them as their rings tilt."""

    title: ClassVar[str] = "cylindrical roller bearing"

    def left_out(self) -> tuple[str, ...]:
        """What the rollers leave out."""
        return ("crowning of rollers, and ribs",)
