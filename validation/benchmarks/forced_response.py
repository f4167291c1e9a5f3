"""Run-up of the split-torque gearbox: modal against direct solution, CPU time against error.

Run  python -m validation.benchmarks.forced_response  (one BLAS thread is set by this file itself). The error is the largest
difference of any mesh or bearing force from the direct solution on the same mesh, relative to the largest one of its order.
Times leave out the choice of the mesh, which both have in common. Exit code 1 where the error exceeds 1e-4.
"""

from __future__ import annotations

import os

os.environ.update(dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1"))

import sys
import time
from pathlib import Path

import numpy as np

import rotorgear as rg

FILE = Path(__file__).resolve().parents[2] / "models" / "split_torque.toml"
RUNS = ((3000.0, 111), (3000.0, 441), (10000.0, 111), (10000.0, 441))
ALLOWED = 1e-4


def timed(model: rg.Model, speeds: np.ndarray, fmax: float, method: str) -> tuple[float, rg.ResponseResult]:
    """CPU seconds and the result."""
    start = time.process_time()
    result = rg.response(model, speeds=list(speeds), fmax=fmax, modal_damping=0.02, method=method)
    return time.process_time() - start, result


def forces(result: rg.ResponseResult) -> np.ndarray:
    """All forces of every order, (o, s, k)."""
    bearings = result.bearing_force.reshape(*result.bearing_force.shape[:2], -1)
    return np.concatenate([result.mesh_force, bearings], axis=2)


def main() -> int:
    """Print one line a run."""
    model = rg.load(FILE)
    assert model.operation is not None
    assert model.operation.speed is not None
    print("  fmax Hz  solutions   dofs  mesh s  direct s  modal s  direct/modal  difference  stated")
    worst = 0.0
    for fmax, points in RUNS:
        speeds = model.operation.speed * np.linspace(0.1, 1.2, points)
        common, _ = timed(model, speeds[-1:], fmax, "direct")
        direct, exact = timed(model, speeds, fmax, "direct")
        modal, found = timed(model, speeds, fmax, "modal")
        largest = np.abs(forces(exact)).max(axis=(1, 2))
        error = float((np.abs(forces(found) - forces(exact)).max(axis=(1, 2)) / largest).max())
        worst = max(worst, error)
        ratio = (direct - common) / (modal - common)
        print(
            f"{fmax:9.0f}  {points * len(exact.orders):9d}  {exact.dofs:5d}  {common:6.1f}  {direct - common:8.1f}  "
            f"{modal - common:7.1f}  {ratio:12.1f}  {error:10.0e}  {found.solver_error:6.0e}"
        )
    return 1 if worst > ALLOWED else 0


if __name__ == "__main__":
    sys.exit(main())
