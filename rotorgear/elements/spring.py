"""6x6 springs and dampers: between a node and the ground (bearing, support), or two nodes (coupling, pedestal, casing's seat).

Between two nodes the strain is the displacement of the second relative to the first, both carried rigidly to the middle of
the gap, so all rigid motions of the pair are free of strain: d = T(m - p2) q2 - T(m - p1) q1, with T(r) q = (u + theta x r,
theta).
"""

from __future__ import annotations

import numpy as np

from rotorgear.elements.matrices import ElementMatrices


def grounded_spring(stiffness: np.ndarray, damping: np.ndarray) -> ElementMatrices:
    """Return a 6x6 stiffness and damping between a node and the ground; only the dofs they touch carry strains."""
    return _spring(np.eye(6), np.asarray(stiffness, float), np.asarray(damping, float))


def linking_spring(
    stiffness: np.ndarray, damping: np.ndarray, first: np.ndarray, second: np.ndarray
) -> ElementMatrices:
    """Return a 6x6 stiffness and damping between two nodes at the points `first` and `second` (3,) in m."""
    middle = 0.5 * (np.asarray(first, float) + np.asarray(second, float))
    relative = np.hstack([-rigid_transfer(middle - first), rigid_transfer(middle - second)])
    return _spring(relative, np.asarray(stiffness, float), np.asarray(damping, float))


def seated_spring(stiffness: np.ndarray, damping: np.ndarray, arm: np.ndarray) -> ElementMatrices:
    """Return a 6x6 stiffness and damping between a seat, carried rigidly by `arm` (3,) to its bearing, and a node there."""
    return _spring(
        np.hstack([-rigid_transfer(arm), np.eye(6)]), np.asarray(stiffness, float), np.asarray(damping, float)
    )


def rigid_transfer(arm: np.ndarray) -> np.ndarray:
    """Motion at a point `arm` (3,) away on a rigid body from the six dofs of its node, shape (6, 6)."""
    rx, ry, rz = arm
    T = np.eye(6)
    T[:3, 3:] = [[0.0, rz, -ry], [-rz, 0.0, rx], [ry, -rx, 0.0]]
    return T


def _spring(relative: np.ndarray, K: np.ndarray, C: np.ndarray) -> ElementMatrices:
    """Spring K and damper C (6, 6) on the relative displacements (6, d)."""
    # Only a symmetric stiffness has a strain energy; the rest (cross-coupling of a fluid film) is circulation.
    symmetric = 0.5 * (K + K.T)
    skew = 0.5 * (K - K.T)
    # Directions without stiffness and damping leave no strain behind: a free direction must not look like a spring of 0 N/m.
    touched = (K != 0.0) | (K.T != 0.0) | (C != 0.0) | (C.T != 0.0)
    used = np.flatnonzero(touched.any(axis=1))

    def among_used(A: np.ndarray) -> np.ndarray | None:
        return A[np.ix_(used, used)][None] if np.any(A) else None

    return ElementMatrices(
        strain=relative[used][None] if used.size else None,
        modulus=among_used(symmetric),
        viscosity=among_used(C),
        circulation=among_used(skew),
    )
