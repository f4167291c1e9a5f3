"""Inside a bearing in a state of its law: loads of rolling elements, or the pressure of a film with its flow and loss.

Results list it under the name `told_as`, in records whose values `told` gives by their names.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields
from typing import Any, ClassVar

import numpy as np


@dataclass(frozen=True)
class RollingLoads:
    """The z rolling elements of a bearing.

    Attributes:
        row: number of its row from -z, (z,); of the diagonal in a four-point bearing.
        angle: place of each one, (z,) rad from +x about +z.
        contact_angle: of its load against the plane across the shaft, (z,) rad; 0 for one that carries nothing.
        load: (z,) N. deflection: of both contacts together, (z,) m, negative where it has a gap.
        inner_pressure, outer_pressure: largest Hertz pressure at the inner and the outer ring, (z,) Pa.
    """

    told_as: ClassVar[str] = "rolling_elements"

    row: np.ndarray
    angle: np.ndarray
    contact_angle: np.ndarray
    load: np.ndarray
    deflection: np.ndarray
    inner_pressure: np.ndarray
    outer_pressure: np.ndarray

    def told(self, law: object, load: np.ndarray, d: np.ndarray, shaft_speed: float) -> Iterator[dict[str, Any]]:
        """Of each element, row by row and around the shaft.

        Args:
            law: whose state it is. load: (k,) on it. d: displacements (k,). shaft_speed: in rad/s.
        """
        names = [item.name for item in fields(self)]
        for i in np.lexsort((self.angle, self.row)):
            yield {name: (int if name == "row" else float)(getattr(self, name)[i]) for name in names}


@dataclass(frozen=True)
class OilField:
    """An oil film in steady running, on nodes (t,) around the shaft and (j,) across that.

    Attributes:
        angle: (t,) rad, from +x about +z, over all pads. gap: (t,) or (t, j) m. pressure: (t, j) Pa.
        side_flow: oil that leaves at both edges, m^3/s.
        power_loss: torque on the shaft times its speed, W.
    """

    told_as: ClassVar[str]

    angle: np.ndarray
    gap: np.ndarray
    pressure: np.ndarray
    side_flow: float
    power_loss: float

    def told(self, law: Any, load: np.ndarray, d: np.ndarray, shaft_speed: float) -> Iterator[dict[str, Any]]:
        """Its own arrays, its extremes, and its temperature, which is the mean of inlet and outlet."""
        T = law.temperature
        yield {
            **{item.name: getattr(self, item.name) for item in fields(self)},
            "minimum_gap": float(self.gap.min()),
            "largest_pressure": float(self.pressure.max()),
            "film_temperature": T,
            "outlet_temperature": None if T is None else 2.0 * T - law.inlet_temperature,
            "film_viscosity": law.viscosity,
        }


@dataclass(frozen=True)
class FilmField(OilField):
    """The film around a journal; one gap for all its length.

    Attributes:
        z: (j,) m from the middle, over one half of the length.
    """

    told_as: ClassVar[str] = "film"

    z: np.ndarray

    def told(self, law: Any, load: np.ndarray, d: np.ndarray, shaft_speed: float) -> Iterator[dict[str, Any]]:
        """The same, the place of the journal, and Sommerfeld's number."""
        W = float(np.hypot(*load[:2]))
        # From the load to the line of centres, positive in the sense of rotation.
        angle = np.arctan2(d[1], d[0]) - np.arctan2(load[1], load[0])
        turns = abs(shaft_speed) / (2.0 * np.pi)
        area = 2.0 * law.radius * law.length
        for film in super().told(law, load, d, shaft_speed):
            yield {
                **film,
                "eccentricity": float(np.hypot(*d[:2])) / law.clearance,
                "attitude": float(np.sign(shaft_speed) * (np.mod(angle + np.pi, 2.0 * np.pi) - np.pi)),
                "sommerfeld": law.viscosity * turns * area / W * (law.radius / law.clearance) ** 2 if W else np.inf,
            }
