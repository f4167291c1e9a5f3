"""What a sweep was asked for: runs of each point, their states to start from, and the steps of each point."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rotorgear.analysis.sweep.point import Point
from rotorgear.analysis.sweep.reduce import MOST_COORDINATES
from rotorgear.errors import AnalysisError
from rotorgear.solvers.batch.run_block import Start
from rotorgear.solvers.batch.small_system import SmallSystem, steps_needed, steps_stable

DIRECTIONS = ("each", "up", "down", "both")
MOST_STEPS = 5000
LEAST_STEPS = 200
# Least and most of each argument.
_LIMITS = {
    "initial_conditions": (1, 1000),
    "discard": (0, 10_000_000),
    "sample": (1, 10_000_000),
    "exponents": (0, math.inf),
    "seed": (0, math.inf),
    "throw": (0, math.inf),
    "steps": (8, 100_000),
    "modes": (1, MOST_COORDINATES),
    "elements": (1, 1000),
}


@dataclass(frozen=True)
class Request:
    """What every point of a sweep gets; see `sweep`."""

    direction: str
    initial_conditions: int
    discard: int
    sample: int
    exponents: int
    steps: int | None
    tolerance: float
    chaos: float
    seed: int
    throw: float = 1.0
    modes: int | None = None
    reduction_error: float = 0.01
    elements: int | None = None

    def __post_init__(self) -> None:
        if self.direction not in DIRECTIONS:
            raise AnalysisError(f"direction: got '{self.direction}', expected one of {', '.join(DIRECTIONS)}")
        for name, (least, most) in _LIMITS.items():
            value = getattr(self, name)
            if value is not None and (not least <= value <= most or value == math.inf):
                limits = f"{least} or more" if most == math.inf else f"{least} to {most}"
                raise AnalysisError(f"{name}: got {value}, expected {limits}")
        for name in ("tolerance", "chaos", "reduction_error"):
            if not 0.0 < getattr(self, name) < 1.0:
                raise AnalysisError(f"{name}: got {getattr(self, name):g}, expected a number between 0 and 1")

    @property
    def directions(self) -> tuple[str, ...]:
        """The directions that runs go."""
        return ("up", "down") if self.direction == "both" else (self.direction,)

    @property
    def runs(self) -> tuple[str, ...]:
        """Names of the runs of each point."""

        def name(direction: str, number: int) -> str:
            way = "" if direction == "each" else direction
            start = f"start {number + 1}" if number else "" if way else "static"
            return f"{way} {start}".strip()

        return tuple(
            name(direction, number) for direction in self.directions for number in range(self.initial_conditions)
        )


def start_of(system: SmallSystem, number: int, seed: int, throw: float = 1.0) -> Start:
    """State that a run starts from: the static one at rest, or for number > 0 one that is thrown off it at random.

    The velocities are drawn in the directions of the contacts, so that contacts move by up to `throw` times twice their
    deflection and backlash in a radian of the mesh.
    """
    if number == 0:
        return Start(system.rest.copy(), np.zeros(system.n))
    mesh = system.columns.counted
    B = system.B[:, mesh]
    reach = np.abs(B.T @ system.rest)
    clearance = system.columns.clearance[mesh]
    backlash = np.where(np.isfinite(clearance), clearance, 0.0)
    draw = np.random.default_rng([seed, number])
    wanted = 2.0 * throw * draw.uniform(-1.0, 1.0, B.shape[1]) * (reach + backlash)
    thrown = np.linalg.lstsq(B.T, wanted, rcond=1e-10)[0]
    return Start(system.rest.copy(), thrown - system.rigid.T @ (system.rigid @ thrown))


def steps_of(points: Sequence[Point | None], wanted: int | None) -> tuple[np.ndarray, dict[int, str]]:
    """Steps of each point in a period of its fastest mesh, and why a point can't be run with them.

    Without a wanted number they follow the highest frequency, from 200 on, in classes 2^(1/2) apart, so that few different
    numbers occur.
    """
    steps = np.zeros(len(points), dtype=np.int64)
    refused = {}
    for i, point in enumerate(points):
        if point is None:
            continue
        needed = steps_needed(point.system)
        least = steps_stable(point.system)
        classes = max(0, int(np.ceil(2.0 * np.log2(max(needed, LEAST_STEPS) / LEAST_STEPS) - 1e-9)))
        steps[i] = wanted or min(int(np.ceil(LEAST_STEPS * 2.0 ** (0.5 * classes))), MOST_STEPS)
        if wanted is None and needed > MOST_STEPS:
            refused[i] = (
                f"the stiffest part needs {needed} steps in a period of the fastest mesh (at most {MOST_STEPS} are chosen): "
                "make it rigid, or ask for the steps"
            )
        elif wanted is not None and wanted < least:
            refused[i] = (
                f"{wanted} steps are unstable: the stiffest part needs at least {least} in a period of the fastest mesh"
            )
    return steps, refused
