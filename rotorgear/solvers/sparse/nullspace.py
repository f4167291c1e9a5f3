"""Static equilibrium K q = f with a known null space, K R = 0, solved on a statically determinate support of r dofs.

The support dofs come from a pivoted QR of R: R restricted to them is well conditioned, so K without them is regular.
Loads that do no work on R, L^T f = 0 with L^T K = 0, leave the support without a load, and the solution is exact; what
is left open is q + R c (Geradin and Rixen, Mechanical Vibrations, 3rd ed., section 3.3, John Wiley 2015).
Bodies that nothing joins have no dof in common: each has its own QR, of its few motions.
Golub and Van Loan, Matrix Computations, 4th ed., section 5.4 (column pivoting).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from rotorgear.errors import AnalysisError, ConvergenceError
from rotorgear.solvers.sparse.factor import factor_general

Solve = Callable[[np.ndarray], np.ndarray]

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
    of_dofs = by_label(label[:n])
    none = np.zeros(0, dtype=int)
    bodies = [(of_dofs.get(number, none), motions) for number, motions in by_label(label[n:]).items()]
    if any(len(dofs) < len(motions) for dofs, motions in bodies):
        return [(np.arange(n), np.arange(r))]
    return bodies


def by_label(label: np.ndarray) -> dict[int, np.ndarray]:
    """The places of each number among `label` (k,), ascending."""
    if label.size and np.all(label == label[0]):  # as of one element group, of which there are many
        return {int(label[0]): np.arange(label.size)}
    order = np.argsort(label, kind="stable")
    values, first = np.unique(label[order], return_index=True)
    return dict(zip(values.tolist(), np.split(order, first[1:]), strict=False))  # no places have one empty part


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


def settled_null_space(K: sp.csc_array, M: sp.csc_array, R: np.ndarray) -> np.ndarray:
    """Orthonormal basis (n, r) of the null space of K from one that is nearly it, by inverse iteration beside zero."""
    factor = factor_general(sp.csc_array(K + 1e-6 * M))
    for _ in range(4):
        R = np.linalg.qr(factor.solve(M @ R))[0]
    return R


def supported_solver(K: sp.csc_array, R: np.ndarray, L: np.ndarray) -> Solve:
    """What solves K q = f, each (n,) or (n, m), for f orthogonal to L; q is zero at the support dofs of R.

    Raises:
        AnalysisError: K stays singular on the support: it has more rigid-body motions than R.
    """
    every = np.arange(K.shape[0])
    columns = np.setdiff1d(every, support_dofs(R))
    rows = columns if L is R else np.setdiff1d(every, support_dofs(L))
    try:
        factor = factor_general(sp.csc_array(K[rows][:, columns]))
    except ConvergenceError as error:
        raise AnalysisError(
            f"The stiffness has more rigid-body motions (to its rounding) than the {R.shape[1]} given: give them all."
        ) from error

    def solve(f: np.ndarray) -> np.ndarray:
        q = np.zeros(f.shape)
        q[columns] = factor.solve(f[rows])
        return q

    return solve


def inertia_relief(K: sp.csc_array, M: sp.csc_array, R: np.ndarray) -> Solve:
    """What gives static displacements without the M-orthonormal motions R (n, r); their inertia carries its share of forces."""
    supported = supported_solver(K, in_comparable_units(R, K, M), left_null_space(K, M, R))

    def solve(f: np.ndarray) -> np.ndarray:
        q = supported(f - M @ (R @ (R.T @ f)))
        return np.asarray(q - R @ (R.T @ (M @ q)))

    return solve


_BALANCE = 1e-8  # work relative to the sum of its absolute parts that counts as none
_RESIDUAL = 1e-11  # relative to the largest force inside, |K||q| + |f|
_ROUNDING = 1e-11  # work on a free motion below this share of the whole load is rounding of the load itself
_REFINEMENTS = 4


class UnbalancedLoadError(AnalysisError):
    """Loads push a free structure. `imbalance` (r,): their work on each rigid vector relative to its absolute parts."""

    def __init__(self, imbalance: np.ndarray) -> None:
        self.imbalance = imbalance
        worst = int(np.argmax(imbalance))
        super().__init__(
            f"The loads do work on rigid-body motion {worst + 1} of {imbalance.size} (a share of {imbalance[worst]:.2g}), "
            "so there is no equilibrium; balance the loads or support that motion."
        )


class StaticSolver:
    """Solves K q = f for many loads that do no work on the free motions R (n, r): K R = 0 and R^T K = 0.

    Raises:
        AnalysisError: K is singular beyond R.
    """

    def __init__(self, K: sp.csc_array, R: np.ndarray) -> None:
        self._K = sp.csc_array(K, dtype=float)
        # Scaled by the root of the stiffness, metres and radians compete fairly for the support; a dof without stiffness of its
        # own counts as a typical one.
        diagonal = np.abs(self._K.diagonal())
        typical = float(np.median(diagonal[diagonal > 0.0])) if np.any(diagonal > 0.0) else 1.0
        self._scale = np.sqrt(np.where(diagonal > 0.0, diagonal, typical))
        self._R = orthonormal_motions(R * self._scale[:, None])  # of q * scale
        self._solve = supported_solver(self._K, self._R, self._R)

    def solve(self, f: np.ndarray, *, carried: bool = False) -> np.ndarray:
        """Return q (n, p) for loads f (n, p); with `carried` their work on free motions is left out instead of refused.

        Raises:
            UnbalancedLoadError: a load does work on a free motion.
            ConvergenceError: the residual stays above 1e-11 of the forces inside; `partial` holds q.
        """
        if not carried:
            self._check_balance(f)
        target = residual = self._without_rigid(f)
        q = np.zeros_like(f)
        size = abs(self._K)
        for _ in range(_REFINEMENTS):
            q = q + self._solve(residual)
            residual = self._without_rigid(target - self._K @ q)
            scale = np.abs(size @ np.abs(q)) + np.abs(target)
            noise = np.max(np.abs(residual / self._scale[:, None]), axis=0)
            if np.all(noise <= _RESIDUAL * np.max(scale / self._scale[:, None], axis=0)):
                return q
        raise ConvergenceError("the static solution keeps a residual: look for stiffnesses many decades apart", q)

    def _check_balance(self, f: np.ndarray) -> None:
        """Refuse loads that do work on a free motion."""
        if not self._R.shape[1]:
            return
        scaled = f / self._scale[:, None]
        work = self._R.T @ scaled
        parts = np.abs(self._R.T) @ np.abs(scaled)
        noise = _ROUNDING * np.linalg.norm(scaled, axis=0)  # a motion that the loads hardly touch
        imbalance = (np.abs(work) / np.maximum(parts, np.where(noise > 0.0, noise, 1.0))).max(axis=1)
        imbalance[np.all(np.abs(work) <= noise, axis=1)] = 0.0
        if np.any(imbalance > _BALANCE):
            raise UnbalancedLoadError(imbalance)

    def _without_rigid(self, f: np.ndarray) -> np.ndarray:
        """The part of f (n, p) that does no work on the free motions."""
        scaled = f / self._scale[:, None]
        return np.asarray((scaled - self._R @ (self._R.T @ scaled)) * self._scale[:, None])
