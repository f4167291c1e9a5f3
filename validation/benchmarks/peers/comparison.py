"""What the scripts share: median processor times over changing speeds, frequencies side by side."""

from __future__ import annotations

import contextlib
import io
import statistics
import time
import warnings
from collections.abc import Callable, Sequence

import numpy as np

from rotorgear.model.model import Model
from rotorgear.system.system import System

warnings.filterwarnings("ignore")
with contextlib.redirect_stdout(io.StringIO()):  # a library of its prints a notice
    import ross

AGREEMENT = 1e-5
_TURN = 0.1  # s


def assembled_system(model: Model, elements: int) -> System:
    """The system of a model with the matrices that a rotor of ROSS has when it is built."""
    system = System(model, elements)
    system.matrices()
    system.strain_factor()
    return system


def median_times(runs: Sequence[Callable[[float], object]], speed: float, turns: int) -> list[float]:
    """Median processor times in s of each run(speed) after a first one that is not counted.

    They take turns, so that a busy machine is as busy for all of them; a quick one is repeated for a tenth of a second in each.
    The speed changes a little from one to the next, so that nothing can be remembered.
    """
    times: list[list[float]] = [[] for _ in runs]
    for run in runs:
        run(speed)
    count = 0
    for _ in range(turns):
        for run, own in zip(runs, times, strict=True):
            before = len(own)
            while sum(own[before:]) < _TURN:
                count += 1
                start = time.process_time()
                run(speed * (1.0 + 1e-6 * count))
                own.append(time.process_time() - start)
    return [statistics.median(own) for own in times]


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


__all__ = ["AGREEMENT", "assembled_system", "median_times", "print_frequencies", "ross", "verdict"]
