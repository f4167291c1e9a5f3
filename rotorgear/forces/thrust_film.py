"""Thrust bearing of sector pads, fixed with a taper and a land or tilting about a radius, by Reynolds' equation.

A pad reaches from r_i to r_o over the angle beta; its film is that of thrust_pressure.py. A fixed pad has the shape
delta (1 - u/b) up to the share b of its arc in the sense of rotation and is flat behind; b = 1 is a plain wedge. A tilting pad
turns about the radius through its pivot until the film has no moment about it, G_3 = 0, which small motions keep, so that

    Z_red = Z_rr - Z_r3 Z_3r / Z_33,   Z = K + i w C

at w = `whirl_ratio` times the speed (as in tilting_pads.py).

Pinkus and Sternlicht, Theory of Hydrodynamic Lubrication (1961), chs. 3 and 4.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, ClassVar

import numpy as np

from rotorgear.forces.inside import OilField
from rotorgear.forces.law import Linearised, parameter, refuse
from rotorgear.forces.oil_film import TURN, OilFilm
from rotorgear.forces.pad_fold import KEPT, doubts, fold_of
from rotorgear.forces.thrust_pressure import (
    ACROSS,
    ARC,
    AROUND,
    CLEARANCE,
    FIRST,
    INNER,
    LEAST,
    OUTER,
    PIVOT,
    VISCOSITY,
    force,
    gaps_at,
    leaning,
    pad_in_balance,
    schedule,
    sector_film,
)

_TAYLOR = 1000.0  # Reynolds' number rho omega r h / mu up to which films of thrust bearings are laminar


@dataclass(frozen=True)
class ThrustField(OilField):
    """The films in steady running, nodes of all pads one after the other.

    Attributes:
        side: +1 or -1, the sense of the push that the pad takes, (t,). radius: (j,) m.
    """

    told_as: ClassVar[str] = "thrust_film"

    side: np.ndarray
    radius: np.ndarray


@lru_cache(maxsize=64)
def _fold(
    pivot: float, arc: float, inner: float, around: int, across: int, least: float
) -> tuple[float, float, float, float]:
    """Parameters of the fold of a pad.

    Args:
        pivot: from the leading edge, as a share of the arc. inner: r_i/r_o. around, across: cells. least: of the parameters.
    """
    if pivot <= 0.5:
        return 0.0, 0.0, 0.0, 0.0
    p = np.zeros(FIRST)
    p[[VISCOSITY, INNER, OUTER, CLEARANCE, ARC, PIVOT, LEAST]] = 1.0, inner, 1.0, 1.0, arc, pivot, least
    p[[AROUND, ACROSS]] = around, across
    behind = (1.0 - pivot) * arc
    pressure = np.zeros((around - 1, across - 1))

    def moment(away: float, tilt: float) -> tuple[float, float, float]:
        G = np.zeros(4)
        K = np.zeros((4, 4))
        q = np.array([0.0, 0.0, away, tilt * (1.0 + away * np.cos(behind)) / np.sin(behind)])
        sector_film(p, 1.0, -pivot * arc, q, np.zeros(4), 0, 4, G, K, np.zeros((4, 4)), pressure)
        return G[3], K[3, 2] + K[3, 3] * tilt / np.tan(behind), K[3, 3]

    return fold_of(moment, 1.0 - least)


@dataclass(frozen=True)
class ThrustFilm(OilFilm):
    """Thrust bearing of sector pads: five displacements of the collar, of which those along x and y press on nothing."""

    title: ClassVar[str] = "thrust bearing"
    components: ClassVar[int] = 5
    grid: ClassVar[tuple[str, ...]] = ("around", "across")

    inner_radius: float = parameter("m", "inner radius r_i of the pads", above=0.0)
    outer_radius: float = parameter("m", "outer radius r_o of the pads", above=0.0)
    clearance: float = parameter("m", "gap c between collar and pads (land) with the shaft at 0", above=0.0)
    pads: int = parameter("", "number of pads of a side", 8, least=1, most=40)
    arc: float = parameter("rad", "extent of a pad", np.radians(38.0), above=0.0)
    at: float = parameter("rad", "angle of the middle of the first pad, from +x about +z", 0.0)
    taper: float = parameter("m", "depth delta of the taper at the leading edge of fixed pads", 0.0, least=0.0)
    taper_share: float = parameter("", "share b of the arc that the taper takes", 0.8, above=0.0, most=1.0)
    pivot: float = parameter(
        "",
        "place of the pivot in the arc of tilting pads, in the sense of rotation; -1: fixed pads",
        -1.0,
        least=-1.0,
        below=1.0,
    )
    acts: str = parameter("", "pushes of the shaft that it takes", "both", choices=("both", "+z", "-z"))
    whirl_ratio: float = parameter("", "frequency of small motions over the speed of the collar", 1.0, above=0.0)
    around: int = parameter("", "cells of the grid along a pad", 30, least=6, most=400)
    across: int = parameter("", "cells from the inner to the outer radius", 12, least=4, most=200)
    least: float = parameter("", "gap over c from which on the film is a wall", 0.02, above=0.0, below=1.0)
    moves: bool = parameter("", "whether tangents are those of small motions, not of slow ones", False)

    def check(self) -> None:
        """Pads fit on the collar, and fixed ones have a taper."""
        if not self.inner_radius < self.outer_radius:
            raise refuse(self, "inner_radius", "a radius below the outer one")
        if self.pads * self.arc > TURN * (1.0 + 1e-9):
            raise refuse(self, "arc", "pads that fit on the collar")
        if self.pivot < 0.0 and not self.taper:
            raise refuse(
                self, "taper", "a depth above 0 in fixed pads, or a pivot of tilting ones: flat pads carry nothing"
            )

    @property
    def extents(self) -> np.ndarray:
        """The clearance, over which pressures on both sides of the collar and around it change."""
        tilt = 1.0 / self.outer_radius
        return self.clearance * np.array([0.0, 0.0, 1.0, tilt, tilt])

    def functions(self) -> tuple[Any, Any]:
        """Return the compiled functions schedule and force."""
        return schedule, force

    def parameters(self) -> np.ndarray:
        """What the grid needs, then middle and side of each pad, and the fold of tilting ones."""
        sides = {"both": (1.0, -1.0), "+z": (1.0,), "-z": (-1.0,)}[self.acts]
        middles = self.at + TURN * np.arange(self.pads) / self.pads
        pivot = self.pivot if self.order >= 0.0 or self.pivot < 0.0 else 1.0 - self.pivot
        own = [self.viscosity, self.inner_radius, self.outer_radius, self.clearance, self.order, self.arc, self.taper]
        own += [self.taper_share, pivot, self.least, self.around, self.across, len(sides) * self.pads]
        # Pads that turn the other way have their other edge in front.
        share = max(self.pivot, 1.0 - self.pivot)
        size = self.inner_radius / self.outer_radius
        fold = _fold(share, self.arc, size, self.around, self.across, self.least) if self.pivot >= 0.0 else [0.0] * KEPT
        return np.array([*own, *(value for side in sides for t in middles for value in (t, side)), *fold])

    def rough(self) -> ThrustFilm:
        """The same on a grid that knows the stiffness to some 10 %."""
        return replace(self, around=min(self.around, 10), across=min(self.across, 5))

    def settled(self, d: Any) -> ThrustFilm:
        """The bearing for small motions, whose pads follow at their frequency."""
        return replace(self, moves=True) if self.pivot >= 0.0 else self

    def left_out(self) -> tuple[str, ...]:
        """What the films leave out."""
        pads = ("tilt of pads across their radius, inertia, friction and elasticity of pads and pivots",)
        return (
            *(pads if self.pivot >= 0.0 else ()),
            f"{self.heat_left_out}, turbulence, and oil carried over from pad to pad",
        )

    def doubts(self, d: Any, speed: float) -> Iterator[tuple[str, str]]:
        """Flutter of pads without a film, and the other stable tilt of pads that the collar leans away from."""
        if self.pivot < 0.0:
            return
        p = self.parameters()
        sides: dict[float, list[tuple[int, bool, float]]] = {}
        for start, side, q, G, *_ in self._each_pad(d, speed):
            away = leaning(p, start + p[PIVOT] * self.arc, q)
            pads = sides.setdefault(side, [])
            pads.append((len(pads) + 1, bool(G[0] > 0.0), float(away)))
        for side, pads in sides.items():
            yield from doubts(pads, p[-KEPT:], f" for {side:+.0f}z".replace("1", "") if self.acts == "both" else "")

    def _each_pad(self, d: Any, speed: float) -> Iterator[tuple[Any, ...]]:
        """Of each pad its start, side, q, G, K and C, and pressure, with the collar at rest at displacements d (5,)."""
        p = self.parameters()
        for middle, side in p[FIRST:-KEPT].reshape(-1, 2):
            q = np.array([*(side * np.asarray(d, float)[2:]), 0.0])
            G = np.zeros(4)
            K = np.zeros((4, 4))
            C = np.zeros((4, 4))
            pressure = np.zeros((self.around - 1, self.across - 1))
            start = float(middle) - 0.5 * self.arc
            if self.pivot >= 0.0:
                pad_in_balance(p, self.order * speed, start, q, np.zeros(4), G, K, C, pressure, np.zeros((2, 3, 3)))
            else:
                sector_film(p, self.order * speed, start, q, np.zeros(4), 0, 3, G, K, C, pressure)
            yield start, side, q, G, K, C, pressure

    def linearised(self, d: Any = 0.0, v: Any = 0.0, *, speed: float = 0.0, points: int | None = None) -> Linearised:
        """Force and tangents; of the settled bearing those of motions at the whirl ratio, pads following."""
        omega = abs(self.whirl_ratio * self.order * speed)
        if not self.moves or omega == 0.0:
            return super().linearised(d, v, speed=speed, points=points)
        total = np.zeros(5)
        Z = np.zeros((5, 5), dtype=complex)
        for _, side, _, G, K, C, _ in self._each_pad(np.broadcast_to(np.asarray(d, float), 5), speed):
            z = K + 1j * omega * C
            # A pad that lies on its edge no longer turns.
            turns = z[3, 3] and abs(G[3]) <= 1e-6 * abs(G[0]) * self.outer_radius
            total[2:] += side * G[:3]
            Z[2:, 2:] += z[:3, :3] - (np.outer(z[:3, 3], z[3, :3]) / z[3, 3] if turns else 0.0)
        return Linearised(total, Z.real.copy(), Z.imag / omega)

    def _films(self, d: Any, speed: float) -> Iterator[tuple[float, np.ndarray, np.ndarray, np.ndarray]]:
        """Of each pad its side, angles (t,), gaps (t, j) and pressures (t, j) at the nodes, edges among them."""
        p = self.parameters()
        r = np.linspace(self.inner_radius, self.outer_radius, self.across + 1)
        for start, side, q, *_, inner in self._each_pad(d, speed):
            t = start + self.arc * np.arange(self.around + 1) / self.around
            yield side, t, gaps_at(p, self.order * speed, start, t, r, q)[0], np.pad(inner, 1)

    def beyond(self, d: Any, speed: float) -> str:
        """Heat, a gap that is too thin for the model, or a turbulent film."""
        if hot := self.too_hot():
            return hot
        smallest = min(float(h.min()) for _, _, h, _ in self._films(d, speed))
        if smallest <= self.least * self.clearance:
            return (
                f"the collar comes to {1e6 * smallest:.3g} um of its pads, where the film is too thin for this model (at least "
                f"{1e6 * self.least * self.clearance:.3g} um); check load, viscosity, pads and speed"
            )
        reynolds = self.density * abs(self.order * speed) * self.outer_radius * smallest / self.viscosity
        if reynolds > _TAYLOR:
            return (
                f"the film is turbulent (Reynolds' number {reynolds:.4g}, laminar up to {_TAYLOR:g}), which is not modelled; "
                "check viscosity and clearance"
            )
        return ""

    def inside(self, d: Any, *, angle: float = 0.0, speed: float = 0.0) -> ThrustField:
        """Pressure, gap, side flow and power loss of all pads with the collar at rest at displacements d (5,)."""
        from scipy.integrate import trapezoid  # here: models without a sheet or a heat balance don't load it

        omega = self.order * speed
        dr = (self.outer_radius - self.inner_radius) / self.across
        dt = self.arc / self.around
        r = self.inner_radius + dr * np.arange(self.across + 1)
        nodes = []
        flow = 0.0
        loss = 0.0
        for side, t, h, pressure in self._films(d, speed):
            # Slopes at both edges by a parabola through the edge and two nodes.
            low = (4.0 * pressure[:, 1] - pressure[:, 2]) / (2.0 * dr)
            high = (4.0 * pressure[:, -2] - pressure[:, -3]) / (2.0 * dr)
            leaves = r[0] * h[:, 0] ** 3 * low + r[-1] * h[:, -1] ** 3 * high
            flow += dt * float(np.sum(leaves)) / (12.0 * self.viscosity)
            shear = self.viscosity * omega * r / h + 0.5 * h * np.gradient(pressure, dt, axis=0) / r
            moment = trapezoid(trapezoid(shear * r * r, dx=dr, axis=1), dx=dt)
            loss += omega * moment
            nodes.append((np.full(t.size, side), t, h, pressure))
        sides, angles, gaps, fields = (np.concatenate(each) for each in zip(*nodes, strict=True))
        return ThrustField(angles, gaps, fields, flow, float(loss), sides, r)

    @classmethod
    def examples(cls) -> tuple[ThrustFilm, ...]:
        """Fixed pads on both sides, and tilting pads that take a push towards +z."""
        return (
            cls(0.02, 30e-3, 50e-3, 200e-6, pads=4, arc=1.2, taper=60e-6, around=10, across=5),
            cls(0.02, 30e-3, 50e-3, 200e-6, pads=4, arc=1.2, pivot=0.6, acts="+z", around=10, across=5),
        )
