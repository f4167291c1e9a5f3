"""Solves the models of a case and measures what its lines ask for.

Richardson's rule on two mesh stiffnesses k and r k, where the error goes with 1/k: f = f_2 + (f_2 - f_1)/(r - 1). The order p
of such an error, or of that of the element length, follows from the errors of two against the exact value, or from the
differences of three.
"""

from __future__ import annotations

import time
import tomllib
from dataclasses import dataclass, field
from importlib import import_module
from itertools import pairwise, product
from pathlib import Path
from typing import Any

import numpy as np

import rotorgear as rg
from rotorgear.errors import AnalysisError
from rotorgear.results.modal import ModalResult
from validation.case import Case, Expectation
from validation.quantities import FORCED, SHEET, TEETH, elastic, sheet_number, teeth_number

PAIR_AGREEMENT = 1e-10
MOST_RIGID = 6

Key = tuple[str, str, int | None, float | None, float | None]


@dataclass(frozen=True)
class Measured:
    """What a line of expected.csv measured: a number or a word, the dofs of its largest model, seconds, and what went wrong."""

    got: float | str
    dofs: int
    seconds: float
    complaint: str = ""


@dataclass
class Solver:
    """Solves each model of a case once for all lines that need it."""

    case: Case
    solved: dict[Key, tuple[ModalResult, float]] = field(default_factory=dict)

    def measure(self, line: Expectation) -> Measured:
        """Measure what a line asks for."""
        start = time.perf_counter()
        file = self.case.folder / line.model
        if line.model.endswith(".py"):
            # A program in the case's folder: its function measure(quantity, mode) returns the number.
            program = import_module(f"validation.{file.parent.parent.name}.{self.case.name}.{file.stem}")
            return Measured(float(program.measure(line.quantity, line.mode)), 0, time.perf_counter() - start)
        if line.quantity.startswith(SHEET):
            return Measured(sheet_number(file, line.quantity), 0, time.perf_counter() - start)
        if line.quantity.startswith(TEETH):
            number, dofs = teeth_number(file, line.quantity)
            return Measured(number, dofs, time.perf_counter() - start)
        if line.quantity in FORCED:
            elements = line.elements[0] if line.elements else None
            response = rg.response(rg.load(file), speeds=[line.speed], elements=elements, accuracy=line.accuracy)
            number = float(FORCED[line.quantity](response)[int(line.mode) - 1])
            return Measured(number, response.dofs, time.perf_counter() - start)
        kind, name = _split(line.quantity)
        runs = [self._solve(key) for key in keys(line)]
        values = [_pick(elastic(result, name), line.mode) for result, _ in runs]
        complaints = {complaint for _, complaint in values if complaint}
        got = _combine(kind, line, [value for value, _ in values], self.case)
        seconds = sum(seconds for _, seconds in runs)
        return Measured(got, max(result.dofs for result, _ in runs), seconds, "; ".join(sorted(complaints)))

    def _solve(self, key: Key) -> tuple[ModalResult, float]:
        if key not in self.solved:
            file, speed, elements, accuracy, stiffness = key
            model = _model(self.case.folder / file, stiffness)
            own = [line for line in self.case.expectations if line.quantity not in FORCED and key in keys(line)]
            count = max(_highest(line.mode) for line in own) + MOST_RIGID
            start = time.perf_counter()
            result = rg.modal(
                model,
                speed=speed or None,
                modes=count,
                elements=elements,
                accuracy=accuracy,
                error_estimate=not elements,
            )
            self.solved[key] = result, time.perf_counter() - start
        return self.solved[key]


def keys(line: Expectation) -> list[Key]:
    """List the solutions that a line needs."""
    return [
        (line.model, line.speed, elements, line.accuracy, stiffness)
        for elements, stiffness in product(line.elements or (None,), line.mesh_stiffness or (None,))
    ]


def _split(quantity: str) -> tuple[str, str]:
    for kind in ("order of ", "extrapolated "):
        if quantity.startswith(kind):
            return kind.split()[0], quantity.removeprefix(kind)
    return "", quantity


def _highest(mode: str) -> int:
    return max(int(part) for part in mode.replace("-", "+").split("+"))


def _model(file: Path, stiffness: float | None) -> rg.Model:
    """Load a model file; `stiffness` in N/m stands in for that of all its meshes."""
    if stiffness is None:
        return rg.load(file)
    data: dict[str, Any] = tomllib.loads(file.read_text(encoding="utf-8"))
    for mesh in data["meshes"].values():
        mesh["stiffness"] = stiffness
    return rg.Model(**data)


def _pick(values: np.ndarray, mode: str) -> tuple[float | str, str]:
    """Value of a mode, mean of a pair, or difference of two; and a complaint where a pair disagrees."""
    if "-" in mode:
        first, second = (float(values[int(part) - 1]) for part in mode.split("-"))
        return first - second, ""
    numbers = [int(part) - 1 for part in mode.split("+")]
    picked = values[numbers]
    if picked.dtype.kind == "U":
        return " ".join(sorted(set(picked.tolist()))), ""
    mean = float(picked.mean())
    apart = float(np.abs(picked - mean).max() / abs(mean)) if mean else 0.0
    return mean, f"the pair is {apart:.1e} apart" if apart > PAIR_AGREEMENT else ""


def _combine(kind: str, line: Expectation, values: list[float | str], case: Case) -> float | str:
    if not kind:
        return values[-1]
    numbers = [float(value) for value in values]
    steps = line.mesh_stiffness if len(line.mesh_stiffness) > 1 else line.elements
    ratio = steps[-1] / steps[-2]
    if kind == "extrapolated":
        return numbers[-1] + (numbers[-1] - numbers[-2]) / (ratio - 1.0)
    if len(numbers) == 2:
        exact = _exact(line, case)
        errors = [abs(number - exact) for number in numbers]
    else:
        errors = [abs(b - a) for a, b in pairwise(numbers)]
    return float(np.log(errors[-2] / errors[-1]) / np.log(ratio))


def _exact(line: Expectation, case: Case) -> float:
    """The exact value that a line with an order refers to: that of a refined line of the same model, speed and mode."""
    name = line.quantity.removeprefix("order of ")
    for other in case.expectations:
        same = (other.model, other.speed, other.quantity, other.mode) == (line.model, line.speed, name, line.mode)
        if same and other.accuracy:
            return other.number
    raise AnalysisError(f"{case.name}: '{line.quantity}' of {line.model} needs a refined line with the exact value")
