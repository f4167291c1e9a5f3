"""A rigid body at a node: disk, gear or point mass. J_d theta_x'' + W J_p theta_y' = 0, J_d theta_y'' - W J_p theta_x' = 0."""

from __future__ import annotations

import numpy as np

from rotorgear.elements.matrices import ElementMatrices


def rigid_body(mass: float, polar_inertia: float, diametral_inertia: float) -> ElementMatrices:
    """Mass and gyroscopic matrix of one body in x y z theta_x theta_y theta_z (kg, kg m^2); gyroscopic for unit spin."""
    M = np.diag([mass, mass, mass, diametral_inertia, diametral_inertia, polar_inertia])
    G = np.zeros((6, 6))
    G[3, 4] = polar_inertia
    G[4, 3] = -polar_inertia
    return ElementMatrices(mass=M[None], gyroscopic=G[None] if polar_inertia else None)
