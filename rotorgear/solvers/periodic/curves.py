"""Curves of folds and of period doublings in two parameters, as equations of their own.

    r(y, p, q) = 0,   g(y, p, q) = 0,   [A b; c^T 0] [v; g] = [0; 1]

A is the derivative of r at a fold; at a period doubling that of the equations of twice the period, or the monodromy matrix plus
one. It is singular where g vanishes. With [A^T c; b^T 0] [w; g] = [0; 1] the slopes of g are -w^T A' v, and along y, where A
is a derivative itself, -w^T (A(y + e v) - A(y - e v))/2e.
Govaerts, Numerical Methods for Bifurcations of Dynamical Equilibria (SIAM 2000), ch. 4.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol, Self

import numpy as np

from rotorgear.solvers.periodic.arclength import Linear
from rotorgear.solvers.periodic.cycle import Cycle
from rotorgear.solvers.periodic.shooting import ShootingOrbits
from rotorgear.solvers.periodic.special import DOUBLING, Orbits

# Steps of differences: along v, of length 1, and in both parameters.
_ALONG = 1e-5
_DIFFERENCE = 1e-6
_VIEWS = 6


class Differentiable(Orbits, Protocol):
    """Equations of periodic motions with derivatives that are smooth in the parameter."""

    def smooth_residual(self, y: np.ndarray, p: float) -> np.ndarray:
        """r (N,), for differences in a parameter."""

    def jacobian(self, y: np.ndarray, p: float) -> np.ndarray:
        """Derivative of r by y (N, N)."""

    def cycle(self, y: np.ndarray, p: float) -> Cycle:
        """A period of a solution."""

    def doubled(self) -> Self:
        """The same with twice the period."""

    def twice(self, y: np.ndarray, other: Any) -> np.ndarray:
        """The unknowns of one motion in the equations of twice its period."""


class SpecialCurve:
    """Equations of special points of one kind: unknowns (y, p), (N + 1,), the second parameter q as the one to walk along.

    Args:
        orbits_at: equations of the motions at a value of q. kind: fold or period doubling.
        y, p, q: a special point of the kind.
    """

    def __init__(
        self, orbits_at: Callable[[float], Differentiable], kind: str, y: np.ndarray, p: float, q: float
    ) -> None:
        self._orbits_at = orbits_at
        self._doubling = kind == DOUBLING
        self._views: dict[float, tuple[Differentiable, Differentiable]] = {}
        self._settle = True
        own, other = self._view(q)
        self._map = self._doubling and isinstance(own, ShootingOrbits)
        marks = (
            np.asarray(own.twice(np.arange(1.0, y.size + 1.0), other)) if self._doubling else np.arange(1.0, y.size + 1)
        )
        rows = np.flatnonzero(np.round(marks))
        # Place of each unknown of y among those that A takes.
        self._places = rows[np.argsort(marks[rows])]
        own.settle_on(p)
        other.settle_on(p)
        U, _, Vt = np.linalg.svd(self._matrix(y, p, q))
        self._b = U[:, -1]
        self._c = Vt[-1]

    def _view(self, q: float) -> tuple[Differentiable, Differentiable]:
        """The equations at q, and those that A belongs to."""
        if q not in self._views:
            while len(self._views) >= _VIEWS:
                self._views.pop(next(iter(self._views)))
            own = self._orbits_at(q)
            other = own
            if self._doubling and not isinstance(own, ShootingOrbits):
                other = own.doubled()
            self._views[q] = (own, other)
        return self._views[q]

    def orbits(self, q: float) -> Differentiable:
        """The equations of the motions at q."""
        return self._view(q)[0]

    def settle_on(self, q: float) -> None:
        """From the next point on."""
        self._settle = True

    def _matrix(self, y: np.ndarray, p: float, q: float, along: np.ndarray | None = None) -> np.ndarray:
        """A at (y, p, q), or a step of `along` away from it."""
        own, other = self._view(q)
        full = y
        if other is not own:
            full = np.asarray(own.twice(y, other))
        if along is not None:
            full = full + along
        J = other.jacobian(full, p)
        return J + 2.0 * np.eye(len(J)) if self._map else J

    def _bordered(self, A: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
        """v, w and g."""
        n = len(A)
        full = np.zeros((n + 1, n + 1))
        full[:n, :n] = A
        full[:n, n] = self._b
        full[n, :n] = self._c
        right = np.zeros(n + 1)
        right[n] = 1.0
        v = np.linalg.solve(full, right)
        w = np.linalg.solve(full.T, right)
        return v[:n], w[:n], float(v[n])

    def residual(self, z: np.ndarray, q: float) -> np.ndarray:
        """[r, g]."""
        y = z[:-1]
        p = float(z[-1])
        if self._settle:
            for one in self._view(q):
                one.settle_on(p)
        A = self._matrix(y, p, q)
        v, w, g = self._bordered(A)
        if self._settle:
            # Borders near to both null vectors keep the bordered matrix regular along the curve.
            self._c = v / np.linalg.norm(v)
            self._b = w / np.linalg.norm(w)
            g = self._bordered(A)[2]
            self._settle = False
        return np.append(self._view(q)[0].residual(y, p), g)

    def linear(self, z: np.ndarray, q: float) -> Linear:
        """[r, g] and its derivatives."""
        y = z[:-1]
        p = float(z[-1])
        own = self._view(q)[0]
        here = own.linear(y, p)
        v, w, g = self._bordered(self._matrix(y, p, q))
        in_q = _difference(lambda x: self._view(x)[0].smooth_residual(y, p), q) / (2.0 * _DIFFERENCE)
        g_p = -w @ _difference(lambda x: self._matrix(y, x, q), p) @ v / (2.0 * _DIFFERENCE)
        g_q = -w @ _difference(lambda x: self._matrix(y, p, x), q) @ v / (2.0 * _DIFFERENCE)
        step = _ALONG / float(np.linalg.norm(v))
        curved = w @ (self._matrix(y, p, q, step * v) - self._matrix(y, p, q, -step * v)) / (2.0 * step)
        n = y.size
        full = np.zeros((n + 1, n + 1))
        full[:n, :n] = here.in_y
        full[:n, n] = here.in_p
        full[n, :n] = -curved[self._places]
        full[n, n] = g_p
        return Linear(np.append(here.residual, g), full, np.append(in_q, g_q))


def _difference(values: Callable[[float], np.ndarray], at: float) -> np.ndarray:
    """Difference of an array over a step in a parameter to both sides."""
    return values(at + _DIFFERENCE) - values(at - _DIFFERENCE)
