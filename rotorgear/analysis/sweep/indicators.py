"""Indicators of the contacts over the periods that a run of a sweep counts."""

from __future__ import annotations

import numpy as np

from rotorgear.solvers.lanes.lanes import Orbit


def indicators(orbit: Orbit, counted: np.ndarray, steps: int) -> dict[str, np.ndarray]:
    """Indicators of the contacts, which are the local displacements `counted` (m,); watched are two displacements of each."""
    from rotorgear.solvers.lanes import kernel_parts as k

    sums = orbit.sums[counted]
    transmission_error, approach = np.ptp(orbit.extremes, axis=1).reshape(2, -1)
    total = np.maximum(sums[:, [k.FRONT, k.APART, k.BACK]].sum(axis=1), 1.0)
    force = sums[:, k.F_SUM] / total
    d = sums[:, k.D_SUM] / total
    displacement = sums[:, k.D_MAX] - sums[:, k.D_MIN]
    rms = np.sqrt(np.maximum(sums[:, k.D_SQUARES] / total - d**2, 0.0))
    transverse = approach / np.where(displacement > 0.0, displacement, 1.0)
    return {
        "peak_to_peak": sums[:, k.X_MAX] - sums[:, k.X_MIN],
        "displacement": displacement,
        "peak_to_peak_transmission_error": transmission_error,
        "peak_to_peak_approach": approach,
        "rms_approach": rms * transverse,
        "mean_force": force,
        "rms_force": np.sqrt(np.maximum(sums[:, k.F_SQUARES] / total - force**2, 0.0)),
        "largest_force": sums[:, k.F_MAX],
        "driving": sums[:, k.FRONT] / total,
        "apart": sums[:, k.APART] / total,
        "back": sums[:, k.BACK] / total,
        "losses": sums[:, k.LOSSES] / total * steps,
    }
