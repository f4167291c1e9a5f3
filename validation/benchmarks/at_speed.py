"""Motions with the map of loaded teeth that ships against one of 1024 positions and 44 loads, up and down through a resonance.

    python -m validation.benchmarks.at_speed                        # spur pair with bare flanks
    python -m validation.benchmarks.at_speed --flank relieved crowned --form spur

The pair of docs/mesh.md, lightly damped, so that its teeth part at the resonance. A sweep goes through all speeds up and down and
carries its state from one to the next. Peak to peak and the first three harmonics of the approach are compared at each speed but
those within 2 % of a fold, where one map may have jumped and the other not yet. A fold is where the first harmonic jumps from one
speed to the next; there the speeds are 0.1 % apart, so that it is known to 0.05 %. Harmonics are relative to themselves, or to
half the largest one where that is more.
"""

from __future__ import annotations

import argparse
import itertools
import time
from dataclasses import dataclass
from unittest.mock import patch

import numpy as np

import rotorgear as rg
from rotorgear.analysis.sweep import sweep
from rotorgear.gears.loaded.tooth_contact import contact_problem
from rotorgear.gears.maps.contact_map import ContactMap
from rotorgear.gears.maps.map_positions import MapPositions
from rotorgear.gears.maps.solved_map import solved_map
from rotorgear.model.layout.mesh_layout import MeshLayout
from rotorgear.progress import silent
from validation.benchmarks.crawl import FLANKS, TORQUE, case

# The map that is compared with: positions of a base pitch, and loads as multiples of the working one. In space the patches of
# each group are those of its largest load.
POSITIONS = 1024
LOADS = (0.003, 0.01, 0.03, 0.06, *(0.1 * np.arange(1, 21)), *(2.0 + 0.15 * np.arange(1, 21)))
GROUPS = (1.01, 2.21, 5.1)
# Damping ratio of the mesh, and of the shafts at the resonance (2 zeta / omega, in s).
DAMPING = 0.016
RAYLEIGH = 2.0 * DAMPING / (2.0 * np.pi * 3400.0)
TEETH = 34
# Of the sweep: elastic modes, steps in a mesh period, periods until a speed has settled and those that are counted. 64 more
# follow, from which the harmonics are taken.
MODES = 8
STEPS = 96
SETTLED = 40
COUNTED = 4
# Speeds over that of the resonance, and about a fold.
SPEEDS = np.arange(0.82, 1.0601, 0.02)
FINE = 1e-3 * np.arange(-10, 11)
_PASSES = 4
NEAR_FOLD = 0.02
# A first harmonic that changes by more than this power of the speed has jumped: 10 is the most on a branch.
JUMP = 50.0
WAYS = ("up", "down")


@dataclass(frozen=True)
class Branches:
    """What one map does over s speeds, up and down.

    Attributes:
        frequency: (s,) of the mesh in Hz.
        peak_to_peak: (s, 2) of the approach in m; harmonics: (s, 2, 3) amplitudes of its first orders in m.
        apart: (s, 2) share of the time without contact.
    """

    frequency: np.ndarray
    peak_to_peak: np.ndarray
    harmonics: np.ndarray
    apart: np.ndarray

    def steepest(self, way: int) -> tuple[float, float]:
        """Mesh frequency in Hz where the first harmonic changes most from one speed to the next, and the power by which."""
        slope = np.abs(np.diff(np.log(self.harmonics[:, way, 0])) / np.diff(np.log(self.frequency)))
        jump = int(np.argmax(slope))
        return float(0.5 * (self.frequency[jump] + self.frequency[jump + 1])), float(slope[jump])

    def fold(self, way: int) -> float:
        """Mesh frequency in Hz where the first harmonic jumps; NaN where it does not."""
        place, slope = self.steepest(way)
        return place if slope >= JUMP else float("nan")


def damped(model: rg.Model) -> rg.Model:
    """The pair of a crawl, lightly damped in its mesh and its shafts."""
    return model.with_({"meshes.stage.damping_ratio": DAMPING, "damping": {"rayleigh_beta": RAYLEIGH}})


def resonance(model: rg.Model) -> float:
    """Mesh frequency in Hz at which the first order of the response is largest."""
    frequency = np.linspace(2000.0, 5000.0, 121)
    found = rg.response(model, speeds=(2.0 * np.pi * frequency / TEETH).tolist(), elements=1)
    return float(frequency[np.argmax(np.abs(found.approach[0, :, 0]))])


