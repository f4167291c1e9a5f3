"""Damped modes (lambda^2 M + lambda D + K) v = 0, smallest |lambda| first; D holds damping and gyroscopic terms.

Block Arnoldi on the inverse of the quadratic pencil at a small positive real shift sigma, where K + sigma D + sigma^2 M
of a passive structure is always regular. Eigenvalues are found in the order of |lambda - sigma| up to some R, hence all with
|lambda| <= R - sigma. When n is small LAPACK's `eig` takes the same inverse.
Tisseur and Meerbergen, SIAM Review 43 (2001) 235, sections 5 and 6.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from rotorgear.errors import AnalysisError, ConvergenceError
from rotorgear.solvers.eigen.quadratic import (
    InverseState,
    corrected,
    first_guess,
    infinite_states,
    newton,
    scaled,
)
from rotorgear.solvers.sparse.factor import single_thread
from rotorgear.solvers.sparse.pencil import EDGE, EPS, check_finite, check_wanted

_DENSE_UP_TO = 40  # dofs up to which LAPACK is as fast (validation/benchmarks/thresholds.py)
_BLOCK = 4
_CONVERGED = 1e-12  # residual of T x = mu x relative to mu
_EQUAL = 1e-6  # relative distance of Ritz values that may be copies: one too many costs time, one too few a mode
_SOUND = 1e-9  # backward error, and distance of two pairs, above and below which a Krylov result is not taken
_TOO_BLURRED = 1e-8  # rounding of the smallest mu from which the upper spectrum is taken from the companion matrix
_LARGEST_DENSE = 6000  # states: 0.6 GB a complex matrix
_GATHERED_DENSE = 2000  # states: a minute, where a Krylov space does not tell eigenvalues apart
_SPARE = 8  # pairs beyond those that matter which are refined too, since refinement may change their order
_BEYOND = 1.04  # eigenvalues that are asked for over those that are expected
_SHIFT = 0.3  # sigma / w0, w0 being near the lowest |lambda|
_BLUR = 1e-13  # relative error of 1/mu from rounding above which an eigenpair is refined on the pencil itself
_TWINS = 1.0  # imaginary part over rounding up to which a pair is two real roots
_ONE_DIRECTION = 1e-6  # length of a vector's imaginary part, over the whole, below which it is no direction of its own
_BLUR_LARGE = 1e-12  # the same for a large pencil, where a refinement costs more


# Scaled eigenvalues (k,) with Im >= 0, vectors (n, k), and the reach up to which all |lambda| are among them.
Pairs = tuple[np.ndarray, np.ndarray, float]


def prepared(
    M: sp.csc_array, D: sp.csc_array, K: sp.csc_array, R: np.ndarray, frequency_scale: float | None
) -> InverseState:
    """Choose w0 near the lowest frequencies: probe, and move there while the guess is more than a decade away.

    Where they lie is the geometric mean of the lowest few |lambda|.
    """
    w0 = first_guess(M, D, K) if frequency_scale is None else frequency_scale
    best = None
    off = np.inf
    for _ in range(11):
        quadratic = scaled(M, D, K, w0)
        inverse = InverseState(quadratic, _SHIFT, R / quadratic.scale[:, None], _BLOCK)

        # Three blocks see the eigenvalues nearest to the shift; nothing but zero ones leaves nothing to move to.
        for _ in range(3):
            if not inverse.krylov.exhausted:
                inverse.krylov.expand()
        if inverse.krylov.size == 0:
            return inverse
        mu, _, residuals = inverse.ritz()
        converging = mu[residuals < 0.3][: 2 * _BLOCK]
        near = np.abs(inverse.sigma + 1.0 / (converging if converging.size else mu[:1]))
        lowest = float(np.exp(np.mean(np.log(np.maximum(near, np.finfo(float).tiny)))))
        if 0.1 <= lowest <= 10.0:
            return inverse
        if abs(np.log(lowest)) < off:
            best = inverse
            off = abs(np.log(lowest))
        w0 *= lowest
    if best is None:
        raise ConvergenceError("No lowest frequency found: inertia, damping, stiffness are too many decades apart.")
    return best  # a spectrum without a place near which its lowest eigenvalues gather: any scale will do


def solve(
    inverse: InverseState, rows: int | None, below: float | None, dense: bool = False, expected: int | None = None
) -> Pairs:
    """At least `rows` pairs, and all up to `below`: more and more of the spectrum until the reach suffices.

    `expected`: how many pairs may be below, to begin with.
    """
    quadratic = inverse.quadratic
    limit = np.inf if below is None else below / quadratic.w0
    wanted = 2 * rows + 4 if rows is not None else max(40, int(_BEYOND * 2 * (expected or 0)) + 4)
    iterates = not dense and quadratic.n > _DENSE_UP_TO and not (rows is None and below is None)
    while iterates and wanted < quadratic.n // 2:
        try:
            values, vectors, reach = _arnoldi(inverse, wanted)
        except ConvergenceError:
            # Those of damping in proportion to the stiffness gather at one place without end.
            if 2 * quadratic.n > _GATHERED_DENSE:
                raise
            break
        inside = int(np.count_nonzero(np.abs(values) <= reach))
        if (rows is not None and inside >= rows) or reach >= limit:
            shown = slice(0, inside if rows is None else rows)
            # Pairs that rounding in the Krylov basis has blurred too much are refined on the pencil itself.
            errors = quadratic.residuals(values[shown], vectors[:, shown])
            for i in np.flatnonzero(errors > _SOUND):
                values[i], vectors[:, i] = newton(quadratic, values[i], vectors[:, i])
            # All pairs must satisfy the pencil, and none may be there twice: a wide spectrum may blur a Krylov basis too much.
            z = values[shown]
            V = vectors[:, shown] / np.linalg.norm(vectors[:, shown], axis=0)
            close = np.abs(z[:, None] - z) <= _SOUND * np.abs(z)
            close &= np.abs(V.conj().T @ V) > 1.0 - _SOUND
            if np.all(quadratic.residuals(z, V) <= _SOUND) and np.count_nonzero(close) == z.size:
                return values, vectors, reach
            break
        wanted += max(8, wanted // 4)

    # LAPACK's `eig` of the inverse gives all finite eigenvalues, of which the first `rows` matter.
    size = 2 * quadratic.n
    if size > _LARGEST_DENSE:
        raise ConvergenceError(
            f"All eigenvalues of {size} states were needed: the spectrum is too wide, or too much is asked for; ask for less."
        )
    known = np.hstack([inverse.zeros, infinite_states(quadratic)])
    rest = np.linalg.qr(known, mode="complete")[0][:, known.shape[1] :] if known.shape[1] else np.eye(size)
    # Off the states of zero and of infinite eigenvalues: these would spoil the others by their defective pairs.
    T = rest.T @ inverse.apply(rest)
    mu, X = np.linalg.eig(T)
    finite = np.abs(mu) > size * EPS**2 * np.abs(mu).max(initial=0.0)
    mu = mu[finite]
    X = rest @ X[:, finite]
    norm = float(np.linalg.norm(T, 1)) if T.size else 0.0
    # Rounding goes with the largest mu, hence with the lowest eigenvalues; where it swamps the highest ones they are taken from
    # the companion matrix itself, whose rounding goes with them. The two are equally good at the geometric mean.
    if mu.size and EPS * norm > _TOO_BLURRED * np.abs(mu).min():
        mu, X = _with_direct(inverse, mu, X)
    return _selected(inverse, mu, X, known, norm, reach=np.inf, rows=rows)


def _arnoldi(inverse: InverseState, wanted: int) -> Pairs:
    """The `wanted` eigenvalues nearest to the shift, each with all its copies.

    A block of width b holds at most b copies of a repeated eigenvalue: where that many are found there may be more, and
    fresh directions are added until fewer copies than directions are found.
    """
    krylov = inverse.krylov
    mu, Y = _converged(inverse, wanted)
    while not krylov.exhausted:
        shown = mu[:wanted]
        equal = np.abs(shown[:, None] - shown) <= _EQUAL * np.abs(shown)
        if int(equal.sum(axis=0).max(initial=0)) < krylov.width:
            break
        krylov.widen(krylov.width)
        for _ in range(3):
            krylov.expand()
        mu, Y = _converged(inverse, wanted)
    last = np.abs(mu[min(wanted, mu.size) - 1])
    size = float(np.linalg.norm(krylov.projection, 1))
    Y = Y[:, :wanted]
    X = krylov.polished(np.hstack([Y.real, Y.imag]))
    X = inverse.unbalanced(X[:, : Y.shape[1]] + 1j * X[:, Y.shape[1] :])
    return _selected(inverse, mu[:wanted], X, inverse.zeros, size, reach=float(1.0 / last))


def _converged(inverse: InverseState, wanted: int) -> tuple[np.ndarray, np.ndarray]:
    """Expand until the first `wanted` Ritz values have converged: all mu (m,) and coordinates (m, m)."""
    krylov = inverse.krylov
    goal = int(3.25 * wanted)
    while True:
        krylov.grow(goal)
        mu, Y, residuals = inverse.ritz()
        if krylov.exhausted:
            return mu, Y
        worst = residuals[:wanted].max() if mu.size >= wanted else 1.0
        if worst < _CONVERGED:
            return mu, Y
        if krylov.size > 10 * wanted + 200:
            raise ConvergenceError(f"The {wanted} eigenvalues nearest to zero did not converge.", mu)
        # Residuals fall geometrically from about 1 at size = wanted: go to where the line meets the tolerance
        slope = np.log(min(worst, 0.1)) / max(krylov.size - wanted, 1)
        goal = krylov.size + int(np.clip(np.log(_CONVERGED / worst) / slope, 1, wanted))


def _with_direct(inverse: InverseState, mu: np.ndarray, X: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The pairs of the inverse with the upper part of the spectrum from the companion matrix, where M is regular."""
    quadratic = inverse.quadratic
    n = quadratic.n
    M = quadratic.M.toarray()
    if np.any(M.diagonal() <= 0.0) or np.linalg.cond(M) > 1e12:
        return mu, X
    A = np.zeros((2 * n, 2 * n))
    A[:n, n:] = np.eye(n)
    A[n:] = -np.linalg.solve(M, np.hstack([quadratic.K.toarray(), quadratic.D.toarray()]))
    direct, Y = np.linalg.eig(A)
    order = np.argsort(np.abs(inverse.sigma + 1.0 / mu))
    upper = np.argsort(np.abs(direct))[::-1]
    size = np.abs(inverse.sigma + 1.0 / mu[order])
    middle = np.sqrt(size[0] * size[-1])
    # Conjugate pairs and close groups stay together: the spectrum is cut in its widest gap around the middle.
    places = np.flatnonzero((size[1:] > 0.1 * middle) & (size[:-1] < 10.0 * middle)) + 1
    if places.size == 0:
        return mu, X
    cut = int(places[np.argmax(size[places] / size[places - 1])])
    high = upper[: mu.size - cut]
    if np.abs(direct[high]).min() < size[cut - 1]:
        return mu, X
    low = order[:cut]
    return np.concatenate([mu[low], 1.0 / (direct[high] - inverse.sigma)]), np.hstack([X[:, low], Y[:, high]])


