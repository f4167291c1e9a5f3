"""Modes of a gyroscopic structure with dampers at few places, Q(s) v = (s^2 M + s D + K) v = 0, from undamped ones; D = G + C.

The basis holds the undamped modes X, what the forces s D x of each call forth, (K + sigma^2 M)^-1 D X, and the static responses
to the dampers. It is projected on its own columns (Galerkin), and a small dense problem gives eigenvalues z, right vectors v and
left ones y. What they leave in the dofs, r = Q(z) v and t = Q(z)^H y, corrects all three by the one factor that is there,

    e = A^-1 r,   f = A^-1 t,   A = K + sigma^2 M,   v <- v - e,
    z <- z + (2 t^H e - f^H Q(z) e) / (y^H Q'(z) v),

the quotient (y - f)^H Q(z) (v - e) = 0, whose error is the product of the errors that are left on both sides. Where t^H e alone
says something else, the corrections e become columns of the basis, and the small problem is solved again.

No mode of the structure without its dampers is missing where Q(i w) of the dofs and of the basis have the same number of negative
eigenvalues, see `gyroscopic`. Dampers alone bring motions that do not oscillate, and those are left to the general solver.

Tisseur and Meerbergen, SIAM Review 43 (2001) 235, sections 3 and 6; Lancaster, Lambda-Matrices and Vibrating Systems, section 4.
"""

from __future__ import annotations

import numpy as np

from rotorgear.solvers.eigen.damped import DampedModes
from rotorgear.solvers.eigen.gyroscopic import counted_modes
from rotorgear.solvers.eigen.reduced_pencil import Pencil, clusters, eigen
from rotorgear.solvers.eigen.undamped_basis import NearUndamped, ScaledBasis, forces, with_near
from rotorgear.solvers.sparse.entries import columns_of, times
from rotorgear.solvers.sparse.factor import negative_eigenvalues, single_thread
from rotorgear.solvers.sparse.pencil import EDGE

_BASIS = "basis of undamped modes and responses to dampers"
# Largest number of dofs on which dampers act, and largest share of all dofs.
_MOST_PLACES = 96
_MOST_OF = 0.2
# Relative size of an eigenvalue of the damping matrix that is rounding.
_RANK = 1e-12
# By how much the two corrections of an eigenvalue may differ, relative to it; what is left is a tenth of that or less.
_CONVERGED = 2e-9
# Eigenvalues this close to each other are corrected together.
_CLOSE = 1e-3
# Share of the largest correction that is not worth a column yet.
_COARSE = 3e-2
_ROUNDS = 5
# Backward error above which vectors are not good enough.
_SOUND = 1e-9
# Share of the dofs above which a basis saves nothing.
_LARGEST_SHARE = 0.6
# Places above the last mode, relative to it, at which modes may be counted; and how far around it no mode may lie.
_COUNT_AT = (1.02, 1.035, 1.05)
_AROUND = 1e-4
# Share of the first frequency below which a pair is two motions that dampers slow, split by rounding.
_SLOW = 1e-5


