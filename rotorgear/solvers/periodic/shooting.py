"""Periodic motions of small systems by shooting: phi_T(x) = x, with the derivative of the flow along it.

The flow and its derivative are integrated to a tolerance near rounding, steps end at every switch of a law, and the derivative
over a period is the monodromy matrix, whose eigenvalues are the Floquet multipliers. Seydel (2010), ch. 7.
"""

from __future__ import annotations

from copy import copy
from typing import NamedTuple

import numpy as np

from rotorgear.errors import ConvergenceError
from rotorgear.solvers.periodic.arclength import Linear
from rotorgear.solvers.periodic.floquet import basis_of, sorted_by_size
from rotorgear.solvers.periodic.harmonic_orbits import static_displacements
from rotorgear.solvers.periodic.plant import Plant, PlantAt
from rotorgear.solvers.periodic.samples import MotionCycle, answered, arguments_of, spectrum

# Relative tolerance of the flow and its derivative, and the one that tells its error: no less, for rounding.
TOLERANCE = 1e-11
_TIGHTER = 1e-13
_MOST_STEPS = 400_000
_DIFFERENCE = 1e-5
# Largest system, in coordinates, and steps in a base period that are asked for by its highest frequency.
MOST_COORDINATES = 6
MOST_RATIO = 200.0


class Small(NamedTuple):
    """M^-1 K / w^2 and so on of `kernel_shooting`; see there."""

    K: np.ndarray
    D: np.ndarray
    C: np.ndarray
    E: np.ndarray
    f: np.ndarray
    w: float
    speed: float


