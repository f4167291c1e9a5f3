"""Layouts beside differential evolution: is there a smaller penalty, or a smaller change, at a hundred times the cost?

    python -m validation.studies.layouts                      the split-torque gearbox (long)
    python -m validation.studies.layouts 10                   at so many times the cost
    python -m validation.studies.layouts 100 kept.npz 400     for 400 CPU s; the same again goes on from the file

`rotorgear optimise` looks for a 15 % margin of the first orders of all shafts and meshes at the operating speed. Differential
evolution (Storn and Price 1997, scipy's) then minimises the same penalty within the same bounds, for a multiple of its CPU
time.
"""

from __future__ import annotations

import sys
import time
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from scipy.optimize import OptimizeResult, differential_evolution

import rotorgear as rg
from rotorgear.analysis.common.excitation import excitation_orders
from rotorgear.analysis.layout.problem import Problem, bounds_of
from rotorgear.model.numbers import numbers_of
from rotorgear.solvers.sparse.factor import single_thread
from rotorgear.system.plan import Plan

FREE = "bearings.*.at, shafts.*.sections.*.outer_diameter"
MARGIN = 0.15
POPULATION = 4


class _SpentError(Exception):
    """The CPU time is spent."""


@dataclass
class Evolution:
    """Differential evolution on the penalty of a problem, in pieces that a file keeps.

    Attributes:
        problem: the layout.
        least_penalty, least_change: the smallest so far; the change of layouts that keep the margin.
        kept: how many kept it.
        solutions, spent: modal solutions and CPU s so far.
        population, values: of the last generation; the values of layouts that are known already.
    """

    problem: Problem
    least_penalty: float = np.inf
    least_change: float = np.inf
    kept: int = 0
    solutions: int = 0
    spent: float = 0.0
    population: np.ndarray | None = None
    values: dict[bytes, float] = field(default_factory=dict)

    def value(self, t: np.ndarray) -> float:
        """The penalty; where the margin is kept the smaller change wins, as in `optimise`."""
        known = self.values.get(np.round(t, 12).tobytes())
        if known is not None:
            return known
        self.solutions += 1
        states = self.problem.states(t)
        found = self.problem.penalty(states)
        if self.problem.margins_kept(states):
            change = float(np.sum((t - self.problem.start) ** 2))
            self.kept += 1
            self.least_change = min(self.least_change, change)
            self.least_penalty = 0.0
            return -1.0 / (1.0 + change)
        self.least_penalty = min(self.least_penalty, found)
        return found

    def run(self, seconds: float, file: Path | None) -> None:
        """Go on for so many CPU s in all, and write the file after every generation."""
        begun = time.process_time() - self.spent

        def value(t: np.ndarray) -> float:
            self.spent = time.process_time() - begun
            if self.spent > seconds:
                raise _SpentError
            return self.value(t)

        def keep(intermediate_result: OptimizeResult) -> None:
            self.population = np.array(intermediate_result.population)
            energies = intermediate_result.population_energies
            rows = zip(self.population, energies, strict=True)
            self.values = {np.round(t, 12).tobytes(): float(found) for t, found in rows}
            print(self.words, flush=True)
            if file is not None:
                np.savez(
                    file,
                    population=self.population,
                    energies=energies,
                    state=[self.least_penalty, self.least_change, self.kept, self.solutions, self.spent],
                )

        with suppress(_SpentError):
            differential_evolution(
                value,
                [(0.0, 1.0)] * len(self.problem.low),
                popsize=POPULATION,
                maxiter=100_000,
                tol=0.0,
                seed=1 + self.solutions,
                polish=False,
                init="sobol" if self.population is None else self.population,
                callback=keep,
            )

    def take(self, file: Path) -> None:
        """What an earlier piece came to."""
        with np.load(file) as data:
            self.population = data["population"]
            energies = data["energies"]
            state = data["state"]
        rows = zip(self.population, energies, strict=True)
        self.values = {np.round(t, 12).tobytes(): float(found) for t, found in rows}
        self.least_penalty = float(state[0])
        self.least_change = float(state[1])
        self.kept = int(state[2])
        self.solutions = int(state[3])
        self.spent = float(state[4])

    @property
    def words(self) -> str:
        """Where it stands."""
        return (
            f"evolution    penalty {self.least_penalty:.3g}, margin kept {self.kept} times, change {self.least_change:.4f}, "
            f"{self.solutions} solutions, {self.spent:.1f} CPU s"
        )


def main(times: float, file: Path | None, piece: float) -> int:
    """Print both; 1 where differential evolution found a smaller penalty or change."""
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
    evolution = Evolution(
        Problem(
            numbers, low, high, (model.operation.speed,), lines, Plan(1, 4), 1.265 * top, 1.01 * MARGIN, MARGIN, 0.01
        )
    )
    if file is not None and file.exists():
        evolution.take(file)
    with single_thread(0):
        evolution.run(min(times * cost, evolution.spent + piece), file)
    print(f"{evolution.words} ({evolution.spent / cost:.0f} times)")
    ok = result.reached and change <= evolution.least_change
    print("no worse than differential evolution" if ok else "WORSE than differential evolution")
    return 0 if ok else 1


if __name__ == "__main__":
    words = sys.argv[1:]
    sys.exit(
        main(
            float(words[0]) if words else 100.0,
            Path(words[1]) if len(words) > 1 else None,
            float(words[2]) if len(words) > 2 else np.inf,
        )
    )
