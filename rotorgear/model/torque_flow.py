"""Torque flow: the mean force of every mesh and its driving flank, from static equilibrium of the train in torsion.

A tree is plain statics; in a closed loop (split torque) the split follows from the torsional stiffness of shafts, couplings
and meshes. Torsional springs to ground carry no mean torque here: loads balance by themselves.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from rotorgear.model.applied_torques import AppliedTorque, applied_torques
from rotorgear.model.mesh_geometry import Contact, contacts
from rotorgear.model.tables import Tables
from rotorgear.model.torsion_network import contact_forces
from rotorgear.model.train import Train

# A mesh whose share of the torque is below this relative to the largest one is called unloaded.
UNLOADED = 1e-9


@dataclass(frozen=True)
class MeshForce:
    """Mean state of one contact.

    Attributes:
        normal_force: N along the flank normal, 0 where nothing is known or nothing flows.
        torque_sense: s of the conventions: sense about +z of the torque that the pinion's shaft puts into the pinion.
        pinion_drives: whether the power flows from pinion to gear.
        assumed: True where no load flows and the sense was taken from the walk over the train.
    """

    contact: Contact
    normal_force: float
    torque_sense: int
    pinion_drives: bool
    assumed: bool


@dataclass(frozen=True)
class TorqueFlow:
    """All applied torques and mesh forces. Contacts are in the order of the file, helices from left to right."""

    applied: tuple[AppliedTorque, ...]
    forces: tuple[MeshForce, ...]

    def of_mesh(self, mesh: str) -> tuple[MeshForce, ...]:
        """The contacts of one mesh."""
        return tuple(force for force in self.forces if force.contact.mesh == mesh)


def torque_flow(model: Tables, train: Train, direction: int = 1) -> TorqueFlow:
    """Solve for the mean mesh forces of a checked model and decide the driving flanks.

    Args:
        model: a checked model.
        train: its train.
        direction: +1 or -1, sense about +z in which the reference shaft turns; reversed, the other flanks drive.
    """
    applied = [replace(item, torque=direction * item.torque) for item in applied_torques(model, train)[0]]
    lines = [contact for name in model.meshes for contact in contacts(model, name)]
    squeeze = contact_forces(model, train, applied, lines) if applied and lines else [0.0] * len(lines)
    largest = max((abs(force) for force in squeeze), default=0.0)
    forces = []
    for contact, force in zip(lines, squeeze, strict=True):
        shaft = model.gears[contact.pinion].shaft
        unloaded = abs(force) <= UNLOADED * largest
        sense = direction * _assumed_sense(model, train, contact) if unloaded else (1 if force > 0 else -1)
        drives = sense == direction * train.sense(shaft)
        forces.append(MeshForce(contact, 0.0 if unloaded else abs(force), sense, drives, unloaded))
    return TorqueFlow(tuple(applied), tuple(forces))


def _assumed_sense(model: Tables, train: Train, contact: Contact) -> int:
    """Sense of the pinion's torque where no load flows: the shaft nearer to the input drives in its own sense."""
    pinion, gear = model.gears[contact.pinion].shaft, model.gears[contact.gear].shaft
    drives = train.depth[pinion] <= train.depth[gear]
    return train.sense(pinion) if drives else -train.sense(pinion)
