"""A mesh between two gears, its stiffness, and what its teeth excite.

The stiffness is a number, a list over one mesh period, a Fourier series, or the name of a stiffness model. The series is
k(u) = mean [1 + sum_n a_n cos(2 pi n u + phi_n)], u in mesh periods from contact at the pitch point in the middle of the face; it
is kept as the list of its values, which are enough for its highest harmonic.
"""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, WithJsonSchema

from rotorgear.gears.stiffness_models import MODELS
from rotorgear.model.parts import fields as si
from rotorgear.model.parts.fields import RIGID, Flag, Part, Unit, Whole, refuse
from rotorgear.quantity import DIMENSIONS, did_you_mean

# Least length of a list; most harmonics of a series; values of a series for each harmonic, and at least.
_LEAST_VALUES = 3
_MOST_HARMONICS = 100
_VALUES_A_HARMONIC = 8
_VALUES = 64
_UNIT = Unit("stiffness", "positive")
_SHARE = Unit("ratio")
_ANGLE = Unit("angle")
_EXAMPLE = DIMENSIONS["stiffness"].example
_SERIES = ("mean", "amplitudes", "phases")


def _parse(value: Any) -> Any:
    if isinstance(value, dict):
        return _series(value)
    if isinstance(value, list | tuple):
        if len(value) < _LEAST_VALUES:
            raise refuse(f"at least {_LEAST_VALUES} stiffnesses, evenly spaced over one mesh period")
        return tuple(_UNIT.parse(item) for item in value)
    if isinstance(value, str) and value.strip()[:1].isalpha():
        named = (*MODELS, RIGID)
        if value in named:
            return value
        wanted = f"a stiffness such as '{_EXAMPLE}' or one of {', '.join(named)}"
        raise refuse("; ".join(filter(None, (wanted, did_you_mean(value, named)))))
    return _UNIT.parse(value)


def _series(table: dict[str, Any]) -> tuple[float, ...]:
    """Values of a Fourier series over one mesh period."""
    amplitudes = table.get("amplitudes")
    phases = table.get("phases", [])
    if (
        set(table) - set(_SERIES)
        or "mean" not in table
        or not isinstance(amplitudes, list | tuple)
        or not isinstance(phases, list | tuple)
        or not 1 <= len(amplitudes) <= _MOST_HARMONICS
        or len(phases) not in (0, len(amplitudes))
    ):
        raise refuse(
            f"mean, a list of 1 to {_MOST_HARMONICS} amplitudes as shares of it, and as many phases or none, such as "
            f"{{ mean = '{_EXAMPLE}', amplitudes = [0.1, 0.02], phases = ['0 deg', '90 deg'] }}"
        )
    mean = _UNIT.parse(table["mean"])
    shares = [_SHARE.parse(item) for item in amplitudes]
    angles = [_ANGLE.parse(item) for item in phases] or [0.0] * len(shares)
    count = max(_VALUES, _VALUES_A_HARMONIC * len(shares))
    turns = [2.0 * math.pi * j / count for j in range(count)]
    terms = list(zip(range(1, len(shares) + 1), shares, angles, strict=True))
    values = tuple(mean * (1.0 + sum(a * math.cos(n * turn + phi) for n, a, phi in terms)) for turn in turns)
    if min(values) <= 0.0:
        raise refuse("amplitudes that leave the stiffness positive over the whole mesh period")
    return values


def _schema() -> dict[str, Any]:
    one = _UNIT.schema()
    names = {"type": "string", "enum": [*MODELS, RIGID]}
    several = {"type": "array", "minItems": _LEAST_VALUES, "items": {"anyOf": one["anyOf"]}}
    shares = {"type": "array", "minItems": 1, "maxItems": _MOST_HARMONICS, "items": {"type": "number"}}
    angles = {"type": "array", "maxItems": _MOST_HARMONICS, "items": {"anyOf": _ANGLE.schema()["anyOf"]}}
    series = {
        "type": "object",
        "properties": {"mean": {"anyOf": one["anyOf"]}, "amplitudes": shares, "phases": angles},
        "required": ["mean", "amplitudes"],
        "additionalProperties": False,
    }
    text = f"{one['description']}, a list, a Fourier series, or a model"
    return {**one, "anyOf": [*one["anyOf"], names, several, series], "description": text}


StiffnessValue = Annotated[float | str | tuple[float, ...], BeforeValidator(_parse), WithJsonSchema(_schema())]


class ToothFeTable(Part):
    """How stiffness = 'tooth_fe' models the teeth of a mesh."""

    preset: Literal["preview", "default", "fine"] = Field("default", description="mesh of teeth and contact lines")
    body: Literal["rim", "ring", "wheel"] | None = Field(
        None,
        description="rim: a few teeth held below their roots; ring: a full disc held at its bore or inside of the rim; wheel: "
        "rim, web and hub of the gear's body; default: wheel for a gear with rim and web, else rim",
    )
    rim_thickness: si.PositiveRatio = Field(3.0, description="depth of the rim's held circle below the root over m_n")
    pitches: Whole = Field(7, description="rim: pitches of the arc, an odd number of at least 3; its end cuts are held")
    exclude_torsion: bool | None = Field(
        None,
        description="ring, wheel: leave the wind-up between bore and teeth to the rotor model; default: true of a wheel, false "
        "of a ring",
    )


class ErrorHarmonic(Part):
    """A harmonic of the transmission error: amplitude times cos(harmonic times the angle of the mesh + phase)."""

    harmonic: Whole = Field(description="number of the harmonic; 1: the mesh frequency")
    amplitude: si.NonNegativeLength = Field(description="amplitude along the flank normal (half of peak to peak)")
    phase: si.Angle = Field(0.0, description="phase, from a contact at the pitch point")


