"""Modes of a gyroscopic structure without damping, (s^2 M + s G + K) v = 0 with G skew, from a basis of its undamped ones.

The basis begins with the undamped modes. Each round solves the projected pencil and adds to the basis what its residuals ask
for, (K + sigma^2 M)^-1 Q(s) v, until eigenvalues and vectors no longer move; by Galerkin's condition an eigenvalue's error is the
square of its vector's. The projected pencil is a Hermitian eigenproblem, see `gyroscopic_pairs`.

That no mode is missing is counted. Q(i w) = K + i w G - w^2 M is Hermitian, and each mode makes one eigenvalue of it negative as
w rises past it (x^H Q(i w) x has one positive root w for every x), so that the signs of its pivots count the modes below w.

Tisseur and Meerbergen, SIAM Review 43 (2001) 235, sections 3.10 (gyroscopic and hyperbolic pencils) and 6.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from rotorgear.solvers.eigen.damped import DampedModes
from rotorgear.solvers.eigen.reduced_pencil import gyroscopic_pairs
from rotorgear.solvers.eigen.undamped_basis import NearUndamped, UndampedBasis, with_near
from rotorgear.solvers.sparse.factor import Factor, single_thread

# Error of an eigenvalue by its residual, and of a vector, at which a round is the last.
_SETTLED = 1e-12
_SETTLED_VECTOR = 1e-7
# Part of a correction that is not worth a column of the basis, relative to the largest correction.
_COARSE = 2e-3
_ROUNDS = 8
# Backward error above which the general solver is better.
_SOUND = 2e-9
# Share of the dofs above which a basis saves nothing.
_LARGEST_SHARE = 0.8
# Least relative gap between two frequencies in which modes are counted.
_GAP = 1e-4
# A mode this close above the limit `below` counts as on it.
_EDGE = 1e-9


def gyroscopic_modes(problem: NearUndamped, count: int | None, below: float | None) -> DampedModes | None:
    """The modes of smallest |s| as `damped_modes` gives them; None where a basis does not serve or the count differs.

    Args:
        problem: the pencil, whose D = G is skew, and its undamped modes, some more than are asked for.
        count: so many rows, rigid-body motions included; below: only |s| up to this in rad/s. One of them at least.
    """
    if problem.moves_rigid_bodies():
        return None
    rows = len(problem.frequencies) if count is None else max(count - problem.rigid.shape[1], 0)
    limit = np.inf if below is None else below
    with single_thread(problem.K.shape[0]):
        factor = problem.factor
        space = UndampedBasis(problem)
        for _ in range(_ROUNDS):
            if space.size > _LARGEST_SHARE * problem.K.shape[0]:
                return None
            basis = space.basis
            small = space.pencil(basis)
            w, Y = gyroscopic_pairs(small.M, 0.5 * (small.D - small.D.T), small.K, len(problem.frequencies))
            wanted = with_near(w, rows, limit)
            if wanted >= len(w):
                return None
            V = basis @ Y[:, :wanted]
            corrections, settled = _corrections(problem, factor, w[:wanted], V)
            if settled:
                asked = min(rows, int(np.count_nonzero(w <= limit * (1.0 + _EDGE))))
                found = counted_modes(problem, 1j * w[:asked], V[:, :asked], count, "basis of undamped modes")
                sound = found.backward_error.max(initial=0.0) <= _SOUND
                return found if sound and _count_agrees(problem, w, wanted) else None
            space.add(corrections, space.sizes(V), _COARSE)
    return None


def _corrections(problem: NearUndamped, factor: Factor, w: np.ndarray, V: np.ndarray) -> tuple[np.ndarray, bool]:
    """(K + sigma^2 M)^-1 Q(i w) v of each pair, (n, m), and whether eigenvalues and vectors have settled by them."""
    residual = problem.K @ V + (problem.D @ V) * (1j * w) - (problem.M @ V) * w**2
    found = problem.without_rigid(factor.solve(residual))

    def form(A: sp.csc_array, X: np.ndarray) -> np.ndarray:
        return np.asarray(np.real(np.einsum("ij,ij->j", X.conj(), A @ X)))

    # v^H Q'(w) v = -(v^H K v + w^2 v^H M v)/w, since v^H Q v = 0.
    error = np.abs(np.einsum("ij,ij->j", residual.conj(), found)) / (form(problem.K, V) + w**2 * form(problem.M, V))
    turned = np.sqrt(np.maximum(form(problem.K, found), 0.0) / form(problem.K, V))
    settled = error.max(initial=0.0) <= _SETTLED and turned.max(initial=0.0) <= _SETTLED_VECTOR
    return found, bool(settled)


def _count_agrees(problem: NearUndamped, w: np.ndarray, wanted: int) -> bool:
    """Whether no mode is missing below a gap above the wanted ones; a basis without a gap is not taken."""
    gaps = [k for k in range(max(wanted, 1), len(w)) if w[k] - w[k - 1] > _GAP * w[k]]
    if not gaps:
        return False
    middle = float(0.5 * (w[gaps[0] - 1] + w[gaps[0]]))
    return problem.counted_below(middle) == gaps[0] + problem.rigid.shape[1]


def counted_modes(problem: NearUndamped, s: np.ndarray, V: np.ndarray, count: int | None, basis: str) -> DampedModes:
    """Rigid-body motions and modes, that pivot signs have counted, with their backward errors.

    Args:
        problem: what is solved. s, V: eigenvalues (m,) and vectors (n, m) of its elastic modes. count: of rigid-body motions, at
            most; None for all. basis: in which the modes were found, in words.
    """
    rigid = problem.rigid[:, :count]
    values = np.concatenate([np.zeros(rigid.shape[1]), s])
    V = np.hstack([rigid, V])
    return DampedModes(
        eigenvalues=values,
        vectors=V / V[np.argmax(np.abs(V), axis=0), np.arange(V.shape[1])],
        rigid=np.arange(len(values)) < rigid.shape[1],
        backward_error=problem.backward_errors(values, V, problem.applied(values, V)),
        zero_count=2 * problem.rigid.shape[1],
        complete=False,
        method=f"{basis}, counted by pivot signs",
        shift=problem.shift,
        factorisations=2,
    )
