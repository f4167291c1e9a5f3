"""Sheet of one bearing at the loads of its gearbox: what it looks like inside, and its stiffness and damping over speed."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator
from typing import ClassVar

import numpy as np

from rotorgear.results.result import ModelResult
from rotorgear.results.schema import Record, derived, of


class RollingElementRow(Record):
    """One ball or roller, with the cage at angle 0; a ball of a four-point bearing has a row for each diagonal."""

    row: int = of("its row", note=", from -z; of a four-point bearing the diagonal across which it presses")
    angle: float = of("where it stands", "rad", json="angle_deg", note=", from +x about +z")
    contact_angle: float = of("contact angle under load", "rad", json="contact_angle_deg", note="; 0 without load")
    load: float = of("load", "N", json="load_n")
    deflection: float = of("deflection of both contacts", "m", json="deflection_m", note="; negative: it stands apart")
    inner_pressure: float = of("largest Hertz pressure at the inner ring", "Pa", json="inner_pressure_pa")
    outer_pressure: float = of("largest Hertz pressure at the outer ring", "Pa", json="outer_pressure_pa")


# Angles in deg (t,), places across them in m (j,), gap in m (t,) and pressure in Pa (t, j) of a part of a film.
Patch = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]
# Steps of the grid: a leap from one pad to the next.
_APART = 1.5


class OilState(Record):
    """What every oil film has under its load.

    `along_shaft`: whether it carries along the shaft, not across. `place`: what the grid is counted by beside angles. `smooth`:
    whether pressure and gap are drawn from node to node, not node by node. `over_gap`: what stands over the picture of the gap.
    """

    along_shaft: ClassVar[bool] = False
    place: ClassVar[str] = "z"
    smooth: ClassVar[bool] = False
    over_gap: ClassVar[str] = "Film: eccentricity {0.eccentricity:.3f} of the clearance"

    largest_pressure: float = of("largest pressure", "Pa", json="largest_pressure_pa")
    power_loss: float = of("power loss", "W", json="power_loss_w")
    film_temperature: float | None = of(
        "mean temperature of the film", "K", json="film_temperature_k", note="; `null` where the viscosity is given"
    )
    outlet_temperature: float | None = of(
        "temperature of the oil that leaves",
        "K",
        json="outlet_temperature_k",
        note="; `null` where the viscosity is given",
    )
    film_viscosity: float = of("dynamic viscosity of the film", "Pa s", json="film_viscosity_pa_s")

    @abstractmethod
    def patches(self) -> Iterator[Patch]:
        """The film in parts that are drawn each as one."""


class FilmState(OilState):
    """The film under its load. Angles are from +x about +z."""

    eccentricity: float = of("eccentricity over the clearance", form=".4f")
    attitude: float = of(
        "attitude angle",
        "rad",
        json="attitude_deg",
        note=": from the load to the line of centres, in the sense of rotation",
    )
    minimum_gap: float = of("smallest gap of the film", "m", json="minimum_gap_m")
    sommerfeld: float = of("Sommerfeld number", note=" mu N L D / W (R/c)^2", form=".4g")
    side_flow: float = of("oil that leaves at both ends", "m^3/s", json="side_flow_m3_per_s")
    angle: np.ndarray = of("angle of the grid", "rad", "angle", json="angle_rad")
    z: np.ndarray = of("place along the shaft from the middle of the bearing", "m", "place", json="z_m")
    gap: np.ndarray = of("gap of the film", "m", "angle", json="gap_m")
    pressure: np.ndarray = of(
        "pressure", "Pa", "angle", "place", json="pressure_pa", note=", symmetric about the middle"
    )

    def patches(self) -> Iterator[Patch]:
        """All of it, both halves, around the circle."""
        angle = np.degrees(self.angle) % 360.0
        order = np.argsort(angle)
        field = self.pressure[order]
        z = np.concatenate([-self.z[::-1], self.z])
        yield angle[order], z, self.gap[order], np.hstack([field[:, ::-1], field])


class ThrustState(OilState):
    """The films of a thrust bearing under its load. Angles are from +x about +z."""

    along_shaft: ClassVar[bool] = True
    place: ClassVar[str] = "radius"
    smooth: ClassVar[bool] = True
    over_gap: ClassVar[str] = "Least gap over the radius"

    minimum_gap: float = of("smallest gap of the films", "m", json="minimum_gap_m")
    side_flow: float = of("oil that leaves at the inner and the outer radius", "m^3/s", json="side_flow_m3_per_s")
    side: np.ndarray = of("sense of the push that the pad takes", "", "angle", note=", 1 towards +z, -1 towards -z")
    angle: np.ndarray = of("angle of the grid", "rad", "angle", json="angle_rad", note=", over all pads")
    radius: np.ndarray = of("radius of the grid", "m", "radius", json="radius_m")
    gap: np.ndarray = of("gap of the films", "m", "angle", "radius", json="gap_m")
    pressure: np.ndarray = of("pressure", "Pa", "angle", "radius", json="pressure_pa")

    def patches(self) -> Iterator[Patch]:
        """The pads of the side that carries more, each with its least gap over the radius."""
        carried = {side: float(self.pressure[self.side == side].sum()) for side in np.unique(self.side)}
        own = self.side == max(carried, key=lambda side: carried[side])
        angle = np.degrees(self.angle[own])
        # From pad to pad the angle leaps over the groove.
        steps = np.diff(angle)
        for pad in np.split(np.arange(angle.size), np.flatnonzero(steps > _APART * np.median(steps)) + 1):
            yield angle[pad], self.radius, self.gap[own][pad].min(axis=1), self.pressure[own][pad]


class BearingSpeed(Record):
    """The bearing at one speed of the input shaft, at the loads of the gearbox there."""

    speed: float = of("speed of the input shaft", "rad/s", json="speed_rpm")
    load: np.ndarray = of("force of the shaft on it", "N, N m", "component", json="load")
    displacement: np.ndarray = of("displacement of the shaft in it", "m, rad", "component")
    stiffness: np.ndarray = of("tangent stiffness", "SI", "component", "displacement")
    damping: np.ndarray = of("tangent damping", "SI", "component", "velocity")
    critical_mass: float | None = of(
        "mass of a rigid rotor on such bearings alone at its threshold",
        "kg",
        json="critical_mass_kg",
        note=", a bearing; a heavier one whirls; `null` where none does",
    )
    whirl_ratio: float | None = of("frequency of that whirl over the speed of the shaft", form=".4f")
    film_temperature: float | None = of(
        "mean temperature of the film", "K", json="film_temperature_k", note="; `null` where the viscosity is given"
    )
    log_decrement: float | None = of(
        "smallest logarithmic decrement of the gearbox",
        note=", of its 24 lowest modes that anything damps; `null` where it was not asked for",
    )


class BearingSheet(ModelResult, kind="bearing"):
    """One bearing; components are x, y, z in m and N, then tilts about x and y in rad and N m, as far as its law has them."""

    bearing: str = of("bearing", note=", its address")
    law: str = of("what it is", note=": its force law")
    speed: float = of("speed of the input shaft", "rad/s", json="speed_rpm")
    shaft_speed: float = of("speed of its own shaft", "rad/s", json="shaft_speed_rpm")
    geometry: dict[str, float | int | str | bool] = of("parameters of the law, in SI", "", "PARAMETER")
    bearing_load: np.ndarray = of("force of the shaft on it", "N, N m", "component")
    bearing_displacement: np.ndarray = of("displacement of the shaft in it", "m, rad", "component")
    bearing_stiffness: np.ndarray = of("tangent stiffness", "SI", "component", "displacement")
    bearing_damping: np.ndarray = of("tangent damping", "SI", "component", "velocity")
    averaged: bool = of("whether these are means over a pitch of its rolling elements")
    rolling_elements: tuple[RollingElementRow, ...] = of(
        "rolling elements", "", "element", record=RollingElementRow, default=(), kw_only=True
    )
    film: FilmState | None = of(
        "film", record=FilmState, note="; `null` in a rolling bearing", default=None, kw_only=True
    )
    thrust_film: ThrustState | None = of(
        "films of a thrust bearing", record=ThrustState, note="; `null` in any other", default=None, kw_only=True
    )
    over_speed: tuple[BearingSpeed, ...] = of("over speed", "", "speed", record=BearingSpeed)
    threshold_speed: float | None = of(
        "speed at which the gearbox begins to whirl",
        "rad/s",
        json="threshold_rpm",
        note=", of the input shaft, in the range of `over_speed`; `null` where it does not, or was not asked for",
    )
    threshold_frequency_hz: float | None = of("frequency of that whirl", "Hz")
    consistency: float = of(
        "difference between its law at the state printed and the load of the gearbox", note=", relative", form=".0e"
    )
    error_estimate: float = of(
        "estimated relative error of stiffness and damping",
        note=": twice the change on a grid of twice the cells each way, or with twice the positions of its elements",
        form=".0e",
    )
    cpu_seconds: float = of("CPU time of the bearing at one speed and load", "s", form=".4f")

    @property
    def oil(self) -> OilState | None:
        """Its oil film, of whatever kind; None in a rolling bearing."""
        return self.film or self.thrust_film

    @property
    def along_shaft(self) -> bool:
        """Whether it carries along its shaft, and nothing across."""
        return self.oil is not None and self.oil.along_shaft

    @derived("largest load of a rolling element", "N", json="largest_element_load_n")
    def largest_element_load(self) -> float | None:
        """Of all of them, with the cage at angle 0; None for a film."""
        return max((row.load for row in self.rolling_elements), default=None)
