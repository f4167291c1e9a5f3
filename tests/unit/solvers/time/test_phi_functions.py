"""The phi functions of the exponential integrator and of the map over a period, against 40 digits."""

from __future__ import annotations

import mpmath as mp
import numpy as np

from rotorgear.solvers.time.exponential import phi_functions


def test_the_phi_functions_hold_to_rounding_at_small_and_large_arguments() -> None:
    mp.mp.dps = 40
    sizes = [1e-9, 1e-4, 0.02, 0.29, 0.3, 0.31, 1.0, 5.0, 40.0]
    x = np.array([size * np.exp(1j * angle) for size in sizes for angle in (0.5 * np.pi, 0.6 * np.pi, np.pi)])
    first, second = phi_functions(x)
    for k, value in enumerate(x):
        z = mp.mpc(value)
        for found, exact in ((first[k], (mp.exp(z) - 1) / z), (second[k], (mp.exp(z) - 1 - z) / z**2)):
            assert abs(found - complex(exact)) < 2e-15 * (1.0 + abs(complex(exact)))