class ShootingOrbits:
    """Displacements and velocities at the begin of a period, over their scale, as unknowns; the parameter from 0 to 1.

    Motions that nothing holds in their place begin where they are at rest, and are there again after a period: what torques and
    the losses of laws such as friction lack on them on average is given by the drive.

    Args:
        plant_at: the plant at a value of the parameter. order: base periods in a turn of the reference.
        scale: local displacements (m,) that count as 1. harmonics, instants: of the cycles that are handed out.
        periods: how many base periods the motion takes.
    """

    method = "shooting"

    def __init__(
        self, plant_at: PlantAt, order: float, scale: np.ndarray, harmonics: int, instants: int, periods: int = 1
    ) -> None:
        self._plant_at = plant_at
        self.order = order
        self.scale = scale
        self.harmonics = harmonics
        self.instants = instants
        self.periods = periods
        self.tolerance = TOLERANCE
        first = plant_at(0.5)
        basis = basis_of(first, np.inf)
        self._V = basis.V
        self._unheld = basis.unheld
        moved = np.abs(first.B.T @ self._V)
        used = moved.max(axis=1) > 0.0
        self._size = float(np.median(scale[used] / moved[used].max(axis=1))) if np.any(used) else 1.0
        self._known: dict[tuple[bytes, float], np.ndarray] = {}

    @property
    def size(self) -> int:
        """Number of unknowns."""
        return 2 * int(self._V.shape[1])

    def prepare_at(self, p: float) -> None:
        """Nothing is approximated."""

    def _small(self, plant: Plant) -> Small:
        V = self._V
        w = self.order * abs(plant.speed)
        # The laws act whole: their reference is taken off again.
        laws = plant.forces
        B = V.T @ plant.B
        K = V.T @ (plant.K @ V) - B @ laws.reference_stiffness @ B.T
        D = V.T @ (plant.D @ V) - B @ laws.reference_damping @ B.T
        M = V.T @ (plant.M @ V)
        inverse = np.linalg.inv(M)
        s = self._size
        return Small(
            np.ascontiguousarray(inverse @ K / w**2),
            np.ascontiguousarray(inverse @ D / w),
            np.ascontiguousarray(inverse @ B / (s * w**2)),
            np.ascontiguousarray(s * B.T),
            inverse @ (V.T @ plant.load) / (s * w**2),
            w,
            plant.speed,
        )

    def _run(
        self, y: np.ndarray, p: float, outputs: np.ndarray, *, tangents: bool = False
    ) -> tuple[np.ndarray, np.ndarray]:
        """State at the end beside its tangents, (2 n, 1 + 2 n) or (2 n, 1), and the states at the outputs (r, 2 n)."""
        from rotorgear.solvers.periodic.kernel_shooting import flow

        plant = self._plant_at(p)
        x = np.column_stack([y, np.eye(self.size)]) if tangents else y[:, None].copy()
        kept = np.zeros((len(outputs), self.size))
        most = _MOST_STEPS * self.periods
        steps = flow(self._small(plant), arguments_of(plant.forces), x, outputs, self.tolerance, kept, most)
        if steps < 0 or not np.all(np.isfinite(x)):
            raise ConvergenceError("the motion over a period can't be integrated")
        return x, kept

    def _mapped(self, y: np.ndarray, p: float) -> np.ndarray:
        """The state after a period beside its derivative by the one at its begin, (2 n, 1 + 2 n)."""
        key = (y.tobytes(), p)
        if key not in self._known:
            if len(self._known) > 16:
                self._known.clear()
            self._known[key] = self._run(y, p, self._period, tangents=True)[0]
        return self._known[key]

    @property
    def _period(self) -> np.ndarray:
        return np.array([0.0, 2.0 * np.pi * self.periods])

    def residual(self, y: np.ndarray, p: float) -> np.ndarray:
        """phi_T(x) - x."""
        return self._closed(self._mapped(y, p)[:, 0] - y, y)

    def linear(self, y: np.ndarray, p: float) -> Linear:
        """The residual, its derivative by the unknowns, and the one by the parameter, by a central difference."""
        residual, in_y = self.values(y, p)
        before, after = (self._run(y, p + by, self._period)[0][:, 0] for by in (-_DIFFERENCE, _DIFFERENCE))
        slope = (after - before) / (2.0 * _DIFFERENCE)
        return Linear(residual, in_y, self._closed(slope, np.zeros(self.size)))

    def values(self, y: np.ndarray, p: float, *, smooth: bool = False) -> tuple[np.ndarray, np.ndarray]:
        """The residual and its derivative by the unknowns; `smooth` changes nothing, for nothing is approximated."""
        here = self._mapped(y, p)
        one = np.eye(self.size)
        return self._closed(here[:, 0] - y, y), self._closed(here[:, 1:] - one, one)

    def _closed(self, change: np.ndarray, begin: np.ndarray) -> np.ndarray:
        """The residual, or a derivative of it, from that of the change over a period, phi_T(x) - x, and of the begin x.

        Motions that nothing holds in their place begin at zero and end there: these conditions stand where that place and its
        rate would.
        """
        n = self._V.shape[1]
        closed = change.copy()
        closed[n : n + self._unheld] = change[: self._unheld]
        closed[: self._unheld] = begin[: self._unheld]
        return closed

    def along(self, plant_at: PlantAt) -> ShootingOrbits:
        """The same for other plants of the same structure."""
        other = copy(self)
        other._plant_at = plant_at
        other._known = {}
        return other

    def apart(self) -> ShootingOrbits:
        """The same without what was asked before."""
        return self.along(self._plant_at)

    def memory(self) -> dict[str, np.ndarray]:
        """What answers depend on, beside what is asked: nothing."""
        return {}

    def recall(self, memory: dict[str, np.ndarray]) -> None:
        """Go on as equations that have told this `memory`."""

    def finer(self) -> ShootingOrbits:
        """The same motions to a tighter tolerance, at twice the instants."""
        other = self.apart()
        other.tolerance = _TIGHTER
        other.instants = 2 * self.instants
        return other

    def lifted(self, y: np.ndarray, finer: ShootingOrbits) -> np.ndarray:
        """The unknowns of a motion in the finer equations: the same."""
        return y

    def multipliers(self, y: np.ndarray, p: float) -> np.ndarray:
        """Floquet multipliers of a solution, without those of 1 of motions that nothing holds in their place."""
        return sorted_by_size(np.linalg.eigvals(self._mapped(y, p)[self._unheld :, 1 + self._unheld :]))

    def start(self, p: float) -> np.ndarray:
        """Unknowns of the static state at a value."""
        plant = self._plant_at(p)
        static = plant.static
        d = static_displacements(plant)
        # q = q0 + X u with u from the laws at d.
        u = np.linalg.lstsq(static.R, d - static.d, rcond=None)[0]
        return self.from_motion(static.q + static.X @ u, np.zeros(len(static.q)), plant)

    def from_motion(self, q: np.ndarray, v: np.ndarray, plant: Plant) -> np.ndarray:
        """Unknowns of displacements and velocities (n,) at the begin of a period."""
        w = self.order * abs(plant.speed)
        rows = self._V.T @ (plant.M @ np.column_stack([q, v]))
        own = np.linalg.solve(self._V.T @ (plant.M @ self._V), rows)
        return np.concatenate([own[:, 0] / self._size, own[:, 1] / (self._size * w)])

    def state(self, y: np.ndarray, p: float) -> tuple[np.ndarray, np.ndarray]:
        """Displacements and velocities (n,) of a solution at the begin of its period."""
        n = self._V.shape[1]
        w = self.order * abs(self._plant_at(p).speed)
        return self._V @ (self._size * y[:n]), self._V @ (self._size * w * y[n:])

    def cycle(self, y: np.ndarray, p: float, instants: int | None = None) -> MotionCycle:
        """A period of a solution."""
        plant = self._plant_at(p)
        N = (instants or self.instants) * self.periods
        outputs = 2.0 * np.pi * self.periods * np.arange(N + 1) / N
        states = self._run(y, p, outputs)[1][:-1]
        n = self._V.shape[1]
        w = self.order * abs(plant.speed)
        q = self._size * states[:, :n]
        v = self._size * w * states[:, n:]
        E = self._V.T @ plant.B
        at = answered(outputs[:-1] / w, q @ E, v @ E, plant.forces, plant.speed)
        H = self.harmonics * self.periods
        return MotionCycle(
            2.0 * np.pi * self.periods / w,
            at,
            q @ (self._V.T @ plant.watched),
            v @ (self._V.T @ plant.watched),
            spectrum(at.d, H),
            spectrum(at.F, H),
        )

    def doubled(self) -> ShootingOrbits:
        """The same with twice the period."""
        return ShootingOrbits(self._plant_at, self.order, self.scale, self.harmonics, self.instants, 2 * self.periods)

    def twice(self, y: np.ndarray, other: ShootingOrbits) -> np.ndarray:
        """The unknowns of one motion in the equations of twice its period: the same state."""
        return y.copy()
