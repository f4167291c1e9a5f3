"""A mesh between two gears."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from rotorgear.model.parts.excitation import CornerImpact, ErrorHarmonic, StiffnessHarmonic
from rotorgear.model.parts.fields import (
    Angle,
    Damping,
    Flag,
    Length,
    NonNegativeLength,
    Part,
    PositiveLength,
    PositiveRatio,
    Ratio,
    Viscosity,
)
from rotorgear.model.parts.flank import ToothFeTable
from rotorgear.model.parts.stiffness_field import StiffnessValue


class Mesh(Part):
    """Two gears in mesh. Everything that follows from the gears and the axes is computed, not asked for."""

    pinion: str = Field(description="name of the gear that is called the pinion")
    gear: str = Field(description="name of its mate")
    stiffness: StiffnessValue = Field(
        description="mean mesh stiffness along the flank normal, both helices together; a list of such values over one "
        "mesh period; a Fourier series { mean, amplitudes, phases }; or the name of a stiffness model, which takes the "
        "mean load of the torque flow"
    )
    damping_ratio: Ratio = Field(0.0, description="damping ratio zeta: c = 2 zeta sqrt(k m_e)")
    damping: Damping | None = Field(
        None, description="damping coefficient along the flank normal, in place of the ratio"
    )
    equivalent_mass: Literal["torsion", "general"] = Field(
        "torsion", description="m_e of the damping ratio: from the rotations only, or from all motions of the two gears"
    )
    centre_distance_allowance: NonNegativeLength = Field(
        0.0, description="the centre distance may deviate by so much to both sides, for the backlash"
    )
    application_factor: PositiveRatio = Field(1.0, description="application factor K_A of ISO 6336, for K_v")
    stagger: Ratio = Field(
        0.0,
        description="herringbone: share of a pitch by which the pinion's teeth at the larger z are ahead, where the input shaft "
        "turns about +z; 0 in phase, 0.5 staggered",
    )
    misalignment: Length = Field(
        0.0, description="distance of the flanks at the end of larger z of the common face less that at its other end"
    )
    tilt: Flag = Field(
        False,
        description="whether the flanks feel the tilt of their shafts: the mesh resists it over the width of its face, and "
        "statics finds misalignment and load distribution together with the shafts",
    )
    tooth_fe: ToothFeTable = Field(default_factory=ToothFeTable, description="settings of stiffness = 'tooth_fe'")
    contact_position: Length = Field(
        0.0, description="place of the contact along the line of action from the pitch point, positive towards recess"
    )
    centre_line_angle: Angle | None = Field(
        None, description="direction from pinion to gear from +x, only where the shafts have no positions"
    )
    pressure_angle: Angle | None = Field(
        None, description="working transverse pressure angle, only where the shafts have no positions"
    )
    index_error: Length = Field(
        0.0,
        description="gap along the flank normal that must close before this mesh carries (timing error of a branch)",
    )
    helix_index_error: Length = Field(
        0.0, description="gap that the helix at the larger z of a herringbone has beside that"
    )
    phase: Angle | None = Field(
        None,
        description="angle of the mesh at the time 0, counted from contact at the pitch point; default: what follows from "
        "teeth, clocking and centre lines",
    )
    transmission_error: tuple[ErrorHarmonic, ...] = Field(
        (), description="harmonics of the static transmission error, positive where it opens the gap"
    )
    stiffness_variation: tuple[StiffnessHarmonic, ...] = Field(
        (), description="harmonics of the mesh stiffness about its mean"
    )
    corner_impact: CornerImpact | None = Field(None, description="impact at each entry of a tooth; default: none")
    friction_coefficient: Ratio = Field(0.0, description="coefficient of sliding friction between the flanks")
    lubricant_viscosity: Viscosity | None = Field(
        None, description="viscosity of the oil: friction by Benedict and Kelley's formula, in place of a coefficient"
    )
    backlash: NonNegativeLength | None = Field(
        None, description="backlash along the flank normal; without it the teeth never part in a transient"
    )
    coast_flank: Literal["line", "own normals"] = Field(
        "line",
        description="the non-working (coast) flank pushes along the line of action of the working flank, or along its own normal",
    )
    nominal_driver: Literal["pinion", "gear"] | None = Field(
        None,
        description="which of the two drives on the flanks that responses, transients and sweeps call the working ones, "
        "even where the loads press the other flanks together; default: the one that the mean torques make drive",
    )
    contact_damping: Literal["non-adhesive", "adhesive", "penetration"] = Field(
        "non-adhesive",
        description="non-adhesive: the contact force never pulls; adhesive: damping may pull while the flanks touch; "
        "penetration: the damping coefficient is proportional to the penetration",
    )
    regularisation_depth: PositiveLength | None = Field(
        None,
        description="penetration over which contact damping grows from zero to its full value, so that the force is "
        "continuous; default: 2 % of the mean deflection. With penetration: the penetration at which the coefficient has its "
        "given value; default: the mean deflection",
    )

    @property
    def rubs(self) -> bool:
        """Whether its flanks have sliding friction, by a coefficient or by the viscosity of the oil."""
        return bool(self.friction_coefficient or self.lubricant_viscosity)
