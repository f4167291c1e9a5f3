"""Curves of folds and period doublings over two parameters, from the special points at the begin of the second range."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rotorgear.analysis.orbits.family import SystemFamily
from rotorgear.analysis.orbits.follow import AnyOrbits, Branch
from rotorgear.errors import ConvergenceError
from rotorgear.progress import Progress
from rotorgear.solvers.periodic.arclength import Node, Walk, at_value, walk
from rotorgear.solvers.periodic.curves import SpecialCurve
from rotorgear.solvers.periodic.samples import Cycle
from rotorgear.solvers.periodic.special import DOUBLING, FOLD

_FIRST_STEP = 0.01
# Distance of two points, in shares of both ranges, that are the same.
_SAME = 1e-4


@dataclass(frozen=True)
class Curve:
    """Special points of one kind over two parameters.

    `points` are shares p and q of both ranges and the motion there; `branch` and `periods` are those of the motions.
    """

    kind: str
    branch: int
    periods: int
    points: list[tuple[float, float, Cycle]]
    ended: str


def special_curves(branches: list[Branch], family: SystemFamily, plan: Walk, progress: Progress) -> list[Curve]:
    """Follow each fold and period doubling of the branches over the second range."""
    found: list[Curve] = []
    starts = [
        (number, branch, one)
        for number, branch in enumerate(branches)
        for one in branch.special
        if one.kind in (FOLD, DOUBLING)
    ]
    for count, (number, branch, one) in enumerate(starts):
        node = one.at.node
        # A curve that has come back to the begin of the second range ends at a point of a branch.
        ends = [curve.points[-1] for curve in found if curve.kind == one.kind and curve.points]
        if any(abs(q) < _SAME and abs(p - node.p) < _SAME for p, q, _ in ends):
            continue
        progress(0.8 + 0.15 * count / len(starts), f"curve of the {one.kind}")
        found.append(_followed(number, branch, one.kind, node, family, plan))
    return found


def _followed(number: int, branch: Branch, kind: str, node: Node, family: SystemFamily, plan: Walk) -> Curve:
    def orbits_at(q: float) -> AnyOrbits:
        return branch.orbits.along(lambda p: family.plant(p, q))

    equations = SpecialCurve(orbits_at, kind, node.y, node.p, 0.0)
    points: list[tuple[float, float, Cycle]] = []

    def heard(one: Node) -> bool:
        p = float(one.y[-1])
        if not 0.0 <= p <= 1.0:
            return False
        cycle = equations.orbits(one.p).cycle(one.y[:-1], p)
        points.append((p, one.p, cycle))
        return True

    try:
        start = at_value(equations, np.append(node.y, node.p), 0.0)
    except ConvergenceError as error:
        return Curve(kind, number, branch.periods, points, str(error))
    heard(start)
    _, ended = walk(equations, start, min(_FIRST_STEP, plan.longest), plan, heard)
    words = {
        "end": "the end of the second range",
        "stopped": "the end of the first range",
        "closed": "the curve closed",
        "most": f"{plan.most} points",
    }
    return Curve(kind, number, branch.periods, points, words.get(ended, ended))
