"""Tooth contact of one helix as its loaded teeth have it: F(delta, u) from a map over approach and position in the mesh cycle.

    x = d - e(p) - delta_0(u),     F = F(x, u) + c k_t(x, u)/k x',     k_t = dF/dx,     F = 0 for x <= 0
    p = order * angle + phase,     u = forward * (order * angle + path phase) / 2 pi

The map comes as approaches delta(F_j; u_i) under loads F_j from 0, all flanks, modifications, pitch errors and corners inside
(Ozguven and Houser, J. Sound Vib. 125 (1988) 71). It is turned over into forces at even steps of x, linear between these, and
smooth between positions: F rises with x, and a position has the given approach under each load. Above the largest load it goes
on along its tangent. The contact pushes only: teeth part by themselves. Coast flanks on the same line are a map F_coast(-d).
Damping goes with the stiffness that carries, from zero at first touch over one step of x: c is what it is at k. It never pulls
where `contact_damping` is non-adhesive; "penetration" is c x/reference (Hunt and Crossley, J. Applied Mechanics 42 (1975) 440).
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
    COAST,
    E_NOW,
    E_RATE,
    FLANK_STATE,
    MODE,
    NEAREST,
    PER_DEPTH,
    PER_K,
    RATE,
    ROW,
    SPACING,
    WEIGHT,
    C,
    LoadedMap,
    place_flank,
)
from rotorgear.forces.mesh_contact import DAMPINGS
from rotorgear.solvers.contact.gap_contact import curve_contact
from rotorgear.solvers.contact.kinds import PENETRATION
from rotorgear.solvers.lanes.columns import ERROR, OWN_LAW, SLOPE, STIFFNESS, TABLE_ROWS, Column
from rotorgear.solvers.time.compiled import compiled, force_function, schedule_function

# Steps of x up to the largest load. With half as many the curve of a helix in a loop, of 0.02 um on 9 um, was 2.4 % off, and is
# 0.3 % with these.
STEPS = 384
# A row: delta_0, then at each step of x the force, the tangent stiffness and the energy.
FORCE, TANGENT, ENERGY = range(3)
NODE = 3


@schedule_function
def schedule(angle, speed, time, p, s):  # type: ignore[no-untyped-def]
    """Fill the state of the working flanks, and that of the coast flanks behind it."""
    place_flank(angle, speed, p, s)
    coast = int(p[COAST])
    if coast > 0:
        place_flank(angle, speed, p[coast:], s[FLANK_STATE:])


@compiled(entry=False)
def press_flank(p, s, d, v):  # type: ignore[no-untyped-def]
    """Contact of one side of the teeth at its approach, its energy, and the power that the passing of the map puts in."""
    x = d - s[E_NOW]
    rate = v - s[E_RATE]
    depth = max(x, 0.0)
    h = p[SPACING]
    i = min(int(depth / h), STEPS - 1) if depth < STEPS * h else STEPS - 1
    past = depth - i * h
    elastic = 0.0
    stiffness = 0.0
    carries = 0.0
    bend = 0.0
    stored = 0.0
    driven = 0.0
    for k in range(NEAREST):
        about = ABOUT + ROW * k
        weight = s[about + WEIGHT]
        own = int(s[about + BEGIN]) + 1 + NODE * i
        slope = (p[own + NODE + FORCE] - p[own + FORCE]) / h
        turn = (p[own + NODE + TANGENT] - p[own + TANGENT]) / h if past <= h else 0.0
        elastic += weight * (p[own + FORCE] + slope * past)
        stiffness += weight * slope
        carries += weight * (p[own + TANGENT] + turn * past if past <= h else p[own + NODE + TANGENT])
        bend += weight * turn
        work = p[own + ENERGY] + p[own + FORCE] * past + 0.5 * slope * past * past
        stored += weight * work
        driven += s[about + RATE] * work
    damping = p[PER_K] * carries
    growth = p[PER_K] * bend
    if int(p[MODE]) == PENETRATION:
        damping = p[C] * depth * p[PER_DEPTH]
        growth = p[C] * p[PER_DEPTH]
    now = curve_contact(int(p[MODE]), elastic, stiffness, damping, growth, x, rate)
    return now, stored, driven


@force_function
def force(p, s, d, v, F, Kd, Kv, energy):  # type: ignore[no-untyped-def]
    """Force along the flank normal, positive where the working flanks are pressed; the coast flanks push the other way."""
    now, stored, driven = press_flank(p, s, d[0], v[0])
    F[0] = now.force
    Kd[0] = now.stiffness
    Kv[0] = now.damping
    energy[0] = stored
    energy[1] = driven - now.force * s[E_RATE]
    energy[2] = now.resisted * (v[0] - s[E_RATE])
    energy[3] = now.side
    coast = int(p[COAST])
    if coast > 0:
        behind = s[FLANK_STATE:]
        back, stored, driven = press_flank(p[coast:], behind, -d[0], -v[0])
        F[0] -= back.force
        Kd[0] += back.stiffness
        Kv[0] += back.damping
        energy[0] += stored
        energy[1] += driven - back.force * behind[E_RATE]
        energy[2] += back.resisted * (-v[0] - behind[E_RATE])
        energy[3] -= back.side


@dataclass(frozen=True, eq=False)
class LoadedTeeth(LoadedMap):
    """Contact of one helix by the map of its loaded teeth."""

    title: ClassVar[str] = "loaded teeth"
    conserves: ClassVar[bool] = True

    load: np.ndarray = parameter("N", "loads F_j along the flank normal, (l,), rising from 0")  # noqa: RUF009
    approach: np.ndarray = parameter("m", "approach (p, l) under these loads at even positions over all periods")  # noqa: RUF009
    stiffness: float = parameter("N/m", "stiffness k at which the damping is c", above=0.0)
    damping: float = parameter("N s/m", "damping coefficient c at the stiffness k", 0.0, least=0.0)
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
    coast: LoadedTeeth | None = parameter("", "the map of the coast flanks, which d < 0 presses", None)  # noqa: RUF009
    expanded: bool = parameter("", "whether solvers expand about k and c: not on a flank that is mostly open", True)

    def __post_init__(self) -> None:
        """Take lists as arrays, as a model file gives them."""
        object.__setattr__(self, "load", np.asarray(self.load, dtype=float))
        object.__setattr__(self, "approach", np.atleast_2d(np.asarray(self.approach, dtype=float)))
        super().__post_init__()

    def check(self) -> None:
        """Loads rise from 0, and so does the approach under them, at every position."""
        if self.load[0] != 0.0 or np.any(np.diff(self.load) <= 0.0):
            raise refuse(self, "load", "loads that rise from 0")
        if self.approach.shape[1:] != self.load.shape or np.any(np.diff(self.approach, axis=1) <= 0.0):
            raise refuse(self, "approach", "for each position an approach that rises with the load")

    def functions(self) -> tuple[Any, Any]:
        """Return the compiled functions schedule and force."""
        return schedule, force

    def state_size(self) -> int:
        """Of each side of the teeth: e + delta_0, its rate, and four rows with their weights and rates."""
        return FLANK_STATE * (1 if self.coast is None else 2)

    @property
    def spacing(self) -> float:
        """Step of x in m: the largest deflection under the largest load over STEPS."""
        return float((self.approach[:, -1] - self.approach[:, 0]).max()) / STEPS

    @cached_property
    def rows(self) -> np.ndarray:
        """The map turned over, (p, 1 + 3 (STEPS + 1)): delta_0, then force, tangent stiffness and energy at each step of x."""
        loads = self.loads_between()
        curve = PchipInterpolator(self.load, self.approach, axis=1)
        deflections = curve(loads) - self.approach[:, :1]
        softness = np.maximum(curve(loads, 1), 1e-6 / self.stiffness)
        x = self.spacing * np.arange(STEPS + 1)
        found = np.empty((len(self.approach), 1 + NODE * (STEPS + 1)))
        found[:, 0] = self.approach[:, 0]
        nodes = found[:, 1:].reshape(len(found), STEPS + 1, NODE)
        for i, (deflection, soft) in enumerate(zip(deflections, softness, strict=True)):
            last = 1.0 / soft[-1]
            nodes[i, :, FORCE] = np.interp(x, deflection, loads) + last * np.maximum(x - deflection[-1], 0.0)
            nodes[i, :, TANGENT] = np.interp(x, deflection, 1.0 / soft)
        nodes[:, 0, TANGENT] = 0.0
        means = 0.5 * (nodes[:, 1:, FORCE] + nodes[:, :-1, FORCE])
        nodes[:, 0, ENERGY] = 0.0
        nodes[:, 1:, ENERGY] = self.spacing * np.cumsum(means, axis=1)
        return found

    def parameters(self) -> np.ndarray:
        """Return those of the map, and those of the coast flanks behind them."""
        own = self.of_the_map()
        if self.coast is None:
            return own
        own[COAST] = len(own)
        return np.concatenate([own, self.coast.parameters()])

    def closed_stiffness(self) -> np.ndarray:
        """k."""
        return np.array([[self.stiffness]])

    def reference_stiffness(self) -> np.ndarray:
        """k; nothing for a flank that is mostly open."""
        return self.closed_stiffness() if self.expanded else np.zeros((1, 1))

    def reference_damping(self) -> np.ndarray:
        """c, as with teeth that never part."""
        return np.array([[self.damping if self.expanded and self.contact_damping != "penetration" else 0.0]])

    def mean(self) -> LoadedTeeth:
        """The same map at one position: the mean approach under each load, so that the mean force has the mean approach."""
        behind = self.coast and self.coast.mean()
        still = self.approach.mean(axis=0)[None]
        return replace(self, approach=still, periods=1, error_cos=(), error_sin=(), coast=behind)

    def columns(self, speed: float = 1.0) -> tuple[Column, ...]:
        """By the compiled functions, one system at a time; contact is counted."""
        gap = 0.0 if self.coast is None else self.coast.error_mean + float(self.coast.approach[:, 0].mean())
        return (Column(OWN_LAW, stiffness=self.stiffness, damping=self.damping, clearance=max(gap, 0.0), counted=True),)

    def table(self, angles: np.ndarray, states: np.ndarray, order: float) -> np.ndarray:
        """e + delta_0 and its slope over the sweep's time, which the statistics of the approach take."""
        found = np.zeros((len(angles), 1, TABLE_ROWS))
        found[:, 0, STIFFNESS] = 1.0
        found[:, 0, ERROR] = states[:, E_NOW]
        found[:, 0, SLOPE] = states[:, E_RATE] / order
        return found

    def table_key(self) -> bytes:
        """All that shapes delta_0 and e."""
        shape = (self.order, self.phase, self.path_phase, self.forward, self.periods, self.error_mean)
        return repr([*shape, self.error_cos, self.error_sin]).encode() + self.approach[:, 0].tobytes()

    @classmethod
    def examples(cls) -> tuple[LoadedTeeth, ...]:
        """A Hertzian pair whose stiffness varies, with each damping; one over two base pitches that runs the other way."""
        load = 1000.0 * np.array([0.0, 0.01, 0.03, 0.08, 0.15, 0.3, 0.6, 1.0, 1.6, 2.5, 5.0])
        turn = 2.0 * np.pi * np.arange(64)[:, None] / 64
        soft = (1.0 + 0.2 * np.cos(turn)) / 3e8
        approach = 2e-6 * np.sin(turn) + soft * load + 1e-6 * (load / 1000.0) ** 0.7
        ripple: dict[str, Any] = {"order": 20.0, "phase": 0.3, "path_phase": 0.7, "error_cos": (1e-6,)}
        return (
            cls(load, approach, 3e8, 900.0, **ripple),
            cls(load, approach, 3e8, 900.0, contact_damping="adhesive", **ripple),
            cls(load, approach, 3e8, 900.0, contact_damping="penetration", reference=3e-6, **ripple),
            replace(
                cls(load, approach, 3e8, 900.0, **ripple),
                coast=cls(load, approach, 3e8, 900.0, order=20.0, path_phase=0.2, error_mean=2e-5, error_cos=(-1e-6,)),
            ),
            cls(load, approach, 3e8, order=3.0, forward=-1, periods=2, error_mean=1e-6, error_sin=(0.0, 1e-6)),
        )
