"""Pseudo-arc-length continuation of r(y, p) = 0, r and y (N,), through folds, with a line search.

Keller, in: Applications of Bifurcation Theory (Academic Press 1977) 359; Seydel, Practical Bifurcation and Stability Analysis
(Springer 2010), ch. 4. The parameter is scaled so that the range asked for is 0 to 1.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from rotorgear.errors import ConvergenceError

# Newton's method: iterations of one correction, halvings of its step, and the size of the last step that ends it.
_ITERATIONS = 14
_HALVINGS = 5
_ENOUGH = 1e-10
_ROUNDING = 1e-13
# Steps along the arc: iterations that lengthen and shorten the next one, largest turn of the tangent.
_FEW = 4
_MANY = 8
_LONGER = 1.5
_SHORTER = 0.6
_LEAST_COSINE = 0.85
_SHORTEST = 1e-6


@dataclass(frozen=True)
class Linear:
    """Residual (N,), its derivative by y (N, N) and by the parameter (N,)."""

    residual: np.ndarray
    in_y: np.ndarray
    in_p: np.ndarray


class Equations(Protocol):
    """Equations r(y, p) = 0."""

    def residual(self, y: np.ndarray, p: float) -> np.ndarray:
        """r (N,)."""

    def linear(self, y: np.ndarray, p: float) -> Linear:
        """r and its derivatives."""

    def prepare_at(self, p: float) -> None:
        """Make what is approximated between values exact at this one."""


@dataclass(frozen=True)
class Node:
    """A solution: z = (y, p) (N + 1,), its unit tangent (N + 1,), iterations that it took."""

    z: np.ndarray
    tangent: np.ndarray
    iterations: int

    @property
    def y(self) -> np.ndarray:
        """Unknowns (N,)."""
        return self.z[:-1]

    @property
    def p(self) -> float:
        """The parameter."""
        return float(self.z[-1])


def corrected(equations: Equations, guess: np.ndarray, normal: np.ndarray, tangent: np.ndarray) -> Node:
    """The solution in the plane through a guess z (N + 1,) with this normal; `tangent` gives the sense of the new one.

    Raises:
        ConvergenceError: Newton's method does not get there.
    """
    z = guess.copy()
    taken = 0
    for _ in range(4):
        z, done, iterations = _newton(equations, z, guess, normal)
        taken += iterations
        equations.prepare_at(float(z[-1]))
        if np.linalg.norm(equations.residual(z[:-1], float(z[-1]))) <= 10.0 * max(
            done, _ROUNDING * (1.0 + float(np.linalg.norm(z)))
        ):
            break
    else:
        raise ConvergenceError("the solution drifts between exact and approximate equations")
    now = equations.linear(z[:-1], float(z[-1]))
    return Node(z, tangent_of(now, tangent), taken)


def _newton(
    equations: Equations, z: np.ndarray, guess: np.ndarray, normal: np.ndarray
) -> tuple[np.ndarray, float, int]:
    """Newton's method in a plane; returns the solution, the size of its residual and the iterations."""
    last = np.inf
    for iteration in range(1, _ITERATIONS + 1):
        now = equations.linear(z[:-1], float(z[-1]))
        off = float(normal @ (z - guess))
        size = float(np.hypot(np.linalg.norm(now.residual), off))
        try:
            step = np.linalg.solve(_bordered(now, normal), np.append(now.residual, off))
        except np.linalg.LinAlgError:
            raise ConvergenceError("singular equations") from None
        length = float(np.linalg.norm(step))
        if not np.isfinite(length):
            raise ConvergenceError("not finite")
        share = 1.0
        best = None
        for _ in range(_HALVINGS):
            trial = z - share * step
            reached = float(np.linalg.norm(equations.residual(trial[:-1], float(trial[-1]))))
            reached = float(np.hypot(reached, normal @ (trial - guess)))
            if best is None or reached < best[0]:
                best = (reached, trial)
            if reached < (1.0 - 1e-4 * share) * size or length < 1e-9:
                break
            share *= 0.5
        assert best is not None
        z = best[1]
        scale = 1.0 + float(np.linalg.norm(z))
        if length <= _ENOUGH * scale or (best[0] <= _ROUNDING * scale):
            return z, best[0], iteration
        # Rounding of the equations: nothing gets better any more, and what is left is small.
        if best[0] >= 0.5 * last and length <= 1e-7 * scale:
            return z, best[0], iteration
        last = best[0]
    raise ConvergenceError(f"Newton's method did not converge in {_ITERATIONS} iterations")


