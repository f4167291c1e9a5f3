"""Reference integrator for small models: explicit Runge-Kutta of order 8 with its own step control (DOP853).

Its steps are far smaller than those of the others, because they follow the highest frequency of the structure; it
shares only the force laws with them, and so it checks them. Hairer, Norsett and Wanner, Solving Ordinary Differential
Equations I (Springer 1993), II.5.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg as la
from scipy.integrate import DOP853

from rotorgear.errors import AnalysisError
from rotorgear.solvers.sparse.factor import factor_general
from rotorgear.solvers.time.arguments import Kept
from rotorgear.solvers.time.local_system import Integrator, LocalSystem, MotionState, Stepper

MOST_DOFS = 600
# Evaluations of the forces that a run may take, at some 0.1 ms each and once more for the error estimate: a minute.
MOST_EVALUATIONS = 2e5
# Radians of the fastest motion that a step spans, and evaluations of the forces in it.
_RADIANS = 6.0
_STAGES = 12
_FINEST = 1e-13


@dataclass(frozen=True)
class Explicit(Integrator):
    """Dormand and Prince's method of order 8; `relative` is the tolerance of a step."""

    relative: float = 1e-11

    @property
    def name(self) -> str:
        """What it is, in words."""
        return f"explicit Runge-Kutta of order 8, tolerance {self.relative:.0e}"

    def prepare(self, system: LocalSystem, h: float, speed: float, tolerance: float = 1e-10) -> ExplicitStepper:
        """Factor the inertia.

        Raises:
            AnalysisError: a dof without inertia, or a model that is too large.
        """
        if np.any(system.M.diagonal() <= 0.0):
            raise AnalysisError("a degree of freedom has no inertia; the explicit integrator needs it: use newmark")
        if system.n > MOST_DOFS:
            raise AnalysisError(
                f"{system.n} dofs are too many for the explicit integrator (at most {MOST_DOFS}); use newmark"
            )
        return ExplicitStepper(system, h, speed, max(self.relative, _FINEST))


def check_length(system: LocalSystem, time: float) -> None:
    """Refuse a time in s that explicit steps would not come through.

    Raises:
        AnalysisError: with the frequency that makes the steps small.
    """
    if system.n > MOST_DOFS or np.any(system.M.diagonal() <= 0.0):
        return  # refused with their own sentences when the method is made ready
    squared = la.eigvalsh(system.K.toarray(), system.M.toarray(), subset_by_index=[system.n - 1, system.n - 1])[0]
    fastest = float(np.sqrt(max(squared, 0.0)))
    evaluations = _STAGES * time * fastest / _RADIANS
    if evaluations > MOST_EVALUATIONS:
        raise AnalysisError(
            f"{time:g} s would take about {evaluations:.1g} evaluations: explicit steps follow the fastest motion of the "
            f"structure, {fastest / (2.0 * np.pi):.3g} Hz; ask for less time, or use newmark"
        )


class ExplicitStepper(Stepper):
    """The method made ready for one system and speed; `h` is the time between the instants at which forces are recorded."""

    def __init__(self, system: LocalSystem, h: float, speed: float, relative: float) -> None:
        super().__init__(system, h)
        self._relative = relative
        self._rotation = system.rotation.table
        self._Bt = system.B.T.tocsr()
        self._laws = system.forces.arguments()
        factor = factor_general(system.M)
        dense = (system.K.toarray(), system.velocity_terms(speed).toarray(), system.B.toarray(), system.load[:, None])
        self._inverse = tuple(np.ascontiguousarray(factor.solve(A)) if A.size else A for A in dense)

    def _slope(self, t: float, y: np.ndarray) -> np.ndarray:
        n = self.system.n
        q = y[:n]
        v = y[n:]
        K, D, B, load = self._inverse
        F, _ = self._local_forces(q, v, t)
        return np.concatenate([v, load[:, 0] - K @ q - D @ v - B @ F])

    def _local_forces(self, q: np.ndarray, v: np.ndarray, t: float) -> tuple[np.ndarray, np.ndarray]:
        """Forces (m,) and energies (4 l,)."""
        from rotorgear.solvers.time.kernel_time import rotation_at

        angle, speed = rotation_at(t, self._rotation)
        F, _, _, energy = self.system.forces.answer(angle, speed, t, self._Bt @ q, self._Bt @ v)
        return F, energy

    def loop(self, state: MotionState, steps: int, every: int, kept: Kept) -> tuple[int, int, int]:
        """Advance a state in place and record; returns steps done, status and evaluations of the forces."""
        begin = state.step * self.h
        end = (state.step + steps) * self.h
        y = np.concatenate([state.q, state.v])
        solver = DOP853(self._slope, begin, y, end, rtol=self._relative, atol=self._relative * self._sizes(state))
        done = 0
        status = 0
        with np.errstate(all="ignore"):
            while solver.status == "running":
                solver.step()
                if solver.status == "failed" or not np.all(np.isfinite(solver.y)):
                    status = -2
                    break
                dense = solver.dense_output()
                while done < steps and (state.step + done + 1) * self.h <= solver.t * (1.0 + 1e-14):
                    done += 1
                    self._look(state, kept, done, every, dense((state.step + done) * self.h))
        return done, status, solver.nfev

    def _sizes(self, state: MotionState) -> np.ndarray:
        """Sizes (2n,) that errors of displacements and velocities are taken relative to."""
        s = self.system
        ratio = np.abs(s.stiffness_about.diagonal()) / s.M.diagonal()
        typical = float(np.sqrt(np.median(ratio[ratio > 0.0]))) if np.any(ratio > 0.0) else 1.0
        # Not less than a share of what the load does to the stiffest dof.
        stiffest = _size(s.stiffness_about.diagonal())
        far = max(_size(state.q), _size(s.load) / stiffest if stiffest else 0.0, 1e-12, _size(state.v) / typical)
        return np.concatenate([np.full(s.n, far), np.full(s.n, far * typical)])

    def _look(self, state: MotionState, kept: Kept, number: int, every: int, y: np.ndarray) -> None:
        """Take the state over after a step, with what forces did in it."""
        from rotorgear.solvers.time.kernel_events import take_account
        from rotorgear.solvers.time.kernel_time import gather, record_forces

        n = self.system.n
        t = (state.step + number) * self.h
        state.q[:] = y[:n]
        state.v[:] = y[n:]
        state.a[:] = self._slope(t, y)[n:]
        F, energy = self._local_forces(state.q, state.v, t)
        state.before[:] = state.F
        state.F[:] = F
        state.d[:] = self.system.B.T @ state.q
        take_account(self._laws, self._rotation, t, self.h, energy, state.d, state.carried)
        values = self.system.gathered_values(state.q, state.v, state.a, state.d, F)
        gather(state.gathered, values, F.size, False)
        if number % every == 0:
            r = number // every - 1
            for array, now in zip(kept.motion, (state.q, state.v, state.a), strict=True):
                array[r] = now
            record_forces(r, F, energy, 0.5 * self.h, state.carried, kept)


def _size(x: np.ndarray) -> float:
    return float(np.abs(x).max(initial=0.0))
