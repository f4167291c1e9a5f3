"""Tooth contact of one helix whose flanks tilt against each other: (F, M)(delta, tilt, u) from the maps of its loaded teeth.

    x = d_1 - e(p) - delta_0(u),     F = dW/dx + c k/k_0 (x' + z_e d_2'),     M = dW/d d_2 + z_e (F - dW/dx)

with the displacements d_1 in the middle of the face and d_2 = tilt (m/m, closing the flanks at larger z), p and u as in
`loaded_teeth.py`, k = d^2W/dx^2 and k_0 the stiffness at which the damping is c. The energy W(x, tilt, u) is a Hermite cubic in
the tilt between two of those for which the contact was solved, with its force and moment there: W_k and M_k are the integrals of
F_k and dM_k/dx over x. So F and M follow from one energy, at those tilts they are the contact's own, and both are nothing where
the teeth part. Beyond the first and the last tilt the moment stays as it is there. Damping acts at the place z_e of the face
where the stiffness of the mean state stands.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
from scipy.interpolate import PchipInterpolator

from rotorgear.forces.law import parameter, refuse
from rotorgear.forces.loaded_map import (
    ABOUT,
    BEGIN,
    E_NOW,
    E_RATE,
    FLANK_STATE,
    HARMONICS,
    LENGTH,
    MODE,
    NEAREST,
    PER_DEPTH,
    PER_K,
    RATE,
    ROW,
    ROWS,
    SERIES,
    SPACING,
    WEIGHT,
    C,
    LoadedMap,
    place_flank,
)
from rotorgear.forces.mesh_contact import DAMPINGS
from rotorgear.solvers.contact.gap_contact import curve_contact
from rotorgear.solvers.contact.kinds import PENETRATION
from rotorgear.solvers.lanes.columns import OWN_LAW, Column
from rotorgear.solvers.time.compiled import force_function, schedule_function

# Steps of x up to the largest load: half of those of a map without tilt, for there are as many maps as tilts.
STEPS = 192
# At each step of x of one tilt: force, tangent stiffness, energy, dM/dx and moment.
FORCE, TANGENT, ENERGY, LIFT, MOMENT = range(5)
NODE = 5
# Behind the rows stand the place z_e, the number of tilts, and these.
PLACE, TILTS, FIRST_TILT = range(3)


@schedule_function
def schedule(angle, speed, time, p, s):  # type: ignore[no-untyped-def]
    """Fill e + delta_0, its rate, and the rows of the map about the position."""
    place_flank(angle, speed, p, s)


@force_function
def force(p, s, d, v, F, Kd, Kv, energy):  # type: ignore[no-untyped-def]
    """Force and moment on the flanks, their tangents and energies."""
    own = SERIES + 2 * int(p[HARMONICS]) + int(p[ROWS]) * int(p[LENGTH])
    place = p[own + PLACE]
    last = int(p[own + TILTS]) - 1
    tilts = own + FIRST_TILT
    x = d[0] - s[E_NOW]
    rate = v[0] - s[E_RATE] + place * v[1]

    # Hermite's cubics of the tilt between two that are known, straight on outside: a of the energies, b of the moments.
    k = 0
    while k < last - 1 and d[1] > p[tilts + k + 1]:
        k += 1
    width = p[tilts + k + 1] - p[tilts + k]
    y = (d[1] - p[tilts + k]) / width
    inside = 1.0 if 0.0 <= y <= 1.0 else 0.0
    outside = 0.0 if inside > 0.0 else (y * width if y < 0.0 else (y - 1.0) * width)
    y = min(max(y, 0.0), 1.0)
    a_1 = y * y * (3.0 - 2.0 * y)
    a = (1.0 - a_1, a_1)
    b = (
        width * y * (1.0 - y) * (1.0 - y) + (outside if y == 0.0 else 0.0),
        width * y * y * (y - 1.0) + (outside if y == 1.0 else 0.0),
    )
    a_slope = (6.0 * y * (y - 1.0) / width, 6.0 * y * (1.0 - y) / width)
    b_slope = (1.0 + y * (3.0 * y - 4.0), y * (3.0 * y - 2.0))
    a_bend = (inside * (12.0 * y - 6.0) / width**2, inside * (6.0 - 12.0 * y) / width**2)
    b_bend = (inside * (6.0 * y - 4.0) / width, inside * (6.0 * y - 2.0) / width)

    depth = max(x, 0.0)
    h = p[SPACING]
    i = min(int(depth / h), STEPS - 1) if depth < STEPS * h else STEPS - 1
    past = depth - i * h
    elastic = 0.0
    moment = 0.0
    stiffness = 0.0
    coupling = 0.0
    against_tilt = 0.0
    carries = 0.0
    bend = 0.0
    turn = 0.0
    stored = 0.0
    driven = 0.0
    for row in range(NEAREST):
        about = ABOUT + ROW * row
        weight = s[about + WEIGHT]
        for side in range(2):
            at = int(s[about + BEGIN]) + 1 + NODE * ((k + side) * (STEPS + 1) + i)
            slope = (p[at + NODE + FORCE] - p[at + FORCE]) / h
            pushed = p[at + FORCE] + slope * past
            work = p[at + ENERGY] + p[at + FORCE] * past + 0.5 * slope * past * past
            lift_slope = (p[at + NODE + LIFT] - p[at + LIFT]) / h if past <= h else 0.0
            lift = p[at + LIFT] + lift_slope * past if past <= h else p[at + NODE + LIFT]
            turned = p[at + MOMENT] + p[at + LIFT] * past + 0.5 * lift_slope * past * past
            if past > h:
                turned = p[at + NODE + MOMENT] + lift * (past - h)
            steeper = (p[at + NODE + TANGENT] - p[at + TANGENT]) / h if past <= h else 0.0
            tangent = p[at + TANGENT] + steeper * past if past <= h else p[at + NODE + TANGENT]
            elastic += weight * (a[side] * pushed + b[side] * lift)
            stiffness += weight * (a[side] * slope + b[side] * lift_slope)
            moment += weight * (a_slope[side] * work + b_slope[side] * turned)
            coupling += weight * (a_slope[side] * pushed + b_slope[side] * lift)
            against_tilt += weight * (a_bend[side] * work + b_bend[side] * turned)
            carries += weight * a[side] * tangent
            bend += weight * a[side] * steeper
            turn += weight * a_slope[side] * tangent
            kept = a[side] * work + b[side] * turned
            stored += weight * kept
            driven += s[about + RATE] * kept
    damping = p[PER_K] * carries
    growth = p[PER_K] * bend
    growth_tilt = p[PER_K] * turn
    if int(p[MODE]) == PENETRATION:
        damping = p[C] * depth * p[PER_DEPTH]
        growth = p[C] * p[PER_DEPTH]
        growth_tilt = 0.0
    now = curve_contact(int(p[MODE]), elastic, stiffness, damping, growth, x, rate)
    holds = 1.0 if now.force != 0.0 else 0.0
    in_tilt = holds * (coupling + growth_tilt * rate)
    F[0] = now.force
    F[1] = moment + place * (now.force - elastic)
    Kd[0] = now.stiffness
    Kd[1] = in_tilt
    Kd[2] = coupling + place * (now.stiffness - stiffness)
    Kd[3] = against_tilt + place * (in_tilt - coupling)
    Kv[0] = now.damping
    Kv[1] = now.damping * place
    Kv[2] = now.damping * place
    Kv[3] = now.damping * place * place
    energy[0] = stored
    energy[1] = driven - now.force * s[E_RATE]
    energy[2] = now.resisted * rate
    energy[3] = now.side


@dataclass(frozen=True, eq=False)
class LoadedFace(LoadedMap):
    """Contact of one helix by the maps of its loaded teeth at several tilts of the flanks."""

    title: ClassVar[str] = "loaded teeth that tilt"
    conserves: ClassVar[bool] = True

    load: np.ndarray = parameter("N", "loads F_j along the flank normal, (l,), rising from 0")  # noqa: RUF009
    tilt: np.ndarray = parameter("m/m", "tilts (k,), rising, that close the flanks at larger z")  # noqa: RUF009
    approach: np.ndarray = parameter("m", "approach (k, p, l) under these loads at even positions over all periods")  # noqa: RUF009
    moment: np.ndarray = parameter("N m", "moment (k, p, l) about the middle of the face")  # noqa: RUF009
    stiffness: float = parameter("N/m", "stiffness k_0 of the mean state, at which the damping is c", above=0.0)
    place: float = parameter("m", "place z_e of that stiffness from the middle of the face", 0.0)
    tilt_stiffness: float = parameter(
        "N m", "stiffness of the mean state against a tilt about that place", 0.0, least=0.0
    )
    damping: float = parameter("N s/m", "damping coefficient c at the stiffness k_0", 0.0, least=0.0)
    contact_damping: str = parameter(
        "", "non-adhesive, adhesive or penetration", "non-adhesive", choices=tuple(DAMPINGS)
    )
    reference: float = parameter("m", "reference depth of penetration damping", 1e-6, above=0.0)
    order: float = parameter("rad/rad", "mesh phase for each radian of the reference", 0.0)
    phase: float = parameter("rad", "mesh phase p of the error at angle 0", 0.0)
    path_phase: float = parameter("rad", "mesh phase of the flanks' own contact at angle 0", 0.0)
    forward: int = parameter(
        "", "whether contact runs along the path as the map counts it: 1, or -1", 1, least=-1, most=1
    )
    periods: int = parameter("", "base pitches after which the map repeats", 1, least=1)
    error_mean: float = parameter("m", "constant part of e", 0.0)
    error_cos: tuple[float, ...] = parameter("m", "a_n of e(p)", ())
    error_sin: tuple[float, ...] = parameter("m", "b_n of e(p)", ())

    def __post_init__(self) -> None:
        """Take lists as arrays, as a model file gives them."""
        for name in ("load", "tilt", "approach", "moment"):
            object.__setattr__(self, name, np.asarray(getattr(self, name), dtype=float))
        super().__post_init__()

    def check(self) -> None:
        """Loads rise from 0, and so does the approach under them; two tilts at least, which rise."""
        if self.load[0] != 0.0 or np.any(np.diff(self.load) <= 0.0):
            raise refuse(self, "load", "loads that rise from 0")
        if self.tilt.ndim != 1 or len(self.tilt) < 2 or np.any(np.diff(self.tilt) <= 0.0):
            raise refuse(self, "tilt", "at least two tilts, rising")
        shape = self.approach.shape
        if shape[0] != len(self.tilt) or shape[2:] != self.load.shape or np.any(np.diff(self.approach, axis=2) <= 0.0):
            raise refuse(self, "approach", "for each tilt and position an approach that rises with the load")
        if self.moment.shape != shape:
            raise refuse(self, "moment", "a moment for each approach")

    @property
    def components(self) -> int:
        """Approach and tilt."""
        return 2

    def functions(self) -> tuple[Any, Any]:
        """Return the compiled functions schedule and force."""
        return schedule, force

    def state_size(self) -> int:
        """e + delta_0, its rate, and four rows with their weights and rates."""
        return FLANK_STATE

    @property
    def spacing(self) -> float:
        """Step of x in m: from the first touch to the largest load at any tilt, over STEPS."""
        return float((self.approach[:, :, -1].max(axis=0) - self.approach[:, :, 0].min(axis=0)).max()) / STEPS

    @cached_property
    def rows(self) -> np.ndarray:
        """The maps turned over, (p, 1 + 5 k (STEPS + 1)): delta_0, the first touch at any tilt, then all steps of x."""
        loads = self.loads_between()
        curve = PchipInterpolator(self.load, self.approach, axis=2)
        touch = self.approach[:, :, 0].min(axis=0)
        deflections = curve(loads) - touch[:, None]
        softness = np.maximum(curve(loads, 1), 1e-6 / self.stiffness)
        moments = PchipInterpolator(self.load, self.moment, axis=2)(loads)
        x = self.spacing * np.arange(STEPS + 1)
        found = np.zeros((self.approach.shape[1], 1 + NODE * len(self.tilt) * (STEPS + 1)))
        found[:, 0] = touch
        nodes = found[:, 1:].reshape(len(found), len(self.tilt), STEPS + 1, NODE)
        for k in range(len(self.tilt)):
            for i in range(len(found)):
                deflection = deflections[k, i]
                last = 1.0 / softness[k, i, -1]
                beyond = np.maximum(x - deflection[-1], 0.0)
                steady = (moments[k, i, -1] - moments[k, i, -2]) / (deflection[-1] - deflection[-2])
                nodes[i, k, :, FORCE] = np.interp(x, deflection, loads, left=0.0) + last * beyond
                nodes[i, k, :, TANGENT] = np.interp(x, deflection, 1.0 / softness[k, i], left=0.0)
                nodes[i, k, :, LIFT] = np.gradient(
                    np.interp(x, deflection, moments[k, i], left=0.0) + steady * beyond, self.spacing
                )
        nodes[:, :, 0] = 0.0
        for rate, whole in ((FORCE, ENERGY), (LIFT, MOMENT)):
            means = 0.5 * (nodes[:, :, 1:, rate] + nodes[:, :, :-1, rate])
            nodes[:, :, 1:, whole] = self.spacing * np.cumsum(means, axis=2)
        return found

    @cached_property
    def _parameters(self) -> np.ndarray:
        # Kept: statics over a cycle evaluate one law a thousand times, and the whole map is copied into them.
        return np.concatenate([self.of_the_map(), [self.place, len(self.tilt)], self.tilt])

    def parameters(self) -> np.ndarray:
        """Return those of the map, and the place and the tilts behind them."""
        return self._parameters

    def closed_stiffness(self) -> np.ndarray:
        """k_0 at its place, and what resists a tilt about it."""
        at = np.array([1.0, self.place])
        return self.stiffness * np.outer(at, at) + np.diag([0.0, self.tilt_stiffness])

    def reference_stiffness(self) -> np.ndarray:
        """That of the mean state."""
        return self.closed_stiffness()

    def reference_damping(self) -> np.ndarray:
        """c at its place, as with teeth that never part."""
        at = np.array([1.0, self.place])
        return (self.damping if self.contact_damping != "penetration" else 0.0) * np.outer(at, at)

    def mean(self) -> LoadedFace:
        """The same map at one position: mean approach and moment under each load and tilt."""
        return replace(
            self,
            approach=self.approach.mean(axis=1)[:, None],
            moment=self.moment.mean(axis=1)[:, None],
            periods=1,
            error_cos=(),
            error_sin=(),
        )

    def columns(self, speed: float = 1.0) -> tuple[Column, ...]:
        """By the compiled functions, one system at a time; contact is counted of the approach."""
        return (
            Column(OWN_LAW, stiffness=self.stiffness, damping=self.damping, counted=True),
            Column(OWN_LAW, stiffness=self.tilt_stiffness),
        )

    @classmethod
    def examples(cls) -> tuple[LoadedFace, ...]:
        """A line of springs over a face of 0.2 m that only push, and whose stiffness varies over the cycle."""
        width = 0.2
        stiffness = 3e8
        load = 1000.0 * np.concatenate([[0.0], np.geomspace(0.002, 40.0, 30)])
        tilt = np.linspace(-1.5e-4, 1.5e-4, 25)
        u = np.arange(32)[:, None] / 32
        k = stiffness * (1.0 + 0.2 * np.cos(2.0 * np.pi * u))
        gape = np.maximum(np.abs(tilt), 1e-9)[:, None, None] * width
        # The part a of the face that carries: all of it, or from the end that the tilt closes.
        part = width * np.minimum(np.sqrt(2.0 * load / (k * gape)), 1.0)
        approach = np.where(part < width, gape * (part / width - 0.5), load / k) + 1e-6 * np.sin(2.0 * np.pi * u)
        side = np.sign(tilt)[:, None, None]
        moment = np.where(part < width, load * side * (0.5 * width - part / 3.0), k * width * side * gape / 12.0)
        law = cls(
            load,
            tilt,
            approach,
            moment,
            stiffness,
            0.01,
            9e5,
            900.0,
            order=20.0,
            phase=0.3,
            path_phase=0.7,
            error_cos=(1e-6,),
        )
        return (
            law,
            replace(law, contact_damping="adhesive"),
            replace(law, contact_damping="penetration", reference=3e-6, forward=-1),
        )
