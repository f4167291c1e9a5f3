"""Left eigenvectors y of damped and gyroscopic modes, y^H Q(s) = 0 with Q(s) = s^2 M + s D + K, from the right ones x.

Without damping Q(s) is Hermitian on the imaginary axis, so y = x; with symmetric matrices y = conj(x). Else x is right up to the
damping ratio, and a mode that is damped more, or a stiffness that circulates, gets one inverse iteration with Q(s)^H.
Lancaster, Lambda-Matrices and Vibrating Systems, section 4.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from rotorgear.errors import ConvergenceError
from rotorgear.solvers.sparse.factor import factor_general
from rotorgear.system.system import System

_LIGHT = 0.03  # damping ratio up to which x does for an estimate
_ASIDE = 1e-9  # Q is taken so far from s that it can be factored, relative to s


def left_shapes(system: System, speed: float | None, s: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Left shapes (n, m) in the free dofs of modes s (m,), x (n, m) at a reference speed in rad/s; None is undamped."""
    at = speed or 0.0
    skew = system.circulatory(at)
    if not skew.nnz and (speed is None or not system.damping(at).nnz):
        return x
    if not skew.nnz and not (at and system.gyroscopic.nnz):
        return np.asarray(x.conj())
    unsure = np.ones(len(s), dtype=bool) if skew.nnz else np.abs(s.real) > _LIGHT * np.abs(s)
    D = system.velocity_terms(speed)
    y = x.astype(complex)
    for k in np.flatnonzero(unsure):
        y[:, k] = _iterated(system.mass, D, sp.csc_array(system.stiffness(at) + skew), s[k] * (1.0 + _ASIDE), y[:, k])
    return y


def _iterated(M: sp.csc_array, D: sp.csc_array | None, K: sp.csc_array, s: complex, x: np.ndarray) -> np.ndarray:
    Q = s**2 * M + K if D is None else s**2 * M + s * D + K
    try:
        y = factor_general(sp.csc_array(Q.conj().T)).solve(x)
    except ConvergenceError:
        return x
    return np.asarray(y / np.linalg.norm(y))
