"""Folds of periodic motions beside the jumps of sweeps up and down.

    python -m validation.studies.jumps [backlash_pair] [flexible_pair]

A sweep that carries its state along stays on a branch of stable motions until that folds, and jumps there. `rotorgear orbits`
finds the folds without sweeping. The oscillator with a dead zone is the third
such model: python -m validation.studies.dead_zone jumps.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass

import numpy as np

import rotorgear as rg
from validation.seeds.models import loaded

# Change of ln(peak to peak) from one speed to the next that is a jump: along the branches it is less between the speeds below.
JUMP = 0.3
RPM = 30.0 / np.pi


@dataclass(frozen=True)
class Swept:
    """A model of models/ at a torque, ends of its branches, and speeds of the sweep in rpm."""

    torque: str
    ends: tuple[float, float]
    speeds: tuple[float, ...]
    direction: str


CASES = {
    "backlash_pair": Swept(
        "300 N m",
        (3200.0, 4800.0),
        (3440, 3470, 3475, 3477, 3480, 3550, 3620, 3655, 3658, 3700, 3800, 3880, 3950, 4006, 4010, 4100, 4200, 4300),
        "both",
    ),
    # The small motion is the only one at low speeds; from 6000 rpm on a start at rest ends in large chaos beside it.
    "flexible_pair": Swept(
        "20 N m",
        (5990.0, 6300.0),
        (4600, 4900, 5200, 5500, 5700, 5850, 5990, 6050, 6090, 6115, 6125, 6127, 6129, 6132, 6140),
        "up",
    ),
}


def jumps(name: str) -> dict[str, list[tuple[float, float]]]:
    """Neighbouring speeds in rpm between which a sweep of a case jumps, by its direction."""
    case = CASES[name]
    found = rg.sweep(
        loaded(name).with_("operation.torque", case.torque),
        {"operation.speed": [f"{rpm} rpm" for rpm in case.speeds]},
        direction=case.direction,
        discard=400,
        sample=30,
        exponents=0,
    )
    changes = np.abs(np.diff(np.log(found.peak_to_peak[:, :, 0]), axis=0))
    return {
        run: [(case.speeds[i], case.speeds[i + 1]) for i in np.flatnonzero(changes[:, r] > JUMP)]
        for r, run in enumerate(found.run)
    }


def folds(name: str) -> list[float]:
    """Speeds in rpm at which the branches of a case fold."""
    case = CASES[name]
    found = rg.orbits(
        loaded(name).with_("operation.torque", case.torque),
        {"operation.speed": [f"{rpm} rpm" for rpm in case.ends]},
    )
    return [point.value * RPM for point in found.special_points if point.kind == "fold"]


def main() -> None:
    """Print both of the named cases, or of all."""
    for name in sys.argv[1:] or CASES:
        print(f"{name}: folds at {', '.join(f'{rpm:.2f}' for rpm in folds(name))} rpm", flush=True)
        for run, places in jumps(name).items():
            words = ", ".join(f"{low} and {high}" for low, high in places)
            print(f"  {run}: jumps between {words} rpm", flush=True)


if __name__ == "__main__":
    main()
