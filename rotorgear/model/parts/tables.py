"""The tables of a model file as named, frozen parts, each sound by itself."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Literal

from pydantic import Field

from rotorgear.model.parts.carrier import Carrier
from rotorgear.model.parts.casing import Casing
from rotorgear.model.parts.fields import Name, Part
from rotorgear.model.parts.gear import Gear
from rotorgear.model.parts.load import Load, Unbalance
from rotorgear.model.parts.mesh import Mesh
from rotorgear.model.parts.operation import ModelDamping, Operation, Point, Scatter
from rotorgear.model.parts.shaft import LIBRARY, Disk, Material, PointMass, Section, Shaft
from rotorgear.model.parts.supports import Bearing, Coupling, NonlinearElement, Support


class Tables(Part):
    """All parts of a model by name. Whether they fit each other is checked by `Model`."""

    schema_version: Literal[1] = Field(1, description="version of this file format; this rotorgear reads 1")
    title: str = Field("", description="what the model is, in a line")
    motions: tuple[Literal["bending", "axial", "torsion"], ...] = Field(
        ("bending", "axial", "torsion"), description="motions the model has; the others are held fixed in every node"
    )
    operation: Operation | None = Field(None, description="operating point")
    materials: dict[Name, Material] = Field(default_factory=dict, description="materials besides the library")
    shafts: dict[Name, Shaft] = Field(default_factory=dict, description="shafts")
    carriers: dict[Name, Carrier] = Field(default_factory=dict, description="planet carriers")
    disks: dict[Name, Disk] = Field(default_factory=dict, description="rigid disks")
    point_masses: dict[Name, PointMass] = Field(default_factory=dict, description="point masses")
    gears: dict[Name, Gear] = Field(default_factory=dict, description="gears")
    meshes: dict[Name, Mesh] = Field(default_factory=dict, description="meshes between gears")
    bearings: dict[Name, Bearing] = Field(default_factory=dict, description="bearings")
    casings: dict[Name, Casing] = Field(default_factory=dict, description="elastic casings")
    supports: dict[Name, Support] = Field(default_factory=dict, description="supports to ground")
    couplings: dict[Name, Coupling] = Field(default_factory=dict, description="couplings between shafts")
    nonlinear_elements: dict[Name, NonlinearElement] = Field(
        default_factory=dict, description="force laws between shafts, or a shaft and the ground"
    )
    damping: ModelDamping = Field(default_factory=ModelDamping, description="damping of the model as a whole")
    loads: dict[Name, Load] = Field(default_factory=dict, description="torques and forces")
    unbalances: dict[Name, Unbalance] = Field(default_factory=dict, description="unbalances of shafts")
    points: dict[Name, Point] = Field(default_factory=dict, description="named points with a direction")
    scatter: dict[str, Scatter] = Field(
        default_factory=dict, description="how far numbers scatter, by address; * stands for all names or places there"
    )

    def material_of(self, shaft: str, section: Section | None = None, name: str | None = None) -> Material:
        """Return the material of a shaft, of one of its sections, or of a body on it with its own material name."""
        own = name or (section.material if section else None) or self.shafts[shaft].material
        return self.materials[own] if own in self.materials else LIBRARY[own]

    def parts_of(self, *tables: str) -> Iterator[tuple[str, Any]]:
        """Address and part of all parts in some tables."""
        for table in tables:
            for name, part in getattr(self, table).items():
                yield f"{table}.{name}", part

    @property
    def has_turned_axes(self) -> bool:
        """Whether the directions of some shaft are not those of the model."""
        return any(shaft.frame.is_turned for shaft in self.shafts.values())

    def has(self, motion: str) -> bool:
        """Whether the model has a motion: bending, axial or torsion."""
        return motion in self.motions

    @property
    def operating_speed(self) -> float | None:
        """Speed of the reference shaft at the operating point in rad/s; None where the file gives none."""
        return self.operation.speed if self.operation else None

    @property
    def reference_shaft(self) -> str:
        """The shaft whose speed is the reference: the input shaft, else the first one."""
        return self.operation.input_shaft if self.operation else next(iter(self.shafts))
