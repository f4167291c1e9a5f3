"""Harmonic response Z(w) q = f, Z = K + i w D - w^2 M (+ i w P diag(d) P^T): direct, or in a basis checked by its residual.

The reduced solution q = X y comes from X^T Z X y = X^T f. Its residual f - Z q is cheap at every frequency; where it is
largest the full problem is solved, which measures the true error there, and the solution joins the basis until that error is
below the tolerance. Greedy reduced basis: Hesthaven, Rozza and Stamm, Certified Reduced Basis Methods (Springer 2016), ch. 3.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp

from rotorgear.errors import ConvergenceError
from rotorgear.solvers.eigen.reduced_pencil import Pencil
from rotorgear.solvers.sparse.entries import magnitudes, times
from rotorgear.solvers.sparse.factor import Factor, factor_general

# Residuals relative to the forces inside: refined until below the first, refused above the second.
_RESIDUAL = 1e-14
_LARGEST_RESIDUAL = 1e-11
_REFINEMENTS = 24
# Relative distances of the frequency whose factors are used: farther only where nearer ones fail, since refinement gets slower.
_ASIDE = (0.0, 1e-8, 1e-6, 1e-4)
# What a new vector adds to a basis counts from this share of its length on.
_NEW = 1e-8


# Modes whose damping moves the response by less than this share near a frequency are left to the refinement, which converges
# about so fast then; it ends where a step gains less than the second.
_STRONG = 0.1
_GAINS = 0.7


class LowRank(NamedTuple):
    """Damping P diag(d) P^T of single modes, which is never assembled: P (n, m), d (m,), and their frequencies (m,) in rad/s."""

    P: np.ndarray
    d: np.ndarray
    w: np.ndarray


@dataclass(frozen=True)
class Dynamics:
    """M, D, K at one parameter, sparse (n, n); D and K may be non-symmetric.

    `factored` gives factors of K + i w D - w^2 M at a frequency in rad/s where somebody has them cheaper than from the matrices.
    """

    M: sp.csc_array
    D: sp.csc_array
    K: sp.csc_array
    low_rank: LowRank | None = None
    factored: Callable[[float], Factor] | None = None

    def cut(self, dofs: np.ndarray) -> Dynamics:
        """Those of some dofs (k,) on which no others act."""
        M, D, K = (sp.csc_array(A[dofs][:, dofs]) for A in (self.M, self.D, self.K))
        low_rank = None if self.low_rank is None else self.low_rank._replace(P=self.low_rank.P[dofs])
        return Dynamics(M, D, K, low_rank)

    def solve(self, w: float, f: np.ndarray) -> np.ndarray:
        """Solve at one frequency in rad/s: f (n, p) complex -> q (n, p).

        Raises:
            ConvergenceError: Z is singular: an undamped resonance to the last digit.
        """
        f = np.asarray(f, complex)
        if self.low_rank is None:
            return self._factor(w).solve(f)
        for aside in _ASIDE:
            q = self._refined(w, w * (1.0 + aside), f)
            if q is not None:
                return q
        raise ConvergenceError(
            f"the response at {w / (2.0 * np.pi):.9g} Hz, an undamped resonance to the last digit, keeps a residual: "
            "move the speed or frequency a little, or give more damping"
        )

    def _refined(self, w: float, near: float, f: np.ndarray) -> np.ndarray | None:
        """Solution by Woodbury's formula with the factors of a near frequency, refined; None where that does not get there.

        The formula divides by the undamped matrix, which is nearly singular at an undamped resonance; beside it, it is not.
        """
        assert self.low_rank is not None
        try:
            factor = self._factor(near)
        except ConvergenceError:
            return None
        _, d, own = self.low_rank
        strong = np.abs(near * d) >= _STRONG * np.abs(own**2 - near**2)
        if not strong.all():
            q = self._iterated(factor, w, near, f, strong)
            if q is not None:
                return q
        return self._iterated(factor, w, near, f, np.ones(len(d), bool))

    def _iterated(self, factor: Factor, w: float, near: float, f: np.ndarray, chosen: np.ndarray) -> np.ndarray | None:
        """Solution by Woodbury's formula for the damping of chosen modes (m,), refined for all; None where that fails."""
        assert self.low_rank is not None
        P = self.low_rank.P[:, chosen]
        d = (1j * near * self.low_rank.d[chosen])[:, None]
        spread = factor.solve(P.astype(complex))
        inner = np.eye(len(d)) + d * times(P.T, spread)
        q = np.zeros_like(f)
        rest = f
        residual = np.inf
        for _ in range(_REFINEMENTS):
            step = factor.solve(rest)
            q = q + step - spread @ np.linalg.solve(inner, d * times(P.T, step))
            rest = f - self.apply(w, q)
            before = residual
            residual = self._share(rest, w, f, q)
            if residual <= _RESIDUAL:
                return np.asarray(q)
            if residual > _GAINS * before:
                break
        return np.asarray(q) if residual <= _LARGEST_RESIDUAL else None

    def _factor(self, w: float) -> Factor:
        """Of K + i w D - w^2 M, without the damping of low rank."""
        if self.factored is not None:
            return self.factored(w)
        return factor_general(sp.csc_array(self.K + (1j * w) * self.D - w**2 * self.M, dtype=complex))

    def relative_residual(self, w: float | np.ndarray, f: np.ndarray, q: np.ndarray) -> float:
        """Largest residual of Z q = f over the columns, relative to the sizes of the forces inside."""
        return self._share(f - self.apply(w, q), w, f, q)

    def _share(self, rest: np.ndarray, w: float | np.ndarray, f: np.ndarray, q: np.ndarray) -> float:
        """Of a residual f - Z q, (n, p), as `relative_residual` has it."""
        K, M = self._magnitudes
        inside = K @ np.abs(q) + (M @ np.abs(q)) * np.asarray(w) ** 2
        scale = np.linalg.norm(inside, axis=0) + np.linalg.norm(f, axis=0)
        return float(np.max(np.linalg.norm(rest, axis=0) / np.where(scale > 0.0, scale, 1.0)))

    @cached_property
    def _magnitudes(self) -> tuple[sp.csc_array, sp.csc_array]:
        """|K| and |M|."""
        return magnitudes(self.K), magnitudes(self.M)

    def apply(self, w: float | np.ndarray, q: np.ndarray) -> np.ndarray:
        """Z q, (n, p), at one frequency or at one for each column."""
        out = times(self.K, q) + times(self.D, q) * (1j * w) - times(self.M, q) * (w**2)
        if self.low_rank is not None:
            P, d, _ = self.low_rank
            out = out + times(P, d[:, None] * times(P.T, q)) * (1j * w)
        return np.asarray(out)


