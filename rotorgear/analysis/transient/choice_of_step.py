"""The step of a transient that reaches an accuracy, and what is said where none within reach does."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from rotorgear.analysis.transient.request import Grid
from rotorgear.analysis.transient.statistics import Judged, judged
from rotorgear.analysis.transient.task import Task, coarser, run_task
from rotorgear.errors import ConvergenceError
from rotorgear.progress import Progress
from rotorgear.solvers.time.local_system import Integrator
from rotorgear.solvers.time.statistics import gain

_HALVINGS = 6
# So many halvings in a row that leave more than this share of the error are given up.
_FRUITLESS = 2
_FALLS = 0.5
# What a halving leaves of the error with second order.
_SECOND_ORDER = 0.25
# The search for a step runs over so many steps at most.
_PROBE = 60_000


@dataclass(frozen=True)
class Choice:
    """The grid with the step that was chosen, and the share of the error that a halving left; untried, that of second order."""

    grid: Grid
    left: float = _SECOND_ORDER

    def remedy(self, error: float, wanted: float, frequency: float, method: str) -> str:
        """What would reach the accuracy that this grid's run missed by its error.

        `frequency` in Hz is that in whose periods steps are counted.
        """
        if self.left > _FALLS:
            return "smaller steps do not lower it: the motion is chaotic, or the time too short for its statistics"
        steps = self.grid.every / (self.grid.spacing * frequency) * (error / wanted) ** (-1.0 / np.log2(self.left))
        if not np.isfinite(steps):
            return "take more steps in a period of the fastest motion (--steps)"
        many = f"{float(f'{steps:.2g}'):.0f} steps in a mesh period (--steps)"
        return f"about {many} of the same method ({method}) would reach it, by how it falls"


def fine_enough(task: Task, integrator: Integrator, grid: Grid, accuracy: float, progress: Progress) -> Choice:
    """Halve the step until the statistics of a run, or of its beginning, agree with those of twice the step.

    The search ends early where what halvings leave of the error says that those to come won't reach the accuracy.
    """
    records = min(grid.records, max(_PROBE // grid.every, 8))
    probe = replace(grid, records=records, settled=min(grid.settled, records // 2))
    last = _probed(task, integrator, probe, progress)
    errors: list[float] = []
    for number in range(1, _HALVINGS + 1):
        finer = replace(probe, every=2 * probe.every)
        now = _probed(task, integrator, finer, progress)
        errors.append(now.errors(last, gain(2.0))[1] if now and last else np.inf)
        # What the finer of the two was found to be good for.
        if errors[-1] <= accuracy:
            # The coarser one is four times worse, and no better than its own comparison with twice its step, which is stated.
            first = len(errors) == 1 and errors[-1] <= _SECOND_ORDER * accuracy
            enough = first and _is_enough(task, integrator, probe, last, accuracy, progress)
            return Choice(replace(grid, every=probe.every if enough else finer.every), _left(errors))
        if len(errors) > _FRUITLESS and min(errors[-_FRUITLESS:]) > _FALLS * errors[-1 - _FRUITLESS] < np.inf:
            # Steps four times finer give other statistics, no better ones: the motion is chaotic, or the time too short for it.
            return Choice(grid, 1.0)
        probe = finer
        last = now
        if number >= _FRUITLESS and errors[-1] * _hoped(errors) ** (_HALVINGS - number) > accuracy:
            break
    return Choice(replace(grid, every=probe.every), _left(errors))


def _left(errors: list[float]) -> float:
    """Share of the error that a halving left in the mean over the last two."""
    known = [error for error in errors[-3:] if np.isfinite(error)]
    return float((known[-1] / known[0]) ** (1.0 / (len(known) - 1))) if len(known) > 1 else _SECOND_ORDER


def _hoped(errors: list[float]) -> float:
    """Share of the error that each further halving may leave: the least of the last two, or what second order leaves."""
    if not np.isfinite(errors[-1]):
        return 0.0
    last = np.array(errors[-3:])
    return (
        float(min((last[1:] / last[:-1]).min(), _FALLS))
        if last.size == 3 and np.all(np.isfinite(last))
        else _SECOND_ORDER
    )


def _is_enough(
    task: Task, integrator: Integrator, grid: Grid, found: Judged | None, accuracy: float, progress: Progress
) -> bool:
    """Whether the statistics of a run agree with those of twice its step, as its own error will be stated."""
    double, ratio = coarser(grid)
    other = _probed(task, integrator, double, progress)
    return found is not None and other is not None and found.errors(other, gain(ratio))[1] <= accuracy


def _probed(task: Task, integrator: Integrator, grid: Grid, progress: Progress) -> Judged | None:
    """Statistics of a run that helps to choose the step; None where so large a step did not get through."""
    try:
        found = run_task(task, integrator, grid, progress, text="choosing the step")
    except ConvergenceError:
        return None
    return judged(found, task) if found.status == "success" else None
