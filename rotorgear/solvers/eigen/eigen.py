"""Undamped modes K v = lambda M v, lowest first, by shift and invert: (K - sigma M)^-1 M v = v / (lambda - sigma).

Block Lanczos on one sparse factor, or LAPACK's `eigh(M, K - sigma M)` when n is small or most modes are wanted.
With strain factors S (K = S^T S) a Ritz step on S V replaces the eigenvalues by strain-energy Rayleigh quotients, which
do not suffer from the rounding of the assembled K. A Sturm count from the pivot signs proves that no mode is missing.
Ericsson and Ruhe, Math. Comp. 35 (1980) 1251; Parlett, The Symmetric Eigenvalue Problem, chapters 3 and 13.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from rotorgear.errors import ConvergenceError
from rotorgear.solvers.eigen.ritz import combine, count_rigid, orthonormalise, stiffness_ritz, strain_ritz
from rotorgear.solvers.eigen.shift_invert import (
    ShiftInvert,
    basis_vectors,
    dense_modes,
    lanczos_modes,
    shifted_operator,
    unstable,
)
from rotorgear.solvers.sparse.factor import SymmetricFactor, single_thread
from rotorgear.solvers.sparse.pencil import (
    EDGE,
    Strain,
    backward_errors,
    check_pencil,
    check_wanted,
    count_below,
    rounding_noise,
)

_DENSE_UP_TO = 250  # unknowns up to which LAPACK is as fast (validation/benchmarks/thresholds.py)
# It is slower already above 100 unknowns where 5 times the number of modes is less than that of unknowns.
_FEW = (100, 5)
_SPARE = 4  # Ritz pairs beyond the converged ones, among which a gap for the Sturm count is looked for
_GAP = 1e-3  # least relative gap in lambda in which a Sturm count is placed

_ATTEMPTS = 6  # each with three times the spare pairs of the one before
_UNSTABLE = 100.0  # multiple of the rounding of K below which a negative eigenvalue is no rounding
_ENDLESS = 1e100  # rad/s; no limit at all, and its square is still a number


@dataclass(frozen=True)
class UndampedModes:
    """The m lowest modes of K v = lambda M v.

    Attributes:
        eigenvalues: (m,) lambda = omega^2 in (rad/s)^2, ascending, never negative.
        vectors: (n, m), V^T M V = identity.
        rigid_count: how many of the first modes have no strain beyond rounding.
        backward_error: (m,) ||K v - lambda M v|| / ((||K||_1 + |lambda| ||M||_1) ||v||); NaN where the modes were not counted.
        available: number of finite modes of the pencil; `complete` says that all of them are here.
        sturm_shift: lambda at which modes were counted.
        sturm_count: modes below it by pivot signs.
        sturm_expected: modes below it that this solver has.
        method: "dense" or "block Lanczos".
        shift: sigma.
        noise: (m,) what rounding of the stored K does to Rayleigh quotients, in (rad/s)^2.
        factor: that of K - sigma M, where the modes were not counted: a basis of other modes goes on with it.
    """

    eigenvalues: np.ndarray
    vectors: np.ndarray
    rigid_count: int
    backward_error: np.ndarray
    available: int
    sturm_shift: float
    sturm_count: int
    sturm_expected: int
    method: str
    shift: float
    noise: np.ndarray
    factor: SymmetricFactor | None

    @property
    def rigid(self) -> np.ndarray:
        """(n, r) vectors of the modes without strain."""
        return self.vectors[:, : self.rigid_count]

    @property
    def elastic(self) -> np.ndarray:
        """(n, m - r) vectors of the other modes."""
        return self.vectors[:, self.rigid_count :]

    @property
    def frequencies(self) -> np.ndarray:
        """(m - r,) omega of the other modes in rad/s."""
        return np.sqrt(self.eigenvalues[self.rigid_count :])

    @property
    def sturm_count_ok(self) -> bool:
        """True when the independent count agrees: no mode below the last one is missing."""
        return self.sturm_count == self.sturm_expected

    @property
    def complete(self) -> bool:
        """True when these are all the finite modes there are."""
        return self.eigenvalues.size == self.available


def lowest_modes(
    M: sp.csc_array,
    K: sp.csc_array,
    *,
    count: int | None = None,
    below: float | None = None,
    strain: Strain | None = None,
    guess: float | None = None,
    counted: bool = True,
    rigid: int = 0,
) -> UndampedModes:
    """The lowest undamped modes of a symmetric positive semidefinite pair, rigid modes included.

    Args:
        M: (n, n) symmetric positive semidefinite; it may have massless dofs, whose infinite modes are left out.
        K: (n, n) symmetric positive semidefinite.
        count: number of modes; when fewer exist all are returned (`complete`). None with no `below`: all modes.
        below: only the modes with omega <= below [rad/s], and all of them (the lowest `count` when both are given).
        strain: S (p, n) with K = S^T S, or V (n, m) -> S V (p, m), each strain evaluated without forming K. It carries soft
            modes to full precision and tells rigid from soft; without it a mode softer than the rounding of K counts as rigid.
        guess: an eigenvalue [(rad/s)^2] near the first elastic one; saves the search for it, never changes the answer.
        counted: False leaves the Sturm count out, and of the upper modes a part of their accuracy: for a basis of other modes,
            which are corrected and counted themselves.
        rigid: how many of the lowest modes are known to be rigid, of a stiffness whose terms cancel in them.

    Raises:
        LooseDofError: a dof has neither inertia nor stiffness (`dofs`).
        AnalysisError: the matrices are not symmetric or K is not positive semidefinite.
        ConvergenceError: the Sturm count does not confirm the modes; `partial` holds them.
    """
    check_wanted(count, below)
    if below is not None and below > _ENDLESS:
        below = None
    M = sp.csc_array(M, dtype=float)
    K = sp.csc_array(K, dtype=float)
    with single_thread(K.shape[0]):
        massless = check_pencil(M, K)
        operator = shifted_operator(M, K, guess)

        # How many there are to find: all finite ones, or those that a first Sturm count sees just above the limit.
        target = K.shape[0] - massless.size
        if below is not None:
            # Counted a little beyond the edge, so that a mode on the limit is computed before it is judged.
            target = min(target, count_below(operator.M, operator.K, below**2 * (1.0 + 1e3 * EDGE)))
        if count is not None:
            target = min(count, target)

        # Compute and refine, then count below a gap above the last mode; with more pairs while there is no gap, or while the
        # count finds modes that are missing.
        limit = np.inf if below is None else below**2 * (1.0 + EDGE)
        spare = _SPARE if counted else 0
        modes = None
        for _ in range(_ATTEMPTS):
            V, sure, finite, method = _ritz_basis(operator, massless, target, spare)
            values, V, noise, free = _refined(operator, V, strain, rigid)
            keep = int(np.count_nonzero(values <= limit))
            if count is not None:
                keep = min(keep, count)
            gap: tuple[float, int] | None = None
            if keep <= sure:  # a shift of zero has nothing to count below it
                gap = _gap_above(values, noise, keep, finite) if counted else (0.0, 0)
            if gap is not None:
                sturm_shift, expected = gap
                errors = np.full(len(values), np.nan)
                sturm_count = expected
                if counted:
                    errors = backward_errors(operator.mass, operator.stiffness, values, V)
                    sturm_count = count_below(operator.M, operator.K, sturm_shift)
                modes = UndampedModes(
                    eigenvalues=values[:keep],
                    vectors=V[:, :keep],
                    rigid_count=min(free, keep),
                    backward_error=errors[:keep],
                    available=finite,
                    sturm_shift=sturm_shift,
                    sturm_count=sturm_count,
                    sturm_expected=expected,
                    method=method,
                    shift=operator.sigma,
                    noise=noise[:keep],
                    factor=None if counted else operator.factor,
                )
                if modes.sturm_count_ok:
                    return modes
                target = max(target, sturm_count)
            target = max(target, keep)
            spare = 3 * spare
    raise ConvergenceError(
        f"The {target} lowest modes are not told from those above: no Sturm count confirms a gap. Ask for more modes.",
        modes,
    )


def _ritz_basis(
    operator: ShiftInvert, massless: np.ndarray, target: int, spare: int
) -> tuple[np.ndarray, int, int, str]:
    """Ritz vectors (n, m) of the `target` lowest modes and up to `spare` more, among which a gap may be found.

    Returns:
        The vectors, how many of them are converged, how many finite modes exist, and the name of the method.
    """
    n = operator.K.shape[0]
    few = n > _FEW[0] and _FEW[1] * (target + spare) < n
    if (n <= _DENSE_UP_TO and not few) or 3 * (target + spare) > n:
        V = dense_modes(operator, massless, target + spare)
        return V[:, : target + 10 * spare], V.shape[1], V.shape[1], "dense"
    finite = n - massless.size
    if spare:
        # One more than the target must be converged: the gap lies below it.
        return lanczos_modes(operator, target + 1, spare), target + 1, finite, "block Lanczos"
    return basis_vectors(operator, max(target, 1)), target, finite, "block Lanczos"


def _refined(
    operator: ShiftInvert, V: np.ndarray, strain: Strain | None, known: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray, int]:
    """Ascending Rayleigh quotients (m,) of Ritz vectors V (n, m), which are overwritten, M-orthonormal vectors, and their noise.

    The last number says how many of them are rigid, `known` at least.
    """
    orthonormalise(operator.mass, V)
    if strain is None:
        values, V = stiffness_ritz(operator.K, V, operator.sigma)
    else:
        values, turn = strain_ritz(strain, V)
        combine(V, turn)
    noise = rounding_noise(operator.size_K, V, operator.sigma)
    if known < values.size and values[known] < -_UNSTABLE * noise[known]:
        raise unstable(float(values[known]))
    rigid = max(count_rigid(operator, values, V, noise, strain is not None), min(known, values.size))
    if strain is None:
        values[:rigid] = 0.0
    return values, V, noise, rigid


def _gap_above(values: np.ndarray, noise: np.ndarray, keep: int, finite: int) -> tuple[float, int] | None:
    """A shift in the widest relative gap above the modes to keep, and the number of modes below it; None: no gap."""
    # With all finite modes at hand any shift above the last one is in a gap.
    if values.size == finite:
        values = np.append(values, max(4.0 * values[-1], 1e3 * noise.max()))
        noise = np.append(noise, 0.0)
    under = np.concatenate([np.zeros(1), values[:-1]])
    # Below a hundred times the rounding of K values are as good as equal: no shift between them can be trusted.
    gaps = np.where(values > 1e2 * noise, (values - under) / np.maximum(values, np.finfo(float).tiny), 0.0)
    gaps = gaps[keep:] if keep else gaps[:1]
    if gaps.size == 0 or gaps.max() < _GAP:
        return None
    best = keep + int(np.argmax(gaps))
    return float(0.5 * (values[best] + under[best])), best
