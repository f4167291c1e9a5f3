"""Whether a motion that repeats is stable: Newton's method onto the orbit and the multipliers of its map over a period.

An exponent from some hundred periods cannot see slow growth beside slow decay, nor what the symmetry of a start leaves out: one
that is symmetric in the two helices stays so, on an orbit where they grow apart by 1 part in 250 in a period, until rounding has
grown to its size. The map x -> P(x) over k common periods sees both. Its derivative M comes from central differences, which run
side by side; Newton's method x <- x - (M - 1)^-1 (P(x) - x) goes onto the orbit. Motions without strain are left out.
A run that spirals slowly onto an orbit of a shorter period looks like one of a longer period all the while, so the orbit itself
tells after how many periods it repeats.
Nor does a run with little damping say where it ends: after N periods exp(lambda N) of the start is left. The orbit is where it
ends, if the map is linear on the way there or the orbit is near.
Seydel, Practical Bifurcation and Stability Analysis (Springer 2010), ch. 7.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
import scipy.linalg as la

from rotorgear.analysis.sweep.classify import period_of
from rotorgear.solvers.batch.run_block import Start
from rotorgear.solvers.batch.small_system import SmallSystem

# Steps of the differences, over the size of the motion: rounding of a period leaves 1e-14 of it.
_STEP = 1e-5
_ITERATIONS = 6
# Newton's last step to the orbit, or P(x) - x where rounding makes that step, and how far from the run the orbit may lie, over
# the size of the motion. With multipliers near one P(x) - x is far less than the way to the orbit.
_CLOSED = 1e-5
_ROUNDING = 1e-11
_NEAR = 0.1
# What a step of Newton's method leaves of P(x) - x, over its length, where the map is linear along it.
_LINEAR = 1e-6
# ln|mu| of a period within which differences can't tell its sign.
SURE = 1e-4
# ln|mu| of a period that differences can tell from that of a motion without damping.
_DAMPED = 1e-7
# Distance of a run from its orbit, over the size of the motion, that counts as none.
ARRIVED = 1e-4
# How far along the most unstable direction a run begins anew, over the size of the motion.
_MOVED = 1e-2

# Where states are after a number of common periods.
Advance = Callable[[Sequence[Start], int], list[Start]]


class Certificate(NamedTuple):
    """The orbit of a run.

    Attributes:
        growth: ln|mu| of the largest multiplier in one common period.
        repeats: common periods after which the orbit repeats, a divisor of those of the map.
        onward: the state from which the run goes on: its end; the orbit, where that attracts it and is not reached yet; beside an
            unstable orbit, the end moved along the direction that grows most, unless it is further along it already.
        away: largest distance of the run from the orbit over the periods that count, over the size of the motion.
        jumped: whether the run goes on from the orbit.
    """

    growth: float
    repeats: int
    onward: Start
    away: float
    jumped: bool


def certificate(
    system: SmallSystem,
    end: Start,
    sizes: np.ndarray,
    periods: int,
    advance: Advance,
    tolerance: float,
    seen: np.ndarray | None = None,
    near: bool = True,
) -> Certificate | None:
    """The orbit of a number of common periods that a run goes to, with its multipliers.

    Args:
        system: the small system. end: where the run is.
        sizes: of the motion's counted displacements (c,) in m, peak to peak.
        periods: common periods after which the run repeats. advance: runs states.
        tolerance: share of its own size by which a displacement may differ that counts as the same.
        seen: displacements in m, and velocities in m per radian, of the run at its section up to its end, (p, 2, c).
        near: whether an orbit near by is the run's, however the map bends; else only one that a linear map leads to.

    Returns:
        None where Newton's method finds no such orbit, as where a contact only just closes.
    """
    n = system.n
    # Orthonormal states [z, z'] (2 n, s) without those of rigid motions.
    V = la.null_space(system.rigid) if len(system.rigid) else np.eye(n)
    U = la.block_diag(V, V)
    # z = L^T q: a displacement d = B^T z of that size.
    scale = float(sizes.max()) / float(np.linalg.norm(system.B, axis=0).max())
    begun = np.concatenate([end.z, end.dz])

    def after(states: Sequence[np.ndarray], length: int = periods) -> np.ndarray:
        ends = advance([Start(state[:n], state[n:]) for state in states], length)
        return np.stack([np.concatenate([one.z, one.dz]) for one in ends])

    def slope(at: np.ndarray) -> np.ndarray:
        h = _STEP * scale
        sides = after([at + sign * h * u for sign in (1.0, -1.0) for u in U.T])
        ahead, behind = np.split(sides, 2)
        return np.asarray(U.T @ (ahead - behind).T / (2.0 * h))

    M = slope(begun)
    x = _on_orbit(begun, M, U, scale, after, near)
    if x is None:
        return None
    if np.linalg.norm(x - begun) > _STEP * scale:
        M = slope(x)
        if not np.all(np.isfinite(M)):
            return None
    mu, left, right = la.eig(M, left=True)
    most = int(np.argmax(np.abs(mu)))
    growth = float(np.log(max(abs(mu[most]), 1e-300))) / periods
    # After how many common periods the orbit repeats is told as of a run (classify.py), from a section of its own.
    counted = system.B[:, system.columns.counted].T
    states = [x]
    for _ in range(periods - 1):
        states.append(after([states[-1]], 1)[0])
    section = np.array([state.reshape(2, n) @ counted.T for state in states])
    repeats = period_of(np.tile(section[:, 0], (3, 1)), sizes, tolerance) or periods
    away = float(np.linalg.norm(U.T @ (begun - x))) / scale
    if seen is not None and len(seen):
        phases = -np.arange(len(seen))[::-1] % periods
        away = max(away, float((np.abs(seen - section[phases]) / sizes).max()))
    if growth < SURE:
        jumped = away > ARRIVED and growth < -_DAMPED
        return Certificate(growth, repeats, Start(x[:n], x[n:]) if jumped else end, away, jumped)
    # Slow motions may still be far from the orbit; only what lies along the direction of growth counts.
    along = right[:, most]
    beside = abs(np.vdot(left[:, most], U.T @ (begun - x)) / np.vdot(left[:, most], along)) * np.linalg.norm(
        np.real(along)
    )
    if beside < _MOVED * scale:
        direction = U @ np.real(along)
        begun = begun + _MOVED * scale * direction / np.linalg.norm(direction)
    return Certificate(growth, repeats, Start(begun[:n], begun[n:]), away, False)


def _on_orbit(
    begun: np.ndarray,
    M: np.ndarray,
    U: np.ndarray,
    scale: float,
    after: Callable[[Sequence[np.ndarray]], np.ndarray],
    near: bool,
) -> np.ndarray | None:
    """The state (2 n,) of the orbit of another one; None where Newton's method finds none, or one that may be another's.

    It is the orbit of that state where it is near by, or where the first step, from afar, has left nothing: the map is linear.
    """
    if not np.all(np.isfinite(M)):
        return None
    x = begun
    linear = False
    moved = np.zeros(len(M))
    for number in range(_ITERATIONS):
        left = U.T @ (after([x])[0] - x)
        if not np.all(np.isfinite(left)):
            return None
        if number == 1:
            linear = bool(np.linalg.norm(left) <= _LINEAR * np.linalg.norm(moved) + _ROUNDING * scale)
        beside = near and np.linalg.norm(x - begun) <= _NEAR * scale * np.sqrt(len(x))
        if number and not (linear or beside):
            return None
        if np.linalg.norm(left) < _ROUNDING * scale:
            return x
        moved = np.linalg.lstsq(M - np.eye(len(M)), left, rcond=None)[0]
        x = x - U @ moved
        if np.linalg.norm(moved) < _CLOSED * scale:
            return x
    return None
