"""Error against run time of a reduced sweep: what fewer modes change in the motion of a finite-element model.

    python -m validation.benchmarks.sweep_reduction

models/flexible_pair.toml, 84 degrees of freedom, at 16 speeds, in 4 of which its teeth part. Prints for several numbers of modes
the error that the reduction states (receptances at the contacts); against all modes, largest errors of peak to peak, force, share
of time apart where the motion is periodic; and how many kinds of motion are the same.
"""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np

import rotorgear as rg
from rotorgear.results.sweep import SweepResult

MODEL = Path(__file__).resolve().parents[2] / "models" / "flexible_pair.toml"
OVER = {"operation.speed": "1500 rpm:9000 rpm:16"}
MODES: tuple[int | None, ...] = (5, 10, 15, 20, None, 40)
ALL = 83


def run(modes: int | None) -> tuple[SweepResult, float]:
    """A sweep with so many modes, and its seconds."""
    begun = time.perf_counter()
    found = rg.sweep(rg.load(MODEL), OVER, discard=300, sample=100, modes=modes, workers=1, elements=1)
    return found, time.perf_counter() - begun


def row(found: SweepResult, seconds: float, whole: SweepResult) -> str:
    """One line of the table."""
    assert found.reduction is not None
    same = np.array([a == b for a, b in zip(found.motion, whole.motion, strict=True)])
    periodic = same & np.array([kind.endswith("T") for kind in whole.motion])

    def off(name: str) -> float:
        a = getattr(found, name)[periodic]
        b = getattr(whole, name)[periodic]
        return 100.0 * float(np.max(np.abs(a / b - 1.0)))

    apart = 100.0 * float(np.max(np.abs(found.apart - whole.apart)[periodic]))
    return (
        f"{found.reduction.modes:5d} {found.dofs:11d}   {100.0 * found.reduction.error:9.2g} %   {off('peak_to_peak'):7.2g} %  "
        f"{off('largest_force'):7.2g} %  {apart:7.2g} %  {same.sum():5d}/{same.size}  {int(found.steps.max()):5d}  {seconds:7.1f}"
    )


def main() -> None:
    """Print the table."""
    rg.sweep(rg.load(MODEL), {"operation.speed": ["6000 rpm"]}, discard=1, sample=1)  # compiles
    whole, longest = run(ALL)
    print("modes coordinates   receptances   peak to p.  force      apart      kinds   steps  seconds")
    for modes in MODES:
        print(row(*run(modes), whole))
    print(row(whole, longest, whole))


if __name__ == "__main__":
    main()
