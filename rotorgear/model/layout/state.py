"""The state that an analysis is about: all that an equilibrium of a model found, in one frozen object.

A `Model` is what the file says. What follows from it under load is a State: the flanks that work and their mean forces, how the
teeth stand along their faces and over the mesh cycle, the tangents of the laws of bearings, the temperatures of films. The
torque flow (`torque_flow.py`) is the first one; an equilibrium of the whole structure puts other forces and flanks in its place,
and adds what only it knows (`analysis/static/state_at.py`).

A mesh runs with the phase

    phi = 2 pi sigma (z_p (theta_p + s w - psi) / 2 pi),

counted from the moment when a contact of its first helix stands at the pitch point: sigma the sense of rotation of the pinion,
theta_p the angle of one of its teeth (`assembly.py`), s the side of the working flank and w half the angle of a tooth there.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal

from rotorgear.elements.gear_mesh import ContactGeometry, flank_normal
from rotorgear.model.layout.assembly import tooth_numbers
from rotorgear.model.layout.layout import Layout
from rotorgear.model.layout.mesh_layout import Contact, MeshLayout
from rotorgear.model.layout.spring import Spring, given_spring
from rotorgear.note import Note

if TYPE_CHECKING:
    import numpy as np

    from rotorgear.gears.maps.contact_map import ContactMap
    from rotorgear.gears.maps.face_map import FaceMap
    from rotorgear.gears.stiffness.face_load import FaceLoad
    from rotorgear.gears.stiffness.mesh_stiffness import MeshStiffness

    Curves = Mapping[str, tuple[MeshStiffness, ...]]
    Faces = Mapping[str, tuple[FaceLoad, ...]]
    Misalignments = Mapping[str, tuple[tuple[float, ...], ...]]
    Film = tuple[float | None, float | None]


Kind = Literal["dynamic", "static"]


@dataclass(frozen=True)
class FaceState:
    """A contact along its face, linear about its mean state.

    F = start + k (v . q - gap - shift),    M - e F = couple + k_t (v_t . q).

    Attributes:
        place: e, where v stands, from the middle of the face (m).
        tilt_stiffness: k_t (N m).
        shift: what the tilt of the state adds to the approach at that place (m): with it, approaches are those in the middle.
        couple: N m about e where the shafts have not tilted.
    """

    place: float
    tilt_stiffness: float
    shift: float
    couple: float


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
        behind: whether the flank works that stands behind the one of the torque flow, which errors of the mesh are told of.
        turned: whether the flank of the torque flow stands behind the one that it presses at the model's own sense of rotation,
            of which the file tells index errors: a tooth space that sits late on one side sits early on the other.
    """

    contact: Contact
    normal_force: float
    torque_sense: int
    pinion_drives: bool
    assumed: bool
    face: FaceState | None = None
    start: float | None = None
    behind: bool = False
    turned: bool = False

    @property
    def on_other_flank(self) -> MeshForce:
        """The same contact where the flanks on the other side of the teeth work."""
        turned = replace(self, torque_sense=-self.torque_sense, pinion_drives=not self.pinion_drives, start=None)
        return replace(turned, behind=not self.behind)

    def clocking_gap(self, layout: Layout) -> float:
        """What the clockings of the file leave open (m) on the flank that errors of the mesh are told of."""
        sense = -self.torque_sense if self.behind else self.torque_sense
        return sense * layout.clocking_gaps.get(self.contact.mesh, 0.0)

    def gap(self, layout: Layout) -> float:
        """What must close before the contact carries (m).

        Index errors, what clockings leave open, and what the tilt of its state adds at its place. Behind the flank that these are
        told of, the backlash is what that one leaves.
        """
        mesh = layout.mesh(self.contact.mesh).part
        index_error = mesh.index_error + (mesh.helix_index_error if self.contact.helix else 0.0)
        own = (-index_error if self.turned else index_error) + self.clocking_gap(layout)
        if self.behind:
            own = (mesh.backlash or 0.0) - own
        own -= self._pin_approach(layout)
        return own if self.face is None else own + self.face.shift

    def _pin_approach(self, layout: Layout) -> float:
        """How far the flanks approach (m) where pins are off their places: displacements of planets count from there."""
        import numpy as np

        contact = self.contact
        found = 0.0
        for name, side in ((contact.pinion, 1.0), (contact.gear, -1.0)):
            off = layout.pin_error(layout.gear(name).shaft)
            if off is not None:
                n = flank_normal(contact_geometry(self))
                if side < 0.0 and contact.turn is not None:
                    n = np.array(contact.turn) @ n
                found += side * float(n[0] * off[1] + n[1] * off[0])
        return found

    def about_face(self, face: FaceLoad, given: float, kind: Kind) -> MeshForce:
        """The contact linear about the load along its face; `given` is the misalignment (m) before the shafts tilt."""
        spring = face.static if kind == "static" else face.dynamic
        tilt = (given - face.misalignment) / face.width
        along = FaceState(
            place=spring.place,
            tilt_stiffness=spring.tilt_stiffness,
            shift=spring.place * tilt,
            couple=face.moment - spring.place * face.force - spring.tilt_stiffness * tilt,
        )
        start = face.force - spring.stiffness * face.approach
        return replace(self, contact=replace(self.contact, stiffness=spring.stiffness), face=along, start=start)

    def on_whole_face(self, mesh: MeshLayout) -> MeshForce:
        """The contact carrying evenly over its whole face, k b^2/12 against tilt: what is known without a load."""
        tilt_stiffness = self.contact.stiffness * mesh.width**2 / 12.0
        slope = mesh.part.misalignment / mesh.width
        return replace(self, face=FaceState(0.0, tilt_stiffness, 0.0, -tilt_stiffness * slope))


