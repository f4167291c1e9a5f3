"""python -m validation.seeds.settling [NAME ...]: labels and numbers of the five systems after ten times the settling.

Of set 2 of the 24-dof pair it is thirty times. Where the longer run of a route has not settled by its own account, which 64
periods may be too few to tell, one that also counts so many times more periods decides. Prints each label that differs between
both runs, unless the shorter one says that it has not settled, and each number of chaos that leaves the root of the sum of
squares of both stated errors. Long: each name takes one to ten minutes of a core. What has been run is kept (kept.py), so that
an interrupted run goes on where it was.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial

from validation.seeds import kept, marine, pair24
from validation.seeds.motions import kinds

TIMES = 10
TIMES_2 = 30
# Speeds of set 2 in one run.
_PART = 25
_OPEN = "not settled"

Values = dict[str, float | str]


def changes(first: Mapping[str, float | str], later: Mapping[str, float | str]) -> Iterator[str]:
    """Yield what differs between the values of two runs; counts of starts and settling are no results."""
    for key, one in first.items():
        other = later[key]
        if "runs" not in key and _OPEN not in str(one) and not agree(str(one), str(other)):
            yield f"{key}: {one} | {other}"


def agree(one: str, other: str) -> bool:
    """Whether two texts of values agree: within their errors, equal where they have none, texts word by word."""
    numbers = [_number(text) for text in (one, other)]
    if None in numbers:
        return one == other
    (a, ea), (b, eb) = (number for number in numbers if number)
    behind = min(len(text.split()[0].partition(".")[2]) for text in (one, other))
    return abs(a - b) <= max(math.hypot(ea, eb), 1.01 * 10.0**-behind)


def _number(text: str) -> tuple[float, float] | None:
    value, _, error = text.partition(" +- ")
    try:
        return float(value), float(error or 0.0)
    except ValueError:
        return None


def labels(name: str, times: int) -> dict[str, float | str]:
    """Every label of a route or a set of points at so many times the settling of the page, by place; what was run is kept."""
    pieces = {f"{name}-{times}": lambda: RUNS[name](times)}
    return dict(kept.piece("settling", f"{name}-{times}", pieces)["values"])


def _torques(total: float, times: int) -> Values:
    settle = times * marine.SETTLE
    return dict(marine.indicators(marine.swept(list(marine.PRINTED.values()), total, settle=settle), "", settle=settle))


def _route(name: str, model: str, speeds: Sequence[float], settle: int, times: int) -> Values:
    """Labels over speeds in rpm; what the longer run alone leaves open is told by one that counts so many times longer, too."""
    found = _labels(model, speeds, times * settle)
    if times > 1:
        shorter = labels(name, 1)
        unclear = [rpm for rpm in speeds if found[f"{rpm:.0f} rpm"] == _OPEN != shorter[f"{rpm:.0f} rpm"]]
        if unclear:
            found |= _labels(model, unclear, times * settle, times * pair24.KEPT)
    return found


def _labels(model: str, speeds: Sequence[float], settle: int, count: int = pair24.KEPT) -> Values:
    result = pair24.route(model, speeds, settle, count=count)
    return {f"{rpm:.0f} rpm": result.motion_at(p) for p, rpm in enumerate(speeds)}


def _way(total: float, times: int) -> Values:
    result = marine.way(total, times * marine.SETTLE)
    return {f"load ratio {at[0]:.2f}": result.motion_at(p) for p, at in enumerate(result.values)}


def _trend(name: str, times: int) -> Values:
    result = pair24.apart(**pair24.TRENDS[name], settle=times * pair24.LONG_SETTLE)  # type: ignore[arg-type]
    return {f"{name} {p}": ", ".join(sorted(kinds(result, p))) for p in range(len(result.values))}


# What is run, at so many times the settling.
RUNS: dict[str, Callable[[int], Values]] = {
    "marine_30": partial(_torques, 30e3),
    "marine_35": partial(_torques, 35e3),
    "way_30": partial(_way, 30e3),
    "way_35": partial(_way, 35e3),
    "set1": partial(_route, "set1", pair24.MODEL, pair24.SPEEDS, pair24.SETTLE),
    **{
        (name := f"set2_{1 + begin // _PART}"): partial(
            _route, name, pair24.SECOND, pair24.SPEEDS_2[begin : begin + _PART], pair24.SETTLE_2
        )
        for begin in range(0, len(pair24.SPEEDS_2), _PART)
    },
    **{name: partial(_trend, name) for name in pair24.TRENDS},
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
        unsettled = [key for key, value in first.items() if value == _OPEN]
        print(f"{name}: {len(first)} values, {len(unsettled)} not settled, {len(found)} differ", flush=True)
        for line in found:
            print(f"  {line}", flush=True)


if __name__ == "__main__":
    main()
