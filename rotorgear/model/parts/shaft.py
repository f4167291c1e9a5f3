"""Shafts: an axis in space, and sections along it; and the disks and point masses on them."""

from __future__ import annotations

from functools import cached_property
from typing import Annotated, Any, Literal, NamedTuple, Self

from pydantic import Discriminator, Field, Tag, model_validator

from rotorgear.model.parts import fields as si
from rotorgear.model.parts.fields import Flag, Part, Station, Whole, refuse
from rotorgear.model.parts.frame import Frame, frame_along
from rotorgear.model.parts.problems import LIST, TABLE


class Material(Part):
    """An isotropic elastic material: two of E, G and nu are enough."""

    youngs_modulus: si.Modulus = Field(description="Young's modulus E")
    density: si.Density = Field(description="density")
    poisson_ratio: si.Ratio | None = Field(None, description="Poisson's ratio nu; follows from G where that is given")
    shear_modulus: si.Modulus | None = Field(None, description="shear modulus G; follows from nu where that is given")

    @property
    def nu(self) -> float:
        """Poisson's ratio, from E and G where it is not given."""
        if self.poisson_ratio is not None:
            return self.poisson_ratio
        return self.youngs_modulus / (2.0 * self.shear_modulus) - 1.0 if self.shear_modulus else 0.3

    @property
    def g(self) -> float:
        """Shear modulus in Pa, from E and nu where it is not given."""
        if self.shear_modulus is not None:
            return self.shear_modulus
        return self.youngs_modulus / (2.0 * (1.0 + self.nu))


# Handbook values at room temperature; a model that needs others gives them under [materials].
LIBRARY = {
    "steel": Material(youngs_modulus=206e9, poisson_ratio=0.3, density=7850.0),
    "stainless_steel": Material(youngs_modulus=193e9, poisson_ratio=0.29, density=8000.0),
    "cast_iron": Material(youngs_modulus=110e9, poisson_ratio=0.26, density=7200.0),
    "ductile_iron": Material(youngs_modulus=169e9, poisson_ratio=0.275, density=7100.0),
    "aluminium": Material(youngs_modulus=70e9, poisson_ratio=0.33, density=2700.0),
    "titanium": Material(youngs_modulus=114e9, poisson_ratio=0.34, density=4430.0),
    "bronze": Material(youngs_modulus=110e9, poisson_ratio=0.34, density=8800.0),
    "brass": Material(youngs_modulus=105e9, poisson_ratio=0.35, density=8500.0),
}


class Section(Part):
    """Part of a shaft between two values of z, cylindrical or conical."""

    length: si.PositiveLength = Field(description="length along z")
    outer_diameter: si.PositiveLength = Field(description="outer diameter (at the left end of a cone)")
    bore: si.NonNegativeLength = Field(0.0, description="inner diameter (at the left end of a cone)")
    outer_diameter_end: si.PositiveLength | None = Field(None, description="outer diameter at the right end of a cone")
    bore_end: si.NonNegativeLength | None = Field(None, description="inner diameter at the right end of a cone")
    mass_outer_diameter: si.PositiveLength | None = Field(
        None, description="outer diameter that counts for the mass, where it differs from that for the stiffness"
    )
    mass_outer_diameter_end: si.PositiveLength | None = Field(
        None, description="the same at the right end; default: as at the left end"
    )
    mass_bore: si.NonNegativeLength | None = Field(None, description="inner diameter that counts for the mass")
    mass_bore_end: si.NonNegativeLength | None = Field(None, description="the same at the right end")
    material: str | None = Field(None, description="name of a material; default: the shaft's")
    shear_coefficient: si.PositiveRatio | None = Field(None, description="shear coefficient kappa; default: Cowper's")
    rigid: Flag = Field(False, description="true: moves as a rigid body (it keeps its mass)")
    elements: Whole | None = Field(None, description="elements of this section; overrides --elements")

    def stiffness_diameters(self) -> tuple[float, float, float, float]:
        """Outer and inner diameter at the left end, outer and inner at the right end, in m."""
        outer_end = self.outer_diameter if self.outer_diameter_end is None else self.outer_diameter_end
        bore_end = self.bore if self.bore_end is None else self.bore_end
        return self.outer_diameter, self.bore, outer_end, bore_end

    def diameters_at(self, share: float) -> tuple[float, float]:
        """Outer and inner diameter in m at a share of the length from the left end."""
        outer, bore, outer_end, bore_end = self.stiffness_diameters()
        return outer + (outer_end - outer) * share, bore + (bore_end - bore) * share

    def mass_diameters(self) -> tuple[float, float, float, float]:
        """The same four diameters as they count for the mass."""
        outer, bore, outer_end, bore_end = self.stiffness_diameters()
        if self.mass_outer_diameter is not None:
            outer = self.mass_outer_diameter
            outer_end = outer if self.mass_outer_diameter_end is None else self.mass_outer_diameter_end
        if self.mass_bore is not None:
            bore = self.mass_bore
            bore_end = bore if self.mass_bore_end is None else self.mass_bore_end
        return outer, bore, outer_end, bore_end


class PositionByMesh(Part):
    """The place of a shaft beside the one that a mesh joins it to, at the centre distance of their teeth."""

    mesh: str = Field(description="name of the mesh, of a gear on this shaft with one on a shaft that has its place")
    angle: si.Angle = Field(
        description="direction from the axis of that shaft to this one, from its own +x about its +z"
    )


def _kind_of_position(value: Any) -> str:
    return TABLE if isinstance(value, dict | PositionByMesh) else LIST


