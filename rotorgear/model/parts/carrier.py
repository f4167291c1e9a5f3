"""Planet carriers: the shaft that carries the pins, and where they stand on it."""

from __future__ import annotations

import math
from typing import Self

from pydantic import Field, model_validator

from rotorgear.model.parts import fields as si
from rotorgear.model.parts.fields import Part, Station, Whole, refuse

# Between the name of a part that stands there once in the file, and the number of its sister from 1 on.
MARK = "#"


def sister(name: str, number: int) -> str:
    """Name of one of the parts that a file writes once: "planet#2"."""
    return f"{name}{MARK}{number}"


def written_name(name: str) -> str:
    """The name that a file has for a part and its sisters."""
    return name.partition(MARK)[0]


class Carrier(Part):
    """Pins on a shaft, and as many planets; what stands on a planet's shaft is there once for each."""

    shaft: str = Field(description="name of the shaft that carries the pins")
    at: Station = Field(description="z on that shaft where the pins are held")
    planets: Whole | None = Field(None, description="number of planets, equally spaced")
    angles: tuple[si.Angle, ...] = Field(
        (), description="direction of each pin from +x of the shaft, in place of planets"
    )
    radius: si.PositiveLength | None = Field(
        None, description="radius of the pins' circle; default: that of the meshes without backlash"
    )
    pin_errors: tuple[tuple[si.Length, si.Length], ...] = Field(
        (), description="how far each pin is off its place: in the sense of +z, and outwards"
    )

    @model_validator(mode="after")
    def _has_pins(self) -> Self:
        if (self.planets is None) == (not self.angles):
            raise refuse("either planets = 3 or angles of all pins")
        if self.pin_errors and len(self.pin_errors) != len(self.directions):
            raise refuse(f"pin_errors of {len(self.directions)} pins, two lengths each")
        return self

    @property
    def directions(self) -> tuple[float, ...]:
        """Direction of each pin from +x of the carrier's shaft at the start, in rad."""
        count = self.planets or 0
        return self.angles or tuple(2.0 * math.pi * k / count for k in range(count))

    @property
    def is_regular(self) -> bool:
        """Whether there are three pins or more, equally spaced."""
        N = len(self.directions)
        pitch = 2.0 * math.pi / N
        first = self.directions[0]
        places = sorted((angle - first) % (2.0 * math.pi) for angle in self.directions)
        return N >= 3 and all(math.isclose(place, k * pitch, abs_tol=1e-9) for k, place in enumerate(places))
