"""Deflection and stiffness of a cylindrical roller bearing under a radial load, roller 0 under it."""

from __future__ import annotations

from scipy.optimize import brentq

from rotorgear.forces.roller_bearing import RollerBearing


def measure(quantity: str, mode: str) -> float:
    """Deflection in um or tangent stiffness in N/um; `mode`: load in N, clearance in mm."""
    load, clearance = mode.split(", ")
    bearing = RollerBearing(6, 13.6e-3, clearance=1e-3 * float(clearance.removesuffix(" mm")))
    wanted = float(load.removesuffix(" N"))
    x = brentq(lambda x: bearing.evaluate([x, 0.0]).force[0] - wanted, 0.0, 1e-3, xtol=1e-17)
    return float(1e6 * x if quantity == "deflection in um" else 1e-6 * bearing.evaluate([x, 0.0]).in_displacement[0, 0])
