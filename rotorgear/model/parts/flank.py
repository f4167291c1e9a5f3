"""Deviations of a gear's flanks from the involute helicoid, and settings of the finite-element tooth model, as file tables."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from rotorgear.model.parts.fields import Length, Name, NonNegativeLength, Part, PositiveLength, PositiveRatio, Whole
from rotorgear.model.parts.topography import TopographyFile


class Flank(Part):
    """Modifications and errors of the flanks, along the flank normal. Tip relief stands in the gear itself."""

    root_relief: NonNegativeLength = Field(0.0, description="linear relief at the form circle")
    root_relief_diameter: PositiveLength | None = Field(None, description="diameter at which the root relief starts")
    crowning: NonNegativeLength = Field(0.0, description="lead crowning: parabolic relief at both ends of the face")
    profile_crowning: NonNegativeLength = Field(
        0.0, description="profile crowning (barrelling): parabolic relief at form circle and tip"
    )
    profile_slope: Length = Field(0.0, description="depth at the tip less that at the form circle")
    end_relief: NonNegativeLength = Field(0.0, description="linear relief at both ends of the face")
    end_relief_length: NonNegativeLength = Field(0.0, description="length of the end relief along the face")
    helix_slope: Length = Field(0.0, description="depth at the end of larger z less that at the end of smaller z")
    bias: Length = Field(
        0.0, description="twist of the flank: profile slope at the end of larger z less that at the end of smaller z"
    )
    tip_rounding: NonNegativeLength = Field(
        0.0, description="radius of the rounded tip edge; the involute ends where it begins"
    )
    tip_chamfer: NonNegativeLength = Field(
        0.0, description="radial height of the chamfered tip edge; the involute ends below it"
    )
    topography: TopographyFile | None = Field(
        None, description="CSV file of measured deviations, beside the model file, added to the rest"
    )
    pitch_errors: dict[Name, Length] = Field(
        default_factory=dict,
        description="tooth number -> how far its flank stands back along the line of action; tooth 0 meshes first",
    )


class ToothFeTable(Part):
    """How stiffness = 'tooth_fe' models the teeth of a mesh."""

    preset: Literal["preview", "default", "fine"] = Field("default", description="mesh of teeth and contact lines")
    body: Literal["rim", "ring", "wheel"] | None = Field(
        None,
        description="rim: a few teeth held below their roots; ring: a full disc held at its bore or inside of the rim; wheel: "
        "rim, web and hub of the gear's body; default: wheel for a gear with rim and web, else rim",
    )
    rim_thickness: PositiveRatio = Field(3.0, description="depth of the rim's held circle below the root over m_n")
    pitches: Whole = Field(7, description="rim: pitches of the arc, an odd number of at least 3; its end cuts are held")
    exclude_torsion: bool | None = Field(
        None,
        description="ring, wheel: leave the wind-up between bore and teeth to the rotor model; default: of a wheel, whose "
        "torsion then stands between its teeth and its shaft, but not of a ring",
    )
