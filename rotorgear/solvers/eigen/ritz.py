"""Refinement of computed modes with strain factors, and the decision which of them are rigid.

With K = S^T S the Ritz values on span V are the squared singular values of S V. One-sided Jacobi finds them to relative
accuracy even when they differ by many decades (Demmel and Veselic, SIAM J. Matrix Anal. 13 (1992) 1204; LAPACK dgejsv).

Residual attachment vectors as dynamic Ritz vectors: static shapes that modes leave over, with inertia and frequencies.

Craig and Kurdila, Fundamentals of Structural Dynamics, 2nd ed. (Wiley 2006), section 17.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp
from scipy.linalg.lapack import dgejsv, dgeqrf, dpotrf, dtrtri

from rotorgear.errors import ConvergenceError
from rotorgear.solvers.eigen.shift_invert import Modes, ShiftInvert
from rotorgear.solvers.sparse.entries import row_products, stretches
from rotorgear.solvers.sparse.pencil import EPS, Strain

_SAFETY = 10.0  # between a rounding estimate and the most that rounding was taken to do


def orthonormalise(M: sp.csr_array, V: np.ndarray) -> None:
    """Make V (n, m) M-orthonormal in place by Cholesky: V^T M V = identity to rounding.

    Raises:
        ConvergenceError: the inertia of some combination of the vectors is rounding.
    """
    gram = np.zeros((V.shape[1], V.shape[1]))
    for rows, heavy in row_products(M, V):
        gram += V[rows].T @ heavy
    size = gram.diagonal()
    positive = bool(np.all(size > 0.0))
    scale = 1.0 / np.sqrt(np.where(size > 0.0, size, 1.0))
    triangle, failed = dpotrf(0.5 * (gram + gram.T) * scale * scale[:, None])
    if failed or not positive:
        raise ConvergenceError(
            "Inertias of the model are too many decades apart: those of some motions are rounding of the largest."
        )
    inverse, _ = dtrtri(triangle)
    combine(V, scale[:, None] * inverse)


def combine(V: np.ndarray, C: np.ndarray) -> None:
    """Replace V (n, m) by V C, C (m, m), without another array of its size."""
    for rows in stretches(V.shape[0]):
        V[rows] = V[rows] @ C


def stiffness_ritz(K: sp.csc_array, V: np.ndarray, shift: float) -> Modes:
    """Rayleigh quotients (m,) ascending of the M-orthonormal V (n, m), and V in that order.

    The modes below |shift|, which inversion at the shift hardly tells apart, are Ritz vectors of K among themselves.
    """
    values = np.einsum("ij,ij->j", V, K @ V)
    low = values < abs(shift)
    if np.any(low):
        V = V.copy()
        block = V[:, low].T @ (K @ V[:, low])
        values[low], rotation = np.linalg.eigh(0.5 * (block + block.T))
        V[:, low] = V[:, low] @ rotation
    order = np.argsort(values, kind="stable")
    return values[order], V[:, order]


def strain_ritz(strain: Strain, V: np.ndarray) -> Modes:
    """Ritz values (m,) ascending and their coordinates (m, m) in the M-orthonormal V (n, m), of S^T S."""
    pieces = [strain(V)] if callable(strain) else (piece for _, piece in row_products(strain, V))
    triangle = _triangle(np.vstack([_triangle(np.asarray(piece, dtype=float)) for piece in pieces]))
    stretched = np.zeros((V.shape[1], V.shape[1]))
    stretched[: len(triangle)] = triangle
    # joba=0: accuracy not degraded by column scaling; jobu=3: no left vectors; jobv=0: right vectors
    scaled, _, W, work, _, info = dgejsv(stretched, joba=0, jobu=3, jobv=0, jobr=0, jobt=0, jobp=1)
    if info != 0:
        raise ConvergenceError(f"The Jacobi iteration on the strains of {V.shape[1]} modes did not converge.")
    singular = scaled[: V.shape[1]] * (work[0] / work[1])
    order = np.argsort(singular)
    return singular[order] ** 2, W[:, order]


def _triangle(A: np.ndarray) -> np.ndarray:
    """R (m, m) of A = Q R for a tall A (n, m); A itself where it is not tall.

    Householder QR errs by eps times each column's own length, so it keeps the relative accuracy of short ones.
    """
    m = A.shape[1]
    return np.triu(dgeqrf(A)[0][:m]) if A.shape[0] > m else A


def count_rigid(operator: ShiftInvert, values: np.ndarray, V: np.ndarray, noise: np.ndarray, with_strain: bool) -> int:
    """How many leading modes carry no energy beyond rounding; `noise` (m,) is that of the stored K.

    Without strains: lambda <= 10 noise. With strains the noise is of second order: rounding leaves a residual
    r ~ eps |K||v| in the vector, whose energy is r^T (K - sigma M)^-1 r after removing the part along computed modes,
    which the Ritz step has cleaned; the strains themselves round by eps noise. A mode is rigid below 100 times the sum.
    """
    if not with_strain:
        return _leading(values <= _SAFETY * noise)
    # Only what is near the rounding of K can be rigid; the rest needs no solve.
    low = _leading(values <= 1e3 * noise)
    if low == 0:
        return 0
    signs = np.sign(np.sin(np.arange(1.0, V.shape[0] * low + 1.0) ** 2)).reshape(-1, low)  # without a pattern
    residual = EPS * (operator.size_K @ np.abs(V[:, :low])) * signs
    residual -= operator.mass @ (V @ (V.T @ residual))
    energy = np.einsum("ij,ij->j", residual, operator.factor.solve(residual))
    return _leading(values[:low] <= _SAFETY**2 * (energy + EPS * noise[:low]))


def _leading(flags: np.ndarray) -> int:
    """How many of the first flags are true."""
    return int(np.argmin(np.append(flags, False)))


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
