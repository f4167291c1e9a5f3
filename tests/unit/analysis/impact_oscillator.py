"""A pair of unequal gears that rattles, solved exactly: between two switches its motion is that of a linear oscillator.

    m d'' + 2 z w m d' + F(d) = F0 + Fa cos(W t),    F = k d for d > 0, 0 for -2b < d < 0, k (d + 2b) below

with d = r1 theta1 + r2 theta2, 1/m = r1^2/I1 + r2^2/I2 and w^2 = k/m. Torque T (1 + a cos) on the first gear makes F0 = T/r1 and
Fa = a m r1 T/I1. Pieces are closed forms, switches their roots, the periodic motion the fixed point of Newton's method on them,
and integrals those of Gauss over pieces: nothing of the package is used.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy.optimize

import rotorgear as rg

TEETH = 20
_RADII = (0.04, 0.09)
_INERTIAS = (6e-4, 1.7e-2)
_GAUSS = np.polynomial.legendre.leggauss(24)


@dataclass(frozen=True)
class ImpactOscillator:
    """Frequency ratio W/w, damping ratio z, ripple a of the torque, half backlash b in m, mean torque T in N m, k in N/m."""

    W: float
    z: float = 0.02
    ripple: float = 1.0
    half_backlash: float = 20e-6
    torque: float = 12.0
    stiffness: float = 9e7

    @property
    def mass(self) -> float:
        """m in kg."""
        return float(1.0 / sum(r**2 / inertia for r, inertia in zip(_RADII, _INERTIAS, strict=True)))

    @property
    def natural(self) -> float:
        """w in rad/s."""
        return float(np.sqrt(self.stiffness / self.mass))

    @property
    def period(self) -> float:
        """2 pi/W in s."""
        return 2.0 * np.pi / (self.W * self.natural)

    @property
    def amplitude(self) -> float:
        """Fa in N."""
        return self.ripple * self.mass * _RADII[0] * self.torque / _INERTIAS[0]

    def speed(self, W: float) -> float:
        """Speed in rad/s at which the ripple comes with W w."""
        return W * self.natural / TEETH

    def model(self) -> rg.Model:
        """The same as a model file."""
        gears = "".join(
            f"""
[shafts.{shaft}]

[gears.{gear}]
shaft = "{shaft}"
at = "start"
kind = "spur"
teeth = {round(TEETH * radius / _RADII[0])}
base_radius = {radius}
mass = 1.0
polar_inertia = {inertia}
diametral_inertia = {0.6 * inertia}
"""
            for shaft, gear, radius, inertia in zip("ab", ("pinion", "wheel"), _RADII, _INERTIAS, strict=True)
        )
        return rg.loads(f"""schema_version = 1
motions = ["torsion"]

[operation]
input_shaft = "a"
speed = {self.speed(self.W)!r}

[damping]
rayleigh_alpha = {2.0 * self.z * self.natural!r}

[loads.drive]
shaft = "a"
kind = "input"
torque = {self.torque!r}
ripple = {self.ripple!r}
ripple_order = {TEETH}

