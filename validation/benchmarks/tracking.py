"""Mode tracking from coarse speed grids against a fine one: the branches at the last speed must be the same ones.

Run  python -m validation.benchmarks.tracking

Two rotors: three overhung disks on anisotropic bearings, with torsion and axial motion, to 30000 rad/s, and the split-torque
gearbox to 20000 rpm. The truth is the same analysis on 3201 speeds. A branch is wrong where, starting from the same mode, it ends
in another one.
"""

from __future__ import annotations

import os

os.environ.update(dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1"))

import sys
import time
from pathlib import Path

import numpy as np

import rotorgear as rg

ROOT = Path(__file__).resolve().parents[2]
GRIDS = (14, 26, 51, 101)
TRUTH = 3201
MODES = 24


def overhung() -> rg.Model:
    """Three disks, the last one overhung, on two anisotropic bearings; 10 sections of 100 mm."""
    disks = {
        name: {"shaft": "rotor", "at": at, "outer_diameter": diameter, "bore": 0.05, "width": 0.03}
        for name, at, diameter in (("first", 0.3, 0.20), ("second", 0.6, 0.25), ("overhung", 1.0, 0.30))
    }
    damping = {"x": 300.0, "y": 200.0}
    bearings = {
        "left": {
            "shaft": "rotor",
            "at": 0.0,
            "stiffness": {"x": 3e7, "y": 1.2e7, "axial": 2e7, "torsion": 1e4},
            "damping": damping,
        },
        "right": {"shaft": "rotor", "at": 0.8, "stiffness": {"x": 4e7, "y": 2e7}, "damping": damping},
    }
    return rg.Model(
        title="Overhung three-disk rotor",
        materials={"steel": {"youngs_modulus": 210e9, "poisson_ratio": 0.3, "density": 7850.0}},
        shafts={"rotor": {"material": "steel", "sections": [{"length": 0.1, "outer_diameter": 0.05}] * 10}},
        disks=disks,
        bearings=bearings,
    )


def cases() -> dict[str, tuple[rg.Model, float]]:
    """Models and the highest speed of the input shaft in rad/s."""
    return {
        "overhung": (overhung(), 30000.0),
        "split_torque": (rg.load(ROOT / "models" / "split_torque.toml"), 20000.0 * np.pi / 30.0),
    }


def branches(model: rg.Model, top: float, count: int) -> tuple[np.ndarray, rg.CampbellResult]:
    """First and last eigenvalue of each branch that begins among the lowest modes, ascending at the first speed, (b, 2)."""
    result = rg.campbell(
        model,
        speeds=np.linspace(0.02 * top, top, count).tolist(),
        modes=MODES,
        elements=1,
        shaft_orders=(),
        mesh_orders=(),
        error_estimate=False,
    )
    ends = result.eigenvalues[[0, -1]].T
    ends = ends[np.isfinite(ends[:, 0])]
    return ends[np.argsort(np.abs(ends[:, 0]), kind="stable")][:MODES], result


def wrong(found: np.ndarray, truth: np.ndarray) -> int:
    """How many branches end in another mode than in the truth."""
    known = np.isfinite(truth[:, 1])
    same = np.abs(found[known, 1] - truth[known, 1]) <= 1e-6 * np.abs(truth[known, 1])
    return int(np.sum(~same)) + int(np.sum(np.isfinite(found[~known, 1])))


def main() -> int:
    """Print the wrong branches of every grid; 0 where there are none."""
    total = 0
    for name, (model, top) in cases().items():
        start = time.process_time()
        truth, fine = branches(model, top, TRUTH)
        print(
            f"{name}: {len(truth)} branches, {fine.dofs} dofs, truth on {TRUTH} speeds {time.process_time() - start:.1f} s"
        )
        print(f"  {fine.method}")
        for count in GRIDS:
            start = time.process_time()
            found, coarse = branches(model, top, count)
            bad = wrong(found, truth)
            total += bad
            print(
                f"  {count:4d} speeds: {bad} wrong, {time.process_time() - start:.1f} s; {coarse.method.rpartition(', ')[2]}"
            )
    return 1 if total else 0


if __name__ == "__main__":
    sys.exit(main())
