"""Residual attachment vectors as dynamic Ritz vectors: static shapes that modes leave over, with inertia and frequencies.

Craig and Kurdila, Fundamentals of Structural Dynamics, 2nd ed. (Wiley 2006), section 17.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp

# Shapes that are so near to a sum of the others, in the square of their size, are left out.
_DEPENDENT = 1e-10


def ritz_residuals(M: np.ndarray | sp.csc_array, K: np.ndarray | sp.csc_array, shapes: np.ndarray) -> np.ndarray:
    """Return an M-orthonormal basis (n, r) of shapes (n, m), r <= m, in which K is diagonal, softest first.

    Args:
        M: (n, n) symmetric.
        K: (n, n) symmetric.
        shapes: (n, m), M-orthogonal to the modes that they complete.
    """
    size = np.sqrt(np.einsum("ij,ij->j", shapes, M @ shapes))
    shapes = shapes[:, size > 0.0] / size[size > 0.0]
    if not shapes.shape[1]:
        return shapes
    # Orthonormal in M by the eigenvectors of their Gram matrix, which shows what depends on the others; then diagonal in K.
    values, turned = la.eigh(shapes.T @ (M @ shapes))
    kept = values > _DEPENDENT * values.max(initial=0.0)
    shapes = shapes @ (turned[:, kept] / np.sqrt(values[kept]))
    _, turned = la.eigh(shapes.T @ (K @ shapes))
    return np.asarray(shapes @ turned)