[loads.driven]
shaft = "b"
kind = "output"
{gears}
[meshes.pair]
pinion = "pinion"
gear = "wheel"
stiffness = {self.stiffness!r}
centre_line_angle = 0
pressure_angle = "20 deg"
backlash = {2.0 * self.half_backlash!r}
""")

    def linear(self) -> np.ndarray:
        """Statistics, as `exact` gives them, of the motion whose flanks never part: d = F0/k + Re X e^{iWt}."""
        mean = self.torque / _RADII[0]
        force = self.stiffness * abs(self._response(self.stiffness))
        way = 2.0 * force / self.stiffness
        return np.array([mean, force / np.sqrt(2.0), mean + force, mean - force, 0.0, 0.0, way, way])

    def exact(self, d: float, v: float) -> np.ndarray:
        """Statistics of the periodic motion next to the one that begins with d and v.

        Mean, root mean square about it, largest and smallest of F, shares apart and behind, and twice d peak to peak.
        """
        size = np.array([self.half_backlash, self.half_backlash * self.natural])
        y = np.array([d, v]) / size
        for _ in range(20):
            off = self._pieces(y * size)[-1].end / size - y
            ends = [
                [self._pieces((y + sign * e) * size)[-1].end / size for sign in (1.0, -1.0)] for e in 1e-6 * np.eye(2)
            ]
            slope = np.column_stack([(one - other) / 2e-6 for one, other in ends])
            y = y - np.linalg.solve(slope - np.eye(2), off)
            if np.abs(off).max() < 1e-11:
                return self._told(self._pieces(y * size))
        raise ValueError("no periodic motion near there")

    def _response(self, stiffness: float) -> complex:
        """X of the motion Re X e^{iWt} that the ripple makes."""
        w = 2.0 * np.pi / self.period
        c = 2.0 * self.z * self.natural * self.mass
        return self.amplitude / (stiffness - self.mass * w**2 + 1j * c * w)

    def _pieces(self, state: np.ndarray) -> list[Piece]:
        """The motion over a period from d and v."""
        t = 0.0
        d, v = state
        gap = -2.0 * self.half_backlash
        side = 1 if d > 0.0 else (-1 if d < gap else 0)
        found: list[Piece] = []
        while t < self.period and len(found) < 100:
            piece = Piece(self, side, t, d, v)
            grid = np.linspace(t, self.period, 2000)[1:]
            path = piece.at(grid)[0]
            low, high = {1: (0.0, np.inf), 0: (gap, 0.0), -1: (-np.inf, gap)}[side]
            past = np.flatnonzero((path < low) | (path > high))
            if not past.size:
                found.append(replace(piece, until=self.period))
                break
            i = past[0]
            bound = low if path[i] < low else high

            def away(s: float, piece: Piece = piece, bound: float = bound) -> float:
                return float(piece.at(np.array([s]))[0][0]) - bound

            after = grid[i - 1] if i else t + 1e-9 * self.period
            t = scipy.optimize.brentq(away, after, grid[i], xtol=1e-18, rtol=1e-15)
            found.append(replace(piece, until=t))
            d, v = bound, found[-1].end[1]
            side = 0 if side else (1 if bound == 0.0 else -1)
        return found

    def _told(self, pieces: list[Piece]) -> np.ndarray:
        T = self.period
        points = np.concatenate([np.linspace(p.begin, p.until, 40)[:-1] for p in pieces] + [[T]])
        low, high = points[:-1], points[1:]
        t = 0.5 * (low + high)[:, None] + 0.5 * (high - low)[:, None] * _GAUSS[0]
        weight = 0.5 * (high - low)[:, None] * _GAUSS[1] / T
        which = np.repeat(np.arange(len(pieces)), 39)
        F = np.array([pieces[i].force(own) for i, own in zip(which, t, strict=True)])
        mean = float((weight * F).sum())
        rms = float(np.sqrt((weight * (F - mean) ** 2).sum()))
        shares = [sum(p.until - p.begin for p in pieces if p.side == side) / T for side in (0, -1)]
        F_ends = [self._end(pieces, sign, forces=True) for sign in (1.0, -1.0)]
        way = self._end(pieces, 1.0, forces=False) - self._end(pieces, -1.0, forces=False)
        return np.array([mean, rms, *F_ends, *shares, way, way])

    def _end(self, pieces: list[Piece], sign: float, *, forces: bool) -> float:
        """Largest (sign 1) or least (-1) of F or d."""
        best = -np.inf
        for p in pieces:
            t = np.linspace(p.begin, p.until, 400)
            values = sign * (p.force(t) if forces else p.at(t)[0])
            i = int(values.argmax())
            around = (t[max(i - 1, 0)], t[min(i + 1, 399)])

            def less(s: float, p: Piece = p) -> float:
                at = np.array([s])
                return float(-sign * (p.force(at) if forces else p.at(at)[0])[0])

            found = scipy.optimize.minimize_scalar(
                less, bounds=around, method="bounded", options={"xatol": 1e-9 * self.period}
            )
            best = max(best, float(values[i]), -float(found.fun))
        return sign * best


@dataclass(frozen=True)
class Piece:
    """The motion on one side (1 in front, 0 apart, -1 behind) from a time, with d and v there, until another one."""

    of: ImpactOscillator
    side: int
    begin: float
    d: float
    v: float
    until: float = np.nan

    def at(self, t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """d and v at times."""
        of = self.of
        w = 2.0 * np.pi / of.period
        decay = of.z * of.natural
        mean = of.torque / _RADII[0]
        X = of._response(of.stiffness if self.side else 0.0)
        forced = [(X * (1j * w) ** k * np.exp(1j * w * t)).real for k in (0, 1)]
        begun = [float((X * (1j * w) ** k * np.exp(1j * w * self.begin)).real) for k in (0, 1)]
        s = t - self.begin
        if self.side:
            level = mean / of.stiffness - (0.0 if self.side > 0 else 2.0 * of.half_backlash)
            swing = of.natural * np.sqrt(1.0 - of.z**2)
            a = self.d - level - begun[0]
            b = (self.v - begun[1] + decay * a) / swing
            cos, sin, fall = np.cos(swing * s), np.sin(swing * s), np.exp(-decay * s)
            own = fall * (a * cos + b * sin)
            return level + own + forced[0], fall * swing * (b * cos - a * sin) - decay * own + forced[1]
        # Without a spring: m d'' + 2 z w m d' = F0 ends in a drift.
        drift = mean / (2.0 * decay * of.mass)
        rate = self.v - begun[1] - drift
        fall = np.exp(-2.0 * decay * s)
        return (
            self.d - begun[0] + drift * s - rate * np.expm1(-2.0 * decay * s) / (2.0 * decay) + forced[0],
            drift + rate * fall + forced[1],
        )

    def force(self, t: np.ndarray) -> np.ndarray:
        """F at times."""
        return (
            self.of.stiffness
            * (self.at(t)[0] + (2.0 * self.of.half_backlash if self.side < 0 else 0.0))
            * abs(self.side)
        )

    @property
    def end(self) -> np.ndarray:
        """d and v at its end."""
        return np.array(self.at(np.array([self.until]))).ravel()
