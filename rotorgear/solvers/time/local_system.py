"""A linear structure with local forces, the rotation that is prescribed to it, its state in time, and what integrators record.

M q'' + D q' + K q + B F(B^T q, B^T q', t) = f
"""

from __future__ import annotations

from copy import deepcopy
from dataclasses import dataclass, field
from functools import cached_property
from typing import Protocol

import numpy as np
import scipy.sparse as sp

from rotorgear.errors import AnalysisError
from rotorgear.solvers.time.arguments import Carried, Gathered, Kept
from rotorgear.solvers.time.local_forces import LocalForces
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

    @property
    def angles(self) -> np.ndarray:
        """Angle in rad at each of the times, with 0 at time 0."""
        steps = 0.5 * (self.speeds[1:] + self.speeds[:-1]) * np.diff(self.times)
        return self.speeds[0] * self.times[0] + np.concatenate([[0.0], np.cumsum(steps)])

    def speed(self, t: np.ndarray) -> np.ndarray:
        """Speed in rad/s at times (p,)."""
        return np.asarray(np.interp(t, self.times, self.speeds))

    def angle(self, t: np.ndarray) -> np.ndarray:
        """Angle in rad at times (p,)."""
        t = np.asarray(t, dtype=float)
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

    def values(self, q: np.ndarray, v: np.ndarray, a: np.ndarray, F: np.ndarray) -> np.ndarray:
        """Values (p,) of a state."""
        return np.asarray(self.q @ q + self.v @ v + self.a @ a + self.F @ F)


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
class State:
    """State of a run after `step` steps: displacements, velocities, accelerations (n,), local forces (m,) and sums.

    `before` are the forces a step earlier; `d` (m,) the local displacements; `sums` (l, 2): energy put in and dissipated by
    each law, with half a step before the first for those that follow the trapezoidal rule; `events` (l, 4): steps on the front
    side, without contact, on the back side, and contact losses; `gathered`: statistics of local forces and displacements,
    watched displacements and channels at all steps so far; `inner`: what else an integrator carries on.
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
        """What the local forces carry on, for the compiled loops to change in place."""
        return Carried(self.F, self.before, self.d, self.sums, self.last, self.events, self.gathered)

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

    def copy(self) -> State:
        """Return a copy with arrays of its own."""
        return deepcopy(self)


@dataclass(frozen=True)
class Records:
    """r recorded steps: time (r,), local d and F (r, m), energies of each law (r, l, 3): stored, put in, dissipated.

    `fields` gives rows of q, v and a. `status`: 0, or what stopped the loop (-1 no convergence, -2 not finite). `done`: steps
    that were taken. `solutions`: linear systems of m x m that were solved.
    """

    t: np.ndarray
    d: np.ndarray
    F: np.ndarray
    energy: np.ndarray
    fields: Fields
    done: int
    status: int = 0
    solutions: int = 0


class Fields(Protocol):
    """Motions of the recorded steps."""

    def rows(self, kind: str, Y: np.ndarray) -> np.ndarray:
        """Y q, Y v or Y a at the recorded steps, (r, p); `kind` is "q", "v" or "a"."""

    def chosen(self, which: np.ndarray) -> Fields:
        """Those of some records."""


@dataclass(frozen=True)
class PlainFields:
    """q, v and a of the recorded steps, (r, n)."""

    q: np.ndarray
    v: np.ndarray
    a: np.ndarray

    def rows(self, kind: str, Y: np.ndarray) -> np.ndarray:
        """Y q, Y v or Y a at the recorded steps, (r, p)."""
        return np.asarray(getattr(self, kind) @ Y.T)

    def chosen(self, which: np.ndarray) -> PlainFields:
        """Those of some records."""
        return PlainFields(self.q[which], self.v[which], self.a[which])


class Stepper(Protocol):
    """An integrator made ready for one system and one step."""

    h: float

    def start(self, state: State) -> None:
        """Take a state that another integrator, or the equilibrium, has left."""

    def advance(self, state: State, steps: int, every: int) -> Records:
        """Advance a state in place by some steps and record every `every`-th."""


class Integrator(Protocol):
    """A method of integration."""

    @property
    def name(self) -> str:
        """What it is, in words."""

    @property
    def keeps_energy(self) -> bool:
        """Whether contacts that part can't bring energy in, whatever the step."""

    def damping_rows(self, system: LocalSystem, speed: float) -> np.ndarray:
        """Rows Y (b, n) of damping that the method has beside D: it dissipates |Y v|^2."""

    def prepare(self, system: LocalSystem, h: float, speed: float, tolerance: float) -> Stepper:
        """Make ready for a system, a step in s and a speed of the reference in rad/s at which D + W G is taken."""


