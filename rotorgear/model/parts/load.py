"""Loads: torques that drive the train or take its power, forces and moments at any place, and unbalances.

A force with its moment is constant, goes as cos(order * angle of a shaft + phase) or cos(2 pi f t + phase), or follows a CSV
file over time or over the angle of a shaft.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Annotated, Any, Literal, Self, get_args

import numpy as np
from pydantic import BeforeValidator, Field, WithJsonSchema, model_validator

from rotorgear.files.numbers import number_of
from rotorgear.model.parts import fields as si
from rotorgear.model.parts.fields import Part, Station, Unit, listed, refuse
from rotorgear.model.parts.topography import csv_table, from_csv
from rotorgear.quantity import QuantityError, did_you_mean, parse_quantity


class Unbalance(Part):
    """An unbalance that turns with its shaft, at the speed of that shaft."""

    shaft: str = Field(description="name of the shaft")
    at: Station = Field(description="z of the unbalance")
    magnitude: si.UnbalanceSize = Field(description="mass times eccentricity")
    phase: si.Angle = Field(0.0, description="direction of the unbalance at the time 0, from +x about +z")


_Component = Literal["force_x", "force_y", "force_z", "moment_x", "moment_y", "moment_z"]
COMPONENTS = get_args(_Component)
_TURN = 2.0 * np.pi


ForceVector = Annotated[
    tuple[Annotated[float, Unit("force")], Annotated[float, Unit("force")], Annotated[float, Unit("force")]],
    listed(3, "its x, y and z such as ['0 N', '100 N', '0 N']"),
]
MomentVector = Annotated[
    tuple[Annotated[float, Unit("torque")], Annotated[float, Unit("torque")], Annotated[float, Unit("torque")]],
    listed(3, "its x, y and z such as ['0 N m', '0 N m', '5 N m']"),
]


class LoadHistory(Part):
    """Forces and moments over time, or over the angle of a shaft, linear in between."""

    over: Literal["time", "angle"] = Field(description="what the places are")
    places: tuple[float, ...] = Field(description="times in s or angles in rad, rising; a turn of angles begins again")
    components: tuple[_Component, ...] = Field(description="components that are given")
    values: tuple[tuple[float, ...], ...] = Field(description="of each component at the places, in N and N m")

    @model_validator(mode="after")
    def _is_a_table(self) -> Self:
        if len(set(self.components)) != len(self.components) or not self.components:
            raise refuse(f"components, each once; it has {', '.join(self.components) or 'none'}")
        if len(self.places) < 2:
            raise refuse(f"at least two places; it has {len(self.places)}")
        if len(self.values) != len(self.components):
            raise refuse(f"values of each component: {len(self.components)} lists; it has {len(self.values)}")
        for component, values in zip(self.components, self.values, strict=True):
            if len(values) != len(self.places):
                raise refuse(f"{len(self.places)} values of {component}, one at each place; it has {len(values)}")
        for row, (a, b) in enumerate(pairwise(self.places), 2):
            if not b > a:
                raise refuse(f"rising places; the one of number {row}, {b:g}, is not above {a:g} before it")
        if not np.isfinite([self.places, *self.values]).all():
            raise refuse("finite numbers")
        # A turn of angles begins again, so that its end is not its begin.
        if self.over == "angle" and not 0.0 <= self.places[0] <= self.places[-1] < _TURN:
            raise refuse("angles from 0 to below 2 pi rad, one turn that begins again")
        return self

    @property
    def mean(self) -> np.ndarray:
        """The part (6,) that statics take: the mean over a turn, or the values at time 0, from which a transient starts."""
        from scipy.integrate import trapezoid  # here: most models have no tables

        found = np.zeros(6)
        for name, values in zip(self.components, self.values, strict=True):
            if self.over == "time":
                mean = float(np.interp(0.0, self.places, values))
            else:
                angles, turned = self.whole_turn(values)
                mean = float(trapezoid(turned, angles)) / _TURN
            found[COMPONENTS.index(name)] = mean
        return found

    def whole_turn(self, values: tuple[float, ...]) -> tuple[np.ndarray, np.ndarray]:
        """Angles from 0 to 2 pi and the values there, closed."""
        angles = np.array(self.places)
        start = float(np.interp(0.0, angles, values, period=_TURN))
        inner = (angles > 0.0) & (angles < _TURN)
        turn = np.concatenate([[0.0], angles[inner], [_TURN]])
        return turn, np.concatenate([[start], np.array(values)[inner], [start]])


def parse_history(text: str, name: str) -> dict[str, Any]:
    """Fields of a `LoadHistory` from the text of a CSV file: a column `time` or `angle`, others force_x ... moment_z.

    Each column has its unit behind its name: `time_s`, `angle_deg`, `force_y (kN)`, `moment_z_Nm`.

    Args:
        text: of the file.
        name: what errors call it.

    Raises:
        PydanticCustomError: what is wrong, with its line.
    """
    columns, rows = csv_table(text, name, "row, such as time_s,force_y_N", _column)
    names = [column for column, _, _ in columns]
    over = [column for column in ("time", "angle") if column in names]
    if len(over) != 1 or len(set(names)) != len(names) or len(names) < 2:
        raise refuse(f"one column of time or angle, each of {', '.join(COMPONENTS)} at most once; {name} has {names}")
    axis = over[0]
    table = []
    for line, cells in rows:
        try:
            pairs = zip(cells, columns, strict=True)
            table.append([parse_quantity(f"{number_of(cell)!r} {unit}", kind) for cell, (_, kind, unit) in pairs])
        except (ValueError, QuantityError):
            raise refuse(
                "a finite number with a decimal point in each cell (leave rows without a value out); "
                f"{line} has '{'; '.join(cells)}'"
            ) from None
    by_name = dict(zip(names, zip(*table, strict=True), strict=True))
    places = by_name.pop(axis)
    if len(places) < 2:
        raise refuse(f"at least two rows; {name} has one")
    for (a, b), (line, _) in zip(pairwise(places), rows[1:], strict=True):
        if b <= a:
            how = "the same as" if b == a else "below that of"
            raise refuse(f"rising {axis}s; that of {line} is {how} the row before: sort the rows, each once")
    if axis == "angle":
        # Angles go from 0 to below a whole turn; a last row at 360 deg repeats the first one.
        if places[0] < 0.0 or places[-1] > _TURN * (1.0 + 1e-9):
            raise refuse(f"angles from 0 to 360 deg, one turn that begins again; {name} goes beyond")
        if places[0] == 0.0 and places[-1] > _TURN * (1.0 - 1e-9):
            size = max(abs(x) for values in by_name.values() for x in values)
            if any(abs(values[-1] - values[0]) > 1e-9 * size for values in by_name.values()):
                raise refuse(f"the same values at 360 deg as at 0 deg, where the turn begins again; {name} has others")
            places = places[:-1]
            by_name = {column: values[:-1] for column, values in by_name.items()}
    return {"over": axis, "places": places, "components": tuple(by_name), "values": tuple(by_name.values())}


def _column(cell: str, line: str) -> tuple[str, str, str]:
    """Name, dimension and unit of a column from its header."""
    kinds = {"time": "time", "angle": "angle"} | {c: "force" if c[0] == "f" else "torque" for c in COMPONENTS}
    text = cell.strip().strip("])").replace("[", " ").replace("(", " ")
    found = next((name for name in kinds if text.lower().startswith(name)), None)
    if found is None:
        hint = did_you_mean(text.lower(), kinds, f"there are {', '.join(kinds)}")
        raise refuse(f"columns that are known; {line} has '{cell}' ({hint})")
    unit = text[len(found) :].strip(" _")
    try:
        parse_quantity(f"1.0 {unit}", kinds[found])
    except QuantityError as error:
        raise refuse(f"the unit of '{found}' in its header, {error}; {line} has '{cell}'") from None
    return found, kinds[found], unit


HistoryFile = Annotated[
    LoadHistory,
    BeforeValidator(lambda value: from_csv(value, "a load over time or angle", parse_history)),
    WithJsonSchema({"type": "string", "description": "CSV file over time or angle, beside the model file"}),
]


class Load(Part):
    """A torque that drives or loads the train, or a force and a moment at a place."""

    shaft: str | None = Field(None, description="name of the shaft")
    kind: Literal["input", "output"] | None = Field(None, description="of a torque; input: drives; output: takes power")
    at: Station | None = Field(
        None, description="z of the place; default of a torque: start for an input, end for an output"
    )
    torque: si.Torque | None = Field(None, description="size of the torque; left out of one load: the rest")
    power: si.Power | None = Field(None, description="power, in place of the torque")
    speed_power: si.SignedRatio = Field(
        0.0,
        description="transient: the torque goes with this power of the speed; 2 for a propeller, -1 for constant power",
    )
    ripple: si.Ratio = Field(
        0.0, description="transient and response: amplitude of the torque's ripple as a share of it"
    )
    ripple_order: si.PositiveRatio = Field(1.0, description="periods of the ripple in a turn of its shaft")
    step_to: si.Ratio = Field(1.0, description="transient: share of the torque that remains after a step")
    step_at: si.Time = Field(0.0, description="transient: time at which the step begins")
    step_duration: si.PositiveTime = Field(0.001, description="transient: how long the step takes")
    gear: str | None = Field(
        None, description="name of the gear that a force acts on, in place of shaft and at; in the middle of its face"
    )
    point: str | None = Field(None, description="name of the point that a force acts at, in place of shaft and at")
    force: ForceVector | None = Field(None, description="force along x, y and z")
    moment: MomentVector | None = Field(None, description="moment about x, y and z")
    order: si.PositiveRatio | None = Field(
        None,
        description="force and moment go as cos(order * angle + phase) with the angle of a shaft; default: constant",
    )
    order_of: str | None = Field(None, description="name of the shaft whose angle counts; default: that it acts on")
    frequency: si.Frequency | None = Field(
        None, description="force and moment go as cos(2 pi frequency * time + phase), in place of an order"
    )
    phase: si.Angle = Field(0.0, description="phase at angle or time 0")
    history: HistoryFile | None = Field(
        None,
        description="forces and moments over time or angle, in place of force and moment",
    )

    @property
    def is_torque(self) -> bool:
        """Whether it is a torque that drives or loads the train, not a force or moment at a place."""
        return self.force is None and self.moment is None and self.history is None

    @property
    def over_angle(self) -> bool:
        """Whether it follows a history over the angle of a shaft."""
        return self.history is not None and self.history.over == "angle"

    @property
    def on_shaft(self) -> str:
        """The shaft of a torque; "" where it names none, which is a problem of the model."""
        return self.shaft or ""

    @property
    def varies(self) -> bool:
        """Whether a torque changes with time or speed."""
        return bool(self.speed_power or self.ripple or self.step_to != 1.0)
