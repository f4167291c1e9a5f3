"""How finely a forced response is meshed, and the modes that carry modal damping: both up to a frequency."""

from __future__ import annotations

import numpy as np

from rotorgear.analysis.modal import modal
from rotorgear.analysis.modal_solve import solve
from rotorgear.analysis.modes import Wanted
from rotorgear.analysis.refine import DEFAULT_ACCURACY, START
from rotorgear.model.model import Model
from rotorgear.results.modal import ModalResult
from rotorgear.system.plan import Plan
from rotorgear.system.system import System

# Modes are found, and the mesh is refined for them, up to this much above the highest excited frequency.
MARGIN = 1.25


def plan_up_to(model: Model, fmax: float, elements: int | None, accuracy: float | None) -> Plan:
    """The mesh that modes up to a frequency in Hz need, or a fixed one."""
    if elements is not None:
        return Plan(elements)
    if not any(shaft.sections for shaft in model.shafts.values()):
        return Plan()
    found = modal(model, fmax=fmax, accuracy=accuracy or DEFAULT_ACCURACY)
    return plan_of(found)


def plan_of(result: ModalResult) -> Plan:
    """The plan that a modal result was refined to."""
    number: dict[str, int] = {}
    cut = {}
    for piece in result.discretisation:
        k = number[piece.shaft] = number.get(piece.shaft, -1) + 1
        cut[piece.shaft, k] = (piece.elements, piece.order)
    return Plan(START.elements, START.order, cut)


def damped_modes(system: System, limit: float) -> tuple[np.ndarray, np.ndarray]:
    """Undamped modes at standstill up to a frequency in rad/s: shapes (n, m) of modal mass 1, and w (m,), 0 where rigid."""
    found = solve(system, Wanted(None, None, limit))
    keep = np.flatnonzero(found.vectors.any(axis=0))
    return np.real(found.vectors[:, keep]), np.where(found.rigid, 0.0, np.abs(found.eigenvalues))[keep]
