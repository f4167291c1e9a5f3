"""Static equilibrium K q = f of a structure that may be free to move: the part M-orthogonal to the rigid-body motions.

A free structure is in equilibrium only under loads that do no work on its rigid-body motions R: R^T f = 0 (K R = 0).
Then q = q_s - R (R^T M R)^-1 R^T M q_s, with q_s the solution on a statically determinate support.
Geradin and Rixen, Mechanical Vibrations, 3rd ed., section 3.3 (John Wiley 2015).
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from rotorgear.errors import AnalysisError, ConvergenceError
from rotorgear.solvers.sparse.entries import norm_1
from rotorgear.solvers.sparse.factor import single_thread
from rotorgear.solvers.sparse.nullspace import SupportedSolver
from rotorgear.solvers.sparse.pencil import check_pencil

_BALANCE = (
    1e-8  # work of the loads on a rigid-body motion, relative to the sum of its absolute parts, that counts as none
)
_RESIDUAL = 1e-12  # of the solution, relative to ||K||_1 ||q|| + ||f||
_REFINEMENTS = 3  # one brings a regular K to rounding; a residual after three means that K is singular


class UnbalancedLoadError(AnalysisError):
    """Loads push a free structure. `imbalance` (r,): their work on each rigid vector relative to its absolute parts."""

    def __init__(self, imbalance: np.ndarray) -> None:
        self.imbalance = imbalance
        worst = int(np.argmax(imbalance))
        super().__init__(
            f"The loads do work on rigid-body motion {worst + 1} of {imbalance.size} (a share of {imbalance[worst]:.2g}), "
            "so there is no equilibrium; balance the loads or support that motion."
        )


def static_solution(K: sp.csc_array, M: sp.csc_array, f: np.ndarray, rigid_vectors: np.ndarray | None) -> np.ndarray:
    """Solve K q = f, with q M-orthogonal to the rigid-body motions.

    Args:
        K: (n, n) symmetric positive semidefinite.
        M: (n, n) likewise.
        f: (n,) one load case, or (n, p) several.
        rigid_vectors: (n, r) basis of the null space of K; None when K is regular.

    Returns:
        q of the shape of f, with ||K q - f|| <= 1e-12 (||K||_1 ||q|| + ||f||).

    Raises:
        UnbalancedLoadError: the loads do work on a rigid-body motion.
        AnalysisError: a rigid vector has no inertia, or K is singular beyond the rigid vectors given.
        ConvergenceError: the residual stays above its bound; `partial` holds q.
    """
    K = sp.csc_array(K, dtype=float)
    M = sp.csc_array(M, dtype=float)
    f = np.asarray(f, dtype=float)
    loads = f.reshape(K.shape[0], -1)
    R = np.zeros((K.shape[0], 0)) if rigid_vectors is None else np.asarray(rigid_vectors, dtype=float)
    with single_thread(K.shape[0]):
        check_pencil(M, K)

        # Balanced loads do no work on rigid-body motions but for rounding; inertia forces carry that rest.
        if R.shape[1]:
            work = R.T @ loads
            parts = np.abs(R.T) @ np.abs(loads)
            imbalance = (np.abs(work) / np.where(parts > 0.0, parts, 1.0)).max(axis=1)
            if np.any(imbalance > _BALANCE):
                raise UnbalancedLoadError(imbalance)
            loads = loads - M @ (R @ _inertia_solve(M, R, work))

        # The support is chosen by the rows of R. Scaled by the root of the stiffness, metres and radians compete fairly for it.
        stiffness = np.sqrt(np.maximum(K.diagonal(), np.finfo(float).tiny))
        comparable = R * stiffness[:, None]
        solver = SupportedSolver(K, comparable, comparable)

        # Refine, and take out the rigid part that the choice of the support left in.
        norm = norm_1(K)
        q = np.zeros_like(loads)
        for _ in range(_REFINEMENTS):
            q = q + solver.solve(loads - K @ q)
            q = q - R @ _inertia_solve(M, R, R.T @ (M @ q))
            residual = np.linalg.norm(loads - K @ q, axis=0)
            if np.all(residual <= _RESIDUAL * (norm * np.linalg.norm(q, axis=0) + np.linalg.norm(loads, axis=0))):
                return q.reshape(f.shape)
    raise ConvergenceError(
        "The static solution keeps a residual: the stiffness has a rigid-body motion that was not given, or a vector given "
        "as rigid-body motion is strained.",
        q,
    )


def _inertia_solve(M: sp.csc_array, R: np.ndarray, b: np.ndarray) -> np.ndarray:
    """(R^T M R)^-1 b, in units in which the diagonal of R^T M R is one."""
    if R.shape[1] == 0:
        return b
    inertia = R.T @ (M @ R)
    size = np.sqrt(np.maximum(np.diag(inertia), 0.0))
    if np.any(size == 0.0):
        raise AnalysisError("A rigid-body motion has no inertia: give the parts that it moves a mass or a support.")
    solved: np.ndarray = np.linalg.solve(inertia / size / size[:, None], b / size[:, None]) / size[:, None]
    return solved
