"""Lyapunov exponents of equations of one's own, y' = f(y), from the tangent flow Y' = J(y) Y made orthonormal by QR.

Many trajectories run side by side; the exponents are means over all of them, and their standard errors follow from the scatter
between trajectories. Benettin, Galgani, Giorgilli and Strelcyn, Meccanica 15 (1980) 9.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from rotorgear.errors import AnalysisError

Field = Callable[[np.ndarray], np.ndarray]


def flow_exponents(
    slope: Field, jacobian: Field, states: np.ndarray, step: float, *, discard: int, sample: int, every: int = 10
) -> tuple[np.ndarray, np.ndarray]:
    """Return all exponents (n,), largest first, and their standard errors (n,), per unit time.

    Args:
        slope: f of states (w, n), returns (w, n). jacobian: J of states (w, n), returns (w, n, n).
        states: where w >= 2 trajectories start, (w, n).
        step: of the Runge-Kutta method of order 4.
        discard: steps of the transient discarded; sample: steps evaluated after them.
        every: steps between two orthonormalisations.

    Raises:
        AnalysisError: a trajectory left all bounds, or there is one only.
    """
    y = np.array(states, dtype=float)
    if y.ndim != 2 or len(y) < 2:
        raise AnalysisError("states: expected an array (w, n) of at least two trajectories")
    w, n = y.shape
    Y = np.broadcast_to(np.eye(n), (w, n, n)).copy()
    growth = np.zeros((w, n))
    counted = 0
    for number in range(1, discard + sample + 1):
        y, Y = _step(slope, jacobian, y, Y, step)
        if number % every == 0 or number == discard + sample:
            Y, R = np.linalg.qr(Y)
            if not np.all(np.isfinite(y)):
                raise AnalysisError(f"a trajectory left all bounds after {number} steps: take a smaller step")
            if number > discard:
                growth += np.log(np.abs(np.diagonal(R, axis1=1, axis2=2)))
                counted = number
        if number == discard:
            Y = np.linalg.qr(Y)[0]
            growth[:] = 0.0
    rates = growth / ((counted - discard) * step)
    return rates.mean(axis=0), rates.std(axis=0, ddof=1) / np.sqrt(w)


def _step(slope: Field, jacobian: Field, y: np.ndarray, Y: np.ndarray, h: float) -> tuple[np.ndarray, np.ndarray]:
    """One step of trajectories and tangents."""
    k1 = slope(y)
    K1 = jacobian(y) @ Y
    a = y + 0.5 * h * k1
    A = Y + 0.5 * h * K1
    k2 = slope(a)
    K2 = jacobian(a) @ A
    a = y + 0.5 * h * k2
    A = Y + 0.5 * h * K2
    k3 = slope(a)
    K3 = jacobian(a) @ A
    a = y + h * k3
    A = Y + h * K3
    k4 = slope(a)
    K4 = jacobian(a) @ A
    return y + h / 6.0 * (k1 + 2.0 * (k2 + k3) + k4), Y + h / 6.0 * (K1 + 2.0 * (K2 + K3) + K4)
