"""Sweeps over one or two parameters of a model: each point settles, is sampled, and is classified.

Which points of a sweep get a portrait, how long it is, and the runs that go on from where the counted ones ended.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Mapping, Sequence
from contextlib import closing
from dataclasses import replace
from functools import partial
from math import lcm

import numpy as np

from rotorgear.analysis.common.forecast import Forecast
from rotorgear.analysis.common.pool import Pool
from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.common.stream import Stream
from rotorgear.analysis.sweep.axes import Axis, along, axis_of, number_in, points_of
from rotorgear.analysis.sweep.between_ends import BetweenEnds
from rotorgear.analysis.sweep.blocks import Job, blocks, packed, run_blocks, unpacked, waves
from rotorgear.analysis.sweep.classify import CHAOS, FAILED, TOLERANCE, period_in
from rotorgear.analysis.sweep.gather import gathered
from rotorgear.analysis.sweep.point import Point, PointMaker, ready_reduced, table_of
from rotorgear.analysis.sweep.reduce import Large, Reducer
from rotorgear.analysis.sweep.request import Request, start_of, steps_of
from rotorgear.cpu import Clock, compiling_seconds, cpu_seconds
from rotorgear.errors import AnalysisError, RotorgearError
from rotorgear.model.model import Model, model_hash
from rotorgear.progress import Progress, silent
from rotorgear.results.portrait import Portraits
from rotorgear.results.sweep import Reduction, SweepResult
from rotorgear.solvers.batch.run_block import BatchPlan, Orbit, foretell_batches, trajectory
from rotorgear.solvers.sparse.factor import single_thread

# How many portraits, or the values of the parameters next to which points keep theirs.
WantedPortraits = int | Sequence[float | str | Sequence[float]]
# Share of the progress that making the points ready gets.
_READY = 0.1
# Where blocks are few: the share of the first pass from which on it is measured, and what all takes over that: certificates,
# errors, and as much again to settle; motions that do not settle run on.
_SEEN = 0.1
_WHOLE = 3.0
_LONGER = "in all, up to 8 times as long where motions do not settle"


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
    portraits: WantedPortraits = 0,
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
    clock = Clock()
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
    if not (model.meshes or model.nonlinear_elements or any(bearing.has_law for bearing in model.bearings.values())):
        raise AnalysisError(
            "nothing in the model is nonlinear (no mesh, nonlinear element, rolling bearing or film), so there is no motion to "
            "classify: rotorgear response gives its motion over speed, rotorgear transient over time"
        )
    axes = [axis_of(address, values) for address, values in over.items()]
    wanted = wanted_points(portraits, axes)
    with single_thread(0):
        models, points, failure, left_out, reduction = ready_points(model, axes, change, request, progress)
        chosen, refused = steps_of(points, steps)
        for i, reason in refused.items():
            points[i] = None
            failure[i] = reason
        if all(point is None for point in points):
            raise RotorgearError(next(filter(None, failure)))
        clock.lap("points")
        settings = {"models": "".join(models), "run": f"{request} {[axis.address for axis in axes]} {chosen.tolist()}"}
        kept = stream.begin(settings) if stream else []
        shape = [len(axis.values) for axis in axes]
        run = partial(run_blocks, workers=workers, executor=executor)
        plans = waves(shape, request.directions, request.initial_conditions)
        grouped = [blocks(jobs, points, chosen) for jobs in plans]
        foretell_batches()
        forecast = Forecast("sweep", clock.worked, sum(map(len, grouped)) - len(kept))
        orbits = _run(points, chosen, grouped, request, run, stream, kept, forecast, progress)
    clock.lap("integration")
    result = gathered(model, axes, points, failure, chosen, request, orbits, reduction, left_out)
    if wanted:
        result = replace(result, portraits=portraits_of(result, wanted, points, request, orbits, progress))
        clock.lap("portraits")
    progress(1.0, "done")
    return replace(result, seconds=clock.total())


def ready_points(
    model: Model,
    axes: Sequence[Axis],
    change: Callable[[Model, tuple[float, ...]], Model] | None,
    request: Request,
    progress: Progress,
) -> tuple[list[str], list[Point | None], list[str], list[tuple[str, ...]], Reduction | None]:
    """Hashes of the models, points made ready, why a point failed, what is left out of each model, and what was reduced."""
    maker = PointMaker(request.modes, request.elements)
    between = BetweenEnds(model, axes, along(model, axes), maker) if change is None else None
    change = change or along(model, axes)
    values = points_of(axes)
    texts = [repr(value) for value in values]
    failure = [""] * len(values)
    points: list[Point | None] = [None] * len(values)
    groups: dict[bytes, list[tuple[int, Large]]] = {}
    for i, value in enumerate(values):
        progress(_READY * i / len(values), f"point {i + 1} of {len(values)}")
        try:
            known = between(value) if between else None
            if known is not None:
                texts[i], make = known
                made = make()
            else:
                own = change(model, value)
                texts[i] = model_hash(own)
                made = maker(own)
        except RotorgearError as error:
            failure[i] = str(error)
            continue
        if isinstance(made, Large):
            groups.setdefault(made.key, []).append((i, made))
        else:
            points[i] = made
    reducer = Reducer(request.reduction_error, request.modes)
    for number, members in enumerate(groups.values()):
        text = f"basis {number + 1} of {len(groups)}: " if len(groups) > 1 else "basis: "

        def heard(size: int, error: float, text: str = text) -> None:
            progress(_READY, f"{text}{size} coordinates, {100.0 * error:.2g} % off")

        try:
            large = [one for _, one in members]
            for (i, _), point in zip(members, ready_reduced(large, reducer(large, heard)), strict=True):
                points[i] = point
        except RotorgearError as error:
            for i, _ in members:
                points[i] = None
                failure[i] = str(error)
    return texts, points, failure, maker.left_out, reducer.summary


def _run(
    points: Sequence[Point | None],
    steps: np.ndarray,
    waves_of: Sequence[list[list[Job]]],
    request: Request,
    run: Callable[..., Generator[list[Orbit]]],
    stream: Stream | None,
    kept: list[dict[str, np.ndarray]],
    forecast: Forecast,
    progress: Progress,
) -> dict[tuple[int, int], Orbit]:
    """Run all waves of blocks; blocks that were kept by an interrupted sweep are taken over."""
    orbit_of: dict[tuple[int, int], Orbit] = {}
    total = sum(len(block) for grouped in waves_of for block in grouped)
    done = 0
    start = cpu_seconds() - compiling_seconds()
    for grouped in waves_of:
        old = kept[: len(grouped)]
        kept = kept[len(grouped) :]
        for block, chunk in zip(grouped, old, strict=False):
            orbit_of.update(zip([job.key for job in block], unpacked(chunk), strict=True))
            done += len(block)
        rest = grouped[len(old) :]
        tasks = []
        for block in rest:
            own = [p for p in (points[job.point] for job in block) if p is not None]
            states = []
            for job, p in zip(block, own, strict=True):
                # A run starts at the end of the one before it, unless that failed.
                before = orbit_of.get((job.after, job.run)) if job.after is not None else None
                last = points[job.after] if job.after is not None else None
                if before is not None and last is not None and before.finite and last.system.size == p.system.size:
                    states.append(before.end.moved(last.system, p.system))
                else:
                    number = job.run % request.initial_conditions
                    states.append(start_of(p.system, number, request.seed, request.throw))
            # A system has no more exponents than states beside its rigid-body motions.
            most = 2 * (own[0].system.n - len(own[0].system.rigid))
            plan = BatchPlan(int(steps[block[0].point]), request.discard, request.sample, min(request.exponents, most))
            tasks.append(([p.bare for p in own], states, plan, request))
        begun = done
        runs = sum(map(len, rest))

        def heard(share: float, begun: int = begun, runs: int = runs) -> None:
            part = (begun + share * runs) / total
            progress(_READY + (1.0 - _READY) * part, f"about {100.0 * part:.0f} %")
            if forecast.few and part >= _SEEN:
                used = cpu_seconds() - compiling_seconds() - start
                forecast.tell(_WHOLE * used / part, _LONGER)

        with closing(run(tasks, heard=heard, spent=forecast.add)) as found:
            for block, orbits in zip(rest, found, strict=True):
                orbit_of.update(zip([job.key for job in block], orbits, strict=True))
                if stream:
                    stream.write(packed(orbits))
                done += len(block)
                progress(_READY + (1.0 - _READY) * done / total, f"{done} of {total} runs")
    return orbit_of


MOST_PORTRAITS = 16
# Common periods of a portrait: enough to tell subharmonics apart, fewer where the common period is long.
_LONGEST = 64
_SHORTEST = 8
_MOST_RECORDS = 100_000
# Records in a period of the fastest mesh that are kept at least.
_FEWEST = 20


def wanted_points(wanted: WantedPortraits, axes: Sequence[Axis]) -> list[int] | int:
    """The points next to values of the parameters, or how many are wanted anywhere.

    Raises:
        AnalysisError: too many, or values off the sweep.
    """
    count = wanted if isinstance(wanted, int) else len(wanted)
    if not 0 <= count <= MOST_PORTRAITS:
        raise AnalysisError(f"portraits: got {count}, expected 0 to {MOST_PORTRAITS} points")
    if isinstance(wanted, int):
        return wanted
    places = []
    for value in wanted:
        parts = value.split(",") if isinstance(value, str) else np.atleast_1d(np.asarray(value, dtype=float)).tolist()
        if len(parts) != len(axes):
            what = "a value" if len(axes) == 1 else "two values with a comma"
            raise AnalysisError(f"portrait: got '{value}', expected {what} of {' and '.join(a.address for a in axes)}")
        # The number of the nearest point: the last parameter runs fastest.
        place = 0
        for axis, part in zip(axes, parts, strict=True):
            number = number_in(axis, part, "portrait")
            all_of = np.array(axis.values)
            low, high = all_of.min(), all_of.max()
            if not low - 1e-9 * abs(low) <= number <= high + 1e-9 * abs(high):
                raise AnalysisError(
                    f"portrait: got '{part}', expected {axis.address} from {low:g} to {high:g} {axis.unit}".rstrip()
                )
            place = place * len(all_of) + int(np.argmin(np.abs(all_of - number)))
        places.append(place)
    return list(dict.fromkeys(places))


def spread(shape: Sequence[int], sound: Sequence[bool], count: int) -> list[int]:
    """Up to `count` sound points that cover the sweep: evenly along one parameter, or a grid over two."""
    if len(shape) == 1:
        own = np.flatnonzero(sound)
        return [int(own[i]) for i in _even(own.size, min(count, own.size))]
    rows = max(1, min(shape[0], int(np.sqrt(count))))
    columns = min(shape[1], count // rows)
    rows = min(shape[0], count // max(1, columns))
    grid = [i * shape[1] + k for i in _even(shape[0], rows) for k in _even(shape[1], columns)]
    return [p for p in grid if sound[p]]


def _even(size: int, count: int) -> list[int]:
    """`count` places that cover 0 to size - 1; the middle one for a single."""
    if count == 1:
        return [(size - 1) // 2]
    return [int(i) for i in np.linspace(0, size - 1, count).round()]


def length_of(turns: int, steps: int, repeats: int = 1) -> tuple[int, int]:
    """Common periods of a portrait, and the steps between two of its records; a motion that repeats is kept in whole periods."""
    own = turns * steps
    periods = int(np.clip(_MOST_RECORDS // own, _SHORTEST, _LONGEST))
    periods -= periods % repeats if repeats <= periods else 0
    divisors = [e for e in range(1, max(1, steps // _FEWEST) + 1) if own % e == 0]
    fitting = [e for e in divisors if periods * own // e <= _MOST_RECORDS]
    return periods, fitting[0] if fitting else divisors[-1]


def portraits_of(
    result: SweepResult,
    wanted: list[int] | int,
    points: Sequence[Point | None],
    request: Request,
    orbits: dict[tuple[int, int], Orbit],
    progress: Progress,
) -> Portraits | None:
    """Run the chosen points on from where their first runs ended; None where no point is sound."""
    sound = [not reason for reason in result.failure]
    chosen = (
        spread(result.shape.tolist(), sound, wanted) if isinstance(wanted, int) else [p for p in wanted if sound[p]]
    )
    if not chosen:
        return None
    begun = request.discard + request.sample
    runs = list(range(0, len(request.runs), request.initial_conditions))
    kinds = [[result.motion_at(p, run) for run in runs] for p in chosen]
    sizes = [
        length_of(int(result.turns[p]), int(result.steps[p]), lcm(*filter(None, map(period_in, own))))
        for p, own in zip(chosen, kinds, strict=True)
    ]
    periods, every = (np.array(x) for x in zip(*sizes, strict=True))
    records = result.turns[chosen] * result.steps[chosen] // every
    values = np.full((len(chosen), len(runs), int((periods * records).max()), len(result.contact), 3), np.nan)
    for k, p in enumerate(chosen):
        progress(1.0, f"portrait {k + 1} of {len(chosen)}")
        point = points[p]
        assert point is not None
        table = table_of(point, int(result.steps[p]))
        for j, run in enumerate(runs):
            if kinds[k][j] == FAILED:
                continue
            own = trajectory(point.system, orbits[p, run].end, table, int(result.steps[p]), *sizes[k], begun=begun)
            values[k, j, : len(own)] = own[:, point.system.columns.counted]
    return Portraits(np.array(chosen), np.array(runs), result.turns[chosen], periods, records, values)
