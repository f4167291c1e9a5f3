"""Bodies: rigid ones, gears whose bodies or teeth give way, and elastic bodies that a finite-element mesh was reduced to.

A rigid body (disk, gear, point mass) has J_d theta_x'' + W J_p theta_y' = 0, J_d theta_y'' - W J_p theta_x' = 0.

An elastic gear body that turns has the six dofs of its node, then its elastic coordinates p, in axes that stand still:

    M q'' + (C + W G) q' + (K + W^2 S + W C L) q = f,      K = diag(w^2),  C = diag(2 zeta w) on p

The material damps in proportion to the rate p' + W L p that an observer on the body sees (L: `casings/wheel_reduction.py`). Its
rigid motions, those of the node, have neither stiffness nor damping.

An elastic body that does not turn has dense K and M of its n dofs. With the modes of the body by itself, K Phi = M Phi L and
Phi^T M Phi = I, the dofs are q = Phi eta and

    eta = B q,  B = Phi^T M,        K = B^T L B,        C = B^T Z B,  Z = Phi^T C Phi,

so that the modal coordinates are the strains of the body, and a rigid-body motion has none that meets a stiffness (Craig,
Kurdila, Fundamentals of Structural Dynamics, 2nd ed., section 10.1).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import scipy.linalg as la

from rotorgear.elements.matrices import ElementMatrices

# A rigid-body motion whose strain energy is below this share of what its parts have is free: rounding of a reduction leaves more
# than that of the sums, and mounts leave far more than a reduction.
_FREE = 1e-9
# What the products leave between modes that a damping ratio keeps apart, relative to the largest term.
_ROUNDING = 1e-14


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
    behind = ((0, 0), (0, 6), (0, 6))
    M = np.pad(whole.mass, behind)
    # Only the rotations of node and teeth differ; the teeth's other dofs are those of the node, counted once.
    M[0][np.ix_([5, 11], [5, 11])] = polar_inertia
    G = None if whole.gyroscopic is None else np.pad(whole.gyroscopic, behind)
    B = np.zeros((1, 1, 12))
    B[0, 0, [5, 11]] = (-1.0, 1.0)
    return ElementMatrices(strain=B, modulus=np.full((1, 1, 1), stiffness), mass=M, gyroscopic=G)


if TYPE_CHECKING:
    from rotorgear.casings.wheel import ReducedWheel


def gear_body(wheel: ReducedWheel) -> ElementMatrices:
    """Matrices of one body; gyroscopic, circulatory and centrifugal ones for unit spin."""
    elastic = np.hstack([np.zeros((wheel.size, 6)), np.eye(wheel.size)])
    viscosity = np.diag(2.0 * wheel.damping_ratio * np.sqrt(wheel.stiffness))
    damped = wheel.damping_ratio > 0.0
    return ElementMatrices(
        strain=elastic[None],
        modulus=np.diag(wheel.stiffness)[None],
        mass=wheel.mass[None],
        viscosity=viscosity[None] if damped else None,
        gyroscopic=wheel.gyroscopic[None],
        circulation_per_speed=(viscosity @ wheel.turning)[None] if damped else None,
        modulus_per_square=wheel.spin_stiffness[None],
    )


def elastic_body(stiffness: np.ndarray, mass: np.ndarray, damping: np.ndarray, motions: np.ndarray) -> ElementMatrices:
    """Return the matrices of one body from K, M and C (n, n), all symmetric; no gyroscopic ones: a casing does not turn.

    Args:
        stiffness, mass: K positive semidefinite, M positive definite.
        motions: its rigid-body motions (n, 6); those that nothing holds are free of strain to the last digit.

    Raises:
        ValueError: M is not positive definite, or K has a negative eigenvalue; the text says which.
    """
    try:
        squares, modes = la.eigh(stiffness, mass)
    except la.LinAlgError:
        raise ValueError("its mass matrix is not positive definite") from None
    free = free_motions(stiffness, motions)
    rigid = free.shape[1]
    if squares[rigid:].size and squares[rigid] <= 0.0:
        raise ValueError(f"its stiffness matrix has a negative eigenvalue, omega^2 = {squares[rigid]:.3g}")
    squares[:rigid] = 0.0
    viscosity = modes.T @ damping @ modes
    viscosity[np.abs(viscosity) < _ROUNDING * np.abs(viscosity).max(initial=0.0)] = 0.0
    strain = modes.T @ mass
    if rigid:
        # What rounding leaves of an elastic strain in a free motion would be multiplied by the stiffest mode.
        strain[rigid:] -= (strain[rigid:] @ free) @ la.pinv(free)
    # A free motion leaves no strain behind, unless a damper holds it.
    used = (squares > 0.0) | np.any(viscosity, axis=0)
    return ElementMatrices(
        strain=strain[None, used],
        modulus=np.diag(squares[used])[None],
        mass=np.asarray(mass)[None],
        viscosity=viscosity[used][:, used][None] if np.any(viscosity) else None,
    )


def free_motions(stiffness: np.ndarray, motions: np.ndarray) -> np.ndarray:
    """Those combinations (n, r) of the rigid-body motions (n, 6) that nothing holds: R^T K R is rounding."""
    size = np.sqrt(np.einsum("nm,n,nm->m", motions, np.abs(np.diagonal(stiffness)), motions))
    scaled = motions / np.where(size > 0.0, size, 1.0)
    energy = scaled.T @ stiffness @ scaled
    values, turned = la.eigh(0.5 * (energy + energy.T))
    return np.asarray(scaled @ turned[:, values < _FREE])
