"""Errors of a coarse mesh from the modes of a finer one, where the estimate from each element by itself is too rough."""

from __future__ import annotations

from collections import Counter

import numpy as np

from rotorgear.analysis.modal.modes import Modes, Wanted
from rotorgear.analysis.modal.refine import HIGHEST_ORDER
from rotorgear.analysis.modal.solve import solve
from rotorgear.errors import AnalysisError
from rotorgear.system.plan import Plan
from rotorgear.system.system import System

# Neighbouring elements begin to act on each other's errors, and close modes to change places, from about here: below, the
# estimate from each element by itself was within a tenth of the error on all models, above it was off by up to a factor of two.
ROUGH = 1e-3
# Fewer elements than this in a piece may hide an error from the next orders, which then shows four orders up only.
_FEW_ELEMENTS = 4
_ROUGH_WITH_FEW = 1e-4
_LARGEST = 2000  # dofs up to which a second solution is worth its time


def enriched_errors(system: System, wanted: Wanted, found: Modes, estimate: np.ndarray) -> np.ndarray:
    """Estimated relative errors (m,): rough ones replaced by the difference from a mesh of four orders more.

    Args:
        system, wanted, found: the coarse mesh, what was asked of it, and its modes.
        estimate: their estimated relative errors (m,); where it is infinite it stays so.
    """
    pieces = Counter((shaft, e.piece) for shaft, elements in system.nodes.elements.items() for e in elements)
    limit = ROUGH if min(pieces.values(), default=0) >= _FEW_ELEMENTS else _ROUGH_WITH_FEW
    rough = ~found.rigid & np.isfinite(estimate) & (estimate > limit)
    if not rough.any() or system.n > _LARGEST:
        return estimate
    finer = system.with_plan(_much_finer(system))
    asked = Wanted(wanted.speed, len(found.eigenvalues), None, wanted.only, wanted.pruning)
    try:
        truth = solve(finer, asked)
    except AnalysisError:  # the coarse modes stand, with the estimate that they have
        return estimate
    count = min(len(truth.eigenvalues), len(estimate))
    if not np.array_equal(truth.rigid[:count], found.rigid[:count]):
        return estimate
    exact = truth.eigenvalues[:count]
    difference = np.zeros(len(estimate))
    difference[:count] = np.abs(found.eigenvalues[:count] - exact) / np.where(exact != 0.0, np.abs(exact), 1.0)
    return np.asarray(np.where(rough & (difference > 0.0), difference, estimate))


def _much_finer(system: System) -> Plan:
    """Four orders more in every piece, which catches what an even or odd shape hides from the next ones; else more elements."""
    cut = {}
    for shaft, elements in system.nodes.elements.items():
        lumped = system.model.shafts[shaft].mass_matrix == "lumped"
        for number in {element.piece for element in elements}:
            own = [element for element in elements if element.piece == number]
            order = own[0].order + 4
            raised = not lumped and order <= HIGHEST_ORDER
            cut[shaft, number] = (len(own), order) if raised else (4 * len(own), own[0].order)
    return Plan(system.plan.elements, system.plan.order, cut)