class StiffnessHarmonic(Part):
    """A harmonic of the mesh stiffness: a share of the mean times cos(harmonic times the angle of the mesh + phase)."""

    harmonic: Whole = Field(description="number of the harmonic; 1: the mesh frequency")
    amplitude: si.Ratio = Field(description="amplitude as a share of the mean stiffness")
    phase: si.Angle = Field(0.0, description="phase, from a contact at the pitch point")


class CornerImpact(Part):
    """A half-sine force between the flanks once a mesh cycle, as teeth that come into contact too early give."""

    force: si.Force = Field(description="peak of the force of one helix")
    duration: si.Ratio = Field(description="duration in pitches, below 1")
    at: si.Ratio = Field(0.0, description="start in the cycle in pitches; 0: a contact at the pitch point")


class Mesh(Part):
    """Two gears in mesh. What follows from gears and axes is computed."""

    pinion: str = Field(description="name of the gear that is called the pinion")
    gear: str = Field(description="name of its mate")
    stiffness: StiffnessValue = Field(
        description="mean mesh stiffness along the flank normal, both helices together; a list of such values over one mesh "
        "period; a Fourier series { mean, amplitudes, phases }; a stiffness model, which takes the mean load of the torque "
        "flow; or rigid: the flanks stay in touch, and one degree of freedom follows from the others"
    )
    damping_ratio: si.Ratio = Field(0.0, description="damping ratio zeta: c = 2 zeta sqrt(k m_e)")
    damping: si.Damping | None = Field(
        None, description="damping coefficient along the flank normal, in place of the ratio"
    )
    equivalent_mass: Literal["torsion", "general"] = Field(
        "torsion", description="m_e of the damping ratio: from the rotations only, or from all motions of the two gears"
    )
    centre_distance_allowance: si.NonNegativeLength = Field(
        0.0, description="the centre distance may deviate by so much to both sides, for the backlash"
    )
    application_factor: si.PositiveRatio = Field(1.0, description="application factor K_A of ISO 6336, for K_v")
    stagger: si.Ratio = Field(
        0.0,
        description="herringbone: share of a pitch by which the pinion's teeth at the larger z are ahead, where the input shaft "
        "turns about +z; 0.5: staggered",
    )
    misalignment: si.Length = Field(
        0.0, description="distance of the flanks at the end of larger z of the common face less that at its other end"
    )
    tilt: Flag = Field(
        False,
        description="whether the mesh resists the tilt of its shafts over its face width; statics then finds misalignment and "
        "load distribution with the shafts",
    )
    tooth_fe: ToothFeTable = Field(default_factory=ToothFeTable, description="settings of stiffness = 'tooth_fe'")
    contact_position: si.Length = Field(
        0.0, description="place of the contact along the line of action from the pitch point, positive towards recess"
    )
    centre_line_angle: si.Angle | None = Field(
        None, description="direction from pinion to gear from +x, only where the shafts have no positions"
    )
    pressure_angle: si.Angle | None = Field(
        None, description="working transverse pressure angle, only where the shafts have no positions"
    )
    index_error: si.Length = Field(
        0.0,
        description="gap along the flank normal that must close before this mesh carries (timing error of a branch), at the "
        "sense of rotation of the operating speed; an analysis at the other sense takes it with the other sign",
    )
    helix_index_error: si.Length = Field(
        0.0, description="gap that the helix at the larger z of a herringbone has beside that"
    )
    phase: si.Angle | None = Field(
        None,
        description="angle of the mesh at the time 0, from contact at the pitch point; default: from teeth, clocking and centre "
        "lines",
    )
    transmission_error: tuple[ErrorHarmonic, ...] = Field(
        (), description="harmonics of the static transmission error, positive where it opens the gap"
    )
    stiffness_variation: tuple[StiffnessHarmonic, ...] = Field(
        (), description="harmonics of the mesh stiffness about its mean"
    )
    corner_impact: CornerImpact | None = Field(None, description="impact at each entry of a tooth")
    friction_coefficient: si.Ratio = Field(0.0, description="coefficient of sliding friction between the flanks")
    lubricant_viscosity: si.Viscosity | None = Field(
        None, description="viscosity of the oil: friction by Benedict and Kelley's formula, in place of a coefficient"
    )
    backlash: si.NonNegativeLength | None = Field(
        None, description="backlash along the flank normal; without it the teeth never part in a transient"
    )
    coast_flank: Literal["line", "own normals"] = Field(
        "line",
        description="the non-working (coast) flank pushes along the line of action of the working flank, or along its own normal",
    )
    nominal_driver: Literal["pinion", "gear"] | None = Field(
        None,
        description="which gear drives on the flanks that are called working ones, even where loads press the others together; "
        "default: the one that drives under the mean torques",
    )
    contact_damping: Literal["non-adhesive", "adhesive", "penetration"] = Field(
        "non-adhesive",
        description="non-adhesive: the contact force never pulls; adhesive: damping may pull while the flanks touch; "
        "penetration: the damping coefficient is proportional to the penetration",
    )
    regularisation_depth: si.PositiveLength | None = Field(
        None,
        description="penetration over which contact damping grows to its full value; default: 2 % of the mean deflection. With "
        "contact_damping = 'penetration': where the coefficient has its given value; default: the mean deflection",
    )

    @property
    def rubs(self) -> bool:
        """Whether its flanks have sliding friction, by a coefficient or by the viscosity of the oil."""
        return bool(self.friction_coefficient or self.lubricant_viscosity)
