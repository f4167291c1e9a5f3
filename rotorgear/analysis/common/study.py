"""Error against run time of any analysis. A study is a knob and its values (the settings), the quantity that is compared and what
judges it, and a reference that is taken for the truth.

Every setting is run and timed. Times are CPU seconds on one BLAS thread, the median of several runs beside the least and the
largest; the first run, which warms caches up and counts memory, is not among them. Short runs are repeated until the quartiles of
their times lie within a tenth of the median; a long run is timed once, and the row says so.
"""

from __future__ import annotations

import tracemalloc
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import KW_ONLY, dataclass, field
from functools import partial
from typing import Any, Generic, TypeVar

import numpy as np

from rotorgear.analysis.common.stream import Piece, unkept
from rotorgear.cpu import compiling_seconds, cpu_seconds
from rotorgear.errors import Interrupted, RotorgearError
from rotorgear.model.model import Model
from rotorgear.progress import Progress, part_of
from rotorgear.results.convergence import ConvergenceStudy, Rung
from rotorgear.solvers.sparse.factor import single_thread

R = TypeVar("R")
# Runs that are timed at least; they are repeated until their times agree, within the largest number and the seconds of all. A
# long one is not repeated.
REPEAT = 3
_MOST = 15
_ENOUGH = 2.0  # s of all runs together
_LONG = 2.0  # s of one run
# Difference of the quartiles over the median: below the first, times agree; above the second they are noise.
_AGREE = 0.1
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
    """What one run found of c quantities: relative errors against the reference and its own estimates of them, (c,) each.

    `missed` counts quantities that it has and the reference has not, or the other way round; their errors are infinite.
    """

    dofs: int
    error: np.ndarray
    estimate: np.ndarray
    missed: int = 0


@dataclass(frozen=True)
class Study(Generic[R]):
    """A series of settings of one analysis, and how they are judged.

    Attributes:
        settings: the values of the knob, or of several, one family after the other.
        run: the analysis with the options of a setting.
        judge: what its result is worth.
        compared: the quantities that are compared, in words.
        count: how many they are.
        reference: what they are compared with, in words.
        resolution: relative error below which the reference, or rounding, decides, and no estimate can be judged.
        rising: families whose number divides the step, so that the error falls with its power: the order is measured there.
        below: what a row says whose error is below the resolution.
    """

    settings: Sequence[Setting]
    _: KW_ONLY
    run: Callable[[dict[str, Any]], R]
    judge: Callable[[R], Judged]
    compared: str = ""
    count: int = 0
    reference: str = ""
    resolution: float
    rising: tuple[str, ...] = ("elements",)
    below: str = "below what the reference resolves"

    def result(
        self, analysis: str, model: Model, repeat: int, progress: Progress, also: Study[Any] | None = None
    ) -> ConvergenceStudy:
        """Run all settings, and then those of another study whose rows belong to the same table."""
        found: list[Rung] = []

        def study(status: str = "success") -> ConvergenceStudy:
            title = model.title or "model"
            of = {"compared": self.compared, "resolution": self.resolution, "status": status}
            return ConvergenceStudy(title, analysis, self.reference, self.count, tuple(found), **of)  # type: ignore[arg-type]

        half = 0.5 if also else 1.0
        with kept(found, len(self.settings) + len(also.settings if also else ()), study):
            self._run(found, repeat, part_of(progress, 0.0, half))
            if also:
                also._run(found, repeat, part_of(progress, half, 1.0))
        return study()

    def rungs(self, repeat: int, progress: Progress) -> tuple[Rung, ...]:
        """Run all settings, each timed `repeat` times at least; one that does not converge has a row that says so."""
        found: list[Rung] = []
        self._run(found, repeat, progress)
        return tuple(found)

    def _run(self, found: list[Rung], repeat: int, progress: Progress) -> None:
        piece = keeper()
        for number, setting in enumerate(self.settings):
            progress(number / len(self.settings), setting.method)
            before = found[-1] if found and found[-1].family == setting.family else None
            found.append(piece(partial(self._of_setting, setting, repeat, before))["rung"])
        progress(1.0, "done")

    def _of_setting(self, setting: Setting, repeat: int, before: Rung | None) -> dict[str, Rung]:
        try:
            result, seconds, memory = measured(lambda: self.run(setting.options), repeat)
        except RotorgearError as error:
            which = (setting.method, setting.family, setting.number)
            return {"rung": Rung(*which, 0, np.nan, np.inf, np.inf, None, notes=(f"not reached: {error}",))}
        return {"rung": self._rung(setting, self.judge(result), seconds, memory, before)}

    def _rung(self, setting: Setting, judged: Judged, seconds: np.ndarray, memory: int, before: Rung | None) -> Rung:
        error = float(np.max(judged.error, initial=0.0))
        estimate = float(np.max(judged.estimate, initial=0.0))
        order = None
        coarser = before.error if before is not None and setting.family in self.rising else 0.0
        if before is not None and np.isfinite(error + coarser) and min(error, coarser) > self.resolution:
            # error ~ h^p with the step h ~ 1 / n: p = log(e_1 / e_2) / log(n_2 / n_1)
            order = float(np.log(coarser / error) / np.log(setting.number / before.setting))
        resolved = np.isfinite(error) and np.isfinite(estimate) and error > self.resolution
        notes = []
        if error <= self.resolution:
            notes.append("exact: error and estimate are 0" if max(error, estimate) == 0.0 else self.below)
        if setting.family == "accuracy" and not max(error, estimate) <= max(setting.number, self.resolution):
            notes.append("accuracy missed")
        if judged.missed:
            notes.append(f"{judged.missed} missed, or found where there is none")
        spread = spread_of(seconds)
        if spread > _NOISE:
            notes.append("time is noise")
        if len(seconds) == 1:
            notes.append("timed once")
        # Quantities that have estimates of their own have effectivities of their own.
        told = np.zeros(0, bool)
        if judged.estimate.shape == judged.error.shape:
            told = np.isfinite(judged.error) & np.isfinite(judged.estimate) & (judged.error > self.resolution)
        ratio = judged.estimate[told] / judged.error[told] if told.any() else None
        return Rung(
            method=setting.method,
            family=setting.family,
            setting=setting.number,
            dofs=judged.dofs,
            seconds=float(np.median(seconds)),
            error=error,
            estimate=estimate,
            order=order,
            spread=spread,
            seconds_least=float(np.min(seconds)),
            seconds_most=float(np.max(seconds)),
            timed=len(seconds),
            memory=memory,
            effectivity=estimate / error if resolved else None,
            effectivity_smallest=None if ratio is None else float(ratio.min()),
            effectivity_largest=None if ratio is None else float(ratio.max()),
            notes=tuple(notes),
        )


