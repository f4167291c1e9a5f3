"""Where dense and sparse eigensolvers take the same time: python -m validation.benchmarks.thresholds

Undamped modes (dense or block Lanczos) and damped ones at the operating speed (all by LAPACK or block Arnoldi) of shipped
models on finer and finer meshes. Prints, for each size and count, CPU milliseconds of one thread by either method, medians of
several runs that take turns, and what the solvers choose by themselves over the better of the two: 1.05 is the most it should be.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from statistics import median
from types import ModuleType
from typing import Any
from unittest.mock import patch

import rotorgear as rg
from rotorgear.solvers.eigen import damped, eigen
from rotorgear.solvers.sparse.factor import single_thread
from rotorgear.system.plan import Plan
from rotorgear.system.system import System, flow_system
from tests.paths import ROOT

MODELS = ("jeffcott", "geared_pair", "split_torque")
ELEMENTS = (1, 2, 3, 4, 6, 8, 12)
COUNTS = (6, 12, 24)
LARGEST = 900
_REPEATED = 5


def main() -> None:
    """Print one line for each model, size, count and problem."""
    print("model           dofs modes  problem   dense ms  sparse ms  chosen ms  over the better")
    worst = 1.0
    for name in MODELS:
        model = rg.load(ROOT / "models" / f"{name}.toml")
        for elements in ELEMENTS:
            system = flow_system(model, Plan(elements))
            if system.n > LARGEST:
                break
            for count in COUNTS:
                if 4 * count > system.n:
                    continue
                for problem, (module, work) in _problems(system, model.operating_speed or 0.0, count).items():
                    always = {"_DENSE_UP_TO": 10**9} | _ALWAYS.get(module, {})
                    try:
                        times = _times(work, module, (always, {"_DENSE_UP_TO": 0}, {}))
                    except rg.RotorgearError as error:
                        print(f"{name:14} {system.n:5} {count:5}  {problem:8} {error}")
                        continue
                    over = times[2] / min(times[:2])
                    worst = max(worst, over)
                    columns = " ".join(f"{ms:10.2f}" for ms in times)
                    print(f"{name:14} {system.n:5} {count:5}  {problem:8} {columns}  {over:6.2f}", flush=True)
    print(f"worst: {worst:.2f}")


# What else makes a solver dense.
_ALWAYS: dict[ModuleType, dict[str, Any]] = {eigen: {"_FEW": (10**9, 1)}}


def _problems(system: System, speed: float, count: int) -> dict[str, tuple[ModuleType, Callable[[], Any]]]:
    """Modes of a system by what they are called: the module that chooses how, and what finds so many."""
    at = system.matrices(speed)
    D = at.damping + speed * at.gyroscopic
    K = system.stiffness(speed)
    return {
        "undamped": (eigen, lambda: eigen.lowest_modes(at.mass, K, count=count)),
        "damped": (damped, lambda: damped.damped_modes(at.mass, D, at.stiffness, count=count)),
    }


def _times(work: Callable[[], Any], module: ModuleType, settings: Sequence[dict[str, Any]]) -> list[float]:
    """CPU milliseconds of some work under each of the settings of a module."""
    taken: list[list[float]] = [[] for _ in settings]
    for _ in range(_REPEATED):
        for own, changes in zip(taken, settings, strict=True):
            with patch.multiple(module, **changes) if changes else single_thread(0), single_thread(0):
                begun = time.process_time()
                work()
                own.append(1e3 * (time.process_time() - begun))
    return [median(own) for own in taken]


if __name__ == "__main__":
    main()
