"""Campbell diagram of the split-torque gearbox against dense solutions at every speed: 24 modes at 100 speeds.

Run  python -m validation.benchmarks.campbell_dense  (one BLAS thread is set by this file itself). The dense way is LAPACK on the
states of the same matrices, with vectors, since branches can't be followed without; timed at three of the speeds. Exit code 1
where the basis is off by more than 1e-9 or the ratio misses its aim.
"""

from __future__ import annotations

import os

os.environ.update(dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1"))

import statistics
import sys
import time
from pathlib import Path

import numpy as np
import scipy.linalg as la

import rotorgear as rg

FILE = Path(__file__).resolve().parents[2] / "models" / "split_torque.toml"
ELEMENTS = 5
SPEEDS = 100
MODES = 24
AIM = 40.0
ERROR = 1e-9


def dense(system: rg.System, speed: float) -> np.ndarray:
    """Oscillating eigenvalues at a speed in rad/s, all of them, by LAPACK on the 2n states."""
    parts = system.matrices(speed)
    n = system.n
    mass = la.cho_factor(parts.mass.toarray())
    states = np.zeros((2 * n, 2 * n))
    states[:n, n:] = np.eye(n)
    states[n:, :n] = -la.cho_solve(mass, parts.stiffness.toarray())
    states[n:, n:] = -la.cho_solve(mass, (parts.damping + speed * parts.gyroscopic).toarray())
    s = la.eig(states)[0]
    return np.asarray(s[s.imag > 1.0])


def main() -> int:
    """Print times, the ratio and the largest difference; 0 where both aims are met."""
    model = rg.load(FILE)
    data = model.model_dump(exclude_unset=True)
    data["damping"] = {"rayleigh_alpha": 5.0, "rayleigh_beta": 1e-6}
    system = rg.System(rg.Model(**data), ELEMENTS)
    top = 2.0 * np.pi * 20000.0 / 60.0
    speeds = np.linspace(0.0, top, SPEEDS)
    rg.campbell(system, speeds=speeds[:5].tolist(), modes=MODES, error_estimate=False)
    times = []
    for _ in range(3):
        start = time.process_time()
        result = rg.campbell(system, speeds=speeds.tolist(), modes=MODES, error_estimate=False)
        times.append(time.process_time() - start)
    own = statistics.median(times)
    lapack = []
    worst = 0.0
    for k in (10, 50, 90):
        start = time.process_time()
        true = dense(system, float(speeds[k]))
        lapack.append(time.process_time() - start)
        at = int(np.argmin(np.abs(result.speeds - speeds[k])))
        for s in result.eigenvalues[at][np.isfinite(result.eigenvalues[at])]:
            worst = max(worst, float(np.min(np.abs(true - s)) / abs(s)))
    slow = SPEEDS * statistics.median(lapack)
    print(f"{system.n} dofs, {SPEEDS} speeds, {MODES} modes, damped; processor time of one thread")
    print(
        f"rotorgear {own:.3f} s; dense {statistics.median(lapack):.3f} s a speed, {slow:.1f} s in all; ratio {slow / own:.0f}"
    )
    print(
        f"basis certified to {result.basis_error:.0e}; largest difference from the dense solution, with its rounding, {worst:.0e}"
    )
    print(f"aims: ratio at least {AIM:g}, basis error at most {ERROR:g}")
    return 0 if slow / own >= AIM and result.basis_error <= ERROR else 1


if __name__ == "__main__":
    sys.exit(main())
