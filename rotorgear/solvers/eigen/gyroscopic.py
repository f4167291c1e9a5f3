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

from rotorgear.solvers.eigen.damped import DampedModes, with_largest_one
from rotorgear.solvers.eigen.reduced_pencil import gyroscopic_pairs
from rotorgear.solvers.eigen.undamped_basis import NearUndamped, ScaledBasis, with_near
from rotorgear.solvers.sparse.entries import column_forms
from rotorgear.solvers.sparse.factor import single_thread
from rotorgear.solvers.sparse.pencil import EDGE

# Error of an eigenvalue by its residual, and of a vector, at which a round is the last.
_CONVERGED = 1e-12
_CONVERGED_VECTOR = 1e-7
# Part of a correction that is not worth a column of the basis, relative to the largest correction.
_COARSE = 2e-3
_ROUNDS = 8
# Backward error above which the general solver is better.
_SOUND = 2e-9
# Share of the dofs above which a basis saves nothing.
_LARGEST_SHARE = 0.8
# Least relative gap between two frequencies in which modes are counted.
_GAP = 1e-4


def gyroscopic_modes(problem: NearUndamped, count: int | None, below: float | None) -> DampedModes | None:
    """The modes of smallest |s| as `damped_modes` gives them; None where the basis fails or the count differs.

    Args:
        problem: the pencil, whose D = G is skew, and its undamped modes, some more than are asked for.
        count: number of modes, rigid-body motions included. below: highest |s| in rad/s. At least one of the two is given.
    """
    if problem.moves_rigid_bodies():
        return None
    rows = len(problem.frequencies) if count is None else max(count - problem.rigid.shape[1], 0)
    limit = np.inf if below is None else below
    with single_thread(problem.K.shape[0]):
        space = ScaledBasis(problem.weight, problem.modes)
        for _ in range(_ROUNDS):
            if space.size > _LARGEST_SHARE * problem.K.shape[0]:
                return None
            basis = space.basis
            small = problem.pencil(basis)
            w, Y = gyroscopic_pairs(small.M, 0.5 * (small.D - small.D.T), small.K, len(problem.frequencies))
            wanted = with_near(w, rows, limit)
            if wanted >= len(w):
                return None
            V = basis @ Y[:, :wanted]
            corrections, converged = _corrections(problem, w[:wanted], V)
            if converged:
                asked = min(rows, int(np.count_nonzero(w <= limit * (1.0 + EDGE))))
                found = counted_modes(problem, 1j * w[:asked], V[:, :asked], count, "basis of undamped modes")
                # No mode may be missing below a gap above the wanted ones; a basis without such a gap is not taken.
                gap = next((k for k in range(max(wanted, 1), len(w)) if w[k] - w[k - 1] > _GAP * w[k]), None)
                if gap is None or not found.backward_error.max(initial=0.0) <= _SOUND:
                    return None
                middle = float(0.5 * (w[gap - 1] + w[gap]))
                return found if problem.counted_below(middle) == gap + problem.rigid.shape[1] else None
            space.add_corrections(corrections, space.sizes(V), _COARSE)
    return None


def _corrections(problem: NearUndamped, w: np.ndarray, V: np.ndarray) -> tuple[np.ndarray, bool]:
    """(K + sigma^2 M)^-1 Q(i w) v of each pair, (n, m), and whether eigenvalues and vectors have converged by them."""
    residual = problem.K @ V + (problem.D @ V) * (1j * w) - (problem.M @ V) * w**2
    found = problem.without_rigid(problem.factor.solve(residual))
    strain = column_forms(problem.K, V).real
    # v^H Q'(w) v = -(v^H K v + w^2 v^H M v)/w, since v^H Q v = 0.
    slope = strain + w**2 * column_forms(problem.M, V).real
    error = np.abs(np.einsum("ij,ij->j", residual.conj(), found)) / slope
    turned = np.sqrt(np.maximum(column_forms(problem.K, found).real, 0.0) / strain)
    return found, bool(error.max(initial=0.0) <= _CONVERGED and turned.max(initial=0.0) <= _CONVERGED_VECTOR)


def counted_modes(problem: NearUndamped, s: np.ndarray, V: np.ndarray, count: int | None, basis: str) -> DampedModes:
    """Rigid-body motions and modes that pivot signs have counted, with their backward errors.

    Args:
        problem: the pencil and its undamped modes. s, V: eigenvalues (m,) and vectors (n, m) of its elastic modes.
        count: the most rigid-body motions to list; None for all. basis: name of the basis, for the result.
    """
    rigid = problem.rigid[:, :count]
    values = np.concatenate([np.zeros(rigid.shape[1]), s])
    V = np.hstack([rigid, V])
    return DampedModes(
        eigenvalues=values,
        vectors=with_largest_one(V),
        rigid=np.arange(len(values)) < rigid.shape[1],
        backward_error=problem.backward_errors(values, V, problem.applied(values, V)),
        complete=False,
        method=f"{basis}, counted by pivot signs",
    )
