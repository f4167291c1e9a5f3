"""Branches of periodic motions: followed over the range, certified by their multipliers, with their special points.

Over a second parameter, curves of their folds and period doublings.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from rotorgear.analysis.orbits.family import Outputs, SystemFamily
from rotorgear.errors import ConvergenceError
from rotorgear.progress import Progress
from rotorgear.results.orbits import SpecialCurve
from rotorgear.solvers.periodic.arclength import Node, Walk, at_value, corrected, walk
from rotorgear.solvers.periodic.curves import SpecialCurve as CurveEquations
from rotorgear.solvers.periodic.harmonic_orbits import HarmonicOrbits
from rotorgear.solvers.periodic.samples import MotionCycle
from rotorgear.solvers.periodic.shooting import ShootingOrbits
from rotorgear.solvers.periodic.special import DOUBLING, FOLD, Certified, Special, kinds_between, located

AnyOrbits = HarmonicOrbits | ShootingOrbits
# First steps along a branch and along a curve.
_FIRST_STEP = 0.005
_FIRST_STEP_OF_CURVE = 0.01
# Length of the first step onto a branch of twice the period.
_ASIDE = 0.02
# Distance of two motions that are the same, of their unknowns; of two points of a curve, in shares of both ranges.
_SAME = 1e-4


@dataclass(frozen=True)
class Branch:
    """A branch: its equations, name, base periods, certified nodes, special points, and why it ended."""

    orbits: AnyOrbits
    name: str
    periods: int
    nodes: list[Certified]
    special: list[Special]
    ended: str


def followed(
    orbits: AnyOrbits,
    start: Node,
    step: float,
    plan: Walk,
    name: str,
    periods: int,
    progress: Progress,
    begin: float,
    *,
    both: bool = False,
) -> Branch:
    """Follow a branch from a solution, its tangent the way to go."""
    nodes: list[Certified] = []

    def heard(node: Node) -> bool:
        nodes.append(Certified(node, orbits.multipliers(node.y, node.p)))
        progress(min(begin + 0.8 * abs(node.p), 0.95), f"{name}: {len(nodes)} points")
        return True

    heard(start)
    if plan.low < start.p < plan.high and both:
        # From the middle of the range first back to where the branch comes in.
        walk(orbits, Node(start.z, -start.tangent, start.iterations), step, plan, heard)
        # The start has the tangent of the way forward already.
        backwards = [(Node(one.node.z, -one.node.tangent, one.node.iterations), one) for one in nodes[:0:-1]]
        nodes = [Certified(node, one.multipliers) for node, one in backwards] + nodes[:1]
    _, ended = walk(orbits, start, step, plan, heard)
    special = [
        Special(kind, found, i)
        for i, (a, b) in enumerate(pairwise(nodes))
        for kind in kinds_between(a, b)
        if (found := located(orbits, a, b, kind)) is not None
    ]
    words = {"end": "the end of the range", "closed": "the branch closed", "most": f"{plan.most} points"}
    return Branch(orbits, name, periods, nodes, special, words.get(ended, ended))


def main_branches(
    orbits: AnyOrbits,
    first: Node,
    plan: Walk,
    progress: Progress,
    settled: Callable[[float], np.ndarray] | None = None,
) -> list[Branch]:
    """The branch through a first solution; and those through other solutions at the ends of the range that it does not come to.

    Args:
        orbits: the equations. first: a solution. plan: how far to go. progress: is told where it is.
        settled: gives the unknowns of what a transient settles on at a value, for ends where Newton's method fails from rest.
    """
    found = [followed(orbits, first, _FIRST_STEP, plan, "1T", 1, progress, 0.05, both=True)]
    for end, name in ((0.0, "1T from the begin"), (1.0, "1T from the end")):
        for begin in filter(None, (orbits.start, settled)):
            try:
                other = at_value(orbits, begin(end), end, 1.0 if end == 0.0 else -1.0)
            except ConvergenceError:
                continue
            same = _SAME * (1.0 + float(np.linalg.norm(other.z)))
            known = [one.node.z for branch in found for one in branch.nodes]
            if all(float(np.linalg.norm(z - other.z)) >= same for z in known):
                found.append(followed(orbits, other, _FIRST_STEP, plan, name, 1, progress, 0.1))
            break
    return found


def doubled_branches(branch: Branch, plan: Walk, progress: Progress) -> list[Branch]:
    """The branches of twice the period that begin at the period doublings of a branch."""
    found: list[Branch] = []
    reached: list[float] = []
    for one in branch.special:
        if one.kind != DOUBLING or any(abs(one.at.node.p - p) < 1e-3 for p in reached):
            continue
        twice = branch.orbits.doubled()
        node = one.at.node
        y = branch.orbits.twice(node.y, twice)  # type: ignore[arg-type]
        twice.prepare_at(node.p)
        J = twice.linear(y, node.p).in_y
        aside = np.append(np.linalg.svd(J)[2][-1], 0.0)
        for step in (_ASIDE, 0.25 * _ASIDE, 0.05 * _ASIDE):
            try:
                first = corrected(twice, np.append(y, node.p) + step * aside, aside, aside)
            except ConvergenceError:
                continue
            periods = 2 * branch.periods
            found.append(followed(twice, first, step, plan, f"{periods}T", periods, progress, 0.5))
            # A branch from one doubling may end on the next one, where both motions of half the period meet again.
            reached += [two.at.node.p for two in found[-1].special]
            break
    return found


def special_curves(
    branches: list[Branch], family: SystemFamily, outputs: Outputs, plan: Walk, progress: Progress
) -> tuple[SpecialCurve, ...]:
    """Follow each fold and period doubling of the branches over the second range."""
    found: list[SpecialCurve] = []
    ends: list[tuple[str, float, float]] = []
    starts = [
        (number, one)
        for number, branch in enumerate(branches)
        for one in branch.special
        if one.kind in (FOLD, DOUBLING)
    ]
    for count, (number, one) in enumerate(starts):
        node = one.at.node
        # A curve that has come back to the begin of the second range ends at a point of a branch.
        if any(kind == one.kind and abs(q) < _SAME and abs(p - node.p) < _SAME for kind, p, q in ends):
            continue
        progress(0.8 + 0.15 * count / len(starts), f"curve of the {one.kind}")
        points, ended = _curve(branches[number].orbits, one.kind, node, family, plan)
        ends += [(one.kind, p, q) for p, q, _ in points[-1:]]
        extremes = [outputs.extremes(cycle) for _, _, cycle in points]
        found.append(
            SpecialCurve(
                one.kind,
                number,
                np.array([family.ranges[0].at(p) for p, _, _ in points]),
                np.array([family.ranges[1].at(q) for _, q, _ in points]),
                np.array([cycle.period for _, _, cycle in points]),
                np.array([approach for approach, _ in extremes]),
                ended,
                np.array([moved for _, moved in extremes]),
            )
        )
    return tuple(found)


def _curve(
    orbits: AnyOrbits, kind: str, node: Node, family: SystemFamily, plan: Walk
) -> tuple[list[tuple[float, float, MotionCycle]], str]:
    """Points of the curve that begins at a special point, shares of both ranges and the motion there, and why it ended."""
    equations = CurveEquations(lambda q: orbits.along(lambda p: family.plant(p, q)), kind, node.y, node.p, 0.0)
    points: list[tuple[float, float, MotionCycle]] = []

    def heard(one: Node) -> bool:
        p = float(one.y[-1])
        if not 0.0 <= p <= 1.0:
            return False
        points.append((p, one.p, equations.orbits(one.p).cycle(one.y[:-1], p)))
        return True

    try:
        start = at_value(equations, np.append(node.y, node.p), 0.0)
    except ConvergenceError as error:
        return points, str(error)
    heard(start)
    _, ended = walk(equations, start, min(_FIRST_STEP_OF_CURVE, plan.longest), plan, heard)
    words = {
        "end": "the end of the second range",
        "stopped": "the end of the first range",
        "closed": "the curve closed",
        "most": f"{plan.most} points",
    }
    return points, words.get(ended, ended)