def evaluated(
    system: LocalSystem, d: np.ndarray, v: np.ndarray, t: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Forces (m,), tangents in d and v (flat blocks) and energies (4 l,) at local displacements, velocities and a time."""
    laws = system.forces
    angle = float(system.rotation.angle(np.array(t)))
    speed = float(system.rotation.speed(np.array(t)))
    F = np.zeros(laws.m)
    energy = np.zeros(4 * len(laws.laws))
    states = np.zeros(laws.state_first[-1])
    Kd = np.zeros(laws.block_first[-1])
    Kv = np.zeros(laws.block_first[-1])
    d = np.ascontiguousarray(d, dtype=float)
    v = np.ascontiguousarray(v, dtype=float)
    # Law by law: to hand all compiled functions over as one tuple costs a hundred times the evaluation.
    for i, kind in enumerate(laws.kind):
        rows = slice(laws.first[i], laws.first[i + 1])
        block = slice(laws.block_first[i], laws.block_first[i + 1])
        parameters = laws.parameters[laws.parameters_first[i] : laws.parameters_first[i + 1]]
        state = states[laws.state_first[i] : laws.state_first[i + 1]]
        laws.schedules[kind](angle, speed, t, parameters, state)
        laws.forces[kind](parameters, state, d[rows], v[rows], F[rows], Kd[block], Kv[block], energy[4 * i : 4 * i + 4])
    return F, Kd, Kv, energy


def local_values(system: LocalSystem, q: np.ndarray, v: np.ndarray, t: float) -> tuple[np.ndarray, np.ndarray]:
    """Local forces (m,) and energies (4 l,) of a motion at a time."""
    F, _, _, energy = evaluated(system, system.B.T @ q, system.B.T @ v, t)
    return F, energy


def local_tangent(system: LocalSystem, d: np.ndarray, t: float) -> tuple[np.ndarray, np.ndarray]:
    """Local forces (m,) at rest and their tangent (m, m) at local displacements and a time."""
    F, blocks, _, _ = evaluated(system, d, np.zeros(system.m), t)
    laws = system.forces
    K = np.zeros((system.m, system.m))
    for a, b, p, q in zip(laws.first[:-1], laws.first[1:], laws.block_first[:-1], laws.block_first[1:], strict=True):
        K[a:b, a:b] = blocks[p:q].reshape(b - a, b - a)
    return F, K


def state_at_rest(system: LocalSystem, h: float, q: np.ndarray, v: np.ndarray | None = None) -> State:
    """Return a consistent state at t = 0: M a = f - D v - K q - B F."""
    v = np.zeros(system.n) if v is None else np.asarray(v, dtype=float)
    F, energy = local_values(system, q, v, 0.0)
    D = system.velocity_terms(float(system.rotation.speeds[0]))
    a = acceleration(system.M, system.load - D @ v - system.K @ q - system.B @ F)
    laws = len(system.forces.laws)
    powers = energy.reshape(laws, 4)
    d = np.asarray(system.B.T @ q, dtype=float)
    return State(
        0,
        np.array(q, dtype=float),
        v.copy(),
        a,
        F,
        F.copy(),
        d,
        0.5 * h * powers[:, 1:3].copy(),
        powers[:, 3].astype(np.int64),
        np.zeros((laws, 4), dtype=np.int64),
        blank_gathered(system.gathered_values(q, v, a, d, F)),
    )


def acceleration(M: sp.csc_array, force: np.ndarray) -> np.ndarray:
    """Solve M a = force; dofs without inertia get no acceleration."""
    from rotorgear.solvers.sparse.factor import factor_general

    heavy = np.flatnonzero(M.diagonal() > 0.0)
    a = np.zeros(force.size)
    if heavy.size:
        a[heavy] = factor_general(sp.csc_array(M[heavy][:, heavy])).solve(force[heavy])
    return a


def contact_rates(system: LocalSystem) -> np.ndarray:
    """Rates (m,) in rad/s at which each local displacement alone would vibrate on the inertia it meets: sqrt(k b^T M^-1 b)."""
    k = np.diag(system.forces.reference_stiffness)
    squares = np.zeros(system.m)
    for j in np.flatnonzero(k > 0.0):
        column = system.B[:, [j]].toarray()[:, 0]
        squares[j] = k[j] * float(column @ acceleration(system.M, column))
    return np.sqrt(squares)


def blank_records(steps: int, every: int, n: int, system: LocalSystem) -> Kept:
    """Arrays for the records of some steps."""
    r = steps // every
    m = system.m
    laws = len(system.forces.laws)
    return Kept(
        q=np.zeros((r, n)),
        v=np.zeros((r, n)),
        a=np.zeros((r, n)),
        d=np.zeros((r, m)),
        F=np.zeros((r, m)),
        energy=np.zeros((r, laws, 3)),
    )
