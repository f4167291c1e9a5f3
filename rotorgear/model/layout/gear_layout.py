"""A gear on its shaft: what follows from the gear, the shaft and the material, before any load; and the mass of disks.

Each fact is derived when it is first asked for and then kept, so that checks may ask for those that the sound parts of a
broken file allow.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Literal

from rotorgear.gears.geometry.blank import BlankShape, RigidBody, gear_blank, hollow_cylinder, solid_blank
from rotorgear.gears.geometry.geometry import GearGeometry
from rotorgear.model.layout.bevel import meeting, pair_of
from rotorgear.model.parts.gear import BLANK, DEPTHS, Flank, Gear
from rotorgear.model.parts.shaft import Disk, Place
from rotorgear.model.parts.tables import Tables

if TYPE_CHECKING:
    from rotorgear.casings.wheel import ReducedWheel
    from rotorgear.gears.geometry.flank import FlankModification
    from rotorgear.gears.stiffness.mesh_stiffness import ToothBody
    from rotorgear.gears.tooth_fe.blank_section import BlankTorsion
    from rotorgear.model.parts.shaft import Material


class GearLayout:
    """One gear of a model.

    Attributes:
        name, part: its name and what the file says of it.
        shaft: name of its shaft; shaft_part: that shaft.
        material: of its blank and teeth.
    """

    def __init__(self, model: Tables, name: str) -> None:
        self._model = model
        self.name = name
        self.part = model.gears[name]
        self.shaft = self.part.shaft
        self.shaft_part = model.shafts[self.shaft]
        self.material = model.material_of(self.shaft, name=self.part.material)

    @property
    def carrier_shaft(self) -> str | None:
        """Name of the shaft of the carrier that it goes round with; None of a gear that is no planet."""
        carrier = self.shaft_part.carrier
        return None if carrier is None else self._model.carriers[carrier].shaft

    @property
    def geometry(self) -> GearGeometry | None:
        """ISO 21771 geometry; None for a lumped gear."""
        return self.part.geometry

    @property
    def base_radius(self) -> float:
        """r_b in m, given or from the teeth; of a bevel gear at its mean point."""
        if self.part.is_bevel:
            return self._bevel_numbers[0]
        return abs(self.geometry.base_radius) if self.geometry else (self.part.base_radius or 0.0)

    @property
    def base_helix_angle(self) -> float:
        """b_b in rad, given or from the teeth; 0 for a spur gear; of a bevel gear at its mean point."""
        if self.part.is_bevel:
            return self._bevel_numbers[1]
        return self.geometry.base_helix_angle if self.geometry else (self.part.base_helix_angle or 0.0)

    @cached_property
    def _bevel_numbers(self) -> tuple[float, float]:
        """r_b and b_b at the mean point of a bevel gear, whose cone is that of its first mesh; 0 without one."""
        for mesh in self._model.meshes.values():
            if self.name in (mesh.pinion, mesh.gear):
                first, second = (self._model.gears[name] for name in (mesh.pinion, mesh.gear))
                shafts = (self._model.shafts[first.shaft], self._model.shafts[second.shaft])
                met = meeting(shafts, (shafts[0].station(first.at), shafts[1].station(second.at)))
                if met is not None:
                    pair = pair_of(met, first, second)
                    return pair.base_radii[0 if mesh.pinion == self.name else 1], pair.base_helix_angle
        return 0.0, 0.0

    @property
    def hand(self) -> int:
        """+1 for a right-hand helix (of a herringbone: that at the smaller z), -1 for a left-hand one, 0 for a spur gear."""
        return 0 if self.part.kind == "spur" else {"right": 1, "left": -1, None: 0}[self.part.hand]

    @property
    def helices(self) -> int:
        """2 for a herringbone, else 1."""
        return 2 if self.part.kind == "herringbone" else 1

    @property
    def z(self) -> float:
        """z of the gear's middle in m."""
        return self.shaft_part.station(self.part.at)

    @property
    def planes(self) -> tuple[float, ...]:
        """z in m of the mid-plane of each helix, from left to right."""
        offset = self.part.helix_offset
        return (self.z - offset, self.z + offset) if self.helices == 2 else (self.z,)

    @property
    def places(self) -> tuple[Place, ...]:
        """Where its nodes stand: one, or one for each helix from left to right."""
        z = self.planes if self.part.node_count == 2 else (self.z,)
        return tuple(Place(self.shaft, at) for at in z)

    @property
    def bore(self) -> float:
        """Bore in m: given, or the shaft's diameter there."""
        if self.part.body.bore is not None:
            return self.part.body.bore
        return max(self.shaft_part.diameter_at(place.z) for place in self.places)

    @property
    def ring_diameter(self) -> float:
        """Outer diameter (m) of a toothed ring: given, or by the rim around its roots; 0 where neither is."""
        body = self.part.body
        if body.rim_thickness is None or self.geometry is None:
            return body.outer_diameter or 0.0
        return 2.0 * body.rim_thickness - self.geometry.root_diameter

    @cached_property
    def wheel(self) -> ReducedWheel | None:
        """The elastic body of a gear with a mesh, reduced once and kept; None where it is rigid.

        Raises:
            AnalysisError: what is wrong with the mesh. MissingExtraError: meshio or scikit-fem is not installed.
        """
        if self.part.body.mesh is None:
            return None
        from rotorgear.model.layout.casings import reduced_wheel

        return reduced_wheel(self.name, self.part, self.mesh_material)

    @property
    def mesh_material(self) -> Material:
        """Material of the mesh of its body."""
        return self._model.material_of(self.shaft, name=self.part.body.material or self.part.material)

    @cached_property
    def body(self) -> RigidBody:
        """Mass and inertias of the whole gear about its middle, given, from its blank or from its mesh.

        Raises:
            ValueError: the sizes make no blank; the text is what was expected.
        """
        gear = self.part
        if self.wheel is not None:
            steiner = self.wheel.body_mass * self.wheel.centre**2
            diametral = self.wheel.diametral_inertia + steiner
            return RigidBody(self.wheel.body_mass, self.wheel.polar_inertia, diametral)
        if inertia_is_given(gear):
            return given_body(gear)
        if self.geometry is None or not gear.width:
            raise ValueError("mass and inertias, or teeth, module and width to compute them from")
        if gear.internal:
            # Its teeth count as a solid ring from the reference diameter on.
            inside = -self.geometry.reference_diameter
            if not self.ring_diameter:
                raise ValueError(
                    "body.rim_thickness or body.outer_diameter of the ring, or mass and moments of inertia"
                )
            helix = hollow_cylinder(self.ring_diameter, inside, gear.width, self.material.density)
        else:
            helix = gear_blank(
                self.geometry.reference_diameter,
                self.bore,
                gear.width,
                self.material.density,
                root_diameter=self.geometry.root_diameter,
                **{key: getattr(gear.body, key) for key in BLANK},
            )
        if self.helices == 1:
            return helix
        steiner = helix.mass * gear.helix_offset**2
        return RigidBody(2.0 * helix.mass, 2.0 * helix.polar_inertia, 2.0 * (helix.diametral_inertia + steiner))

    @cached_property
    def torsion(self) -> BlankTorsion:
        """How the teeth at each of its nodes turn against the bore; of a gear with teeth and width."""
        from rotorgear.gears.tooth_fe.blank_section import blank_torsion

        assert self.geometry is not None
        assert self.part.width is not None
        m = self.geometry.normal_module
        radii = (0.5 * self.geometry.root_diameter / m, 0.5 * self.geometry.reference_diameter / m)
        blank = self.blank.scaled(1.0 / m).with_core(radii[0])
        helix = blank_torsion(blank, self.part.width / m, radii, self.material.nu)
        # In normal modules for a Young's modulus of 1; both helices of a herringbone on one node stand side by side.
        scale = len(self.places) / (self.helices * self.material.youngs_modulus * m**3)
        return replace(helix, flexibility=scale * helix.flexibility)

    @property
    def node_bodies(self) -> tuple[tuple[str, Place, RigidBody], ...]:
        """Address, place and body at each node. Two halves that are tied rigidly have the mass and inertias of the whole."""
        body = self.body
        if len(self.places) == 2:
            tilt = 0.5 * (body.diametral_inertia - body.mass * self.part.helix_offset**2)
            body = RigidBody(0.5 * body.mass, 0.5 * body.polar_inertia, tilt)
        return tuple((f"gears.{self.name}", place, body) for place in self.places)

    @cached_property
    def flank(self) -> FlankModification:
        """The left flank, which works where the torque on the pinion is positive about +z."""
        return self.flank_of("left")

    @property
    def flanks_differ(self) -> bool:
        """Whether left and right flanks were measured apart."""
        measured = self.part.flank.topography
        return measured is not None and any(grid.flank is not None for grid in measured.grids)

    def flank_of(self, side: Literal["right", "left"]) -> FlankModification:
        """Modifications of the flanks of one side along roll length and face; none for a lumped gear.

        Sides are those of a tooth that points up, seen from the end of larger z. What is given beside a topography is that of
        both sides.
        """
        from rotorgear.gears.geometry.flank import FlankGrid, FlankModification
        from rotorgear.gears.geometry.outline import tooth_outline

        geometry = self.geometry
        given = self.part.flank
        if geometry is None or (given == Flank() and not self.part.tip_relief):
            return FlankModification()
        outline = tooth_outline(geometry)

        def roll(diameter: float | None) -> float:
            return geometry.sign * math.sqrt(max(0.25 * (diameter or 0.0) ** 2 - geometry.base_radius**2, 0.0))

        tip = outline.tip_form_roll_length(given.tip_rounding, given.tip_chamfer)
        grids: dict[int | None, FlankGrid] = {}
        # What was measured on one side alone counts there before what stands for both.
        measured = sorted(given.topography.grids if given.topography else (), key=lambda grid: grid.flank is not None)
        for grid in measured:
            if grid.flank not in (None, side):
                continue
            places = grid.places
            if given.topography and given.topography.by == "diameter":
                places = tuple(roll(diameter) for diameter in places)
            # A deviation is positive where material stands out, a depth where it is taken off.
            depth = tuple(tuple(-value for value in row) for row in grid.deviation)
            grids[grid.tooth] = FlankGrid(places, grid.z, depth)
        return FlankModification(
            tip_relief=self.part.tip_relief,
            tip_relief_length=tip - roll(self.part.tip_relief_diameter),
            **{key: getattr(given, key) for key in DEPTHS},
            root_relief_length=roll(given.root_relief_diameter) - outline.form_roll_length,
            end_relief_length=given.end_relief_length,
            tip_break=outline.tip_roll_length - tip,
            topography=grids.pop(None, None),
            tooth_topography=tuple((tooth, grid) for tooth, grid in grids.items() if tooth is not None),
            pitch_error=tuple((int(tooth), error) for tooth, error in sorted(given.pitch_errors.items())),
        )

    @property
    def tooth_body(self) -> ToothBody:
        """Material and blank that carry its teeth."""
        from rotorgear.gears.stiffness.mesh_stiffness import ToothBody

        rim = self.part.body.rim_thickness
        web = self.part.body.web_thickness
        if self.part.internal:
            return ToothBody(self.material.youngs_modulus, self.material.nu, 0.5 * self.ring_diameter, 1.0, rim)
        inner = 0.5 * self.bore
        if rim is not None and self.geometry is not None:
            inner = 0.5 * self.geometry.root_diameter - rim
        share = 1.0 if web is None or not self.part.width else web / self.part.width
        return ToothBody(self.material.youngs_modulus, self.material.nu, inner, share, rim, self.blank)

    @property
    def blank(self) -> BlankShape:
        """Rim, web and hub of one helix of an external gear; a full disc where the file gives no rim."""
        given = self.part.body
        bore = 0.5 * self.bore
        if given.rim_thickness is None or given.web_thickness is None or self.geometry is None:
            return solid_blank(bore)
        return BlankShape(
            bore_radius=bore,
            rim_radius=0.5 * self.geometry.root_diameter - given.rim_thickness,
            web_thickness=given.web_thickness,
            web_position=given.web_position,
            hub_radius=bore if given.hub_diameter is None else 0.5 * given.hub_diameter,
            hub_width=given.hub_width or self.part.width or 0.0,
        )


def inertia_is_given(part: Gear | Disk) -> bool:
    """Whether the part gives its mass or a moment of inertia itself."""
    return not (part.mass is None and part.polar_inertia is None and part.diametral_inertia is None)


def given_body(part: Gear | Disk) -> RigidBody:
    """Mass and inertias as the part gives them; what it leaves out is 0."""
    return RigidBody(part.mass or 0.0, part.polar_inertia or 0.0, part.diametral_inertia or 0.0)
