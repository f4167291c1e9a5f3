"""Gears: spur, helical, herringbone or bevel, by their teeth, or by base radius and transverse angle for lumped models.

Their flanks may deviate from the involute helicoid, by modifications and by errors.
"""

from __future__ import annotations

from functools import cached_property
from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from rotorgear.gears.geometry.geometry import GearGeometry
from rotorgear.gears.geometry.pair import Allowance
from rotorgear.model.parts import fields as si
from rotorgear.model.parts.casing import Seat, TextOrTable
from rotorgear.model.parts.fields import Flag, Name, Part, Station, Whole
from rotorgear.model.parts.topography import TopographyFile

# Sizes of a gear's blank beside its bore.
BLANK = ("rim_thickness", "web_thickness", "web_position", "hub_diameter", "hub_width")
# Modifications of a flank that are depths.
DEPTHS = ("root_relief", "crowning", "profile_crowning", "profile_slope", "end_relief", "helix_slope", "bias")


class Flank(Part):
    """Modifications and errors of the flanks, along the flank normal. Tip relief stands in the gear itself."""

    root_relief: si.NonNegativeLength = Field(0.0, description="linear relief at the form circle")
    root_relief_diameter: si.PositiveLength | None = Field(None, description="diameter at which the root relief starts")
    crowning: si.NonNegativeLength = Field(0.0, description="lead crowning: parabolic relief at both ends of the face")
    profile_crowning: si.NonNegativeLength = Field(
        0.0, description="profile crowning (barrelling): parabolic relief at form circle and tip"
    )
    profile_slope: si.Length = Field(0.0, description="depth at the tip less that at the form circle")
    end_relief: si.NonNegativeLength = Field(0.0, description="linear relief at both ends of the face")
    end_relief_length: si.NonNegativeLength = Field(0.0, description="length of the end relief along the face")
    helix_slope: si.Length = Field(0.0, description="depth at the end of larger z less that at the end of smaller z")
    bias: si.Length = Field(
        0.0, description="twist of the flank: profile slope at the end of larger z less that at the end of smaller z"
    )
    tip_rounding: si.NonNegativeLength = Field(
        0.0, description="radius of the rounded tip edge; the involute ends where it begins"
    )
    tip_chamfer: si.NonNegativeLength = Field(
        0.0, description="radial height of the chamfered tip edge; the involute ends below it"
    )
    topography: TopographyFile | None = Field(
        None, description="CSV file of measured deviations, beside the model file, added to the rest"
    )
    pitch_errors: dict[Name, si.Length] = Field(
        default_factory=dict,
        description="tooth number -> how far its flank stands back along the line of action; tooth 0 meshes first",
    )


class GearBody(Part):
    """A gear's blank, for its mass and its compliance: rim, web and hub, or a finite-element mesh. What is left out is solid."""

    bore: si.NonNegativeLength | None = Field(None, description="bore; default: the shaft's diameter there")
    outer_diameter: si.PositiveLength | None = Field(
        None, description="outer diameter of a ring, in place of its rim_thickness"
    )
    rim_thickness: si.PositiveLength | None = Field(
        None, description="thickness of the rim below the tooth roots; of a ring all that is around them"
    )
    web_thickness: si.PositiveLength | None = Field(
        None, description="thickness of the web along z, between rim and hub"
    )
    web_position: si.Length = Field(0.0, description="z of the web's middle from the middle of the face")
    hub_diameter: si.PositiveLength | None = Field(None, description="outer diameter of the hub")
    hub_width: si.PositiveLength | None = Field(None, description="width of the hub along z")
    mesh: str | None = Field(
        None,
        description="file of a finite-element mesh of an elastic body, beside the model file; z is its axis, and its middle "
        "the origin",
    )
    unit: Literal["m", "dm", "cm", "mm", "um", "in", "ft"] | None = Field(
        None, description="unit of length of the mesh: such files carry none"
    )
    material: str | None = Field(None, description="material of the mesh; default: the gear's")
    seat: Annotated[Seat | None, TextOrTable()] = Field(
        None, description="where the mesh sits on its shaft, its bore: a face or node set, or a place"
    )
    rim: Annotated[Seat | None, TextOrTable()] = Field(
        None, description="face of the mesh that carries the teeth: a face or node set, or a place"
    )
    connection: Literal["rigid", "mean"] = Field(
        "rigid",
        description="whether the shaft holds the bore as a rigid body (RBE2), or in its mean motion alone (RBE3)",
    )
    modes_to: si.Frequency | None = Field(
        None, description="highest frequency of the modes of the mesh on its bore that are kept; default: the lowest 20"
    )
    damping_ratio: si.Ratio = Field(0.0, description="damping ratio of every mode of the mesh on its bore")
    mass_tolerance: si.PositiveRatio = Field(
        0.05, description="how far the mesh's mass and inertias may be off those that the gear states"
    )


