"""Harmonic response Z(w) q = f, Z = K + i w D - w^2 M (+ i w P diag(d) P^T): direct, or in a basis checked by its residual.

The reduced solution q = X y comes from X^T Z X y = X^T f. Its residual f - Z q is cheap at every frequency; where it is
largest the full problem is solved, which measures the true error there, and the solution joins the basis until that error is
below the tolerance. Greedy reduced basis: Hesthaven, Rozza and Stamm, Certified Reduced Basis Methods (Springer 2016), ch. 3.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp

from rotorgear.errors import ConvergenceError
from rotorgear.solvers.eigen.reduced_pencil import Pencil
from rotorgear.solvers.sparse.factor import factor_general

# Residuals relative to the forces inside: refined until below the first, refused above the second.
_RESIDUAL = 1e-14
_LARGEST_RESIDUAL = 1e-11
_REFINEMENTS = 6
# Relative distances of the frequency whose factors are used: farther only where nearer ones fail, since refinement gets slower.
_ASIDE = (0.0, 1e-8, 1e-6, 1e-4)
# What a new vector adds to a basis counts from this share of its length on.
_NEW = 1e-8


# P (n, m) and d (m,) of the damping P diag(d) P^T of single modes, which is never assembled.
LowRank = tuple[np.ndarray, np.ndarray]


@dataclass(frozen=True)
class Dynamics:
    """M, D, K at one parameter, sparse (n, n); D and K may be non-symmetric."""

    M: sp.csc_array
    D: sp.csc_array
    K: sp.csc_array
    low_rank: LowRank | None = None

    def cut(self, dofs: np.ndarray) -> Dynamics:
        """Those of some dofs (k,) on which no others act."""
        M, D, K = (sp.csc_array(A[dofs][:, dofs]) for A in (self.M, self.D, self.K))
        low_rank = None if self.low_rank is None else (self.low_rank[0][dofs], self.low_rank[1])
        return Dynamics(M, D, K, low_rank)

    def solve(self, w: float, f: np.ndarray) -> np.ndarray:
        """Solve at one frequency in rad/s: f (n, p) complex -> q (n, p).

        Raises:
            ConvergenceError: Z is singular: an undamped resonance to the last digit.
        """
        f = np.asarray(f, complex)
        if self.low_rank is None:
            return factor_general(self._stiffness(w)).solve(f)
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
            factor = factor_general(self._stiffness(near))
        except ConvergenceError:
            return None
        P, d = self.low_rank
        d = 1j * near * d
        spread = factor.solve(P.astype(complex))
        inner = la.lu_factor(np.eye(len(d)) + d[:, None] * (P.T @ spread))
        q = np.zeros_like(f)
        for _ in range(_REFINEMENTS):
            step = factor.solve(f - self.apply(w, q))
            q = q + step - spread @ la.lu_solve(inner, d[:, None] * (P.T @ step))
            residual = self.relative_residual(w, f, q)
            if residual <= _RESIDUAL:
                return np.asarray(q)
        return np.asarray(q) if residual <= _LARGEST_RESIDUAL else None

    def _stiffness(self, w: float) -> sp.csc_array:
        """K + i w D - w^2 M, without the damping of low rank."""
        return sp.csc_array(self.K + (1j * w) * self.D - w**2 * self.M, dtype=complex)

    def relative_residual(self, w: float | np.ndarray, f: np.ndarray, q: np.ndarray) -> float:
        """Largest residual of Z q = f over the columns, relative to the sizes of the forces inside."""
        rest = f - self.apply(w, q)
        inside = abs(self.K) @ np.abs(q) + (abs(self.M) @ np.abs(q)) * np.asarray(w) ** 2
        scale = np.linalg.norm(inside, axis=0) + np.linalg.norm(f, axis=0)
        return float(np.max(np.linalg.norm(rest, axis=0) / np.where(scale > 0.0, scale, 1.0)))

    def apply(self, w: float | np.ndarray, q: np.ndarray) -> np.ndarray:
        """Z q, (n, p), at one frequency or at one for each column."""
        out = self.K @ q + (self.D @ q) * (1j * w) - (self.M @ q) * (w**2)
        if self.low_rank is not None:
            P, d = self.low_rank
            out = out + (P @ (d[:, None] * (P.T @ q))) * (1j * w)
        return np.asarray(out)


def projected(dynamics: Dynamics, X: np.ndarray) -> Pencil:
    """X^T M X, X^T D X and X^T K X in a real basis X (n, r)."""
    M, D, K = (X.T @ (part @ X) for part in (dynamics.M, dynamics.D, dynamics.K))
    if dynamics.low_rank is not None:
        P, d = dynamics.low_rank
        seen = P.T @ X
        D = D + seen.T @ (d[:, None] * seen)
    return Pencil(M, D, K)


def stiffness_in_basis(pencil: Pencil, w: np.ndarray) -> np.ndarray:
    """Z (p, r, r) in a basis at p frequencies w (p,) in rad/s."""
    return np.asarray(pencil.K[None] + 1j * w[:, None, None] * pencil.D[None] - (w**2)[:, None, None] * pencil.M[None])


def response_in_basis(pencil: Pencil, w: np.ndarray, f: np.ndarray) -> np.ndarray:
    """Coordinates y (r, p) at p frequencies w (p,) in rad/s, each with its own projected right side f (r, p)."""
    return np.asarray(np.linalg.solve(stiffness_in_basis(pencil, w), f.T[:, :, None])[:, :, 0].T)


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
