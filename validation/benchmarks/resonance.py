"""Loaded teeth through a resonance with contact loss: the map that ships against one of 1024 positions and 44 loads.

    python -m validation.benchmarks.resonance                 # sweeps up and down, and folds
    python -m validation.benchmarks.resonance --points 41

The pair 34/80 of docs/mesh.md in torsion alone, a damping ratio of 0.03. Sweeps carry their state from speed to speed, and teeth
part where they meet the resonance. Printed are the approach's peak to peak with both maps, up and down, and the speeds of the
folds as `orbits` finds them. Two per cent of speed beside a fold are passed over: there a sweep falls a point earlier or later.
"""

from __future__ import annotations

import argparse
import time
from unittest.mock import patch

import numpy as np

import rotorgear as rg
from rotorgear.gears.loaded.contact_map import ContactMap
from rotorgear.gears.loaded.map_positions import even_positions
from rotorgear.gears.loaded.solved_map import solved_map
from rotorgear.gears.loaded.tooth_contact import contact_problem
from rotorgear.model.layout.mesh_layout import MeshLayout
from validation.benchmarks.crawl import pair

TORQUE = 500.0
POSITIONS = 1024
LOADS = tuple(float(x) for x in (0.003, 0.01, *np.linspace(0.03, 1.0, 21)[:-1], *np.linspace(1.0, 5.0, 22)))
NEAR_FOLD = 0.02


def model() -> rg.Model:
    """The pair in torsion: one elastic mode, that of the mesh."""
    given = pair(TORQUE, mesh={"damping_ratio": 0.03})
    return given.model_copy(
        update={"motions": ("torsion",), "damping": given.damping.model_copy(update={"modal_ratio": 0.0})}
    )


def fine(mesh: MeshLayout, helix: int, force: float, sense: int = 1, near: bool = False) -> ContactMap | None:
    """The contact map of 1024 positions and 44 loads."""
    if mesh.part.stiffness != "tooth_fe" or not force:
        return None
    key = (helix, float(f"{force:.12g}"), sense)
    if key not in _FINE:
        problem = contact_problem(mesh.helix_teeth(helix, sense))
        _FINE[key] = solved_map(problem, key[1], even_positions(POSITIONS), (LOADS,), lambda *_: None)
    return _FINE[key]


_FINE: dict[tuple[int, float, int], ContactMap] = {}


def swept(given: rg.Model, speeds: np.ndarray) -> tuple[np.ndarray, list[float]]:
    """Peak to peak (2, s) of the approach in m up and down, and the speeds of folds in rad/s."""
    over = {"operation.speed": [float(speed) for speed in speeds]}
    result = rg.sweep(given, over, direction="both", discard=150, sample=20, exponents=0)
    width = result.peak_to_peak_approach[:, :, 0].T
    found = rg.orbits(given, {"operation.speed": [float(speeds[0]), float(speeds[-1])]})
    folds = [one.value for one in found.special_points if one.kind == "fold"]
    return width, sorted(folds)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description="Loaded teeth through a resonance: the map that ships and a fine one.")
    parser.add_argument("--points", type=int, default=25, help="speeds")
    asked = parser.parse_args()
    given = model()
    w = float(np.max(rg.modal(given, modes=2).frequency_hz)) * 2.0 * np.pi / 34.0
    speeds = np.linspace(0.75, 1.1, asked.points) * w
    begun = time.process_time()
    width, folds = swept(given, speeds)
    seconds = time.process_time() - begun
    with patch.object(MeshLayout, "contact_map", fine):
        exact, true_folds = swept(model(), speeds)
    print(f"resonance {w * 34.0 / 2.0 / np.pi:.1f} Hz; {seconds:.0f} CPU s with the map that ships")
    print("speed/resonance   up um   fine um   off %   down um   fine um   off %")
    off = 100.0 * (width / exact - 1.0)
    for k, speed in enumerate(speeds):
        print(
            f"{speed / w:15.4f} {1e6 * width[0, k]:7.3f} {1e6 * exact[0, k]:9.3f} {off[0, k]:+7.3f} "
            f"{1e6 * width[1, k]:9.3f} {1e6 * exact[1, k]:9.3f} {off[1, k]:+7.3f}"
        )
    far = (
        np.all([np.abs(speeds / fold - 1.0) > NEAR_FOLD for fold in true_folds], axis=0) if true_folds else slice(None)
    )
    print(f"largest beside folds: {np.abs(off[:, far]).max():.3f} %")
    for fold, exact_fold in zip(folds, true_folds, strict=False):
        print(
            f"fold at {fold / w:.5f}, with the fine map {exact_fold / w:.5f}: {100.0 * (fold / exact_fold - 1.0):+.4f} %"
        )
    if len(folds) != len(true_folds):
        print(f"{len(folds)} folds, with the fine map {len(true_folds)}")


if __name__ == "__main__":
    main()
