"""A linear structure with local forces, the rotation that is prescribed to it, its state in time, and what integrators record.

M q'' + D q' + K q + B F(B^T q, B^T q', t) = f

Where planets go round with a carrier, their dofs are told at the directions of the pins at the start (system/planets.py), and
laws act where planets are: with the carrier at the angle a and the speed W, d = R(a) B^T q, d' = R(a) (B^T q' - W T B^T q), and
forces act as B R(a)^T F (kernel_sisters.py).
"""

from __future__ import annotations

from collections.abc import Callable
from copy import deepcopy
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Protocol

import numpy as np
import scipy.sparse as sp

from rotorgear.errors import AnalysisError
from rotorgear.solvers.time.arguments import Carried, Gathered, Kept, Sisters
from rotorgear.solvers.time.local_forces import LocalForces
from rotorgear.solvers.time.sisters import sisters_of, turned, turning_matrix
from rotorgear.solvers.time.statistics import blank_gathered


@dataclass(frozen=True)
class Rotation:
    """Speeds (k,) in rad/s at times (k,) in s; constant before the first and after the last."""

    times: np.ndarray
    speeds: np.ndarray

    @staticmethod
    def constant(speed: float) -> Rotation:
        """Return the rotation at one speed."""
        return Rotation(np.zeros(1), np.array([float(speed)]))

    def __post_init__(self) -> None:
        if self.times.size == 0 or self.times.size != self.speeds.size or np.any(np.diff(self.times) <= 0.0):
            raise AnalysisError("the speed over time needs rising times, with one speed each")

    @property
    def is_constant(self) -> bool:
        """Whether the speed never changes."""
        return bool(np.all(self.speeds == self.speeds[0]))

    @property
    def accelerations(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Times in s and the accelerations in rad/s^2 that hold from them on; none where the speed never changes."""
        if self.is_constant:
            return (), ()
        steps = np.diff(self.speeds) / np.diff(self.times)
        return tuple(map(float, self.times)), (*map(float, steps), 0.0)

    def acceleration(self, t: float) -> float:
        """Acceleration in rad/s^2 from a time on."""
        times, accelerations = self.accelerations
        k = int(np.searchsorted(times, t, side="right"))
        return accelerations[k - 1] if k else 0.0

    @property
    def angles(self) -> np.ndarray:
        """Angle in rad at each of the times, with 0 at time 0."""
        steps = 0.5 * (self.speeds[1:] + self.speeds[:-1]) * np.diff(self.times)
        return self.speeds[0] * self.times[0] + np.concatenate([[0.0], np.cumsum(steps)])

    @property
    def table(self) -> np.ndarray:
        """Times, speeds and angles, (3, k), as the compiled loops read them."""
        return np.array([self.times, self.speeds, self.angles], dtype=float)

    def speed(self, t: np.ndarray) -> np.ndarray:
        """Speed in rad/s at times (p,)."""
        return np.asarray(np.interp(t, self.times, self.speeds))

    def angle(self, t: np.ndarray) -> np.ndarray:
        """Angle in rad at times (p,)."""
        t = np.asarray(t, dtype=float)
        if self.times.size == 1:  # the most frequent case, and the same to the last bit
            return np.asarray(self.speeds[0] * self.times[0] + self.speeds[0] * (t - self.times[0]))
        i = np.clip(np.searchsorted(self.times, t, side="right") - 1, 0, self.times.size - 1)
        late = t - self.times[i]
        mean = 0.5 * (self.speeds[i] + self.speed(t))
        return np.asarray(self.angles[i] + np.where(t < self.times[0], self.speeds[0], mean) * late)


@dataclass(frozen=True)
class Observed:
    """p channels whose statistics are gathered at every step: Y_q q + Y_v v + Y_a a, rows (p, n), + Y_F F, rows (p, m)."""

    q: np.ndarray
    v: np.ndarray
    a: np.ndarray
    F: np.ndarray

    def plus(self, share: float, other: Observed) -> Observed:
        """The sum with a share of other rows."""
        return Observed(*(getattr(self, kind) + share * getattr(other, kind) for kind in "qvaF"))

    def values(self, q: np.ndarray, v: np.ndarray, a: np.ndarray, F: np.ndarray) -> np.ndarray:
        """Values (p,) of a state."""
        return np.asarray(self.q @ q + self.v @ v + self.a @ a + self.F @ F)


class Changes(Protocol):
    """What changes with the speed of the reference beside W G."""

    def at(self, speed: float, acceleration: float) -> tuple[sp.csc_array, np.ndarray]:
        """Stiffness (n, n) and constant load (n,) at a speed in rad/s and an acceleration in rad/s^2."""


@dataclass(frozen=True)
class LocalSystem:
    """n degrees of freedom with m local displacements d = B^T q, and p watched ones W^T q that no force acts on.

    Attributes:
        M, D, K: sparse (n, n): inertia, velocity terms without W G, stiffness, all without the local forces.
        B: sparse (n, m).
        forces: the laws.
        load: constant load f, (n,).
        rotation: prescribed rotation of the reference, which gives the laws their phases.
        G: gyroscopic matrix for unit speed of the reference; None where nothing gyrates.
        watched: W (n, p): displacements whose statistics at all steps are kept; none where it is None.
        observed: channels, the same; none where it is None.
        sisters: of planets that go round, among the local displacements; seen_sisters: the same, among watched displacements and
            channels in a row.
        changes: of K and load with the speed, where these are those of a moment; None where nothing but W G changes.
        rates: what `observed` grows by with the speed and with its square, where that is of a moment, too.
    """

    M: sp.csc_array
    D: sp.csc_array
    K: sp.csc_array
    B: sp.csc_array
    forces: LocalForces
    load: np.ndarray
    rotation: Rotation
    G: sp.csc_array | None = None
    watched: np.ndarray | None = None
    observed: Observed | None = None
    sisters: Sisters = field(default_factory=sisters_of)
    seen_sisters: Sisters = field(default_factory=sisters_of)
    changes: Changes | None = None
    rates: tuple[Observed, Observed] | None = None

    def at_time(self, start: float, end: float | None = None) -> LocalSystem:
        """The system at the mean speed and acceleration from `start` to `end` in s, by default at the start."""
        if self.changes is None:
            return self
        ends = self.rotation.speed(np.array([start, start if end is None else end]))
        speed = float(ends.mean())
        acceleration = self.rotation.acceleration(start) if end is None else float(ends[1] - ends[0]) / (end - start)
        K, load = self.changes.at(speed, acceleration)
        observed = self.observed
        if observed is not None and self.rates is not None:
            by_speed, by_square = self.rates
            observed = observed.plus(speed, by_speed).plus(speed**2, by_square)
        return replace(self, K=K, load=load, observed=observed)

    @property
    def n(self) -> int:
        """Number of degrees of freedom."""
        return int(self.M.shape[0])

    @property
    def m(self) -> int:
        """Number of local displacements."""
        return self.forces.m

    @property
    def watched_vectors(self) -> np.ndarray:
        """Watched displacements, (n, p)."""
        return np.zeros((self.n, 0)) if self.watched is None else self.watched

    @property
    def observed_rows(self) -> Observed:
        """The channels."""
        nothing = np.zeros((0, self.n))
        return self.observed or Observed(nothing, nothing, nothing, np.zeros((0, self.m)))

    def gathered_values(self, q: np.ndarray, v: np.ndarray, a: np.ndarray, d: np.ndarray, F: np.ndarray) -> np.ndarray:
        """What statistics are gathered of: local forces and displacements, watched displacements, channels, (2 m + p,)."""
        return np.concatenate([F, d, self.watched_vectors.T @ q, self.observed_rows.values(q, v, a, F)])

    def local_motion(self, q: np.ndarray, v: np.ndarray, t: float) -> tuple[np.ndarray, np.ndarray]:
        """Local displacements and their rates, (m,) each, of a motion at a time."""
        d = np.asarray(self.B.T @ q, dtype=float)
        rate = np.asarray(self.B.T @ v, dtype=float)
        if not self.sisters.planets.size:
            return d, rate
        rate = rate - float(self.rotation.speed(np.array(t))) * turning_matrix(self.sisters, self.m) @ d
        d, rate = turned(self.sisters, np.full(2, self.rotation.angle(np.array(t))), np.array([d, rate]))
        return d, rate

    @property
    def going_round(self) -> tuple[Sisters | None, Sisters | None]:
        """Both sets of sisters as compiled loops take them: without any, the loops are compiled without a word of them."""
        return (self.sisters, self.seen_sisters) if self.sisters.planets.size else (None, None)

    def velocity_terms(self, speed: float) -> sp.csc_array:
        """D + W G at a speed of the reference, sparse (n, n)."""
        return self.D if self.G is None else sp.csc_array(self.D + speed * self.G)

    @cached_property
    def stiffness_about(self) -> sp.csc_array:
        """K with the local forces linear at their reference stiffness, sparse (n, n)."""
        return sp.csc_array(self.K + self.B @ sp.csc_array(self.forces.reference_stiffness) @ self.B.T)

    @cached_property
    def damping_about(self) -> sp.csc_array:
        """D with the local forces linear at their reference damping, sparse (n, n)."""
        return sp.csc_array(self.D + self.B @ sp.csc_array(self.forces.reference_damping) @ self.B.T)


@dataclass
class MotionState:
    """MotionState of a run after `step` steps: displacements, velocities, accelerations (n,), local forces (m,) and sums.

    `before` are the forces a step earlier; `d` (m,) the local displacements; `sums` (l, 2): energy put in and dissipated by
    each law, with half a step before the first for those that follow the trapezoidal rule; `events` (l, 4): steps, and parts of
    them, on the front side, without contact, on the back side, and contact losses; `gathered`: statistics of local forces and
    displacements, watched displacements and channels at all steps so far; `inner`: what else an integrator carries on.
    """

    step: int
    q: np.ndarray
    v: np.ndarray
    a: np.ndarray
    F: np.ndarray
    before: np.ndarray
    d: np.ndarray
    sums: np.ndarray
    last: np.ndarray
    events: np.ndarray
    gathered: Gathered
    inner: dict[str, np.ndarray] = field(default_factory=dict)

    @property
    def carried(self) -> Carried:
        """What the compiled loops change in place."""
        return Carried(*(getattr(self, name) for name in Carried._fields))

    @property
    def extremes(self) -> np.ndarray:
        """Least and largest of the local and the watched displacements at all steps so far, (m + p, 2), then of the channels."""
        return self.gathered.extremes[self.F.size :]

    def count_anew(self) -> None:
        """Forget events and statistics of the steps so far."""
        self.events[:] = 0
        self.gathered.sums[:] = 0.0
        self.gathered.extremes[:] = (np.inf, -np.inf)
        self.gathered.steps[:] = 0

    def copy(self) -> MotionState:
        """Return a copy with arrays of its own."""
        return deepcopy(self)


@dataclass(frozen=True)
class Records:
    """r recorded steps.

    Attributes:
        t: times (r,). d, F: local displacements and forces, (r, m). energy: of each law, (r, l, 3): stored, put in, dissipated.
        motion: arrays (r, ...) in the coordinates of the integrator, and product: gives rows of q, v and a of them.
        done: steps that were taken. status: 0, or what stopped the loop (-1 no convergence, -2 not finite).
        solutions: linear systems of m x m that were solved.
        system: with the matrices of these steps.
    """

    t: np.ndarray
    d: np.ndarray
    F: np.ndarray
    energy: np.ndarray
    motion: tuple[np.ndarray, ...]
    product: Callable[..., np.ndarray]
    done: int
    status: int
    solutions: int
    system: LocalSystem

    def rows(self, kind: str, Y: np.ndarray, which: np.ndarray | slice = slice(None)) -> np.ndarray:
        """Y q, Y v or Y a at the recorded steps, or at some of them, (r, p); `kind` is "q", "v" or "a"."""
        return self.product(kind, Y, *(array[which] for array in self.motion))


class Stepper:
    """An integrator made ready for one system and steps of h seconds; it records q, v and a unless it says otherwise."""

    def __init__(self, system: LocalSystem, h: float) -> None:
        self.system = system
        self.h = h

    def start(self, state: MotionState) -> None:
        """Take a state that another integrator, or the equilibrium, has left."""

    @property
    def sizes(self) -> tuple[int, ...]:
        """Of the arrays in which the motion is recorded."""
        return (self.system.n,) * 3

    def rows(self, kind: str, Y: np.ndarray, *motion: np.ndarray) -> np.ndarray:
        """Y q, Y v or Y a, (r, p), of a recorded motion; `kind` is "q", "v" or "a"."""
        return np.asarray(motion["qva".index(kind)] @ Y.T)

    def loop(self, state: MotionState, steps: int, every: int, kept: Kept) -> tuple[int, int, int]:
        """Advance a state in place and record; returns steps done, status and linear solutions, see `Records`."""
        raise NotImplementedError

    def advance(self, state: MotionState, steps: int, every: int) -> Records:
        """Advance a state in place by some steps and record every `every`-th."""
        r = steps // every
        m = self.system.m
        motion = tuple(np.zeros((r, size)) for size in self.sizes)
        kept = Kept(motion, np.zeros((r, m)), np.zeros((r, m)), np.zeros((r, len(self.system.forces.laws), 3)))
        done, status, solutions = self.loop(state, steps, every, kept)
        r = done // every
        t = (state.step + every * np.arange(1, r + 1)) * self.h
        state.step += done
        motion = tuple(array[:r] for array in motion)
        return Records(
            t, kept.d[:r], kept.F[:r], kept.energy[:r], motion, self.rows, done, status, solutions, self.system
        )


class Integrator(Protocol):
    """A method of integration."""

    @property
    def name(self) -> str:
        """What it is, in words."""

    @property
    def keeps_energy(self) -> bool:
        """Whether contacts that part can't bring energy in, whatever the step."""
        return True

    def damping_rows(self, system: LocalSystem, speed: float) -> np.ndarray:
        """Rows Y (b, n) of damping that the method has beside D: it dissipates |Y v|^2."""
        return np.zeros((0, system.n))

    def prepare(self, system: LocalSystem, h: float, speed: float, tolerance: float) -> Stepper:
        """Make ready for a system, a step in s and a speed of the reference in rad/s at which D + W G is taken."""


def evaluated(
    system: LocalSystem, d: np.ndarray, v: np.ndarray, t: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Forces (m,), tangents in d and v (flat blocks) and energies (4 l,) at local displacements, velocities and a time."""
    angle = float(system.rotation.angle(np.array(t)))
    speed = float(system.rotation.speed(np.array(t)))
    return system.forces.answer(angle, speed, t, d, v)


def local_values(system: LocalSystem, q: np.ndarray, v: np.ndarray, t: float) -> tuple[np.ndarray, np.ndarray]:
    """Local forces (m,) and energies (4 l,) of a motion at a time."""
    F, _, _, energy = evaluated(system, *system.local_motion(q, v, t), t)
    return F, energy


def local_tangent(system: LocalSystem, d: np.ndarray, t: float) -> tuple[np.ndarray, np.ndarray]:
    """Local forces (m,) at rest and their tangent (m, m) at local displacements and a time."""
    F, blocks, _, _ = evaluated(system, d, np.zeros(system.m), t)
    return F, system.forces.matrix(blocks)


def state_at_rest(system: LocalSystem, h: float, q: np.ndarray, v: np.ndarray | None = None) -> MotionState:
    """Return a consistent state at t = 0: M a = f - D v - K q - B F."""
    q = np.array(q, dtype=float)
    v = np.zeros(system.n) if v is None else np.array(v, dtype=float)
    F, energy = local_values(system, q, v, 0.0)
    D = system.velocity_terms(float(system.rotation.speeds[0]))
    a = acceleration(system.M, system.load - D @ v - system.K @ q - system.B @ F)
    powers = energy.reshape(-1, 4)
    d = np.asarray(system.B.T @ q, dtype=float)
    sums = 0.5 * h * powers[:, 1:3]
    last = powers[:, 3].astype(np.int64)
    events = np.zeros((len(powers), 4))
    gathered = blank_gathered(system.gathered_values(q, v, a, d, F))
    return MotionState(0, q, v, a, F, F.copy(), d, sums, last, events, gathered)


def acceleration(M: sp.csc_array, force: np.ndarray) -> np.ndarray:
    """Solve M a = force; dofs without inertia get no acceleration."""
    from rotorgear.solvers.sparse.factor import factor_general

    heavy = np.flatnonzero(M.diagonal() > 0.0)
    a = np.zeros(force.size)
    if heavy.size:
        a[heavy] = factor_general(sp.csc_array(M[heavy][:, heavy])).solve(force[heavy])
    return a


def contact_rates(M: sp.csc_array, B: np.ndarray, stiffness: np.ndarray) -> np.ndarray:
    """Rates (m,) in rad/s at which each local displacement alone would vibrate on the inertia it meets: sqrt(k b^T M^-1 b)."""
    k = np.diag(stiffness)
    squares = np.zeros(k.size)
    for j in np.flatnonzero(k > 0.0):
        column = np.ascontiguousarray(B[:, j])
        squares[j] = k[j] * float(column @ acceleration(M, column))
    return np.sqrt(squares)
