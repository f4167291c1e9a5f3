"""Value and uncertainty against run time of what a sweep tells of one point, over steps and length."""

from __future__ import annotations

import time as clock
from collections.abc import Sequence

import numpy as np

from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.common.request import speed_in_si
from rotorgear.analysis.sweep.sweep import sweep
from rotorgear.errors import AnalysisError
from rotorgear.model.model import Model
from rotorgear.progress import Progress, silent
from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.convergence import SweepConvergenceStudy, SweepRung
from rotorgear.results.sweep import SweepResult

STEPS = (50, 100, 200, 400)
COUNTS = (50, 200, 800)
_SETTLE = 300
# Far enough apart for chaos to forget, near enough to stay with one motion.
_THROW = 1e-3
# Shares of the operating speed that are tried for a point with one motion, and periods that show it.
_SHARES = (1.0, 0.9, 1.1, 0.8, 1.2, 0.7, 1.3, 0.6, 0.5)
_TRIED = 30
_ALIKE = 1e-3
# The reference takes so many times the most steps.
_FINER = 4


@recorded
def sweep_convergence_study(
    model: Model,
    *,
    speed: float | str | None = None,
    steps: Sequence[int] = STEPS,
    counts: Sequence[int] = COUNTS,
    starts: int = 32,
    progress: Progress = silent,
) -> SweepConvergenceStudy:
    """Run one point with several steps and lengths, each from many states near the static one, side by side.

    The scatter between the runs from different states is a check of the standard error that a single run states: where one motion
    attracts them all, both agree.

    Args:
        model: a small model. speed: in rad/s or as a text; where not given the operating speed, or one near
            it at which a single motion attracts all states.
        steps: in a period of the fastest mesh. counts: least common periods that count. starts: states, at least 2.

    Raises:
        AnalysisError: fewer than two states, or a model that sweeps don't take.
    """
    if starts < 2:
        raise AnalysisError(f"starts: got {starts}, expected 2 or more, whose scatter is compared")
    given = speed if speed is not None else (model.operation.speed if model.operation else None)
    if given is None:
        raise AnalysisError("the model gives no speed of operation: ask for one (speed, or --speed)")
    notes: list[str] = []
    if speed is None:
        progress(0.0, "a point with one motion")
        given, notes = _one_motion(model, float(given), starts)

    def run(n: int, count: int) -> SweepResult:
        return sweep(
            model,
            {"operation.speed": [given]},
            initial_conditions=starts,
            throw=_THROW,
            steps=n,
            discard=_SETTLE,
            sample=count,
        )

    plans = [(n, max(counts)) for n in steps] + [(max(steps) // 2, count) for count in counts[:-1]]
    progress(0.1, "reference")
    truth = _sizes(run(_FINER * max(steps), max(counts)))
    rungs = []
    for number, (n, count) in enumerate(plans):
        progress(0.2 + 0.8 * number / len(plans), f"{n} steps, {count} periods")
        begun = clock.process_time()
        runs = run(n, count)
        seconds = clock.process_time() - begun
        worst = int(np.argmax(runs.peak_to_peak[0].mean(axis=0)))
        exponents = runs.lyapunov[0, :, 0]
        scatter = exponents.std(ddof=1) if np.ptp(exponents) else 0.0
        sizes = runs.peak_to_peak[0, :, worst]
        factors = runs.dynamic_factor[0, :, worst]
        rungs.append(
            SweepRung(
                n,
                count,
                seconds / starts,
                float(exponents.mean()),
                float(scatter),
                float(np.median(runs.lyapunov_error[0, :, 0])),
                float(sizes.mean()),
                float(sizes.std(ddof=1)),
                float(factors.mean()),
                float(factors.std(ddof=1)),
                tuple(sorted(set(runs.motion))),
                error=float(np.max(np.abs(_sizes(runs) / truth - 1.0))),
            )
        )
    progress(1.0, "done")
    return SweepConvergenceStudy(
        model.title or "model",
        starts,
        tuple(rungs),
        speed=speed_in_si(given),
        reference=f"{_FINER * max(steps)} steps and {max(counts)} periods, the mean over the states",
        warnings=tuple(notes),
    )


def _sizes(runs: SweepResult) -> np.ndarray:
    """Peak to peak and dynamic factor of the contact that moves most, the means over the states."""
    worst = int(np.argmax(runs.peak_to_peak[0].mean(axis=0)))
    return np.array([runs.peak_to_peak[0, :, worst].mean(), runs.dynamic_factor[0, :, worst].mean()])


def _one_motion(model: Model, operating: float, starts: int) -> tuple[float, list[str]]:
    """The speed nearest to the operating one, of a few, at which all states end on one motion, and what to say of that.

    Several motions at one point, each with its own values, show no error of steps or length.
    """
    speeds = [share * operating for share in _SHARES]
    runs = sweep(
        model, {"operation.speed": speeds}, initial_conditions=starts, throw=_THROW, discard=_SETTLE, sample=_TRIED
    )
    for k, speed in enumerate(speeds):
        # Contacts that hardly move have a peak to peak of rounding, which says nothing.
        sizes = runs.peak_to_peak[k]
        kinds = {runs.motion_at(k, r) for r in range(starts)}
        if len(kinds) == 1 and np.ptp(sizes, axis=0).max() <= _ALIKE * sizes.max():
            if k == 0:
                return speed, []
            rpm = [value * RPM_PER_RAD_S for value in (operating, speed)]
            return speed, [
                f"several motions coexist at {rpm[0]:.6g} rpm; this is {rpm[1]:.6g} rpm, where all states meet one"
            ]
    return operating, [
        "several motions coexist at this point: their values differ more than steps make them; give a speed"
    ]
