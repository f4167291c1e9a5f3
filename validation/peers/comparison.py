"""What the scripts share: median processor times over changing speeds, frequencies side by side."""

from __future__ import annotations

import contextlib
import io
import statistics
import time
import warnings
from collections.abc import Callable
from typing import TypeVar

import numpy as np

warnings.filterwarnings("ignore")
with contextlib.redirect_stdout(io.StringIO()):  # a library of its prints a notice
    import ross

T = TypeVar("T")
AGREEMENT = 1e-5


def median_time(run: Callable[[float], T], speed: float, repetitions: int) -> tuple[float, T]:
    """Median processor time in s of run(speed) after a first one that is not counted, and the result at `speed` itself.

    The speed changes a little from one repetition to the next, so that nothing can be remembered.
    """
    result = run(speed)
    times = []
    for k in range(repetitions):
        start = time.process_time()
        run(speed * (1.0 + 1e-6 * (k + 1)))
        times.append(time.process_time() - start)
    return statistics.median(times), result


def print_frequencies(name: str, theirs: np.ndarray, ours: np.ndarray) -> float:
    """Print two ascending lists of frequencies in Hz; return the largest relative difference."""
    difference = np.abs(ours / theirs - 1.0)
    print(f"{'mode':>4}  {name + ' Hz':>14}  {'rotorgear Hz':>14}  {'difference':>10}")
    for k, row in enumerate(zip(theirs, ours, difference, strict=True), start=1):
        print(f"{k:4d}  {row[0]:14.7f}  {row[1]:14.7f}  {row[2]:10.1e}")
    return float(difference.max())


def verdict(worst: float, ratio: float, target: float) -> int:
    """Print whether frequencies and the ratio of solution times are what was aimed at; 0 if both, else 1."""
    good = worst <= AGREEMENT and ratio >= target
    print(f"largest difference {worst:.1e} (aim {AGREEMENT:g}), {ratio:.1f} times as fast (aim {target:g})")
    return 0 if good else 1


__all__ = ["AGREEMENT", "median_time", "print_frequencies", "ross", "verdict"]
