"""What the gearbox does: its speed, its loads, its damping, and the points that are looked at."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from rotorgear.model.parts.fields import (
    Gravity,
    Part,
    PositiveRatio,
    PositiveTime,
    Power,
    Rate,
    Ratio,
    SignedRatio,
    Speed,
    Station,
    Time,
    Torque,
)


class Operation(Part):
    """The operating point. Power or torque here is that of the input shaft; the output shaft takes all of it."""

    input_shaft: str = Field(description="name of the shaft whose speed is the reference")
    speed: Speed | None = Field(None, description="speed of the input shaft, positive about +z")
    power: Power | None = Field(None, description="power into the input shaft")
    torque: Torque | None = Field(None, description="torque into the input shaft, in the sense of its rotation")
    output_shaft: str | None = Field(None, description="name of the shaft that takes the power")
    gravity: Gravity | None = Field(
        None, description="acceleration of gravity along x, y and z, for statics and transients; default: none"
    )


class Load(Part):
    """A torque on one shaft, for trains with several inputs or outputs."""

    shaft: str = Field(description="name of the shaft")
    kind: Literal["input", "output"] = Field(description="input: drives; output: takes power")
    at: Station | None = Field(None, description="z of the place; default: start for an input, end for an output")
    torque: Torque | None = Field(
        None, description="size of the torque; one load, an output as a rule, may leave it out and takes the rest"
    )
    power: Power | None = Field(None, description="power, in place of the torque")
    speed_power: SignedRatio = Field(
        0.0,
        description="transient: the torque goes with this power of the speed; 2 for a propeller, -1 for constant power",
    )
    ripple: Ratio = Field(0.0, description="transient: amplitude of the torque's ripple as a share of it")
    ripple_order: PositiveRatio = Field(1.0, description="transient: periods of the ripple in a turn of its shaft")
    step_to: Ratio = Field(1.0, description="transient: share of the torque that remains after a step")
    step_at: Time = Field(0.0, description="transient: time at which the step begins")
    step_duration: PositiveTime = Field(0.001, description="transient: how long the step takes")

    @property
    def varies(self) -> bool:
        """Whether the torque changes with time or speed."""
        return bool(self.speed_power or self.ripple or self.step_to != 1.0)


class ModelDamping(Part):
    """Damping of the model as a whole."""

    rayleigh_alpha: Rate = Field(0.0, description="alpha of C = alpha M + beta K")
    rayleigh_beta: Time = Field(
        0.0,
        description="beta of C = alpha M + beta K, of the symmetric part of K: cross-coupled and circulatory terms damp "
        "nothing; tangents of nonlinear elements and rolling bearings take part in linear analyses only",
    )
    modal_ratio: Ratio = Field(0.0, description="damping ratio added to that of every mode that is not rigid")


class Point(Part):
    """A named point with a direction: an output or a sensor."""

    on: str | None = Field(None, description="address of a part, such as 'bearings.input_left' or 'gears.wheel'")
    shaft: str | None = Field(None, description="name of a shaft, in place of a part")
    at: Station | None = Field(None, description="z on that shaft")
    direction: Literal["x", "y", "z", "tilt_x", "tilt_y", "torsion"] = Field("x", description="direction looked along")
