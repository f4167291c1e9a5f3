"""Sweeps over one or two parameters of a model: each point settles, is sampled, and is classified."""

from __future__ import annotations

import time as clock
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from rotorgear.analysis.common.pool import Pool
from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.sweep.axes import Axis, Family, axis_of, points_of
from rotorgear.analysis.sweep.blocks import Workers, blocks, packed, unpacked, waves
from rotorgear.analysis.sweep.classify import CHAOS, TOLERANCE
from rotorgear.analysis.sweep.gather import gathered
from rotorgear.analysis.sweep.notes import coarse_shafts, left_out_of, short_of_modes
from rotorgear.analysis.sweep.point import Point, PointMaker
from rotorgear.analysis.sweep.portrait import Wanted, portraits_of, wanted_points
from rotorgear.analysis.sweep.reduce import Large
from rotorgear.analysis.sweep.request import Request, start_of, steps_of
from rotorgear.analysis.sweep.shrink import shrunk
from rotorgear.analysis.transient.histories import Stream
from rotorgear.errors import RotorgearError
from rotorgear.model.model import Model, model_hash
from rotorgear.old_names import renamed_arguments
from rotorgear.progress import Progress, silent
from rotorgear.results.sweep import SweepResult
from rotorgear.solvers.lanes.lanes import Orbit, Plan, Start
from rotorgear.solvers.sparse.factor import single_thread

# Share of the progress that making the points ready gets.
_READY = 0.1


@renamed_arguments(starts="initial_conditions", settle="discard", count="sample")
@recorded
def sweep(
    model: Model,
    over: Mapping[str, str | Sequence[float | str]],
    *,
    change: Callable[[Model, tuple[float, ...]], Model] | None = None,
    direction: str = "each",
    initial_conditions: int = 1,
    discard: int = 300,
    sample: int = 200,
    exponents: int = 1,
    steps: int | None = None,
    tolerance: float = TOLERANCE,
    chaos: float = CHAOS,
    seed: int = 1,
    throw: float = 1.0,
    modes: int | None = None,
    reduction_error: float = 0.01,
    elements: int | None = None,
    portraits: Wanted = 0,
    workers: int | None = None,
    executor: Pool | None = None,
    stream: Stream | None = None,
    progress: Progress = silent,
) -> SweepResult:
    """Return Poincare sections, Lyapunov exponents, response types and indicators over one or two parameters of a model.

    Args:
        model: a model with meshes that have teeth. Beyond 80 degrees of freedom it is reduced (analysis/sweep/reduce.py).
        over: address in the model file with its values: FROM:TO:COUNT, or values with commas between; "*" in an address means
            all names there. Once or twice. In Python a mapping of addresses to such texts, or to numbers in SI or texts with
            units.
        change: returns the model at a point from the model and the values, in place of the addresses, which are then only
            names.
        direction: each (every point starts from its own static state), up or down (from where the point before ended), or both.
        initial_conditions: number of runs at each point: the first from the static equilibrium, the others from random states.
        discard: number of periods of the transient that are discarded, in least common periods of all meshes.
        sample: number of periods after them that are sampled.
        exponents: number of Lyapunov exponents; 0 for none.
        steps: number of Runge-Kutta steps (order 4) in a period of the fastest mesh (default: by the highest frequency of the
            model).
        tolerance: share of the peak-to-peak value within which a response repeats.
        chaos: Lyapunov exponent per mesh period above which a response is chaotic.
        seed: seed of the random states.
        throw: size of the random states; at 1 contacts are moved by up to some backlashes.
        modes: number of elastic modes that the model is reduced to, with the static shapes of contacts and loads, whatever the
            error.
        reduction_error: largest relative error of the receptances at the contacts that a reduction may make.
        elements: number of basic elements in each shaft segment (default: one of second order).
        portraits: number of points, spread over the sweep, that keep their trajectory over some periods more; or the values of
            the parameters, in their units, next to which points do: 3250.0 or "3250 rpm", with two parameters (3250.0, 20.0).
        workers: number of threads, on which the result does not depend (default: all cores).
        executor: runs the blocks of points in place of threads: `rotorgear.cluster(address)`, or any object with `submit`.
        stream: keeps blocks while the sweep goes on (`rotorgear.stream`), and starts an interrupted one again.
        progress: callable that is told fraction and step.

    Raises:
        AnalysisError: a request that makes no sense, or a model that sweeps don't take. Points that fail alone are kept as such.
    """
    begun = clock.perf_counter()
    request = Request(
        direction,
        initial_conditions,
        discard,
        sample,
        exponents,
        steps,
        tolerance,
        chaos,
        seed,
        throw,
        modes,
        reduction_error,
        elements,
    )
    axes = [axis_of(address, values) for address, values in over.items()]
    values = points_of(axes)
    wanted = wanted_points(portraits, axes)
    with single_thread(0):
        models, large, failure, left_out = _ready(model, axes, values, change, request, progress)
        points, failure, reduction = shrunk(large, failure, request.reduction, progress, _READY)
        chosen, refused = steps_of(points, steps)
        for i, reason in refused.items():
            points[i] = None
            failure[i] = reason
        if all(point is None for point in points):
            raise RotorgearError(next(filter(None, failure)))
        laps = {"points": clock.perf_counter() - begun}
        settings = {"models": "".join(models), "run": f"{request} {[axis.address for axis in axes]} {chosen.tolist()}"}
        kept = stream.begin(settings) if stream else []
        shape = [len(axis.values) for axis in axes]
        orbits = _run(points, chosen, shape, request, Workers(workers, executor), stream, kept, progress)
    laps["integration"] = clock.perf_counter() - begun - laps["points"]
    result = gathered(model, axes, values, points, failure, chosen, request, orbits, laps, reduction)
    result = replace(
        result,
        left_out=left_out_of(left_out),
        warnings=(*result.warnings, *coarse_shafts(model, elements), *short_of_modes(model, points)),
    )
    if wanted:
        result = replace(result, portraits=portraits_of(result, wanted, points, request, orbits, progress))
        laps["portraits"] = clock.perf_counter() - begun - laps["points"] - laps["integration"]
    laps["total"] = clock.perf_counter() - begun
    progress(1.0, "done")
    return replace(result, seconds=laps)


