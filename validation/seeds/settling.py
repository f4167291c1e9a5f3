"""python -m validation.seeds.settling [NAME ...]: labels and numbers of the five systems after ten times the settling.

Of set 2 of the 24-dof pair it is thirty times. Where the longer run of set 2 has not settled by its own account, which 64
periods may be too few to tell, one that also counts so many times more periods decides. Prints each label that differs between
both runs, unless the shorter one says itself that it is open (not settled, or chaos beside a motion that repeats), and each
number of chaos that leaves the root of the sum of squares of both stated errors. Long: most names take one to twenty minutes of
a core, the map two hours. What has been run is kept (kept.py), so that an interrupted run goes on where it was.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial

import rotorgear as rg
from rotorgear.analysis.sweep.classify import NOT_SETTLED
from validation.seeds import kept, marine, pair24
from validation.seeds.motions import SO_FAR, kinds_so_far
from validation.seeds.rules import operand

TIMES = 10
TIMES_2 = 30
# Speeds of set 2 in one run.
_PART = 25
# What a run says itself that more time may change.
_OPEN = (NOT_SETTLED, SO_FAR)

Values = dict[str, float | str]


def changes(first: Mapping[str, float | str], later: Mapping[str, float | str]) -> Iterator[str]:
    """Yield what differs between the values of two runs; what is told of the runs themselves ("runs") is no result."""
    for key, one in first.items():
        other = later[key]
        is_open = any(label in str(one) for label in _OPEN)
        if "runs" not in key and not is_open and not agree(str(one), str(other)):
            yield f"{key}: {one} | {other}"


def agree(one: str, other: str) -> bool:
    """Whether two texts of values agree: within their errors, equal where they have none, texts word by word."""
    a, b = operand(one), operand(other)
    if isinstance(a, str) or isinstance(b, str):
        return one == other
    apart = 0.5 * abs(a.low + a.high - b.low - b.high)
    halves = [0.5 * (number.high - number.low) for number in (a, b)]
    behind = min(len(text.split()[0].partition(".")[2]) for text in (one, other))
    # Ends of several runs are no errors of a mean: their ranges need only meet.
    allowed = sum(halves) if " to " in one or " to " in other else math.hypot(*halves)
    return apart <= max(allowed, 1.01 * 10.0**-behind)


def labels(name: str, times: int) -> dict[str, float | str]:
    """Every label of a route or a set of points at so many times the settling of the page, by place; what was run is kept."""
    pieces = {f"{name}-{times}": lambda: RUNS[name](times)}
    return dict(kept.piece("settling", f"{name}-{times}", pieces)["values"])


def _torques(total: float, times: int) -> Values:
    settle = times * marine.SETTLE
    return dict(marine.indicators(marine.swept(list(marine.PRINTED.values()), total, settle=settle), "", settle=settle))


def _set_1(times: int) -> Values:
    """The page's rows, and the motion of each start."""
    settle = times * pair24.SETTLE
    result = pair24.route(pair24.MODEL, pair24.SPEEDS, settle, starts=pair24.STARTS)
    return {**pair24.of_set_1(result, settle), **_starts(result, [f"{rpm:.0f} rpm" for rpm in pair24.SPEEDS])}


def _starts(result: rg.SweepResult, points: Sequence[str]) -> Values:
    """The motion of each start at each point."""
    return {
        f"{point}, start {1 + start}": kind
        for p, point in enumerate(points)
        for start, kind in enumerate(kinds_so_far(result, p))
    }


def _set_2(name: str, speeds: Sequence[float], times: int) -> Values:
    """Labels over speeds in rpm; what the longer run alone leaves open is told by one that counts so many times longer, too."""
    found = _labels(speeds, times, 1)
    if times > 1:
        shorter = labels(name, 1)
        unclear = [rpm for rpm in speeds if found[f"{rpm:.0f} rpm"] == NOT_SETTLED != shorter[f"{rpm:.0f} rpm"]]
        if unclear:
            found |= _labels(unclear, times, times)
    return found


