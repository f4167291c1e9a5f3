"""From the orbits of all points to the result of a sweep."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from rotorgear.analysis.sweep.axes import Axis
from rotorgear.analysis.sweep.certify import bounded, indicators, judged
from rotorgear.analysis.sweep.classify import FAILED, NOT_SETTLED, exponents
from rotorgear.analysis.sweep.notes import notes
from rotorgear.analysis.sweep.point import Point
from rotorgear.analysis.sweep.request import Request
from rotorgear.model.model import Model
from rotorgear.results.sweep import Reduction, SweepResult
from rotorgear.solvers.batch.run_block import Orbit
from rotorgear.solvers.time.statistics import STATISTICS

_TABLES = (
    "peak_to_peak",
    "peak_to_peak_transmission_error",
    "peak_to_peak_approach",
    "rms_approach",
    "mean_force",
    "rms_force",
    "largest_force",
    "driving",
    "apart",
    "back",
    "losses",
)


def gathered(
    model: Model,
    axes: Sequence[Axis],
    values: Sequence[tuple[float, ...]],
    points: Sequence[Point | None],
    failure: Sequence[str],
    steps: np.ndarray,
    request: Request,
    orbits: dict[tuple[int, int], Orbit],
    laps: dict[str, float],
    reduction: Reduction | None = None,
) -> SweepResult:
    """Return the result."""
    sound = [p for p in points if p is not None]
    contact = sound[0].contact
    p = len(points)
    r = len(request.runs)
    c = len(contact)
    t = max((o.growth.shape[1] for o in orbits.values()), default=0)
    section = np.full((p, r, request.count, c, 2), np.nan)
    exponent = np.full((p, r, t), np.nan)
    error = np.full((p, r, t), np.nan)
    tables: dict[str, Any] = {name: np.full((p, r, c), np.nan) for name in _TABLES}
    statistics_error = np.full((p, r, c, len(STATISTICS)), np.nan)
    motion = [FAILED] * (p * r)
    failed = list(failure)
    for (i, run), orbit in orbits.items():
        point = points[i]
        assert point is not None
        if point.contact != contact:
            failed[i] = "its contacts are not those of the other points"
            continue
        if not bounded(orbit, point):
            failed[i] = failed[i] or (
                f"the run '{request.runs[run]}' left all bounds: the motion is unstable; give more damping, or a backlash that "
                "bounds it"
            )
            continue
        mesh = point.system.columns.counted
        section_here = orbit.section[:, mesh]
        section[i, run] = section_here
        measures = indicators(orbit, mesh, int(steps[i]))
        for name, table in tables.items():
            table[i, run] = measures[name]
        statistics_error[i, run] = orbit.error
        k = orbit.growth.shape[1]
        exponent[i, run, :k], error[i, run, :k] = exponents(orbit.growth, float(point.system.turns))
        error[i, run, :k] = np.hypot(error[i, run, :k], orbit.doubt[:k])
        kind, settled = judged(orbit, point, int(steps[i]), request.judge)
        motion[i * r + run] = kind.kind if settled else NOT_SETTLED
    none = np.full((2, c), np.nan)
    both = [np.stack([q.static_force, q.stiffness]) if q and q.contact == contact else none for q in points]
    static, stiffness = np.stack(both, axis=1)
    warnings = notes(axes, points, failed, motion, request.settle, orbits)
    if reduction is not None and reduction.error > request.reduction_error:
        warnings += (
            f"the reduction is {100.0 * reduction.error:.2g} % off, beyond {100.0 * request.reduction_error:.2g} %: ask for "
            "more modes, or leave their number open",
        )
    return SweepResult(
        model=model,
        address=tuple(axis.address for axis in axes),
        unit=tuple(axis.unit for axis in axes),
        values=np.array(values, dtype=float),
        shape=np.array([len(axis.values) for axis in axes]),
        run=request.runs,
        contact=contact,
        frequency=np.array([q.system.w / (2.0 * np.pi) if q else np.nan for q in points]),
        turns=np.array([q.system.turns if q else 0 for q in points]),
        section=section,
        motion=tuple(motion),
        lyapunov=exponent,
        lyapunov_error=error,
        static_force=static,
        static_deflection=static / np.where(stiffness > 0.0, stiffness, np.nan),
        failure=tuple(failed),
        steps=steps,
        settle=request.settle,
        count=request.count,
        tolerance=request.tolerance,
        chaos=request.chaos,
        dofs=max(q.system.n for q in sound),
        seconds=laps,
        method="Runge-Kutta of order 4 in SIMD batches of 32 points",
        warnings=warnings,
        portraits=None,
        statistic=STATISTICS,
        statistics_error=statistics_error,
        reduction=reduction,
        **tables,
    )
