"""Journal bearing of tilting pads: each pad turns about its pivot until the film has no moment about it.

With the pivot of a pad at the angle q, e_r = (cos q, sin q) and e_t = (-sin q, cos q), a tilt opens the gap by R tilt sin(t - q).
That is what the journal does when it moves along e_t, so that the film of a pad knows its tilt and the place of the journal by

    h = c_p - xi cos(t - q) - eta sin(t - q) - m c_p cos(t - q),   xi = d . e_r,   eta = d . e_t - R tilt

and the moment about the pivot is R F_t: pads rest where F_t(xi, eta) = 0, and push the journal along e_r alone. Small motions
exp(i w t) of a pad without inertia keep F_t = 0, so with Z = K + i w C in xi, eta (Lund, ASLE Trans. 7 (1964) 408)

    Z_red = Z_rr - Z_rt Z_tr / Z_tt,   K = sum Re Z_red e_r e_r^T,   C = sum Im Z_red / w e_r e_r^T

at w = `whirl_ratio` times the speed of the journal; 1: synchronous. The film of a pad is that of journal_pressure.py.

Pads whose pivot lies behind their middle keep a film where the journal has moved away, up to a fold, a = -(xi + m c_p)/c_p in
pad_fold.py.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, ClassVar

import numpy as np

from rotorgear.forces.inside import FilmField
from rotorgear.forces.journal_pressure import ALONG, AROUND, CUT, FIRST, PADS, PRELOAD, pad_film
from rotorgear.forces.law import Linearised, parameter, refuse
from rotorgear.forces.oil_film import TURN, JournalOil
from rotorgear.forces.pad_fold import KEPT, TILT_THERE, doubts, film_weight, fold_of, loaded_tilt
from rotorgear.forces.shell import (
    CLEARANCE,
    LENGTH,
    RADIUS,
    SPEED,
    VISCOSITY,
    WALL,
    add_wall,
    place_in_shell,
    schedule,
)
from rotorgear.solvers.time.compiled import compiled, force_function

_ITERATIONS = 60
# Of the clearance: the least gap that a tilt leaves at an edge.
_EDGE = 0.02
# Of the pad's force: a moment about the pivot over R that is none.
_LEVEL = 1e-12


@compiled
def pad_in_balance(p, omega, xi, v_xi, start, extent, pivot, F, K, C, pressure):  # type: ignore[no-untyped-def]
    """Of a pad in balance its force along e_r, the changes of that with xi and with v_xi as the pad follows, and eta.

    F (2,), K and C (4,) at this eta, in (e_r, e_t), and the pressure are filled. Near the fold they are weighted, and so is what
    the journal squeezes out of the film as it comes nearer to a pad on its other tilt.
    """
    c_pad = p[CLEARANCE] / (1.0 - p[PRELOAD])
    away = -(xi + p[PRELOAD] * c_pad) / c_pad
    at = FIRST + 3 * int(p[PADS])
    behind = extent - (pivot - start) if omega >= 0.0 else pivot - start
    slope = np.zeros(2)
    if away < 0.0 or behind >= 0.5 * extent:
        eta = tilted(p, omega, xi, v_xi, start, extent, pivot, False, F, K, C, pressure, slope)
        return F[0], K[0] + K[1] * slope[0], C[0] + K[1] * slope[1], eta
    weight, change = film_weight(p, at, away)
    force = 0.0
    stiff = 0.0
    damp = 0.0
    eta = 0.0
    if weight < 1.0 and (v_xi > 0.0 or weight == 0.0):
        eta = tilted(p, omega, xi, v_xi, start, extent, pivot, False, F, K, C, pressure, slope)
        force = (1.0 - weight) * F[0]
        stiff = (1.0 - weight) * (K[0] + K[1] * slope[0]) + change / c_pad * F[0]
        damp = (1.0 - weight) * (C[0] + K[1] * slope[1])
    if weight > 0.0:
        eta = tilted(p, omega, xi, v_xi, start, extent, pivot, True, F, K, C, pressure, slope)
        force += weight * F[0]
        stiff += weight * (K[0] + K[1] * slope[0]) - change / c_pad * F[0]
        damp += weight * (C[0] + K[1] * slope[1])
        F *= weight
        K *= weight
        C *= weight
        pressure *= weight
    return force, stiff, damp, eta


@compiled
def tilted(p, omega, xi, v_xi, start, extent, pivot, loaded, F, K, C, pressure, slope):  # type: ignore[no-untyped-def]
    """Tilt a pad until F_t = 0; fill its force and tangents in (e_r, e_t) and its pressure, and return eta.

    `loaded`: on the loaded tilt of a pad that the journal has moved away from; else from the level pad on. F (2,), K and C (4,),
    slope (2,): change of eta with xi and its velocity. A pad whose edge comes down to the least gap before F_t = 0 lies on that
    edge; one that nothing presses has no force.
    """
    around = int(p[AROUND])
    c_pad = p[CLEARANCE] / (1.0 - p[PRELOAD])
    away = -(xi + p[PRELOAD] * c_pad) / c_pad
    sense = 1.0 if omega >= 0.0 else -1.0
    # From the pivot to the trailing edge.
    behind = extent - (pivot - start) if sense > 0.0 else pivot - start
    slope[:] = 0.0
    if away >= 0.0 and v_xi <= 0.0 and not loaded:
        F[:] = 0.0
        K[:] = 0.0
        C[:] = 0.0
        pressure[:] = 0.0
        # The gap opens from the leading edge to the trailing one.
        return -sense * away * c_pad * np.tan(behind)
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
    eta = 0.0
    if loaded:
        at = FIRST + 3 * int(p[PADS])
        shut = sense * c_pad * (1.0 + away * np.cos(behind)) / np.sin(behind)
        eta = p[at + TILT_THERE] * shut
        below = 0.0
        if v_xi != 0.0:
            F[:] = 0.0
            pad_film(p, omega, xi, eta, v_xi, 0.0, start - pivot, extent, 0.0, F, K, C, pressure)
            below = sense * F[1]
        # A journal that moves fast may leave no loaded tilt: then the pad turns on from the one at the fold.
        if below <= 0.0:
            if sense > 0.0:
                low = eta
            else:
                high = eta
            eta = shut * loaded_tilt(p, at, away)
    if not low < eta < high:
        eta = 0.5 * (low + high)
    for _ in range(_ITERATIONS):
        F[:] = 0.0
        K[:] = 0.0
        C[:] = 0.0
        pad_film(p, omega, xi, eta, v_xi, 0.0, start - pivot, extent, 0.0, F, K, C, pressure)
        if (F[0] > 0.0 and abs(F[1]) <= _LEVEL * F[0]) or high - low < 1e-14 * c_pad:
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
    if most - eta < 1e-9 * c_pad:
        slope[0] = high_slope
    elif eta - least < 1e-9 * c_pad:
        slope[0] = low_slope
    else:
        slope[0] = -K[2] / K[3] if K[3] != 0.0 else 0.0
        slope[1] = -C[2] / K[3] if K[3] != 0.0 else 0.0
    return eta


@lru_cache(maxsize=64)
def _fold(
    pivot: float, arc: float, slenderness: float, around: int, along: int, cut: float
) -> tuple[float, float, float, float]:
    """Parameters of the fold of a pad.

    Args:
        pivot: from the leading edge, as a share of the arc. slenderness: L/R. around, along: cells. cut: of the parameters.
    """
    if pivot <= 0.5:
        return 0.0, 0.0, 0.0, 0.0
    p = np.zeros(FIRST)
    p[[VISCOSITY, RADIUS, LENGTH, CLEARANCE, AROUND, ALONG, CUT]] = 1.0, 1.0, slenderness, 1.0, around, along, cut
    behind = (1.0 - pivot) * arc
    pressure = np.zeros((around - 1, along))

    def moment(away: float, tilt: float) -> tuple[float, float, float]:
        F = np.zeros(2)
        K = np.zeros(4)
        eta = tilt * (1.0 + away * np.cos(behind)) / np.sin(behind)
        pad_film(p, 1.0, -away, eta, 0.0, 0.0, -pivot * arc, arc, 0.0, F, K, np.zeros(4), pressure)
        return F[1], -K[2] + K[3] * tilt / np.tan(behind), K[3]

    return fold_of(moment, 1.0 - _EDGE)


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
    pressure = np.zeros((int(p[AROUND]) - 1, int(p[ALONG])))
    for pad in range(int(p[PADS])):
        at = FIRST + 3 * pad
        c = np.cos(p[at + 2])
        n = np.sin(p[at + 2])
        xi = place.x * c + place.y * n
        v_xi = v[0] * c + v[1] * n
        force, stiff, damp, _ = pad_in_balance(
            p, omega, xi, v_xi, p[at], p[at + 1], p[at + 2], pad_F, pad_K, pad_C, pressure
        )
        if force <= 0.0:
            continue
        film[0] += force * c
        film[1] += force * n
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
        around = max(self.around // self.pads, 12)
        p = self.of_grid(around, False, pads)
        # Pads that turn the other way have their other edge in front.
        share = max(self.pivot, 1.0 - self.pivot)
        return np.array([*p, *_fold(share, self.arc, self.length / self.radius, around, self.along, float(p[CUT]))])

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

    def doubts(self, d: Any, speed: float) -> Iterator[tuple[str, str]]:
        """Flutter of pads without a film, and the other stable tilt of pads that the journal moved away from."""
        pads = enumerate(self._each_pad(np.asarray(d, float), speed), 1)
        told = (
            (k, bool(F[0] > 0.0), -float(e_r @ d) / self.pad_clearance - self.preload) for k, (_, _, e_r, F, *_) in pads
        )
        return doubts(told, self.parameters()[-KEPT:])

    def _each_pad(self, d: np.ndarray, speed: float) -> Iterator[tuple[Any, ...]]:
        """Of each pad start and pivot in rad, e_r (2,), force (2,), K and C (2, 2) in (e_r, e_t), eta, and pressure."""
        p = self.parameters()
        for start, extent, q in p[FIRST:-KEPT].reshape(-1, 3):
            e_r = np.array([np.cos(q), np.sin(q)])
            F = np.zeros(2)
            K = np.zeros((2, 2))
            C = np.zeros((2, 2))
            pressure = np.zeros((int(p[AROUND]) - 1, self.along))
            answer = (F, K.reshape(4), C.reshape(4), pressure)
            *_, eta = pad_in_balance(p, self.order * speed, float(e_r @ d), 0.0, start, extent, q, *answer)
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