def _labels(speeds: Sequence[float], times: int, counts: int) -> Values:
    result = pair24.route(pair24.SECOND, speeds, times * pair24.SETTLE_2, counts * pair24.KEPT_2)
    return {f"{rpm:.0f} rpm": result.motion_at(p) for p, rpm in enumerate(speeds)}


def _trend(name: str, times: int) -> Values:
    """The page's motions and shares of time, which it rounds to 10 %, and the motion of each start."""
    result = pair24.apart(**pair24.TRENDS[name], settle=times * pair24.LONG_SETTLE)  # type: ignore[arg-type]
    points = [f"{name} {value:g}" for value in next(iter(pair24.TRENDS[name].values()))]
    found = _starts(result, points)
    for point, (motion, share) in zip(points, pair24.trend(result), strict=True):
        found |= {point: motion, f"{point}, share apart": f"{share} +- 10"}
    return found


def _clearance(times: int) -> Values:
    result = pair24.with_clearance(times * pair24.SETTLE_BEARINGS)
    found: Values = {}
    for p, (rpm, exponent) in enumerate(zip(pair24.SPEEDS_BEARINGS, pair24.clearance_exponents(result), strict=True)):
        found |= {f"{rpm:.0f} rpm": result.motion_at(p), f"exponent at {rpm:.0f} rpm": exponent}
    return found


def _way(total: float, times: int) -> Values:
    result = marine.way(total, times * marine.SETTLE)
    return {f"load ratio {at[0]:.2f}": name for at, name in zip(result.values, marine.way_names(result), strict=True)}


def _region(total: float, times: int) -> Values:
    return {"load ratios": marine.region(total, times * marine.SETTLE)}


def _map(times: int) -> Values:
    longer = (*marine.MAP_SETTLE, times * marine.MAP_SETTLE[-1])
    rows = marine.told_map() if times == 1 else marine.torque_map(settle=longer)
    return {
        f"{total / 1e3:.0f} kN m, load ratio {ratio:.2f}": NOT_SETTLED if region == marine.OPEN else region
        for total, row in zip(marine.TOTALS, rows, strict=True)
        for ratio, region in zip(marine.RATIOS, row, strict=True)
    }


def _friction(times: int) -> Values:
    return dict(marine.with_friction("", times * marine.SETTLE))


# What is run, at so many times the settling.
RUNS: dict[str, Callable[[int], Values]] = {
    "marine_30": partial(_torques, 30e3),
    "marine_35": partial(_torques, 35e3),
    "regions_30": partial(_region, 30e3),
    "regions_35": partial(_region, 35e3),
    "way_30": partial(_way, 30e3),
    "way_35": partial(_way, 35e3),
    "map": _map,
    "friction": _friction,
    "set1": _set_1,
    **{
        (name := f"set2_{1 + begin // _PART}"): partial(_set_2, name, pair24.SPEEDS_2[begin : begin + _PART])
        for begin in range(0, len(pair24.SPEEDS_2), _PART)
    },
    **{name: partial(_trend, name) for name in pair24.TRENDS},
    "clearance": _clearance,
}
NAMES = tuple(RUNS)


def times_of(name: str) -> int:
    """How many times the settling of the page the longer run takes."""
    return TIMES_2 if name.startswith("set2") else TIMES


def main() -> None:
    """Compare what is named, or all."""
    parser = argparse.ArgumentParser(
        prog="python -m validation.seeds.settling",
        description="Labels of the five systems after ten times the settling, of set 2 thirty times.",
    )
    parser.add_argument("names", nargs="*", metavar="NAME", choices=[*NAMES, []], help=", ".join(NAMES))
    for name in parser.parse_args().names or NAMES:
        first = labels(name, 1)
        found = list(changes(first, labels(name, times_of(name))))
        unsettled = [key for key, value in first.items() if value in _OPEN]
        print(f"{name}: {len(first)} values, {len(unsettled)} open, {len(found)} differ", flush=True)
        for line in found:
            print(f"  {line}", flush=True)


if __name__ == "__main__":
    main()
