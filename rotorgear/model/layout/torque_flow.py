"""Torque flow: the mean force of every mesh and its driving flank, from static equilibrium of the train in torsion.

A tree is plain statics; in a closed loop (split torque) the split follows from the torsional stiffness of shafts, couplings
and meshes. Torsional springs to ground carry no mean torque here: loads balance by themselves. Where the file names a
stiffness model, the mesh has its stiffness at that mean force; in a loop the two are iterated until they agree.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Literal

from rotorgear.errors import ConvergenceError
from rotorgear.model.layout.applied_torques import AppliedTorque, applied_torques
from rotorgear.model.layout.mesh_geometry import Contact, contacts
from rotorgear.model.layout.mesh_stiffness import given_mean, is_modelled, stiffness_of_mesh
from rotorgear.model.layout.torsion_network import contact_forces
from rotorgear.model.layout.train import Train
from rotorgear.model.parts.tables import Tables

if TYPE_CHECKING:
    from rotorgear.gears.stiffness.mesh_stiffness import MeshStiffness

# A mesh whose share of the torque is below this relative to the largest one is called unloaded.
UNLOADED = 1e-9
# Stiffness and force of modelled meshes agree when no stiffness changes by more than this; so many passes are tried.
_AGREED = 1e-9
_PASSES = 60


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
    """All applied torques and mesh forces. Contacts are in the order of the file, helices from left to right.

    `stiffness` holds the curves of the meshes for which the file names a stiffness model.
    """

    applied: tuple[AppliedTorque, ...]
    forces: tuple[MeshForce, ...]
    stiffness: dict[str, MeshStiffness] = field(default_factory=dict)

    def with_stiffness(self, kind: Literal["dynamic", "static"]) -> TorqueFlow:
        """The same state with the stiffness of each modelled mesh against small motions, or for the deflection at the load."""
        forces = []
        for force in self.forces:
            curve = self.stiffness.get(force.contact.mesh)
            if curve is not None:
                normal = curve.dynamic_normal if kind == "dynamic" else curve.static_normal
                own = replace(force.contact, stiffness=normal / curve.helices)
                force = replace(force, contact=own)
            forces.append(force)
        return replace(self, forces=tuple(forces))

    def of_mesh(self, mesh: str) -> tuple[MeshForce, ...]:
        """The contacts of one mesh."""
        return tuple(force for force in self.forces if force.contact.mesh == mesh)


def carries_on_back_flanks(model: Tables, force: MeshForce) -> bool:
    """Whether the mean load presses the flanks that the file does not call the driving ones (nominal_driver)."""
    return model.meshes[force.contact.mesh].nominal_driver == ("gear" if force.pinion_drives else "pinion")


def about_nominal_flanks(model: Tables, flow: TorqueFlow) -> TorqueFlow:
    """The same state told from the flanks that the file calls the driving ones, which may not be those that carry."""
    forces = (
        replace(force, torque_sense=-force.torque_sense, pinion_drives=not force.pinion_drives)
        if carries_on_back_flanks(model, force)
        else force
        for force in flow.forces
    )
    return replace(flow, forces=tuple(forces))


def torque_flow(model: Tables, train: Train, direction: int = 1) -> TorqueFlow:
    """Solve for the mean mesh forces of a checked model and decide the driving flanks.

    Args:
        model: a checked model.
        train: its train.
        direction: +1 or -1, sense about +z in which the reference shaft turns; reversed, the other flanks drive.

    Raises:
        AnalysisError: a stiffness model that can't do its teeth.
        ConvergenceError: in a loop, mesh stiffness and torque split don't come to agree.
    """
    applied = [replace(item, torque=direction * item.torque) for item in applied_torques(model, train)[0]]
    modelled = [name for name in model.meshes if is_modelled(model, name)]
    # Forces come first from the standard's stiffness: a model may need a load, and in a train without loops they stay.
    curves = {name: stiffness_of_mesh(model, name, name="iso" if applied else None) for name in modelled}
    lines, squeeze = _solved(model, train, applied, curves)
    if curves and applied:
        lines, squeeze, curves = _agreed(model, train, applied, lines, squeeze, curves)
    return TorqueFlow(tuple(applied), _forces(model, train, lines, squeeze, direction), curves)


def _agreed(
    model: Tables,
    train: Train,
    applied: Sequence[AppliedTorque],
    lines: list[Contact],
    squeeze: list[float],
    curves: dict[str, MeshStiffness],
) -> tuple[list[Contact], list[float], dict[str, MeshStiffness]]:
    """Iterate until the modelled stiffnesses are those at the forces that they lead to."""
    for _ in range(_PASSES):
        before = curves
        curves = _loaded(model, lines, squeeze)
        lines, squeeze = _solved(model, train, applied, curves)
        if all(abs(curves[name].mean / before[name].mean - 1.0) <= _AGREED for name in curves):
            return lines, squeeze, curves
    raise ConvergenceError(
        "The split of the torque and the mesh stiffness that depends on it don't come to agree: "
        "give the stiffness of one mesh of the loop as a number."
    )


def _solved(
    model: Tables, train: Train, applied: Sequence[AppliedTorque], curves: dict[str, MeshStiffness]
) -> tuple[list[Contact], list[float]]:
    """Contacts with their stiffness, and the signed normal force of each."""
    lines: list[Contact] = []
    for name in model.meshes:
        given = given_mean(model, name)
        lines += contacts(model, name, curves[name].static_normal if given is None else given)
    return lines, contact_forces(model, train, applied, lines) if applied and lines else [0.0] * len(lines)


def _loaded(model: Tables, lines: Sequence[Contact], squeeze: Sequence[float]) -> dict[str, MeshStiffness]:
    """Stiffness of the modelled meshes at the mean force of a helix; where no torque flows, without one."""
    largest = max(abs(force) for force in squeeze)
    found = {}
    for name in model.meshes:
        if is_modelled(model, name):
            own = [force for line, force in zip(lines, squeeze, strict=True) if line.mesh == name]
            mean = sum(own) / len(own)
            carries = abs(mean) > UNLOADED * largest
            found[name] = stiffness_of_mesh(model, name, abs(mean) if carries else None, sense=1 if mean >= 0.0 else -1)
    return found


def _forces(
    model: Tables, train: Train, lines: Sequence[Contact], squeeze: Sequence[float], direction: int
) -> tuple[MeshForce, ...]:
    """Mean state of each contact from its signed force."""
    largest = max((abs(force) for force in squeeze), default=0.0)
    forces = []
    for contact, force in zip(lines, squeeze, strict=True):
        shaft = model.gears[contact.pinion].shaft
        unloaded = abs(force) <= UNLOADED * largest
        sense = direction * _assumed_sense(model, train, contact) if unloaded else (1 if force > 0 else -1)
        drives = sense == direction * train.sense(shaft)
        forces.append(MeshForce(contact, 0.0 if unloaded else abs(force), sense, drives, unloaded))
    return tuple(forces)


def _assumed_sense(model: Tables, train: Train, contact: Contact) -> int:
    """Sense of the pinion's torque where no load flows: the shaft nearer to the input drives in its own sense."""
    pinion = model.gears[contact.pinion].shaft
    gear = model.gears[contact.gear].shaft
    drives = train.depth[pinion] <= train.depth[gear]
    return train.sense(pinion) if drives else -train.sense(pinion)
