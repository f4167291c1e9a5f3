"""Two gears in mesh: what follows from them, their axes and the mesh, before any load.

The working pressure angle follows from the distance of the axes, cos a = (r_b1 + r_b2)/a_w (ISO 21771), the contact's
plane from the overlap of the faces. Signs of flank and hand are left to `elements/gear_mesh.py`.

What a file gives as stiffness acts along the flank normal of both helices together; a stiffness model answers in the
transverse plane for one helix. Here the two are brought to one `MeshStiffness` for each helix.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

from rotorgear.elements.gear_mesh import Cone
from rotorgear.errors import AnalysisError
from rotorgear.gears.geometry.bevel import BevelPair
from rotorgear.gears.geometry.geometry import GearGeometry
from rotorgear.gears.geometry.pair import (
    Backlash,
    PairGeometry,
    normal_backlash,
    pair_geometry,
    working_pressure_angle_from_shifts,
)
from rotorgear.model.layout.bevel import Meeting, meeting, pair_of
from rotorgear.model.layout.gear_layout import GearLayout
from rotorgear.model.layout.train import Train
from rotorgear.model.parts.fields import RIGID
from rotorgear.model.parts.frame import Frame
from rotorgear.model.parts.mesh import Mesh
from rotorgear.model.parts.shaft import Place
from rotorgear.quantity import millimetres

if TYPE_CHECKING:
    from rotorgear.gears.maps.contact_map import ContactMap
    from rotorgear.gears.maps.face_map import FaceMap
    from rotorgear.gears.stiffness.face_load import FaceLoad
    from rotorgear.gears.stiffness.mesh_stiffness import MeshStiffness, ToothBody, ToothPair

# Positions in a mesh period at which a stiffness model is asked.
POSITIONS = 64
# Of rigid teeth in the torque flow, N/m: far above those of steel, and far below what numbers can hold beside a soft shaft.
STIFF = 1e11
# How far the circle that the teeth are held on may be off the rim of the mesh, in normal modules. A ring of this height under
# the mean force of the teeth gives some thousandths of what the teeth give.
_BETWEEN = 0.5


@dataclass(frozen=True)
class Contact:
    """One helix of a mesh, as the assembly needs it (m, rad, N/m).

    Attributes:
        mesh: name of the mesh.
        helix: 0 for the only one or that at the smaller z, 1 for the other of a herringbone.
        pinion, gear: names of the gears; pinion_place, gear_place: of the two gear nodes.
        contact_z: z of the middle of the common face on the pinion's shaft; gear_contact_z: on the gear's.
        hand: +1 right, -1 left hand of the pinion's helix, 0 for a spur gear.
        psi: direction to the pitch point from +x of the pinion's shaft; gear_psi: the same of the gear's.
        pressure_angle: working transverse pressure angle.
        stiffness: along the flank normal; NaN where a contact stands for its geometry only.
        turn: rows of (3, 3), directions of the pinion's shaft in those of the gear's; None where both are the same.
        gear_node: (x, y, z) from the pinion's node to the gear's in the frame of the pinion's shaft, beside a turn and where
            both shafts have positions.
        cone: of bevel gears.
    """

    mesh: str
    helix: int
    pinion: str
    gear: str
    pinion_place: Place
    gear_place: Place
    contact_z: float
    gear_contact_z: float
    hand: int
    psi: float
    gear_psi: float
    pressure_angle: float
    base_helix_angle: float
    pinion_base_radius: float
    gear_base_radius: float
    stiffness: float
    contact_position: float
    turn: tuple[tuple[float, ...], ...] | None = None
    gear_node: tuple[float, ...] | None = None
    cone: Cone | None = None

    @property
    def levers(self) -> tuple[float, float]:
        """r_b of pinion and gear in m, by which a positive rotation of each about its own z presses one and the same flank.

        That of a gear is negative of a ring with its teeth inside, and where the axes of a bevel pair lead to the apex on one
        side and away from it on the other.
        """
        side = self.cone.sides[0] * self.cone.sides[1] if self.cone else 1
        return self.pinion_base_radius, side * self.gear_base_radius


class MeshLayout:
    """One mesh of a model.

    Attributes:
        name, part: its name and what the file says of it.
        pinion, gear: the two gears, as the file calls them.
    """

    def __init__(self, name: str, part: Mesh, pinion: GearLayout, gear: GearLayout, train: Callable[[], Train]) -> None:
        self._train = train
        self.name = name
        self.part = part
        self.pinion = pinion
        self.gear = gear

    @property
    def train(self) -> Train:
        """The train that the mesh is part of, walked when it is asked for: checks look at meshes before."""
        return self._train()

    @property
    def gears(self) -> tuple[GearLayout, GearLayout]:
        """Pinion and gear."""
        return self.pinion, self.gear

    @property
    def carrier(self) -> str | None:
        """Name of the shaft of the carrier that the mesh goes round with; None of one that stands still."""
        return self.pinion.carrier_shaft or self.gear.carrier_shaft

    def turns(self, gear: GearLayout) -> float:
        """Speed of one of its gears as the mesh sees it, over that of the reference shaft: relative to its carrier."""
        if self.carrier is None:
            return self.train.ratio(gear.shaft)
        return float(self.train.ratios[gear.shaft] - self.train.ratios[self.carrier])

    def sense(self, gear: GearLayout) -> int:
        """+1 or -1: sense in which one of its gears turns against the mesh; +1 at rest."""
        return -1 if self.turns(gear) < 0.0 else 1

    @property
    def order(self) -> float:
        """Mesh frequency over that of the reference shaft; 0 without teeth."""
        return abs(self.turns(self.pinion)) * (self.pinion.part.teeth or 0)

    @property
    def helices(self) -> int:
        """Helices of the mesh: 2 for a herringbone pair."""
        return self.pinion.helices

    @property
    def has_teeth(self) -> bool:
        """Whether both gears give their number of teeth."""
        return bool(self.pinion.part.teeth and self.gear.part.teeth)

    @cached_property
    def centre_line(self) -> tuple[float, float] | None:
        """Centre distance in m and direction from pinion to gear in rad; None where the shafts have no positions."""
        if self.pinion.shaft_part.origin is None or self.gear.shaft_part.origin is None or self.is_bevel:
            return None
        dx, dy, _ = self.gear_frame.at(self.gear.z).tolist()
        return math.hypot(dx, dy), math.atan2(dy, dx)

    @cached_property
    def gear_frame(self) -> Frame:
        """The gear's shaft in the frame of the pinion's."""
        return self.pinion.shaft_part.frame.sees(self.gear.shaft_part.frame)

    @property
    def is_bevel(self) -> bool:
        """Whether it is one of bevel gears."""
        return self.pinion.part.is_bevel and self.gear.part.is_bevel

    @cached_property
    def meeting(self) -> Meeting | None:
        """Where the axes of bevel gears meet; None of cylindrical gears, and of parallel axes."""
        if not self.is_bevel:
            return None
        return meeting((self.pinion.shaft_part, self.gear.shaft_part), (self.pinion.z, self.gear.z))

    @cached_property
    def bevel(self) -> BevelPair | None:
        """The pitch cones of bevel gears; None as of `meeting`."""
        return None if self.meeting is None else pair_of(self.meeting, self.pinion.part, self.gear.part)

    @property
    def _shift(self) -> float:
        """z in m of the gear's z = 0 on the pinion's shaft."""
        return float(self.gear_frame.origin[2])

    @property
    def psi(self) -> float:
        """Direction from the pinion's axis to the pitch point in rad, from +x of its shaft."""
        if self.meeting is not None:
            return self.meeting.directions[0]
        line = self.centre_line[1] if self.centre_line else (self.part.centre_line_angle or 0.0)
        return line + math.pi if self.is_internal else line

    @property
    def gear_psi(self) -> float:
        """Direction from the gear's axis to the pitch point in rad, from +x of its shaft."""
        if self.meeting is not None:
            return self.meeting.directions[1]
        x = self.gear_frame.axes[:, 0]
        return self.psi + (0.0 if self.is_internal else math.pi) - math.atan2(x[1], x[0])

    @property
    def is_internal(self) -> bool:
        """Whether its gear is a ring with its teeth inside."""
        return self.gear.part.internal

    @property
    def gear_base_radius(self) -> float:
        """r_b of the gear in m, negative of a ring with its teeth inside (ISO 21771)."""
        return -self.gear.base_radius if self.is_internal else self.gear.base_radius

    @cached_property
    def pressure_angle(self) -> float:
        """Working transverse pressure angle in rad; of bevel gears at the mean point."""
        if self.bevel is not None:
            return self.bevel.pressure_angle
        if self.centre_line is not None and not self.has_own_angle:
            return math.acos(min(abs(self.pinion.base_radius + self.gear_base_radius) / self.centre_line[0], 1.0))
        if self.part.pressure_angle is not None:
            return self.part.pressure_angle
        if self.pinion.geometry and self.gear.geometry:
            return working_pressure_angle_from_shifts(self.pinion.geometry, self.gear.geometry)
        return self.pinion.part.transverse_pressure_angle or self.gear.part.transverse_pressure_angle or 0.0

    @property
    def has_own_angle(self) -> bool:
        """Whether its lumped gears go round with a carrier and say their pressure angle: radii need not fit the pin's then."""
        angles = (self.part.pressure_angle, *(gear.part.transverse_pressure_angle for gear in self.gears))
        return self.carrier is not None and self.pinion.part.lumped and any(angle is not None for angle in angles)

    @property
    def width(self) -> float:
        """Common face width in m of one helix: the smaller one given, 0 where none is."""
        return min((gear.part.width for gear in self.gears if gear.part.width), default=0.0)

    @cached_property
    def pair(self) -> PairGeometry | None:
        """Contact ratios and working circles; None for lumped gears.

        Raises:
            AnalysisError: gears that can't mesh on these axes.
        """
        if self.pinion.geometry is None or self.gear.geometry is None:
            return None
        distance = None
        if self.centre_line is not None:
            distance = -self.centre_line[0] if self.is_internal else self.centre_line[0]
        return pair_geometry(self.pinion.geometry, self.gear.geometry, centre_distance=distance, width=self.width)

    def _toothed(self, lacking: str) -> tuple[GearGeometry, GearGeometry, PairGeometry]:
        """The geometry of gears that are given by their teeth; others lack what is asked for."""
        if self.pinion.geometry is None or self.gear.geometry is None or self.pair is None:
            kind = "bevel gears" if self.is_bevel else "gears given by their base radius"
            raise AnalysisError(f"meshes.{self.name}: {kind} have no {lacking}.")
        return self.pinion.geometry, self.gear.geometry, self.pair

    @cached_property
    def backlash(self) -> Backlash:
        """Normal backlash from the centre distance and the allowances.

        Raises:
            AnalysisError: gears that are given by their base radius.
        """
        pinion, gear, pair = self._toothed("backlash of their own; give one")
        return normal_backlash(
            pinion,
            gear,
            pair.centre_distance,
            self.pinion.part.allowance,
            self.gear.part.allowance,
            self.part.centre_distance_allowance,
        )

    def face(self, helix: int) -> tuple[float, float] | None:
        """z range in m where the two gears of one helix face each other, on the pinion's shaft; None where a width is missing."""
        pinion = self.pinion.part.width
        gear = self.gear.part.width
        if not pinion or not gear or self.is_bevel:
            return None
        first, second = self.planes[helix]
        return max(first - 0.5 * pinion, second - 0.5 * gear), min(first + 0.5 * pinion, second + 0.5 * gear)

    @property
    def planes(self) -> tuple[tuple[float, float], ...]:
        """z in m of the mid-planes of pinion and gear, both on the pinion's shaft, of each helix from left to right."""
        pairs = zip(self.pinion.planes, self.gear.planes, strict=True)
        return tuple((first, second + self._shift) for first, second in pairs)

    def own_face(self, gear: GearLayout, helix: int) -> tuple[float, float] | None:
        """The same range on the shaft of one of its gears."""
        face = self.face(helix)
        shift = 0.0 if gear is self.pinion else self._shift
        return None if face is None else (face[0] - shift, face[1] - shift)

    @cached_property
    def contacts(self) -> tuple[Contact, ...]:
        """The contacts of the mesh, without stiffness: one, or two for a herringbone pair from left to right."""
        return tuple(self._contact(helix) for helix in range(self.helices))

    def _contact(self, helix: int) -> Contact:
        low, high = self.face(helix) or self.planes[helix]
        places = (0.5 * (low + high), 0.5 * (low + high) - self._shift)
        cone = None
        if self.meeting is not None and self.bevel is not None:
            met = self.meeting
            pair = self.bevel
            # From the apex along each axis to the foot of the mean point.
            far = pair.mean_distances
            places = (met.apex[0] + met.sides[0] * far[0], met.apex[1] + met.sides[1] * far[1])
            cone = Cone(pair.pitch_angles[0], pair.shaft_angle, met.sides)
        pinion_place = self.pinion.places[helix if len(self.pinion.places) == 2 else 0]
        gear_place = self.gear.places[helix if len(self.gear.places) == 2 else 0]
        turn = None
        gear_node = None
        if self.gear_frame.is_turned:
            turn = tuple(map(tuple, self.gear_frame.axes.T.tolist()))
            if self.centre_line is not None and not self.has_own_angle:
                gear_node = tuple((self.gear_frame.at(gear_place.z) - [0.0, 0.0, pinion_place.z]).tolist())
        return Contact(
            mesh=self.name,
            helix=helix,
            pinion=self.pinion.name,
            gear=self.gear.name,
            pinion_place=pinion_place,
            gear_place=gear_place,
            contact_z=places[0],
            gear_contact_z=places[1],
            hand=self.pinion.hand if helix == 0 else -self.pinion.hand,
            psi=self.psi,
            gear_psi=self.gear_psi,
            pressure_angle=self.pressure_angle,
            base_helix_angle=self.pinion.base_helix_angle,
            pinion_base_radius=self.pinion.base_radius,
            gear_base_radius=self.gear_base_radius,
            stiffness=math.nan,
            contact_position=self.part.contact_position,
            turn=turn,
            gear_node=gear_node,
            cone=cone,
        )

    @property
    def base_pitch(self) -> float:
        """Distance of the flanks of two teeth along the flank normal, p_bn in m."""
        pinion = self.pinion
        return 2.0 * math.pi * pinion.base_radius * math.cos(pinion.base_helix_angle) / (pinion.part.teeth or 1)

    @property
    def half_tooth(self) -> float:
        """Half the angle of the pinion's tooth at the working circle in rad: a quarter of the pitch, and the profile shift."""
        geometry = self.pinion.geometry
        if geometry is None:
            return 0.5 * math.pi / (self.pinion.part.teeth or 1)
        working = 2.0 * geometry.base_radius / math.cos(self.pressure_angle)
        return geometry.transverse_thickness(working) / working

    @cached_property
    def teeth(self) -> ToothPair:
        """One helix with its teeth and blanks.

        Raises:
            AnalysisError: gears that are given by their base radius.
        """
        from rotorgear.gears.stiffness.mesh_stiffness import ToothPair
        from rotorgear.gears.tooth_fe.settings import ToothFe

        fe = self.part.tooth_fe
        return ToothPair(
            *self._toothed("teeth to look at"),
            self.width,
            self.pinion.tooth_body,
            self.gear.tooth_body,
            self.pinion.flank,
            self.gear.flank,
            self.part.misalignment,
            ToothFe(fe.preset, fe.body, fe.rim_thickness, fe.pitches, fe.exclude_torsion),
            self.part.tilt,
        )

    def working_teeth(self, sense: int) -> ToothPair:
        """The teeth with the flanks that work where the torque on the pinion has this sense about +z: the left ones for +1."""
        if sense > 0 or not any(gear.flanks_differ for gear in self.gears):
            return self.teeth
        return replace(self.teeth, first_flank=self.pinion.flank_of("right"), second_flank=self.gear.flank_of("right"))

    def helix_teeth(self, helix: int, sense: int = 1, misalignment: float | None = None) -> ToothPair:
        """The teeth of one helix as contact runs over them: seen from the other end of the face where it runs behind at larger z.

        `sense` is that of the torque on the pinion about +z; `misalignment` (m) that of a state with tilted shafts, None for that
        of the file. Raises what `teeth` raises.
        """
        teeth = self.working_teeth(sense)
        if misalignment is not None:
            teeth = replace(teeth, misalignment=misalignment)
        return teeth if self.helix_senses(sense)[helix] > 0 else mirrored(teeth)

    def face_load(
        self, helix: int, normal_force: float, misalignment: float, stiffness: float, sense: int = 1
    ) -> FaceLoad:
        """How a helix carries along its face: by its loaded teeth, or as a line of springs of another mesh's stiffness.

        Args:
            normal_force: mean force (N) along the flank normal on this helix.
            misalignment: over the face (m), positive where the flanks stand apart at larger z.
            stiffness: of this helix along the flank normal (N/m), for a mesh without loaded teeth.
            sense: of the torque on the pinion about +z.

        Raises:
            AnalysisError: teeth or a load that the loaded contact can't do.
        """
        if self.part.stiffness != "tooth_fe":
            from rotorgear.gears.stiffness.face_load import uniform_line

            return uniform_line(stiffness, self.width, normal_force, misalignment)
        from rotorgear.gears.loaded.face import loaded_face

        with self._named_in_errors():
            found = loaded_face(self.helix_teeth(helix, sense, misalignment), _twelve_digits(normal_force))
        return found if self.helix_senses(sense)[helix] > 0 else found.mirrored

    @contextmanager
    def _named_in_errors(self) -> Iterator[None]:
        """Errors of the teeth say which mesh they are of."""
        try:
            yield
        except AnalysisError as error:
            raise AnalysisError(f"meshes.{self.name}: {error}") from None

    @property
    def elastic_gears(self) -> tuple[GearLayout, ...]:
        """Its gears whose wind-up between bore and teeth is left to the rotor model: wheels, unless they say otherwise."""
        if not self.has_loaded_teeth:
            return ()
        fe = self.teeth.fe
        # Teeth that are cut on their shaft have no bore to turn against, nor have rings.
        bodies = zip(self.gears, self.teeth.bodies, strict=True)
        return tuple(
            gear for gear, body in bodies if not gear.part.integral and body == "wheel" and fe.excludes_torsion(body)
        )

    def check_rims(self) -> None:
        """Loaded teeth on an elastic body are held where its rim is: below, its mesh gives, above the elements of the teeth.

        Raises:
            AnalysisError: they end elsewhere; it says the rim thickness that fits.
        """
        for gear in self.gears if self.has_loaded_teeth else ():
            wheel = gear.wheel
            geometry = gear.geometry
            if wheel is None or geometry is None:
                continue
            root = 0.5 * geometry.root_diameter
            module = geometry.normal_module
            held = root - self.part.tooth_fe.rim_thickness * module
            if abs(held - wheel.rim_radius) <= _BETWEEN * module:
                continue
            fitting = (root - wheel.rim_radius) / module
            remedy = f"say meshes.{self.name}.tooth_fe.rim_thickness = {fitting:.3g}"
            if fitting < 1.0:
                remedy = f"name a set of nodes at the radius {millimetres(held)} as gears.{gear.name}.body.rim"
            what = "would count twice" if held < wheel.rim_radius else "would be in neither"
            raise AnalysisError(
                f"meshes.{self.name}.tooth_fe: the loaded teeth of {gear.name} are held at the radius {millimetres(held)}, and "
                f"the rim of its mesh is at {millimetres(wheel.rim_radius)}: what gives between the two {what}. Make both one: "
                f"{remedy}."
            )

    @property
    def has_loaded_teeth(self) -> bool:
        """Whether its stiffness is that of its teeth by finite elements, under their load."""
        return self.part.stiffness == "tooth_fe" and self.has_teeth

    @property
    def is_modelled(self) -> bool:
        """Whether the file names a stiffness model."""
        return isinstance(self.part.stiffness, str) and not self.is_rigid

    @property
    def is_rigid(self) -> bool:
        """Whether its teeth do not give."""
        return self.part.stiffness == RIGID

    @property
    def varies(self) -> bool:
        """Whether the stiffness changes over the mesh period by itself: a list, a series or a model."""
        return not (self.is_rigid or isinstance(self.part.stiffness, int | float))

    @property
    def given_mean(self) -> float | None:
        """Mean stiffness along the flank normal (N/m, both helices) that the file gives; None where it names a model.

        Of rigid teeth one that is stiff beside all others, by which the torque flow finds their flanks.
        """
        given = STIFF if self.is_rigid else self.part.stiffness
        if isinstance(given, str):
            return None
        return sum(given) / len(given) if isinstance(given, tuple) else given

    def lead(self, helix: int, direction: int) -> float:
        """By which share of a mesh period the teeth of a helix are ahead in time of those of the first one.

        The stagger is how far the pinion's teeth at the larger z are ahead where the reference shaft turns about +z; turned
        the other way, the same teeth are behind.
        """
        return direction * self.part.stagger if helix else 0.0

    def helix_senses(self, sense: int = 1) -> tuple[int, ...]:
        """For each helix +1 where contact runs ahead at larger z (the pinion's teeth lead there), -1 where it runs behind.

        A right-hand helix is farther round about +z at larger z, so its flanks that push about +z (torque sense +1) lead
        there. A spur gear counts as +1.
        """
        first = self.pinion.hand * sense if self.pinion.hand else 1
        return (first, -first)[: self.helices]

    def helix_stiffness(
        self,
        normal_force: float | None = None,
        positions: int = POSITIONS,
        name: str | None = None,
        sense: int = 1,
        misalignments: Sequence[float] | None = None,
    ) -> tuple[MeshStiffness, ...]:
        """Stiffness of each helix over one mesh period, each counted from where its own teeth touch at the pitch point.

        Args:
            normal_force: mean force (N) along the flank normal on one helix; None where none flows.
            positions: how many positions of one mesh period, for a stiffness model.
            name: a stiffness model in place of what the file says.
            sense: of the torque on the pinion about +z; it matters where flanks differ along the face.
            misalignments: of each helix (m) in a state with tilted shafts; None for that of the file.

        Raises:
            AnalysisError: teeth or a load that the stiffness model can't do.
        """
        from rotorgear.gears.stiffness.mesh_stiffness import given_stiffness
        from rotorgear.gears.stiffness_models import mesh_stiffness

        given = name or self.part.stiffness
        angle = self.pinion.base_helix_angle
        load = None if not normal_force else _twelve_digits(_twelve_digits(normal_force) * math.cos(angle))
        if not isinstance(given, str):
            values = given if isinstance(given, tuple) else (given,)
            # A file gives both helices together, in phase: half of it is one helix.
            one = given_stiffness([value / self.helices for value in values], angle, 1, load, positions)
            return (one,) * self.helices
        if self.bevel is not None:
            from rotorgear.gears.stiffness.bevel import bevel_stiffness

            return (bevel_stiffness(self.bevel, self.width, load, positions),)
        with self._named_in_errors():
            return tuple(
                mesh_stiffness(given, self.helix_teeth(helix, sense, f), load, positions)
                for helix, f in enumerate(misalignments or (None,) * self.helices)
            )

    def face_map(
        self, helix: int, normal_force: float, asked: tuple[float, ...], sense: int = 1, near: bool = False
    ) -> FaceMap | None:
        """(F, M)(delta, tilt, u) of one helix at some misalignments (m), falling; None where its teeth are not loaded ones.

        Other arguments and errors as of `contact_map`.
        """
        if self.part.stiffness != "tooth_fe" or not normal_force:
            return None
        from rotorgear.gears.maps.face_map import face_map

        teeth = self.helix_teeth(helix, sense)
        load = _twelve_digits(normal_force)
        with self._named_in_errors():
            if self.helix_senses(sense)[helix] > 0:
                return face_map(teeth, load, asked, teeth.misalignment, near)
            behind = tuple(-f for f in reversed(asked))
            return face_map(teeth, load, behind, teeth.misalignment, near).mirrored

    def contact_map(
        self, helix: int, normal_force: float, sense: int = 1, near: bool = False, misalignment: float | None = None
    ) -> ContactMap | None:
        """F(delta, u) of one helix about a mean force (N) along the flank normal; None where its teeth are not loaded ones.

        `sense` is that of the torque on the pinion about +z; `near` gives the map for linear analyses; `misalignment` as of
        `helix_teeth`. Raises what `rotorgear.gears.maps.contact_map` raises.
        """
        if self.part.stiffness != "tooth_fe" or not normal_force:
            return None
        from rotorgear.gears.maps.solved_map import contact_map

        with self._named_in_errors():
            return contact_map(self.helix_teeth(helix, sense, misalignment), _twelve_digits(normal_force), near=near)

    def lead_on_path(self, sense: int) -> float:
        """By which share of a mesh period the second helix is ahead along the path of contact of the pinion, 0 to 1.

        The path runs from approach to recess of a pinion that a torque of the given sense about +z drives.
        """
        return (sense * self.sense(self.pinion) * self.part.stagger) % 1.0

    def both_helices(self, helices: tuple[MeshStiffness, ...], sense: int = 1) -> MeshStiffness:
        """Stiffness of the whole mesh from that of its helices, which stand in parallel, one ahead of the other."""
        return helices[0] if len(helices) == 1 else helices[0].of_both_helices(self.lead_on_path(sense), helices[1])

    def stiffness(
        self, normal_force: float | None = None, positions: int = POSITIONS, name: str | None = None, sense: int = 1
    ) -> MeshStiffness:
        """Stiffness of the whole mesh over one mesh period; arguments and errors as of `helix_stiffness`."""
        return self.both_helices(self.helix_stiffness(normal_force, positions, name, sense), sense)


def _twelve_digits(value: float) -> float:
    """A force without the rounding of the torque flow, which must not make another load: equal meshes are solved once."""
    return float(f"{value:.12g}")


def mirrored(teeth: ToothPair) -> ToothPair:
    """The pair seen from the other end of the face: that of the other hand, or with the other flanks in contact."""

    def seen(body: ToothBody) -> ToothBody:
        return replace(body, blank=body.blank and body.blank.mirrored())

    return replace(
        teeth,
        misalignment=-teeth.misalignment,
        first_flank=teeth.first_flank.mirrored(),
        second_flank=teeth.second_flank.mirrored(),
        first_body=seen(teeth.first_body),
        second_body=seen(teeth.second_body),
    )
