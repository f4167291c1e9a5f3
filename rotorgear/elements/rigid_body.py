"""A rigid body at a node: disk, gear or point mass. J_D tx'' + W J_P ty' = 0, J_D ty'' - W J_P tx' = 0."""

from __future__ import annotations

import numpy as np

from rotorgear.elements.matrices import ElementMatrices


def rigid_body(mass: float, polar_inertia: float, diametral_inertia: float) -> ElementMatrices:
    """Mass and gyroscopic matrix of one body in x y z tx ty tz (kg, kg m^2); gyroscopic for unit spin."""
    M = np.diag([mass, mass, mass, diametral_inertia, diametral_inertia, polar_inertia])
    G = np.zeros((6, 6))
    G[3, 4] = polar_inertia
    G[4, 3] = -polar_inertia
    return ElementMatrices(mass=M[None], gyroscopic=G[None] if polar_inertia else None)
