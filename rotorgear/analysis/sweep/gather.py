"""From the orbits of all points to the result of a sweep, with its warnings: points that failed or had not settled, parameters
without effect, slow transients."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from rotorgear.analysis.common.casings import time_warnings
from rotorgear.analysis.sweep.axes import Axis, points_of
from rotorgear.analysis.sweep.certify import STATED, bounded, indicators, judged, needed
from rotorgear.analysis.sweep.classify import CHAOTIC, FAILED, NOT_SETTLED, exponents, period_in
from rotorgear.analysis.sweep.inside import with_reduction
from rotorgear.analysis.sweep.point import Point
from rotorgear.analysis.sweep.request import Request
from rotorgear.model.model import Model
from rotorgear.note import Note
from rotorgear.results.sweep import Reduction, SweepResult
from rotorgear.solvers.batch.run_block import Orbit
from rotorgear.system.internal_loads import read_loads

# Decay exponent over the periods discarded: exp(-3) = 5 % of the initial deviation is left.
_FORGOTTEN = 3.0
# What a motion may be in the direction of a law, beside that direction, and still count as none.
_ROUNDING = 1e-9
# Sentences that are shown of those that do not hold for all points.
_SOME = 4


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
    points: Sequence[Point | None],
    failure: Sequence[str],
    steps: np.ndarray,
    request: Request,
    orbits: dict[tuple[int, int], Orbit],
    reduction: Reduction | None,
    left_out: Sequence[tuple[str, ...]],
) -> SweepResult:
    """Return the result; `left_out`: of each different model."""
    sound = [p for p in points if p is not None]
    contact = sound[0].contact
    p = len(points)
    r = len(request.runs)
    c = len(contact)
    t = max((o.growth.shape[1] for o in orbits.values()), default=0)
    section = np.full((p, r, request.sample, c, 2), np.nan)
    exponent = np.full((p, r, t), np.nan)
    error = np.full((p, r, t), np.nan)
    tables: dict[str, Any] = {name: np.full((p, r, c), np.nan) for name in _TABLES}
    statistics_error = np.full((p, r, c, len(STATED)), np.nan)
    gauges = read_loads(model)
    loads, load_error = np.full((2, p, r, len(gauges), 4), np.nan)
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
        section[i, run] = orbit.section[:, mesh]
        measures = indicators(orbit, mesh, int(steps[i]))
        for name, table in tables.items():
            table[i, run] = measures[name]
        statistics_error[i, run] = orbit.error
        loads[i, run] = orbit.loads
        load_error[i, run] = with_reduction(orbit.load_error, orbit.loads, reduction.loads if reduction else 0.0)
        k = orbit.growth.shape[1]
        exponent[i, run, :k], error[i, run, :k] = exponents(orbit.growth, float(point.system.turns))
        error[i, run, :k] = np.hypot(error[i, run, :k], orbit.doubt[:k])
        kind, settled = judged(orbit, point, request)
        motion[i * r + run] = kind if settled else NOT_SETTLED
    none = np.full((2, c), np.nan)
    both = [np.stack([q.static_force, q.stiffness]) if q and q.contact == contact else none for q in points]
    static, stiffness = np.stack(both, axis=1)
    warnings: list[str] = [*notes(axes, points, failed, motion, request.discard, orbits)]
    if reduction is not None and reduction.error > request.reduction_error:
        sizes = f"{100.0 * reduction.error:.2g} % off, beyond {100.0 * request.reduction_error:.2g} %"
        warnings.append(Note("", f"the reduction is {sizes}", "ask for more modes, or leave their number open"))
    if reduction is not None and reduction.loads > request.reduction_error:
        off = f"vibrations of loads inside shafts and couplings by up to {100.0 * reduction.loads:.2g} % off"
        warnings.append(Note("", f"the reduction leaves {off}", "their errors have it; more modes (--modes) lower it"))
    if request.elements is None and any(shaft.sections for shaft in model.shafts.values()):
        # The error of the default discretisation is not estimated.
        warnings.append(
            Note("", "each shaft segment has one element of second order", "compare with --elements 8, say")
        )
    # Modes of a casing may end too low for the point with the fastest excitation.
    fastest = max(sound, key=lambda point: point.system.w)
    warnings += time_warnings(model, fastest.forces.laws, fastest.system.w / fastest.order)
    return SweepResult(
        model=model,
        address=tuple(axis.address for axis in axes),
        unit=tuple(axis.unit for axis in axes),
        values=np.array(points_of(axes), dtype=float),
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
        settle=request.discard,
        count=request.sample,
        tolerance=request.tolerance,
        chaos=request.chaos,
        dofs=max(q.system.n for q in sound),
        method="Runge-Kutta of order 4 in SIMD batches of 32 points",
        warnings=tuple(warnings),
        left_out=left_out_of(left_out),
        portraits=None,
        statistic=STATED,
        statistics_error=statistics_error,
        load_points=tuple(gauges),
        load_unit=tuple(gauges.values()),
        load_statistics=loads,
        load_error=load_error,
        reduction=reduction,
        **tables,
    )


def notes(
    axes: Sequence[Axis],
    points: Sequence[Point | None],
    failed: Sequence[str],
    motion: Sequence[str],
    settle: int,
    orbits: dict[tuple[int, int], Orbit],
) -> Iterator[Note]:
    """Yield the warnings."""
    runs = len(motion) // max(1, len(points))
    sound = [q for q in points if q is not None]
    if count := sum(map(bool, failed)):
        yield Note("", f"{count} of {len(points)} points failed; the first", next(filter(None, failed)))
    if any(q.drift for q in sound):
        what = "the torques do not balance at some points"
        yield Note("", what, "the shafts drift off the prescribed rotation there")
    # Laws that take power from a motion whose speed the drive keeps.
    takers: set[str] = set()
    for q in sound:
        B = q.system.B
        pushed = np.any(np.abs(q.system.carried @ B) > _ROUNDING * np.linalg.norm(B, axis=0), axis=0)
        own = q.system.own
        places = zip(own.forces.laws, *own.place, strict=True)
        takers |= {law.title for law, first, count in places if pushed[first : first + count].any()}
    if takers:
        what = f"the loads do not give the power that {' and '.join(sorted(takers))} takes"
        why = "the drive makes up for it on all shafts, in proportion to their inertia, so that they keep their speed"
        yield Note("", what, f"{why}; with a drive at one end mean forces may be another by about that loss")
    if any(q.rolling for q in sound):
        what = "bearing cages never repeat with the teeth"
        yield Note("", what, "a response that rolling elements drive shows as quasi-periodic")
    if unsettled := sum(kind == NOT_SETTLED for kind in motion):
        why = "ask for more periods (--discard, --sample)"
        waits = [needed(orbit) for (i, run), orbit in orbits.items() if motion[i * runs + run] == NOT_SETTLED]
        if np.any(np.isfinite(waits)):
            why = f"by their exponents their starts decay in up to {np.nanmax(waits):.2g} periods (--discard)"
        yield Note("", f"{unsettled} of {len(motion)} runs had not settled", why)
    if solved := sum(orbit.jumped for orbit in orbits.values()):
        why = "their starts decay too slowly; Newton's method found where they end"
        yield Note("", f"{solved} of {len(motion)} runs went on from their periodic motion", why)
    if longer := [orbit.settled for orbit in orbits.values() if orbit.settled > settle and not orbit.jumped]:
        what = f"{len(longer)} of {len(motion)} runs settled for up to {max(longer)} periods"
        yield Note("", f"{what}, until their response type and their exponents agreed")
    # Runs of one point that end in different responses.
    kinds = [set(motion[i * runs : (i + 1) * runs]) - {NOT_SETTLED, FAILED} for i in range(len(points))]
    several = [found for found in kinds if len(found) > 1]
    if several:
        why = "--initial-conditions shows what share of the starts goes to each"
        yield Note("", f"different responses coexist at {len(several)} of {len(kinds)} points", why)
    # Chaos that a crisis has opened stays for thousands of periods, with the exponents of lasting chaos, and then leaves at once.
    if transient := sum(CHAOTIC in found and any(map(period_in, found)) for found in several):
        what = f"at {transient} of them a chaotic response stands beside one that repeats"
        why = "it may be a long transient that ends in that one; run it with ten times the --discard"
        yield Note("", what, why)
    for axis in idle(axes, points):
        yield Note("", f"{axis.address} has no effect on this model", "all its points are the same")
    # Where the transient has not decayed when sampling begins, a response may repeat after several T because of it.
    repeating = [
        orbit for (i, run), orbit in orbits.items() if period_in(motion[i * runs + run]) > 1 and orbit.growth.shape[1]
    ]
    if slow := sum(float(o.growth[:, 0].mean()) * o.settled > -_FORGOTTEN for o in repeating):
        what = f"{slow} of {len(repeating)} runs with 2T or longer have a transient that outlasts the periods that they settled"
        yield Note("", what, "their period may change with more --discard")


def left_out_of(models: Sequence[tuple[str, ...]]) -> tuple[str, ...]:
    """What is left out of all models of a sweep; of some of them only, the first such sentences."""
    found = list(dict.fromkeys(text for texts in models for text in texts))
    common = [text for text in found if all(text in texts for texts in models)]
    some = [text for text in found if text not in common]
    shown = [f"of some points: {text}" for text in some[:_SOME]]
    more = [f"of some points: {len(some) - _SOME} more such sentences"] if len(some) > _SOME else []
    return (*common, *shown, *more)


def idle(axes: Sequence[Axis], points: Sequence[Point | None]) -> list[Axis]:
    """Axes along which all systems are the same to the last bit."""
    seen: dict[bytes, int] = {}
    own = []
    for q in points:
        if q is None:
            own.append(-1)
            continue
        # All that a point's motion depends on.
        system = q.system
        matrices = (system.K, system.D, system.load, system.B, system.rest, system.own.forces.parameters)
        columns = (system.columns.kind, system.columns.mode, system.columns.values)
        parts = (*matrices, *columns, np.array([system.w, system.turns]))
        data = b"".join([*(np.ascontiguousarray(part).tobytes() for part in parts), q.shape])
        own.append(seen.setdefault(hashlib.blake2b(data).digest(), len(seen)))
    table = np.array(own).reshape([len(axis.values) for axis in axes])
    return [
        axis
        for at, axis in enumerate(axes)
        if len(set(axis.values)) > 1 and np.all(table == np.take(table, [0], axis=at))
    ]