def _selected(
    inverse: InverseState,
    mu: np.ndarray,
    X: np.ndarray,
    known: np.ndarray,
    size: float,
    reach: float,
    rows: int | None = None,
) -> Pairs:
    """One eigenpair a conjugate pair, refined, in ascending |lambda|; `size` is the norm of the matrix that gave mu.

    That norm, not the largest |mu|, is what rounding goes with: a fast spin makes the matrix far from normal.
    """
    quadratic = inverse.quadratic
    sigma = inverse.sigma
    # Two equal real roots that rounding has made a conjugate pair are two real ones again, whose vectors are its two parts. Where
    # both parts are one direction, the double root has one vector and stays a pair.
    distance = 1.0 / mu
    twins = (mu.imag != 0.0) & (np.abs(distance.imag) <= _TWINS * EPS * np.abs(distance) ** 2 * size)
    if twins.any():
        twins &= np.linalg.norm(X.imag, axis=0) > _ONE_DIRECTION * np.linalg.norm(X, axis=0)
        X = np.where(twins, np.where(mu.imag < 0.0, X.real, X.imag), X)
        mu = np.where(twins, mu.real, mu)
    one = mu.imag <= 0.0  # Im lambda >= 0, since mu = 1 / (lambda - sigma)
    mu = mu[one].astype(complex)
    V = inverse.restored(mu, X[:, one].astype(complex), known)[: quadratic.n]
    values = sigma + 1.0 / mu

    # An error e of mu is one of |lambda - sigma|^2 e of lambda. What it blurs is refined on the pencil itself.
    rounding = EPS * np.abs(values - sigma) ** 2 * size / np.abs(values)
    rank = np.argsort(np.argsort(np.abs(values), kind="stable"), kind="stable")
    blurred = (rounding > _BLUR) & (rank < (values.size if rows is None else rows + _SPARE))
    if np.isfinite(reach):  # a large pencil: refinements cost, and a quotient does as well where little damps
        values = corrected(values, rounding, quadratic.forms(V))
        blurred = rounding * np.minimum(np.abs(values.real) / np.abs(values) + rounding, 1.0) > _BLUR_LARGE
    for i in np.flatnonzero(blurred):
        values[i], V[:, i] = newton(quadratic, values[i], V[:, i])
        if values[i].imag < 0.0:  # of a pair next to the real axis the other one may be found
            values[i] = np.conj(values[i])
            V[:, i] = np.conj(V[:, i])
    order = np.lexsort((values.imag, np.abs(values)))
    return values[order], V[:, order], reach - sigma


