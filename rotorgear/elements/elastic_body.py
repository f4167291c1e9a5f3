"""An elastic body that a finite-element mesh was reduced to: dense K and M of its n dofs, strained in its own modes.

With the modes of the reduced body by itself, K Phi = M Phi L and Phi^T M Phi = I, the dofs are q = Phi eta and

    eta = B q,  B = Phi^T M,        K = B^T L B,        C = B^T Z B,  Z = Phi^T C Phi,

so that the modal coordinates are the strains of the body, and a rigid-body motion has none that meets a stiffness (Craig,
Kurdila, Fundamentals of Structural Dynamics, 2nd ed., section 10.1).
"""

from __future__ import annotations

import numpy as np
import scipy.linalg as la

from rotorgear.elements.matrices import ElementMatrices

# A rigid-body motion whose strain energy is below this share of what its parts have is free: rounding of a reduction leaves more
# than that of the sums, and mounts leave far more than a reduction.
_FREE = 1e-9
# What the products leave between modes that a damping ratio keeps apart, relative to the largest term.
_ROUNDING = 1e-14


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
