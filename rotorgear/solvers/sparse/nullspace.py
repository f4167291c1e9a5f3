"""Systems with a known null space: K q = f with K R = 0, solved by a statically determinate support of r dofs.

The support dofs come from a pivoted QR of R: R restricted to them is well conditioned, so K without them is regular.
When f is orthogonal to the left null space the support carries no load, and the solution is exact.
Bodies that nothing joins have no dof in common: each has its own QR, of its few motions.
Golub and Van Loan, Matrix Computations, 4th ed., section 5.4 (column pivoting).
"""

from __future__ import annotations

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from rotorgear.errors import AnalysisError, ConvergenceError
from rotorgear.solvers.sparse.factor import Factor, factor_general

# Square of a frequency far below those of dofs on springs, over their median square.
_SLOW = 1e-10


def support_dofs(R: np.ndarray) -> np.ndarray:
    """The r dofs (r,) whose fixing stops all motions R (n, r); scale the rows of R to comparable units first."""
    chosen = [np.zeros(0, dtype=int)]
    for dofs, motions in _bodies(R):
        _, order = la.qr(R[np.ix_(dofs, motions)].T, mode="r", pivoting=True)
        chosen.append(dofs[order[: len(motions)]])
    return np.sort(np.concatenate(chosen))


def orthonormal_motions(R: np.ndarray) -> np.ndarray:
    """An orthonormal basis (n, r) of the motions R (n, r), in which those of a body move no dof of another one."""
    Q = np.zeros(R.shape)
    for dofs, motions in _bodies(R):
        Q[np.ix_(dofs, motions)] = np.linalg.qr(R[np.ix_(dofs, motions)])[0]
    return Q


def _bodies(R: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
    """Dofs and motions of the parts of R (n, r) that have no dof in common; all of R where one of them is not regular."""
    n, r = R.shape
    dof, motion = np.nonzero(R)
    graph = sp.coo_array((np.ones(len(dof), dtype=np.int8), (dof, n + motion)), shape=(n + r, n + r))
    label = connected_components(graph, directed=False)[1]
    of_dofs = np.argsort(label[:n], kind="stable")
    of_motions = np.argsort(label[n:], kind="stable")
    values = np.unique(label[n:])
    # The places of each number in both sorted lists.
    first = [np.searchsorted(label[:n][of_dofs], values, side) for side in ("left", "right")]
    second = [np.searchsorted(label[n:][of_motions], values, side) for side in ("left", "right")]
    bodies = [(of_dofs[a:b], of_motions[c:d]) for a, b, c, d in zip(*first, *second, strict=True)]
    if any(len(dofs) < len(motions) for dofs, motions in bodies):
        return [(np.arange(n), np.arange(r))]
    return bodies


def in_comparable_units(R: np.ndarray, K: sp.csc_array, M: sp.csc_array) -> np.ndarray:
    """Motions R (n, r) with each dof in the root of the strain energy that it alone takes.

    A dof that no spring holds, such as the rotation of a lone rotor, has that of its inertia at a frequency far below those of
    the others: else the rounding of dofs on stiff springs would pass for the motion.
    """
    k = np.maximum(K.diagonal(), 0.0)
    m = M.diagonal()
    sprung = (k > 0.0) & (m > 0.0)
    least = _SLOW * float(np.median(k[sprung] / m[sprung])) if sprung.any() else 1.0
    return np.asarray(R * np.sqrt(np.maximum(np.maximum(k, least * m), 1e-300))[:, None])


def left_null_space(K: sp.csc_array, M: sp.csc_array, R: np.ndarray) -> np.ndarray:
    """Orthonormal L (n, r) with L^T K = 0, by inverse iteration; R itself when K is symmetric."""
    skew = abs(K - K.T)
    if R.shape[1] == 0 or skew.nnz == 0 or skew.max() <= 1e-14 * abs(K).max():
        return orthonormal_motions(R)
    # Inverse iteration beside zero: each step shrinks all other left vectors by 1e-6 / |lambda|: four are plenty.
    factor = factor_general(sp.csc_array(K + 1e-6 * M))
    L = R
    for _ in range(4):
        L = np.linalg.qr(factor.solve(M.T @ L, transposed=True))[0]
    return L


class SupportedSolver:
    """Solves K q = f for f orthogonal to L; q is zero at the support dofs of R.

    Raises:
        AnalysisError: K stays singular on the support: it has more rigid-body motions than R.
    """

    def __init__(self, K: sp.csc_array, R: np.ndarray, L: np.ndarray) -> None:
        n = K.shape[0]
        self._columns = np.setdiff1d(np.arange(n), support_dofs(R))
        self._rows = self._columns if L is R else np.setdiff1d(np.arange(n), support_dofs(L))
        try:
            self._factor: Factor = factor_general(sp.csc_array(K[self._rows][:, self._columns]))
        except ConvergenceError as error:
            raise AnalysisError(
                f"The stiffness has more rigid-body motions (to its rounding) than the {R.shape[1]} given: give them all."
            ) from error
        self._n = n

    def solve(self, f: np.ndarray) -> np.ndarray:
        """q (n,) or (n, m) for f of that shape."""
        q = np.zeros(f.shape)
        q[self._columns] = self._factor.solve(f[self._rows])
        return q
