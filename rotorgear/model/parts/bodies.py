"""Rigid bodies on a shaft that are no gears: disks and point masses."""

from __future__ import annotations

from pydantic import Field

from rotorgear.model.parts.fields import Inertia, Mass, NonNegativeLength, Part, PositiveLength, Station


class Disk(Part):
    """A rigid disk: mass and inertias given, or a plain cylinder by its size."""

    shaft: str = Field(description="name of the shaft")
    at: Station = Field(description="z of the middle, or 'start' or 'end'")
    mass: Mass | None = Field(None, description="mass")
    polar_inertia: Inertia | None = Field(None, description="moment of inertia about z")
    diametral_inertia: Inertia | None = Field(None, description="moment of inertia about x and y through the middle")
    outer_diameter: PositiveLength | None = Field(None, description="outer diameter of a plain cylinder")
    bore: NonNegativeLength | None = Field(None, description="its bore; default: the shaft's diameter there")
    width: PositiveLength | None = Field(None, description="its width")
    material: str | None = Field(None, description="its material; default: the shaft's")


class PointMass(Part):
    """A mass without moments of inertia."""

    shaft: str = Field(description="name of the shaft")
    at: Station = Field(description="z of the place, or 'start' or 'end'")
    mass: Mass = Field(description="mass")
