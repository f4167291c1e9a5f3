"""Responses to the same forces at many frequencies: one by one, all at once where the system is small, or in a basis of few.

Responses over a range lie close to a space of few shapes, and solutions at some of its frequencies span it. Where the residual
in their basis is largest, between them, the whole system is solved: that tells the true error there, and the solution joins the
basis until the error is below the tolerance. See `harmonic`; rational Krylov spaces: Antoulas, Approximation of Large-Scale
Dynamical Systems (SIAM 2005), chapter 11.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from rotorgear.errors import ConvergenceError
from rotorgear.progress import Progress, silent
from rotorgear.solvers.frequency.harmonic import Dynamics, orthonormal, projected, stiffness_in_basis

# Largest error of a solution in a basis against the direct one, in the scaled norm.
TOLERANCE = 1e-7
# Up to here a dense solution of all is faster than a sparse one of each.
_DENSE = 60
# Fewer frequencies are solved one by one; a basis takes about half as many direct solutions.
_FEW = 80
# Solutions that a basis begins with, those that are added in a round where residuals and responses are largest, and rounds.
_FIRST = 8
_BY_RESIDUAL = 6
_BY_RESPONSE = 3
_ROUNDS = 30
# Frequencies that are looked at while the basis grows, and numbers in one block of solutions.
_LOOKED_AT = 150
_NUMBERS = 2_000_000


def largest_peaks(residuals: np.ndarray, most: int) -> list[tuple[int, int]]:
    """(place, column) where residuals (p, c) are larger than at the places beside them, the largest of these first."""
    padded = np.pad(residuals, ((1, 1), (0, 0)), constant_values=-1.0)
    peaks = np.argwhere((residuals >= padded[:-2]) & (residuals > padded[2:]))
    ranked = sorted(peaks.tolist(), key=lambda at: -residuals[at[0], at[1]])
    return [(place, column) for place, column in ranked[:most]]


class FrequencyRange:
    """Solutions of Z(w) q = f at rising w (p,) in rad/s for forces f (n, i).

    Args:
        dynamics: Z. w, f: frequencies and forces. progress: is told how far the basis is.
        solve: gives the direct solutions (n, i) at some frequencies that a basis is made of (default: those of `dynamics`).

    Attributes:
        method: in words.
        error: largest relative error against direct solutions, 0 where all are direct.
    """

    def __init__(
        self,
        dynamics: Dynamics,
        w: np.ndarray,
        f: np.ndarray,
        progress: Progress = silent,
        solve: Callable[[np.ndarray], Sequence[np.ndarray]] | None = None,
    ) -> None:
        self.method = "direct sparse LU at every frequency"
        self.error = 0.0
        self._dynamics = dynamics
        self._w = w
        self._f = f
        self._solve = solve or self._direct
        self._basis: np.ndarray | None = None
        self._proved: np.ndarray | None = None
        n = len(f)
        if n <= _DENSE:
            self._take(np.eye(n))
            self.method = "dense, direct at every frequency"
        elif len(w) > _FEW:
            self._grow(progress)

    def blocks(self) -> list[np.ndarray]:
        """Numbers (b,) of the frequencies whose solutions are looked at together, rising."""
        size = max(1, _NUMBERS // max(self._f.size, 1))
        return [np.arange(begin, min(begin + size, len(self._w))) for begin in range(0, len(self._w), size)]

    def solutions(self, at: np.ndarray) -> np.ndarray:
        """The solutions (b, n, i) at the frequencies of some numbers (b,).

        Raises:
            ConvergenceError: of `Dynamics.solve`.
        """
        if self._basis is None:
            return np.array(self._direct(self._w[at]))
        return self._basis @ (self._in_basis(at) if self._proved is None else self._proved[at])

    def _direct(self, w: np.ndarray) -> list[np.ndarray]:
        return [self._dynamics.solve(float(one), self._f) for one in w]

    def _take(self, basis: np.ndarray) -> None:
        self._basis = basis
        self._pencil = projected(self._dynamics, basis)
        self._load = basis.T @ self._f

    def _in_basis(self, at: np.ndarray) -> np.ndarray:
        """Coordinates (b, r, i) of the solutions at some of the frequencies."""
        together = max(1, _NUMBERS // len(self._load) ** 2)
        try:
            parts = [
                np.linalg.solve(stiffness_in_basis(self._pencil, self._w[at[k : k + together]]), self._load[None])
                for k in range(0, len(at), together)
            ]
        except np.linalg.LinAlgError:
            low, high = (self._w[k] / (2.0 * np.pi) for k in (at[0], at[-1]))
            raise ConvergenceError(
                f"the response between {low:.9g} and {high:.9g} Hz meets an undamped resonance to the last digit: move the "
                "frequencies a little, or give damping"
            ) from None
        return np.concatenate(parts)

    def _grow(self, progress: Progress) -> None:
        """Find the basis, or leave it where it is not proved with less work than direct solutions take."""
        D = self._dynamics
        w = self._w
        scale = np.sqrt(np.abs(D.K.diagonal()) + (0.1 * w[-1]) ** 2 * np.abs(D.M.diagonal()))
        scale[scale == 0.0] = scale[scale > 0.0].min(initial=1.0)
        few = np.unique(np.linspace(0, len(w) - 1, _LOOKED_AT).round().astype(int))
        first = np.unique(np.linspace(0, len(w) - 1, _FIRST).round().astype(int))
        solved = dict(zip(first.tolist(), self._solve(w[first]), strict=True))
        new = list(solved.values())
        basis = np.zeros((len(self._f), 0))
        looked_at = few
        checked = 0
        for number in range(_ROUNDS):
            progress(0.5 * number / _ROUNDS, f"basis of {basis.shape[1]} shapes")
            parts = np.hstack([part for q in new for part in (q.real, q.imag)])
            basis = orthonormal(basis, parts, scale)
            if basis.shape[1] > len(basis) // 2 or len(solved) > len(w) // 2:
                break
            self._take(basis)
            y = self._in_basis(looked_at)
            error, new, there = self._checked(looked_at, basis @ y, scale, solved)
            checked += there
            if error <= TOLERANCE:
                if len(looked_at) == len(w):
                    self.error = error
                    self._proved = y
                    self.method = (
                        f"in a basis of {basis.shape[1]} shapes from {len(solved)} direct solutions, "
                        f"proved by {there} of them where its residual is largest"
                    )
                    return
                looked_at = np.arange(len(w))
        self._basis = None

    def _checked(
        self, at: np.ndarray, q: np.ndarray, scale: np.ndarray, solved: dict[int, np.ndarray]
    ) -> tuple[float, list[np.ndarray], int]:
        """Largest error of solutions q (b, n, i) where it may be largest, what was solved there, and at how many places."""
        columns = self._f.shape[1]
        flat = q.transpose(1, 0, 2).reshape(len(scale), -1)
        rest = np.tile(self._f, len(at)) - self._dynamics.apply(np.repeat(self._w[at], columns), flat)
        shape = (len(at), columns)
        forced = np.linalg.norm(self._f / scale[:, None], axis=0)
        residuals = np.linalg.norm(rest / scale[:, None], axis=0).reshape(shape) / np.where(forced > 0.0, forced, 1.0)
        # Where the response is large, a small residual may be a large error.
        responses = np.linalg.norm(scale[:, None] * flat, axis=0).reshape(shape)
        known = np.isin(at, list(solved))
        residuals[known] = responses[known] = 0.0
        worst = largest_peaks(residuals, _BY_RESIDUAL) + largest_peaks(responses, _BY_RESPONSE)
        places = list(dict.fromkeys(place for place, _ in worst))
        error = 0.0
        new = []
        for place, exact in zip(places, self._solve(self._w[at[places]]), strict=True):
            solved[int(at[place])] = exact
            length = np.linalg.norm(scale[:, None] * exact, axis=0)
            off = np.linalg.norm(scale[:, None] * (exact - q[place]), axis=0)
            error = max(error, float(np.max(off / np.where(length > 0.0, length, 1.0), initial=0.0)))
            new.append(exact)
        return error, new, len(places)
