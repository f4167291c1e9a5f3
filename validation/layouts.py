"""Layouts beside differential evolution: is there a smaller penalty, or a smaller change, at a hundred times the cost?

    python -m validation.layouts           the split-torque gearbox (long)
    python -m validation.layouts 10        at so many times the cost

`rotorgear optimise` looks for a 15 % margin of the first orders of all shafts and meshes at the operating speed. Differential
evolution (Storn and Price 1997, scipy's) then minimises the same penalty within the same bounds, for a multiple of its CPU
time.
"""

from __future__ import annotations

import sys
import time
from contextlib import suppress

import numpy as np
from scipy.optimize import differential_evolution

import rotorgear as rg
from rotorgear.analysis.common.excitation import excitation_orders
from rotorgear.analysis.layout.bounds import bounds_of
from rotorgear.analysis.layout.problem import Problem
from rotorgear.model.numbers import numbers_of
from rotorgear.solvers.sparse.factor import single_thread
from rotorgear.system.plan import Plan

FREE = "bearings.*.at, shafts.*.sections.*.outer_diameter"
MARGIN = 0.15
POPULATION = 4


class _SpentError(Exception):
    """The CPU time is spent."""


def main(times: float) -> int:
    """Print both; 1 where differential evolution found a smaller penalty."""
    model = rg.load("models/split_torque.toml")
    begun = time.process_time()
    result = rg.optimise(model, FREE, margin=MARGIN, searches=1)
    cost = time.process_time() - begun
    change = sum(((row.after - row.before) / (row.high - row.low)) ** 2 for row in result.numbers)
    print(
        f"gradients    reached {result.reached}, change {change:.4f}, {result.solutions} solutions, {cost:.1f} CPU s",
        flush=True,
    )
    numbers = numbers_of(model, FREE)
    low, high, _ = bounds_of(numbers, {})
    assert model.operation is not None
    assert model.operation.speed is not None
    lines = excitation_orders(model, (1,), (1,))
    top = max(line.frequency_hz(model.operation.speed) for line in lines)
    problem = Problem(
        numbers, low, high, (model.operation.speed,), lines, Plan(1, 4), 1.265 * top, 1.01 * MARGIN, MARGIN, 0.01
    )
    best = [np.inf, np.inf, 0]
    begun = time.process_time()

    def value(t: np.ndarray) -> float:
        if time.process_time() - begun > times * cost:
            raise _SpentError
        states = problem.states(t)
        found = problem.penalty(states)
        if problem.margins_kept(states):
            best[2] += 1
            best[1] = min(best[1], float(np.sum((t - problem.start) ** 2)))
            found = 0.0
        best[0] = min(best[0], found)
        # Where the margin is kept the smaller change wins, as in `optimise`.
        return found if found else -1.0 / (1.0 + float(np.sum((t - problem.start) ** 2)))

    with single_thread(0), suppress(_SpentError):
        differential_evolution(
            value,
            [(0.0, 1.0)] * len(low),
            popsize=POPULATION,
            maxiter=100_000,
            tol=0.0,
            seed=1,
            polish=False,
            init="sobol",
        )
    spent = time.process_time() - begun
    print(
        f"evolution    penalty {best[0]:.3g}, margin kept {best[2]} times, change {best[1]:.4f}, {problem.solutions} solutions, "
        f"{spent:.1f} CPU s ({spent / cost:.0f} times)"
    )
    ok = result.reached and change <= best[1]
    print("no worse than differential evolution" if ok else "WORSE than differential evolution")
    return 0 if ok else 1


if __name__ == "__main__":
    sys.exit(main(float(sys.argv[1]) if len(sys.argv) > 1 else 100.0))
