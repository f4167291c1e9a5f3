"""6x6 springs and dampers: between a node and the ground (bearing, support), or two nodes (coupling, pedestal, casing's seat).

Between two nodes the strain is the displacement of the second relative to the first, both carried rigidly to the middle of
the gap, so all rigid motions of the pair are free of strain: d = T(m - p2) q2 - T(m - p1) q1, with T(r) q = (u + theta x r,
theta).
"""

from __future__ import annotations

import numpy as np

from rotorgear.elements.matrices import ElementMatrices


def between(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Displacements (6, 12) of the second of two nodes relative to the first, which stand at two points (3,) in m."""
    middle = 0.5 * (np.asarray(first, float) + np.asarray(second, float))
    return np.hstack([-rigid_transfer(middle - first), rigid_transfer(middle - second)])


def rigid_transfer(arm: np.ndarray) -> np.ndarray:
    """Motion at a point `arm` (3,) away on a rigid body from the six dofs of its node, shape (6, 6)."""
    rx, ry, rz = arm
    T = np.eye(6)
    T[:3, 3:] = [[0.0, rz, -ry], [-rz, 0.0, rx], [ry, -rx, 0.0]]
    return T


def spring(relative: np.ndarray, stiffness: np.ndarray, damping: np.ndarray) -> ElementMatrices:
    """A stiffness and a damping (6, 6) on the relative displacements (6, d) of d dofs; only those they touch carry strains."""
    K = np.asarray(stiffness, float)
    C = np.asarray(damping, float)
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
