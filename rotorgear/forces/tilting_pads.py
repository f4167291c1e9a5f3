"""Journal bearing of tilting pads: each pad turns about its pivot until the film has no moment about it.

With the pivot of a pad at the angle q, e_r = (cos q, sin q) and e_t = (-sin q, cos q), a tilt opens the gap by R tilt sin(t - q).
That is what the journal does when it moves along e_t, so that the film of a pad knows its tilt and the place of the journal by

    h = c_p - xi cos(t - q) - eta sin(t - q) - m c_p cos(t - q),   xi = d . e_r,   eta = d . e_t - R tilt

and the moment about the pivot is R F_t: pads rest where F_t(xi, eta) = 0, and push the journal along e_r alone. Small motions
exp(i w t) of a pad without inertia keep F_t = 0, so with Z = K + i w C in xi, eta (Lund, ASLE Trans. 7 (1964) 408)

    Z_red = Z_rr - Z_rt Z_tr / Z_tt,   K = sum Re Z_red e_r e_r^T,   C = sum Im Z_red / w e_r e_r^T

at w = `whirl_ratio` times the speed of the journal; 1: synchronous. The film of a pad is that of journal_pressure.py.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np

from rotorgear.forces.inside import FilmField
from rotorgear.forces.journal_pressure import ALONG, AROUND, FIRST, PADS, PRELOAD, pad_film
from rotorgear.forces.law import Linearised, parameter, refuse
from rotorgear.forces.oil_film import TURN, JournalOil
from rotorgear.forces.shell import CLEARANCE, SPEED, WALL, add_wall, place_in_shell, schedule
from rotorgear.solvers.time.compiled import compiled, force_function

_ITERATIONS = 60
# Of the clearance: the least gap that a tilt leaves at an edge.
_EDGE = 0.02
# Of the pad's force: a moment about the pivot over R that is none.
_LEVEL = 1e-12


@compiled
def tilted(p, omega, xi, v_xi, start, extent, pivot, F, K, C, pressure, slope):  # type: ignore[no-untyped-def]
    """Tilt a pad until F_t = 0; fill its force and tangents in (e_r, e_t) and its pressure, and return eta.

    F (2,), K and C (4,), slope (2,): change of eta with xi and its velocity. A pad whose edge comes down to the least gap before
    F_t = 0 lies on that edge; one that nothing presses has no force.
    """
    around = int(p[AROUND])
    c_pad = p[CLEARANCE] / (1.0 - p[PRELOAD])
    low = -1e3 * c_pad
    high = 1e3 * c_pad
    low_slope = 0.0
    high_slope = 0.0
    for i in range(around + 1):
        t = start + extent * i / around - pivot
        room = c_pad - (xi + p[PRELOAD] * c_pad) * np.cos(t) - _EDGE * p[CLEARANCE]
        if np.sin(t) > 1e-12 and room / np.sin(t) < high:
            high = room / np.sin(t)
            high_slope = -np.cos(t) / np.sin(t)
        elif np.sin(t) < -1e-12 and room / np.sin(t) > low:
            low = room / np.sin(t)
            low_slope = -np.cos(t) / np.sin(t)
    most = high
    least = low
    eta = 0.0 if low < 0.0 < high else 0.5 * (low + high)
    sense = 1.0 if omega >= 0.0 else -1.0
    for _ in range(_ITERATIONS):
        F[:] = 0.0
        K[:] = 0.0
        C[:] = 0.0
        pad_film(p, omega, xi, eta, v_xi, 0.0, start - pivot, extent, 0.0, F, K, C, pressure)
        if abs(F[1]) <= _LEVEL * abs(F[0]) or high - low < 1e-14 * c_pad:
            break
        # More tilt presses the trailing edge, which lies at larger angles where the journal turns about +z.
        if F[1] > 0.0:
            high = eta
        elif F[1] < 0.0 or sense > 0.0:
            low = eta
        else:
            high = eta
        step = eta - F[1] / K[3] if K[3] != 0.0 else low
        eta = step if low < step < high else 0.5 * (low + high)
    slope[1] = 0.0
    if most - eta < 1e-9 * c_pad:
        slope[0] = high_slope
    elif eta - least < 1e-9 * c_pad:
        slope[0] = low_slope
    else:
        slope[0] = -K[2] / K[3] if K[3] != 0.0 else 0.0
        slope[1] = -C[2] / K[3] if K[3] != 0.0 else 0.0
    return eta


@force_function
def force(p, s, d, v, F, Kd, Kv, energy):  # type: ignore[no-untyped-def]
    """Force of the journal on its pads and the shell; pads follow its place, and squeeze no oil as they turn."""
    place = place_in_shell(d, p)
    omega = s[SPEED]
    film = np.zeros(2)
    k = np.zeros(4)
    Kv[:] = 0.0
    pad_F = np.zeros(2)
    pad_K = np.zeros(4)
    pad_C = np.zeros(4)
    slope = np.zeros(2)
    pressure = np.zeros((int(p[AROUND]) - 1, int(p[ALONG])))
    for pad in range(int(p[PADS])):
        at = FIRST + 3 * pad
        c = np.cos(p[at + 2])
        n = np.sin(p[at + 2])
        xi = place.x * c + place.y * n
        v_xi = v[0] * c + v[1] * n
        tilted(p, omega, xi, v_xi, p[at], p[at + 1], p[at + 2], pad_F, pad_K, pad_C, pressure, slope)
        if pad_F[0] <= 0.0:
            continue
        stiff = pad_K[0] + pad_K[1] * slope[0]
        damp = pad_C[0] + pad_K[1] * slope[1]
        film[0] += pad_F[0] * c
        film[1] += pad_F[0] * n
        k[0] += stiff * c * c
        k[1] += stiff * c * n
        k[2] += stiff * c * n
        k[3] += stiff * n * n
        Kv[0] += damp * c * c
        Kv[1] += damp * c * n
        Kv[2] += damp * c * n
        Kv[3] += damp * n * n
    stored = add_wall(d, place, p[WALL], film, k, F, Kd)
    energy[:] = stored, 0.0, film[0] * v[0] + film[1] * v[1], place.touches


@dataclass(frozen=True)
class TiltingPads(JournalOil):
    """Journal bearing of tilting pads without inertia, by Reynolds' equation on a grid."""

    title: ClassVar[str] = "tilting-pad journal bearing"

    pads: int = parameter("", "number of pads", 5, least=2, most=12)
    arc: float = parameter("rad", "extent of a pad", np.radians(60.0), above=0.0)
    at: float = parameter("rad", "angle of the first pivot, from +x about +z", 0.0)
    pivot: float = parameter("", "place of the pivot in the arc, in the sense of rotation", 0.5, above=0.0, below=1.0)
    whirl_ratio: float = parameter("", "frequency of small motions over the speed of the journal", 1.0, above=0.0)
    moves: bool = parameter("", "whether tangents are those of small motions, not of slow ones", False)

    def check(self) -> None:
        """Pads fit around the journal, and the bearing is not longer than the grid serves."""
        super().check()
        if self.pads * self.arc > TURN * (1.0 + 1e-9):
            raise refuse(self, "arc", "pads that fit around the journal")

    def functions(self) -> tuple[Any, Any]:
        """Return the compiled functions schedule and force."""
        return schedule, force

    def parameters(self) -> np.ndarray:
        """What the grid needs, then start, extent and pivot of each pad."""
        place = self.pivot if self.order >= 0.0 else 1.0 - self.pivot
        pivots = self.at + TURN * np.arange(self.pads) / self.pads
        pads = [(float(q) - place * self.arc, self.arc, float(q)) for q in pivots]
        return self.of_grid(max(self.around // self.pads, 12), False, pads)

    def rough(self) -> TiltingPads:
        """The same on a grid that knows the stiffness to some 10 %."""
        return replace(self, around=min(self.around, 12 * self.pads), along=min(self.along, 3))

    def settled(self, d: Any) -> TiltingPads:
        """The bearing for small motions, whose pads follow at their frequency."""
        return replace(self, moves=True)

    def left_out(self) -> tuple[str, ...]:
        """What the pads and their film leave out."""
        return (
            "inertia, friction and elasticity of pads and pivots",
            f"small motions at other than {self.whirl_ratio:g} times the speed: K and C are those of this whirl ratio",
            "in time: the oil that pads squeeze as they turn",
            f"{self.heat_left_out}, turbulence and tilt of the journal in its film",
        )

    def _each_pad(self, d: np.ndarray, speed: float) -> Iterator[tuple[Any, ...]]:
        """Of each pad start and pivot in rad, e_r (2,), force (2,), K and C (2, 2) in (e_r, e_t), eta, and pressure."""
        p = self.parameters()
        for start, extent, q in p[FIRST:].reshape(-1, 3):
            e_r = np.array([np.cos(q), np.sin(q)])
            F = np.zeros(2)
            K = np.zeros((2, 2))
            C = np.zeros((2, 2))
            pressure = np.zeros((int(p[AROUND]) - 1, self.along))
            answer = (F, K.reshape(4), C.reshape(4), pressure, np.zeros(2))
            eta = tilted(p, self.order * speed, float(e_r @ d), 0.0, start, extent, q, *answer)
            yield start, q, e_r, F, K, C, eta, pressure

    def linearised(self, d: Any = 0.0, v: Any = 0.0, *, speed: float = 0.0, points: int | None = None) -> Linearised:
        """Force and tangents; of the settled bearing those of motions at the whirl ratio, pads following."""
        omega = abs(self.whirl_ratio * self.order * speed)
        d = np.broadcast_to(np.asarray(d, float), 2)
        if not self.moves or omega == 0.0 or np.hypot(*d) > self.contact * self.clearance:
            return super().linearised(d, v, speed=speed, points=points)
        total = np.zeros(2)
        Z = np.zeros((2, 2), dtype=complex)
        for _, _, e_r, F, K, C, _, _ in self._each_pad(d, speed):
            if F[0] <= 0.0:
                continue
            z = K + 1j * omega * C
            reduced = z[0, 0] - z[0, 1] * z[1, 0] / z[1, 1] if z[1, 1] else z[0, 0]
            total += F[0] * e_r
            Z += reduced * np.outer(e_r, e_r)
        return Linearised(total, Z.real.copy(), Z.imag / omega)

    def inside(self, d: Any, *, angle: float = 0.0, speed: float = 0.0) -> FilmField:
        """Pressure, gap, side flow and power loss with the journal at rest at displacements d (2,)."""
        c_pad = self.pad_clearance
        pads = []
        for start, q, e_r, *_, eta, pressure in self._each_pad(np.asarray(d, float), speed):
            around = len(pressure) + 1
            t = start + self.arc * np.arange(1, around) / around
            h = c_pad - (float(e_r @ d) + self.preload * c_pad) * np.cos(t - q) - eta * np.sin(t - q)
            pads.append((t, h, pressure, self.arc))
        return self.film_field(pads, speed)

    @classmethod
    def examples(cls) -> tuple[TiltingPads, ...]:
        """Five pads with offset pivots, and four with preload."""
        return (
            cls(0.02, 25e-3, 25e-3, 50e-6, pivot=0.6, preload=0.2, around=60, along=3),
            cls(0.02, 25e-3, 25e-3, 50e-6, pads=4, arc=1.3, at=0.7, preload=0.4, around=60, along=3),
        )