class Gear(Part):
    """A gear on a shaft: a cylindrical one, external or internal, or a bevel gear."""

    shaft: str = Field(description="name of the shaft")
    at: Station = Field(description="z of the gear's middle; of a bevel gear the foot of its mean point on the axis")
    casing: str | None = Field(
        None,
        description="of a ring in place of shaft and at: name of the casing that it stands in, whose seat has the ring's name",
    )
    kind: Literal["spur", "helical", "herringbone", "bevel"] = Field(
        description="spur, helical, herringbone or bevel (straight, Zerol and spiral)"
    )
    internal: Flag = Field(
        False, description="whether it is a ring with its teeth inside; its teeth and diameters are positive here"
    )
    teeth: Whole | None = Field(None, description="number of teeth")
    normal_module: si.PositiveLength | None = Field(None, description="normal module m_n")
    normal_pressure_angle: si.Angle = Field(0.3490658503988659, description="normal pressure angle alpha_n")
    outer_module: si.PositiveLength | None = Field(
        None, description="bevel: transverse module at the outer cone distance, m_et"
    )
    mean_normal_module: si.PositiveLength | None = Field(
        None, description="bevel: normal module at the mean cone distance, m_mn, in place of the outer one"
    )
    spiral_angle: si.Angle = Field(
        0.0, description="bevel: spiral angle at the mean cone distance, positive; 0: straight or Zerol"
    )
    helix_angle: si.Angle | None = Field(None, description="helix angle beta at the reference circle, positive")
    hand: Literal["right", "left"] | None = Field(
        None, description="hand of the helix or spiral; of a herringbone: of the helix at the smaller z"
    )
    width: si.PositiveLength | None = Field(None, description="face width (of one helix)")
    integral: Flag = Field(
        False,
        description="whether the teeth are cut on the shaft: in meshes with tilt = true they bend and twist with it along "
        "the face",
    )
    gap: si.NonNegativeLength = Field(0.0, description="gap between the helices of a herringbone")
    profile_shift: si.SignedRatio = Field(0.0, description="profile shift coefficient x")
    addendum_factor: si.PositiveRatio = Field(1.0, description="addendum of the rack over m_n")
    dedendum_factor: si.PositiveRatio = Field(1.25, description="dedendum of the rack over m_n")
    tip_diameter: si.PositiveLength | None = Field(None, description="tip diameter; default: from addendum and shift")
    root_radius_factor: si.Ratio | None = Field(
        None, description="tip radius of the rack over m_n, which cuts the root fillet; default: that of ISO 53"
    )
    cutter_teeth: Whole | None = Field(
        None, description="teeth of the pinion-type cutter of a ring; default: half of the ring's, at most 30"
    )
    tip_relief: si.NonNegativeLength = Field(
        0.0, description="linear tip relief C_a at the tip circle, normal to the flank"
    )
    tip_relief_diameter: si.PositiveLength | None = Field(None, description="diameter at which the tip relief starts")
    flank: Flank = Field(default_factory=Flank, description="further modifications and errors of the flanks")
    upper_thickness_allowance: si.Length = Field(
        0.0, description="upper allowance E_sns of the normal tooth thickness, 0 or negative, for the backlash"
    )
    lower_thickness_allowance: si.Length | None = Field(
        None, description="lower allowance E_sni of the normal tooth thickness; default: the upper one"
    )
    ball_diameter: si.PositiveLength | None = Field(
        None,
        description="diameter of the balls or pins that the gear is measured over; default: the ideal one, rounded up",
    )
    accuracy_grade: Whole | None = Field(None, description="flank tolerance class 1 to 11 of ISO 1328-1, for K_v")
    base_radius: si.PositiveLength | None = Field(
        None, description="base radius of a lumped gear, in place of the module"
    )
    transverse_pressure_angle: si.Angle | None = Field(None, description="transverse pressure angle of a lumped gear")
    base_helix_angle: si.Angle | None = Field(None, description="base helix angle of a lumped helical gear")
    clocking: si.Angle | None = Field(
        None,
        description="angle of a tooth's middle from the mark of the shaft, about +z; default: what closes a loop, else 0",
    )
    nodes: Literal[1, 2] | None = Field(
        None, description="herringbone: 2 = a node for each helix, joined by the shaft (default); 1 = one rigid node"
    )
    mass: si.Mass | None = Field(None, description="mass of the whole gear; default: from the blank")
    polar_inertia: si.Inertia | None = Field(None, description="moment of inertia about z of the whole gear")
    diametral_inertia: si.Inertia | None = Field(None, description="moment of inertia about x and y through its middle")
    body: GearBody = Field(default_factory=GearBody, description="shape of the blank, for mass and compliance")
    material: str | None = Field(None, description="material of the blank; default: the shaft's")

    @model_validator(mode="before")
    @classmethod
    def _stands_in_a_casing(cls, data: Any) -> Any:
        """A ring in a casing has no shaft and no place on one."""
        if isinstance(data, dict) and data.get("casing") is not None:
            return {"shaft": "", "at": 0.0, **data}
        return data

    @property
    def lumped(self) -> bool:
        """Whether the gear is given by its base radius instead of its teeth."""
        return self.base_radius is not None

    @property
    def is_bevel(self) -> bool:
        """Whether it is a bevel gear."""
        return self.kind == "bevel"

    @cached_property
    def geometry(self) -> GearGeometry | None:
        """ISO 21771 geometry of a cylindrical gear given by its teeth; None for others or one with missing data.

        Teeth and diameters of a ring are negative there.
        """
        if self.lumped or self.is_bevel or self.teeth is None or self.normal_module is None:
            return None
        sign = -1 if self.internal else 1
        return GearGeometry(
            teeth=sign * self.teeth,
            normal_module=self.normal_module,
            normal_pressure_angle=self.normal_pressure_angle,
            helix_angle=self.helix_angle or 0.0,
            profile_shift=self.profile_shift,
            addendum_factor=self.addendum_factor,
            dedendum_factor=self.dedendum_factor,
            tip_diameter=None if self.tip_diameter is None else sign * self.tip_diameter,
            root_radius_factor=self.root_radius_factor,
            cutter_teeth=self.cutter_teeth,
        )

    @property
    def allowance(self) -> Allowance:
        """Allowances of the normal tooth thickness."""
        upper = self.upper_thickness_allowance
        return Allowance(upper, upper if self.lower_thickness_allowance is None else self.lower_thickness_allowance)

    @property
    def node_count(self) -> int:
        """Nodes of the gear on its shaft: 2 for a herringbone unless it says 1, else 1."""
        if self.kind != "herringbone":
            return 1
        return self.nodes or 2

    @property
    def helix_offset(self) -> float:
        """Distance in m of a helix' mid-plane from the gear's middle: (gap + width)/2 for a herringbone, else 0."""
        return 0.5 * (self.gap + (self.width or 0.0)) if self.kind == "herringbone" else 0.0

    @property
    def total_width(self) -> float:
        """Width over all in m; 0 where no width is given."""
        width = self.width or 0.0
        return 2.0 * width + self.gap if self.kind == "herringbone" else width
