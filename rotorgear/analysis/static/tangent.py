"""The model that linear analyses solve: laws without a linear part of their own get their tangents at the equilibrium.

A nonlinear element, or a bearing given by its rolling elements alone, has the stiffness dF/dd and the damping dF/dv of its law
at the static equilibrium under the loads, at rest but for the rotation. What does not depend on speed becomes one stiffness; what
does, such as the film of a journal bearing, a table over speed, as a file may give it. Meshes have the stiffness of their mean
load: the tangent at that load where a stiffness model knows it; loaded teeth their mean tangent over the mesh cycle, all
contacts of the gearbox in equilibrium together (`about_cycle.py`); those that feel the tilt of their shafts are about the load
along their faces.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from rotorgear.model.model import Model
from rotorgear.model.parts.fields import DOF_NAMES
from rotorgear.model.parts.supports import DampingMatrix, StiffnessMatrix, TableRow
from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.system.system import System

if TYPE_CHECKING:
    from rotorgear.analysis.static.solve import LawState

# Tangents that change less over speed are one stiffness.
_CONSTANT = 1e-9


def about_equilibrium(
    model: Model, speeds: Sequence[float | None], near: Sequence[LawState] = ()
) -> tuple[Model, tuple[str, ...]]:
    """Return the linear model about its static equilibrium, and a sentence on each nonlinear part.

    A model without such parts, or whose parts all give a stiffness, comes back as it is.

    Args:
        model: a checked model.
        speeds: of the reference shaft in rad/s, of one sense, at which tangents are taken; None stands for standstill, where
            films have none, so that the operating speed serves.
        near: the laws in a known equilibrium near the first of them, from which it is looked for.

    Raises:
        AnalysisError: there is no equilibrium at one of the speeds.
    """
    key = tuple(speeds)
    if key not in model.linear_models:
        model.linear_models[key] = _about_equilibrium(model, speeds, near)
    return model.linear_models[key]


def _about_equilibrium(
    model: Model, speeds: Sequence[float | None], near: Sequence[LawState]
) -> tuple[Model, tuple[str, ...]]:
    notes = [
        f"the law of nonlinear_elements.{name}: the stiffness given beside it is taken"
        for name, element in model.nonlinear_elements.items()
        if element.is_given
    ]
    wanted = {f"bearings.{name}" for name, bearing in model.bearings.items() if not bearing.is_linear}
    wanted |= {
        f"nonlinear_elements.{name}" for name, element in model.nonlinear_elements.items() if not element.is_given
    }
    # Most models have none of these parts: what finds an equilibrium is loaded for the others only.
    if any(mesh.tilt for mesh in model.meshes.values()):
        from rotorgear.analysis.static.along_faces import about_faces

        model, along = about_faces(model, speeds)
        notes += along
    if any(mesh.stiffness == "tooth_fe" for mesh in model.meshes.values()):
        from rotorgear.analysis.static.about_cycle import about_cycle

        model, without = about_cycle(model, speeds)
        notes += without
    if not wanted:
        return model, tuple(notes)
    from rotorgear.analysis.static.law_states import law_rows
    from rotorgear.analysis.static.solve import equilibrate

    operating = model.operation.speed if model.operation else None
    at = sorted({(operating or 0.0) if speed is None else float(speed) for speed in speeds}, key=abs)
    load = model.mean_load(-1 if min(at) < 0.0 else 1).of_kind("static")
    system = System(model, load=load)
    # Each begins where the one before stands.
    states: list[dict[str, LawState]] = []
    for speed in at:
        near = equilibrate(system, speed, near=near).laws
        states.append({law.part.part: law for law in near})
    changed: dict[str, dict[str, Any]] = {}
    for part in sorted(wanted):
        table, _, name = part.partition(".")
        parts = changed.setdefault(table, dict(getattr(model, table)))
        parts[name] = parts[name].model_copy(update=_linear(model, part, at, [state[part] for state in states]))
    where = " to ".join(f"{speed * RPM_PER_RAD_S:.6g}" for speed in dict.fromkeys((at[0], at[-1])))
    notes.append(
        f"what is not linear of {', '.join(sorted(wanted))}: linearised about the static equilibrium at {where} rpm"
    )
    for speed, state in {at[0]: states[0], at[-1]: states[-1]}.items():
        turning = f" at {speed * RPM_PER_RAD_S:.6g} rpm" if len(at) > 1 else ""
        notes += [f"{row.sentence}{turning}" for row in law_rows(state[part] for part in sorted(wanted))]
    return model.model_copy(update=changed), tuple(notes)


def shared_maps(linear: Model) -> tuple[str, ...]:
    """Meshes of a model about its equilibrium whose face maps `with_maps_of` gives to others."""
    return tuple(name for name, mesh in linear.meshes.items() if mesh.stiffness == "tooth_fe" and mesh.face_loads)


def with_maps_of(linear: Model, model: Model) -> Model:
    """A model with the face maps of another one next to it, as long as its state lies among their misalignments.

    Maps of loaded teeth that feel the tilt of their shafts take nearly all the time of an equilibrium. And a map is known to a
    few thousandths of its tangents only: were each model on a map of its own, the difference of two would be off by as much.

    Args:
        linear: the other one, about its equilibrium.
        model: one with the same meshes.
    """
    mapped = shared_maps(linear)
    meshes = dict(model.meshes)
    for name in mapped:
        layout = linear.layout.mesh(name)
        helices = range(len(layout.part.face_loads))
        meshes[name] = meshes[name].mapped_at(tuple(layout.map_misalignments(helix) for helix in helices))
    return model.model_copy(update={"meshes": meshes}) if mapped else model


def about_equilibrium_of(
    model: Model | System, speeds: Sequence[float | None]
) -> tuple[Model | System, Model, tuple[str, ...]]:
    """The same of a model or an assembled system: linear, as it was given, and the sentences."""
    given = model.model if isinstance(model, System) else model
    linear, notes = about_equilibrium(given, speeds)
    if not isinstance(model, System):
        return linear, given, notes
    return about_state_of(model, linear), given, notes


def about_state_of(system: System, linear: Model) -> System:
    """An assembled system about the state of the linear model that was made from its own."""
    if linear is system.model:
        return system
    load = system.load if linear.meshes is system.model.meshes else linear.mean_load(system.direction)
    return System(linear, plan=system.plan, load=load)


def _linear(model: Model, part: str, speeds: Sequence[float], states: Sequence[LawState]) -> dict[str, Any]:
    """Stiffness and damping of a part in the words of a model file."""
    table, _, name = part.partition(".")
    owner = getattr(model, table)[name]
    given = np.array(owner.damping.as_rows()) if owner.damping else np.zeros((6, 6))
    used = [DOF_NAMES.index(d) for d in owner.directions] if table == "nonlinear_elements" else None
    # The linear bearing has no law any more, so that no note speaks of two descriptions.
    linear: dict[str, Any] = {} if table == "nonlinear_elements" else {"rolling": None, "journal": None, "thrust": None}
    pairs = [(_six(state.stiffness, used), given + _six(state.damping, used)) for state in states]
    ratio = abs(float(model.layout.train.ratio(owner.shaft)))
    first = pairs[0]
    size = [max(float(np.abs(A).max()), 1e-300) for A in first]
    change = max(float(np.abs(A - B).max()) / s for pair in pairs for A, B, s in zip(pair, first, size, strict=True))
    if change <= _CONSTANT or ratio == 0.0:
        return {**linear, "stiffness": _matrix(first[0]), "damping": DampingMatrix(matrix=_rows(first[1]))}
    rows = tuple(
        TableRow(speed=ratio * abs(speed), stiffness=_matrix(K), damping=DampingMatrix(matrix=_rows(C)))
        for speed, (K, C) in zip(speeds, pairs, strict=True)
    )
    return {**linear, "table": rows, "damping": None}


def _six(A: np.ndarray, used: list[int] | None) -> np.ndarray:
    """Tangents (k, k) among the six displacements of a node."""
    full = np.zeros((6, 6))
    dofs = list(range(len(A))) if used is None else used
    full[np.ix_(dofs, dofs)] = A
    return full


def _rows(A: np.ndarray) -> tuple[tuple[float, ...], ...]:
    return tuple(tuple(map(float, row)) for row in A)


def _matrix(K: np.ndarray) -> StiffnessMatrix:
    return StiffnessMatrix(matrix=_rows(K))
