"""python -m validation.seeds.doubling: where one period of the 24-dof pair becomes two, by multipliers and by a sweep.

`orbits` follows the motion of one period of set 1 and locates its period doubling; a sweep up from that motion, each speed from
the end of the one before, tells between which speeds it is one of two periods. At 5750 rpm the motion of one period must be
stable: random starts end in chaos beside it. Four times the harmonics tell how well the speed of the doubling is known.
"""

from __future__ import annotations

import numpy as np

import rotorgear as rg
from validation.seeds.pair24 import MODEL, STEPS
from validation.seeds.rows import loaded

ENDS = ("5500 rpm", "5900 rpm")
NEAR = ("5740 rpm", "5800 rpm")
FINER = 120
SWEPT = (5740.0, 5750.0, 5770.0, 5780.0, 5783.0, 5785.0, 5787.0, 5792.0, 5800.0)


def main() -> None:
    """Print both."""
    found = rg.orbits(loaded(MODEL), {"operation.speed": ENDS}, step=0.08)
    rpm = found.value * 30.0 / np.pi
    for point in found.special_points:
        print(f"{point.kind} at {point.value * 30.0 / np.pi:.2f} rpm")
    below = rpm < min(p.value for p in found.special_points) * 30.0 / np.pi
    print(f"stable from {rpm[below].min():.0f} to {rpm[below].max():.0f} rpm: {bool(found.stable[below].all())}")
    finer = rg.orbits(loaded(MODEL), {"operation.speed": NEAR}, harmonics=FINER)
    for point in finer.special_points:
        print(f"with {FINER} harmonics: {point.kind} at {point.value * 30.0 / np.pi:.2f} rpm")
    over = {"operation.speed": [f"{speed} rpm" for speed in SWEPT]}
    swept = rg.sweep(loaded(MODEL), over, direction="up", steps=STEPS, discard=300, sample=100)
    print("sweep up: " + ", ".join(f"{speed:.0f} {swept.motion_at(p)}" for p, speed in enumerate(SWEPT)))


if __name__ == "__main__":
    main()
