"""Static equilibrium K q = f where some motions R are free of strain: K R = 0 and R^T K = 0. K may be non-symmetric.

The loads must do no work on R. Then q is the solution on a statically determinate support of r dofs, which carries no load;
what is left open is q + R c (Geradin and Rixen, Mechanical Vibrations, 3rd ed., section 3.3, John Wiley 2015).
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from rotorgear.errors import AnalysisError, ConvergenceError
from rotorgear.solvers.sparse.nullspace import SupportedSolver, orthonormal_motions

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


class Equilibrium:
    """Solves K q = f again and again for loads that leave the free motions R (n, r) alone.

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
        self._solver = SupportedSolver(self._K, self._R, self._R)

    def solve(self, f: np.ndarray, *, carried: bool = False) -> np.ndarray:
        """Return q (n, p) for loads f (n, p); `carried`: what they do on the free motions is left out, not refused.

        Raises:
            UnbalancedLoadError: a load does work on a free motion.
            ConvergenceError: the residual stays above 1e-11 of the forces inside; `partial` holds q.
        """
        rest = self._free_of_rigid(f) if carried else self._balanced(f)
        target = rest
        q = np.zeros_like(f)
        size = abs(self._K)
        for _ in range(_REFINEMENTS):
            q = q + self._solver.solve(rest)
            rest = self._free_of_rigid(target - self._K @ q)
            scale = np.abs(size @ np.abs(q)) + np.abs(target)
            noise = np.max(np.abs(rest / self._scale[:, None]), axis=0)
            if np.all(noise <= _RESIDUAL * np.max(scale / self._scale[:, None], axis=0)):
                return q
        raise ConvergenceError("the static solution keeps a residual: look for stiffnesses many decades apart", q)

    def _balanced(self, f: np.ndarray) -> np.ndarray:
        """The loads less the rounding of their balance."""
        scaled = f / self._scale[:, None]
        work = self._R.T @ scaled
        parts = np.abs(self._R.T) @ np.abs(scaled)
        if self._R.shape[1]:
            noise = _ROUNDING * np.linalg.norm(scaled, axis=0)  # a motion that the loads hardly touch
            imbalance = (np.abs(work) / np.maximum(parts, np.where(noise > 0.0, noise, 1.0))).max(axis=1)
            imbalance[np.all(np.abs(work) <= noise, axis=1)] = 0.0
            if np.any(imbalance > _BALANCE):
                raise UnbalancedLoadError(imbalance)
        return self._free_of_rigid(f)

    def _free_of_rigid(self, f: np.ndarray) -> np.ndarray:
        """The part of f (n, p) that does no work on the free motions."""
        scaled = f / self._scale[:, None]
        return np.asarray((scaled - self._R @ (self._R.T @ scaled)) * self._scale[:, None])
