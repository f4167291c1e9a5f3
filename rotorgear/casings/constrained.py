"""Static answers of an elastic body whose mean motions are prescribed or sprung, by one factorisation of its own stiffness.

    K u + W λ = f,    Wᵀ u - C λ = g

W: weights of mean motions (prescribed where the flexibility C is 0, on springs of flexibility C else), λ: their forces. The
dense block W Wᵀ never meets the sparse K: with A = K⁻¹, u = A (f - W λ) and (Wᵀ A W + C) λ = Wᵀ A f - g.

A body that floats has rigid motions R; then A is the inverse with six of its dofs pinned, which answers exactly to forces in
balance, and u = A (f - W λ) + R α with Rᵀ (f - W λ) = 0: the flexibility method of structures that float (Farhat and Roux,
Int. J. Numer. Meth. Eng. 32, 1991).

The lowest modes under such constraints come by Lanczos on these static answers (ARPACK, Lehoucq et al. 1998).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp
from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigsh

from rotorgear.errors import AnalysisError, ConvergenceError
from rotorgear.progress import Progress, silent
from rotorgear.solvers.sparse.large import factor_positive

Columns = Callable[[np.ndarray], np.ndarray]
_TOLERANCE = 1e-10
# No analysis can use more modes than this.
_MOST_MODES = 2000
# Modes beyond this share of the unknowns are modes of the elements, not of the body.
_MOST_SHARE = 0.25


def lowest_modes(solve: Columns, times_mass: Columns, size: int, count: int) -> tuple[np.ndarray, np.ndarray]:
    """The lowest modes of K x = λ M x.

    Args:
        solve: static answers (n, k) to forces (n, k), that fulfil the constraints; symmetric.
        times_mass: M x.
        size: n.
        count: of modes.

    Returns:
        λ (count,) rising, in (rad/s)^2, and shapes (n, count) of modal mass 1.

    Raises:
        ConvergenceError: the iteration did not end.
    """

    def column(function: Columns) -> LinearOperator:
        return LinearOperator((size, size), matvec=lambda x: function(x.reshape(-1, 1))[:, 0], dtype=float)

    # A start in the space of the constraints, the same each time.
    start = solve(times_mass(np.random.default_rng(3).standard_normal((size, 1))))[:, 0]
    try:
        values, shapes = eigsh(
            column(times_mass),  # not used with sigma = 0 but for its size
            k=count,
            M=column(times_mass),
            sigma=0.0,
            OPinv=column(solve),
            v0=start,
            tol=_TOLERANCE,
        )
    except ArpackNoConvergence as error:
        raise ConvergenceError(f"{len(error.eigenvalues)} of {count} modes of the casing converged.") from None
    order = np.argsort(values)
    return values[order], shapes[:, order]


def modes_up_to(
    solve: Columns, times_mass: Columns, size: int, limit: float | None, usual: int, name: str
) -> tuple[np.ndarray, np.ndarray, float]:
    """Modes below a frequency limit in Hz, or the usual number of them; and the frequency in Hz of the first that is left.

    No more than a quarter of the unknowns: those above are modes of the elements.

    Raises:
        AnalysisError: thousands of modes lie below the limit; `name` is that of the body.
    """
    count = min(usual, max(size - 3, 1))
    most = max(count, min(_MOST_MODES, int(_MOST_SHARE * size)))
    while True:
        values, shapes = lowest_modes(solve, times_mass, size, min(count + 1, size - 2))
        frequency = np.sqrt(np.maximum(values, 0.0)) / (2.0 * np.pi)
        if limit is None:
            return values[:count], shapes[:, :count], float(frequency[-1])
        if frequency[-1] <= limit and count == _MOST_MODES:
            raise AnalysisError(
                f"{name}.modes_to: more than {_MOST_MODES} modes lie below {limit:.6g} Hz, the last of these at "
                f"{frequency[-1]:.4g} Hz; lower modes_to, or the frequencies that are asked for"
            )
        if frequency[-1] > limit or count == most:
            kept = min(int(np.count_nonzero(frequency <= limit)), len(frequency) - 1)
            return values[:kept], shapes[:, :kept], float(frequency[kept])
        # By Weyl's law the number of modes of a solid grows with the cube of the frequency, of a plate linearly.
        count = min(int(count * np.clip((limit / frequency[-1]) ** 1.5 * 1.2, 1.3, 4.0)), most)


class ElasticBody:
    """A factored stiffness; `rigid` (n, 6) are the motions that it does not resist, pinned for the factorisation; or none."""

    def __init__(self, K: Any, rigid: np.ndarray, what: str, progress: Progress = silent) -> None:
        self.rigid = rigid
        self._pins = np.zeros(0, dtype=int)
        if rigid.shape[1]:
            # Six dofs that hold the body best: the pivots of its rigid motions.
            self._pins = la.qr((rigid / np.linalg.norm(rigid, axis=0)).T, mode="r", pivoting=True)[1][: rigid.shape[1]]
            # K with some dofs held: their rows and columns are those of the unit matrix, scaled like K.
            K = sp.csr_array(K, copy=True)
            keep = np.ones(K.shape[0])
            keep[self._pins] = 0.0
            rows = np.repeat(np.arange(K.shape[0]), np.diff(K.indptr))
            K.data *= keep[rows] * keep[K.indices]
            diagonal = K.diagonal()
            diagonal[self._pins] = diagonal.max()
            K.setdiag(diagonal)
        self._solve = factor_positive(K, 3, what, progress)

    def flexibility(self, forces: np.ndarray) -> np.ndarray:
        """A f for f (n, k): exact for forces in balance, if the body floats."""
        if len(self._pins):
            forces = forces.copy()
            forces[self._pins] = 0.0
        return self._solve(forces)


class Constrained:
    """The static answer of a body under mean motions W with flexibilities C."""

    def __init__(self, body: ElasticBody, weights: np.ndarray, flexibility: np.ndarray | None = None) -> None:
        """Take a body, W (n, c), and C (c,), zero where motions are prescribed (default: all)."""
        self.body = body
        self.weights = weights
        count = weights.shape[1]
        self.moved = body.flexibility(weights) if count else weights  # A W
        held = np.zeros(count) if flexibility is None else flexibility
        F = weights.T @ self.moved + np.diag(held)
        G = weights.T @ body.rigid
        rigid = body.rigid.shape[1]
        self._small = np.block([[0.5 * (F + F.T), -G], [-G.T, np.zeros((rigid, rigid))]])
        # Displacements, rotations and motions of the body have sizes far apart: rows and columns are scaled.
        scale = np.sqrt(np.maximum(np.abs(np.diag(self._small)), 0.0))
        if count:
            scale[count:] = np.linalg.norm(G / scale[:count, None], axis=0)
        scale[scale == 0.0] = 1.0
        self._scale = scale
        self._lu = la.lu_factor(self._small / np.outer(scale, scale)) if len(scale) else None

    def solve(self, forces: np.ndarray | None = None, motions: np.ndarray | None = None) -> np.ndarray:
        """u (n, k) for forces f (n, k) and motions g (c, k); one of them may be left out."""
        count = self.weights.shape[1]
        free = 0.0 if forces is None else self.body.flexibility(forces)
        columns = (forces if forces is not None else motions).shape[1]  # type: ignore[union-attr]
        if self._lu is None:
            return np.asarray(free)
        right = np.zeros((len(self._scale), columns))
        if forces is not None:
            right[:count] = self.weights.T @ free
            right[count:] = -self.body.rigid.T @ forces
        if motions is not None:
            right[:count] -= motions
        found = la.lu_solve(self._lu, right / self._scale[:, None]) / self._scale[:, None]
        return np.asarray(free - self.moved @ found[:count] + self.body.rigid @ found[count:])
