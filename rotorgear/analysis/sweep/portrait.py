"""Which points of a sweep get a portrait, how long it is, and the runs that go on from where the counted ones ended."""

from __future__ import annotations

from collections.abc import Sequence
from math import lcm

import numpy as np

from rotorgear.analysis.sweep.axes import Axis, number_in
from rotorgear.analysis.sweep.classify import FAILED, period_in
from rotorgear.analysis.sweep.point import Point, table_of
from rotorgear.analysis.sweep.request import Request
from rotorgear.errors import AnalysisError
from rotorgear.progress import Progress
from rotorgear.results.portrait import Portraits
from rotorgear.results.sweep import SweepResult
from rotorgear.solvers.lanes.lanes import Orbit
from rotorgear.solvers.lanes.trajectory import recorded

MOST_PORTRAITS = 16
# Common periods: enough that subharmonics stand apart, fewer where the common period is long.
_LONGEST = 64
_SHORTEST = 8
_MOST_RECORDS = 100_000
# Records in a period of the fastest mesh that are kept at least.
_FEWEST = 20

Wanted = int | Sequence[float | str | Sequence[float]]


def wanted_points(wanted: Wanted, axes: Sequence[Axis]) -> list[int] | int:
    """The points next to values of the parameters, or how many are wanted anywhere.

    Raises:
        AnalysisError: too many, or values off the sweep.
    """
    count = wanted if isinstance(wanted, int) else len(wanted)
    if not 0 <= count <= MOST_PORTRAITS:
        raise AnalysisError(f"portraits: got {count}, expected 0 to {MOST_PORTRAITS} points")
    if isinstance(wanted, int):
        return wanted
    return list(dict.fromkeys(_nearest(value, axes) for value in wanted))


def _nearest(value: float | str | Sequence[float], axes: Sequence[Axis]) -> int:
    """Number of the point next to a value of each parameter."""
    parts = value.split(",") if isinstance(value, str) else np.atleast_1d(np.asarray(value, dtype=float)).tolist()
    if len(parts) != len(axes):
        what = "a value" if len(axes) == 1 else "two values with a comma"
        raise AnalysisError(f"portrait: got '{value}', expected {what} of {' and '.join(a.address for a in axes)}")
    place = 0
    for axis, part in zip(axes, parts, strict=True):
        number = number_in(axis, part, "portrait")
        all_of = np.array(axis.values)
        if not all_of.min() - 1e-9 * abs(all_of.min()) <= number <= all_of.max() + 1e-9 * abs(all_of.max()):
            raise AnalysisError(
                f"portrait: got '{part}', expected {axis.address} from {all_of.min():g} to {all_of.max():g} {axis.unit}".rstrip()
            )
        place = place * len(all_of) + int(np.argmin(np.abs(all_of - number)))
    return place


def spread(shape: Sequence[int], sound: Sequence[bool], count: int) -> list[int]:
    """Up to `count` sound points that cover the sweep: evenly along one parameter, or a grid over two."""
    if len(shape) == 1:
        own = np.flatnonzero(sound)
        return [] if not own.size or not count else [int(own[i]) for i in _even(own.size, min(count, own.size))]
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
    """Run the chosen points on from where they ended, those that were not thrown at random; None where no point is sound."""
    sound = [not reason for reason in result.failure]
    chosen = (
        spread(result.shape.tolist(), sound, wanted) if isinstance(wanted, int) else [p for p in wanted if sound[p]]
    )
    if not chosen:
        return None
    begun = request.settle + request.count
    runs = list(range(0, len(request.runs), request.starts))
    kinds = [[result.motion_at(p, run) for run in runs] for p in chosen]
    sizes = [
        length_of(int(result.turns[p]), int(result.steps[p]), lcm(*map(period_in, own)))
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
            own = recorded(point.system, orbits[p, run].end, table, int(result.steps[p]), *sizes[k], begun=begun)
            values[k, j, : len(own)] = own[:, point.system.columns.counted]
    return Portraits(np.array(chosen), np.array(runs), result.turns[chosen], periods, records, values)
