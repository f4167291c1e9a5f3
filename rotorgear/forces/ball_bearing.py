"""Ball bearing: Hertz contacts of Z balls that turn with the cage, clearance, and coupling of radial, axial and tilting motion.

Ball j is at phi_j = order * angle + phase + 2 pi j/Z. With the distance A = r_i + r_e - D_w of the groove centres at rest,
the inner one moves by

    u = x cos phi + y sin phi,   w = z + R_i (tx sin phi - ty cos phi)
    delta = sqrt((A cos a0 + u)^2 + (A sin a0 + w)^2) - A,   Q = c_p delta^(3/2) where delta > 0

and F is the gradient of the energy 2/5 c_p sum delta^(5/2), so that the law is conservative except for the motion
of the balls. The rings of a deep groove bearing are centred: A cos a0 = A - s/2, A sin a0 = 0.

Several rows share the bearing: row r is at l_r along the shaft and takes a push towards + or - z (sigma_r), with

    u = (x + l_r ty) cos phi + (y - l_r tx) sin phi,   A sin a0 -> sigma_r A sin a0

so that two rows make a pair in O arrangement, where the lines of contact meet the axis outside of the pair, in X or in tandem
(rolling.py). A four-point bearing has both sides in one place; each ball then presses across either diagonal by itself.

ISO/TS 16281:2008; de Mul, Vree and Maas, J. Tribology 111 (1989) 142.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np
from scipy.optimize import brentq

from rotorgear.forces.inside import RollingLoads
from rotorgear.forces.law import parameter, refuse
from rotorgear.forces.rolling import (
    CAGE,
    CAGE_SPEED,
    TURN,
    RollingElements,
    contact_ellipses,
    point_contact,
    point_pressure,
    rows_of,
    schedule,
)
from rotorgear.solvers.time.compiled import force_function

# Of the parameters behind those of the cage; then place and side of each row.
BALLS, CONTACT, DISTANCE, RADIAL, AXIAL, ARM, ROWS, FIRST = range(2, 10)


@force_function
def force(p, s, d, v, F, Kd, Kv, energy):  # type: ignore[no-untyped-def]
    """Forces along x, y, z and moments about x, y of the inner ring on the balls."""
    count = int(p[BALLS])
    cp = p[CONTACT]
    distance = p[DISTANCE]
    radial = p[RADIAL]
    arm = p[ARM]
    F[:] = 0.0
    Kd[:] = 0.0
    Kv[:] = 0.0
    stored = 0.0
    turned = 0.0
    loaded = 0.0
    g = np.zeros(5)
    a = np.zeros(5)
    b = np.zeros(5)
    for j in range(count * int(p[ROWS])):
        row = j // count
        along = p[FIRST + 2 * row]
        axial = p[FIRST + 2 * row + 1] * p[AXIAL]
        phi = s[CAGE] + TURN * j / count
        c = np.cos(phi)
        n = np.sin(phi)
        a[0] = c
        a[1] = n
        a[3] = -along * n
        a[4] = along * c
        b[2] = 1.0
        b[3] = arm * n
        b[4] = -arm * c
        u = radial + d[0] * c + d[1] * n - along * (d[3] * n - d[4] * c)
        w = axial + d[2] + arm * (d[3] * n - d[4] * c)
        length = np.sqrt(u * u + w * w)
        delta = length - distance
        if delta <= 0.0:
            continue
        loaded = 1.0
        root = np.sqrt(delta)
        Q = cp * delta * root
        slope = 1.5 * cp * root
        cosine = u / length
        sine = w / length
        for i in range(5):
            g[i] = cosine * a[i] + sine * b[i]
            F[i] += Q * g[i]
        for i in range(5):
            for k in range(5):
                across = (cosine * b[i] - sine * a[i]) * (cosine * b[k] - sine * a[k]) / length
                Kd[5 * i + k] += slope * g[i] * g[k] + Q * across
        stored += 0.4 * cp * delta * delta * root
        du = -d[0] * n + d[1] * c - along * (d[3] * c + d[4] * n)
        dw = arm * (d[3] * c + d[4] * n)
        turned += Q * (cosine * du + sine * dw) * s[CAGE_SPEED]
    energy[:] = stored, turned, 0.0, loaded


@dataclass(frozen=True)
class BallBearing(RollingElements):
    """Ball bearing of one or two rows, or of four points."""

    title: ClassVar[str] = "ball bearing"

    balls: int = parameter("", "number of balls Z", least=3)
    ball_diameter: float = parameter("m", "diameter D_w of a ball", above=0.0)
    pitch_diameter: float = parameter("m", "pitch diameter D_pw", above=0.0)
    inner_groove: float = parameter("", "groove radius of the inner ring over D_w", 0.52, above=0.5)
    outer_groove: float = parameter("", "groove radius of the outer ring over D_w", 0.53, above=0.5)
    contact_angle: float = parameter(
        "rad", "free contact angle of an angular contact bearing; its sign is that of the axial load it takes", 0.0
    )
    youngs_modulus: float = parameter("Pa", "of balls and rings", 210e9, above=0.0)
    poisson_ratio: float = parameter("", "of balls and rings", 0.3, above=-1.0, below=0.5)
    contact: float = parameter(
        "N/m^1.5",
        "c_p, load over deflection^(3/2) of a ball between both raceways; 0: by Hertz from the geometry",
        0.0,
        least=0.0,
    )
    preload: float = parameter(
        "m", "displacement along z by which the rings are pressed together when the shaft is at 0; with a sign", 0.0
    )
    arrangement: str = parameter(
        "", "rows and the sides that they press to", "single", choices=("single", "O", "X", "tandem", "four-point")
    )
    row_distance: float = parameter("m", "distance of the two rows of a pair", 0.0, least=0.0)

    def check(self) -> None:
        """Balls fit into the bearing, and the clearance into the grooves."""
        if not self.ball_diameter < self.pitch_diameter:
            raise refuse(self, "ball_diameter", "a diameter below the pitch diameter")
        if self.arrangement != "single" and not self.contact_angle > 0.0:
            raise refuse(self, "contact_angle", "above 0 where rows press to both sides or together")
        if not self.clearance < 2.0 * self.distance:
            raise refuse(self, "clearance", "less than what parts the grooves")

    @property
    def elements(self) -> int:
        """Z."""
        return self.balls

    @property
    def distance(self) -> float:
        """A: distance of the groove centres in m."""
        return (self.inner_groove + self.outer_groove - 1.0) * self.ball_diameter

    @property
    def extents(self) -> np.ndarray:
        """A along x, y, z, and what moves a ball as far by tilting: a deflection is the difference of two lengths A."""
        tilt = 2.0 * self.distance / self.pitch_diameter
        return np.array([self.distance] * 3 + [tilt] * 2)

    @property
    def contact_constant(self) -> float:
        """c_p in N/m^1.5, as given or by Hertz."""
        return self.contact or point_contact(self._ellipses, self._modulus)

    @property
    def _ellipses(self) -> Iterator[tuple[float, float]]:
        D = self.ball_diameter
        grooves = self.inner_groove * D, self.outer_groove * D
        return contact_ellipses(D, self.pitch_diameter, *grooves, self.contact_angle)

    @property
    def _modulus(self) -> float:
        """E'."""
        return self.youngs_modulus / (1.0 - self.poisson_ratio**2)

    def functions(self) -> tuple[Any, Any]:
        """Return the compiled functions schedule and force."""
        return schedule, force

    def parameters(self) -> np.ndarray:
        """Order, phase, Z, c_p, A, A cos a0, A sin a0, R_i, number of rows, and place and side of each."""
        A = self.distance
        a0 = self.contact_angle
        radial = A * np.cos(a0) - 0.5 * self.clearance
        axial = A * np.sin(a0)
        arm = 0.5 * self.pitch_diameter + (self.inner_groove - 0.5) * self.ball_diameter * radial / A
        rows = rows_of(self.arrangement, self.row_distance)
        cage = [self.order, self.phase, self.balls]
        own = [self.contact_constant, A, radial, axial + self.preload, arm, len(rows)]
        return np.array([*cage, *own, *(value for row in rows for value in row)])

    def pressed_by(self, force: float) -> BallBearing:
        """The bearing with the preload that an axial force in N on a row gives."""
        A = self.distance
        radial = self.parameters()[RADIAL]
        axial = A * np.sin(self.contact_angle)
        side = -1.0 if self.contact_angle < 0.0 else 1.0

        def rest(z: float) -> float:
            length = np.hypot(radial, axial + side * z)
            load = self.balls * self.contact_constant * max(length - A, 0.0) ** 1.5
            return float(load * abs(axial + side * z) / length - force)

        return replace(self, preload=side * float(brentq(rest, 0.0, 2.0 * A, xtol=1e-16)))

    def inside(self, d: Any, *, angle: float = 0.0, speed: float = 0.0) -> RollingLoads:
        """Loads, contact angles and pressures of the balls at displacements d (5,), with the cage where it is at an angle."""
        A, radial, axial, arm = self.parameters()[DISTANCE:ROWS]
        row, phi, place, side = self.places(angle, rows_of(self.arrangement, self.row_distance))
        c = np.cos(phi)
        n = np.sin(phi)
        tilt = n * d[3] - c * d[4]
        across = radial + d[0] * c + d[1] * n - place * tilt
        along = side * axial + d[2] + arm * tilt
        delta = np.hypot(across, along) - A
        load = self.contact_constant * np.maximum(delta, 0.0) ** 1.5
        inner, outer = point_pressure(load, self._ellipses, self._modulus)
        return RollingLoads(row, phi, np.where(delta > 0.0, np.arctan2(along, across), 0.0), load, delta, inner, outer)

    @classmethod
    def examples(cls) -> tuple[BallBearing, ...]:
        """A deep groove bearing with clearance that turns, an angular contact bearing, a pair, and one of four points."""
        return (
            cls(7, 11.5e-3, 43.5e-3, clearance=10e-6, order=0.4, phase=0.2),
            cls(12, 14e-3, 77e-3, contact_angle=0.44, order=0.4),
            cls(12, 14e-3, 77e-3, contact_angle=0.44, order=0.4, preload=5e-6, arrangement="O", row_distance=0.022),
            cls(10, 14e-3, 77e-3, contact_angle=0.6, clearance=8e-6, order=0.4, arrangement="four-point"),
        )
