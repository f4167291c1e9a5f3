"""Errors of a transient's statistics, by runs of other steps, and the step that reaches an accuracy.

A run of half the step tells the error of each statistic: with second order e = 4/3 |s_h - s_(h/2)|. Sides change at another place
in each step, so that both may agree by luck; a run of twice the step keeps the error from being said smaller than a share of what
it would be by that one.

Chaos, where motions of two steps part however small both are, has no error of the step. There a statistic scatters: windows of
the record tell by how much other runs as long as this one differ from it in nine cases of ten.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from rotorgear.analysis.transient.histories import Histories, run_task
from rotorgear.analysis.transient.request import Grid, Task, coarser
from rotorgear.analysis.transient.statistics import quantities_of, resampled
from rotorgear.errors import ConvergenceError
from rotorgear.progress import Progress
from rotorgear.solvers.time.explicit import Explicit
from rotorgear.solvers.time.exponential import Exponential
from rotorgear.solvers.time.local_system import Integrator
from rotorgear.solvers.time.statistics import by_steps, largest_relative

# No table shows the smallest force of a contact. Where a damper lets go it jumps, and is known to first order only.
_UNSHOWN = "smallest force"
# Standard deviations that nine of ten values lie within.
_NINETY = 1.645
# Motions of two steps have parted that differ by more than this share of their size, and by more than this share of what the
# motions of twice these steps differ by.
_PARTED = 0.3
_FALLS = 0.5


@dataclass(frozen=True)
class Stated:
    """Errors (s,) of statistics, the largest relative to its statistic, where they are from, and whether motions part."""

    errors: np.ndarray
    largest: float
    source: str
    parted: bool = False


@dataclass(frozen=True)
class Others:
    """Runs of half the step (of an explicit method: to a looser tolerance), of `ratio` times the step, and of more modes."""

    finer: Histories | None
    coarser: Histories | None = None
    ratio: float = 2.0
    fuller: Histories | None = None
    looser: bool = False


def stated(found: Histories, others: Others, task: Task) -> Stated:
    """The errors of a run's statistics; NaN where the run or one that tells them did not end well."""
    own = quantities_of(found, task)
    runs = [found, *(run for run in (others.finer, others.fuller) if run)]
    if others.finer is None or any(run.status != "success" for run in runs):
        return Stated(np.full(own.value.size, np.nan), float("nan"), "")
    finer = quantities_of(others.finer, task)
    if others.looser:
        errors, largest = own.errors(finer, 1.0)
        return Stated(errors, largest, "a run to a looser tolerance, at half as many steps")
    rough = others.coarser if others.coarser and others.coarser.status == "success" else None
    worse = quantities_of(rough, task) if rough else None
    errors = by_steps(own.value, finer.value, worse.value if worse else None, others.ratio, own.counted)
    source = "runs of half and of twice the step" if worse else "a run of half the step"
    parted = _parted(found, others.finer, rough)
    if parted:
        seen = [np.abs(own.value - other.value) for other in (finer, worse) if other]
        between = np.maximum(np.max(seen, axis=0), own.counted)
        scatter = _scatter(found, task)
        errors = np.fmax(between, scatter)
        source = "the largest difference of runs of other steps, which part from this one"
        if largest_relative(np.nan_to_num(scatter), own.scale) > _PARTED * largest_relative(between, own.scale):
            source = "the scatter of the record and of runs of other steps, which part from it: the motion is chaotic"
    if others.fuller:
        # Errors of the step and of the modes that are missing add up.
        errors = errors + own.errors(quantities_of(others.fuller, task), 1.0)[0]
        source += ", and one of more modes"
    shown = ~np.char.startswith(own.name, _UNSHOWN)
    return Stated(errors, largest_relative(errors[shown], own.scale[shown]), source, parted)


def _parted(own: Histories, finer: Histories, rough: Histories | None) -> bool:
    """Whether motions of other steps end elsewhere, and no nearer to each other with smaller steps."""
    near = _distance(own, finer)
    return near > _PARTED and (rough is None or near > _FALLS * _distance(own, rough))


def _distance(one: Histories, other: Histories) -> float:
    """How far local displacements of two runs are apart in the last records of both, relative to how they move there."""
    spacing = max(np.diff(run.table("t")[-2:]).max(initial=0.0) for run in (one, other))
    if not spacing or not one.state.d.size:
        return 0.0
    places = [np.rint(2.0 * run.table("t") / spacing).astype(int) for run in (one, other)]
    _, first, second = np.intersect1d(*places, return_indices=True)
    if first.size < 2:
        return 0.0
    d = one.table("d")[first]
    off = d - other.table("d")[second]
    moved = float(np.var(d, axis=0).sum())
    return float(np.sqrt(np.mean(off**2, axis=0).sum() / moved)) if moved > 0.0 else 0.0