def locally_damped_modes(problem: NearUndamped, count: int | None, below: float | None) -> DampedModes | None:
    """The modes of smallest |s| as `damped_modes` gives them; None where the basis fails.

    Args:
        problem: the pencil and its undamped modes, some more than are asked for.
        count: number of modes, rigid-body motions included. below: highest |s| in rad/s. At least one of the two is given.
    """
    C, _ = problem.halves
    touched = np.unique(C.indices)
    if len(touched) > min(_MOST_PLACES, _MOST_OF * C.shape[0]) or problem.moves_rigid_bodies():
        return None
    # Unit forces P (n, p) of the dampers, whose damping matrix is P c P^T.
    scale = 1.0 / problem.weight[touched]
    block = np.zeros((len(touched), len(touched)))
    block[np.searchsorted(touched, C.indices), np.searchsorted(touched, columns_of(C))] = C.data
    values, vectors = np.linalg.eigh(block * scale * scale[:, None])
    real = np.abs(values) > _RANK * np.abs(values).max(initial=0.0)
    P = np.zeros((C.shape[0], int(real.sum())))
    P[touched] = vectors[:, real] / scale[:, None]
    most = len(problem.frequencies)
    rows = most if count is None else max(count - problem.rigid.shape[1], 0)
    limit = np.inf if below is None else below
    with single_thread(problem.K.shape[0]):
        # Undamped modes, static responses to dampers, and what the velocities of the first `rows` modes excite.
        space = ScaledBasis(problem.weight, problem.modes)
        modes = problem.modes[:, :rows]
        forced = problem.without_rigid(problem.factor.solve(np.hstack([P, problem.D @ modes])))
        local = forced[:, : P.shape[1]]
        space.add_corrections(local, np.maximum(space.sizes(local), np.finfo(float).tiny), 0.0)
        space.add_corrections(forced[:, P.shape[1] :] * problem.frequencies[:rows], space.sizes(modes), _COARSE)
        for _ in range(_ROUNDS):
            if space.size > _LARGEST_SHARE * problem.K.shape[0]:
                return None
            basis = space.basis
            small = problem.pencil(basis)
            shift = float(np.sqrt(problem.frequencies[0] * problem.frequencies[-1]))
            # No rigid-body motion is in the basis: what hardly moves is a motion that dampers slow.
            found = eigen(small, shift, 0.0, most)
            size = np.abs(found.s)
            wanted = with_near(size, rows, limit)
            # With a motion that does not oscillate among the modes, or no mode above them, the general solver is needed.
            if wanted >= len(size) or np.any(np.abs(found.real) <= _COUNT_AT[-1] * size[wanted]):
                return None
            if size[0] <= _SLOW * problem.frequencies[0]:
                return None
            right = basis @ found.q[:, :wanted]
            s, v, e, unsure = _corrected(problem, found.s[:wanted], right, basis @ found.y[:, :wanted])
            if unsure <= _CONVERGED:
                asked = min(rows, int(np.count_nonzero(np.abs(s) <= limit * (1.0 + EDGE))))
                s = s[:asked]
                v = v[:, :asked]
                # One more correction A^-1 Q(s) v frees the vectors of what lies beyond the undamped modes X. Along X, where r of
                # the projection was zero, it is the eigenvalue that decides, and A would mistake s: that part is not taken.
                more = problem.without_rigid(problem.factor.solve(problem.applied(s, v)))
                v = v - more + problem.modes @ (problem.modes.T @ times(problem.M, more))
                found_modes = counted_modes(problem, s, v, count, _BASIS)
                if found_modes.backward_error.max(initial=0.0) <= _SOUND:
                    last = float(size[wanted - 1]) if wanted else float(problem.frequencies[0]) / _COUNT_AT[-1]
                    return found_modes if _none_is_missing(problem, small, last) else None
            space.add_corrections(e, space.sizes(right), _COARSE)
    return None


def _corrected(
    problem: NearUndamped, z: np.ndarray, v: np.ndarray, y: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray, float]:
    """Correct eigenvalues z (m,) with right and left vectors v and y (n, m).

    Returns:
        Eigenvalues (m,) and right vectors (n, m) with both corrections, e (n, m), and the largest difference of the two
        corrections of an eigenvalue over its size.
    """
    m = len(z)
    of_both = problem.products(np.hstack([v, y]))
    products = of_both[:, :, :m]
    right = forces(z, products)
    left = forces(z.conj(), problem.mirrored(y, of_both[:, :, m:]))
    both = problem.without_rigid(problem.factor.solve(np.hstack([right, left])))
    e = both[:, :m]
    f = both[:, m:]
    values = z.copy()
    v = v - e
    # y_i^H ((s_i + s_j) M + D) v_j: the product in which left and right vectors of a pencil are biorthogonal.
    heavy = y.conj().T @ products[0]
    product = y.conj().T @ products[1] + heavy * z + z[:, None] * heavy
    once = left.conj().T @ e
    twice = f.conj().T @ problem.applied(z, e)
    groups = clusters(z, _CLOSE)
    alone = np.array([close[0] for close in groups if len(close) == 1], dtype=int)
    change = once[alone, alone]
    change_of_change = change - twice[alone, alone]
    slope = product[alone, alone]
    values[alone] += (change + change_of_change) / slope
    unsure = float(np.abs(change_of_change / (slope * z[alone])).max(initial=0.0))
    for close in groups:
        if len(close) == 1:
            continue
        block = np.ix_(close, close)
        first = np.linalg.solve(product[block], once[block])
        second = 2.0 * first - np.linalg.solve(product[block], twice[block])
        unsure = max(unsure, float((np.abs(second - first) / np.abs(z[close])[:, None]).max()))
        values[close], turn = np.linalg.eig(np.diag(z[close]) + second)
        v[:, close] = v[:, close] @ turn
    order = np.argsort(np.abs(values), kind="stable")
    return values[order], v[:, order], e, unsure


def _none_is_missing(problem: NearUndamped, small: Pencil, last: float) -> bool:
    """Whether the structure without its dampers has as many modes in the dofs as in the basis, up to a little above `last`."""
    G = 0.5j * (small.D - small.D.T)
    scale = 1.0 / np.sqrt(small.K.diagonal() + problem.shift**2 * small.M.diagonal())

    def below(w: float) -> int:
        """How many modes the basis has below w."""
        return negative_eigenvalues((small.K + w * G - w**2 * small.M) * scale * scale[:, None])

    for place in _COUNT_AT:
        w = place * last
        expected = below(w * (1.0 - _AROUND))
        if below(w * (1.0 + _AROUND)) == expected:
            break
    else:
        return False
    return problem.counted_below(w) == expected + problem.rigid.shape[1]
