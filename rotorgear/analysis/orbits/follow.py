"""Branches of periodic motions: followed over the range, certified by their multipliers, with their special points.

Over a second parameter, curves of their folds and period doublings.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np

from rotorgear.analysis.common.stream import Piece, unkept
from rotorgear.analysis.orbits.family import Outputs, SystemFamily
from rotorgear.analysis.orbits.kept import AnyOrbits, packed, remembering, unpacked
from rotorgear.cpu import compiling_seconds, cpu_seconds
from rotorgear.errors import ConvergenceError
from rotorgear.progress import Progress
from rotorgear.results.orbits import SpecialCurve
from rotorgear.solvers.periodic.arclength import Node, Position, Walk, at_value, corrected, step_on, walk
from rotorgear.solvers.periodic.curves import SpecialCurve as CurveEquations
from rotorgear.solvers.periodic.samples import MotionCycle
from rotorgear.solvers.periodic.special import DOUBLING, FOLD, Certified, Special, kinds_between, located

# Points of a branch that are kept together.
STRETCH = 5
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


Measured = Callable[[list[Certified], float], None]


def _nobody(nodes: list[Certified], seconds: float) -> None:
    """Measure nothing."""


def certified(orbits: AnyOrbits, node: Node) -> Certified:
    """A solution with its multipliers."""
    return Certified(node, orbits.multipliers(node.y, node.p))


def followed(
    orbits: AnyOrbits,
    start: Certified,
    step: float,
    plan: Walk,
    name: str,
    periods: int,
    progress: Progress,
    begin: float,
    piece: Piece,
    *,
    both: bool = False,
    measured: Measured = _nobody,
) -> Branch:
    """Follow a branch from a solution, its tangent the way to go; `piece` does the work of a stretch, or takes it over."""
    nodes = [start]
    worked = 0

    def heard(p: float, new: int) -> None:
        nonlocal worked
        worked += 1
        progress(min(begin + 0.8 * abs(p), 0.95), f"{name}: {len(nodes) + new} points")

    def walked(start: Node) -> str:
        """Add the nodes behind a start; returns why there are no more."""
        at = Position(start, min(step, plan.longest))
        while not at.ended:
            before = worked
            used = cpu_seconds() - compiling_seconds()
            done = piece(partial(_stretch, orbits, start, at, plan, heard))
            new = unpacked(done)
            nodes.extend(new)
            if worked > before:
                measured(nodes, (cpu_seconds() - compiling_seconds() - used) / (worked - before))
            at = Position(new[-1].node if new else at.here, done["length"], at.count + len(new), done["ended"])
        return at.ended

    first = start.node
    if plan.low < first.p < plan.high and both:
        # From the middle of the range first back to where the branch comes in.
        walked(_turned(first))
        # The start has the tangent of the way forward already.
        nodes = [Certified(_turned(one.node), one.multipliers) for one in nodes[:0:-1]] + nodes[:1]
    ended = walked(first)
    special = [
        Special(kind, found, i)
        for i, (a, b) in enumerate(pairwise(nodes))
        for kind in kinds_between(a, b)
        for found in unpacked(piece(partial(_located, orbits, a, b, kind)))
    ]
    words = {"end": "the end of the range", "closed": "the branch closed", "most": f"{plan.most} points"}
    return Branch(orbits, name, periods, nodes, special, words.get(ended, ended))


def _stretch(
    orbits: AnyOrbits, start: Node, at: Position, plan: Walk, heard: Callable[[float, int], None]
) -> dict[str, Any]:
    """The next solutions of a branch, the length of the step behind them, and why it ended.

    `heard`: is told where each of them is, and how many there are.
    """
    found: list[Certified] = []
    while not at.ended and len(found) < STRETCH:
        at, there = step_on(orbits, start, at, plan)
        if there:
            found.append(certified(orbits, at.here))
            heard(at.here.p, len(found))
    return {**packed(found), "length": at.length, "ended": at.ended}


def _turned(node: Node) -> Node:
    return Node(node.z, -node.tangent, node.iterations)


def _located(orbits: AnyOrbits, a: Certified, b: Certified, kind: str) -> dict[str, Any]:
    found = located(orbits, a, b, kind)
    return packed([] if found is None else [found])


def main_branches(
    orbits: AnyOrbits,
    first: Certified,
    plan: Walk,
    progress: Progress,
    settled: Callable[[float], np.ndarray] | None = None,
    piece: Piece = unkept,
    measured: Measured = _nobody,
) -> list[Branch]:
    """The branch through a first solution; and those through other solutions at the ends of the range that it does not come to.

    Args:
        orbits: the equations. first: a solution. plan: how far to go. progress: is told where it is.
        settled: gives the unknowns of what a transient settles on at a value, for ends where Newton's method fails from rest.
        piece: does the work of a piece, or takes it over.
        measured: is told the solutions of the first branch so far, after each stretch, and the CPU seconds of one of its points.
    """
    found = [followed(orbits, first, _FIRST_STEP, plan, "1T", 1, progress, 0.05, piece, both=True, measured=measured)]

    def solution_at(end: float) -> dict[str, Any]:
        for begin in filter(None, (orbits.start, settled)):
            with suppress(ConvergenceError):
                node = at_value(orbits, begin(end), end, 1.0 if end == 0.0 else -1.0)
                return packed([certified(orbits, node)])
        return packed([])

    for end, name in ((0.0, "1T from the begin"), (1.0, "1T from the end")):
        for other in unpacked(piece(partial(solution_at, end))):
            same = _SAME * (1.0 + float(np.linalg.norm(other.node.z)))
            known = [one.node.z for branch in found for one in branch.nodes]
            if all(float(np.linalg.norm(z - other.node.z)) >= same for z in known):
                found.append(followed(orbits, other, _FIRST_STEP, plan, name, 1, progress, 0.1, piece))
    return found


def doubled_branches(branch: Branch, plan: Walk, progress: Progress, piece: Piece = unkept) -> list[Branch]:
    """The branches of twice the period that begin at the period doublings of a branch.

    Args:
        branch: the branch. plan: how far to go. progress: is told where it is.
        piece: does the work of a piece, or takes it over.
    """
    found: list[Branch] = []
    reached: list[float] = []
    periods = 2 * branch.periods
    for one in branch.special:
        if one.kind != DOUBLING or any(abs(one.at.node.p - p) < 1e-3 for p in reached):
            continue
        twice = branch.orbits.doubled()
        own = remembering(piece, twice)
        begun = own(partial(_behind_doubling, branch.orbits, twice, one.at.node))
        for first in unpacked(begun):
            found.append(followed(twice, first, begun["step"], plan, f"{periods}T", periods, progress, 0.5, own))
            # A branch from one doubling may end on the next one, where both motions of half the period meet again.
            reached += [two.at.node.p for two in found[-1].special]
    return found


def _behind_doubling(orbits: AnyOrbits, twice: AnyOrbits, node: Node) -> dict[str, Any]:
    """A motion of twice the period beside a period doubling, if it is found, and how long the step to it was."""
    y = orbits.twice(node.y, twice)  # type: ignore[arg-type]
    twice.prepare_at(node.p)
    J = twice.linear(y, node.p).in_y
    aside = np.append(np.linalg.svd(J)[2][-1], 0.0)
    for step in (_ASIDE, 0.25 * _ASIDE, 0.05 * _ASIDE):
        with suppress(ConvergenceError):
            first = corrected(twice, np.append(y, node.p) + step * aside, aside, aside)
            return {**packed([certified(twice, first)]), "step": step}
    return packed([])


def special_curves(
    branches: list[Branch],
    family: SystemFamily,
    outputs: Outputs,
    plan: Walk,
    progress: Progress,
    piece: Piece = unkept,
) -> tuple[SpecialCurve, ...]:
    """Follow each fold and period doubling of the branches over the second range; `piece` does a curve, or takes it over."""
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
        curve = piece(partial(_as_result, branches[number].orbits, one.kind, number, node, family, outputs, plan))
        ends += [(one.kind, p, q) for p, q in curve["end"].tolist()]
        found.append(curve["curve"])
    return tuple(found)


def _as_result(
    orbits: AnyOrbits, kind: str, number: int, node: Node, family: SystemFamily, outputs: Outputs, plan: Walk
) -> dict[str, Any]:
    """The curve that begins at a special point of a branch of a number, and shares of both ranges where it ends."""
    points, ended = _curve(orbits, kind, node, family, plan)
    extremes = [outputs.extremes(cycle) for _, _, cycle in points]
    curve = SpecialCurve(
        kind,
        number,
        np.array([family.ranges[0].at(p) for p, _, _ in points]),
        np.array([family.ranges[1].at(q) for _, q, _ in points]),
        np.array([cycle.period for _, _, cycle in points]),
        np.array([approach for approach, _ in extremes]),
        ended,
        np.array([moved for _, moved in extremes]),
    )
    return {"curve": curve, "end": np.array([(p, q) for p, q, _ in points[-1:]]).reshape(-1, 2)}


def _curve(
    orbits: AnyOrbits, kind: str, node: Node, family: SystemFamily, plan: Walk
) -> tuple[list[tuple[float, float, MotionCycle]], str]:
    """Points of the curve that begins at a special point, shares of both ranges and the motion there, and why it ended."""
    # What the branches asked for before changes no digit of a curve.
    own = orbits.apart()
    equations = CurveEquations(lambda q: own.along(lambda p: family.plant(p, q)), kind, node.y, node.p, 0.0)
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
    ended = walk(equations, start, _FIRST_STEP_OF_CURVE, plan, heard).ended
    words = {
        "end": "the end of the second range",
        "stopped": "the end of the first range",
        "closed": "the curve closed",
        "most": f"{plan.most} points",
    }
    return points, words.get(ended, ended)