def contact_geometry(force: MeshForce) -> ContactGeometry:
    """Geometry of one contact with its driving flank, in the middle of its face."""
    c = force.contact
    # Recess follows the driving flank; the element measures from the pitch point towards where the pinion would recede.
    past_pitch_point = c.contact_position if force.pinion_drives else -c.contact_position
    return ContactGeometry(
        psi=c.psi,
        pressure_angle=c.pressure_angle,
        base_helix_angle=c.base_helix_angle,
        hand=c.hand,
        torque_sense=force.torque_sense,
        pinion_base_radius=c.pinion_base_radius,
        gear_base_radius=c.gear_base_radius,
        pinion_offset=c.contact_z - c.pinion_place.z,
        gear_offset=c.gear_contact_z - c.gear_place.z,
        contact_position=past_pitch_point,
        turn=c.turn,
        gear_node=c.gear_node,
        cone=c.cone,
    )


# Tables of the file whose parts linear analyses take as springs.
SPRING_TABLES = ("bearings", "supports", "couplings", "nonlinear_elements")


@dataclass(frozen=True, eq=False)
class OperatingPoint:
    """Where the force law of a part stands in an equilibrium.

    Attributes:
        part: its address. speed: of the reference shaft (rad/s).
        force: of the shaft on it (k,), along its displacements. displacement: (k,).
        stiffness: tangent (k, k). damping: (k, k).
        averaged: whether these are means over a pitch of rolling elements.
    """

    part: str
    speed: float
    force: np.ndarray
    displacement: np.ndarray
    stiffness: np.ndarray
    damping: np.ndarray
    averaged: bool


