"""A real basis that begins with the undamped modes and grows by what residuals ask for."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from rotorgear.solvers.eigen.quadratic import Quadratic, scaled
from rotorgear.solvers.eigen.reduced_pencil import Pencil
from rotorgear.solvers.sparse.entries import norm_1, scaled_on_both_sides, times

Strain = Callable[[np.ndarray], np.ndarray]

# Part of a correction that is not worth a column of the basis, relative to its mode.
_NEGLIGIBLE = 1e-9
# What D R of a rigid-body motion may be beside |D| |R| and still count as rounding.
_ROUNDING = 1e-13


@dataclass(frozen=True)
class NearUndamped:
    """(s^2 M + s D + K) v = 0 with K = S^T S, `strain(V)` = S V, and its undamped modes. M, D and K are (n, n).

    `modes` (n, k) are elastic and M-orthonormal, lowest first, none missing up to the last, with `frequencies` (k,) in rad/s;
    `rigid` (n, r) are the rigid-body motions, M-orthonormal. There is one elastic mode at least.
    """

    M: sp.csc_array
    D: sp.csc_array
    K: sp.csc_array
    strain: Strain
    frequencies: np.ndarray
    modes: np.ndarray
    rigid: np.ndarray

    @property
    def shift(self) -> float:
        """sigma in rad/s: low beside the first mode, so that corrections by (K + sigma^2 M)^-1 of soft modes are good ones."""
        return 0.3 * float(self.frequencies[0])

    @cached_property
    def weight(self) -> np.ndarray:
        """(K_ii + sigma^2 M_ii)^1/2, (n,): units of forces and moments do not matter in coordinates scaled by it."""
        size = np.sqrt(self.K.diagonal() + self.shift**2 * self.M.diagonal())
        return np.where(size > 0.0, size, 1.0)

    @cached_property
    def damping(self) -> sp.csc_array:
        """(D + D^T) / 2, sparse (n, n): what takes energy out."""
        return sp.csc_array(0.5 * (self.D + self.D.T))

    @cached_property
    def quadratic(self) -> Quadratic:
        """The pencil in scaled dofs and time, for backward errors."""
        return scaled(self.M, self.D, self.K, float(self.frequencies[0]))

    def applied(self, s: np.ndarray, V: np.ndarray, transposed: bool = False) -> np.ndarray:
        """Q(s_j) v_j (n, m) for s (m,) and V (n, m), or Q(s_j)^T v_j."""
        D = self.D.T if transposed else self.D
        return times(self.M, V) * s**2 + times(D, V) * s + times(self.K, V)

    def moves_rigid_bodies(self) -> bool:
        """Whether D acts on a rigid-body motion, which then does not stand apart from the other modes."""
        if not self.rigid.shape[1]:
            return False
        D = scaled_on_both_sides(self.D, 1.0 / self.weight)
        R = self.rigid * self.weight[:, None]
        R = R / np.linalg.norm(R, axis=0)
        return float(max(np.abs(D @ R).max(), np.abs(D.T @ R).max())) > _ROUNDING * norm_1(D)

    def without_rigid(self, X: np.ndarray) -> np.ndarray:
        """X (n, m) without its part in the rigid-body motions, which have none in elastic modes."""
        return X - self.rigid @ (self.rigid.T @ times(self.M, X)) if self.rigid.shape[1] else X


class UndampedBasis:
    """The basis in coordinates scaled by the weight of the problem, orthonormal."""

    def __init__(self, problem: NearUndamped) -> None:
        self._problem = problem
        self._weight = problem.weight[:, None]
        # QR takes one vector after the other: soft modes keep their directions among stiff ones.
        self._scaled = np.linalg.qr(problem.modes * self._weight)[0]

    @property
    def size(self) -> int:
        """Number of columns."""
        return int(self._scaled.shape[1])

    @property
    def basis(self) -> np.ndarray:
        """(n, size), real, in the coordinates of the dofs."""
        return np.asarray(self._scaled / self._weight)

    def pencil(self, V: np.ndarray) -> Pencil:
        """M, D and K on a basis V (n, r); K through its strains, free of the rounding of the assembled one."""
        S = self._problem.strain(V)
        return Pencil(V.T @ (self._problem.M @ V), V.T @ (self._problem.D @ V), S.T @ S)

    def add(self, vectors: np.ndarray, size: np.ndarray, coarse: float) -> None:
        """Add what real or complex vectors (n, m) bring beside the span.

        Args:
            vectors: (n, m).
            size: what they correct, (m,) norms in scaled coordinates.
            coarse: share of the largest addition that waits for the next round: a correction is no better than that.
        """
        new = vectors * self._weight / size
        rest = np.hstack([new.real, new.imag]) if np.iscomplexobj(new) else new
        for _ in range(2):  # twice is enough for the rounding
            rest = rest - self._scaled @ (self._scaled.T @ rest)
        U, sizes, _ = np.linalg.svd(rest, full_matrices=False)
        least = max(_NEGLIGIBLE, coarse * float(sizes.max(initial=0.0)))
        self._scaled = np.hstack([self._scaled, U[:, sizes > least]])

    def sizes(self, V: np.ndarray) -> np.ndarray:
        """Norms (m,) of vectors V (n, m) in scaled coordinates."""
        return np.asarray(np.linalg.norm(V * self._weight, axis=0))
