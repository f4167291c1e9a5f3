"""The state that linear analyses are about: what laws, faces and loaded teeth are in the static equilibrium at some speeds.

A nonlinear element, or a bearing given by its rolling elements alone, has the stiffness dF/dd and the damping dF/dv of its law
at the static equilibrium under the loads, at rest but for the rotation. What does not depend on speed becomes one stiffness; what
does, such as the film of a journal bearing, a table over speed. Meshes have the stiffness of their mean load: the tangent at that
load where a stiffness model knows it; loaded teeth their mean tangent over the mesh cycle, all contacts of the gearbox in
equilibrium together (`about_equilibrium.py`); those that feel the tilt of their shafts are about the load along their faces.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from rotorgear.model.layout.spring import Spring, constant_spring, given_spring
from rotorgear.model.layout.state import State
from rotorgear.model.model import Model
from rotorgear.model.parts.fields import DOF_NAMES
from rotorgear.model.parts.supports import Bearing, NonlinearElement
from rotorgear.system.plan import Plan
from rotorgear.system.system import System, flow_system

if TYPE_CHECKING:
    from rotorgear.analysis.static.solve import LawState

# Tangents that change less over speed are one stiffness.
_CONSTANT = 1e-9


def state_at(
    model: Model,
    speeds: Sequence[float | None],
    *,
    direction: int | None = None,
    near: Sequence[LawState] = (),
    beside: State | None = None,
    springs: Mapping[str, Spring] | None = None,
) -> State:
    """Return the state about the static equilibrium, found once; `operating` has the laws that are linear about it.

    Of a model without parts that an equilibrium decides about it is that of the torque flow.

    Args:
        model: a checked model.
        speeds: of the reference shaft in rad/s, of one sense, at which tangents are taken; None is standstill, where
            films have none, so that the operating speed serves.
        direction: +1 or -1, sense about +z in which the reference shaft turns; None: that of the speeds, else of the model.
        near: the laws in a known equilibrium near the first of them, from which it is looked for.
        beside: a state of a model next to this one, whose face maps serve as long as this state lies among their misalignments.
            They take nearly all the time of an equilibrium. And a map is known to a few thousandths of its tangents only: were
            each model on a map of its own, the difference of two would be wrong by as much.
        springs: address -> what takes the place of a bearing in the equilibrium and about it.

    Raises:
        AnalysisError: there is no equilibrium at one of the speeds.
    """
    sense = direction or sense_of(speeds) or model.layout.direction
    mapped_at = beside.shared_maps if beside else {}
    if springs:
        return _state_at(model, speeds, replace(model.torque_flow(sense), tangents=springs, mapped_at=mapped_at), near)
    key = (tuple(speeds), sense, tuple(sorted(mapped_at.items())))
    if key not in model.states:
        flow = model.torque_flow(sense)
        model.states[key] = _state_at(model, speeds, replace(flow, mapped_at=mapped_at) if mapped_at else flow, near)
    return model.states[key]


def linear_system(
    model: Model | System,
    speeds: Sequence[float | None],
    plan: Plan | None = None,
    *,
    state: State | None = None,
    beside: State | None = None,
) -> System:
    """The linear system of a model about its equilibrium at some speeds, as `state_at` has them, on the mesh of a plan.

    `state` is the one about that equilibrium where it is known already. A system that is assembled keeps its mesh, and the state
    that it is about where an equilibrium found that; its torque flow is that of the sense of the speeds.
    """
    if not isinstance(model, System):
        return System(model, plan=plan, state=state or state_at(model, speeds, beside=beside))
    if not model.state.is_flow:
        return model
    sense = sense_of(speeds)
    if sense and sense != model.direction:
        model = model.with_state(model.model.torque_flow(sense))
    found = state_at(model.model, speeds, direction=model.direction)
    if found.is_flow and not found.notes:
        return model
    # Its own flanks and forces stay where the equilibrium says nothing of the meshes.
    if not (found.faces or found.cycle):
        found = replace(model.state, tangents=found.tangents, operating=found.operating, notes=found.notes)
    return model.with_state(found)


def sense_of(speeds: Sequence[float | None]) -> int:
    """+1 or -1, the sense about +z of speeds of the reference shaft in rad/s; 0 where none of them turns it."""
    return int(np.sign(min((speed for speed in speeds if speed), key=abs, default=0.0)))


def _state_at(model: Model, speeds: Sequence[float | None], state: State, near: Sequence[LawState]) -> State:
    """The state about the equilibrium, from that of the torque flow."""
    laws: dict[str, Bearing | NonlinearElement] = {
        f"bearings.{name}": bearing for name, bearing in model.bearings.items() if not bearing.is_linear
    }
    laws |= {f"nonlinear_elements.{name}": one for name, one in model.nonlinear_elements.items() if not one.is_given}
    wanted = sorted(laws.keys() - state.tangents.keys())
    # Most models have none of these parts: what finds an equilibrium is loaded for the others only.
    if any(mesh.tilt for mesh in model.meshes.values()):
        from rotorgear.analysis.static.about_equilibrium import along_faces

        state = along_faces(model, speeds, state)
    if any(mesh.stiffness == "tooth_fe" for mesh in model.meshes.values()):
        from rotorgear.analysis.static.about_equilibrium import about_cycle

        state = about_cycle(model, speeds, state)
    if not wanted:
        return state
    from rotorgear.analysis.static.solve import equilibrate

    running = state.direction * abs(model.operating_speed or 0.0)
    at = sorted({running if speed is None else float(speed) for speed in speeds}, key=abs)
    system = flow_system(model).with_state(state.of_kind("static"))
    # Each begins at the one before.
    found: list[dict[str, LawState]] = []
    for speed in at:
        near = equilibrate(system, speed, near=near).laws
        found.append({law.part.part: law for law in near})
    tangents = {part: _tangent(model, part, laws[part], at, [laws[part] for laws in found]) for part in wanted}
    # Each once where there is one speed, in the order of the speeds.
    ends = {at[0]: found[0], at[-1]: found[-1]}
    operating = [there[part].at(speed) for speed, there in ends.items() for part in wanted]
    doubts = (note for speed, there in ends.items() for part in wanted for note in there[part].doubts(speed))
    notes = (*state.notes, *dict.fromkeys(doubts))
    return replace(state, tangents={**state.tangents, **tangents}, operating=tuple(operating), notes=notes)


def _tangent(
    model: Model,
    part: str,
    owner: Bearing | NonlinearElement,
    speeds: Sequence[float],
    states: Sequence[LawState],
) -> Spring:
    """The spring that a law is about its equilibria at some speeds of the reference shaft."""
    given = given_spring(owner).damping[0]
    named = owner.directions if isinstance(owner, NonlinearElement) else DOF_NAMES[: len(states[0].d)]
    used = [DOF_NAMES.index(direction) for direction in named]
    among = np.ix_(range(len(states)), used, used)
    stiffness = np.zeros((len(states), 6, 6))
    stiffness[among] = [state.stiffness for state in states]
    damping = np.repeat(given[None], len(states), axis=0)
    damping[among] += [state.damping for state in states]
    ratio = abs(float(model.layout.train.ratio(owner.shaft)))
    change = max(float(np.abs(A - A[0]).max()) / max(float(np.abs(A[0]).max()), 1e-300) for A in (stiffness, damping))
    if change <= _CONSTANT or ratio == 0.0:
        return constant_spring(stiffness[0], damping[0])
    return Spring(stiffness, damping, ratio * np.abs(np.array(speeds)))
