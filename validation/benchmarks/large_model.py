"""How time and memory grow: a split-torque model refined to a million dofs, and a chain of geared shafts up to 200 of them.

Run  python -m validation.benchmarks.large_model [--plot FILE]  (one BLAS thread is set by this file itself). Each size runs in a
process of its own, so that its peak memory is its own. The modes of the refined model stand against one sparse factorisation of
the same stiffness, and against ARPACK (scipy's `eigsh` at the same shift, the factor given). Exponents are those of a fit
t = c n^p; the work of n log n has 1.08 over these sizes. Exit code 1 where memory or a time grows with an exponent above 1.25, a
frequency differs from ARPACK's, or 100,000 dofs take 20 factorisations or more.
"""

from __future__ import annotations

import os

os.environ.update(dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1"))

import argparse
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
AIMED_AT = 100_000  # dofs at which the aim holds
GROWTH = 1.25  # exponent
AGREEMENT = 1e-7
SIZES = (232, 464, 927, 2780, 9260)
CHAINS = (25, 50, 100, 200)
STEPS = ("model", "matrices", "modes", "at speed", "Campbell")
Rows = list[dict[str, float]]


def megabytes() -> float:
    """Peak memory of this process so far in MB."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0


def one(elements: int) -> dict[str, float]:
    """One size: seconds of a factorisation, of the solver and of the whole analysis, and memory above that of the imports."""
    modal = rg.modal  # loads its modules, which is no work on the model
    start = megabytes()
    system = System(rg.load(FILE), elements)
    K = system.stiffness()
    M = system.mass
    shifted = (K + 1e4 * M).tocsc()
    options = {"permc_spec": "MMD_AT_PLUS_A", "diag_pivot_thresh": 0.0, "options": {"SymmetricMode": True}}
    factor = sorted(timed(lambda: splu(shifted, **options))[0] for _ in range(3))[1]
    inverse = LinearOperator(K.shape, matvec=splu(shifted, **options).solve)
    before = megabytes() - start
    modes, result = timed(lambda: modal(system, modes=MODES, error_estimate=False))
    # as the analysis has them
    strain = system.strain_factor()
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


def in_its_own_process(module: str, size: int) -> dict[str, float]:
    """What a module prints for one size."""
    told = subprocess.run([sys.executable, "-m", module, str(size)], check=True, capture_output=True, text=True)
    row: dict[str, float] = json.loads(told.stdout)
    return row


def exponent(rows: Rows, name: str) -> float:
    """The p of a fit of c dofs^p."""
    dofs, values = ([row[key] for row in rows] for key in ("dofs", name))
    return float(np.polyfit(np.log(dofs), np.log(np.maximum(values, 1e-3)), 1)[0])


def refined_model() -> Rows:
    """Print a line for each size of the split-torque model."""
    print("   dofs  factorisation  analysis          solver alone      ARPACK            memory         difference")
    rows = []
    for elements in SIZES:
        row = in_its_own_process(NAME, elements)
        rows.append(row)
        times = "  ".join(f"{row[k]:6.2f} s {row[k] / row['factor']:5.1f} x" for k in ("modes", "solver", "arpack"))
        memory = f"{row['memory']:4.0f} MB {row['memory'] * 1024 / row['dofs']:4.1f} kB/dof"
        print(f"{row['dofs']:7.0f} {row['factor']:11.3f} s  {times}  {memory}  {row['difference']:.0e}")
    print(f"x: in factorisations (aim below {AIM:g} at {AIMED_AT} dofs)")
    return rows


def gear_chains() -> Rows:
    """Print a line for each length of the chain."""
    print("\nshafts   dofs " + "".join(f"{step:>12}" for step in STEPS) + "    memory")
    rows = []
    for shafts in CHAINS:
        row = in_its_own_process("validation.benchmarks.gear_chain", shafts)
        rows.append(row)
        print(
            f"{shafts:6d} {row['dofs']:6.0f} " + "".join(f"{row[k]:10.3f} s" for k in STEPS) + f" {row['MB']:6.0f} MB"
        )
    return rows


def draw(file: str, refined: Rows, chains: Rows) -> None:
    """Time and memory of both over the dofs, with the slope of n log n."""
    from matplotlib import pyplot as plt

    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 5.0), layout="constrained")
    for key, label in (("factor", "one factorisation"), ("modes", "24 modes"), ("arpack", "ARPACK")):
        left.loglog([row["dofs"] for row in refined], [row[key] for row in refined], "o-", label=f"refined: {label}")
    for key in STEPS[1:]:
        left.loglog([row["dofs"] for row in chains], [row[key] for row in chains], "s--", label=f"chain: {key}")
    n = np.array([row["dofs"] for row in refined])
    left.loglog(n, refined[0]["factor"] * n * np.log(n) / (n[0] * np.log(n[0])) / 2.0, "k:", label="slope of n log n")
    left.set(xlabel="dofs", ylabel="CPU time in s")
    right.loglog(n, [row["memory"] for row in refined], "o-", label="refined: above that of the imports")
    right.loglog([row["dofs"] for row in chains], [row["MB"] for row in chains], "s--", label="chain: whole process")
    right.set(xlabel="dofs", ylabel="peak memory in MB")
    for axes in (left, right):
        axes.legend(fontsize=8, frameon=False, loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=3)
        axes.grid(True, alpha=0.3)
    figure.savefig(file, dpi=110)
    print(f"wrote {file}")


def main() -> int:
    """Print both tables and the exponents; 0 where the aims are met."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("elements", type=int, nargs="?", help="only this size of the refined model, as JSON")
    parser.add_argument("--plot", help="draw it to this file")
    given = parser.parse_args()
    if given.elements:
        print(json.dumps(one(given.elements)))
        return 0
    refined = refined_model()
    chains = gear_chains()
    grows = {
        name: exponent(refined, key) for name, key in (("modes", "modes"), ("solver", "solver"), ("memory", "memory"))
    }
    of_chain = {name: exponent(chains, name) for name in (*STEPS, "MB")}
    print("\nexponents, refined: " + ", ".join(f"{name} {p:.2f}" for name, p in grows.items()))
    print("exponents, chain:   " + ", ".join(f"{name} {p:.2f}" for name, p in of_chain.items()))
    if given.plot:
        draw(given.plot, refined, chains)
    aimed = min(refined, key=lambda row: abs(row["dofs"] - AIMED_AT))
    worst = max(row["difference"] for row in refined)
    fast = max(*grows.values(), *of_chain.values())
    return 0 if fast < GROWTH and worst < AGREEMENT and aimed["modes"] < AIM * aimed["factor"] else 1


if __name__ == "__main__":
    sys.exit(main())
