"""python -m validation.seeds.settling [NAME ...]: labels and numbers of the five systems after ten times the settling.

Prints each label that differs between both runs, unless the shorter one says that it has not settled, and each number of chaos
that leaves the root of the sum of squares of both stated errors. Long: some ten minutes of one core for each name.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable, Iterator, Mapping

from validation.seeds import marine, pair24
from validation.seeds.motions import kinds

TIMES = 10


def changes(first: Mapping[str, float | str], later: Mapping[str, float | str]) -> Iterator[str]:
    """Yield what differs between the values of two runs; counts of starts and settling are no results."""
    for key, one in first.items():
        other = later[key]
        if "runs" not in key and "not settled" not in str(one) and not agree(str(one), str(other)):
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
    """Every label of a route or a set of points at so many times the settling of the page, by place."""
    runs: dict[str, Callable[[], object]] = {
        "marine": lambda: marine.torque_indicators(times * marine.SETTLE),
        "set1": lambda: _route(pair24.MODEL, pair24.SPEEDS, times * pair24.SETTLE),
        "set2": lambda: _route(pair24.SECOND, pair24.SPEEDS_2, times * pair24.SETTLE_2),
        "way": lambda: _way(30e3, times) | _way(35e3, times),
        "trends": lambda: _trends(times),
    }
    return runs[name]()  # type: ignore[return-value]


def _route(model: str, speeds: tuple[float, ...], settle: int) -> dict[str, float | str]:
    result = pair24.route(model, speeds, settle)
    return {f"{rpm:.0f} rpm": result.motion_at(p) for p, rpm in enumerate(speeds)}


def _way(total: float, times: int) -> dict[str, float | str]:
    result = marine.way(total, times * marine.SETTLE)
    found = [result.motion_at(p) for p in range(len(result.values))]
    return {
        f"{total / 1e3:.0f} kN m, load ratio {at[0]:.2f}": kind for at, kind in zip(result.values, found, strict=True)
    }


def _trends(times: int) -> dict[str, float | str]:
    found: dict[str, float | str] = {}
    for name, over in pair24.TRENDS.items():
        result = pair24.apart(**over, settle=times * pair24.LONG_SETTLE)  # type: ignore[arg-type]
        found |= {f"{name} {p}": ", ".join(sorted(kinds(result, p))) for p in range(len(result.values))}
    return found


NAMES = ("marine", "set1", "set2", "way", "trends")


def main() -> None:
    """Compare what is named, or all."""
    parser = argparse.ArgumentParser(
        prog="python -m validation.seeds.settling",
        description="Labels of the five systems after ten times the settling.",
    )
    parser.add_argument("names", nargs="*", metavar="NAME", choices=[*NAMES, []], help=", ".join(NAMES))
    for name in parser.parse_args().names or NAMES:
        first = labels(name, 1)
        found = list(changes(first, labels(name, TIMES)))
        unsettled = [key for key, value in first.items() if value == "not settled"]
        print(f"{name}: {len(first)} values, {len(unsettled)} not settled, {len(found)} differ", flush=True)
        for line in found:
            print(f"  {line}", flush=True)


if __name__ == "__main__":
    main()
