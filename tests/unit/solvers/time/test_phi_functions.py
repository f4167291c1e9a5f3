"""The phi function of the exponential integrator, against 40 digits."""

from __future__ import annotations

import mpmath as mp
import numpy as np

from rotorgear.solvers.time.exponential import _phi


def test_the_phi_function_holds_to_rounding_at_small_and_large_arguments() -> None:
    mp.mp.dps = 40
    sizes = [1e-9, 1e-4, 0.02, 0.29, 0.3, 0.31, 1.0, 5.0, 40.0]
    x = np.array([size * np.exp(1j * angle) for size in sizes for angle in (0.5 * np.pi, 0.6 * np.pi, np.pi)])
    first = _phi(x)
    for k, value in enumerate(x):
        z = mp.mpc(value)
        exact = complex((mp.exp(z) - 1) / z)
        assert abs(first[k] - exact) < 2e-15 * (1.0 + abs(exact))
