"""Equilibrium of the shafts and the loads along the faces of their meshes.

Shafts that bend under the load tilt the flanks against each other: with the tilt v_t . q (m/m) of the gears about the normal of
the plane of action, a face of width b has the misalignment

    f = f_given - b v_t . q,

which shifts the load along the face; the load bends the shafts by its force F and its moment M about the middle of the face.
Both are found by Newton's method: the face answers to F and f with its approach, its moment and its tangents (`FaceLoad`), the
structure to the face, linear about that answer, with another F and f.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from rotorgear.analysis.static.solve import Equilibrated, equilibrate
from rotorgear.errors import ConvergenceError
from rotorgear.gears.stiffness.face_load import FaceLoad
from rotorgear.progress import Progress, silent
from rotorgear.system.system import System

# The misalignment is found when it changes by no more than this share of itself and of the approach. The next pass of Newton's
# method would change it by the square of that.
_CONVERGED = 1e-6
_PASSES = 25
# A gap that changes the forces by less than this share of the stiffness changes nothing but by rounding.
_DECIDED = 1e-7


def equilibrate_along_faces(system: System, speed: float, progress: Progress = silent) -> Equilibrated:
    """Return the equilibrium in which shafts and faces agree; the state of its system knows the loads along the faces.

    Raises:
        AnalysisError: no loads, a motion that nothing holds and the loads push, flanks that can't be settled, or teeth that the
            loaded contact can't do.
        ConvergenceError: the misalignment does not converge.
    """
    equilibrium = equilibrate(system, speed)
    whole = equilibrium.lines.stiffness
    feels = [state.face is not None for state in equilibrium.lines.states]
    if not any(feels):
        return replace(equilibrium, faces=(None,) * len(feels))
    for count in range(1, _PASSES + 1):
        progress(count / (count + 1.0), f"load along the faces, pass {count}")
        given = misalignments(equilibrium)
        faces = tuple(
            system.layout.mesh(state.contact.mesh).face_load(
                state.contact.helix, float(F), float(given[k]), float(whole[k]), state.torque_sense
            )
            if feels[k] and F > 0.0
            else None
            for k, (state, F) in enumerate(zip(equilibrium.lines.states, equilibrium.force, strict=True))
        )
        load = equilibrium.system.state.about_faces(faces)
        equilibrium = equilibrate(equilibrium.system.with_state(load), speed)
        changes = [
            abs(f - face.misalignment) / (abs(face.misalignment) + face.force / face.static.stiffness)
            for f, face in zip(misalignments(equilibrium), faces, strict=True)
            if face is not None
        ]
        if max(changes, default=0.0) <= _CONVERGED:
            # The state knows the loads along the faces, so that all maps are of such teeth; an open helix has none.
            known: dict[str, tuple[FaceLoad, ...]] = {}
            for name in dict.fromkeys(equilibrium.lines.names):
                own = [face for face, mesh in zip(faces, equilibrium.lines.names, strict=True) if mesh == name]
                carrying = tuple(face for face in own if face is not None)
                if len(carrying) == len(own):
                    known[name] = carrying
            system = equilibrium.system.with_state(replace(equilibrium.system.state, faces=known))
            return replace(equilibrium, system=system, faces=faces, passes=count)
    raise ConvergenceError(
        f"shafts and loads along the faces did not come to agree in {_PASSES} passes; the misalignment still changes by "
        f"{100.0 * max(changes):.2g} %. Look for a shaft that hardly anything holds against tilting."
    )


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
