"""The phi functions of the exponential integrator, against 40 digits."""

from __future__ import annotations

import mpmath as mp
import numpy as np

from rotorgear.solvers.time.exponential import _phi


def test_phi_functions_hold_to_rounding_at_small_and_large_arguments() -> None:
    mp.mp.dps = 40
    sizes = [1e-9, 1e-4, 0.02, 0.29, 0.3, 0.31, 1.0, 5.0, 40.0]
    x = np.array([size * np.exp(1j * angle) for size in sizes for angle in (0.5 * np.pi, 0.6 * np.pi, np.pi)])
    first, second = _phi(x)
    for k, value in enumerate(x):
        z = mp.mpc(value)
        exact = (mp.exp(z) - 1) / z, (mp.exp(z) - 1 - z) / z**2
        assert abs(first[k] - complex(exact[0])) < 2e-15 * (1.0 + abs(complex(exact[0])))
        assert abs(second[k] - complex(exact[1])) < 2e-14 * abs(complex(exact[1]))
