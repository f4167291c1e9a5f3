"""A refined split-torque model of about 100,000 dofs: 24 modes against one sparse factorisation of the same stiffness.

Run  python -m validation.benchmarks.large_model  (one BLAS thread is set by this file itself). Each size runs in a process of its
own, so that its peak memory is its own. ARPACK (scipy's
`eigsh` at the same shift, the factor given) stands beside it. Exit code 1 where memory grows faster than the dofs by more than a
fifth, or a frequency differs from ARPACK's.
"""

from __future__ import annotations

import os

os.environ.update(dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1"))

import json
import resource
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

import numpy as np
from scipy.sparse.linalg import LinearOperator, eigsh, splu

import rotorgear as rg
from rotorgear.solvers.eigen.eigen import lowest_modes
from rotorgear.system.system import System

T = TypeVar("T")
NAME = "validation.benchmarks.large_model"
FILE = Path(__file__).resolve().parents[2] / "models" / "split_torque.toml"
LOWEST = 27.1  # Hz, near the first mode
MODES = 24
AIM = 20.0
GROWTH = 1.2
AGREEMENT = 1e-7
SIZES = (232, 464, 927)


def megabytes() -> float:
    """Peak memory of this process so far in MB."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0


def one(elements: int) -> dict[str, float]:
    """One size: seconds of a factorisation, of the solver and of the whole analysis, and memory above that of the imports."""
    start = megabytes()
    system = System(rg.load(FILE), elements)
    K = system.stiffness()
    M = system.mass
    shifted = (K + 1e4 * M).tocsc()
    options = {"permc_spec": "MMD_AT_PLUS_A", "diag_pivot_thresh": 0.0, "options": {"SymmetricMode": True}}
    factor = sorted(timed(lambda: splu(shifted, **options))[0] for _ in range(3))[1]
    inverse = LinearOperator(K.shape, matvec=splu(shifted, **options).solve)
    before = megabytes() - start
    modes, result = timed(lambda: rg.modal(system, modes=MODES, error_estimate=False))
    # as the analysis has them
    strain = system.strain_factor().__matmul__
    guess = (2.0 * np.pi * LOWEST) ** 2
    solver, _ = timed(lambda: lowest_modes(M, K, count=MODES, strain=strain, guess=guess))
    memory = megabytes() - start
    arpack, pairs = timed(lambda: eigsh(K, MODES, M, sigma=-1e4, OPinv=inverse))
    theirs = np.sqrt(np.sort(pairs[0])[-3:]) / (2.0 * np.pi)
    return {
        "dofs": result.dofs,
        "factor": factor,
        "modes": modes,
        "solver": solver,
        "arpack": arpack,
        "memory": max(memory, before),
        "difference": float(np.abs(theirs / result.frequency_hz[-3:] - 1.0).max()),
    }


def timed(run: Callable[[], T]) -> tuple[float, T]:
    """Processor time of one run in s, and what it gives."""
    begin = time.process_time()
    result = run()
    return time.process_time() - begin, result


def main() -> int:
    """Print a line for each size; 0 where both aims are met."""
    if len(sys.argv) > 1:
        print(json.dumps(one(int(sys.argv[1]))))
        return 0
    print("   dofs  factorisation  analysis          solver alone      ARPACK            memory         difference")
    rows = []
    for elements in SIZES:
        told = subprocess.run([sys.executable, "-m", NAME, str(elements)], check=True, capture_output=True, text=True)
        row = json.loads(told.stdout)
        rows.append(row)
        times = "  ".join(f"{row[k]:6.2f} s {row[k] / row['factor']:5.1f} x" for k in ("modes", "solver", "arpack"))
        memory = f"{row['memory']:4.0f} MB {row['memory'] * 1024 / row['dofs']:4.1f} kB/dof"
        print(f"{row['dofs']:7.0f} {row['factor']:11.3f} s  {times}  {memory}  {row['difference']:.0e}")
    growth = rows[-1]["memory"] / rows[-1]["dofs"] / (rows[0]["memory"] / rows[0]["dofs"])
    worst = max(row["difference"] for row in rows)
    print(f"x: in factorisations (aim below {AIM:g}). Memory a dof grows by a factor of {growth:.2f} over the sizes.")
    return 0 if growth < GROWTH and worst < AGREEMENT else 1


if __name__ == "__main__":
    sys.exit(main())
