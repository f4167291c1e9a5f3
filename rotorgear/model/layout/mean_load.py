"""The mean load of a train: forces and working flanks of all meshes, their stiffness at that load, and their phases.

First comes the torque flow, from static equilibrium of the train in torsion. A tree is plain statics; in a closed loop (split
torque) the split follows from the torsional stiffness of shafts, couplings and meshes. Torsional springs to ground carry no
mean torque here: loads balance by themselves. Where the file names a stiffness model, the mesh has its stiffness at that mean
force; in a loop the two are iterated until they agree. An equilibrium of the whole structure may then put other forces and
flanks in their place.

A mesh runs with the phase

    phi = 2 pi sigma (z_p (theta_p + s w - psi) / 2 pi),

counted from the moment when a contact of its first helix stands at the pitch point: sigma the sense of rotation of the pinion,
theta_p the angle of one of its teeth (`assembly.py`), s the side of the working flank and w half the angle of a tooth there.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Literal

from rotorgear.errors import ConvergenceError
from rotorgear.model.layout.applied_torques import AppliedTorque, applied_torques
from rotorgear.model.layout.layout import Layout
from rotorgear.model.layout.mesh_layout import Contact, MeshLayout
from rotorgear.model.layout.tooth_numbers import ToothNumbers, tooth_numbers
from rotorgear.model.layout.torsion_network import contact_forces
from rotorgear.model.parts.helix_state import FaceState, HelixState

if TYPE_CHECKING:
    from rotorgear.gears.maps.contact_map import ContactMap
    from rotorgear.gears.maps.face_map import FaceMap
    from rotorgear.gears.stiffness.face_load import FaceLoad
    from rotorgear.gears.stiffness.mesh_stiffness import MeshStiffness

    Curves = Mapping[str, tuple[MeshStiffness, ...]]

# A mesh whose share of the torque is below this relative to the largest one is called unloaded.
UNLOADED = 1e-9
# Stiffness and force of modelled meshes agree when no stiffness changes by more than this; so many passes are tried.
_AGREED = 1e-9
_PASSES = 60

Kind = Literal["dynamic", "static"]


@dataclass(frozen=True)
class MeshForce:
    """Mean state of one contact.

    Attributes:
        normal_force: N along the flank normal, 0 where nothing is known or nothing flows.
        torque_sense: s of the conventions: sense about +z of the torque that the pinion's shaft puts into the pinion.
        pinion_drives: whether the power flows from pinion to gear.
        assumed: True where no load flows and the sense was taken from the walk over the train.
        face: how the contact resists a tilt along its face; None for one that does not.
        start: N, of a contact that is linear about its mean state over the mesh cycle or along its face, where the flanks have
            not approached: F = start + k (v . q - gap); None of one whose force is proportional to its deflection.
    """

    contact: Contact
    normal_force: float
    torque_sense: int
    pinion_drives: bool
    assumed: bool
    face: FaceState | None = None
    start: float | None = None

    @property
    def on_other_flank(self) -> MeshForce:
        """The same contact where the flanks on the other side of the teeth work."""
        return replace(self, torque_sense=-self.torque_sense, pinion_drives=not self.pinion_drives, start=None)


@dataclass(frozen=True)
class MeanLoad:
    """The mean state that an analysis is about, for one sense of rotation.

    `model.mean_load(direction)` gives that of the torque flow, made once for each sense. A `System` takes a MeanLoad and keeps
    it as `system.load`; its contacts have the flanks and stiffnesses found here. An equilibrium of the whole structure hands
    its result on with

        load = system.load.with_forces(forces)        # N along the flank normal, one for each contact: flanks stay
        load = system.load.on_other_flank("stage_1")  # a mesh that works on its other flanks
        settled = system.with_load(load)              # the same discretisation about the new state

    Objects are frozen: each of these is a new one, and derives its phases again.

    Attributes:
        layout: of the model.
        direction: +1 or -1, sense about +z in which the reference shaft turns.
        applied: torques that drive and load the train.
        forces: of all contacts, in the order of the file, helices from left to right.
        curves: mesh -> stiffness of each helix at the load, where the file names a stiffness model.
        kind: which stiffness `forces` have where it depends on the load: "dynamic", the tangent for small motions about it, or
            "static", the secant for the deflection under it.
        flow: the state of the torque flow where this one was settled over the mesh cycle (`about_cycle`), else None.
    """

    layout: Layout
    direction: int
    applied: tuple[AppliedTorque, ...]
    forces: tuple[MeshForce, ...]
    curves: Curves = field(default_factory=dict)
    kind: Kind = "dynamic"
    flow: MeanLoad | None = None

    def of_kind(self, kind: Kind) -> MeanLoad:
        """The same state with the other stiffness of the contacts; one about the mesh cycle has one for both."""
        if self.flow is not None:
            return replace(self, kind=kind)
        return replace(self, kind=kind, forces=_with_stiffness(self.layout, self.forces, self.curves, kind))

    def about_cycle(
        self,
        forces: Iterable[float],
        stiffness: Iterable[float],
        start: Iterable[float | None],
        faces: Iterable[FaceState | None],
    ) -> MeanLoad:
        """The mean state over the mesh cycle of loaded teeth, with their contacts linear about it: F = start + k (v . q - gap).

        Args:
            forces: mean of each contact (N).
            stiffness: of each contact along the flank normal, of loaded teeth the mean tangent k (N/m).
            start: of loaded teeth (N); None of a contact that keeps its own.
            faces: of loaded teeth that feel the tilt of their shafts; None of a contact that keeps its own, or has none.
        """
        states = [
            replace(
                state,
                normal_force=float(F),
                start=state.start if F_0 is None else F_0,
                contact=replace(state.contact, stiffness=float(k)),
                face=face or state.face,
            )
            for state, F, k, F_0, face in zip(self.forces, forces, stiffness, start, faces, strict=True)
        ]
        return replace(self, forces=tuple(states), flow=self.flow or self)

    def with_forces(self, forces: Iterable[float]) -> MeanLoad:
        """The same flanks under other forces: N along the flank normal, one for each contact."""
        pairs = zip(self.forces, forces, strict=True)
        return replace(self, forces=tuple(replace(state, normal_force=float(force)) for state, force in pairs))

    def on_other_flank(self, mesh: str) -> MeanLoad:
        """The same state with one mesh working on its other flanks."""
        forces = (state.on_other_flank if state.contact.mesh == mesh else state for state in self.forces)
        return replace(self, forces=tuple(forces))

    def about_faces(self, faces: Iterable[FaceLoad | None]) -> MeanLoad:
        """The same state linear about other loads along the faces, one for each contact; None leaves a contact as it is."""
        forces = (
            state
            if face is None
            else about_face(state, face, self.layout.mesh(state.contact.mesh).part.misalignment, self.kind)
            for state, face in zip(self.forces, faces, strict=True)
        )
        return replace(self, forces=tuple(forces))

    def of_mesh(self, mesh: str) -> tuple[MeshForce, ...]:
        """The contacts of one mesh."""
        return tuple(force for force in self.forces if force.contact.mesh == mesh)

    def is_nominal(self, force: MeshForce) -> bool:
        """Whether the mean load presses the flanks that the file calls the driving ones (nominal_driver)."""
        mesh = self.layout.mesh(force.contact.mesh)
        return mesh.part.nominal_driver != ("gear" if force.pinion_drives else "pinion")

    @cached_property
    def about_nominal_flanks(self) -> MeanLoad:
        """The same state told from the flanks that the file calls the driving ones, which may not be those that carry."""
        forces = (force if self.is_nominal(force) else force.on_other_flank for force in self.forces)
        return replace(self, forces=tuple(forces))

    @cached_property
    def phases(self) -> dict[str, float | None]:
        """Phase of each mesh in rad, 0 to 2 pi, when the mark of the reference shaft is at +x; None without teeth."""
        return {mesh.name: self._phase(mesh.name) for mesh in self.layout.meshes}

    def _phase(self, name: str) -> float | None:
        mesh = self.layout.mesh(name)
        pinion = mesh.pinion
        if mesh.part.phase is not None:
            return mesh.part.phase % (2.0 * math.pi)
        if not pinion.part.teeth or pinion.shaft not in self.layout.assembly.shaft:
            return None
        theta = self.layout.assembly.angle(pinion)
        flank = self.of_mesh(name)[0].torque_sense * mesh.half_tooth
        sense = self.direction * self.layout.train.sense(pinion.shaft)
        return (sense * pinion.part.teeth * (theta + flank - mesh.psi)) % (2.0 * math.pi)

    def phase(self, contact: Contact) -> float | None:
        """Phase of one helix in rad, that of its mesh and the lead of its teeth; None without teeth."""
        phase = self.phases[contact.mesh]
        if phase is None:
            return None
        return phase + 2.0 * math.pi * self.layout.mesh(contact.mesh).lead(contact.helix, self.direction)

    @cached_property
    def tooth_numbers(self) -> ToothNumbers:
        """Where the maps of loaded teeth begin in the meshes of a gear whose teeth differ."""
        return tooth_numbers(
            self.layout, self.direction, {force.contact.mesh: force for force in reversed(self.forces)}
        )

    def path_phase(self, contact: Contact) -> float | None:
        """Phase of one helix in rad on the map of its loaded teeth, which counts the teeth; None without teeth."""
        phase = self.phase(contact)
        if phase is None:
            return None
        return phase + 2.0 * math.pi * self.tooth_numbers.ahead.get(contact.mesh, 0)

    def whole_curve(self, mesh: str) -> MeshStiffness | None:
        """Stiffness of both helices together; None where the file names no stiffness model."""
        if mesh not in self.curves:
            return None
        return self.layout.mesh(mesh).both_helices(self.curves[mesh], self.of_mesh(mesh)[0].torque_sense)

    def contact_map(self, force: MeshForce, near: bool = False) -> ContactMap | None:
        """Map F(delta, u) of one helix from its loaded teeth, along the path of contact; None where the file gives none.

        Its working load is the mean one of the mesh in the torque flow, so that equal helices share one map, and so do all
        analyses. Teeth that feel the tilt of their shafts keep that of the state they are about. In time u runs with the mesh
        phase phi (`path_phase`): u = phi / 2 pi where the pinion drives, and the other way, u = -phi / 2 pi, where the gear does.
        `near` gives the one for linear analyses, which takes less time.
        """
        mesh = self.layout.mesh(force.contact.mesh)
        if force.face is not None and not mesh.part.face_loads:
            return None  # its misalignment is not known, and without it the teeth would be others
        return mesh.contact_map(force.contact.helix, self._working_load(force), force.torque_sense, near)

    def coast_map(self, force: MeshForce) -> ContactMap | None:
        """The map of the flanks behind those of a contact, about the same load."""
        mesh = self.layout.mesh(force.contact.mesh)
        return mesh.coast_map(force.contact.helix, self._working_load(force), force.torque_sense)

    def face_map(self, force: MeshForce, near: bool = False) -> FaceMap | None:
        """Map (F, M)(delta, tilt, u) of one helix that feels the tilt of its shafts; None of others. As `contact_map`."""
        mesh = self.layout.mesh(force.contact.mesh)
        return mesh.face_map(force.contact.helix, self._working_load(force), force.torque_sense, near)

    def _working_load(self, force: MeshForce) -> float:
        """Mean force (N) of the helices of a mesh in the torque flow."""
        helices = (self.flow or self).of_mesh(force.contact.mesh)
        return sum(state.normal_force for state in helices) / len(helices)

    def curve(self, force: MeshForce) -> MeshStiffness:
        """Stiffness of one helix over its mesh period, along the path of contact of the pinion."""
        mesh = self.layout.mesh(force.contact.mesh)
        helices = self.curves.get(mesh.name) or mesh.helix_stiffness(force.normal_force or None)
        return helices[force.contact.helix]


def torque_flow(layout: Layout, direction: int = 1) -> MeanLoad:
    """Solve for the mean mesh forces of a checked model and decide the working flanks.

    Args:
        layout: of a checked model.
        direction: +1 or -1, sense about +z in which the reference shaft turns; reversed, the other flanks drive.

    Raises:
        AnalysisError: a stiffness model that can't do its teeth.
        ConvergenceError: in a loop, mesh stiffness and torque split don't come to agree.
    """
    applied = [replace(item, torque=direction * item.torque) for item in applied_torques(layout, direction)[0]]
    # Forces come first from the standard's stiffness: a model may need a load, and in a train without loops they stay.
    first = "iso" if applied else None
    curves: Curves = {mesh.name: mesh.helix_stiffness(name=first) for mesh in layout.meshes if mesh.is_modelled}
    lines, squeeze = _solved(layout, applied, curves)
    if curves and applied:
        for _ in range(_PASSES):
            before = curves
            curves = _loaded(layout, lines, squeeze)
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
    states = _with_stiffness(layout, _states(layout, lines, squeeze, direction), curves, "dynamic")
    return MeanLoad(layout, direction, tuple(applied), states, curves)


def _with_stiffness(layout: Layout, states: Sequence[MeshForce], curves: Curves, kind: Kind) -> tuple[MeshForce, ...]:
    found = []
    for state in states:
        contact = state.contact
        if contact.mesh in curves:
            curve = curves[contact.mesh][contact.helix]
            normal = curve.dynamic_normal if kind == "dynamic" else curve.static_normal
            state = replace(state, contact=replace(contact, stiffness=normal))
        mesh = layout.mesh(contact.mesh)
        if mesh.part.helix_states:
            state = _about_helix_state(state, mesh.part.helix_states[contact.helix])
        elif mesh.part.face_loads:
            state = about_face(state, mesh.part.face_loads[contact.helix], mesh.part.misalignment, kind)
        elif mesh.part.tilt:
            state = _on_whole_face(state, mesh)
        found.append(state)
    return tuple(found)


def _about_helix_state(state: MeshForce, found: HelixState) -> MeshForce:
    """A contact about the mean state of its helix over the mesh cycle, which has one stiffness for small and for mean loads."""
    return replace(
        state,
        contact=replace(state.contact, stiffness=found.stiffness),
        normal_force=found.force,
        torque_sense=found.torque_sense,
        pinion_drives=found.pinion_drives,
        face=found.face,
        start=found.start,
    )


def about_face(state: MeshForce, face: FaceLoad, given: float, kind: Kind) -> MeshForce:
    """A contact about the state of its helix along the face; `given` is the misalignment (m) before the shafts tilt."""
    spring = face.static if kind == "static" else face.dynamic
    tilt = (given - face.misalignment) / face.width
    along = FaceState(
        place=spring.place,
        tilt_stiffness=spring.tilt_stiffness,
        shift=spring.place * tilt,
        couple=face.moment - spring.place * face.force - spring.tilt_stiffness * tilt,
    )
    start = face.force - spring.stiffness * face.approach
    return replace(state, contact=replace(state.contact, stiffness=spring.stiffness), face=along, start=start)


def _on_whole_face(state: MeshForce, mesh: MeshLayout) -> MeshForce:
    """A contact that carries evenly over its whole face, k b^2/12 against tilt: what is known without a load."""
    tilt_stiffness = state.contact.stiffness * mesh.width**2 / 12.0
    askew = mesh.part.misalignment / mesh.width
    return replace(state, face=FaceState(0.0, tilt_stiffness, 0.0, -tilt_stiffness * askew))


def _solved(layout: Layout, applied: Sequence[AppliedTorque], curves: Curves) -> tuple[list[Contact], list[float]]:
    """Contacts with their stiffness, and the signed normal force of each."""
    lines: list[Contact] = []
    for mesh in layout.meshes:
        for contact in mesh.contacts:
            given = mesh.given_mean
            stiffness = curves[mesh.name][contact.helix].static_normal if given is None else given / mesh.helices
            lines.append(replace(contact, stiffness=stiffness))
    return lines, contact_forces(layout, applied, lines) if applied and lines else [0.0] * len(lines)


def _loaded(layout: Layout, lines: Sequence[Contact], squeeze: Sequence[float]) -> Curves:
    """Stiffness of the modelled meshes at the mean force of a helix; where no torque flows, without one."""
    largest = max(abs(force) for force in squeeze)
    found = {}
    for mesh in layout.meshes:
        if mesh.is_modelled:
            forces = [force for line, force in zip(lines, squeeze, strict=True) if line.mesh == mesh.name]
            mean = sum(forces) / len(forces)
            load = abs(mean) if abs(mean) > UNLOADED * largest else None
            found[mesh.name] = mesh.helix_stiffness(load, sense=1 if mean >= 0.0 else -1)
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
