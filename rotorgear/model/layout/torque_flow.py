"""The torque flow of a train: forces and working flanks of all meshes, and their stiffness at that load.

Forces come from static equilibrium of the train in torsion. A tree is plain statics; in a closed loop (split torque) the split
follows from the torsional stiffness of shafts, couplings and meshes. Torsional springs to ground carry no mean torque here: loads
balance by themselves. Where the file names a stiffness model, the mesh has its stiffness at that mean force; in a loop the two
are iterated until they agree.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from rotorgear.errors import ConvergenceError
from rotorgear.model.layout.applied_torques import AppliedTorque, applied_torques
from rotorgear.model.layout.layout import Layout
from rotorgear.model.layout.mesh_force import MeshForce
from rotorgear.model.layout.mesh_layout import Contact
from rotorgear.model.layout.state import State, askew
from rotorgear.model.layout.torsion_network import contact_forces

if TYPE_CHECKING:
    from rotorgear.model.layout.state import Curves, Faces

# A mesh whose share of the torque is below this relative to the largest one is called unloaded.
UNLOADED = 1e-9
# Stiffness and force of modelled meshes agree when no stiffness changes by more than this; so many passes are tried.
_AGREED = 1e-9
_PASSES = 60


def torque_flow(layout: Layout, direction: int = 1, faces: Faces | None = None) -> State:
    """Solve for the mean mesh forces of a checked model and decide the working flanks.

    Args:
        layout: of a checked model.
        direction: +1 or -1, sense about +z in which the reference shaft turns; reversed, the other flanks drive.
        faces: of meshes whose shafts are known to tilt: their teeth stand askew as these say.

    Raises:
        AnalysisError: a stiffness model that can't do its teeth.
        ConvergenceError: in a loop, mesh stiffness and torque split don't come to agree.
    """
    applied = [replace(item, torque=direction * item.torque) for item in applied_torques(layout, direction)[0]]
    # Forces come first from the standard's stiffness: a model may need a load, and in a train without loops they stay.
    first = "iso" if applied else None
    faces = faces or {}
    curves: Curves = {
        mesh.name: mesh.helix_stiffness(name=first, misalignments=askew(faces.get(mesh.name)))
        for mesh in layout.meshes
        if mesh.is_modelled
    }
    lines, squeeze = _solved(layout, applied, curves)
    if curves and applied:
        for _ in range(_PASSES):
            before = curves
            curves = _loaded(layout, lines, squeeze, faces)
            lines, squeeze = _solved(layout, applied, curves)
            if all(
                abs(now.mean / old.mean - 1.0) <= _AGREED
                for name in curves
                for now, old in zip(curves[name], before[name], strict=True)
            ):
                break
        else:
            raise ConvergenceError(
                "The split of the torque and the mesh stiffness that depends on it don't come to agree: "
                "give the stiffness of one mesh of the loop as a number."
            )
    states = _states(layout, lines, squeeze, direction)
    return State(layout, direction, tuple(applied), states, curves, faces=faces).of_kind("dynamic")


def _solved(layout: Layout, applied: Sequence[AppliedTorque], curves: Curves) -> tuple[list[Contact], list[float]]:
    """Contacts with their stiffness, and the signed normal force of each."""
    lines: list[Contact] = []
    for mesh in layout.meshes:
        for contact in mesh.contacts:
            given = mesh.given_mean
            stiffness = curves[mesh.name][contact.helix].static_normal if given is None else given / mesh.helices
            lines.append(replace(contact, stiffness=stiffness))
    return lines, contact_forces(layout, applied, lines) if applied and lines else [0.0] * len(lines)


def _loaded(layout: Layout, lines: Sequence[Contact], squeeze: Sequence[float], faces: Faces) -> Curves:
    """Stiffness of the modelled meshes at the mean force of a helix; where no torque flows, without one."""
    largest = max(abs(force) for force in squeeze)
    found = {}
    for mesh in layout.meshes:
        if mesh.is_modelled:
            forces = [force for line, force in zip(lines, squeeze, strict=True) if line.mesh == mesh.name]
            mean = sum(forces) / len(forces)
            load = abs(mean) if abs(mean) > UNLOADED * largest else None
            found[mesh.name] = mesh.helix_stiffness(
                load, sense=1 if mean >= 0.0 else -1, misalignments=askew(faces.get(mesh.name))
            )
    return found


def _states(
    layout: Layout, lines: Sequence[Contact], squeeze: Sequence[float], direction: int
) -> tuple[MeshForce, ...]:
    """Mean state of each contact from its signed force."""
    train = layout.train
    largest = max((abs(force) for force in squeeze), default=0.0)
    states = []
    for contact, force in zip(lines, squeeze, strict=True):
        pinion_sense = train.sense(contact.pinion_shaft)
        unloaded = abs(force) <= UNLOADED * largest
        if unloaded:  # the shaft nearer to the input is taken to drive, in its own sense
            drives = train.depth[contact.pinion_shaft] <= train.depth[contact.gear_shaft]
            sense = direction * (pinion_sense if drives else -pinion_sense)
        else:
            sense = 1 if force > 0 else -1
        carried = 0.0 if unloaded else abs(force)
        states.append(MeshForce(contact, carried, sense, sense == direction * pinion_sense, assumed=unloaded))
    return tuple(states)
