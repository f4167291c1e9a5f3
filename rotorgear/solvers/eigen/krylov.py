"""Block Krylov basis with full reorthogonalisation: V = orth[X, T X, T^2 X, ...], H = V^T W T V.

W is the inner product (the mass matrix, or none). T symmetric in W gives block Lanczos, any other T block Arnoldi. A
block finds repeated eigenvalues, and keeps the work in matrix-matrix products, a third of the cost of vector-by-vector.
Golub and Van Loan, Matrix Computations, 4th ed., sections 10.3.6 and 10.5.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
from scipy.linalg.lapack import dsyevd

from rotorgear.solvers.sparse.entries import stretches

Apply = Callable[[np.ndarray], np.ndarray]
_DEPENDENT = 1e-13  # a direction this much shorter than its block is rounding of the others
_ROOM = 200  # columns reserved at first
_EPS = float(np.finfo(float).eps)
_CLEAN = 2.0 * _EPS  # overlap of blocks after a pass over the whole basis
_SEMI = 1e-9  # overlap that costs Ritz pairs nothing yet: below the root of eps they are those of an orthogonal basis
_WELL_SPREAD = 3.0  # log of the ratio of singular values up to which one pass leaves an orthonormal block


class BlockKrylov:
    """Growing W-orthonormal basis; `basis` (n, m), `projection` H (m, m), `residuals(Y)` of Ritz vectors basis @ Y.

    `width` directions are expanded together; `size` m counts the basis vectors whose image under T is known.
    The start is T applied to random directions; so is whatever replaces a direction that has closed.
    """

    def __init__(self, apply: Apply, n: int, width: int, inner: Apply | None = None) -> None:
        self._apply = apply
        self._inner = inner
        self._random = np.random.default_rng(20)
        self.width = min(width, n)
        room = min(n, _ROOM) + width
        self._V = np.empty((n, room), order="F")  # untouched pages cost nothing
        self._H = np.zeros((room, room))
        self.size = 0
        self._border = np.zeros((0, 0))
        self._border_start = 0
        self._longest = 0.0
        self._drift = (_CLEAN, _CLEAN)
        self._block, _, self._weighted_block = self._orthonormal(self._fresh(self.width))
        self._weighted_before = self._weighted_block[:, :0]

    @property
    def exhausted(self) -> bool:
        """True when the basis spans the range of T: nothing is left to expand."""
        return self._block.shape[1] == 0

    @property
    def basis(self) -> np.ndarray:
        """V (n, m)."""
        return self._V[:, : self.size]

    @property
    def projection(self) -> np.ndarray:
        """H = V^T W T V (m, m)."""
        return self._H[: self.size, : self.size]

    def expand(self) -> None:
        """Apply T to the newest block and orthonormalise the image into the next one."""
        old = self.size
        new = self.size + self._block.shape[1]
        self._reserve(new + self._block.shape[1])
        self._V[:, old:new] = self._block
        self.size = new
        weighted = self._weighted_block
        # Symmetric T couples a block to its neighbours only: one full pass is then left to remove rounding.
        near = [] if self._inner is None else [self._weighted_before, weighted]
        self._block, coefficients, self._weighted_block = self._orthonormal(self._apply(weighted), near)
        self._weighted_before = weighted
        self._H[:new, old:new] = coefficients[:new]
        self._border = coefficients[new:]
        self._border_start = old
        self._H[new : new + self._border.shape[0], old:new] = self._border
        if self._block.shape[1] < self.width:
            self._inject(self.width - self._block.shape[1])

    def grow(self, size: int) -> None:
        """Expand until the basis has `size` vectors, or nothing is left to expand."""
        while self.size < size and not self.exhausted:
            self.expand()

    def widen(self, count: int) -> None:
        """Add fresh directions to the newest block: finds copies of eigenvalues that the start did not hold."""
        self.width += count
        self._inject(count)

    def _fresh(self, count: int) -> np.ndarray:
        """T applied to random directions (n, count): what T maps to zero is left out from the start."""
        return self._apply(self._weighted(self._random.standard_normal((self._V.shape[0], count))))

    def _inject(self, count: int) -> None:
        """Add fresh directions to the newest block, orthogonal to it and to the basis."""
        held = self.size
        pending = self._block.shape[1]
        self._reserve(held + pending)
        self._V[:, held : held + pending] = self._block
        self.size = held + pending  # for the orthogonalisation only: the images of these are not known yet
        fresh, _, weighted = self._orthonormal(self._fresh(count))
        self.size = held
        self._block = np.hstack([self._block, fresh])
        self._weighted_block = np.hstack([self._weighted_block, weighted])

    def ritz(self, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Largest eigenvalues θ (k,) of a symmetric T, falling, their coordinates (m, k), and residuals relative to θ (k,).

        No more than `count`; those that are rounding of the largest are left out.
        """
        H = self.projection
        theta, Y = np.linalg.eigh(0.5 * (H + H.T))
        theta = theta[::-1][:count]
        Y = Y[:, ::-1][:, :count]
        keep = theta > _EPS * theta[:1].max(initial=0.0)
        theta = theta[keep]
        Y = Y[:, keep]
        return theta, Y, self.residuals(Y) / theta

    def residuals(self, Y: np.ndarray) -> np.ndarray:
        """Norms ||T v - theta v||_W of the Ritz vectors v = V Y, with Y (m, k) eigenvectors of H."""
        norms: np.ndarray = np.linalg.norm(self._border @ Y[self._border_start :], axis=0)
        return norms

    def polished(self, Y: np.ndarray) -> np.ndarray:
        """T V Y (n, k) without another application of T: stiff parts that V Y still holds are scaled down by it."""
        last = self._border @ Y[self._border_start :]
        inner = self.projection @ Y
        V = self.basis
        block = self._block[:, : last.shape[0]]
        image = np.empty((V.shape[0], Y.shape[1]))  # by rows, as sparse products take it
        for rows in stretches(V.shape[0]):
            np.matmul(V[rows], inner, out=image[rows])
            image[rows] += block[rows] @ last
        return image

    def _reserve(self, size: int) -> None:
        """Make room for a basis of `size` columns."""
        if size > self._V.shape[1]:
            room = 2 * size
            V = np.empty((self._V.shape[0], room), order="F")
            V[:, : self.size] = self.basis
            H = np.zeros((room, room))
            H[: self._H.shape[0], : self._H.shape[1]] = self._H
            self._V = V
            self._H = H

    def _orthonormal(self, X: np.ndarray, near: Sequence[np.ndarray] = ()) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Q (n, r) orthonormal and orthogonal to V, the coefficients (m + r, b) with X = [V, Q] coefficients, and W Q.

        X is known to be orthogonal, but for rounding, to all columns of V but the last ones, whose images under W are `near`;
        to none of them where there are no such images.
        """
        V = self.basis
        first = np.concatenate([part.T @ X for part in near]) if near else (self._weighted(X).T @ V).T
        since = V.shape[1] - first.shape[0]
        above = np.zeros((V.shape[1], X.shape[1]))
        above[since:] = first
        below: np.ndarray | None = None
        X = X - _product(V[:, since:], first)
        WX = self._weighted(X)
        gram = X.T @ WX
        # Of the longest column as it came in; what is left of it in the passes is measured against unit vectors.
        squares = gram.diagonal() + np.einsum("ij,ij->j", first, first)
        length = math.sqrt(max(squares.tolist(), default=0.0))
        self._longest = max(self._longest, length)
        drift = self._drift_of(gram) if near else math.inf
        for _ in range(4):  # twice is enough (Kahan and Parlett) unless the block itself is nearly dependent
            if drift > _SEMI:
                overlap = (WX.T @ V).T  # faster than V.T @ WX for a narrow WX
                gram -= overlap.T @ overlap
                X -= _product(V, overlap)
                above += overlap if below is None else overlap @ below
            Q, triangle, spread = _compressed(gram, _DEPENDENT * length)
            X = _product(X, Q)
            WX = self._weighted(X) if drift > _SEMI else _product(WX, Q)
            below = triangle if below is None else triangle @ below
            if spread < _WELL_SPREAD or X.shape[1] == 0:
                break
            length = 1.0
            gram = X.T @ WX
            drift = math.inf
        self._drift = (self._drift[1], _CLEAN if drift > _SEMI else drift)
        return X, np.concatenate([above, below]), WX

    def _drift_of(self, gram: np.ndarray) -> float:
        """Estimated overlap of unit vectors along X with older blocks than its neighbours, from X^T W X.

        X = T V_j - V_j A_j - V_{j-1} B^T, so the overlap of block j counts with the norms of T and A_j, that of block j - 1 with
        the norm of B; both are divided by the length of X (Simon, Linear Algebra Appl. 61 (1984) 101).
        """
        before, last = self._drift
        shortest = min(gram.diagonal().tolist(), default=math.inf)
        border = math.sqrt(float(np.vdot(self._border, self._border)))
        grown = 2.0 * self._longest * last + border * before
        return grown / math.sqrt(shortest) if shortest > 0.0 else math.inf

    def _weighted(self, X: np.ndarray) -> np.ndarray:
        return X if self._inner is None else self._inner(X)


def _product(V: np.ndarray, C: np.ndarray) -> np.ndarray:
    """V C (n, b) of a tall V (n, m) that is stored by columns; BLAS is three times as slow on V @ C itself, for few columns."""
    return (C.T @ V.T).T


def _compressed(gram: np.ndarray, shortest: float) -> tuple[np.ndarray, np.ndarray, float]:
    """Q, R, spread with X = (X Q) R and X Q orthonormal, from X^T W X; directions under `shortest` are left out.

    The spread is the log of the ratio of the longest direction of unit columns to the shortest; 0 of none.
    """
    # Unit columns first: directions of very different lengths then do not hide each other in the eigenvalues.
    scale = np.sqrt(np.maximum(gram.diagonal(), 0.0))
    kept = scale > shortest
    if not kept.all():
        Q, R, spread = _compressed(gram[np.ix_(kept, kept)], shortest)
        inside = np.zeros((len(kept), Q.shape[1]))
        outside = np.zeros((Q.shape[1], len(kept)))
        inside[kept] = Q
        outside[:, kept] = R
        return inside, outside, spread
    if not len(scale):
        return gram, gram, 0.0
    values, vectors, _ = dsyevd(gram / scale / scale[:, None])  # in a fifth of the time of numpy's call of it
    # The eigenvalues of unit columns' products err by some eps of the largest: a direction below that is rounding.
    if values[0] <= 1e-14 * values[-1]:
        strong = values > 1e-14 * values[-1]
        values = values[strong]
        vectors = vectors[:, strong]
    roots = np.sqrt(values)
    return vectors / roots / scale[:, None], roots[:, None] * vectors.T * scale, math.log(roots[-1] / roots[0])
