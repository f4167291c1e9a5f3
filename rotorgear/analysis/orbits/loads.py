"""Loads inside shafts and couplings over a periodic motion, by harmonics d_h, F_h of local displacements and forces:

    q_h = Z(h w)^-1 B u_h,    u_h = (k + i h w c) d_h - F_h,    L_h = (Y_q + i h w Y_v - (h w)^2 Y_a) q_h,

Z(w) = K + i w D - w^2 M with the reference stiffness k and damping c of the laws in K and D, and L_0 of the static deflection
under the loads and u_0, with the rows Y of `system/internal_loads.py`.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from rotorgear.solvers.periodic.plant import Plant
from rotorgear.solvers.periodic.samples import MotionCycle
from rotorgear.solvers.sparse.factor import factor_general
from rotorgear.solvers.time.statistics import PeriodicCurve
from rotorgear.system.internal_loads import LoadRows

# Instants in a period for each harmonic, between which a cubic goes through values and rates.
_INSTANTS = 8
# What is told of each load; rms about the mean.
LOAD_STATISTICS = ("mean", "rms", "largest", "smallest")


def load_harmonics(plant: Plant, rows: LoadRows, cycle: MotionCycle) -> np.ndarray:
    """Coefficients (H + 1, p) of p loads, L(t) = Re sum L_h exp(i h w t).

    Args:
        plant: the structure at the motion. rows: of the loads at the plant's speed. cycle: the motion.
    """
    laws = plant.forces
    base = 2.0 * np.pi / cycle.period
    turn = 1j * base * np.arange(len(cycle.force))[:, None]
    d = cycle.displacement
    u = d @ laws.reference_stiffness.T + turn * (d @ laws.reference_damping.T) - cycle.force
    own = plant.static
    steady = own.q + own.X @ np.real(u[0])
    found = np.zeros((len(cycle.force), len(rows.weight)), dtype=complex)
    found[0] = rows.q @ steady - rows.weight
    for h in range(1, len(cycle.force)):
        w = h * base
        Z = sp.csc_array(plant.K + 1j * w * plant.D - w**2 * plant.M)
        q = factor_general(Z).solve((plant.B @ u[h])[:, None])[:, 0]
        found[h] = rows.amplitudes(np.array([w]), q[:, None])[:, 0]
    return found


def load_statistics(period: float, harmonics: np.ndarray) -> np.ndarray:
    """`LOAD_STATISTICS` (p, 4) of loads by their coefficients (H + 1, p) over a period in s."""
    count = _INSTANTS * len(harmonics)
    rates = harmonics * (2j * np.pi / period * np.arange(len(harmonics)))[:, None]
    values, speeds = (
        np.fft.irfft(np.concatenate([2.0 * x[:1], x[1:]]) * (0.5 * count), count, axis=0) for x in (harmonics, rates)
    )
    extremes = PeriodicCurve(period, values, speeds).extremes()
    rms = np.sqrt(0.5 * np.sum(np.abs(harmonics[1:]) ** 2, axis=0))
    return np.column_stack([np.real(harmonics[0]), rms, extremes[:, 1], extremes[:, 0]])