@dataclass(frozen=True)
class DynamicsOverSpeed:
    """Dynamics that are linear in a parameter x: those at x = 0, and what D and K grow by with x, sparse (n, n)."""

    still: Dynamics
    D: sp.csc_array
    K: sp.csc_array

    def apply(self, x: np.ndarray, w: np.ndarray, q: np.ndarray) -> np.ndarray:
        """Z q, (n, p), at a parameter and a frequency in rad/s for each column, (p,) each."""
        out = self.still.apply(w, q) + times(self.D, q) * (1j * w * x)
        return out + times(self.K, q) * x if self.K.nnz else out

    def projected(self, X: np.ndarray) -> tuple[Pencil, Pencil]:
        """The projection at x = 0 in a real basis X (n, r), and what it grows by with x."""
        still = projected(self.still, X)
        return still, Pencil(np.zeros_like(still.M), X.T @ (self.D @ X), X.T @ (self.K @ X))


def projected(dynamics: Dynamics, X: np.ndarray) -> Pencil:
    """X^T M X, X^T D X and X^T K X in a real basis X (n, r)."""
    M, D, K = (X.T @ (part @ X) for part in (dynamics.M, dynamics.D, dynamics.K))
    if dynamics.low_rank is not None:
        P, d, _ = dynamics.low_rank
        seen = P.T @ X
        D = D + seen.T @ (d[:, None] * seen)
    return Pencil(M, D, K)


def stiffness_in_basis(pencil: Pencil, w: np.ndarray) -> np.ndarray:
    """Z (p, r, r) in a basis at p frequencies w (p,) in rad/s; of a pencil of stacks (p, r, r), each at its own."""
    at = w[:, None, None]
    Z = np.empty((len(w), *pencil.K.shape[-2:]), complex)
    # Part by part: a complex product of the whole stack costs as much as its solution.
    Z.real = pencil.K - at**2 * pencil.M
    Z.imag = at * pencil.D
    return Z


def orthonormal(X: np.ndarray, new: np.ndarray, scale: np.ndarray) -> np.ndarray:
    """X (n, r) and what `new` (n, p) adds to it, orthonormal after multiplication of the rows by `scale` (n,)."""
    rows = scale[:, None]
    columns = new * rows
    size = np.linalg.norm(columns, axis=0)
    columns = columns[:, size > 0.0] / size[size > 0.0]
    have = X * rows
    for _ in range(2):  # twice is enough
        columns = columns - have @ (have.T @ columns)
    q, r, _ = la.qr(columns, mode="economic", pivoting=True) if columns.size else (columns, np.zeros((0, 0)), None)
    kept = np.abs(np.diag(r)) > _NEW
    return np.hstack([X, q[:, : len(kept)][:, kept] / rows])