def _ready(
    model: Model,
    axes: Sequence[Axis],
    values: Sequence[tuple[float, ...]],
    change: Callable[[Model, tuple[float, ...]], Model] | None,
    request: Request,
    progress: Progress,
) -> tuple[list[str], list[Point | Large | None], list[str], list[tuple[str, ...]]]:
    """Hashes of the models, the points made ready, why a point failed, and what is left out of each different model."""
    maker = PointMaker(request.reduction, request.elements)
    family = None if change else Family(model, axes)
    texts: list[str] = []
    points: list[Point | Large | None] = []
    failure: list[str] = []
    for i, value in enumerate(values):
        progress(_READY * i / len(values), f"point {i + 1} of {len(values)}")
        point = None
        reason = ""
        text = repr(value)
        try:
            own = change(model, value) if change else family.at(value)  # type: ignore[union-attr]
            text = model_hash(own)
            point = maker(own)
        except RotorgearError as error:
            reason = str(error)
        texts.append(text)
        points.append(point)
        failure.append(reason)
    return texts, points, failure, maker.left_out


def _run(
    points: Sequence[Point | None],
    steps: np.ndarray,
    shape: Sequence[int],
    request: Request,
    pool: Workers,
    stream: Stream | None,
    kept: list[dict[str, np.ndarray]],
    progress: Progress,
) -> dict[tuple[int, int], Orbit]:
    """Run all jobs; blocks that were kept by an interrupted sweep are taken over."""
    orbit_of: dict[tuple[int, int], Orbit] = {}
    plans = waves(shape, request.directions, request.starts)
    total = sum(len(jobs) for jobs in plans)
    done = 0
    with pool:
        for jobs in plans:
            grouped = list(blocks(jobs, points, steps))
            old = kept[: len(grouped)]
            kept = kept[len(grouped) :]
            for block, chunk in zip(grouped, old, strict=False):
                orbit_of.update(zip([job.key for job in block], unpacked(chunk), strict=True))
                done += len(block)
            rest = grouped[len(old) :]
            tasks = []
            for block in rest:
                own = [p for p in (points[job.point] for job in block) if p is not None]
                states = [
                    _start(job.after, job.run, points, p, orbit_of, request) for job, p in zip(block, own, strict=True)
                ]
                # A system has no more exponents than states beside its rigid-body motions.
                most = 2 * (own[0].system.n - len(own[0].system.rigid))
                plan = Plan(int(steps[block[0].point]), request.settle, request.count, min(request.exponents, most))
                tasks.append(([p.bare for p in own], states, plan, request.judge))
            begun = done
            runs = sum(map(len, rest))

            def heard(share: float, begun: int = begun, runs: int = runs) -> None:
                part = (begun + share * runs) / total
                progress(_READY + (1.0 - _READY) * part, f"about {100.0 * part:.0f} %")

            for block, orbits in zip(rest, pool.run(tasks, heard), strict=True):
                orbit_of.update(zip([job.key for job in block], orbits, strict=True))
                if stream:
                    stream.write(packed(orbits))
                done += len(block)
                progress(_READY + (1.0 - _READY) * done / total, f"{done} of {total} runs")
    return orbit_of


def _start(
    after: int | None,
    run: int,
    points: Sequence[Point | None],
    point: Point,
    found: dict[tuple[int, int], Orbit],
    request: Request,
) -> Start:
    """Where a run starts: the end of the one before it, unless that failed."""
    before = found.get((after, run)) if after is not None else None
    old = points[after] if after is not None else None
    if before is not None and old is not None and before.finite and old.system.size == point.system.size:
        return before.end.moved(old.system, point.system)
    return start_of(point.system, run % request.starts, request.seed, request.throw)
