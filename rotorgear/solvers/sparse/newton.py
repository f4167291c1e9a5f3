"""Equilibrium of a linear structure with local forces, K q + B F(B^T q) = f, by Newton's method on the m local displacements.

About any stiffness k of the laws, q = q0 + X (k d - F(d)) with q0 = (K + B k B^T)^-1 f and X = (K + B k B^T)^-1 B. So

    r(d) = d - d0 + A (F(d) - k d) = 0,    d0 = B^T q0,    A = B^T X,    dr/dd = 1 + A (dF/dd - k)

Whatever k is, the solution is the same; where the forces are k d, the start d0 is the solution.

Where Newton's method stops short, as with open contacts (no force acts in them, so no tangent says where to go), the laws get
dampers in proportion to k, and d moves to an equilibrium: with s = (time step)^-1 each step solves
r(d) + s A k (d - d_last) = 0, and s falls until nothing of it is left. A gap is crossed however soft or stiff its walls are,
because a tenfold step is taken with each solution. A stable equilibrium is reached, an unstable one is left.

Forces may be small differences of large parts, as pressures around a centred journal are: without a load F is rounding of these
parts, and no iteration brings it to a share of itself. A caller that knows the parts gives their `extents`.
Kelley and Keyes, Convergence analysis of pseudo-transient continuation, SIAM J. Numer. Anal. 35 (1998) 508.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

# Forces (m,) and tangents (m, m) at local displacements (m,).
Laws = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]
# Residual (m,) of displacements and forces (m,), and whether it is small with tangents (m, m) there.
Residual = Callable[[np.ndarray, np.ndarray], np.ndarray]
Small = Callable[[np.ndarray, np.ndarray, np.ndarray, np.ndarray], bool]

_ITERATIONS = 80
_TOLERANCE = 1e-10
# Rounding of d - d0 + A (F - k d), or of a force, in units of its terms: no iteration gets below.
ROUNDING = 16.0 * np.finfo(float).eps
# Where rounding would hide more than this share of the forces there is no equilibrium: displacements run away.
_WORST = 1e-4
# Iterations in a row that do not bring the residual down.
_STUCK = 3
# Steps of the continuation: each ten times as long as the last, and a fifth as long again where it was too long to be solved.
_STEPS = 120
_LONGER = 10.0
_SHORTER = 5.0
# Evaluations of the laws after which the search ends: more than three times what any equilibrium was seen to take.
EVALUATIONS = 3000


@dataclass(frozen=True)
class LocalEquilibrium:
    """Local displacements and forces (m,), tangents (m, m) there, and whether they are in equilibrium."""

    d: np.ndarray
    force: np.ndarray
    tangent: np.ndarray
    converged: bool


def local_equilibrium(
    d0: np.ndarray,
    A: np.ndarray,
    k: np.ndarray,
    laws: Laws,
    near: np.ndarray | None = None,
    *,
    extents: np.ndarray | None = None,
    evaluations: int = EVALUATIONS,
) -> LocalEquilibrium:
    """Return the local displacements in equilibrium.

    Args:
        d0: (m,) displacements under the loads with the laws linear at k.
        A: (m, m) receptance of the local displacements with the laws linear at k.
        k: (m, m) that stiffness.
        laws: forces and tangents.
        near: (m,) where the solution is looked for first; None: d0.
        extents: displacements (m,) that change the forces by the size of what cancels in them; None: nothing does.
        evaluations: number of evaluations of the laws after which the search ends.
    """
    size = float(np.abs(d0).max(initial=0.0))
    left = iter(range(evaluations))

    def counted(d: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        next(left)  # it stops where the laws were evaluated as often as they may be
        return laws(d)

    def residual(d: np.ndarray, F: np.ndarray) -> np.ndarray:
        return np.asarray(d - d0 + A @ (F - k @ d))

    def small(d: np.ndarray, F: np.ndarray, tangent: np.ndarray, r: np.ndarray) -> bool:
        largest = size + np.abs(A @ F).max(initial=0.0)
        worst = np.abs(r).max(initial=0.0)
        terms = np.abs(d) + np.abs(A) @ (np.abs(F) + np.abs(k) @ np.abs(d))
        noise = ROUNDING * terms.max(initial=0.0)
        if noise <= _WORST * largest and worst <= max(_TOLERANCE * largest, noise):
            return True
        if extents is None:
            return False
        return bool(worst <= ROUNDING * (terms + (np.abs(A) @ (np.abs(tangent) @ extents))).max(initial=0.0))

    try:
        for start in (d0,) if near is None else (near, d0):
            found = _newton(start, A, k, counted, residual, small)
            if found.converged:
                return found

        d = d0
        s = 1.0
        for _ in range(_STEPS):

            def damped(d: np.ndarray, F: np.ndarray, last: np.ndarray = d, s: float = s) -> np.ndarray:
                return np.asarray(residual(d, F) + s * (A @ (k @ (d - last))))

            step = _newton(d, A, (1.0 - s) * k, counted, damped, small)
            if not step.converged:
                s *= _SHORTER
                continue
            d = step.d
            if small(d, step.force, step.tangent, residual(d, step.force)):
                return step
            s /= _LONGER
    except StopIteration:
        pass
    F, tangent = laws(d0)
    return LocalEquilibrium(d0, F, tangent, False)


def _newton(
    start: np.ndarray, A: np.ndarray, k: np.ndarray, laws: Laws, residual: Residual, small: Small
) -> LocalEquilibrium:
    """Newton's method for a residual of derivative 1 + A (dF/dd - k); a step is halved until it brings the residual down."""
    d = start.copy()
    F, tangent = laws(d)
    r = residual(d, F)
    stuck = 0
    for _ in range(_ITERATIONS):
        if not np.all(np.isfinite(r)):
            break
        if small(d, F, tangent, r):
            return LocalEquilibrium(d, F, tangent, True)
        # Least squares: open contacts leave directions in which nothing changes.
        step = np.linalg.lstsq(np.eye(d.size) + A @ (tangent - k), -r, rcond=1e-14)[0]
        share = 1.0
        before = np.linalg.norm(r)
        while True:
            trial = d + share * step
            F, tangent = laws(trial)
            r = residual(trial, F)
            # Armijo's condition with the usual 1e-4: Nocedal and Wright, Numerical Optimization, section 3.1.
            if np.linalg.norm(r) < (1.0 - 1e-4 * share) * before or share < 1e-3:
                break
            share *= 0.5
        d = trial
        stuck = stuck + 1 if not np.linalg.norm(r) <= (1.0 - 1e-6) * before else 0
        if stuck == _STUCK:
            break
    return LocalEquilibrium(d, F, tangent, bool(np.all(np.isfinite(r))) and small(d, F, tangent, r))
