"""What the gearbox does: its speed, its damping, and the points that are looked at."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from rotorgear.model.parts.fields import (
    Gravity,
    Part,
    Power,
    Rate,
    Ratio,
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
