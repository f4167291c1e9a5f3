"""Flow out of a film and the friction in it, from its pressure on a grid of half the length.

Each end lets out  h^3/(12 mu) |dp/dz|  a length. The journal feels  mu U/h + h/2 dp/dx, and where the film has broken mu U/h as
if it were whole, as Raimondi and Boyd (ASLE Trans. 1 (1958) 159) have it: oil in streamers drags less, so that this is the most.
"""

from __future__ import annotations

import numpy as np


def side_flow(gap: np.ndarray, pressure: np.ndarray, dz: float, step: float, viscosity: float) -> float:
    """Return the oil in m^3/s that leaves a pad at both ends.

    Args:
        gap: (t,) m. pressure: (t, j) Pa, cells from the middle to one end.
        dz, step: of a cell along the shaft and around it, m. viscosity: Pa s.
    """
    # The slope at the end of a film whose profile is a parabola there, as the grid has it.
    end = 2.0 / (1.0 - 1.0 / (3.0 * pressure.shape[1]))
    return float(2.0 * step * np.sum(gap**3 * end * pressure[:, -1] / dz) / (12.0 * viscosity))


def power_loss(
    gap: np.ndarray, pressure: np.ndarray, dz: float, step: float, viscosity: float, velocity: float
) -> float:
    """Return the power in W that the surface of the journal, at a velocity in m/s, puts into a pad.

    The other arguments are those of `side_flow`.
    """
    shear = viscosity * velocity / gap[:, None] + 0.5 * gap[:, None] * np.gradient(pressure, step, axis=0)
    return float(2.0 * velocity * step * dz * np.sum(shear))
