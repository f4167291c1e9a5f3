"""Inside a bearing in a state of its law: loads of rolling elements, or the pressure of a film with its flow and loss."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class RollingLoads:
    """The z rolling elements of a bearing.

    Attributes:
        row: number of its row from -z, (z,); of the diagonal in a four-point bearing.
        angle: where each one stands, (z,) rad from +x about +z.
        contact_angle: of its load against the plane across the shaft, (z,) rad; 0 for one that carries nothing.
        load: (z,) N. deflection: of both contacts together, (z,) m, negative where it stands apart.
        inner_pressure, outer_pressure: largest Hertz pressure at the inner and the outer ring, (z,) Pa.
    """

    row: np.ndarray
    angle: np.ndarray
    contact_angle: np.ndarray
    load: np.ndarray
    deflection: np.ndarray
    inner_pressure: np.ndarray
    outer_pressure: np.ndarray


@dataclass(frozen=True)
class ThrustField:
    """The films of a thrust bearing in steady running, nodes of all pads one after the other.

    Attributes:
        side: +1 or -1, the sense of the push that the pad takes, (t,). angle: (t,) rad, from +x about +z. radius: (j,) m.
        gap: (t, j) m. pressure: (t, j) Pa.
        side_flow: oil that leaves at the inner and the outer radius, m^3/s.
        power_loss: torque on the collar times its speed, W.
    """

    side: np.ndarray
    angle: np.ndarray
    radius: np.ndarray
    gap: np.ndarray
    pressure: np.ndarray
    side_flow: float
    power_loss: float


@dataclass(frozen=True)
class FilmField:
    """The film of a bearing in steady running.

    Attributes:
        angle: (t,) rad, from +x about +z, over all pads. z: (j,) m from the middle, over one half of the length.
        gap: (t,) m. pressure: (t, j) Pa.
        side_flow: oil that leaves at both ends, m^3/s.
        power_loss: torque on the journal times its speed, W.
    """

    angle: np.ndarray
    z: np.ndarray
    gap: np.ndarray
    pressure: np.ndarray
    side_flow: float
    power_loss: float
