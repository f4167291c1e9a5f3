"""Error against run time of any analysis: a series of settings, each run, timed and judged against a reference.

Times are CPU seconds of this process on one BLAS thread, the median of several runs; the first run, which warms caches up and
counts memory, is not among them. A time whose quartiles lie far apart is noise, and the row says so.
"""

from __future__ import annotations

import time
import tracemalloc
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, Generic, TypeVar

import numpy as np

from rotorgear.errors import RotorgearError
from rotorgear.progress import Progress
from rotorgear.results.convergence import Rung
from rotorgear.solvers.sparse.factor import single_thread

R = TypeVar("R")
# Numbers of basic elements in a shaft segment, and accuracies, that studies of a mesh go through.
ELEMENTS = (1, 2, 4, 8, 16, 32)
ACCURACIES = (1e-2, 1e-3, 1e-4, 1e-5, 1e-7, 1e-9)
# Runs that are timed: so many, more while they are short, fewer when one is long.
REPEAT = 3
_MOST = 9
_SHORT = 0.3  # s of all runs together
_LONG = 2.0  # s of one run, which is not repeated
# Difference of the quartiles over the median above which a time is noise.
_NOISE = 0.25


@dataclass(frozen=True)
class Setting:
    """One step of a study: what is asked for in words, its family, the number that rises, and the arguments of the analysis."""

    method: str
    family: str
    number: float
    options: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Judged:
    """What one run found of c quantities: relative errors against the reference and its own estimates of them, (c,) each."""

    dofs: int
    error: np.ndarray
    estimate: np.ndarray


@dataclass(frozen=True)
class Cost:
    """CPU seconds of every timed run, (r,), and the largest memory of a run in bytes, Python's and numpy's."""

    seconds: np.ndarray
    memory: int

    @property
    def spread(self) -> float:
        """Difference of the quartiles over the median; 0 for a single run."""
        low, middle, high = np.percentile(self.seconds, [25.0, 50.0, 75.0])
        return float((high - low) / middle) if middle else 0.0


def mesh_settings(elements: Sequence[int], accuracies: Sequence[float]) -> list[Setting]:
    """Settings of a study over meshes: basic elements in each segment, then refinement to an accuracy."""
    by_number = [
        Setting(f"{n} basic element{'s'[: n != 1]} per segment", "elements", float(n), {"elements": n})
        for n in elements
    ]
    return by_number + [Setting(f"accuracy {a:g}", "accuracy", a, {"accuracy": a}) for a in accuracies]


@dataclass(frozen=True)
class Study(Generic[R]):
    """How an analysis is studied.

    Attributes:
        run: the analysis with the options of a setting.
        judge: what its result is worth.
        resolution: relative error below which the reference, or rounding, decides, and no estimate can be judged.
        rising: families whose number divides the step, so that the error falls with its power: the order is measured there.
        repeat: runs that are timed at least.
        below: what a row says whose error is below the resolution.
    """

    run: Callable[[dict[str, Any]], R]
    judge: Callable[[R], Judged]
    resolution: float
    rising: tuple[str, ...] = ("elements",)
    repeat: int = REPEAT
    below: str = "below what the reference resolves"

    def rungs(self, settings: Sequence[Setting], progress: Progress) -> tuple[Rung, ...]:
        """Run all settings; one that does not come to an end stands as such in the table."""
        found: list[Rung] = []
        for number, setting in enumerate(settings):
            progress(number / len(settings), setting.method)
            before = found[-1] if found and found[-1].family == setting.family else None
            try:
                result, cost = measured(lambda: self.run(setting.options), self.repeat)  # noqa: B023
            except RotorgearError as error:
                found.append(_failed(setting, str(error)))
                continue
            found.append(self._rung(setting, self.judge(result), cost, before))
        progress(1.0, "done")
        return tuple(found)

    def _rung(self, setting: Setting, judged: Judged, cost: Cost, before: Rung | None) -> Rung:
        error = float(np.max(judged.error, initial=0.0))
        estimate = float(np.max(judged.estimate, initial=0.0))
        order = None
        coarser = before.error if before is not None and setting.family in self.rising else 0.0
        if before is not None and np.isfinite(error + coarser) and min(error, coarser) > self.resolution:
            # error ~ h^p with the step h ~ 1 / n: p = log(e_1 / e_2) / log(n_2 / n_1)
            order = float(np.log(coarser / error) / np.log(setting.number / before.setting))
        notes = []
        if error <= self.resolution:
            notes.append("exact: error and estimate are 0" if max(error, estimate) == 0.0 else self.below)
        if setting.family == "accuracy" and not max(error, estimate) <= max(setting.number, self.resolution):
            notes.append("accuracy missed")
        if cost.spread > _NOISE:
            notes.append("time is noise")
        smallest, largest = self._range(judged)
        return Rung(
            method=setting.method,
            family=setting.family,
            setting=setting.number,
            dofs=judged.dofs,
            seconds=float(np.median(cost.seconds)),
            error=error,
            estimate=estimate,
            order=order,
            spread=cost.spread,
            timed=len(cost.seconds),
            memory=cost.memory,
            effectivity=effectivity(error, estimate, self.resolution),
            effectivity_smallest=smallest,
            effectivity_largest=largest,
            notes=tuple(notes),
        )

    def _range(self, judged: Judged) -> tuple[float | None, float | None]:
        """Smallest and largest effectivity of single quantities that have an estimate of their own."""
        if judged.estimate.shape != judged.error.shape:
            return None, None
        told = np.isfinite(judged.error) & np.isfinite(judged.estimate) & (judged.error > self.resolution)
        if not told.any():
            return None, None
        ratio = judged.estimate[told] / judged.error[told]
        return float(ratio.min()), float(ratio.max())


def effectivity(error: float, estimate: float, resolution: float) -> float | None:
    """Estimate over error; None where one of them means nothing."""
    if not (np.isfinite(error) and np.isfinite(estimate)) or error <= resolution:
        return None
    return estimate / error


def measured(run: Callable[[], R], repeat: int = REPEAT) -> tuple[R, Cost]:
    """Run something once for its result and memory, then for its time; with `repeat` 0 the first run has to do for both."""
    watched = tracemalloc.is_tracing()
    with single_thread(0):
        if not watched:
            tracemalloc.start()
        tracemalloc.reset_peak()
        before = tracemalloc.get_traced_memory()[0]
        start = time.process_time()
        try:
            result = run()
            first = time.process_time() - start
            memory = tracemalloc.get_traced_memory()[1] - before
        finally:
            if not watched:
                tracemalloc.stop()
        seconds: list[float] = []
        while len(seconds) < repeat or (repeat > 1 and len(seconds) < _MOST and sum(seconds) < _SHORT):
            start = time.process_time()
            run()
            seconds.append(time.process_time() - start)
            if seconds[-1] > _LONG:
                break
    return result, Cost(np.array(seconds or [first]), memory)


def _failed(setting: Setting, why: str) -> Rung:
    return Rung(
        method=setting.method,
        family=setting.family,
        setting=setting.number,
        dofs=0,
        seconds=float("nan"),
        error=float("inf"),
        estimate=float("inf"),
        order=None,
        notes=(f"not reached: {why}",),
    )
