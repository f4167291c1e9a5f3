"""The mean state of one contact: its force, its working flank, and how it carries along its face."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

from rotorgear.model.layout.mesh_layout import Contact, MeshLayout

if TYPE_CHECKING:
    from rotorgear.gears.stiffness.face_load import FaceLoad

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
        askew = mesh.part.misalignment / mesh.width
        return replace(self, face=FaceState(0.0, tilt_stiffness, 0.0, -tilt_stiffness * askew))
