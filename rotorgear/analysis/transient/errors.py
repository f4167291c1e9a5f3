"""Errors of a transient's statistics, by runs of other steps, and the step that reaches an accuracy.

A run of a third of the step tells the error of each statistic: with second order e = 9/8 |s_h - s_(h/3)|. Both may agree by luck,
so that a run of twice the step, which says e = |s_h - s_2h|/3, keeps it above a share of that. No step is chosen by the first:
the search for one compares runs of a step and of its double.

Chaos, where motions of two steps part however small both are, has no error of the step. There a statistic scatters: windows of
the records of three runs tell by how much other runs as long as this one differ from it in nineteen cases of twenty.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from rotorgear.analysis.transient.histories import Histories, run_task
from rotorgear.analysis.transient.request import Grid, Task, coarser
from rotorgear.analysis.transient.statistics import Quantities, quantities_of, resampled
from rotorgear.errors import ConvergenceError
from rotorgear.progress import Progress
from rotorgear.solvers.time.explicit import Explicit
from rotorgear.solvers.time.exponential import Exponential
from rotorgear.solvers.time.local_system import Integrator
from rotorgear.solvers.time.statistics import FINER, OF_ERROR, gain, scatter_of_two

# Share of the error by twice the step that an error is not below.
_BY_LUCK = 0.35
# By what the larger one of two differences to other runs has to be multiplied to be more than nine of ten others.
_NINE = 2.2
# Motions of two steps have parted that differ by more than this share of their size, and by more than this share of what the
# motions of steps twice as large differ by.
_PARTED = 0.3
# Parts of the time in which motions are compared.
_STRETCHES = 8
FALLS = 0.5


@dataclass(frozen=True)
class Stated:
    """Errors (s,) of statistics, the largest relative to its statistic, where they are from, and whether motions part."""

    errors: np.ndarray
    largest: float
    source: str
    parted: bool = False


def stated(found: Histories, task: Task, integrator: Integrator, grid: Grid, progress: Progress) -> Stated:
    """The errors of a run's statistics; NaN where the run, or one that tells them, did not end well.

    An explicit method chooses its own steps: there a hundred times the tolerance takes their place, looked at half as often, for
    means and extremes hang on that. Where modes are cut, a run has half as many more.
    """
    own = quantities_of(found, task)
    unknown = Stated(np.full(own.value.size, np.nan), float("nan"), "")
    if found.status != "success":
        return unknown
    if isinstance(integrator, Explicit):
        double, _ = coarser(grid)
        loose = _run(task, Explicit(100.0 * integrator.relative), double, progress, "looser tolerance")
        if loose is None:
            return unknown
        errors, largest = own.errors(quantities_of(loose, task), 1.0)
        return Stated(errors, largest, "a run to a looser tolerance, at half as many steps")
    finer = _run(task, integrator, replace(grid, every=FINER * grid.every), progress, "a third of the step")
    if finer is None:
        return unknown
    double, ratio = coarser(grid)
    rough = _run(task, integrator, double, progress, "twice the step")
    runs = [run for run in (finer, rough) if run is not None]
    off = np.array([np.abs(own.value - quantities_of(run, task).value) for run in runs])
    errors = off[0] / OF_ERROR
    source = "a run of a third of the step"
    if rough is not None:
        errors = np.maximum(errors, _BY_LUCK * off[1] / (ratio**2 - 1.0))
        source = "runs of a third of the step and of twice the step"
    near = _distance(found, finer)
    # Where large steps are only inaccurate, a run of twice the step is further away.
    parted = bool(np.any((near > _PARTED) & ((rough is None) | (near > FALLS * _distance(found, rough or found)))))
    if parted:
        scatter = _scatter([found, *runs], task)
        source = "the scatter of the record and of runs of other steps, which part from it: the motion is chaotic"
        if np.all(np.isnan(scatter)):
            source = "the largest difference of runs of other steps, which part from this one"
        errors = np.fmax(_NINE * off.max(axis=0), scatter)
    if isinstance(integrator, Exponential) and integrator.modes is not None:
        more = Exponential(int(1.5 * integrator.modes), integrator.modal_ratio)
        fuller = _run(task, more, grid, progress, "more modes")
        if fuller is None:
            return unknown
        # Errors of the step and of the modes that are missing add up.
        errors = errors + own.errors(quantities_of(fuller, task), 1.0)[0]
        source += ", and one of more modes"
    return Stated(errors, own.largest(errors), source, parted)


def _run(task: Task, integrator: Integrator, grid: Grid, progress: Progress, text: str) -> Histories | None:
    """A run that serves another one; None where it did not get through."""
    try:
        found = run_task(task, integrator, grid, progress, text=text)
    except ConvergenceError:
        return None
    return found if found.status == "success" else None


def _distance(one: Histories, other: Histories) -> np.ndarray:
    """How far local displacements of two runs are apart in each part of the time, relative to how they move there."""
    times = [run.table("t") for run in (one, other)]
    spacing = max(np.diff(t[-2:]).max(initial=0.0) for t in times)
    none = np.zeros(_STRETCHES)
    if not spacing or not one.state.d.size:
        return none
    _, first, second = np.intersect1d(*(np.rint(2.0 * t / spacing).astype(int) for t in times), return_indices=True)
    if first.size < 2 * _STRETCHES:
        return none
    d = one.table("d")[first]
    off = d - other.table("d")[second]
    parts = np.array_split(np.arange(first.size), _STRETCHES)
    moved = np.array([np.var(d[part], axis=0).sum() for part in parts])
    apart = np.array([np.mean(off[part] ** 2, axis=0).sum() for part in parts])
    return np.asarray(np.sqrt(np.divide(apart, moved, out=none, where=moved > 0.0)))


def _scatter(runs: list[Histories], task: Task) -> np.ndarray:
    """By how much statistics (s,) of two runs differ in nineteen cases of twenty; NaN where speed changes, or time is short."""
    rows = resampled(runs, task) if task.local.local.rotation.is_constant else None
    if rows is None:
        return np.full(quantities_of(runs[0], task).value.size, np.nan)
    # Both runs scatter.
    return scatter_of_two(rows)


_HALVINGS = 6
# The search gives up after this many halvings in a row that leave more than `FALLS` of the error.
_FRUITLESS = 2
# What a halving leaves of the error with second order.
_SECOND_ORDER = 0.25
# Most steps of a run that helps to choose the step.
_PROBE = 60_000


def fine_enough(
    task: Task, integrator: Integrator, grid: Grid, accuracy: float, progress: Progress
) -> tuple[Grid, float]:
    """Halve the step until the statistics of a run, or of its beginning, agree with those of twice the step.

    The search ends early where what halvings leave of the error says that those to come won't reach the accuracy.

    Returns:
        The grid with the step that was chosen, and the share of the error that a halving left.
    """
    records = min(grid.records, max(_PROBE // grid.every, 8))
    probe = replace(grid, records=records, settled=min(grid.settled, records // 2))

    def probed(steps: Grid) -> Quantities | None:
        found = _run(task, integrator, steps, progress, "choosing the step")
        return quantities_of(found, task) if found else None

    last = probed(probe)
    errors: list[float] = []
    for number in range(1, _HALVINGS + 1):
        finer = replace(probe, every=2 * probe.every)
        now = probed(finer)
        errors.append(now.errors(last, gain(2.0))[1] if now and last else np.inf)
        # What the finer of the two was found to be good for.
        if errors[-1] <= accuracy:
            # The coarser one is four times worse, and no better than its own comparison with twice its step.
            enough = False
            if len(errors) == 1 and errors[-1] <= _SECOND_ORDER * accuracy:
                double, ratio = coarser(probe)
                other = probed(double)
                enough = bool(last and other and last.errors(other, gain(ratio))[1] <= accuracy)
            return replace(grid, every=probe.every if enough else finer.every), _left(errors)
        if len(errors) > _FRUITLESS and min(errors[-_FRUITLESS:]) > FALLS * errors[-1 - _FRUITLESS] < np.inf:
            # Steps four times finer give other statistics, no better ones: the motion is chaotic, or the time too short for it.
            return grid, 1.0
        probe = finer
        last = now
        # Each further halving may leave as much as the better one of the last two, or what second order leaves.
        recent = np.array(errors[-3:])
        hoped = _SECOND_ORDER
        if not np.isfinite(errors[-1]):
            hoped = 0.0
        elif recent.size == 3 and np.all(np.isfinite(recent)):
            hoped = float(min((recent[1:] / recent[:-1]).min(), FALLS))
        if number >= _FRUITLESS and errors[-1] * hoped ** (_HALVINGS - number) > accuracy:
            break
    return replace(grid, every=probe.every), _left(errors)


def _left(errors: list[float]) -> float:
    """Share of the error that a halving left in the mean over the last two."""
    known = [error for error in errors[-3:] if np.isfinite(error)]
    return float((known[-1] / known[0]) ** (1.0 / (len(known) - 1))) if len(known) > 1 else _SECOND_ORDER