@dataclass(frozen=True)
class DampedModes:
    """Eigenvalues of lambda^2 M + lambda D + K, one per conjugate pair, in ascending |lambda|, rigid ones first.

    Attributes:
        eigenvalues: (m,) complex, Im >= 0, in rad/s; real ones (overdamped or divergent) have no partner; Re > 0 is unstable.
        vectors: (n, m) complex, the largest component is 1.
        rigid: (m,) True for the zero eigenvalue of each rigid vector. A drift partner is not listed.
        backward_error: (m,) ||Q v|| / ((|lambda|^2 ||M|| + |lambda| ||D|| + ||K||) ||v||), scaled to unit diagonals.
        complete: True when these are all the finite eigenvalues there are.
        method: "dense" or "block Arnoldi".
    """

    eigenvalues: np.ndarray
    vectors: np.ndarray
    rigid: np.ndarray
    backward_error: np.ndarray
    complete: bool
    method: str


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
    expected: int | None = None,
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
        expected: how many modes may lie below; saves looking for few first, never changes which are found.

    Raises:
        AnalysisError: K has a rigid-body motion that was not given, or a given one is strained or without inertia.
        ConvergenceError: the iteration did not converge; `partial` holds the modes found so far.
    """
    check_wanted(count, below)
    M, D, K = (sp.csc_array(A, dtype=float) for A in (M, D, K))
    check_finite(M=M, D=D, K=K)
    R = np.zeros((K.shape[0], 0)) if rigid_vectors is None else np.asarray(rigid_vectors, dtype=float)
    with single_thread(K.shape[0]):
        inverse = prepared(M, D, K, R, frequency_scale)
        rows = None if count is None else max(count - R.shape[1], 0)
        found, elastic, reach = solve(inverse, rows, below, dense, expected)

        # Rigid motions come first; the search has left them out. All is scaled here to unit diagonals.
        quadratic = inverse.quadratic
        limit = np.inf if below is None else below * (1.0 + EDGE) / quadratic.w0
        inside = np.count_nonzero(np.abs(found) <= min(limit, reach))
        shown = slice(0, inside if rows is None else min(inside, rows))
        elastic = elastic[:, shown]
        rigid = R / quadratic.scale[:, None]
        listed = rigid[:, :count]
        values = np.concatenate([np.zeros(listed.shape[1]), found[shown]])
        V = np.hstack([listed, elastic])
        errors = quadratic.residuals(values, V)

        # A vector outside the given rigid-body motions that K strains by rounding only: its eigenvalue would be noise.
        force = np.abs(quadratic.K @ elastic)
        rounding = 32.0 * EPS * (abs(quadratic.K) @ np.abs(elastic))
        Q = np.linalg.qr(rigid)[0]
        outside = np.linalg.norm(elastic - Q @ (Q.T @ elastic), axis=0) > 1e-6 * np.linalg.norm(elastic, axis=0)
        if np.any(np.all(force <= rounding, axis=0) & outside):
            raise AnalysisError(
                "The stiffness has a rigid-body motion (to its rounding) that was not given: pass all rigid modes."
            )

        return DampedModes(
            eigenvalues=values * quadratic.w0,
            vectors=with_largest_one(V * quadratic.scale[:, None]),
            rigid=np.arange(values.size) < listed.shape[1],
            backward_error=errors,
            complete=bool(np.isinf(reach)) and values.size == R.shape[1] + found.size,
            method="dense" if np.isinf(reach) else "block Arnoldi",
        )


def with_largest_one(V: np.ndarray) -> np.ndarray:
    """Vectors V (n, m) scaled so that the largest component of each is 1."""
    return np.asarray(V / V[np.argmax(np.abs(V), axis=0), np.arange(V.shape[1])])
