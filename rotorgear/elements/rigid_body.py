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


def elastic_gear(mass: float, polar_inertia: np.ndarray, diametral_inertia: float, stiffness: float) -> ElementMatrices:
    """A gear whose teeth turn against their bore: six dofs of its node, then six of its teeth, which share all but theta_z.

    Args:
        mass: kg.
        polar_inertia: (2, 2) about theta_z of node and teeth, kg m^2; its sum is that of the whole gear.
        diametral_inertia: kg m^2.
        stiffness: in torsion between both, N m/rad.
    """
    whole = rigid_body(mass, float(polar_inertia.sum()), diametral_inertia)
    assert whole.mass is not None
    M = np.zeros((1, 12, 12))
    M[:, :6, :6] = whole.mass
    # Only the rotations of node and teeth differ; the teeth's other dofs are those of the node, counted once.
    M[0][np.ix_([5, 11], [5, 11])] = polar_inertia
    G = np.zeros_like(M)
    if whole.gyroscopic is not None:
        G[:, :6, :6] = whole.gyroscopic
    B = np.zeros((1, 1, 12))
    B[0, 0, 5] = -1.0
    B[0, 0, 11] = 1.0
    return ElementMatrices(
        strain=B,
        modulus=np.full((1, 1, 1), stiffness),
        mass=M,
        gyroscopic=None if whole.gyroscopic is None else G,
    )
