"""Damped modes (lambda^2 M + lambda D + K) v = 0, smallest |lambda| first; D holds damping and gyroscopic terms.

The eigenvalues come from `quadratic_search`; here they are cut to what was asked for, checked and scaled back.
Tisseur and Meerbergen, SIAM Review 43 (2001) 235.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from rotorgear.errors import AnalysisError
from rotorgear.solvers.eigen.quadratic_search import prepared, solve
from rotorgear.solvers.sparse.factor import single_thread
from rotorgear.solvers.sparse.pencil import EPS

_EDGE = 1e-9  # a mode this close above the limit `below` counts as on it


@dataclass(frozen=True)
class DampedModes:
    """Eigenvalues of lambda^2 M + lambda D + K, one per conjugate pair, in ascending |lambda|, rigid ones first.

    Attributes:
        eigenvalues: (m,) complex, Im >= 0, in rad/s; real ones (overdamped or divergent) stand singly; Re > 0 is unstable.
        vectors: (n, m) complex, the largest component is 1.
        rigid: (m,) True for the zero eigenvalue of each rigid vector. A drift partner is not listed.
        backward_error: (m,) ||Q v|| / ((|lambda|^2 ||M|| + |lambda| ||D|| + ||K||) ||v||), scaled to unit diagonals.
        zero_count: how many of the 2n eigenvalues are exactly zero, drift partners included.
        complete: True when these are all the finite eigenvalues there are.
        method: "dense" or "block Arnoldi".
        shift: sigma in rad/s.
        factorisations: how many matrices were factored.
    """

    eigenvalues: np.ndarray
    vectors: np.ndarray
    rigid: np.ndarray
    backward_error: np.ndarray
    zero_count: int
    complete: bool
    method: str
    shift: float
    factorisations: int


def damped_modes(
    M: sp.csc_array,
    D: sp.csc_array,
    K: sp.csc_array,
    *,
    count: int | None = None,
    below: float | None = None,
    rigid_vectors: np.ndarray | None = None,
    frequency_scale: float | None = None,
    dense: bool = False,
) -> DampedModes:
    """The damped modes of smallest |lambda|.

    Args:
        M: (n, n) real.
        D: (n, n) real: damping matrix and gyroscopic terms.
        K: (n, n) real; it may be non-symmetric (circulatory).
        count: number of rows to return: rigid-body motions, real eigenvalues and conjugate pairs each count once.
        below: only |lambda| <= below [rad/s], and all of them (the first `count` when both are given). Neither: all modes.
        rigid_vectors: (n, r) basis of the null space of K; None means that K is regular.
        frequency_scale: a frequency near the lowest ones [rad/s]; saves the search for it, never changes the answer.
        dense: all eigenvalues by LAPACK, whatever n is: for spectra over very many decades.

    Raises:
        AnalysisError: K has a rigid-body motion that was not given, or a given one is strained or without inertia.
        ConvergenceError: the iteration did not settle; `partial` holds what was found.
    """
    if count is not None and count < 1:
        raise AnalysisError(f"The number of modes must be at least 1, got {count}.")
    if below is not None and not below > 0.0:
        raise AnalysisError(f"The highest frequency wanted must be positive, got {below} rad/s.")
    M, D, K = (sp.csc_array(A, dtype=float) for A in (M, D, K))
    for name, A in (("M", M), ("D", D), ("K", K)):
        if not np.all(np.isfinite(A.data)):
            raise AnalysisError(f"{name} holds entries that are not finite; check the input for NaN.")
    R = np.zeros((K.shape[0], 0)) if rigid_vectors is None else np.asarray(rigid_vectors, dtype=float)
    with single_thread(K.shape[0]):
        search = prepared(M, D, K, R, frequency_scale)
        rows = None if count is None else max(count - R.shape[1], 0)
        pairs = solve(search, rows, below, dense)

        # Rigid motions come first; the search has left them out. All is scaled here to unit diagonals.
        quadratic = search.inverse.quadratic
        limit = np.inf if below is None else below * (1.0 + _EDGE) / quadratic.w0
        inside = np.count_nonzero(np.abs(pairs.values) <= min(limit, pairs.reach))
        shown = slice(0, inside if rows is None else min(inside, rows))
        rigid = R / quadratic.scale[:, None]
        listed = rigid[:, :count]
        values = np.concatenate([np.zeros(listed.shape[1]), pairs.values[shown]])
        V = np.hstack([listed, pairs.vectors[:, shown]])
        errors = quadratic.residuals(values, V)

        # A vector outside the given rigid-body motions that K strains by rounding only: its eigenvalue would be noise.
        elastic = pairs.vectors[:, shown]
        force = np.abs(quadratic.K @ elastic)
        rounding = 32.0 * EPS * (abs(quadratic.K) @ np.abs(elastic))
        Q = np.linalg.qr(rigid)[0]
        outside = np.linalg.norm(elastic - Q @ (Q.T @ elastic), axis=0) > 1e-6 * np.linalg.norm(elastic, axis=0)
        if np.any(np.all(force <= rounding, axis=0) & outside):
            raise AnalysisError(
                "The stiffness has a rigid-body motion (to its rounding) that was not given: "
                "pass the rigid modes of the undamped system."
            )

        V = V * quadratic.scale[:, None]
        largest = np.argmax(np.abs(V), axis=0)
        return DampedModes(
            eigenvalues=values * quadratic.w0,
            vectors=V / V[largest, np.arange(largest.size)],
            rigid=np.arange(values.size) < listed.shape[1],
            backward_error=errors,
            zero_count=search.inverse.zeros.shape[1],
            complete=bool(np.isinf(pairs.reach)) and values.size == R.shape[1] + pairs.values.size,
            method=pairs.method,
            shift=search.inverse.sigma * quadratic.w0,
            factorisations=search.factorisations,
        )
