"""Receptances of all harmonics at the local displacements: exact at some values of a parameter, rational between them.

    Z(h, p) X = B,   Z^T Y = B,   R = B^T X = B^T V (Y^T Z V)^-1 Y^T B

With V and Y from a few exact solutions the last form, a Petrov and Galerkin projection, gives the exact ones again, their
slopes in p, and what lies near: its error is the product of the residuals of both sides. What it changes by without the oldest of
these solutions is more than its own error, and tells where the next one is due. Antoulas, Beattie and Gugercin,
Interpolatory Methods for Model Reduction (SIAM 2020).
"""

from __future__ import annotations

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp

from rotorgear.errors import ConvergenceError
from rotorgear.solvers.periodic.plant import Plant, PlantAt
from rotorgear.solvers.sparse.entries import on_one_pattern
from rotorgear.solvers.sparse.factor import factor_general

# Systems up to this size are solved densely, and those whose damping is full to such a share, as modal damping makes it.
_DENSE = 60
_FULL = 0.3
# Exact solutions that the rational form is made of, and the largest change without the oldest of them up to which it is used.
_KEPT = 3
_ENOUGH = 1e-10
# How far beyond these solutions, over what they span, it is worth a try.
_REACH = 0.25


class Receptances:
    """Receptances of harmonics h w, h = 0 ... H, with w = order |speed|."""

    def __init__(self, harmonics: int, order: float) -> None:
        self._h = np.arange(1, harmonics + 1)
        self._order = order
        self._known: list[tuple[np.ndarray, np.ndarray]] = []
        # Values of the parameter of the exact solutions; those of an interrupted run are solved for again when they are needed.
        self.places: list[float] = []
        self._plant_at: PlantAt | None = None
        # By the solutions left out and whether watched places are in it.
        self._bases: dict[tuple[int, bool], tuple[np.ndarray, np.ndarray]] = {}
        self._small: dict[tuple[int, bool], tuple[Plant, list[np.ndarray], np.ndarray | None]] = {}
        # Those of half the frequencies, where a motion of twice the period asked for them.
        self.twice: Receptances | None = None

    @property
    def begun(self) -> bool:
        """Whether there is an exact solution."""
        return bool(self.places)

    def recall(self, places: list[float], plant_at: PlantAt) -> None:
        """Go on as if these were the values of the last exact solutions, of these plants."""
        if places != self.places:
            self.places = places
            self._plant_at = plant_at
            self._forget()

    def _forget(self) -> None:
        self._known = []
        self._bases.clear()
        self._small.clear()

    @property
    def _pairs(self) -> list[tuple[np.ndarray, np.ndarray]]:
        """X and Y of the exact solutions."""
        if len(self._known) < len(self.places) and self._plant_at is not None:
            self._known = [self._solved(self._plant_at(place)) for place in self.places]
        return self._known

    def frequencies(self, plant: Plant) -> np.ndarray:
        """Of the harmonics from the first on, rad/s."""
        return np.asarray(self._h * self._order * abs(plant.speed))

    def exact(self, plant: Plant, place: float) -> np.ndarray:
        """Displacements X (H, n, m + p) of unit local forces, and of unit forces at the p watched places, h from 1 on.

        `place`: of the plant along the parameter.
        """
        known = self._pairs
        found = self._solved(plant)
        self._forget()
        self._known = [*known, found][-_KEPT:]
        self.places = [*self.places, place][-_KEPT:]
        return found[0]

    def _solved(self, plant: Plant) -> tuple[np.ndarray, np.ndarray]:
        """X and Y (H, n, m + p) of both sides."""
        w = self.frequencies(plant)
        B = np.hstack([plant.B, plant.watched]).astype(complex)
        n, m = B.shape
        X = np.empty((len(w), n, m), complex)
        Y = np.empty_like(X)
        if n <= _DENSE or _full(plant.D):
            K, D, M = (A.toarray() for A in (plant.K, plant.D, plant.M))
            for i, frequency in enumerate(w):
                lu, pivots, singular = la.lapack.zgetrf(K + 1j * frequency * D - frequency**2 * M, overwrite_a=True)
                if singular:
                    raise ConvergenceError(_SINGULAR)
                X[i] = la.lapack.zgetrs(lu, pivots, B)[0]
                Y[i] = la.lapack.zgetrs(lu, pivots, B, trans=1)[0]
        else:
            # On one pattern sums of matrices are sums of their values; the rows of a transpose are columns.
            first, row, (k, d, mass) = on_one_pattern(plant.K.T, plant.D.T, plant.M.T)
            for i, frequency in enumerate(w):
                data = k + (1j * frequency) * d - frequency**2 * mass
                factor = factor_general(sp.csc_array((data, row, first), shape=plant.K.shape))
                X[i] = factor.solve(B)
                Y[i] = factor.solve(B, transposed=True)
        if not np.all(np.isfinite(X)):
            raise ConvergenceError(_SINGULAR)
        return X, Y

    def holds_for(self, plant: Plant, place: float) -> bool:
        """Whether the rational form is exact but for rounding at a plant: without its oldest solution it gives the same."""
        # Bases cost as much as half a solution: not where a form of so few can't reach.
        low = min(self.places, default=0.0)
        high = max(self.places, default=0.0)
        beyond = _REACH * (high - low)
        if len(self.places) < _KEPT or not low - beyond <= place <= high + beyond:
            return False
        try:
            best = self.near(plant)[1:]
            fewer = self.near(plant, leave=1)[1:]
        except np.linalg.LinAlgError:
            return False
        change = np.linalg.norm(best - fewer, axis=(1, 2))
        return bool(np.all(change <= _ENOUGH * np.linalg.norm(best, axis=(1, 2))))

    def near(self, plant: Plant, leave: int = 0) -> np.ndarray:
        """R (H + 1, m, m) by the rational form; exact solutions have to be there, `leave` of which are left out."""
        return self.with_static(plant, self._between(plant, leave, wide=False))

    def watched(self, plant: Plant) -> np.ndarray:
        """Watched displacements (H, p, m) of unit local forces by the rational form, h from 1 on."""
        return self._between(plant, 0, wide=True)[:, plant.m :, : plant.m]

    def _between(self, plant: Plant, leave: int, *, wide: bool) -> np.ndarray:
        """B^T V (Y^T Z V)^-1 Y^T B, h from 1 on; the projections are made anew where more than speed and load has changed."""
        key = (leave, wide)
        known = self._small.get(key)
        kept = ("K", "C", "M", "gyroscopic", "B")
        if known is None or any(getattr(known[0], name) is not getattr(plant, name) for name in kept):
            B = np.hstack([plant.B, plant.watched]) if wide else plant.B
            if key not in self._bases:
                s = B.shape[1]
                # Columns of one size, orthonormal: two values next to each other give nearly the same ones.
                V, Y = (
                    np.concatenate([pair[side][:, :, :s] for pair in self._pairs[leave:]], axis=2) for side in (0, 1)
                )
                self._bases[key] = (_orthonormal(V), _orthonormal(Y).transpose(0, 2, 1))
            V, left = self._bases[key]
            h, n, p = V.shape
            flat = V.transpose(1, 0, 2).reshape(n, h * p)

            def seen_by_both(A: sp.csc_array) -> np.ndarray:
                moved = (A.toarray() if _full(A) else A) @ flat
                return np.asarray(left @ moved.reshape(n, h, p).transpose(1, 0, 2))

            both = [*map(seen_by_both, (plant.K, plant.C, plant.M)), B.T @ V, left @ B]
            known = (plant, both, None if plant.gyroscopic is None else seen_by_both(plant.gyroscopic))
            self._small[key] = known
        _, (K, C, M, seen, pushed), G = known
        w = self.frequencies(plant)[:, None, None]
        inner = K + 1j * w * C - w**2 * M
        if G is not None:
            inner = inner + 1j * w * plant.speed * G
        return np.asarray(seen @ np.linalg.solve(inner, pushed))

    def with_static(self, plant: Plant, R: np.ndarray) -> np.ndarray:
        """R of h = 0 ... H from those from 1 on."""
        return np.concatenate([plant.static.R[None].astype(complex), R])


def _full(A: sp.csc_array) -> bool:
    return bool(A.nnz > _FULL * A.shape[0] * A.shape[1])


def _orthonormal(V: np.ndarray) -> np.ndarray:
    return np.linalg.qr(V / np.linalg.norm(V, axis=1, keepdims=True))[0]


_SINGULAR = (
    "a harmonic of the excitation meets an undamped resonance to the last digit: move the range, or give damping"
)
