"""How finely a forced response is meshed, and the modes that carry modal damping: both up to a frequency."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from rotorgear.analysis.common.discretise import cut_of
from rotorgear.analysis.common.request import FINEST
from rotorgear.analysis.modal.modal import ModalRequest, modes_about
from rotorgear.analysis.modal.refine import DEFAULT_ACCURACY, START
from rotorgear.analysis.modal.solve import Wanted, solve
from rotorgear.model.layout.spring import constant_spring
from rotorgear.model.layout.state import State
from rotorgear.model.model import Model
from rotorgear.results.modal import ModalResult
from rotorgear.system.plan import Plan
from rotorgear.system.system import System

# Up to this much above the highest excited frequency the mesh is refined.
MARGIN = 1.25
# Each further round for an accuracy of amplitudes refines the frequencies by this much more.
_TIGHTER = 0.03


def plan_up_to(model: Model, state: State, fmax: float, elements: int | None, accuracy: float | None) -> Plan:
    """The mesh that modes about a state need up to a frequency in Hz, or a fixed one."""
    if elements is not None:
        return Plan(elements)
    if not any(shaft.sections for shaft in model.shafts.values()):
        return Plan()
    asked = ModalRequest(fmax=fmax, accuracy=accuracy or DEFAULT_ACCURACY)
    return plan_of(modes_about(model, asked, state))


def aims(accuracy: float | None) -> Iterator[float | None]:
    """Accuracies of the frequencies to try, one after the other, for an accuracy of amplitudes.

    A light resonance turns a small error of its frequency into a large one of its height, by 1 / (2 zeta): how large is known
    from the amplitudes only.
    """
    yield accuracy
    if accuracy is not None:
        aim = accuracy * _TIGHTER
        while aim > FINEST:
            yield aim
            aim = aim * _TIGHTER


def plan_of(result: ModalResult) -> Plan:
    """The plan that a modal result was refined to."""
    return Plan(START.elements, START.order, cut_of(result.discretisation))


def at_speed(state: State, speed: float) -> State:
    """The conservative part of a state: bearings with tables as at a speed of the reference shaft in rad/s, no skew stiffness.

    Modes of this are real, so that a damping ratio can be given to each.

    Raises:
        AnalysisError: the speed lies outside a table.
    """
    changed = {}
    for address, spring in state.springs.items():
        stiffness, _ = state.spring_at(address, speed)
        if spring.varies or not np.array_equal(stiffness, stiffness.T):
            changed[address] = constant_spring(_conservative(stiffness), np.zeros((6, 6)))
    return replace(state, tangents={**state.tangents, **changed}) if changed else state


def _conservative(K: np.ndarray) -> np.ndarray:
    """The symmetric part of a stiffness, without directions in which it would push away: a light film has such."""
    values, directions = np.linalg.eigh(0.5 * (K + K.T))
    return np.asarray((directions * np.maximum(values, 0.0)) @ directions.T)


def damped_modes(
    system: System, limit: float, speed: float, dofs: np.ndarray | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Undamped modes up to a frequency in rad/s: shapes (n, m) of modal mass 1, and w (m,), 0 where rigid.

    They are those of the conservative part of the model at standstill, with bearings as at a speed of the reference shaft; where
    dofs are given, only of the groups that have one of these.
    """
    conservative = at_speed(system.state, speed)
    if conservative is not system.state:
        system = system.with_state(conservative)
    among = None if dofs is None else frozenset(dofs.tolist())
    found = solve(system, Wanted(None, None, limit if np.isfinite(limit) else None, dofs=among))
    keep = np.flatnonzero(found.vectors.any(axis=0))
    return np.real(found.vectors[:, keep]), np.where(found.rigid, 0.0, np.abs(found.eigenvalues))[keep]