def _scatter(found: Histories, task: Task) -> np.ndarray:
    """By how much statistics (s,) of a run as long differ in nine cases of ten; NaN where speed changes, or time is short."""
    rows = resampled(found, task) if task.local.local.rotation.is_constant else None
    if rows is None:
        return np.full(quantities_of(found, task).value.size, np.nan)
    # Both runs scatter.
    return np.asarray(_NINETY * np.sqrt(2.0) * rows.std(axis=0))


def others_of(task: Task, integrator: Integrator, grid: Grid, progress: Progress, known: Others | None) -> Others:
    """Runs that tell the errors of one over a grid; those of other steps may be known.

    An explicit method chooses its own steps: there a hundred times the tolerance takes their place, looked at half as often, for
    means and extremes hang on that. Where modes are cut, a run has half as many more.
    """
    double, ratio = coarser(grid)
    if isinstance(integrator, Explicit):
        loose = Explicit(100.0 * integrator.relative)
        return Others(run_task(task, loose, double, progress, text="looser tolerance"), looser=True)
    if known is None:
        half = replace(grid, every=2 * grid.every)
        rough = _run(task, integrator, double, progress, "twice the step")
        known = Others(_run(task, integrator, half, progress, "half the step"), rough, ratio)
    if isinstance(integrator, Exponential) and integrator.modes is not None and known.finer:
        fuller = Exponential(int(1.5 * integrator.modes), integrator.modal_ratio)
        return replace(known, fuller=run_task(task, fuller, grid, progress, text="more modes"))
    return known


def _run(task: Task, integrator: Integrator, grid: Grid, progress: Progress, text: str) -> Histories | None:
    """A run that serves another one; None where so large a step did not get through."""
    try:
        found = run_task(task, integrator, grid, progress, text=text)
    except ConvergenceError:
        return None
    return found if found.status == "success" else None


_HALVINGS = 6
# The search gives up after this many halvings in a row that leave more than `_FALLS` of the error.
_FRUITLESS = 2
# What a halving leaves of the error with second order.
_SECOND_ORDER = 0.25
# Most steps of a run that helps to choose the step.
_PROBE = 60_000


@dataclass(frozen=True)
class Choice:
    """The grid with the step that was chosen, the share of the error that a halving left, and the runs of other steps.

    `left` is 1 where steps don't lower the error, `parted` where motions of two steps part; `others` are None where the runs only
    were the beginning of the time.
    """

    grid: Grid
    left: float = _SECOND_ORDER
    others: Others | None = None
    parted: bool = False

    @property
    def falls(self) -> bool:
        """Whether smaller steps lower the error."""
        return self.left <= _FALLS


def fine_enough(task: Task, integrator: Integrator, grid: Grid, accuracy: float, progress: Progress) -> Choice:
    """Halve the step until the statistics of a run, or of its beginning, agree with those of half and of twice the step.

    The search ends early where what halvings leave of the error says that those to come won't reach the accuracy, and where
    motions part: no step is right then.
    """
    # So that steps of twice the length have the same records.
    grid = replace(grid, every=grid.every + grid.every % 2)
    records = min(grid.records, max(_PROBE // grid.every, 8))
    probe = replace(grid, records=records, settled=min(grid.settled, records // 2))

    def probed(steps: Grid) -> Histories | None:
        return _run(task, integrator, steps, progress, "choosing the step")

    def chosen(left: float, parted: bool = False) -> Choice:
        whole = others if records == grid.records else None
        return Choice(replace(grid, every=probe.every), left, whole, parted)

    double, ratio = coarser(probe)
    rough, own = probed(double), probed(probe)
    errors: list[float] = []
    for number in range(1, _HALVINGS + 1):
        finer = probed(replace(probe, every=2 * probe.every))
        others = Others(finer, rough, ratio)
        told = stated(own, others, task) if own and finer else None
        errors.append(told.largest if told else np.inf)
        if told and told.parted:
            return chosen(1.0, parted=True)
        if errors[-1] <= accuracy:
            return chosen(_left(errors))
        if len(errors) > _FRUITLESS and min(errors[-_FRUITLESS:]) > _FALLS * errors[-1 - _FRUITLESS] < np.inf:
            # Steps four times finer give other statistics, no better ones.
            return chosen(1.0)
        # Each further halving may leave as much as the better one of the last two, or what second order leaves.
        recent = np.array(errors[-3:])
        hoped = _SECOND_ORDER
        if not np.isfinite(errors[-1]):
            hoped = 0.0
        elif recent.size == 3 and np.all(np.isfinite(recent)):
            hoped = float(min((recent[1:] / recent[:-1]).min(), _FALLS))
        if number == _HALVINGS or (number >= _FRUITLESS and errors[-1] * hoped ** (_HALVINGS - number) > accuracy):
            break
        probe = replace(probe, every=2 * probe.every)
        rough, own, ratio = own, finer, 2.0
    return chosen(_left(errors))


def _left(errors: list[float]) -> float:
    """Share of the error that a halving left in the mean over the last two."""
    known = [error for error in errors[-3:] if np.isfinite(error)]
    return float((known[-1] / known[0]) ** (1.0 / (len(known) - 1))) if len(known) > 1 else _SECOND_ORDER
