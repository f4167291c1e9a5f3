"""What the gearbox does: its speed, its damping, the points that are looked at, and the scatter of its numbers."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator

from rotorgear.model.parts import fields as si
from rotorgear.model.parts.fields import DOF_NAMES, Part, Station, Whole, listed, refuse


class Operation(Part):
    """The operating point. Power or torque here is that of the input shaft; the output shaft takes all of it."""

    input_shaft: str = Field(description="name of the shaft whose speed is the reference")
    speed: si.Speed | None = Field(None, description="speed of the input shaft, positive about +z")
    power: si.Power | None = Field(None, description="power into the input shaft")
    torque: si.Torque | None = Field(None, description="torque into the input shaft, in the sense of its rotation")
    output_shaft: str | None = Field(None, description="name of the shaft that takes the power")
    gravity: si.Gravity | None = Field(
        None, description="acceleration of gravity along x, y and z, for statics and transients"
    )


class ModelDamping(Part):
    """Damping of the model as a whole."""

    rayleigh_alpha: si.Rate = Field(0.0, description="alpha of C = alpha M + beta K")
    rayleigh_beta: si.Time = Field(
        0.0,
        description="beta of C = alpha M + beta K, of the symmetric part of K; tangents of nonlinear elements and rolling "
        "bearings take part in linear analyses only",
    )
    modal_ratio: si.Ratio = Field(0.0, description="damping ratio added to that of every mode that is not rigid")


_PLACE = "the coordinates x y z of a place, such as ['0 mm', '280 mm', '200 mm']"


# What a point of an internal load reads: along x y z, and the moments about them, by its direction.
_LOADS = {
    "axial": {"x": 2, "z": 2},
    "torque": {"x": 5, "torsion": 5},
    "shear": {"x": 0, "y": 1},
    "bending": {"x": 3, "y": 4, "tilt_x": 3, "tilt_y": 4},
}


# Motion of the model that each of them belongs to.
MOTION_OF_LOAD = {"axial": "axial", "torque": "torsion", "shear": "bending", "bending": "bending"}


class Point(Part):
    """A named point with a direction: an output or a sensor of a motion, or of the load inside a shaft or coupling."""

    on: str | None = Field(
        None,
        description="address of a part, such as 'bearings.input_left' or 'gears.wheel', of a casing, 'casings.box', or of a "
        "coupling, of which a load is known",
    )
    place: Annotated[tuple[si.Length, si.Length, si.Length], listed(3, _PLACE)] | None = Field(
        None, description="on a casing: x y z of a place; the point is that of its surface which is next to it"
    )
    shaft: str | None = Field(None, description="name of a shaft, in place of a part")
    at: Station | None = Field(None, description="z on that shaft")
    direction: Literal["x", "y", "z", "tilt_x", "tilt_y", "torsion"] = Field("x", description="direction looked along")
    quantity: Literal["axial", "torque", "shear", "bending"] | None = Field(
        None,
        description="the load inside the shaft or coupling there, in place of the motion: the force along z, the torque about "
        "z, the shear force along the direction x or y, or the bending moment about x or y",
    )
    side: Literal["left", "right"] | None = Field(
        None,
        description="of a load, the side of the place on which it is looked at, which counts where a part acts there; default: "
        "the right one, towards larger z, where the shaft goes on elastically",
    )

    @property
    def load(self) -> int | None:
        """Number of the internal load that it reads in Fx Fy Fz Mx My Mz; None of a motion, or of a direction without one."""
        return None if self.quantity is None else _LOADS[self.quantity].get(self.direction)

    @property
    def load_unit(self) -> str:
        """SI unit of that load."""
        return "N m" if self.quantity in ("torque", "bending") else "N"

    @property
    def turns(self) -> bool:
        """Whether its direction is that of a rotation."""
        return self.direction in DOF_NAMES[3:]

    @property
    def on_coupling(self) -> bool:
        """Whether it is on a coupling."""
        return self.on is not None and self.on.startswith("couplings.")

    @property
    def on_casing(self) -> str | None:
        """Name of the casing that it is on, if any."""
        return self.on.removeprefix("casings.") if self.on is not None and self.on.startswith("casings.") else None


Distribution = Literal["normal", "lognormal", "uniform"]


class Scatter(Part):
    """Scatter of the numbers that an address names; one of sigma, tolerance and grade."""

    sigma: float | str | None = Field(
        None, description="standard deviation: a share of the value such as '10 %', or a size such as '0.1 mm'"
    )
    tolerance: float | str | None = Field(
        None,
        description="half width: the limits of a uniform distribution, three standard deviations of the others",
    )
    grade: Whole | None = Field(
        None,
        description="flank tolerance class of ISO 1328-1, of an index_error of a mesh; default: accuracy_grade of its gears",
    )
    distribution: Distribution = Field("normal", description="normal, lognormal (of the value itself) or uniform")

    @model_validator(mode="after")
    def _one_size(self) -> Scatter:
        if sum(size is not None for size in (self.sigma, self.tolerance, self.grade)) != 1:
            raise refuse("one of sigma, tolerance and grade, such as { sigma = '10 %' }")
        return self
