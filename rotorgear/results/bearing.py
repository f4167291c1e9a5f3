"""Sheet of one bearing at the loads of its gearbox: what it looks like inside, and its stiffness and damping over speed."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Iterator
from typing import Any, ClassVar

import numpy as np

from rotorgear.quantity import RPM_PER_RAD_S, ZERO_CELSIUS
from rotorgear.results.result import ModelResult
from rotorgear.results.schema import Record, derived, of
from rotorgear.results.table import Block, Column, Line, Table, error_words, grid, table_of, written

_COMPONENTS = ("x", "y", "z", "tilt_x", "tilt_y")
_NEGLIGIBLE = 1e-9
# ISO 76: pressure in Pa that leaves a set of 1e-4 of the element's diameter, of balls and of rollers, and the power of the
# pressure with which the load of a point or line contact grows.
_PERMISSIBLE = {True: (4.2e9, 3), False: (4.0e9, 2)}


class RollingElementRow(Record):
    """One ball or roller, with the cage at angle 0; a ball of a four-point bearing has a row for each diagonal."""

    row: int = of(
        "its row", note=", from -z; of a four-point bearing the diagonal across which it presses", column="row"
    )
    angle: float = of("where it stands", "rad", note=", from +x about +z", form=".2f", column="at deg")
    contact_angle: float = of(
        "contact angle under load", "rad", note="; 0 without load", form=".2f", column="contact deg"
    )
    load: float = of("load", "N", form=".2f", column="load N")
    deflection: float = of(
        "deflection of both contacts", "m", note="; negative: it stands apart", form=".3f", column="press um"
    )
    inner_pressure: float = of("largest Hertz pressure at the inner ring", "Pa", form=".1f", column="p inner MPa")
    outer_pressure: float = of("largest Hertz pressure at the outer ring", "Pa", form=".1f", column="p outer MPa")


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

    minimum_gap: float = of("smallest gap", "m")
    largest_pressure: float = of("largest pressure", "Pa")
    power_loss: float = of("power loss", "W")
    film_temperature: float | None = of(
        "mean temperature of the film", "K", note="; `null` where the viscosity is given"
    )
    outlet_temperature: float | None = of(
        "temperature of the oil that leaves", "K", note="; `null` where the viscosity is given"
    )
    film_viscosity: float = of("dynamic viscosity of the film", "Pa s")

    @abstractmethod
    def patches(self) -> Iterator[Patch]:
        """The film in parts that are drawn each as one."""

    def carries(self, sheet: BearingSheet) -> Iterator[tuple[str, str]]:
        """The load, in words for the table of the film; of a journal also where it stands under it."""
        yield ("load along z", f"{float(sheet.bearing_load[2]):.5g} N")


class FilmState(OilState):
    """The film under its load. Angles are from +x about +z."""

    eccentricity: float = of("eccentricity over the clearance", form=".4f")
    attitude: float = of(
        "attitude angle", "rad", note=": from the load to the line of centres, in the sense of rotation"
    )
    sommerfeld: float = of("Sommerfeld number", note=" mu N L D / W (R/c)^2")
    side_flow: float = of("oil that leaves at both ends", "m^3/s")
    angle: np.ndarray = of("angle of the grid", "rad", "angle", json="angle_rad")
    z: np.ndarray = of("place along the shaft", "m", "place", note=" from the middle of the bearing")
    gap: np.ndarray = of("gap of the film", "m", "angle")
    pressure: np.ndarray = of("pressure", "Pa", "angle", "place", note=", symmetric about the middle")

    def patches(self) -> Iterator[Patch]:
        """All of it, both halves, around the circle."""
        angle = np.degrees(self.angle) % 360.0
        order = np.argsort(angle)
        field = self.pressure[order]
        z = np.concatenate([-self.z[::-1], self.z])
        yield angle[order], z, self.gap[order], np.hstack([field[:, ::-1], field])

    def carries(self, sheet: BearingSheet) -> Iterator[tuple[str, str]]:
        """The load over L D, and where the journal stands under it."""
        load = float(np.hypot(*sheet.bearing_load[:2]))
        area = 2.0 * float(sheet.geometry["radius"]) * float(sheet.geometry["length"])
        yield ("load W, over L D", f"{load:.5g} N, {1e-6 * load / area:.4g} MPa")
        yield ("Sommerfeld number", f"{self.sommerfeld:.5g}")
        attitude = f"attitude {math.degrees(self.attitude):.2f} deg"
        yield ("eccentricity", f"{self.eccentricity:.4f} of the clearance, {attitude}")


class ThrustState(OilState):
    """The films of a thrust bearing under its load. Angles are from +x about +z."""

    along_shaft: ClassVar[bool] = True
    place: ClassVar[str] = "radius"
    smooth: ClassVar[bool] = True
    over_gap: ClassVar[str] = "Least gap over the radius"

    side_flow: float = of("oil that leaves at the inner and the outer radius", "m^3/s")
    side: np.ndarray = of("sense of the push that the pad takes", "", "angle", note=", 1 towards +z, -1 towards -z")
    angle: np.ndarray = of("angle of the grid", "rad", "angle", json="angle_rad", note=", over all pads")
    radius: np.ndarray = of("radius of the grid", "m", "radius")
    gap: np.ndarray = of("gap of the films", "m", "angle", "radius")
    pressure: np.ndarray = of("pressure", "Pa", "angle", "radius")

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

    speed: float = of("speed of the input shaft", "rad/s")
    load: np.ndarray = of("force of the shaft on it", "N, N m", "component")
    displacement: np.ndarray = of("displacement of the shaft in it", "m, rad", "component")
    stiffness: np.ndarray = of("tangent stiffness", "SI", "component", "displacement")
    damping: np.ndarray = of("tangent damping", "SI", "component", "velocity")
    critical_mass: float | None = of(
        "mass a bearing of a rigid rotor at its threshold", "kg", note=" on such bearings; `null` where none whirls"
    )
    whirl_ratio: float | None = of("frequency of that whirl over the speed of the shaft")
    film_temperature: float | None = of(
        "mean temperature of the film", "K", note="; `null` where the viscosity is given"
    )
    log_decrement: float | None = of(
        "smallest logarithmic decrement of the gearbox", note=", of its 24 lowest damped modes; `null`: not asked for"
    )


class BearingSheet(ModelResult, kind="bearing"):
    """One bearing; components are x, y, z in m and N, then tilts about x and y in rad and N m, as far as its law has them."""

    bearing: str = of("bearing", note=", its address")
    law: str = of("what it is", note=": its force law")
    speed: float = of("speed of the input shaft", "rad/s")
    shaft_speed: float = of("speed of its own shaft", "rad/s")
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
        "whirl threshold of the gearbox", "rad/s", json="threshold_rpm", note=", in the range `over_speed`, or `null`"
    )
    threshold_frequency_hz: float | None = of("frequency of that whirl", "Hz")
    consistency: float = of(
        "difference between its law at the state printed and the load of the gearbox", note=", relative"
    )
    error_estimate: float = of(
        "estimated relative error of stiffness and damping", note=": twice the change on a finer grid", form=error_words
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

    @property
    def components(self) -> tuple[str, ...]:
        """Names of its displacements, in their order; a nonlinear element says its own."""
        kind, _, name = self.bearing.partition(".")
        given = getattr(getattr(self.model, kind)[name], "directions", _COMPONENTS)
        return tuple(given)[: len(self.bearing_load)]

    @derived("largest load of a rolling element", "N")
    def largest_element_load(self) -> float | None:
        """Of all of them, with the cage at angle 0; None for a film."""
        return max((row.load for row in self.rolling_elements), default=None)

    @derived("static safety")
    def static_safety(self) -> float | None:
        """Load at which ISO 76 ends over the present one, at the most pressed element; None of a film."""
        pressed = max((max(row.inner_pressure, row.outer_pressure) for row in self.rolling_elements), default=0.0)
        most, power = _PERMISSIBLE["balls" in self.geometry]
        return (most / pressed) ** power if pressed else None

    def tables(self) -> Iterator[Block]:
        """Its state with stiffness and damping, what is inside, the same over speed, and notes."""
        own = f", its shaft at {self.shaft_speed * RPM_PER_RAD_S:.6g} rpm" if self.shaft_speed != self.speed else ""
        turns = f"{self.model.reference_shaft} at {self.speed * RPM_PER_RAD_S:.6g} rpm"
        yield from (Line(f"{self.bearing}: {self.law}", f", {turns}{own}"), *self._state())
        if self.oil is not None:
            yield from ("", grid(self._film(self.oil), "", "", left=2, caption="Film", headed=False))
        if self.rolling_elements:
            yield from ("", self._elements())
            if self.static_safety is not None:
                most, power = _PERMISSIBLE["balls" in self.geometry]
                how = f"({1e-6 * most:.0f} MPa over the largest pressure)^{power}"
                yield f"static safety by ISO 76: {self.static_safety:.3g} = {how}"
        if self.over_speed:
            yield from ("", self._speeds())
        mean = "means over a pitch of the rolling elements; " if self.averaged else ""
        finer = "on a grid of twice the cells" if self.oil is not None else "with twice the positions in a pitch"
        seen = (
            f"twice their change {finer}" if self.oil is not None or self.rolling_elements else "tangents of a formula"
        )
        yield from ("", f"{mean}x, y, z in um, tilts in urad; K and C in N/um, N/urad, N m/urad and kN s/m")
        yield (
            f"error: K and C {error_words(self.error_estimate)}, {seen}; the law at the state printed "
            f"differs from the load of the gearbox by {error_words(self.consistency)}"
        )
        yield f"{self.cpu_seconds:.5f} CPU s for the bearing at one speed and load, {self.cost} in all"
        if self.film is not None:
            yield from self._stability()
        yield from (*self.remarks(), "")

    def _state(self) -> Iterator[Block]:
        """Load, displacement, stiffness and damping of each component; what is rounding beside the largest is 0.

        Damping stands in a table of its own where more than two directions would make one too wide for the terminal.
        """
        shown = list(range(2 if self.along_shaft else 0, len(self.bearing_load)))
        damps = bool(np.any(self.bearing_damping))
        names = [self.components[i] for i in shown]
        parts: list[tuple[list[str], np.ndarray]] = [
            (["load"], self.bearing_load[shown, None]),
            (["moves"], 1e6 * self.bearing_displacement[shown, None]),
            ([f"K {name}" for name in names], 1e-6 * self.bearing_stiffness[np.ix_(shown, shown)]),
        ]
        damping = (
            [([f"C {name}" for name in names], 1e-3 * self.bearing_damping[np.ix_(shown, shown)])] if damps else []
        )
        tables = {"State": parts, "Damping": damping} if len(names) > 2 else {"State": parts + damping}
        for caption, columns in tables.items():
            rows = [
                (
                    f"{name}, {'N' if name in _COMPONENTS[:3] else 'N m'}",
                    *(cell for _, A in columns for cell in _cells(A[k], A)),
                )
                for k, name in enumerate(names)
            ]
            if columns:
                yield from ("", grid(rows, "", *(head for heads, _ in columns for head in heads), caption=caption))

    def _film(self, film: Any) -> Iterator[tuple[str, str]]:
        """Load, gap, pressure and heat of the film."""
        yield from film.carries(self)
        yield ("smallest gap", f"{1e6 * film.minimum_gap:.3f} um")
        yield ("largest pressure", f"{1e-6 * film.largest_pressure:.4g} MPa")
        yield ("side flow", f"{6e4 * film.side_flow:.4g} l/min")
        yield ("power loss", f"{film.power_loss:.5g} W")
        if film.film_temperature is not None and film.outlet_temperature is not None:
            mean = film.film_temperature - ZERO_CELSIUS
            outlet = film.outlet_temperature - ZERO_CELSIUS
            yield ("oil", f"in at {2.0 * mean - outlet:.4g} degC, out at {outlet:.4g} degC")
            yield ("film", f"{mean:.4g} degC, {1e3 * film.film_viscosity:.4g} mPa s")

    def _elements(self) -> Table:
        several = ("row",) if any(row.row > 1 for row in self.rolling_elements) else ()
        numbers = {id(row): k + 1 for k, row in enumerate(self.rolling_elements)}

        def loaded(name: str) -> Column:
            return Column("", name, where=lambda row: row.load > 0.0)

        pressures = (loaded("inner_pressure"), loaded("outer_pressure"))
        columns = ("angle", loaded("contact_angle"), "load", "deflection", *pressures)
        number = Column("element", lambda row: numbers[id(row)], left=True)
        return table_of(self, "rolling_elements", number, *several, *columns)

    def _speeds(self) -> Table:
        """Across the shaft, or along it; all components are in the JSON output."""
        damps = any(np.any(row.damping) for row in self.over_speed)
        own = slice(2, 3) if self.along_shaft else slice(0, 2)
        names = [one + other for one in self.components[own] for other in self.components[own]]
        told = any(row.log_decrement is not None for row in self.over_speed)
        rows = []
        for row in self.over_speed:
            K = 1e-6 * row.stiffness[own, own].ravel()
            C = 1e-3 * row.damping[own, own].ravel()
            cells = [f"{row.speed * RPM_PER_RAD_S:.6g}", f"{np.linalg.norm(row.load[own]):.4g}", *_cells(K, K, 3)]
            cells += _cells(C, C, 3) if damps else []
            cells += [written(row.log_decrement, ".3g")] if told else []
            rows.append(cells)
        heads = ("rpm", "W N", *(f"K {n}" for n in names), *(f"C {n}" for n in names if damps), *["decr."] * told)
        return grid(rows, *heads, caption="Over speed")

    def _stability(self) -> Iterator[str]:
        """When a rigid rotor on such films, and the gearbox, begin to whirl."""
        at = min(self.over_speed, key=lambda row: abs(row.speed - self.speed), default=None)
        if at is not None and at.critical_mass is not None and at.whirl_ratio is not None:
            yield (
                f"a rigid rotor on such bearings alone whirls at {at.whirl_ratio:.3f} of the speed if it has more than "
                f"{at.critical_mass:.4g} kg a bearing ({at.speed * RPM_PER_RAD_S:.6g} rpm)"
            )
        elif at is not None:
            yield "a rigid rotor on such bearings alone does not whirl, whatever its mass"
        decrement = "(decr.: least logarithmic decrement of its modes)"
        if self.threshold_speed is not None and self.threshold_frequency_hz is not None:
            yield (
                f"whirl threshold of the gearbox: {self.threshold_speed * RPM_PER_RAD_S:.6g} rpm, at "
                f"{self.threshold_frequency_hz:.4g} Hz {decrement}"
            )
        elif any(row.log_decrement is not None for row in self.over_speed):
            below = all((row.log_decrement or 0.0) < 0.0 for row in self.over_speed)
            whirls = "the gearbox whirls at all these speeds" if below else "no whirl threshold between these speeds"
            yield f"{whirls} {decrement}"


def _cells(values: np.ndarray, among: np.ndarray, digits: int = 4) -> list[str]:
    """Numbers in a few digits; 0 where one is rounding beside the largest of a group."""
    least = _NEGLIGIBLE * float(np.abs(among).max(initial=0.0))
    return ["0" if abs(value) <= least else f"{value:.{digits}g}" for value in values.tolist()]
