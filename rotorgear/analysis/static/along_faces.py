"""Equilibrium of the shafts and the loads along the faces of their meshes.

Shafts that bend under the load tilt the flanks against each other: with the tilt v_t . q (m/m) of the gears about the normal of
the plane of action, a face of width b has the misalignment

    f = f_given - b v_t . q,

which shifts the load along the face; the load bends the shafts by its force F and its moment M about the middle of the face.
Both rest by Newton's method: the face answers to F and f with its approach, its moment and its tangents (`FaceLoad`), the
structure to the face, linear about that answer, with another F and f.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from rotorgear.analysis.static.about_cycle import state_speed
from rotorgear.analysis.static.solve import Equilibrated, equilibrate
from rotorgear.errors import ConvergenceError
from rotorgear.gears.stiffness.face_load import FaceLoad
from rotorgear.model.layout.state import State
from rotorgear.model.layout.torque_flow import torque_flow
from rotorgear.model.model import Model
from rotorgear.progress import Progress, silent
from rotorgear.system.system import System, flow_system

# The misalignment rests when it changes by no more than this share of itself and of the approach. The next pass of Newton's
# method would change it by the square of that.
_AT_REST = 1e-6
_PASSES = 25
# A gap that changes the forces by less than this share of the stiffness changes nothing but by rounding.
_DECIDED = 1e-7


@dataclass(frozen=True)
class AlongFaces:
    """An equilibrium with the loads along its faces.

    Attributes:
        equilibrium: of the structure; the state of its system knows the loads along the faces.
        faces: of each contact that feels the tilt of its shafts and carries, else None.
        passes: how often the faces were asked; 0 where none is.
    """

    equilibrium: Equilibrated
    faces: tuple[FaceLoad | None, ...]
    passes: int


def equilibrate_along_faces(system: System, speed: float, progress: Progress = silent) -> AlongFaces:
    """Return the equilibrium in which shafts and faces agree.

    Raises:
        AnalysisError: no loads, a motion that nothing holds and the loads push, flanks that can't be settled, or teeth that the
            loaded contact can't do.
        ConvergenceError: the misalignment does not come to rest.
    """
    equilibrium = equilibrate(system, speed)
    whole = equilibrium.lines.stiffness
    feels = [state.face is not None for state in equilibrium.lines.states]
    if not any(feels):
        return AlongFaces(equilibrium, (None,) * len(feels), 0)
    for count in range(1, _PASSES + 1):
        progress(count / (count + 1.0), f"load along the faces, pass {count}")
        faces = tuple(
            _face_load(equilibrium, contact, float(whole[contact]))
            if feels[contact] and equilibrium.force[contact] > 0.0
            else None
            for contact in range(len(feels))
        )
        load = equilibrium.system.state.about_faces(faces)
        equilibrium = equilibrate(equilibrium.system.with_state(load), speed)
        changes = [
            abs(f - face.misalignment) / (abs(face.misalignment) + face.force / face.static.stiffness)
            for f, face in zip(misalignments(equilibrium), faces, strict=True)
            if face is not None
        ]
        if max(changes, default=0.0) <= _AT_REST:
            return AlongFaces(_settled(equilibrium, faces), faces, count)
    raise ConvergenceError(
        f"shafts and loads along the faces did not come to agree in {_PASSES} passes; the misalignment still changes by "
        f"{100.0 * max(changes):.2g} %. Look for a shaft that hardly anything holds against tilting."
    )


def _settled(equilibrium: Equilibrated, faces: tuple[FaceLoad | None, ...]) -> Equilibrated:
    """The equilibrium with a state that knows the loads along the faces, so that all maps are of such teeth."""
    system = equilibrium.system
    found: dict[str, tuple[FaceLoad, ...]] = {}
    for name in dict.fromkeys(equilibrium.lines.names):
        own = [face for face, mesh in zip(faces, equilibrium.lines.names, strict=True) if mesh == name]
        carrying = tuple(face for face in own if face is not None)
        if len(carrying) == len(own):  # an open helix has no state to be about
            found[name] = carrying
    return replace(equilibrium, system=system.with_state(replace(system.state, faces=found)))


def _face_load(equilibrium: Equilibrated, contact: int, stiffness: float) -> FaceLoad:
    """The load along one face under the force and the misalignment of an equilibrium; `stiffness` (N/m) is that of the face."""
    state = equilibrium.lines.states[contact]
    mesh = equilibrium.system.layout.mesh(state.contact.mesh)
    force = float(equilibrium.force[contact])
    f = float(misalignments(equilibrium)[contact])
    return mesh.face_load(state.contact.helix, force, f, stiffness, state.torque_sense)


def decided_by_loads(equilibrium: Equilibrated) -> bool:
    """Whether the mean cycle of all loaded teeth is known along their faces: no stiffness decides about a contact's force.

    Then the force is the same at all positions, and the mean approach and moment are those of the `FaceLoad` of each contact.
    """
    lines = equilibrium.lines
    meshes = equilibrium.system.model.meshes
    known = equilibrium.system.state.faces
    if any(meshes[name].stiffness == "tooth_fe" and name not in known for name in lines.names):
        return False
    # What gaps would change of the forces, dF/dg = K (V^T (K + V K V^T)^-1 V K) - K, is rounding.
    k = np.where(equilibrium.closed, lines.stiffness, 0.0)
    pulled = lines.vectors * k
    change = pulled.T @ equilibrium.solver.solve(pulled, carried=True) - np.diag(k)
    return bool(np.abs(change).max() <= _DECIDED * k.max())


def misalignments(equilibrium: Equilibrated) -> np.ndarray:
    """Misalignment f (c,) of all contacts in m: what is given, and what the tilt of the shafts adds over the face."""
    meshes = [equilibrium.system.layout.mesh(name) for name in equilibrium.lines.names]
    given = np.array([mesh.part.misalignment for mesh in meshes])
    width = np.array([mesh.width for mesh in meshes])
    return np.asarray(given - width * (equilibrium.lines.tilt.T @ equilibrium.q))


def along_faces(model: Model, speeds: Sequence[float | None], state: State) -> State:
    """Return the state about the loads along the faces in the static equilibrium, with a note on each such mesh.

    Where no mesh feels a tilt, or nothing loads them, it is the one given.

    Args:
        model: a checked model.
        speeds: of the reference shaft in rad/s, of one sense, as for `state_speed`.
        state: that of the torque flow, with the films and springs in place of bearings that the equilibrium is to have.

    Raises:
        What `equilibrate_along_faces` raises.
    """
    tilted = [name for name, mesh in model.meshes.items() if mesh.tilt]
    if not tilted or not state.applied:
        return state
    speed = state_speed(model, speeds, state.direction)
    films = tuple(state.films.items())
    key = ("along faces", speed, state.direction, films, tuple(state.mapped_at.items()))
    if key in model.states and not state.tangents:
        return model.states[key]
    settled = equilibrate_along_faces(flow_system(model).with_state(state.of_kind("static")), speed)
    faces = settled.equilibrium.system.state.faces
    found = replace(
        torque_flow(model.layout, state.direction, faces),
        tangents=state.tangents,
        films=state.films,
        mapped_at=state.mapped_at,
        notes=state.notes,
    )
    if not state.tangents:
        model.states[key] = found
    return found
