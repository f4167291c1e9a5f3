"""A real basis that grows by complex vectors, orthonormal in coordinates scaled to unit diagonals."""

from __future__ import annotations

import numpy as np


class Subspace:
    """Span of the real and imaginary parts of the vectors added so far.

    Vectors are scaled by `weight` (n,), so that metres and radians, stiff and soft count alike. The first columns keep the
    directions of the vectors that came first: a soft mode is not turned among stiff ones.
    """

    def __init__(self, weight: np.ndarray, tolerance: float) -> None:
        self._weight = weight
        self._tolerance = tolerance
        self._scaled = np.zeros((len(weight), 0))

    @property
    def size(self) -> int:
        """Number of columns."""
        return int(self._scaled.shape[1])

    @property
    def basis(self) -> np.ndarray:
        """(n, size), real, in the coordinates of the vectors."""
        return np.asarray(self._scaled / self._weight[:, None])

    def add(self, vectors: np.ndarray) -> int:
        """Add what vectors (n, m) bring beside the span; return the number of new columns."""
        scaled = vectors * self._weight[:, None]
        scaled = scaled / np.maximum(np.linalg.norm(scaled, axis=0), np.finfo(float).tiny)
        # The phase of a mode is free: turned so that its real part is as large as can be, little is left for the imaginary one.
        turn = np.sum(scaled**2, axis=0)
        scaled = scaled * np.exp(-0.5j * np.angle(turn))
        new = 0
        for part in (scaled.real, scaled.imag):
            new += self._extend(part)
        return new

    def _extend(self, part: np.ndarray) -> int:
        """Add what real vectors (n, m) bring beside the span; return the number of new columns."""
        rest = part.copy()
        for _ in range(2):  # twice is enough for the rounding
            rest -= self._scaled @ (self._scaled.T @ rest)
        if self.size == 0:
            # QR takes the first vectors one after the other: soft modes keep their directions.
            Q, R = np.linalg.qr(rest)
            columns = Q[:, np.abs(np.diag(R)) > self._tolerance]
        else:
            # Of later ones only what is new counts, largest first.
            U, size, _ = np.linalg.svd(rest, full_matrices=False)
            columns = U[:, size > self._tolerance]
        columns = columns - self._scaled @ (self._scaled.T @ columns)
        self._scaled = np.hstack([self._scaled, columns])
        return int(columns.shape[1])
