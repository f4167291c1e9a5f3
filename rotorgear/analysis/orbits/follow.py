"""Branches of periodic motions: followed over the range, certified by their multipliers, with their special points."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from rotorgear.errors import ConvergenceError
from rotorgear.progress import Progress
from rotorgear.solvers.periodic.arclength import Node, Walk, at_value, corrected, walk
from rotorgear.solvers.periodic.harmonic_orbits import HarmonicOrbits
from rotorgear.solvers.periodic.shooting import ShootingOrbits
from rotorgear.solvers.periodic.special import DOUBLING, Certified, Special, kinds_between, located

AnyOrbits = HarmonicOrbits | ShootingOrbits
_FIRST_STEP = 0.005
# Length of the first step onto a branch of twice the period.
_ASIDE = 0.02
# Distance of two motions that are the same, of their unknowns.
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


def certified(orbits: AnyOrbits, node: Node) -> Certified:
    """A solution with its multipliers."""
    return Certified(node, orbits.multipliers(node.y, node.p))


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
    nodes = [certified(orbits, start)]

    def heard(node: Node) -> bool:
        nodes.append(certified(orbits, node))
        progress(min(begin + 0.8 * abs(node.p), 0.95), f"{name}: {len(nodes)} points")
        return True

    if plan.low < start.p < plan.high and both:
        # From the middle of the range first back to where the branch comes in.
        walk(orbits, Node(start.z, -start.tangent, start.iterations), step, plan, heard)
        # The start has the tangent of the way forward already.
        backwards = [(Node(one.node.z, -one.node.tangent, one.node.iterations), one) for one in nodes[:0:-1]]
        nodes = [Certified(node, one.multipliers) for node, one in backwards] + nodes[:1]
    _, ended = walk(orbits, start, step, plan, heard)
    special = []
    for i, (a, b) in enumerate(pairwise(nodes)):
        for kind in kinds_between(a, b):
            found = located(orbits, a, b, kind)
            if found is not None:
                special.append(Special(kind, found, i))
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
        other = None
        for begin in (orbits.start, settled):
            try:
                if begin is not None:
                    other = at_value(orbits, begin(end), end, 1.0 if end == 0.0 else -1.0)
                    break
            except ConvergenceError:
                continue
        if other is None:
            continue
        same = _SAME * (1.0 + float(np.linalg.norm(other.z)))
        known = [one.node.z for branch in found for one in branch.nodes]
        if all(float(np.linalg.norm(z - other.z)) >= same for z in known):
            found.append(followed(orbits, other, _FIRST_STEP, plan, name, 1, progress, 0.1))
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
            name = f"{2 * branch.periods}T"
            own = followed(twice, first, step, plan, name, 2 * branch.periods, progress, 0.5)
            found.append(own)
            # A branch from one doubling may end on the next one, where both motions of half the period meet again.
            reached += [two.at.node.p for two in own.special]
            break
    return found
