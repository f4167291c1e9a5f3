"""Static answers of an elastic body whose mean motions are prescribed or sprung, by one factorisation of its own stiffness.

    K u + W λ = f,    Wᵀ u - C λ = g

W: weights of mean motions (prescribed where the flexibility C is 0, on springs of flexibility C else), λ: their forces. The
dense block W Wᵀ never meets the sparse K: with A = K⁻¹, u = A (f - W λ) and (Wᵀ A W + C) λ = Wᵀ A f - g.

A body that floats has rigid motions R; then A is the inverse with six of its dofs pinned, which answers exactly to forces in
balance, and u = A (f - W λ) + R α with Rᵀ (f - W λ) = 0: the flexibility method of structures that float (Farhat and Roux,
Int. J. Numer. Meth. Eng. 32, 1991).

The lowest modes under such constraints come by block Lanczos on these static answers.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp

from rotorgear.errors import AnalysisError
from rotorgear.progress import Progress, silent
from rotorgear.solvers.eigen.krylov import BlockKrylov
from rotorgear.solvers.sparse.large import factor_positive

Columns = Callable[[np.ndarray], np.ndarray]
# Residual of a mode over its eigenvalue; the error of the eigenvalue is its square.
_TOLERANCE = 1e-9
# Columns that are solved for at once: eight take a third of the time of eight single ones, twice as many hardly less.
_BLOCK = 8
# Modes are looked for in the basis each time that it has grown by this part of its size.
_GROWTH = 6
# No analysis can use more modes than this.
_MOST_MODES = 2000
# Modes beyond this share of the unknowns are modes of the elements, not of the body.
_MOST_SHARE = 0.25


class Modes:
    """The modes of K x = λ M x from the lowest on, as many as are asked for, by block Lanczos on static answers.

    Args:
        solve: static answers (n, k) to forces (n, k), that fulfil the constraints; symmetric.
        times_mass: M x for x (n, k).
        size: n.
    """

    def __init__(self, solve: Columns, times_mass: Columns, size: int) -> None:
        self._krylov = BlockKrylov(solve, size, _BLOCK, times_mass)

    def until(self, enough: Callable[[np.ndarray], bool]) -> tuple[np.ndarray, np.ndarray]:
        """Look for modes until those that were found are enough.

        Args:
            enough: called with λ (k,), rising, of the lowest modes.

        Returns:
            λ (k,) in (rad/s)^2, and shapes (n, k) of modal mass 1; all modes there are where they are not enough.
        """
        krylov = self._krylov
        while True:
            theta, Y, residuals = krylov.ritz(krylov.size)
            rough = np.flatnonzero(residuals > _TOLERANCE)
            found = len(theta) if krylov.exhausted or not len(rough) else int(rough[0])
            if krylov.exhausted or enough(1.0 / theta[:found]):
                return 1.0 / theta[:found], krylov.basis @ Y[:, :found]
            krylov.grow(krylov.size + max(_BLOCK, krylov.size // _GROWTH))


def lowest_modes(solve: Columns, times_mass: Columns, size: int, count: int) -> tuple[np.ndarray, np.ndarray]:
    """λ (count,) and shapes (n, count) of the lowest modes; arguments as of `Modes`."""
    values, shapes = Modes(solve, times_mass, size).until(lambda found: len(found) >= count)
    return values[:count], shapes[:, :count]


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
    highest = np.inf if limit is None else (2.0 * np.pi * limit) ** 2

    def enough(found: np.ndarray) -> bool:
        return len(found) > count if limit is None else len(found) > most or bool(np.any(found > highest))

    values, shapes = Modes(solve, times_mass, size).until(enough)
    frequency = np.sqrt(np.maximum(values, 0.0)) / (2.0 * np.pi)
    kept = count if limit is None else min(int(np.count_nonzero(frequency <= limit)), most)
    if limit is not None and kept == _MOST_MODES:
        raise AnalysisError(
            f"{name}.modes_to: more than {_MOST_MODES} modes lie below {limit:.6g} Hz, the last of these at "
            f"{frequency[kept - 1]:.4g} Hz; lower modes_to, or the frequencies that are asked for"
        )
    kept = min(kept, len(values) - 1)
    return values[:kept], shapes[:, :kept], float(frequency[kept])


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