Position = Annotated[
    Annotated[si.Position, Tag(LIST)] | Annotated[PositionByMesh, Tag(TABLE)], Discriminator(_kind_of_position)
]


class Shaft(Part):
    """A shaft: an axis, and sections from its start on. Without sections it is one rigid point.

    Its places, displacements and forces are told in its own frame, whose z is the axis.
    """

    position: Position | None = Field(
        None,
        description="(x, y) of the axis, or (x, y, z) of its z = 0, or { mesh, angle }; may be left out where all axes are "
        "parallel to z and no gear on the shaft needs a centre distance",
    )
    axis: si.Direction = Field((0.0, 0.0, 1.0), description="direction of its own +z in space")
    x_axis: si.Direction | None = Field(
        None,
        description="direction of its own +x, made square to the axis; default: x of the model, or y for an axis along x",
    )
    start: si.Length = Field(0.0, description="z of the left end of the first section")
    sections: tuple[Section, ...] = Field((), description="sections from left to right")
    material: str = Field("steel", description="name of a material, from [materials] or the library")
    shear_deformation: Flag = Field(True, description="false: no shear deformation (kappa G A infinite)")
    mass_matrix: Literal["consistent", "lumped"] = Field("consistent", description="inertia of the elements")
    internal_damping: si.Time = Field(
        0.0, description="viscous rotating damping eta of the material: C = eta K of the shaft"
    )
    speed_ratio: si.SignedRatio | None = Field(
        None,
        description="speed relative to the input shaft, where no mesh or coupling leads to this shaft, or as the second given "
        "speed of a train with carriers; 0: the shaft is held",
    )
    speed: si.Speed | None = Field(
        None,
        description="the same as a speed at the operating point; with another input speed it changes in proportion",
    )
    carrier: str | None = Field(
        None, description="name of the carrier on whose pins the shaft runs, in place of a position: it is a planet's"
    )
    radius: si.PositiveLength | None = Field(
        None, description="a planet's: radius of its pins' circle; default: the carrier's, or that of its meshes"
    )
    offset: si.Angle | None = Field(
        None,
        description="a planet's: angle of its pins ahead of those of the carrier; default: 0, or where it meshes with another "
        "planet",
    )

    @model_validator(mode="after")
    def _has_two_directions(self) -> Self:
        if self.x_axis is not None:
            try:
                _ = self.frame
            except ValueError:
                raise refuse("an x_axis that is not along the axis") from None
        return self

    @cached_property
    def frame(self) -> Frame:
        """Its own coordinates; those of a shaft without a position begin at the origin."""
        return frame_along(self.origin or (0.0, 0.0), self.axis, self.x_axis)

    @property
    def origin(self) -> tuple[float, ...] | None:
        """(x, y), or (x, y, z) of its z = 0, in m; None without a position, and until its mesh has placed it."""
        return None if isinstance(self.position, PositionByMesh) else self.position

    @property
    def length(self) -> float:
        """Sum of the sections' lengths in m."""
        return sum(section.length for section in self.sections)

    @property
    def end(self) -> float:
        """z of the right end in m."""
        return self.start + self.length

    def station(self, at: float | str) -> float:
        """z in m of a place on this shaft: a number as it is, or "start" or "end"."""
        if isinstance(at, str):
            return self.start if at == "start" else self.end
        return at

    def diameter_at(self, z: float) -> float:
        """Largest outer diameter in m of the sections that touch `z`; 0 for a shaft without sections."""
        return max(self.diameters_at(z), default=0.0)

    def diameters_at(self, z: float) -> list[float]:
        """Outer diameters in m of the sections that touch `z`: two at a step."""
        left = self.start
        found = []
        tolerance = 1e-9 * max(self.length, abs(z))
        for section in self.sections:
            right = left + section.length
            if left - tolerance <= z <= right + tolerance:
                outer, _ = section.diameters_at(min(max((z - left) / section.length, 0.0), 1.0))
                found.append(outer)
            left = right
        return found

    def elastic_sides(self, z: float) -> tuple[bool, bool]:
        """Whether an elastic section touches z from the left, and whether one goes on to the right of it."""
        left = self.start
        sides = [False, False]
        tolerance = 1e-9 * max(self.length, abs(z))
        for section in self.sections:
            right = left + section.length
            if not section.rigid:
                sides[0] |= left + tolerance < z <= right + tolerance
                sides[1] |= left - tolerance <= z < right - tolerance
            left = right
        return sides[0], sides[1]


class Place(NamedTuple):
    """Name of a shaft and z on it in m."""

    shaft: str
    z: float


class Disk(Part):
    """A rigid disk: mass and inertias given, or a plain cylinder by its size."""

    shaft: str = Field(description="name of the shaft")
    at: Station = Field(description="z of the middle")
    mass: si.Mass | None = Field(None, description="mass")
    polar_inertia: si.Inertia | None = Field(None, description="moment of inertia about z")
    diametral_inertia: si.Inertia | None = Field(None, description="moment of inertia about x and y through the middle")
    outer_diameter: si.PositiveLength | None = Field(None, description="outer diameter of a plain cylinder")
    bore: si.NonNegativeLength | None = Field(None, description="its bore; default: the shaft's diameter there")
    width: si.PositiveLength | None = Field(None, description="its width")
    material: str | None = Field(None, description="its material; default: the shaft's")


class PointMass(Part):
    """A mass without moments of inertia."""

    shaft: str = Field(description="name of the shaft")
    at: Station = Field(description="z of the place")
    mass: si.Mass = Field(description="mass")
