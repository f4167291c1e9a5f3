"""Branches and their special points of equations in closed form: y^3 - .3 y = p - .5 and multipliers that are given."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from rotorgear.analysis.common.stream import unkept
from rotorgear.analysis.orbits.follow import Branch, certified, followed, main_branches
from rotorgear.errors import ConvergenceError
from rotorgear.progress import silent
from rotorgear.solvers.periodic.arclength import Linear, Node, Walk, at_value
from rotorgear.solvers.periodic.special import DOUBLING, FOLD, NEIMARK_SACKER, Certified, located

Multipliers = Callable[[float, float], list[complex]]


@dataclass(frozen=True)
class Cubic:
    """r = p - .5 - y^3 + a y, folds at y = -+sqrt(a/3) for a > 0, with multipliers of (y, p)."""

    a: float
    given: Multipliers

    def residual(self, y: np.ndarray, p: float) -> np.ndarray:
        return p - 0.5 - y**3 + self.a * y

    def linear(self, y: np.ndarray, p: float) -> Linear:
        return Linear(self.residual(y, p), np.diag(self.a - 3.0 * y**2), np.ones(1))

    def prepare_at(self, p: float) -> None:
        pass

    def multipliers(self, y: np.ndarray, p: float) -> np.ndarray:
        return np.array(self.given(float(y[0]), p), complex)


def _branch(equations: Any, y: float, p: float) -> Branch:
    start = certified(equations, at_value(equations, np.array([y]), p))
    return followed(equations, start, 0.01, Walk(longest=0.1), "1T", 1, silent, 0.0, unkept, both=True)


@pytest.mark.parametrize(("y", "p"), [(-0.94, 0.0), (0.0, 0.5), (0.65, 0.6)])
def test_folds_of_a_branch_are_those_of_its_equations_wherever_it_begins(y: float, p: float) -> None:
    branch = _branch(Cubic(0.3, lambda y, p: [1.15 - 1.5 * y**2]), y, p)
    assert {one.kind for one in branch.special} == {FOLD}
    height = 0.2 * np.sqrt(0.1)
    assert sorted(one.at.node.p for one in branch.special) == pytest.approx([0.5 - height, 0.5 + height], abs=1e-9)
    along = [a.node.tangent @ (b.node.z - a.node.z) for a, b in pairwise(branch.nodes)]
    assert min(along) > 0.0


def test_doublings_and_neimark_sacker_points_lie_where_multipliers_cross_the_circle() -> None:
    doubling = _branch(Cubic(-1.0, lambda y, p: [-0.7 - p]), -0.4, 0.0)
    assert [(one.kind, one.at.node.p) for one in doubling.special] == [(DOUBLING, pytest.approx(0.3, abs=1e-8))]
    pair = _branch(Cubic(-1.0, lambda y, p: [(0.4 + p) * np.exp(1j), (0.4 + p) * np.exp(-1j)]), -0.4, 0.0)
    assert [(one.kind, one.at.node.p) for one in pair.special] == [(NEIMARK_SACKER, pytest.approx(0.6, abs=1e-8))]


def test_a_test_function_that_does_not_cross_zero_has_no_special_point() -> None:
    equations = Cubic(-1.0, lambda y, p: [0.5])
    nodes = [at_value(equations, np.zeros(1), p) for p in (0.4, 0.6)]
    a, b = (Certified(node, equations.multipliers(node.y, node.p)) for node in nodes)
    turned = Certified(Node(b.node.z, -b.node.tangent, 1), b.multipliers)
    for kind in (FOLD, DOUBLING, NEIMARK_SACKER):
        assert located(equations, a, turned, kind) is None


def test_a_pair_that_comes_into_being_outside_the_circle_has_not_crossed_it() -> None:
    equations = Cubic(-1.0, lambda y, p: [0.5, 0.5] if p < 0.5 else [1.2 * np.exp(1j), 1.2 * np.exp(-1j)])
    assert not _branch(equations, -0.4, 0.0).special


@dataclass(frozen=True)
class Apart:
    """r = y (p - .6 - (y - 1)^2): y = 0 over the whole range, and beside it a branch that comes in and goes out at its end."""

    at_rest: float | None

    def start(self, p: float) -> np.ndarray:
        if p == 1.0 and self.at_rest is None:
            raise ConvergenceError("nothing near rest")
        return np.array([self.at_rest if p == 1.0 and self.at_rest is not None else 0.0])

    def residual(self, y: np.ndarray, p: float) -> np.ndarray:
        return y * (p - 0.6 - (y - 1.0) ** 2)

    def linear(self, y: np.ndarray, p: float) -> Linear:
        return Linear(self.residual(y, p), np.diag(p - 0.6 - (y - 1.0) ** 2 - 2.0 * y * (y - 1.0)), y)

    def prepare_at(self, p: float) -> None:
        pass

    def multipliers(self, y: np.ndarray, p: float) -> np.ndarray:
        return np.array([0.5], complex)


@pytest.mark.parametrize(("at_rest", "count"), [(0.0, 1), (1.6, 2), (None, 2)])
def test_a_branch_that_comes_in_at_the_other_end_is_followed_too(at_rest: float | None, count: int) -> None:
    equations: Any = Apart(at_rest)
    first = certified(equations, at_value(equations, np.zeros(1), 0.0))
    found = main_branches(equations, first, Walk(longest=0.1), silent, lambda p: np.array([1.6]))
    assert [branch.name for branch in found] == ["1T", "1T from the end"][:count]
    assert [branch.ended for branch in found] == ["the end of the range"] * count
    assert [one.at.node.p for one in found[-1].special] == ([pytest.approx(0.6, abs=1e-9)] if count == 2 else [])
