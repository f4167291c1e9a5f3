"""Contact that pushes and never pulls: forces F >= 0 with a given sum, gaps w = C F + g - d >= 0, F_i w_i = 0.

Block pivoting on the active set with a bordered dense system; where it runs in a circle, the primal active-set method, whose
energy falls in every step, takes over. Both end in the one exact solution of the convex problem.
Reference: Nocedal and Wright, Numerical Optimization, section 16.5;
Lawson and Hanson, Solving Least Squares Problems, chapter 23.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg.lapack import dposv

from rotorgear.errors import ConvergenceError

_BLOCK_ROUNDS = 40
# A gap counts as open inwards below this share of the largest deflection.
_TOLERANCE = 1e-12


def unilateral(
    C: np.ndarray, gap: np.ndarray, total: float, start: np.ndarray | None = None
) -> tuple[np.ndarray, float]:
    """Forces (n,) and approach d of bodies pressed together by `total` > 0.

    Args:
        C: compliance (n, n), symmetric and positive definite.
        gap: (n,) initial gaps, of any sign.
        total: sum of the forces.
        start: (n,) which points to begin with as active; default all.

    Raises:
        ConvergenceError: C is not positive definite.
    """
    active = np.ones(len(gap), bool) if start is None or not start.any() else start.copy()
    seen = set()
    for _ in range(_BLOCK_ROUNDS):
        key = active.tobytes()
        if key in seen:
            break
        seen.add(key)
        force, approach = _pressed(C, gap, total, active)
        open_by = C @ force + gap - approach
        slack = _TOLERANCE * (abs(approach) + float(np.abs(gap).max()))
        pulling = active & (force < 0.0)
        closed = ~active & (open_by < -slack)
        if not pulling.any() and not closed.any():
            return force, approach
        active = (active & ~pulling) | closed
        if not active.any():
            break
    return _primal(C, gap, total)


def _pressed(C: np.ndarray, gap: np.ndarray, total: float, active: np.ndarray) -> tuple[np.ndarray, float]:
    """Forces and approach where the active points touch and the others carry nothing."""
    index = np.flatnonzero(active)
    right = np.ones((len(index), 2), order="F")
    right[:, 1] = gap[index]
    # LAPACK itself: systems are small and many, and the checks of scipy cost as much as their factorisation.
    _, solved, failed = dposv(C[index[:, None], index].T, right, overwrite_a=True, overwrite_b=True)
    if failed:
        raise ConvergenceError(
            "The compliance of the contact is not positive definite: the contact strip is wider than the patches it replaces. "
            "Reduce the load, or use a finer preset."
        )
    approach = float((total + solved[:, 1].sum()) / solved[:, 0].sum())
    force = np.zeros(len(gap))
    force[index] = approach * solved[:, 0] - solved[:, 1]
    return force, approach


def _primal(C: np.ndarray, gap: np.ndarray, total: float) -> tuple[np.ndarray, float]:
    """Primal active-set method from the point with the smallest gap: one point comes or goes in each step."""
    active = np.zeros(len(gap), bool)
    active[np.argmin(gap)] = True
    force = total * active.astype(float)
    for _ in range(50 * len(gap) + 100):
        target, approach = _pressed(C, gap, total, active)
        if np.all(target[active] > 0.0):
            force = target
            open_by = np.where(active, 0.0, C @ force + gap - approach)
            if open_by.min() >= -_TOLERANCE * (abs(approach) + float(np.abs(gap).max())):
                return force, approach
            active[np.argmin(open_by)] = True
            continue
        falling = active & (target <= 0.0)
        steps = force[falling] / np.maximum(force[falling] - target[falling], 1e-300)
        force = force + steps.min() * (target - force)
        leaving = np.flatnonzero(falling)[np.argmin(steps)]
        active[leaving] = False
        force[leaving] = 0.0
    raise ConvergenceError("The contact did not converge: the compliance is too badly conditioned. Use a finer preset.")
