"""Indicators of the contacts over the periods that a run of a sweep counts."""

from __future__ import annotations

import numpy as np

from rotorgear.solvers.lanes.lanes import Orbit
from rotorgear.solvers.time.statistics import MotionStatistics, Statistics


def indicators(orbit: Orbit, counted: np.ndarray, steps: int) -> dict[str, np.ndarray]:
    """Indicators of the contacts, which are the local displacements `counted` (m,); watched are two displacements of each."""
    from rotorgear.solvers.lanes import kernel_parts as k

    sums = orbit.sums[counted].T
    total = np.maximum(sums[[k.FRONT, k.APART, k.BACK]].sum(axis=0), 1.0)
    d = Statistics.of_sums(total, sums[k.D_SUM], sums[k.D_SQUARES], sums[k.D_MIN], sums[k.D_MAX])
    displacement = d.largest - d.least
    motion = motion_statistics(orbit, counted)
    approach = np.ptp(motion.approach, axis=1)
    return {
        "peak_to_peak": sums[k.X_MAX] - sums[k.X_MIN],
        "displacement": displacement,
        "peak_to_peak_transmission_error": np.ptp(motion.transmission_error, axis=1),
        "peak_to_peak_approach": approach,
        "rms_approach": d.rms * (approach / np.where(displacement > 0.0, displacement, 1.0)),
        "mean_force": motion.force.mean,
        "rms_force": motion.force.rms,
        "largest_force": motion.force.largest,
        "driving": motion.shares[:, 0],
        "apart": motion.shares[:, 1],
        "back": motion.shares[:, 2],
        "losses": sums[k.LOSSES] / total * steps,
    }


def motion_statistics(orbit: Orbit, counted: np.ndarray) -> MotionStatistics:
    """Statistics of the contacts, as every analysis of motions tells them."""
    from rotorgear.solvers.lanes import kernel_parts as k

    sums = orbit.sums[counted].T
    sides = sums[[k.FRONT, k.APART, k.BACK]]
    total = np.maximum(sides.sum(axis=0), 1.0)
    transmission_error, approach = np.split(orbit.extremes, 2)
    return MotionStatistics(
        Statistics.of_sums(total, sums[k.F_SUM], sums[k.F_SQUARES], sums[k.F_MIN], sums[k.F_MAX]),
        (sides / total).T,
        transmission_error,
        approach,
        sums[k.LOSSES] / total,
    )