_KEEPER: ContextVar[Piece] = ContextVar("keeper", default=unkept)


@contextmanager
def keeping(piece: Piece) -> Iterator[None]:
    """Let studies keep their rows by `piece` while this lasts."""
    token = _KEEPER.set(piece)
    try:
        yield
    finally:
        _KEEPER.reset(token)


def keeper() -> Piece:
    """What keeps the rows of a study now; it only does the work where nobody asked for more."""
    return _KEEPER.get()


@contextmanager
def kept(rows: Sequence[Any], count: int, result: Callable[[str], Any]) -> Iterator[None]:
    """Where an interrupt comes after the first of `count` rows, pass it on with the result of those there are.

    Raises:
        Interrupted: with `result(status)`.
    """
    try:
        yield
    except KeyboardInterrupt:
        if not rows:
            raise
        raise Interrupted(result(f"interrupted after {len(rows)} of {count} rows")) from None


def spread_of(seconds: Sequence[float] | np.ndarray) -> float:
    """Difference of the quartiles of times over their median; 0 for a single run."""
    low, middle, high = np.percentile(seconds, [25.0, 50.0, 75.0])
    return float((high - low) / middle) if middle else 0.0


def measured(run: Callable[[], R], repeat: int = REPEAT) -> tuple[R, np.ndarray, int]:
    """Run something once for its result and memory, then for its time; with `repeat` 0 the first run has to do for both.

    Returns:
        The result, CPU seconds of every timed run (r,), and the largest memory of a run in bytes, Python's and numpy's.
    """
    watched = tracemalloc.is_tracing()
    with single_thread(0):
        if not watched:
            tracemalloc.start()
        tracemalloc.reset_peak()
        before = tracemalloc.get_traced_memory()[0]
        start = cpu_seconds() - compiling_seconds()
        try:
            result = run()
            first = cpu_seconds() - compiling_seconds() - start
            memory = tracemalloc.get_traced_memory()[1] - before
        finally:
            if not watched:
                tracemalloc.stop()
        seconds: list[float] = []
        while len(seconds) < repeat or (
            repeat > 1 and len(seconds) < _MOST and sum(seconds) < _ENOUGH and spread_of(seconds) > _AGREE
        ):
            start = cpu_seconds()
            run()
            seconds.append(cpu_seconds() - start)
            if seconds[-1] > _LONG:
                break
    return result, np.array(seconds or [first]), memory
