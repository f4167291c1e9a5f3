"""Receptances of all harmonics at the local displacements: exact at some values of a parameter, rational between them.

    Z(h, p) X = B,   Z^T Y = B,   R = B^T X = B^T V (Y^T Z V)^-1 Y^T B

With V and Y from a few exact solutions the last form, a Petrov and Galerkin projection, gives the exact ones again, their
slopes in p, and what lies near: its error is the product of the residuals of both sides. Antoulas, Beattie and Gugercin,
Interpolatory Methods for Model Reduction (SIAM 2020).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from rotorgear.errors import ConvergenceError
from rotorgear.solvers.periodic.plant import Plant
from rotorgear.solvers.sparse.factor import factor_general

# Systems up to this size are solved densely, all harmonics at once.
_DENSE = 60
# Exact solutions that the rational form is made of.
_KEPT = 2


@dataclass(frozen=True)
class Projected:
    """Y^T A V of K, C, M and G (H, p, p), B^T V (H, m, p) and Y^T B (H, p, m)."""

    K: np.ndarray
    C: np.ndarray
    M: np.ndarray
    G: np.ndarray | None
    seen: np.ndarray
    pushed: np.ndarray


class Receptances:
    """Receptances of harmonics h w, h = 0 ... H, with w = order |speed|."""

    def __init__(self, harmonics: int, order: float) -> None:
        self._h = np.arange(1, harmonics + 1)
        self._order = order
        self._known: list[tuple[np.ndarray, np.ndarray]] = []
        self._bases: tuple[np.ndarray, np.ndarray] | None = None
        self._small: tuple[Plant, Projected] | None = None
        self.exact_solutions = 0
        # Those of half the frequencies, where a motion of twice the period asked for them.
        self.twice: Receptances | None = None

    @property
    def begun(self) -> bool:
        """Whether there is an exact solution."""
        return bool(self._known)

    def frequencies(self, plant: Plant) -> np.ndarray:
        """Of the harmonics from the first on, rad/s."""
        return np.asarray(self._h * self._order * abs(plant.speed))

    def exact(self, plant: Plant) -> tuple[np.ndarray, np.ndarray]:
        """R (H + 1, m, m) and the displacements X (H, n, m) of unit local forces, h from 1 on."""
        w = self.frequencies(plant)
        B = plant.B.astype(complex)
        n, m = B.shape
        self.exact_solutions += 1
        if n <= _DENSE:
            K, D, M = (A.toarray() for A in (plant.K, plant.D, plant.M))
            Z = K + 1j * w[:, None, None] * D - (w**2)[:, None, None] * M
            try:
                X = np.linalg.solve(Z, np.broadcast_to(B, (len(w), n, m)))
                Y = np.linalg.solve(Z.transpose(0, 2, 1), np.broadcast_to(B, (len(w), n, m)))
            except np.linalg.LinAlgError:
                raise ConvergenceError(_SINGULAR) from None
        else:
            X = np.empty((len(w), n, m), complex)
            Y = np.empty_like(X)
            K, D, M = _on_one_pattern(plant)
            for i, frequency in enumerate(w):
                data = K.data + (1j * frequency) * D.data - frequency**2 * M.data
                factor = factor_general(sp.csc_array((data, K.indices, K.indptr), shape=K.shape))
                X[i] = factor.solve(B)
                Y[i] = factor.solve(B, transposed=True)
        if not np.all(np.isfinite(X)):
            raise ConvergenceError(_SINGULAR)
        self._known = [*self._known, (X, Y)][-_KEPT:]
        self._bases = None
        self._small = None
        return self._with_static(plant, plant.B.T @ X), X

    def near(self, plant: Plant) -> np.ndarray:
        """R (H + 1, m, m) by the rational form; exact solutions have to be there."""
        own = self._projected(plant)
        w = self.frequencies(plant)[:, None, None]
        inner = own.K + 1j * w * own.C - w**2 * own.M
        if own.G is not None:
            inner = inner + 1j * w * plant.speed * own.G
        return self._with_static(plant, own.seen @ np.linalg.solve(inner, own.pushed))

    def _projected(self, plant: Plant) -> Projected:
        """The plant in both bases: anew where more than its speed and load has changed."""
        if self._small is not None and _same_matrices(self._small[0], plant):
            return self._small[1]
        if self._bases is None:
            # Columns of one size, orthonormal: two values next to each other give nearly the same ones.
            V, Y = (np.concatenate([pair[side] for pair in self._known], axis=2) for side in (0, 1))
            self._bases = (_orthonormal(V), _orthonormal(Y).transpose(0, 2, 1))
        V, left = self._bases
        h, n, p = V.shape
        flat = V.transpose(1, 0, 2).reshape(n, h * p)

        def seen_by_both(A: sp.csc_array) -> np.ndarray:
            return np.asarray(left @ (A @ flat).reshape(n, h, p).transpose(1, 0, 2))

        own = Projected(
            seen_by_both(plant.K),
            seen_by_both(plant.C),
            seen_by_both(plant.M),
            None if plant.gyroscopic is None else seen_by_both(plant.gyroscopic),
            plant.B.T @ V,
            left @ plant.B,
        )
        self._small = (plant, own)
        return own

    def _with_static(self, plant: Plant, R: np.ndarray) -> np.ndarray:
        return np.concatenate([plant.still.R[None].astype(complex), R])


def _orthonormal(V: np.ndarray) -> np.ndarray:
    return np.linalg.qr(V / np.linalg.norm(V, axis=1, keepdims=True))[0]


def _same_matrices(a: Plant, b: Plant) -> bool:
    return a.K is b.K and a.C is b.C and a.M is b.M and a.gyroscopic is b.gyroscopic and a.B is b.B


_SINGULAR = (
    "a harmonic of the excitation meets an undamped resonance to the last digit: move the range, or give damping"
)


def _on_one_pattern(plant: Plant) -> tuple[sp.csc_array, sp.csc_array, sp.csc_array]:
    """K, D and M with the places of each other's entries, so that their sums are sums of data."""
    parts = [sp.coo_array(A) for A in (plant.K, plant.D, plant.M)]
    n = plant.K.shape[0]
    keys = [part.col.astype(np.int64) * n + part.row for part in parts]
    all_keys = np.unique(np.concatenate(keys))
    first = np.searchsorted(all_keys // n, np.arange(n + 1))
    rows = all_keys % n
    found = []
    for part, key in zip(parts, keys, strict=True):
        data = np.zeros(all_keys.size)
        np.add.at(data, np.searchsorted(all_keys, key), part.data)
        found.append(sp.csc_array((data, rows, first), shape=(n, n)))
    return found[0], found[1], found[2]