def through(model: rg.Model, frequency: np.ndarray) -> Branches:
    """A sweep through mesh frequencies (s,) in Hz, up and down."""
    # Trajectories of all points, where pictures have a few.
    with patch.object(sweep, "MOST_PORTRAITS", len(frequency)):
        found = rg.sweep(
            model,
            {"operation.speed": (2.0 * np.pi * frequency / TEETH).tolist()},
            direction="both",
            discard=SETTLED,
            sample=COUNTED,
            exponents=0,
            steps=STEPS,
            elements=1,
            modes=MODES,
            portraits=len(frequency),
            workers=1,
        )
    assert found.portraits is not None
    assert not any(found.failure)
    cosine = np.cos(model.layout.mesh("stage").pinion.base_helix_angle)
    waves = np.full((len(frequency), len(WAYS), 3), np.nan)
    for k, point in enumerate(found.portraits.point):
        per = int(found.portraits.records[k])
        for way in range(len(WAYS)):
            approach = found.portraits.trajectory(k, way)[:, 0, 0] / cosine
            periods = len(approach) // per
            spectrum = 2.0 * np.abs(np.fft.rfft(approach[: periods * per])) / (periods * per)
            waves[point, way] = spectrum[periods : 4 * periods : periods]
    return Branches(frequency, found.peak_to_peak_approach[:, :, 0], waves, found.apart[:, :, 0])


def dense(mesh: MeshLayout, helix: int, force: float, sense: int = 1, near: bool = False) -> ContactMap | None:
    """In place of `MeshLayout.contact_map`: 1024 positions and 44 loads."""
    if mesh.part.stiffness != "tooth_fe" or not force:
        return None
    problem = contact_problem(mesh.helix_teeth(helix, sense))
    bounds = GROUPS[-1:] if problem.plane and not problem.uncoupled else GROUPS
    groups = [
        tuple(float(f) for f in LOADS if low < f <= high) for low, high in zip((0.0, *bounds), bounds, strict=False)
    ]
    return solved_map(problem, force, MapPositions(np.arange(POSITIONS) / POSITIONS), tuple(groups), silent)


def refined(model: rg.Model) -> Branches:
    """Branches over mesh frequencies 2 % apart, and 0.1 % where they change most.

    A sweep in large steps may leave a branch before its end, so that folds move while the speeds about them are made finer.
    """
    coarse = resonance(model) * SPEEDS
    found = through(model, coarse)
    for _ in range(_PASSES):
        folds = [found.steepest(way)[0] for way in range(len(WAYS))]
        width = [np.diff(found.frequency)[np.searchsorted(found.frequency, fold) - 1] / fold for fold in folds]
        if all(one <= 1.5 * (FINE[1] - FINE[0]) for one in width):
            break
        found = through(model, np.unique(np.concatenate([coarse, *(fold * (1.0 + FINE) for fold in folds)])))
    return found


def compared(model: rg.Model) -> tuple[Branches, Branches]:
    """The branches of the map that ships and of the dense one, over the same speeds."""
    ships = refined(model)
    solved: dict[tuple[object, ...], ContactMap | None] = {}

    def once(mesh: MeshLayout, helix: int, force: float, sense: int = 1, near: bool = False) -> ContactMap | None:
        key = (mesh.name, helix, f"{force:.9g}", sense)
        if key not in solved:
            solved[key] = dense(mesh, helix, force, sense)
        return solved[key]

    with patch.object(MeshLayout, "contact_map", once):
        truth = through(model.model_copy(), ships.frequency)
    return ships, truth


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description="Motions at speed with two maps of loaded teeth.")
    parser.add_argument("--form", nargs="+", choices=("spur", "helical"), default=["spur"])
    parser.add_argument("--flank", nargs="+", choices=[f for f in FLANKS if f != "pitch"], default=["bare"])
    asked = parser.parse_args()
    print(
        "form     flanks      way   speeds   most pp um  most apart     fold Hz    of fold     of pp   of h1-3       s"
    )
    for form, flank in itertools.product(asked.form, asked.flank):
        begun = time.process_time()
        ships, truth = compared(damped(case(form, flank, TORQUE)))
        folds = np.array([[branches.fold(way) for way in range(len(WAYS))] for branches in (ships, truth)])
        for number, way in enumerate(WAYS):
            at = folds[:, number]
            away = np.abs(truth.frequency[:, None] / at - 1.0).min(axis=1)
            kept = ~(away <= NEAR_FOLD)  # no fold is no number, and near nothing
            waves = truth.harmonics[kept, number]
            scale = np.maximum(waves, 0.5 * waves.max(axis=1, keepdims=True))
            off = np.abs((ships.harmonics[kept, number] - waves) / scale).max()
            wide = np.abs(ships.peak_to_peak[kept, number] / truth.peak_to_peak[kept, number] - 1.0).max()
            fold = f"{at[1]:.1f} {100.0 * (at[0] / at[1] - 1.0):+8.3f} %" if np.isfinite(at).all() else "none"
            print(
                f"{form:8s} {flank:10s}  {way:4s} {kept.sum():7d} {1e6 * truth.peak_to_peak[:, number].max():12.2f} "
                f"{100.0 * truth.apart[:, number].max():9.1f} % {fold:>22s} "
                f"{100.0 * wide:7.3f} % {100.0 * off:7.3f} % {time.process_time() - begun:7.1f}",
                flush=True,
            )


if __name__ == "__main__":
    main()
