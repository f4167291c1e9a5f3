"""Curves of folds and of period doublings in two parameters, as equations of their own.

    r(y, p, q) = 0,   g(y, p, q) = 0,   [A b; c^T 0] [v; g] = [0; 1]

A is the derivative of r at a fold; at a period doubling that of the equations of twice the period, or the monodromy matrix plus
one. It is singular where g vanishes. With [A^T c; b^T 0] [w; g] = [0; 1] the slopes of g are -w^T A' v, and along y, where A
is a derivative itself, -w^T (A(y + e v) - A(y))/e.
Govaerts, Numerical Methods for Bifurcations of Dynamical Equilibria (SIAM 2000), ch. 4.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple, Protocol, Self

import numpy as np
import scipy.linalg as la

from rotorgear.solvers.periodic.arclength import Linear
from rotorgear.solvers.periodic.samples import MotionCycle
from rotorgear.solvers.periodic.shooting import ShootingOrbits
from rotorgear.solvers.periodic.special import DOUBLING, Orbits

# Steps of differences to one side: along v, of length 1, and in both parameters.
_ALONG = 1e-5
_DIFFERENCE = 1e-6
_VIEWS = 6
# The linear equations of a point of the curve are made anew up to this iteration, and at every multiple of the next number.
_ANEW = 1
_RENEWED = 6


class Differentiable(Orbits, Protocol):
    """Equations of periodic motions with derivatives that are smooth in the parameter."""

    def values(self, y: np.ndarray, p: float, *, smooth: bool = False) -> tuple[np.ndarray, np.ndarray]:
        """r (N,) and its derivative by y (N, N); smooth ones for differences in a parameter."""

    def cycle(self, y: np.ndarray, p: float) -> MotionCycle:
        """A period of a solution."""

    def doubled(self) -> Self:
        """The same with twice the period."""

    def twice(self, y: np.ndarray, other: Any) -> np.ndarray:
        """The unknowns of one motion in the equations of twice its period."""


class Here(NamedTuple):
    """Of a point: r (N,), its derivative by y (N, N), both null vectors v and w, and g."""

    r: np.ndarray
    in_y: np.ndarray
    v: np.ndarray
    w: np.ndarray
    g: float


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
        self._last: tuple[tuple[bytes, float], Here] | None = None
        # The last point (z, q), g there, and slopes: of r by p and q (N,), and of g by (z, q) (N + 2,).
        self._slopes: tuple[np.ndarray, float, np.ndarray, np.ndarray, np.ndarray] | None = None
        self._age = 0
        own, other = self._view(q)
        self._map = self._doubling and isinstance(own, ShootingOrbits)
        marks = np.arange(1.0, y.size + 1.0)
        marks = np.asarray(own.twice(marks, other)) if self._doubling else marks
        rows = np.flatnonzero(np.round(marks))
        # Place of each unknown of y among those that A takes.
        self._places = rows[np.argsort(marks[rows])]
        own.prepare_at(p)
        other.prepare_at(p)
        U, _, Vt = np.linalg.svd(self._equations(y, p, q, smooth=True)[2])
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

    def prepare_at(self, q: float) -> None:
        """Make the equations exact again at the next point."""
        self._settle = True

    def _equations(
        self, y: np.ndarray, p: float, q: float, *, smooth: bool
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """r, its derivative by y, and A."""
        own, other = self._view(q)
        r, J = own.values(y, p, smooth=smooth)
        if other is not own:
            return r, J, other.values(np.asarray(own.twice(y, other)), p, smooth=smooth)[1]
        return r, J, self._of(J)

    def _of(self, J: np.ndarray) -> np.ndarray:
        """A from the derivative of its equations: the same, or the monodromy matrix plus one."""
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
        factors = la.lu_factor(full, check_finite=False)
        v = la.lu_solve(factors, right, check_finite=False)
        w = la.lu_solve(factors, right, trans=1, check_finite=False)
        return v[:n], w[:n], float(v[n])

    def _at(self, z: np.ndarray, q: float) -> Here:
        """What is known of a point; that of the last one is kept: a step of Newton's method ends where the next begins."""
        key = (z.tobytes(), q)
        if self._last is None or self._last[0] != key or self._settle:
            y = z[:-1]
            p = float(z[-1])
            if self._settle:
                for one in self._view(q):
                    one.prepare_at(p)
            r, J, A = self._equations(y, p, q, smooth=False)
            v, w, g = self._bordered(A)
            if self._settle:
                # Borders near to both null vectors keep the bordered matrix regular along the curve.
                self._c = v / np.linalg.norm(v)
                self._b = w / np.linalg.norm(w)
                v, w, g = self._bordered(A)
                self._settle = False
                self._age = 0
            self._last = (key, Here(r, J, v, w, g))
        return self._last[1]

    def residual(self, z: np.ndarray, q: float) -> np.ndarray:
        """[r, g]."""
        here = self._at(z, q)
        return np.append(here.r, here.g)

    def linear(self, z: np.ndarray, q: float) -> Linear:
        """[r, g] and its derivatives.

        Those in both parameters, and of g by y, cost four times as much as all else: they are made at each point of the
        curve, and on the way to the next the slope of g follows its own changes (Broyden's update).
        """
        here = self._at(z, q)
        now = np.append(here.r, here.g)
        at = np.append(z, q)
        self._age += 1
        if self._slopes is None or self._age <= _ANEW or self._age % _RENEWED == 0:
            in_p, in_q, slope = self._differences(z, q, here)
        else:
            then, g, in_p, in_q, slope = self._slopes
            moved = at - then
            slope = slope + (here.g - g - float(slope @ moved)) * moved / float(moved @ moved)
        self._slopes = (at, here.g, in_p, in_q, slope)
        full = np.vstack([np.column_stack([here.in_y, in_p]), slope[:-1]])
        return Linear(now, full, np.append(in_q, slope[-1]))

    def _differences(self, z: np.ndarray, q: float, here: Here) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Derivatives of r by p and q (N,), and of g by (y, p, q), by differences from one smooth base."""
        y = z[:-1]
        p = float(z[-1])
        own, other = self._view(q)
        r, _, A = self._equations(y, p, q, smooth=True)
        by_p = self._equations(y, p + _DIFFERENCE, q, smooth=True)
        by_q = self._equations(y, p, q + _DIFFERENCE, smooth=True)
        step = _ALONG / float(np.linalg.norm(here.v))
        full = y if other is own else np.asarray(own.twice(y, other))
        bent = self._of(other.values(full + step * here.v, p, smooth=True)[1])
        in_y = -(here.w @ (bent - A) / step)[self._places]
        ends = [-here.w @ ((one[2] - A) @ here.v) / _DIFFERENCE for one in (by_p, by_q)]
        return (by_p[0] - r) / _DIFFERENCE, (by_q[0] - r) / _DIFFERENCE, np.append(in_y, ends)