@dataclass(frozen=True, eq=False)  # what it holds are arrays: two states are the same one or not
class State:
    """The state that an analysis is about, for one sense of rotation.

    `model.torque_flow(direction)` gives that of the torque flow, made once for each sense; `state_at` that of an equilibrium. A
    `System` takes a State and keeps it as `system.state`: its contacts have the flanks and stiffnesses found here, its bearings
    the tangents. An equilibrium of the whole structure hands its result on with

        state = system.state.with_forces(forces)        # N along the flank normal, one for each contact: flanks stay
        state = system.state.on_other_flank("stage_1")  # a mesh that works on its other flanks
        settled = system.with_state(state)              # the same discretisation about the new state

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
        faces: mesh -> how each helix carries along its face in equilibrium with the tilt of its shafts.
        cycle: mesh -> mean state of each helix over the mesh cycle, all loaded teeth of the gearbox in equilibrium together.
        tangents: address -> spring about the equilibrium, of a part that has a law alone.
        films: address -> temperature (K) and angle of the inlet (rad) that an equilibrium found of a film, and motions in time
            keep; None of what follows from no equilibrium.
        mapped_at: mesh -> misalignments (m), falling, of the face map of each helix, where states next to each other share one,
            as long as they lie among these.
        operating: where the laws stand that `tangents` are of, at the lowest and the highest speed.
        notes: what of the model is not in it.
        rigid: the same as `forces`, of the meshes whose teeth do not give: as the torque flow has them.
    """

    layout: Layout
    direction: int
    applied: tuple[AppliedTorque, ...]
    forces: tuple[MeshForce, ...]
    curves: Curves = field(default_factory=dict)
    kind: Kind = "dynamic"
    flow: State | None = None
    faces: Faces = field(default_factory=dict)
    cycle: Mapping[str, tuple[MeshForce, ...]] = field(default_factory=dict)
    tangents: Mapping[str, Spring] = field(default_factory=dict)
    films: Mapping[str, Film] = field(default_factory=dict)
    mapped_at: Misalignments = field(default_factory=dict)
    operating: tuple[OperatingPoint, ...] = ()
    notes: tuple[Note, ...] = ()
    rigid: tuple[MeshForce, ...] = ()

    @property
    def is_flow(self) -> bool:
        """Whether it is that of the torque flow: no equilibrium of the structure has added anything to it."""
        return not (self.faces or self.cycle or self.tangents or self.films)

    @cached_property
    def springs(self) -> dict[str, Spring]:
        """Bearings, supports, couplings and nonlinear elements as linear analyses take them, by address."""
        given = self.layout.model.parts_of(*SPRING_TABLES)
        return {address: self.tangents.get(address) or given_spring(part) for address, part in given}

    def shaft_ratio(self, address: str) -> float:
        """Speed of the shaft of a bearing or an element, whatever its sense, over that of the reference."""
        table, _, name = address.partition(".")
        return abs(self.layout.turns(getattr(self.layout.model, table)[name].shaft))

    def spring_at(self, address: str, speed: float) -> tuple[np.ndarray, np.ndarray]:
        """Stiffness and damping (6, 6) of a part at a speed of the reference shaft in rad/s.

        Raises:
            AnalysisError: the speed of its shaft lies outside its table.
        """
        spring = self.springs[address]
        return spring.at(self.shaft_ratio(address) * abs(speed) if spring.varies else 0.0, address)

    def of_kind(self, kind: Kind) -> State:
        """The same state with the other stiffness of the contacts; one about the mesh cycle has one for both."""
        if self.flow is not None:
            return replace(self, kind=kind)
        return self._with((self._with_stiffness(force, kind) for force in self.forces), kind=kind)

    def _with(self, forces: Iterable[MeshForce], **changes: Any) -> State:
        """The same state with other mean states of its contacts."""
        return replace(self, forces=tuple(forces), **changes)

    def _with_stiffness(self, force: MeshForce, kind: Kind) -> MeshForce:
        """A contact with the stiffness about what is known of it."""
        contact = force.contact
        if contact.mesh in self.cycle:
            return self.cycle[contact.mesh][contact.helix]
        if contact.mesh in self.curves:
            curve = self.curves[contact.mesh][contact.helix]
            normal = curve.about_load.mean_normal if kind == "dynamic" else curve.static_normal
            force = replace(force, contact=replace(contact, stiffness=normal))
        mesh = self.layout.mesh(contact.mesh)
        if contact.mesh in self.faces:
            return force.about_face(self.faces[contact.mesh][contact.helix], mesh.part.misalignment, kind)
        return force.on_whole_face(mesh) if mesh.part.tilt else force

    def about_cycle(
        self,
        forces: Iterable[float],
        stiffness: Iterable[float],
        start: Iterable[float | None],
        faces: Iterable[FaceState | None],
    ) -> State:
        """The mean state over the mesh cycle of loaded teeth, with their contacts linear about it: F = start + k (v . q - gap).

        Args:
            forces: mean of each contact (N).
            stiffness: of each contact along the flank normal, of loaded teeth the mean tangent k (N/m).
            start: of loaded teeth (N); None of a contact that keeps its own.
            faces: of loaded teeth that feel the tilt of their shafts; None of a contact that keeps its own, or has none.
        """
        states = (
            replace(
                state,
                normal_force=float(F),
                start=state.start if F_0 is None else F_0,
                contact=replace(state.contact, stiffness=float(k)),
                face=face or state.face,
            )
            for state, F, k, F_0, face in zip(self.forces, forces, stiffness, start, faces, strict=True)
        )
        return self._with(states, flow=self.flow or self)

    def with_forces(self, forces: Iterable[float]) -> State:
        """The same flanks under other forces: N along the flank normal, one for each contact."""
        pairs = zip(self.forces, forces, strict=True)
        return self._with(replace(state, normal_force=float(force)) for state, force in pairs)

    def on_other_flank(self, mesh: str) -> State:
        """The same state with one mesh working on its other flanks."""
        return self._with(state.on_other_flank if state.contact.mesh == mesh else state for state in self.forces)

    def about_faces(self, faces: Iterable[FaceLoad | None]) -> State:
        """The same state linear about other loads along the faces, one for each contact; None leaves a contact as it is."""
        given = self.layout.model.meshes
        return self._with(
            state if face is None else state.about_face(face, given[state.contact.mesh].misalignment, self.kind)
            for state, face in zip(self.forces, faces, strict=True)
        )

    def of_mesh(self, mesh: str) -> tuple[MeshForce, ...]:
        """The contacts of one mesh."""
        return tuple(force for force in (*self.forces, *self.rigid) if force.contact.mesh == mesh)

    def is_nominal(self, force: MeshForce) -> bool:
        """Whether the mean load presses the flanks that the file calls the driving ones (nominal_driver)."""
        mesh = self.layout.mesh(force.contact.mesh)
        return mesh.part.nominal_driver != ("gear" if force.pinion_drives else "pinion")

    @cached_property
    def about_nominal_flanks(self) -> State:
        """The same state told from the flanks that the file calls the driving ones, which may not be those that carry."""
        turned = (force if self.is_nominal(force) else force.on_other_flank for force in self.forces)
        # Where the file names them, errors of the mesh are told of these flanks.
        return self._with(
            replace(force, behind=False) if self.layout.mesh(force.contact.mesh).part.nominal_driver else force
            for force in turned
        )

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
        sense = self.direction * mesh.sense(pinion)
        return (sense * pinion.part.teeth * (theta + flank - mesh.psi)) % (2.0 * math.pi)

    def phase(self, contact: Contact) -> float | None:
        """Phase of one helix in rad, that of its mesh and the lead of its teeth; None without teeth."""
        phase = self.phases[contact.mesh]
        if phase is None:
            return None
        return phase + 2.0 * math.pi * self.layout.mesh(contact.mesh).lead(contact.helix, self.direction)

    @cached_property
    def tooth_numbers(self) -> tuple[dict[str, int], list[str]]:
        """Where the maps of loaded teeth begin in the meshes of a gear whose teeth differ, and where that is not known."""
        pressed = {force.contact.mesh: (force.torque_sense, force.pinion_drives) for force in reversed(self.forces)}
        layout = self.layout
        return tooth_numbers(layout.assembly, layout.meshes, self.direction, pressed)

    def path_phase(self, contact: Contact) -> float | None:
        """Phase of one helix in rad on the map of its loaded teeth, which counts the teeth; None without teeth."""
        phase = self.phase(contact)
        if phase is None:
            return None
        return phase + 2.0 * math.pi * self.tooth_numbers[0].get(contact.mesh, 0)

    def whole_curve(self, mesh: str) -> MeshStiffness | None:
        """Stiffness of both helices together; None where the file names no stiffness model."""
        if mesh not in self.curves:
            return None
        return self.layout.mesh(mesh).both_helices(self.curves[mesh], self.of_mesh(mesh)[0].torque_sense)

    def contact_map(self, force: MeshForce, near: bool = False) -> ContactMap | None:
        """Map F(delta, u) of one helix from its loaded teeth, along the path of contact; None where the file gives none.

        Its working load is the mean one of the mesh in the torque flow, so that equal helices share one map, and so do all
        analyses. Teeth that feel the tilt of their shafts are misaligned as in this state. In time u runs with the mesh phase phi
        (`path_phase`): u = phi / 2 pi where the pinion drives, and the other way, u = -phi / 2 pi, where the gear does. `near`
        gives the one for linear analyses, which takes less time.
        """
        contact = force.contact
        if force.face is not None and contact.mesh not in self.faces:
            return None  # its misalignment is not known, and without it the teeth would be others
        return self.layout.mesh(contact.mesh).contact_map(
            contact.helix, self._working_load(force), force.torque_sense, near, self._misalignment(contact)
        )

    def coast_map(self, force: MeshForce) -> ContactMap | None:
        """The map of the flanks behind those of a contact, about the same load.

        Flanks that stand apart at one end of the face on one side of the teeth stand apart at its other end on the other side:
        the misalignment changes its sign, be it that of the file or that of a state with tilted shafts.
        """
        contact = force.contact
        mesh = self.layout.mesh(contact.mesh)
        f = self._misalignment(contact)
        behind = -(mesh.part.misalignment if f is None else f) or 0.0
        return mesh.contact_map(contact.helix, self._working_load(force), -force.torque_sense, misalignment=behind)

    def face_map(self, force: MeshForce, near: bool = False) -> FaceMap | None:
        """Map (F, M)(delta, tilt, u) of one helix that feels the tilt of its shafts; None of others. As `contact_map`."""
        contact = force.contact
        if contact.mesh not in self.faces:
            return None
        return self.layout.mesh(contact.mesh).face_map(
            contact.helix, self._working_load(force), self.map_misalignments(contact), force.torque_sense, near
        )

    def map_misalignments(self, contact: Contact) -> tuple[float, ...]:
        """Misalignments (m), falling, of the face map of a helix: about this state, or those of states next to it."""
        from rotorgear.gears.maps.face_map import holds, misalignments

        face = self.faces[contact.mesh][contact.helix]
        if contact.mesh in self.mapped_at:
            shared = self.mapped_at[contact.mesh][contact.helix]
            if holds(shared, face.misalignment):
                return shared
        given = self.layout.mesh(contact.mesh).part.misalignment
        return misalignments(face.misalignment, given, face.force / face.static.stiffness)

    @property
    def shared_maps(self) -> Misalignments:
        """What states next to this one take for their face maps (`mapped_at`), of meshes whose loaded teeth have such."""
        return {
            name: tuple(self.map_misalignments(contact) for contact in self.layout.mesh(name).contacts)
            for name in self.faces
            if self.layout.mesh(name).part.stiffness == "tooth_fe"
        }

    def _misalignment(self, contact: Contact) -> float | None:
        """Misalignment (m) of a helix in this state; None where none was looked for, and that of the file holds."""
        faces = self.faces.get(contact.mesh)
        return faces[contact.helix].misalignment if faces else None

    def _working_load(self, force: MeshForce) -> float:
        """Mean force (N) of the helices of a mesh in the torque flow."""
        helices = (self.flow or self).of_mesh(force.contact.mesh)
        return sum(state.normal_force for state in helices) / len(helices)

    def curve(self, force: MeshForce) -> MeshStiffness:
        """Stiffness of one helix over its mesh period, along the path of contact of the pinion."""
        mesh = self.layout.mesh(force.contact.mesh)
        helices = self.curves.get(mesh.name) or mesh.helix_stiffness(
            force.normal_force or None, misalignments=misalignments_of(self.faces.get(mesh.name))
        )
        return helices[force.contact.helix]


def misalignments_of(faces: tuple[FaceLoad, ...] | None) -> tuple[float, ...] | None:
    """Misalignment (m) of each helix that carries along its face; None where none was looked for."""
    return tuple(face.misalignment for face in faces) if faces else None


@dataclass(frozen=True)
class AppliedTorque:
    """A torque on a shaft: `torque` in N m about +z, at `z` in m."""

    name: str
    shaft: str
    z: float
    torque: float
