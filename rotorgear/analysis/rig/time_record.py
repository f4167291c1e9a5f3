"""What the channels of a record over time are on a model: loads that act on it, and motions and forces that it answers with.

A channel belongs to a point or a load of its name, or to what `channels` names: "points.upper", "-points.propeller" where it
looks the other way, "loads.motor", a place and its direction such as "bearings.left:x", or "shafts.output" for the speed that
orders are counted by; a scale may follow for a channel without a unit, "points.case, 98.1 m/s^2". What a channel tells of a
motion follows from its unit: m, m/s or m/s^2; in N or N m it is a force that acts there, but at a bearing, or a point of the
load inside a shaft or coupling, the one that the model computes.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rotorgear.analysis.common.points import located
from rotorgear.analysis.rig.sensor_table import sensors_of
from rotorgear.errors import AnalysisError, ModelError, Problem
from rotorgear.files.numbers import NUMBER
from rotorgear.model.model import Model
from rotorgear.model.parts.fields import DOF_NAMES
from rotorgear.model.parts.load import COMPONENTS, Load
from rotorgear.quantity import GRAVITY, QuantityError, did_you_mean, parse_in_unit, parse_quantity
from rotorgear.records.read import read_record
from rotorgear.records.record import Channel, TimeRecord
from rotorgear.uff.datasets import AXES, FORCE, MOTIONS
from rotorgear.uff.read import read_universal

LOAD = "load"
OUTPUT = "output"
TURNING = "speed"
# Of a motion: what it is called, its SI unit for a displacement and for a rotation.
_MOTIONS = (("displacement", "m", "rad"), ("velocity", "m/s", "rad/s"), ("acceleration", "m/s^2", "rad/s^2"))
_TIME_RESPONSE = 1
_UNIVERSAL = (".uff", ".unv", ".univ")
_ADDED = "from_record"
# Times that differ from even ones by more than this share of a step are taken at even ones, and so much is told.
_EVEN = 1e-3


@dataclass(frozen=True)
class Placed:
    """A channel on the model.

    Attributes:
        name: as the file has it. place: as it was named on the model.
        kind: LOAD, OUTPUT or TURNING. quantity: what it tells, such as "torque" or "acceleration".
        unit: in SI; values: (n,) in it, positive as the model has them.
        history: of an output, what the transient calls it; of a load, the address of what acts in its place.
    """

    name: str
    place: str
    kind: str
    quantity: str
    unit: str
    values: NDArray[np.float64]
    history: str


@dataclass(frozen=True)
class RecordOnModel:
    """A record with the model that its loads act on: `time` (n,) in s, evenly spaced, as the file counts it."""

    model: Model
    time: NDArray[np.float64]
    channels: tuple[Placed, ...]
    notes: tuple[str, ...]

    def of(self, kind: str) -> list[Placed]:
        """The channels of a kind."""
        return [one for one in self.channels if one.kind == kind]


def record_on_model(
    model: Model, path: str | Path | TimeRecord, channels: Mapping[str, str] | None, points: str | Path | None
) -> RecordOnModel:
    """Return the channels of a record on a model, and the model with the loads and points that they need.

    Args:
        model: a model. path: of the file, or a record. channels: name of a channel -> its place.
        points: table of the sensors of a universal file (CSV).

    Raises:
        ModelError: a file that can't be read.
        AnalysisError: names that the record or the model has not, units that do not fit, nothing to compare.
    """
    places = dict(channels or {})
    if isinstance(path, TimeRecord):
        record = path
    elif Path(path).suffix.lower() in _UNIVERSAL:
        record, own = _of_universal(Path(path), points, model)
        places = own | places
    else:
        record = read_record(path)
    if points is not None and (isinstance(path, TimeRecord) or Path(path).suffix.lower() not in _UNIVERSAL):
        raise AnalysisError("--points is the table of sensors of a universal file; name channels by --channels")
    names = [channel.name for channel in record.channels]
    places = {name: place for name in names if (place := _named(name, model))} | places
    if twice := sorted({name for name in names if names.count(name) > 1} & places.keys()):
        raise AnalysisError(
            f"channels: the record has {names.count(twice[0])} channels '{twice[0]}': leave all but one out"
        )
    if strange := [name for name in places if name not in names]:
        hint = did_you_mean(strange[0], names, f"channels of the record: {', '.join(names)}"[:300])
        raise AnalysisError(f"channels: the record has no channel '{strange[0]}' ({hint})")
    record, notes = _evenly(record)
    changes: dict[str, Any] = {}
    found = [
        _on_model(channel, places[channel.name], model, record.time - record.time[0], changes)
        for channel in record.channels
        if channel.name in places
    ]
    if unused := [name for name in names if name not in places]:
        notes.append(
            f"channels that no point or load of the model is called by, nor --channels names: {', '.join(unused)}"
        )
    if not any(one.kind == OUTPUT for one in found):
        raise AnalysisError(
            f"no channel of the record is on the model: call points or loads as the channels ({', '.join(names)[:200]}), or name "
            "their places by --channels 'NAME=points.sensor'"
        )
    changed = model.with_(changes) if changes else model
    return RecordOnModel(changed, record.time, tuple(found), (*record.notes, *notes))


def _named(name: str, model: Model) -> str:
    """The place that a channel is called by: a point, a load, or a place itself; "" where it is none."""
    for table in ("points", "loads"):
        for part in getattr(model, table):
            if name.lower() in (part.lower(), f"{table}.{part}".lower()):
                return f"{table}.{part}"
    return name if re.match(r"(bearings|gears|disks|casings|couplings|shafts)\.", name) else ""


def _evenly(record: TimeRecord) -> tuple[TimeRecord, list[str]]:
    """The record at evenly spaced times."""
    time = record.time
    step = (time[-1] - time[0]) / (len(time) - 1)
    even = time[0] + step * np.arange(len(time))
    off = float(np.abs(time - even).max()) / step
    if off <= _EVEN:
        return replace(record, time=even), []
    channels = tuple(Channel(one.name, one.unit, np.interp(even, time, one.values)) for one in record.channels)
    return TimeRecord(even, channels, record.notes), [f"times are uneven by up to {off:.2g} steps: taken at even ones"]


def _on_model(channel: Channel, text: str, model: Model, time: NDArray[np.float64], changes: dict[str, Any]) -> Placed:
    """A channel at its place; `changes` of the model gain the load or point that it needs."""
    place, _, scale = (part.strip() for part in text.partition(","))
    sign = -1.0 if place.startswith("-") else 1.0
    place = place.lstrip("+-").strip()
    if place.startswith("points.") and place.removeprefix("points.") in model.points:
        place = place.removeprefix("points.")
    unit = channel.unit
    if scale:
        # What 1 in the file means.
        number = re.match(NUMBER, scale)
        unit = scale[number.end() :].strip() if number else ""
        if channel.unit or not unit or number is None:
            what = f"the record has it in {channel.unit} already" if channel.unit else f"got '{scale}'"
            raise AnalysisError(
                f"channel '{channel.name}': a scale is a number and a unit such as '98.1 m/s^2'; {what}"
            )
        sign *= float(number[0])
    told = f"channel '{channel.name}' at '{place}'"

    def in_si(*units: str) -> tuple[int, float]:
        """Which of some SI units that of the channel goes to, and its factor."""
        for k, wanted in enumerate(units):
            if unit == "g" and wanted == "m/s^2":
                return k, GRAVITY
            try:
                # Speeds are told apart from frequencies by their dimension, not by their unit.
                one = parse_quantity(f"1 {unit}", "speed") if wanted == "rad/s" else parse_in_unit(f"1 {unit}", wanted)
            except QuantityError:
                continue
            return k, one
        given = f"is in '{unit}'" if unit else "has no unit"
        remedy = "" if unit else "; say what 1 means: --channels 'NAME=PLACE, 9.81 m/s^2'"
        raise AnalysisError(f"{told} {given}, and needs one of {', '.join(units)}{remedy}")

    def seen(kind: str, quantity: str, si: str, factor: float, history: str) -> Placed:
        return Placed(channel.name, place, kind, quantity, si, sign * factor * channel.values, history)

    def act(where: dict[str, Any], along: NDArray[np.float64], values: NDArray[np.float64], *, drives: bool) -> str:
        """Let a force or moment act over time, along a direction (6,) of the model; its address.

        What drives a train begins at 0: the model starts from the balance of its own torques.
        """
        name = f"{_ADDED}_{len(changes) + 1}"
        moved = [k for k in range(6) if abs(along[k]) > 1e-12]
        components = tuple(COMPONENTS[k] for k in moved)
        values = np.concatenate([[0.0], values[1:]]) if drives else values
        table = tuple(tuple((along[k] * values).tolist()) for k in moved)
        history = {"over": "time", "places": tuple(time.tolist()), "components": components, "values": table}
        changes[f"loads.{name}"] = {**where, "history": history}
        return f"loads.{name}"

    if place.startswith("shafts."):
        if place.removeprefix("shafts.") not in model.shafts:
            raise AnalysisError(f"{told}: the model has no such shaft; it has {', '.join(model.shafts)}")
        return seen(TURNING, "speed", "rad/s", in_si("rad/s")[1], "")
    if place.startswith("loads."):
        name, _, component = place.removeprefix("loads.").partition(":")
        load = model.loads.get(name)
        if load is None:
            raise AnalysisError(f"{told}: the model has no such load; it has {', '.join(model.loads) or 'none'}")
        k, where, along, held = _of_load(model, name, load, component, told, changes)
        si = "N m" if k > 2 else "N"
        found = seen(LOAD, "torque" if load.is_torque else "moment" if k > 2 else "force", si, in_si(si)[1], "")
        return replace(found, history=act(where, along, found.values - held, drives=k == 5))
    point = model.points.get(place)
    if point is not None and point.quantity is not None:
        return seen(
            OUTPUT, point.quantity, point.load_unit, in_si(point.load_unit)[1], f"points.{place} {point.quantity}"
        )
    _, there, dof = located(model, place)
    turns = dof > 2
    motions = [row[2 if turns else 1] for row in _MOTIONS]
    force = "N m" if turns else "N"
    k, factor = in_si(*motions, force)
    table, _, part = place.rpartition(":")[0].partition(".")
    if k == len(motions) and table == "bearings":
        if turns:
            raise AnalysisError(f"{told}: of a bearing the force along x, y or z is known")
        return seen(OUTPUT, "force", "N", factor, f"bearings.{part} force {DOF_NAMES[dof]}")
    name = place
    if place not in model.points:
        name = f"{_ADDED}_{len(changes) + 1}"
        changes[f"points.{name}"] = _as_point(place, dof, told)
    if k < len(motions):
        return seen(OUTPUT, _MOTIONS[k][0], motions[k], factor, f"points.{name} {_MOTIONS[k][0]}")
    found = seen(LOAD, "moment" if turns else "force", force, factor, "")
    return replace(found, history=act({"point": name}, _direction(model, there, dof), found.values, drives=dof == 5))


def _direction(model: Model, where: Any, dof: int) -> NDArray[np.float64]:
    """The direction (6,) in the model of one on a shaft; casings have those of the model."""
    shaft = getattr(where, "shaft", None)
    return np.eye(6)[dof] if shaft is None else np.asarray(model.shafts[shaft].frame.six[:, dof])


def _as_point(place: str, dof: int, told: str) -> dict[str, Any]:
    """A point of the model at a place as `frf` takes it."""
    address = place.rpartition(":")[0]
    if not address.startswith("casings."):
        return {"on": address, "direction": DOF_NAMES[dof]}
    found = re.fullmatch(r"(casings\.[\w -]+?)\(([^()]*)\)", address)
    if found is None:
        raise AnalysisError(
            f"{told}: name a place on the surface of the casing, such as 'casings.box(0 mm; 9 mm; 8 mm):y'"
        )
    return {"on": found[1], "place": [part.strip() for part in found[2].split(";")], "direction": DOF_NAMES[dof]}


def _of_load(
    model: Model, name: str, load: Load, component: str, told: str, changes: dict[str, Any]
) -> tuple[int, dict[str, Any], NDArray[np.float64], float]:
    """Number of the component of a load that a channel is, where it acts, its direction (6,), and what the model has of it.

    That constant part stays in the model, which starts from equilibrium under it; what varies otherwise is taken away. A torque
    that drives is positive in the sense in which its shaft turns, one that takes power against it.
    """
    if load.is_torque:
        if component or load.shaft is None:
            raise AnalysisError(f"{told}: a torque has no component; call it 'loads.{name}'")
        sense = model.layout.direction * (np.sign(float(model.layout.train.ratio(load.shaft))) or 1.0)
        sense = sense if load.kind == "input" else -sense
        at = load.at if load.at is not None else "start" if load.kind == "input" else "end"
        applied = next(item for item in model.torque_flow().applied if item.name.removeprefix("loads.") == name)
        for key, constant in (("speed_power", 0.0), ("ripple", 0.0), ("step_to", 1.0)):
            if getattr(load, key) != constant:
                changes[f"loads.{name}.{key}"] = constant
        return 5, {"shaft": load.shaft, "at": at}, sense * _direction(model, load, 5), float(sense * applied.torque)
    given = [*(load.force or (0.0,) * 3), *(load.moment or (0.0,) * 3)]
    has = [COMPONENTS[k] for k in np.flatnonzero(given)] if load.history is None else list(load.history.components)
    if component not in COMPONENTS and (component or len(has) != 1):
        raise AnalysisError(f"{told}: say which component it is, such as 'loads.{name}:{(has or ['force_y'])[0]}'")
    k = COMPONENTS.index(component or has[0])
    where = {key: getattr(load, key) for key in ("shaft", "at", "gear", "point") if getattr(load, key) is not None}
    varies = load.order is not None or load.frequency is not None or load.history is not None
    if varies:
        changes[f"loads.{name}"] = None
    return k, where, np.eye(6)[k], 0.0 if varies else float(given[k])


def _of_universal(file: Path, points: str | Path | None, model: Model) -> tuple[TimeRecord, dict[str, str]]:
    """The functions over time of a universal file (dataset 58) as a record in SI, and the places of its channels."""
    universal = read_universal(file)
    functions = [one for one in universal.functions if one.kind == _TIME_RESPONSE and not np.iscomplexobj(one.values)]
    if not functions:
        datasets = f"its datasets: {universal.kinds}"
        raise ModelError(
            [Problem(file.name, "", "functions over time (dataset 58, function type 1)", datasets)], str(file)
        )
    sensors, notes = sensors_of(replace(universal, functions=tuple(functions), shapes=()), file.name, points, model)
    by_freedom = {(sensor.node, sensor.direction): sensor for sensor in sensors}
    words = {number: name for name, number in MOTIONS.items()} | {FORCE: "force"}
    channels = []
    places = {}
    time = functions[0].x
    for one in functions:
        if len(one.x) != len(time) or not np.allclose(
            one.x, time, rtol=0.0, atol=_EVEN * float(time[-1] - time[0]) / len(time)
        ):
            raise AnalysisError(
                f"{file.name}: its functions are over different times; give one file for each set of them"
            )
        node, direction = one.response
        if one.numerator not in words or not direction:
            continue
        turns = abs(direction) > 3
        units = {name: row[2 if turns else 1] for row in _MOTIONS for name in [row[0]]} | {
            "force": "N m" if turns else "N"
        }
        what = words[one.numerator]
        axis = f"{'-' if direction < 0 else ''}{AXES[abs(direction) - 1]}"
        name = f"{node} {axis} {what}"
        sensor = by_freedom.get((node, abs(direction) - 1))
        channels.append(Channel(name, units[what], np.asarray(one.values, dtype=float)))
        if sensor is not None:
            places[name] = f"{'-' if (direction < 0) != (sensor.sign < 0.0) else ''}{sensor.place}"
    return TimeRecord(np.asarray(time, dtype=float), tuple(channels), (*universal.notes, *notes)), places
