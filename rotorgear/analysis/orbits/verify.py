"""Transients that start on an orbit: how far they leave it, and how fast a small deviation grows or dies out.

A transient on an unstable orbit is soon too far from it to tell its multipliers. So each period starts on the orbit again, with
the deviation that the last one ended with, made small: the power method on the transient's own map over a period.

Where a branch begins: Newton's method from the static state, or from the end of a transient.
"""

from __future__ import annotations

from functools import partial
from itertools import groupby
from typing import Any

import numpy as np

from rotorgear.analysis.common.stream import Piece, unkept
from rotorgear.analysis.orbits.family import SystemFamily
from rotorgear.analysis.orbits.follow import Branch
from rotorgear.analysis.orbits.kept import AnyOrbits, remembering
from rotorgear.errors import AnalysisError, ConvergenceError
from rotorgear.progress import Progress
from rotorgear.results.orbits import OrbitVerification
from rotorgear.solvers.periodic.arclength import Node, at_value
from rotorgear.solvers.periodic.harmonic_orbits import HarmonicOrbits
from rotorgear.solvers.periodic.plant import Plant
from rotorgear.solvers.periodic.special import Certified
from rotorgear.solvers.time.contact_equilibrium import equilibrium
from rotorgear.solvers.time.exponential import Exponential
from rotorgear.solvers.time.local_system import LocalSystem, MotionState, Records, state_at_rest
from rotorgear.solvers.time.newmark import Newmark
from rotorgear.solvers.time.run import Schedule, run

# Shares of the range at which a branch may begin.
_PLACES = (0.0, 1.0, 0.5, 0.75, 0.25)
# Base periods of the transient that a branch may begin from, and its steps in each.
_SETTLE = 400
_RUN_STEPS = 400
_MOST_DENSE = 400


def run_periods(
    system: LocalSystem, order: float, periods: int, q: np.ndarray, v: np.ndarray, steps: int = _RUN_STEPS
) -> tuple[MotionState, np.ndarray]:
    """Run over base periods from a motion: the state at the end, and local displacements at all steps (r, m)."""
    T = 2.0 * np.pi / (order * abs(float(system.rotation.speeds[0])))
    h = T / steps
    state = state_at_rest(system, h, q, v)
    found: list[np.ndarray] = []

    def keep(records: Records, _: MotionState) -> None:
        found.append(records.d)

    # The exponential method where all modes are cheap.
    cheap = system.n <= _MOST_DENSE and np.all(system.M.diagonal() > 0.0)
    run(system, Exponential() if cheap else Newmark(), Schedule(h, periods * steps, 1), state, keep)
    return state, np.concatenate(found)


def first_node(orbits: AnyOrbits, family: SystemFamily, *, from_transient: bool, progress: Progress) -> Node:
    """A solution at the begin of the range, or else at another value, by Newton's method or a transient.

    Raises:
        AnalysisError: no way leads to a periodic motion.
    """
    ways = [(p, False) for p in _PLACES if not from_transient] + [(p, True) for p in _PLACES]
    why = ""
    for p, settling in ways:
        try:
            y = settled(orbits, family, p, progress) if settling else orbits.start(p)
            return at_value(orbits, y, p, -1.0 if p == 1.0 else 1.0)
        except ConvergenceError as error:
            why = str(error)
    raise AnalysisError(
        f"no periodic motion was found in the range ({why}): neither from the static state nor by transients of {_SETTLE} "
        "periods; try another range"
    )


def settled(orbits: AnyOrbits, family: SystemFamily, p: float, progress: Progress) -> np.ndarray:
    """Unknowns of the motion at the end of a transient from rest."""
    progress(0.02, "settling by a transient")
    system = family.system(family.shares_at(p))
    state, d = run_periods(system, family.order, _SETTLE, equilibrium(system).q, np.zeros(system.n))
    if isinstance(orbits, HarmonicOrbits):
        # The records begin one step behind the begin of a period.
        return orbits.from_samples(np.roll(d[-_RUN_STEPS:], 1, axis=0))
    return orbits.from_motion(state.q, state.v, family.plant(p))


# Stretches of a branch that are looked at, the first ones.
_STRETCHES = 6
_PERIODS = 36
_STEPS = 4000
# Size of the deviation at the begin of each period, over the peak to peak: contacts then close a step earlier or later.
_DEVIATION = 1e-4
# The growth is that of the last periods, in which the other multipliers have died out.
_LAST = 18
_OTHERS = 3e-3


