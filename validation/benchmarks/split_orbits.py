"""Periodic motions of the split-torque gearbox over its speeds, one stage excited: CPU seconds a point, and transients beside.

models/split_torque.toml at its power of 2.5 MW with backlash on all eight lines; the file has no damping, so every mode gets a
ratio of .02 (assumed, as in case T1). The other stage is at its mean. CPU seconds are of all: reading, multipliers, special
points. A transient starts on some of the motions; how far it is from them a period later, over their peak to peak, is printed.

    python -m validation.benchmarks.split_orbits stage_1a 3000 20000
    python -m validation.benchmarks.split_orbits stage_2a 3000 20000 --errors 4 --points 60
    python -m validation.benchmarks.split_orbits stage_1a 8000 8500 --elements 8

`--errors` multiplies the transmission errors of the file, so that flanks part. `--points`: of a branch, at most. `--elements`
divides each shaft segment, for more degrees of freedom: 20 give more than 2000. Damping is then proportional to stiffness, by
2e-6 s, which is a ratio of .025 at 4 kHz: ratios of all modes are refused beyond 600 dofs.
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path

import numpy as np

import rotorgear as rg
from rotorgear.analysis.orbits.family import SPEED, SystemFamily, range_of
from rotorgear.analysis.orbits.follow import main_branches
from rotorgear.analysis.orbits.gather import read
from rotorgear.analysis.orbits.orbits import HARMONICS, INSTANTS, scale_of
from rotorgear.analysis.orbits.places import told_of
from rotorgear.analysis.orbits.start import first_node, run_periods
from rotorgear.progress import silent
from rotorgear.solvers.periodic.arclength import Walk
from rotorgear.solvers.periodic.balance import Grid
from rotorgear.solvers.periodic.harmonic_orbits import HarmonicOrbits
from rotorgear.solvers.sparse.factor import single_thread

MODEL = Path(__file__).resolve().parents[2] / "models" / "split_torque.toml"
_RATIO = 0.02
_BETA = 2e-6
_STEPS = 4800
_CHECKED = 4


def model(errors: float, elements: int | None = None) -> rg.Model:
    """The gearbox with damping, its transmission errors multiplied."""
    data = rg.load(MODEL).model_dump(exclude_none=True)
    data["damping"] = {"modal_ratio": _RATIO} if elements is None else {"rayleigh_beta": _BETA}
    for mesh in data["meshes"].values():
        for item in mesh["transmission_error"]:
            item["amplitude"] *= errors
    return rg.Model(**data)


class Timed(HarmonicOrbits):
    """The equations, with the CPU seconds that multipliers take."""

    cpu_s = 0.0

    def multipliers(self, y: np.ndarray, p: float) -> np.ndarray:
        """As they are."""
        begun = time.process_time()
        found = super().multipliers(y, p)
        self.cpu_s += time.process_time() - begun
        return found


def main() -> None:
    """Follow the branches of a range and print."""
    parser = argparse.ArgumentParser(prog="python -m validation.benchmarks.split_orbits")
    parser.add_argument("excite", help="stage_1a or stage_2a")
    parser.add_argument("ends", nargs=2, type=float, help="speeds in rpm")
    parser.add_argument("--errors", type=float, default=1.0)
    parser.add_argument("--points", type=int, default=600)
    parser.add_argument("--elements", type=int, default=None, help="basic elements in each shaft segment")
    options = parser.parse_args()
    begun = time.process_time()
    gearbox = model(options.errors, options.elements)
    along = range_of(gearbox, SPEED, [f"{rpm} rpm" for rpm in options.ends])
    family = SystemFamily(gearbox, [along], options.excite, options.elements)
    with single_thread(0):
        grid = Grid(HARMONICS, INSTANTS * HARMONICS, family.order)
        orbits = Timed(family.plant, grid, scale_of(family.plant(0.0)))
        first = first_node(orbits, family, from_transient=False, progress=silent)
        branches = main_branches(orbits, first, Walk(most=options.points), silent)
        used = time.process_time() - begun
        nodes = [one for branch in branches for one in branch.nodes]
        told = told_of(family)
        columns = told.contacts.column
        loss = [
            float(np.max(read(orbits.cycle(one.node.y, one.node.p), told, 1, 1)["apart"]))  # type: ignore[call-overload]
            for one in nodes
        ]
        print(
            f"{options.excite}, errors x {options.errors:g}, {family.local.local.n} dofs: {len(nodes)} points, "
            f"{used:.0f} CPU s, {used / len(nodes):.2f} a point, {(used - orbits.cpu_s) / len(nodes):.2f} without multipliers, "
            f"{sum(one.stable for one in nodes)} stable, contact loss up to {100.0 * max(loss):.0f} %, "
            f"{'; '.join(branch.ended for branch in branches)}"
        )
        for branch in branches:
            for point in branch.special:
                rpm = along.at(point.at.node.p) * 30.0 / np.pi
                print(f"  {point.kind} at {rpm:.2f} rpm, |mu| {abs(point.at.multipliers[0]):.4f}")
        # Those with most contact loss, and some spread over the range.
        chosen = {int(np.argmax(loss)), *np.linspace(0, len(nodes) - 1, _CHECKED).astype(int).tolist()}
        for i in sorted(chosen):
            node = nodes[i].node
            q, v = orbits.state(node.y, node.p)
            system = family.system(family.shares_at(node.p))
            exact = orbits.cycle(node.y, node.p).at.d[:, columns]
            _, d = run_periods(system, family.order, 1, q, v, _STEPS)
            there = np.roll(d[:, columns], 1, axis=0)[:: _STEPS // len(exact)]
            off = np.abs(there - exact)[1:].max(axis=0) / np.ptp(exact, axis=0).max()
            rpm = along.at(node.p) * 30.0 / np.pi
            print(f"  {rpm:.1f} rpm: contact loss {100.0 * loss[i]:.1f} %, transient off by {off.max():.1e}")


if __name__ == "__main__":
    main()
