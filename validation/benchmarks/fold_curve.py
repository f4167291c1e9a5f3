"""CPU seconds of a fold curve over speed and torque of models/flexible_pair.toml: python -m validation.benchmarks.fold_curve

The fold of its resonance at 20 N m is followed to 24 N m in some fifty points. Each point is a motion on which flanks part, touch
and let go, whose multiplier is 1. At the last torque the branch over the speed must fold at the same place; it is begun from the
motion at the first speed and torque, since the static start leads to another branch there.
"""

from __future__ import annotations

import time

import numpy as np

from rotorgear.analysis.orbits.family import SPEED, SystemFamily, outputs_of, range_of
from rotorgear.analysis.orbits.follow import main_branches, special_curves
from rotorgear.analysis.orbits.orbits import HARMONICS, INSTANTS, scale_of
from rotorgear.analysis.orbits.verify import first_node
from rotorgear.progress import silent
from rotorgear.solvers.periodic.arclength import Walk, at_value
from rotorgear.solvers.periodic.balance import HarmonicGrid
from rotorgear.solvers.periodic.harmonic_orbits import HarmonicOrbits
from rotorgear.solvers.sparse.factor import single_thread
from validation.seeds.models import loaded

TORQUES = ("20 N m", "24 N m")
SPEEDS = ("5990 rpm", "6300 rpm")
STEP = 0.0066
POINTS = 60


def equations(torque: str, *torques: str) -> tuple[HarmonicOrbits, SystemFamily]:
    """Motions over the speed at a torque, and the family over the speed and, where they are given, torques."""
    model = loaded("flexible_pair").with_("operation.torque", torque)
    ranges = [range_of(model, SPEED, SPEEDS)]
    if torques:
        ranges.append(range_of(model, "operation.torque", torques))
    family = SystemFamily(model, ranges, None, None)
    grid = HarmonicGrid(HARMONICS, INSTANTS * HARMONICS, family.order)
    return HarmonicOrbits(family.plant, grid, scale_of(family.plant(0.0))), family


def main() -> None:
    """Follow the curve and print."""
    along = range_of(loaded("flexible_pair"), SPEED, SPEEDS)

    rpm = 30.0 / np.pi
    with single_thread(0):
        orbits, family = equations(TORQUES[0], *TORQUES)
        first = first_node(orbits, family, from_transient=False, progress=silent)
        branches = main_branches(orbits, first, Walk(), silent)
        begun = time.process_time()
        curves = special_curves(branches, family, outputs_of(family), Walk(longest=STEP, most=POINTS), silent)
        used = time.process_time() - begun
        for curve in curves:
            places = [f"{curve.value[k] * rpm:.2f} rpm, {curve.second[k]:.3f} N m" for k in (0, -1)]
            print(f"{curve.kind}: {' to '.join(places)}, {curve.ended}")
        count = sum(len(curve.value) for curve in curves)
        print(f"{count} points, {used:.1f} CPU s")
        other, _ = equations(TORQUES[1])
        begin = at_value(other, other.unknowns(orbits.coefficients(first.y)), first.p)
        for branch in main_branches(other, begin, Walk(), silent):
            for one in branch.special:
                print(f"branch at {TORQUES[1]}: {one.kind} at {along.at(one.at.node.p) * rpm:.2f} rpm")


if __name__ == "__main__":
    main()