def verified(
    branches: list[Branch], family: SystemFamily, column: np.ndarray, piece: Piece = unkept
) -> tuple[OrbitVerification, ...]:
    """Start transients on a motion of each stretch of the branches, in its middle.

    Args:
        branches: the branches. family: of the systems on them. column: displacements that are compared.
        piece: does the transients of a motion, or takes them over.
    """
    checks = []
    for branch in branches:
        own = remembering(piece, branch.orbits)
        stretches = [list(stretch) for _, stretch in groupby(branch.nodes, key=lambda one: one.stable)]
        middles = [stretch[len(stretch) // 2] for stretch in stretches[:_STRETCHES]]
        checks += [own(partial(_verified, branch, one, family, column))["check"] for one in middles]
    return tuple(checks)


def _verified(branch: Branch, one: Certified, family: SystemFamily, column: np.ndarray) -> dict[str, Any]:
    orbits = branch.orbits
    node = one.node
    system = family.system(family.shares_at(node.p))
    plant = family.plant(node.p)
    # The motion at the begin of its period.
    q, v = orbits.state(node.y, node.p)
    cycle = orbits.cycle(node.y, node.p)
    size = float(np.ptp(cycle.extremes()[column], axis=1).max(initial=0.0)) or 1.0
    k = branch.periods
    exact = cycle.at.d[:, column]
    # Steps so that every instant of the orbit is the end of one.
    each = int(np.ceil(_STEPS * k / len(exact)))
    steps = each * len(exact) // k

    def period_from(q: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        state, d = run_periods(system, family.order, k, q, v, steps)
        return state.q, state.v, d[:, column]

    end_q, end_v, after_one = period_from(q, v)
    # Records are those of the ends of steps: the period is rows 0 to the last.
    orbit = np.vstack([after_one[-1:], after_one[:-1]])
    deviation = float(np.abs(orbit[::each][1:] - exact[1:]).max() / size)
    deviation = max(deviation, float(np.abs(after_one[-1] - (plant.B.T @ q)[column]).max() / size))
    direction = plant.static.X @ np.ones(plant.m)
    moved = float(np.abs((plant.B.T @ direction)[column]).max(initial=0.0)) or 1.0
    dq = direction * (_DEVIATION * size / moved)
    dv = np.zeros(q.size)
    waves: list[np.ndarray] = []
    shares: list[float] = []
    for _ in range(_PERIODS):
        other_q, other_v, other = period_from(q + dq, v + dv)
        waves.append((other - after_one).ravel())
        away = float(np.abs(waves[-1]).max()) / size
        if not 0.0 < away < np.inf:
            break
        shares.append(_DEVIATION / away)
        # Motions without strain neither grow nor move the contacts.
        dq = shares[-1] * _strained(plant, other_q - end_q)
        dv = shares[-1] * _strained(plant, other_v - end_v)
    expected = float(np.abs(one.multipliers[0]))
    value = family.ranges[0].at(node.p)
    return {"check": OrbitVerification(value, one.stable, deviation, _growth(waves, shares), expected, _PERIODS * k)}


def _growth(waves: list[np.ndarray], shares: list[float]) -> float:
    """Modulus of the multipliers that deviations (r,) of one period after the other show; each begins as a share of the last end.

    Where one pair outlasts all others, A^2 w = a A w + b w for all deviations w: a real multiplier or both of a complex pair are
    roots of x^2 = a x + b.
    """
    last = range(max(len(shares) - _LAST, 0), len(shares) - 2)
    if not last:
        return float("nan")
    here, once, twice = (
        np.concatenate([waves[j + ahead] / np.prod(shares[j : j + ahead]) / np.abs(waves[j]).max() for j in last])
        for ahead in range(3)
    )
    # What is left of other multipliers, and of powers of the deviation, is no second direction.
    a, b = np.linalg.lstsq(np.column_stack([once, here]), twice, rcond=_OTHERS)[0]
    return float(np.abs(np.roots([1.0, -a, -b])).max())


def _strained(plant: Plant, q: np.ndarray) -> np.ndarray:
    """Displacements or velocities (n,) without their part in motions that strain nothing."""
    return np.asarray(q - plant.free @ (plant.free.T @ (plant.M @ q)))
