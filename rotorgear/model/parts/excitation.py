"""What shakes a gearbox: unbalances of shafts, and the harmonics of what teeth do in mesh."""

from __future__ import annotations

from pydantic import Field

from rotorgear.model.parts.fields import Angle, Force, NonNegativeLength, Part, Ratio, Station, UnbalanceSize, Whole


class Unbalance(Part):
    """An unbalance that turns with its shaft, at the speed of that shaft."""

    shaft: str = Field(description="name of the shaft")
    at: Station = Field(description="z of the unbalance, or 'start' or 'end'")
    magnitude: UnbalanceSize = Field(description="mass times eccentricity")
    phase: Angle = Field(0.0, description="direction of the unbalance at the time 0, from +x about +z")


class ErrorHarmonic(Part):
    """A harmonic of the transmission error: amplitude times cos(harmonic times the angle of the mesh + phase)."""

    harmonic: Whole = Field(description="1 for the mesh frequency, 2 for twice that, ...")
    amplitude: NonNegativeLength = Field(description="amplitude along the flank normal (half of peak to peak)")
    phase: Angle = Field(0.0, description="phase, counted from the moment when a contact is at the pitch point")


class StiffnessHarmonic(Part):
    """A harmonic of the mesh stiffness: a share of the mean times cos(harmonic times the angle of the mesh + phase)."""

    harmonic: Whole = Field(description="1 for the mesh frequency, 2 for twice that, ...")
    amplitude: Ratio = Field(description="amplitude as a share of the mean stiffness")
    phase: Angle = Field(0.0, description="phase, counted from the moment when a contact is at the pitch point")


class CornerImpact(Part):
    """A half-sine force between the flanks once a mesh cycle, as teeth that come into contact too early give."""

    force: Force = Field(description="peak of the force of one helix")
    duration: Ratio = Field(description="duration in pitches, below 1")
    at: Ratio = Field(0.0, description="its start in the cycle in pitches; 0 when a contact is at the pitch point")
