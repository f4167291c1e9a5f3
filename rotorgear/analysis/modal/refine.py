"""Refines the mesh of the shafts until every requested frequency is estimated to be within the wanted accuracy.

Order first (the error falls exponentially), then twice the elements. Only pieces that bring a share of the error are refined:
a piece that no requested mode bends stays as it is.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import groupby
from operator import attrgetter

import numpy as np

from rotorgear.analysis.modal.solve import Modes, Wanted, solve
from rotorgear.errors import AnalysisError
from rotorgear.model.parts.carrier import MARK, written_name
from rotorgear.system.bubble_errors import bubble_errors
from rotorgear.system.plan import PieceKey, Plan
from rotorgear.system.system import System

DEFAULT_ACCURACY = 1e-3
# One element of this order a piece to start from: the basic element hardly ever does.
START = Plan(elements=1, order=2)
HIGHEST_ORDER = 10
_SPLIT_ORDER = 6
# The estimate is aimed at this share of the wanted accuracy, for its own uncertainty.
_AIM = 0.5
# Neighbouring elements begin to act on each other's errors, and close modes to change places, from about here: below, the
# estimate from each element by itself was within a tenth of the error on all models, above it was off by up to a factor of two.
ROUGH = 1e-3
# Fewer elements than this in a piece may hide an error from the next orders, which then shows four orders up only.
_FEW_ELEMENTS = 4
_ROUGH_WITH_FEW = 1e-4
_LARGEST = 2000  # dofs up to which a second solution is worth its time


def total_error(parts: dict[PieceKey, np.ndarray], modes: int) -> np.ndarray:
    """Estimated relative error of each mode, (m,)."""
    return np.asarray(sum(parts.values(), np.zeros(modes)))


def errors_of(
    system: System, speed: float | None, s: np.ndarray, x: np.ndarray, rigid: np.ndarray
) -> dict[PieceKey, np.ndarray]:
    """Estimated relative error by piece, (m,) each, zero for rigid modes, from free shapes x (n, m)."""
    elastic = ~rigid & (np.abs(s) > 0.0)
    found = bubble_errors(system, speed, s[elastic], x[:, elastic]) if elastic.any() else {}
    spread = {piece: np.zeros(len(s)) for piece in found}
    for piece, part in found.items():
        spread[piece][elastic] = part
    return spread


def refined(system: System, parts: dict[PieceKey, np.ndarray], accuracy: float) -> Plan | None:
    """Return a finer plan where some mode's error is above the accuracy; None where all are within."""
    if not parts:
        return None
    names = list(parts)
    table = np.array([parts[name] for name in names])  # (pieces, m)
    alike = _of_sisters(names)
    for pieces_of_all in alike:
        table[pieces_of_all] = table[pieces_of_all].mean(axis=0)
    aim = _AIM * accuracy
    if np.all(table.sum(axis=0) <= aim):
        return None
    chosen: set[int] = set()
    for mode in np.flatnonzero(~(table.sum(axis=0) <= aim)):
        # The largest contributions go until the rest is well inside the aim.
        ranked = np.argsort(-table[:, mode])
        left = np.cumsum(table[ranked, mode][::-1])[::-1]
        chosen |= {int(piece) for piece, rest in zip(ranked, left, strict=True) if rest > 0.5 * aim}
    for pieces_of_all in alike:
        chosen |= set(pieces_of_all) if chosen & set(pieces_of_all) else set()
    pieces = _pieces(system)
    finer = {names[k]: _finer(*pieces[names[k]], float(np.max(table[k])) / (aim / len(names))) for k in chosen}
    return replace(system.plan, cut={**system.plan.cut, **finer})


def _of_sisters(names: list[PieceKey]) -> list[list[int]]:
    """Numbers of the same piece of all planets, which stay equal: of two modes of one frequency each moves some of them more."""
    found: dict[PieceKey, list[int]] = {}
    for number, (shaft, piece) in enumerate(names):
        if MARK in shaft:
            found.setdefault((written_name(shaft), piece), []).append(number)
    return list(found.values())


def all_finer(system: System) -> Plan:
    """Return a plan with two orders more in every piece, for a mesh that has too few modes."""
    pieces = _pieces(system)
    return replace(system.plan, cut={piece: _finer(*pieces[piece], np.inf) for piece in pieces})


def _pieces(system: System) -> dict[PieceKey, tuple[int, int, bool]]:
    """Elements and order of each piece, and whether its mass is lumped, so that it has no other order."""
    found: dict[PieceKey, tuple[int, int, bool]] = {}
    for shaft, elements in system.nodes.elements.items():
        lumped = system.model.shafts[shaft].mass_matrix == "lumped"
        for number, own in groupby(elements, key=attrgetter("piece")):
            orders = [element.order for element in own]
            found[shaft, number] = (len(orders), orders[0], lumped)
    return found


def _finer(count: int, order: int, lumped: bool, excess: float) -> tuple[int, int]:
    """Elements and order for a piece of some elements of an order whose error is `excess` times its share."""
    if lumped:
        return 2 * count, order
    if not np.isfinite(excess):  # a mode is finer than the mesh: nothing to extrapolate from yet
        return (count, order + 2) if order < _SPLIT_ORDER - 2 else (2 * count, order)
    step = 1 if excess < 100.0 else (2 if excess < 1e5 else 3)
    if order + step <= HIGHEST_ORDER:
        return count, order + step
    return 2 * count, _SPLIT_ORDER


def enriched_errors(system: System, wanted: Wanted, found: Modes, estimate: np.ndarray) -> np.ndarray:
    """Estimated relative errors (m,): rough ones replaced by the difference from a mesh of four orders more.

    Args:
        system, wanted, found: the coarse mesh, what was asked of it, and its modes.
        estimate: their estimated relative errors (m,); where it is infinite it stays so.
    """
    pieces = _pieces(system)
    fewest = min((count for count, _, _ in pieces.values()), default=0)
    limit = ROUGH if fewest >= _FEW_ELEMENTS else _ROUGH_WITH_FEW
    rough = ~found.rigid & np.isfinite(estimate) & (estimate > limit)
    if not rough.any() or system.n > _LARGEST:
        return estimate
    # Four orders more in every piece catch what an even or odd shape hides from the next ones; else more elements.
    cut = {}
    for piece, (count, order, lumped) in pieces.items():
        raised = not lumped and order + 4 <= HIGHEST_ORDER
        cut[piece] = (count, order + 4) if raised else (4 * count, order)
    finer = system.with_plan(replace(system.plan, cut=cut))
    try:
        truth = solve(finer, replace(wanted, modes=len(found.eigenvalues), limit=None))
    except AnalysisError:  # the coarse modes stand, with the estimate that they have
        return estimate
    count = min(len(truth.eigenvalues), len(estimate))
    if not np.array_equal(truth.rigid[:count], found.rigid[:count]):
        return estimate
    exact = truth.eigenvalues[:count]
    difference = np.zeros(len(estimate))
    difference[:count] = np.abs(found.eigenvalues[:count] - exact) / np.where(exact != 0.0, np.abs(exact), 1.0)
    return np.asarray(np.where(rough & (difference > 0.0), difference, estimate))
