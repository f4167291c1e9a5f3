"""Value and uncertainty against run time of what a sweep tells of one point, over steps and length."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.sweep.sweep import sweep
from rotorgear.errors import AnalysisError
from rotorgear.model.model import Model
from rotorgear.progress import Progress, silent
from rotorgear.results.sweep_convergence import SweepConvergenceStudy, SweepRung

STEPS = (50, 100, 200, 400)
COUNTS = (50, 200, 800)
_SETTLE = 300
# Far enough apart for chaos to forget, near enough to stay with one motion.
_THROW = 1e-3


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
        model: a small model. speed: in rad/s or as a text; the operating speed where not given.
        steps: in a period of the fastest mesh. counts: least common periods that count. starts: states, at least 2.

    Raises:
        AnalysisError: fewer than two states, or a model that sweeps don't take.
    """
    if starts < 2:
        raise AnalysisError(f"starts: got {starts}, expected 2 or more, whose scatter is compared")
    given = speed if speed is not None else (model.operation.speed if model.operation else None)
    if given is None:
        raise AnalysisError("the model gives no speed of operation: ask for one (speed, or --speed)")
    plans = [(n, max(counts)) for n in steps] + [(max(steps) // 2, count) for count in counts[:-1]]
    rungs = []
    for number, (n, count) in enumerate(plans):
        progress(number / len(plans), f"{n} steps, {count} periods")
        runs = sweep(
            model,
            {"operation.speed": [given]},
            initial_conditions=starts,
            throw=_THROW,
            steps=n,
            discard=_SETTLE,
            sample=count,
        )
        worst = int(np.argmax(runs.peak_to_peak[0].mean(axis=0)))
        exponents = runs.lyapunov[0, :, 0]
        scatter = exponents.std(ddof=1) if np.ptp(exponents) else 0.0
        sizes = runs.peak_to_peak[0, :, worst]
        factors = runs.dynamic_factor[0, :, worst]
        rungs.append(
            SweepRung(
                n,
                count,
                runs.seconds["integration"] / starts,
                float(exponents.mean()),
                float(scatter),
                float(np.median(runs.lyapunov_error[0, :, 0])),
                float(sizes.mean()),
                float(sizes.std(ddof=1)),
                float(factors.mean()),
                float(factors.std(ddof=1)),
                tuple(sorted(set(runs.motion))),
            )
        )
    progress(1.0, "done")
    return SweepConvergenceStudy(model.title or "model", starts, tuple(rungs))
