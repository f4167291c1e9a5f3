"""Runs an integrator in chunks: records go to a receiver chunk by chunk, and what stops a run keeps what is there."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from rotorgear.errors import ConvergenceError
from rotorgear.progress import Progress, silent
from rotorgear.solvers.time.local_system import Integrator, LocalSystem, Records, State, Stepper

# Records in a chunk: large enough for fast products, small enough to stop and report often.
CHUNK = 512
# Change of the speed within a chunk of a run-up, relative to its largest, for which W G is held constant.
_SPEED_CHANGE = 2e-3


@dataclass(frozen=True)
class Schedule:
    """Steps of a run: their size h in s, how many, and that every `every`-th is recorded."""

    h: float
    steps: int
    every: int = 1


@dataclass
class RunCost:
    """What a run did: steps, linear solutions of m x m, and how often the step's matrix was made ready."""

    steps: int = 0
    solutions: int = 0
    preparations: int = 0


Receiver = Callable[[Records, State], None]


def run(
    system: LocalSystem,
    integrator: Integrator,
    schedule: Schedule,
    state: State,
    receive: Receiver,
    *,
    tolerance: float = 1e-10,
    progress: Progress = silent,
) -> RunCost:
    """Integrate from `state`, which is advanced in place, to the last step of the schedule.

    Raises:
        ConvergenceError: a step did not converge, or something is no longer finite; all records before it were received.
    """
    cost = RunCost()
    fixed_speed = system.rotation.is_constant or system.G is None or not system.G.nnz
    stepper: Stepper | None = None
    first = state.step
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
            stepper = integrator.prepare(system, schedule.h, speed, tolerance)
            stepper.start(state)
            cost.preparations += 1
        records = stepper.advance(state, steps, schedule.every)
        cost.steps += records.done
        cost.solutions += records.solutions
        if not np.all(np.isfinite(state.F)) or (records.t.size and not np.all(np.isfinite(records.F[-1]))):
            raise ConvergenceError(_stopped(-2, records.t[0] if records.t.size else 0.0, schedule.h))
        receive(records, state)
        if records.status:
            raise ConvergenceError(_stopped(records.status, (state.step + 1) * schedule.h, schedule.h))
        share = (state.step - first) / max(schedule.steps - first, 1)
        progress(share, f"step {state.step} of {schedule.steps}")
    return cost


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
