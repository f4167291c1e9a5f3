"""Deflection and stiffness of a deep groove ball bearing under one load, ball 0 under it."""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

from rotorgear.forces.ball_bearing import BallBearing

_NAMES = {"radial": 0, "axial": 2}


def measure(quantity: str, mode: str) -> float:
    """Deflection in um or tangent stiffness in N/um; `mode`: direction, load in N, clearance in mm. Or c_p in N/mm^1.5."""
    if quantity == "contact constant in N/mm^1.5":
        return _bearing(0.0).contact_constant / 1e3**1.5
    direction, load, clearance = mode.split(", ")
    bearing = _bearing(1e-3 * float(clearance.removesuffix(" mm")))
    axis = np.eye(5)[_NAMES[direction]]
    wanted = float(load.removesuffix(" N"))
    x = brentq(lambda x: bearing.evaluate(x * axis).force @ axis - wanted, 0.0, 1e-3, xtol=1e-16)
    if quantity == "deflection in um":
        return float(1e6 * x)
    return float(1e-6 * axis @ bearing.evaluate(x * axis).in_displacement @ axis)


def _bearing(clearance: float) -> BallBearing:
    return BallBearing(7, 11.5e-3, 43.5e-3, clearance=clearance, youngs_modulus=210e9)
