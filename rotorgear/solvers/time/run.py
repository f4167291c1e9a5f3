"""Runs an integrator in chunks: records go to a receiver chunk by chunk, and a run that is stopped keeps those it has."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from rotorgear.errors import ConvergenceError
from rotorgear.progress import Progress, silent
from rotorgear.solvers.time.local_system import Integrator, LocalSystem, MotionState, Records, Stepper

# Records in a chunk: large enough for fast products, small enough to stop and report often.
CHUNK = 512
# Change of the speed within a chunk of a run-up, relative to its largest, for which W G, and what carriers bring, is held.
_SPEED_CHANGE = 2e-3


@dataclass(frozen=True)
class Schedule:
    """Steps of a run: their size h in s, how many, and that every `every`-th is recorded."""

    h: float
    steps: int
    every: int = 1


Receiver = Callable[[Records, MotionState], None]


def run(
    system: LocalSystem,
    integrator: Integrator,
    schedule: Schedule,
    state: MotionState,
    receive: Receiver,
    *,
    tolerance: float = 1e-10,
    progress: Progress = silent,
) -> int:
    """Integrate from `state`, which is advanced in place, to the last step of the schedule.

    Returns:
        Linear systems of m x m that were solved.

    Raises:
        ConvergenceError: a step did not converge, or something is no longer finite; all records before it were received.
    """
    solutions = 0
    unchanged = system.changes is None and (system.G is None or not system.G.nnz)
    fixed_speed = system.rotation.is_constant or unchanged
    stepper: Stepper | None = None
    first = state.step
    begun = time.monotonic()
    while state.step < schedule.steps:
        steps = min(CHUNK * schedule.every, schedule.steps - state.step)
        if not fixed_speed:
            # Steps over which the speed changes so little that W G may be held.
            rotation = system.rotation
            rate = np.abs(np.diff(rotation.speeds) / np.diff(rotation.times)).max()
            even = int(_SPEED_CHANGE * np.abs(rotation.speeds).max() / (rate * schedule.h)) if rate else schedule.steps
            steps = min(steps, max(schedule.every, even // schedule.every * schedule.every))
        if stepper is None or not fixed_speed:
            middle = (state.step + 0.5 * steps) * schedule.h
            speed = float(system.rotation.speed(np.array(middle)))
            here = system.at_time(state.step * schedule.h, (state.step + steps) * schedule.h)
            stepper = integrator.prepare(here, schedule.h, speed, tolerance)
            stepper.start(state)
        records = stepper.advance(state, steps, schedule.every)
        solutions += records.solutions
        if not np.all(np.isfinite(state.F)) or (records.t.size and not np.all(np.isfinite(records.F[-1]))):
            raise ConvergenceError(_stopped(-2, records.t[0] if records.t.size else 0.0, schedule.h))
        receive(records, state)
        if records.status:
            raise ConvergenceError(_stopped(records.status, (state.step + 1) * schedule.h, schedule.h))
        share = (state.step - first) / max(schedule.steps - first, 1)
        left = (time.monotonic() - begun) * (1.0 / share - 1.0)
        progress(share, f"step {state.step} of {schedule.steps}, about {left:.0f} s left")
    return solutions


def _stopped(status: int, t: float, h: float) -> str:
    if status == -1:
        return (
            f"the contact forces of the step to t = {t:.6g} s did not converge; take a smaller step than {h:.3g} s, "
            "or a smoother law"
        )
    return (
        f"a force is not finite in the step to t = {t:.6g} s: a force law gave NaN, or the motion grows without bound; "
        f"check the laws and damping, or take a smaller step than {h:.3g} s"
    )
