"""Modes of a chain of 1000 disks: rotorgear on the loaded model against scipy on the bare matrices, one dof a disk.

Run  python -m validation.benchmarks.torsion_chain  (one BLAS thread is set by this file itself). Exit code 1 where the ratio to
scipy's dense solver misses its target or a frequency differs.
"""

from __future__ import annotations

import os

os.environ.update(dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1"))

import statistics
import sys
import time
from collections.abc import Callable
from itertools import pairwise

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp
from scipy.sparse.linalg import eigsh

import rotorgear as rg

DISKS = 1000
MODES = 24
INERTIA = 0.01
STIFFNESS = 1e6
TARGET = 3.0
AGREEMENT = 1e-9
REPETITIONS = 7


def chain() -> rg.Model:
    """The model as a user writes it: one disk on each shaft without sections, a torsional coupling between neighbours."""
    names = [f"d{k}" for k in range(DISKS)]
    return rg.Model(
        motions=["torsion"],
        shafts={name: {} for name in names},
        disks={name: {"shaft": name, "at": "start", "polar_inertia": INERTIA} for name in names},
        couplings={
            f"c{k}": {"from_shaft": first, "to_shaft": second, "stiffness": {"torsion": STIFFNESS}}
            for k, (first, second) in enumerate(pairwise(names))
        },
    )


def bare() -> tuple[sp.csc_array, sp.csc_array]:
    """K and M of the chain, (n, n)."""
    ends = np.full(DISKS, 2.0 * STIFFNESS)
    ends[[0, -1]] = STIFFNESS
    off = np.full(DISKS - 1, -STIFFNESS)
    return sp.csc_array(sp.diags_array([off, ends, off], offsets=[-1, 0, 1])), sp.csc_array(
        sp.diags_array(np.full(DISKS, INERTIA))
    )


def dense() -> np.ndarray:
    """Lowest frequencies in rad/s by scipy.linalg.eigh."""
    K, M = bare()
    return np.sqrt(np.clip(la.eigh(K.toarray(), M.toarray(), subset_by_index=(0, MODES - 1))[0], 0, None))


def sparse() -> np.ndarray:
    """Lowest frequencies in rad/s by scipy.sparse.linalg.eigsh, shift chosen by hand."""
    K, M = bare()
    return np.sqrt(np.clip(eigsh(K, MODES, M, sigma=-1.0)[0], 0, None))


def median(run: Callable[[], object]) -> float:
    """Median processor time in s."""
    run()
    times = []
    for _ in range(REPETITIONS):
        start = time.process_time()
        run()
        times.append(time.process_time() - start)
    return statistics.median(times)


def main() -> int:
    """Print times and ratios; 0 where the target is met."""
    model = chain()
    own = rg.modal(model, modes=MODES)
    exact = 2.0 * np.sqrt(STIFFNESS / INERTIA) * np.sin(np.arange(MODES) * np.pi / (2 * DISKS))
    worst = float(np.abs(2.0 * np.pi * own.natural_frequency_hz[1:] / exact[1:] - 1.0).max())
    seconds = {
        "rg.modal of the model": median(lambda: rg.modal(model, modes=MODES)),
        "scipy.linalg.eigh on K, M": median(dense),
        "scipy.sparse.linalg.eigsh on K, M": median(sparse),
    }
    ours = seconds["rg.modal of the model"]
    print(f"{DISKS} disks, {MODES} modes, processor time of one thread; {own.dofs} dofs in rotorgear")
    for name, value in seconds.items():
        print(f"  {name:36} {value:8.4f} s   rotorgear / this = {ours / value:5.2f}")
    print(f"largest error of rotorgear against the closed form {worst:.1e}")
    ratio = ours / seconds["scipy.linalg.eigh on K, M"]
    print(f"ratio to scipy's dense solver {ratio:.2f} (aim at most {TARGET:g})")
    return 0 if ratio <= TARGET and worst <= AGREEMENT else 1


if __name__ == "__main__":
    sys.exit(main())