def _bordered(now: Linear, row: np.ndarray) -> np.ndarray:
    """The derivatives of the equations, with a row below them, (N + 1, N + 1)."""
    return np.vstack([np.column_stack([now.in_y, now.in_p]), row])


def tangent_of(now: Linear, towards: np.ndarray) -> np.ndarray:
    """Unit tangent (N + 1,) at a solution, in the sense of `towards`."""
    right = np.zeros(towards.size)
    right[-1] = 1.0
    found = np.linalg.solve(_bordered(now, towards), right)
    return np.asarray(found / np.linalg.norm(found))


def at_value(equations: Equations, y: np.ndarray, p: float, sense: float = 1.0) -> Node:
    """The solution next to a guess y at one value of the parameter."""
    normal = np.zeros(y.size + 1)
    normal[-1] = sense
    equations.prepare_at(p)
    return corrected(equations, np.append(y, p), normal, normal)


@dataclass(frozen=True)
class Walk:
    """How far a walk goes: most points, the ends of the parameter, and the longest step.

    It is a share of the range, or of the size of the unknowns where these are larger than 1.
    """

    longest: float = 0.04
    most: int = 600
    low: float = 0.0
    high: float = 1.0


@dataclass(frozen=True)
class Position:
    """Where a walk is: its last node, the length of the next step, nodes behind the start, and why it ended, "" while it goes on.

    It ends with "end" where the range was left, "closed" where the branch came back, "stopped" where whoever hears of nodes says
    so, "most", or the reason of a failure.
    """

    here: Node
    length: float
    count: int = 0
    ended: str = ""


def step_on(equations: Equations, start: Node, at: Position, plan: Walk) -> tuple[Position, bool]:
    """Go to the next node of a branch; returns the position behind it, and whether there is a node.

    Args:
        equations: r(y, p). start: where the walk began. at: a position of it that goes on. plan: how far it goes.
    """
    here = at.here
    length = at.length
    longest = plan.longest * max(1.0, float(np.linalg.norm(here.y)))
    while True:
        guess = here.z + length * here.tangent
        try:
            found = corrected(equations, guess, here.tangent, here.tangent)
        except ConvergenceError as error:
            length *= 0.4
            if length < _SHORTEST:
                return replace(at, ended=str(error)), False
            continue
        turned = float(found.tangent @ here.tangent)
        if turned < _LEAST_COSINE and length > 100.0 * _SHORTEST:
            length *= 0.5
            continue
        if np.linalg.norm(found.z - here.z) <= 2.0 * length:
            break
        length *= 0.4
        if length < _SHORTEST:
            return replace(at, ended="the branch can't be followed any further"), False
    if outside := [edge for edge in (plan.low, plan.high) if (found.p - edge) * (here.p - edge) < 0.0]:
        last = _at_edge(equations, here, found, outside[0])
        if last is None:
            return replace(at, ended="the end of the range"), False
        return Position(last, length, at.count + 1, "end"), True
    count = at.count + 1
    back = np.linalg.norm(found.z - start.z) < 0.5 * length and count > 5
    ended = "closed" if back else "most" if count == plan.most else ""
    if found.iterations <= _FEW and turned > 0.97:
        length = min(_LONGER * length, longest)
    elif found.iterations >= _MANY:
        length *= _SHORTER
    return Position(found, length, count, ended), True


def _at_edge(equations: Equations, here: Node, found: Node, edge: float) -> Node | None:
    """The solution at the end of the range, between two nodes; None where it is not found."""
    share = (edge - here.p) / (found.p - here.p)
    try:
        last = at_value(equations, here.y + share * (found.y - here.y), edge)
    except ConvergenceError:
        return None
    ahead = float(np.dot(last.tangent, here.tangent)) >= 0.0
    return last if ahead else Node(last.z, -last.tangent, last.iterations)


def walk(equations: Equations, start: Node, step: float, plan: Walk, heard: Callable[[Node], bool]) -> Position:
    """Follow a branch from a solution until it leaves the range; returns the position where it ended.

    Args:
        equations: r(y, p). start: where to begin, its tangent the way to go. step: first length. plan: how far to go.
        heard: is told each node behind the start; False ends the walk.
    """
    at = Position(start, min(step, plan.longest))
    while not at.ended:
        at, there = step_on(equations, start, at, plan)
        if there and not heard(at.here) and at.ended != "end":
            at = replace(at, ended="stopped")
    return at
