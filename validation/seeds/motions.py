"""Motions of a sweep from several starts, in words: what most starts end in, and numbers of chaos with their error.

A run on a regular motion gives the same number from every start of its basin. A chaotic one gives a sample: its mean over the
starts stands with the half-width of Student's interval of 99.73 %, that of three standard errors of a large sample. The largest
value in a chaotic motion grows with the length of the run; what stands then is that of the periods counted.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence

import numpy as np
from scipy.stats import norm
from scipy.stats import t as student

import rotorgear as rg
from rotorgear.analysis.sweep.classify import CHAOTIC, period_in

STARTS = 8
# Chaos from one start where another start ends in a motion that repeats: it may fall onto that one after a longer time.
SO_FAR = "chaotic so far"


def kinds(result: rg.SweepResult, point: int) -> list[str]:
    """Response types of all runs of a point."""
    return [result.motion_at(point, run) for run in range(len(result.run))]


def kinds_so_far(result: rg.SweepResult, point: int) -> list[str]:
    """Response types of all runs of a point, where chaos beside a motion that repeats counts as open."""
    found = kinds(result, point)
    beside = any(map(period_in, found))
    return [SO_FAR if kind == CHAOTIC and beside else kind for kind in found]


def most(found: Sequence[str]) -> str:
    """The response type that most runs end in; of two as frequent ones the one of the earlier run."""
    return Counter(found).most_common(1)[0][0]


def ends(found: Sequence[str]) -> str:
    """What runs end in: "2T 16 of 16", or "chaotic 13 of 16, 2T 3"."""
    (first, count), *others = Counter(found).most_common()
    rest = "".join(f", {kind} {n}" for kind, n in others)
    return f"{first} {count} of {len(found)}{rest}"


def number(values: np.ndarray, found: Sequence[str], digits: int) -> str:
    """A number of the motion that most runs end in; of chaos its mean over them, with its error.

    Args:
        values: (r,) of each run. found: response types of the runs. digits: behind the point, where the motion is regular.
    """
    kind = most(found)
    own = values[[one == kind for one in found]]
    if kind != CHAOTIC:
        return f"{np.median(own):.{digits}f}".replace("-0." + "0" * digits, "0." + "0" * digits)
    if len(own) < 3:
        return f"{own.mean():.1g} (too few starts for an error)"
    return stated(float(own.mean()), _factor(len(own)) * float(own.std(ddof=1)) / math.sqrt(len(own)))


def spread(values: np.ndarray, found: Sequence[str], digits: int) -> str:
    """An extreme of the motion that most runs end in; of chaos its smallest and largest value over them, "4.9 to 5.6".

    The largest value in chaos comes in bursts, so that neither its mean over a few runs nor an error of that is of use.
    """
    kind = most(found)
    own = values[[one == kind for one in found]]
    if kind != CHAOTIC:
        return f"{np.median(own):.{digits}f}"
    return f"{own.min():.{digits}f} to {own.max():.{digits}f}"


def order(names: Sequence[str]) -> str:
    """Names as they follow each other: "1T, 2T, chaotic"."""
    return ", ".join(name for i, name in enumerate(names) if i == 0 or name != names[i - 1])


def _factor(count: int) -> float:
    """Standard errors on either side of the mean in Student's interval of 99.73 %: 9.2 for 4 runs, 4.5 for 8, 3 for many."""
    return float(student.ppf(norm.cdf(3.0), count - 1))


def stated(value: float, error: float) -> str:
    """Text of a value and its error: "0.214 +- 0.012"; the error with one digit, rounded up."""
    if error <= 0.0:
        return f"{value:.4g}"
    place = math.floor(math.log10(error))
    unit = 10.0**place
    behind = max(0, -place)
    return f"{value:.{behind}f} +- {math.ceil(error / unit - 1e-9) * unit:.{behind}f}"


def route(result: rg.SweepResult, names: Sequence[str], form: str = ".0f") -> str:
    """Stretches of equal names over the first parameter: "1T to 4900, 2T to 5100"."""
    last = [i for i, name in enumerate(names) if i + 1 == len(names) or names[i + 1] != name]
    return ", ".join(f"{names[i]} to {result.values[i, 0]:{form}}" for i in last)


def static_share(result: rg.SweepResult) -> str:
    """The smallest number of runs that end in what the first one, from the static start, does at their point."""
    if len(result.run) == 1:
        return "static start alone"
    counts = [kinds(result, p).count(result.motion_at(p)) for p in range(len(result.values))]
    return f"as the static start {min(counts)} of {len(result.run)} or more"


def least_share(result: rg.SweepResult) -> str:
    """The smallest number of runs that end in what most of their point do: "5 of 8 starts or more"."""
    counts = [Counter(kinds(result, p)).most_common(1)[0][1] for p in range(len(result.values))]
    return f"{min(counts)} of {len(result.run)} starts or more"
