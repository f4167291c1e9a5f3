"""The runs of a sweep in waves of blocks: what may run side by side, in an order that does not depend on the workers."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from threading import Event
from typing import Any

import numpy as np

from rotorgear.analysis.common.pool import Pool, in_order
from rotorgear.analysis.sweep.certify import (
    STATED,
    bounded,
    judged,
    judged_statistics,
    left_of,
    sizes_of,
    to_certify,
    to_go_on,
)
from rotorgear.analysis.sweep.classify import QUASI_PERIODIC, period_in
from rotorgear.analysis.sweep.inside import load_errors, load_scatter
from rotorgear.analysis.sweep.multipliers import certificate
from rotorgear.analysis.sweep.point import Point, table_of
from rotorgear.analysis.sweep.request import Request
from rotorgear.solvers.batch.run_block import BatchPlan, Orbit, Start, run_block
from rotorgear.solvers.batch.small_system import steps_stable
from rotorgear.solvers.time.statistics import FINER, OF_ERROR, WINDOWS, compared, scatter_of_two

# Largest tables of one block, in numbers; wider ones are cut into narrower blocks.
_MOST_TABLE = 30_000_000
# What a stream keeps of an orbit beside its end.
_OF_ORBIT = (
    "section",
    "growth",
    "sums",
    "extremes",
    "finite",
    "doubt",
    "settled",
    "multiplier",
    "repeats",
    "away",
    "jumped",
    "before",
    "error",
    "loads",
    "load_error",
)
# Digits by which blocks are put in their order.
_DIGITS = 20
_FRACTION = 2**_DIGITS
# Rounds of settling that a run gets at most.
_ROUNDS = 4
# Least steps of the run that tells the error of exponents by half as many.
_LEAST_HALF = 60
# In steps that tell the errors of statistics a run has come to its motion after so many periods, and so many of them are looked
# at where it repeats.
_REACHED = 32
_REPEATED = 8
# Records made of the windows of a run that never repeats.
_DRAWS = 100
# No statistic is said to be better than this share of what others are. Extremes are those of steps, whose errors are of chance:
# they may be alike in both runs by luck, and then other extremes tell.
_LUCK = 0.1
_LUCK_OF_ENDS = 0.3
_ENDS = [STATED.index(what) for what in ("largest force", "transmission error", "approach", "penetration")]


@dataclass(frozen=True)
class Job:
    """A run: its point and number, and the (point, run) whose end it starts from; None for a start of its own."""

    point: int
    run: int
    after: int | None = None

    @property
    def key(self) -> tuple[int, int]:
        """Point and run."""
        return self.point, self.run


def waves(shape: Sequence[int], directions: Sequence[str], starts: int) -> list[list[Job]]:
    """Jobs by wave: all at once for runs from states of their own; along the first parameter for "up" and "down"."""
    first = shape[0]
    rest = int(np.prod(shape[1:], dtype=int))
    jobs: list[list[Job]] = [[] for _ in range(first if set(directions) & {"up", "down"} else 1)]
    for run, direction in enumerate(direction for direction in directions for _ in range(starts)):
        if direction == "each":
            jobs[0] += [Job(point, run) for point in range(first * rest)]
            continue
        step = -rest if direction == "up" else rest
        for wave, i in enumerate(range(first)[:: -1 if direction == "down" else 1]):
            jobs[wave] += [Job(i * rest + k, run, i * rest + k + step if wave else None) for k in range(rest)]
    return jobs


def blocks(jobs: Sequence[Job], points: Sequence[Point | None], steps: np.ndarray) -> list[list[Job]]:
    """Jobs that can run in one block each; the first blocks are from all over the sweep: their times tell those of all."""
    found = list(_contiguous(jobs, points, steps))
    # Van der Corput's sequence: the digits of the number, in base two, behind the point.
    return [block for _, block in sorted(enumerate(found), key=lambda one: _reversed(one[0] * _FRACTION // len(found)))]


def _reversed(number: int) -> int:
    return int(f"{number:0{_DIGITS}b}"[::-1], 2)


def _contiguous(jobs: Sequence[Job], points: Sequence[Point | None], steps: np.ndarray) -> Iterator[list[Job]]:
    kinds: dict[Any, list[Job]] = {}
    for job in jobs:
        point = points[job.point]
        if point is not None:
            kinds.setdefault((point.kind, int(steps[job.point])), []).append(job)
    for (_, count), members in kinds.items():
        width = _width([p for job in members if (p := points[job.point])], count)
        for at in range(0, len(members), width):
            yield members[at : at + width]


def _width(points: Sequence[Point], steps: int) -> int:
    """How many of some points of one kind one block takes, with their tables."""
    from rotorgear.solvers.contact.vectors import BATCH

    system = points[0].system
    size = (2 * system.turns * steps + 1) * len(system.columns.kind) * 4
    same = len({point.shape for point in points}) == 1
    return BATCH if same else int(np.clip(_MOST_TABLE // size, 1, BATCH))


def run_jobs(
    points: Sequence[Point],
    starts: Sequence[Start],
    plan: BatchPlan,
    request: Request,
    go_on: Callable[[], bool] | None = None,
) -> list[Orbit]:
    """Run the jobs of one block; those whose response type is not settled run on, in rounds of twice the length each.

    A run that is on its way to an orbit that Newton's method knows goes on from that orbit. One that leaves all bounds stays what
    it was after the periods that were asked for.
    """
    orbits = _run(points, starts, plan, go_on)
    chosen = list(range(len(orbits)))
    onward, jumped = _certify(points, orbits, starts, chosen, plan, request, go_on)
    asked = tuple(orbits)
    for number in range(_ROUNDS):
        chosen = [i for i in chosen if to_go_on(orbits[i], points[i], request)]
        if not chosen:
            break
        there = [i for i in chosen if i in jumped]
        underway = [i for i in chosen if i not in jumped]
        chosen = []
        for group, settle in ((there, plan.warm), (underway, max(plan.settle, plan.count) * 2**number)):
            longer = replace(plan, settle=settle)
            again = _run([points[i] for i in group], [onward[i] for i in group], longer, go_on) if group else []
            for i, orbit in zip(group, again, strict=True):
                settled = orbits[i].settled + plan.count + settle
                moved = orbits[i].jumped or i in jumped
                before = np.ptp(orbits[i].section[:, points[i].system.columns.counted, 0], axis=0)
                if bounded(orbit, points[i]):
                    chosen.append(i)
                    orbits[i] = replace(orbit, settled=settled, jumped=moved, before=before)
                else:
                    orbits[i] = asked[i]
        onward, jumped = _certify(points, orbits, starts, chosen, plan, request, go_on)
    # Errors of statistics by periods that follow, in smaller steps. Runge and Kutta's fourth order is not that of statistics:
    # impacts begin between steps, extremes and sides are those of steps.
    unknown = np.full((len(points[0].contact), len(STATED)), np.nan)
    orbits = [replace(orbit, error=unknown, load_error=np.full(orbit.loads.shape, np.nan)) for orbit in orbits]
    sound = [i for i, orbit in enumerate(orbits) if bounded(orbit, points[i])]
    kinds = {i: judged(orbits[i], points[i], request) for i in sound}
    wild = [i for i in sound if not period_in(kinds[i][0]) and kinds[i][0] != QUASI_PERIODIC]
    sound = [i for i in sound if i not in wild]
    for i, orbit in _in_finer_steps(points, orbits, {i: period_in(kinds[i][0]) for i in sound}, plan, go_on).items():
        counted = points[i].system.columns.counted
        (own, scales, by_count), (changed, _, _) = (judged_statistics(one, counted) for one in (orbits[i], orbit))
        error = compared(own, changed, scales, OF_ERROR, _LUCK)
        ends = (own[:, _ENDS], changed[:, _ENDS], scales[:, _ENDS])
        error[:, _ENDS] = compared(*ends, OF_ERROR, _LUCK_OF_ENDS)
        kind, stands = kinds[i]
        left = np.nan_to_num(orbits[i].away) if stands and period_in(kind) else 0.0
        inside = load_errors(orbits[i].loads, orbit.loads, float(left), (_LUCK, _LUCK_OF_ENDS))
        error = np.sqrt(error**2 + (by_count / FINER) ** 2 + (left * scales) ** 2)
        orbits[i] = replace(orbits[i], error=error, load_error=inside)
    for i, windows in _windows(points, orbits, wild, replace(plan, tangents=0), go_on).items():
        draws = np.random.default_rng(1).integers(0, len(windows), (_DRAWS, len(windows)))
        inside = load_scatter(orbits[i].loads, np.array([one.loads for one in windows]), draws)
        error = _scatter(orbits[i], windows, points[i].system.columns.counted, draws)
        orbits[i] = replace(orbits[i], error=error, load_error=inside)
    return orbits


def _in_finer_steps(
    points: Sequence[Point],
    orbits: Sequence[Orbit],
    periods: dict[int, int],
    plan: BatchPlan,
    go_on: Callable[[], bool] | None,
) -> dict[int, Orbit]:
    """The periods that follow the end of some runs, in smaller steps: few where a run repeats after `periods` of them."""
    found: dict[int, Orbit] = {}
    counts = {i: k * -(-_REPEATED // k) if k else plan.count for i, k in periods.items()}
    for count in sorted(set(counts.values())):
        own = [i for i in periods if counts[i] == count]
        finer = replace(plan, steps=FINER * plan.steps + 1, settle=min(_REACHED, plan.settle), count=count, tangents=0)
        width = _width([points[i] for i in own], finer.steps)
        for at in range(0, len(own), width):
            part = own[at : at + width]
            again = _run([points[i] for i in part], [orbits[i].end for i in part], finer, go_on)
            found.update(zip(part, again, strict=True))
    return found


def _windows(
    points: Sequence[Point],
    orbits: Sequence[Orbit],
    chosen: Sequence[int],
    plan: BatchPlan,
    go_on: Callable[[], bool] | None,
) -> dict[int, list[Orbit]]:
    """The periods that follow the end of some runs, in other steps, as windows one after the other."""
    found: dict[int, list[Orbit]] = {i: [] for i in chosen}
    last = list(orbits)
    short = replace(plan, settle=0, count=max(plan.count // WINDOWS, 1))
    for _ in range(WINDOWS):
        for i, orbit in zip(chosen, _in_other_steps(points, last, chosen, short, go_on), strict=True):
            last[i] = orbit
            found[i].append(orbit)
    return found


def _scatter(own: Orbit, windows: Sequence[Orbit], counted: np.ndarray, draws: np.ndarray) -> np.ndarray:
    """By how much statistics (c, s) of a run that never repeats differ from those of another one, in nineteen cases of twenty.

    From records as long, made of windows drawn with replacement; least and largest values are those of a quarter of them, for
    records made of the same windows mostly share the highest one. B. Efron, Ann. Stat. 7 (1979) 1.
    """
    from rotorgear.solvers.batch import kernel_parts as k

    contacts = int(counted.sum())
    sums = np.array([one.sums[counted] for one in windows])
    extremes = np.array([one.extremes for one in windows]).reshape(len(windows), 2, contacts, 2)

    def of(which: np.ndarray, ends: np.ndarray) -> np.ndarray:
        """Statistics (r, c, s) of r records, each of some windows, its least and largest values of some of them."""
        total = sums[which].sum(axis=1)
        for rows, end in (((k.D_MIN, k.X_MIN, k.F_MIN), np.min), ((k.D_MAX, k.X_MAX, k.F_MAX), np.max)):
            total[:, :, rows] = end(sums[ends][..., rows], axis=1)
        moved = np.stack([extremes[ends][..., 0].min(axis=1), extremes[ends][..., 1].max(axis=1)], axis=-1)
        # Records beside each other, as if they were contacts.
        side_by_side = replace(
            own, sums=total.reshape(-1, total.shape[-1]), extremes=moved.transpose(1, 0, 2, 3).reshape(-1, 2)
        )
        found = judged_statistics(side_by_side, np.ones(len(which) * contacts, bool))[0]
        return np.asarray(found.reshape(len(which), contacts, -1))

    scatter = scatter_of_two(of(draws, draws[:, : len(windows) // 4]))
    every = np.arange(len(windows))[None]
    between = np.abs(judged_statistics(own, counted)[0] - of(every, every)[0])
    return np.asarray(np.maximum(between, scatter))


def _in_other_steps(
    points: Sequence[Point],
    orbits: Sequence[Orbit],
    chosen: Sequence[int],
    plan: BatchPlan,
    go_on: Callable[[], bool] | None,
) -> list[Orbit]:
    """The periods that follow the end of some runs, in half as many steps, or twice as many where those would be unstable."""
    if not chosen:
        return []
    systems = [points[i] for i in chosen]
    half = plan.steps // 2
    enough = half >= max(_LEAST_HALF, *(steps_stable(point.system) for point in systems))
    other = replace(plan, steps=half if enough else 2 * plan.steps, settle=min(plan.warm, plan.settle))
    return _run(systems, [orbits[i].end for i in chosen], other, go_on)


def _certify(
    points: Sequence[Point],
    orbits: list[Orbit],
    starts: Sequence[Start],
    chosen: Sequence[int],
    plan: BatchPlan,
    request: Request,
    go_on: Callable[[], bool] | None,
) -> tuple[dict[int, Start], set[int]]:
    """Give the chosen orbits their step errors, multipliers and what is left of their starts.

    Return the state from which each runs on, and which of them go on from their orbits.

    Where sides part, tangents see the instant of that to a step only: exponents have an error of the step there. Multipliers
    certify an orbit where exponents do not.
    """
    from rotorgear.solvers.batch.kernel_parts import LOSSES
    from rotorgear.solvers.contact.vectors import BATCH

    parting = [i for i in chosen if orbits[i].finite and np.any(orbits[i].sums[:, LOSSES] > 0.0)]
    again = _in_other_steps(points, orbits, parting, plan, go_on)
    for i, orbit in zip(parting, again, strict=True):
        change = np.abs(orbit.growth.mean(axis=0) - orbits[i].growth.mean(axis=0)) / points[i].system.turns
        orbits[i] = replace(orbits[i], doubt=change)
    onward = {i: orbits[i].end for i in chosen}
    jumped: set[int] = set()
    for i in chosen:
        if not orbits[i].finite:
            continue
        orbits[i] = replace(orbits[i], away=left_of(orbits[i], starts[i], points[i]))
        periods, near = to_certify(orbits[i], points[i], request)
        if not periods:
            continue

        def advance(states: Sequence[Start], length: int, point: Point = points[i]) -> list[Start]:
            once = BatchPlan(plan.steps, 0, length, 0)
            cuts = (states[k : k + BATCH] for k in range(0, len(states), BATCH))
            return [one.end for own in cuts for one in _run([point] * len(own), own, once, go_on)]

        system = points[i].system
        sizes = sizes_of(orbits[i], system.columns.counted)
        seen = orbits[i].section[:, system.columns.counted].transpose(0, 2, 1) / np.array([[1.0], [system.w]])
        found = certificate(system, orbits[i].end, sizes, periods, advance, request.tolerance, seen, near)
        if found is None:
            continue
        orbits[i] = replace(orbits[i], multiplier=found.growth, repeats=found.repeats, away=found.away)
        onward[i] = found.onward
        if found.jumped:
            jumped.add(i)
    return onward, jumped


def _run(
    points: Sequence[Point], starts: Sequence[Start], plan: BatchPlan, go_on: Callable[[], bool] | None
) -> list[Orbit]:
    """Run systems side by side, with tables of what depends on time."""
    tables = {
        shape: table_of(point, plan.steps)
        for shape, point in {point.shape: point for point in reversed(points)}.items()
    }
    wide = [tables[point.shape] for point in points[: 1 if len(tables) == 1 else None]]
    return run_block([p.system for p in points], starts, wide, plan, go_on or (lambda: True))


def run_blocks(
    tasks: Sequence[tuple[list[Point], list[Start], BatchPlan, Request]],
    workers: int | None,
    executor: Pool | None,
    heard: Callable[[float], None] = lambda share: None,
    spent: Callable[[float], None] = lambda seconds: None,
) -> Generator[list[Orbit]]:
    """Yield the orbits of the blocks of a wave, in their order, from all cores or from an executor of the caller's.

    `heard` is told about which share of all is done, every second of work on cores here, and `spent` what each block took.
    """
    stop = Event()
    asked = 0
    total = 0 if executor else sum(plan.questions(own[0].system.turns) for own, _, plan, _ in tasks)

    def go_on() -> bool:
        nonlocal asked
        asked += 1
        return not stop.is_set()

    def watch() -> None:
        heard(min(1.0, asked / total))

    work = run_jobs if executor else partial(run_jobs, go_on=go_on)
    yield from in_order(work, tasks, workers, executor, watch=watch, stop=stop.set, spent=spent)


def packed(orbits: Sequence[Orbit]) -> dict[str, np.ndarray]:
    """Orbits of a block as arrays, for a stream."""
    fields = {name: np.stack([getattr(o, name) for o in orbits]) for name in _OF_ORBIT}
    return {**fields, "z": np.stack([o.end.z for o in orbits]), "dz": np.stack([o.end.dz for o in orbits])}


def unpacked(chunk: dict[str, np.ndarray]) -> list[Orbit]:
    """The orbits back."""
    return [
        Orbit(**{name: chunk[name][i] for name in _OF_ORBIT}, end=Start(z, dz))
        for i, (z, dz) in enumerate(zip(chunk["z"], chunk["dz"], strict=True))
    ]
