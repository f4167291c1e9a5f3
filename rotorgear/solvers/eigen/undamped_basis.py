"""Real bases, orthonormal in scaled coordinates, that grow by modes or by what the residuals of modes ask for."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from rotorgear.errors import ConvergenceError
from rotorgear.solvers.eigen.reduced_pencil import Pencil
from rotorgear.solvers.sparse.entries import halves, scaled_norm_1, times
from rotorgear.solvers.sparse.factor import Factor, factor_symmetric


class ScaledBasis:
    """Span of real vectors, orthonormal in coordinates scaled by `weight` (n,), in which metres and radians count alike.

    It begins with the vectors `first` (n, m), whose directions its first columns keep: QR takes one after the other, so that a
    soft mode is not turned among stiff ones.
    """

    def __init__(self, weight: np.ndarray, first: np.ndarray | None = None) -> None:
        self._weight = weight
        self._scaled = np.zeros((len(weight), 0)) if first is None else np.linalg.qr(first * weight[:, None])[0]

    @property
    def size(self) -> int:
        """Number of columns."""
        return int(self._scaled.shape[1])

    @property
    def basis(self) -> np.ndarray:
        """(n, size), real, in the coordinates of the dofs."""
        return np.asarray(self._scaled / self._weight[:, None])

    def sizes(self, V: np.ndarray) -> np.ndarray:
        """Norms (m,) of vectors V (n, m) in scaled coordinates."""
        return np.asarray(np.linalg.norm(V * self._weight[:, None], axis=0))

    def _beside(self, scaled: np.ndarray) -> np.ndarray:
        """What real scaled vectors (n, m) have beside the span."""
        for _ in range(2):  # twice is enough for the rounding
            scaled = scaled - self._scaled @ (self._scaled.T @ scaled)
        return scaled

    def add_modes(self, vectors: np.ndarray, tolerance: float) -> int:
        """Add real and imaginary parts of modes (n, m) of any scale; return the number of new columns.

        A part of a mode beside the span that is below the tolerance, relative to the mode, is not worth a column.
        """
        scaled = vectors * self._weight[:, None]
        scaled = scaled / np.maximum(np.linalg.norm(scaled, axis=0), np.finfo(float).tiny)
        # The phase of a mode is free: turned so that its real part is as large as can be, little is left for the imaginary one.
        scaled = scaled * np.exp(-0.5j * np.angle(np.sum(scaled**2, axis=0)))
        before = self.size
        for part in (scaled.real, scaled.imag):
            beside = self._beside(part.copy())
            if self.size == 0:
                # QR takes the first vectors one after the other: soft modes keep their directions.
                Q, R = np.linalg.qr(beside)
                columns = Q[:, np.abs(np.diag(R)) > tolerance]
            else:
                # Of later ones only what is new counts, largest first.
                U, size, _ = np.linalg.svd(beside, full_matrices=False)
                columns = U[:, size > tolerance]
            columns = columns - self._scaled @ (self._scaled.T @ columns)
            self._scaled = np.hstack([self._scaled, columns])
        return self.size - before

    def add_corrections(self, vectors: np.ndarray, size: np.ndarray, coarse: float) -> None:
        """Add what real or complex vectors (n, m) have beside the span.

        Args:
            vectors: (n, m).
            size: what they correct, (m,) norms in scaled coordinates.
            coarse: share of the largest addition that waits for the next round: a correction is no better than that.
        """
        new = vectors * self._weight[:, None] / size
        beside = self._beside(np.hstack([new.real, new.imag]) if np.iscomplexobj(new) else new)
        U, sizes, _ = np.linalg.svd(beside, full_matrices=False)
        least = max(_NEGLIGIBLE, coarse * float(sizes.max(initial=0.0)))
        self._scaled = np.hstack([self._scaled, U[:, sizes > least]])


# sigma over the first frequency where no factor is there.
_LOW = 0.3
Strain = Callable[[np.ndarray], np.ndarray]

# Part of a correction that is not worth a column of the basis, relative to its mode.
_NEGLIGIBLE = 1e-9
# By how much corrections may move a pair past another one, or past a limit, relative to it.
_CORRECTED = 1e-2
# What D R of a rigid-body motion may be beside |D| |R| and still count as rounding.
_ROUNDING = 1e-13


@dataclass(frozen=True)
class NearUndamped:
    """(s^2 M + s D + K) v = 0 with K = S^T S, `strain(V)` = S V, and its undamped modes. M, D and K are (n, n).

    `modes` (n, k) are elastic and M-orthonormal, lowest first, none missing up to the last, with `frequencies` (k,) in rad/s;
    `rigid` (n, r) are the rigid-body motions, M-orthonormal. There is one elastic mode at least. `factored` are sigma in rad/s
    and the factor of K + sigma^2 M, where there is one already; sigma is low beside the first frequency, so that corrections
    by that matrix are good ones of soft modes.
    """

    M: sp.csc_array
    D: sp.csc_array
    K: sp.csc_array
    strain: Strain
    frequencies: np.ndarray
    modes: np.ndarray
    rigid: np.ndarray
    factored: tuple[float, Factor] | None = None

    @property
    def shift(self) -> float:
        """sigma in rad/s."""
        return _LOW * float(self.frequencies[0]) if self.factored is None else self.factored[0]

    @cached_property
    def factor(self) -> Factor:
        """Factor of K + sigma^2 M."""
        if self.factored is not None:
            return self.factored[1]
        return factor_symmetric(sp.csc_array(self.K + self.shift**2 * self.M))

    @cached_property
    def weight(self) -> np.ndarray:
        """(K_ii + sigma^2 M_ii)^1/2, (n,): units of forces and moments do not matter in coordinates scaled by it."""
        size = np.sqrt(self.K.diagonal() + self.shift**2 * self.M.diagonal())
        return np.where(size > 0.0, size, 1.0)

    @cached_property
    def halves(self) -> tuple[sp.csc_array, sp.csc_array]:
        """(D + D^T) / 2, what takes energy out, and (D - D^T) / 2, what does no work, sparse (n, n)."""
        return halves(self.D)

    @cached_property
    def _rows(self) -> sp.csr_array:
        """[M; D; K], sparse (3 n, n)."""
        return sp.csr_array(sp.vstack([self.M.T, sp.csr_array(self.D), self.K.T], format="csr"))

    def pencil(self, V: np.ndarray) -> Pencil:
        """M, D and K on a basis V (n, r); K through its strains, free of the rounding of the assembled one."""
        S = self.strain(V)
        return Pencil(V.T @ (self.M @ V), V.T @ (self.D @ V), S.T @ S)

    def products(self, V: np.ndarray) -> np.ndarray:
        """M V, D V and K V: (3, n, m) for real or complex V (n, m)."""
        return times(self._rows, V).reshape(3, *V.shape)

    def mirrored(self, V: np.ndarray, products: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """M V, D^T V and K V, (n, m) each, from the other `products` of V (n, m)."""
        mass, velocity, stiffness = products
        return mass, 2.0 * times(self.halves[0], V) - velocity, stiffness

    def applied(self, s: np.ndarray, V: np.ndarray) -> np.ndarray:
        """Q(s_j) v_j (n, m) for s (m,) and V (n, m)."""
        return forces(s, self.products(V))

    @cached_property
    def _scaled_dofs(self) -> tuple[np.ndarray, float, float, float]:
        """1/sqrt(|k_ii| + w0 |d_ii| + w0^2 m_ii), (n,), and ||M||_1, ||D||_1, ||K||_1 in dofs scaled by it."""
        w0 = float(self.frequencies[0])
        diagonal = np.abs(self.K.diagonal()) + w0 * np.abs(self.D.diagonal()) + w0**2 * np.abs(self.M.diagonal())
        scale = 1.0 / np.sqrt(np.where(diagonal > 0.0, diagonal, 1.0))
        return scale, scaled_norm_1(self.M, scale), scaled_norm_1(self.D, scale), scaled_norm_1(self.K, scale)

    def backward_errors(self, s: np.ndarray, V: np.ndarray, left: np.ndarray) -> np.ndarray:
        """||Q(s) v|| / ((|s|^2 ||M||_1 + |s| ||D||_1 + ||K||_1) ||v||) of each pair, (m,), in scaled dofs; `left` is Q(s) V."""
        scale, mass, velocity, stiffness = self._scaled_dofs
        size = np.abs(s)
        size = ((size * mass + velocity) * size + stiffness) * np.linalg.norm(V / scale[:, None], axis=0)
        return np.asarray(np.linalg.norm(left * scale[:, None], axis=0) / np.maximum(size, np.finfo(float).tiny))

    def moves_rigid_bodies(self) -> bool:
        """Whether D acts on a rigid-body motion, and so couples it to the other modes."""
        if not self.rigid.shape[1]:
            return False
        weight = self.weight[:, None]
        R = self.rigid / np.linalg.norm(self.rigid * weight, axis=0)
        moved = max(float(np.abs((A @ R) / weight).max()) for A in (self.D, self.D.T))
        return moved > _ROUNDING * scaled_norm_1(self.D, 1.0 / self.weight)

    def counted_below(self, w: float) -> int | None:
        """How many modes of the structure without its dampers lie below w in rad/s, rigid-body motions among them.

        By the signs of the pivots of K + i w G - w^2 M, see `gyroscopic`; None where there are no factors without row exchanges.
        """
        G = self.halves[1]
        turning = sp.csc_array((1j * w * G.data, G.indices, G.indptr), shape=G.shape)
        try:
            factor = factor_symmetric(self.K - w**2 * self.M + turning)
        except ConvergenceError:
            return None
        return factor.negative_count()

    def without_rigid(self, X: np.ndarray) -> np.ndarray:
        """X (n, m) without its part in the rigid-body motions, which have none in elastic modes."""
        return X - self.rigid @ (self.rigid.T @ times(self.M, X)) if self.rigid.shape[1] else X


def forces(s: np.ndarray, products: np.ndarray | tuple[np.ndarray, np.ndarray, np.ndarray]) -> np.ndarray:
    """s_j^2 M v_j + s_j D v_j + K v_j, (n, m), from the three products, (n, m) each."""
    mass, velocity, stiffness = products
    return np.asarray((mass * s + velocity) * s + stiffness)


def with_near(size: np.ndarray, rows: int, limit: float) -> int:
    """How many pairs of a basis, by size (m,), may be among the first `rows` up to a limit once they are corrected."""
    last = float(size[rows - 1]) if 0 < rows <= len(size) else np.inf if rows else 0.0
    return int(np.count_nonzero(size <= min(limit, last) * (1.0 + _CORRECTED)))
