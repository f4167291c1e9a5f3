"""What a rig has measured: lines with the shapes that belong to them, and frequency responses, from a universal file (UFF).

Mode shapes (dataset 55) are at the sensors of a table, or at the nearest places of a model. Frequency responses (datasets 58 and
58b) are receptances between such places: accelerance and mobility become receptance by powers of i w, so that all pairs are
alike.

Several campaigns of one rig were measured at other speeds, or in other states of the gearbox, with the same uncertain numbers.
Each has a model of its own, the file's with some values changed and its speed; all share the logs of the free factors. A line is
only ever paired with a mode of its own campaign.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rotorgear.analysis.common.points import coordinates
from rotorgear.analysis.rig.rig_file import refuse_repeated, rig_lines_of
from rotorgear.analysis.rig.sensor_table import Sensor, sensors_of
from rotorgear.errors import AnalysisError, ModelError, Problem
from rotorgear.files.bounds import LONGEST_TEXT, MODEL
from rotorgear.files.read import UnreadableError, read_text
from rotorgear.files.toml import long_texts, tables_of
from rotorgear.model.model import Model
from rotorgear.note import Note
from rotorgear.results.comparison import RigLine
from rotorgear.uff.datasets import DERIVATIVES, FREQUENCY, FREQUENCY_RESPONSE, MOTIONS, SAYS_NOTHING
from rotorgear.uff.read import read_universal


@dataclass(frozen=True)
class Measured:
    """Measured modes.

    Attributes:
        lines: frequencies, with uncertainty and damping where known (n).
        points: names of the model's points where shapes were measured, or places such as "bearings.left:x" (s); empty without
            shapes.
        shapes: displacement along the direction of each point (n, s), to any scale and phase of each mode; NaN where a mode was
            not measured at a point.
        notes: sentences on what the file leaves open.
        sensors: what is known of the sensor at each point (s), where the shapes come from a file.
    """

    lines: tuple[RigLine, ...]
    points: tuple[str, ...] = ()
    shapes: NDArray[np.complex128] | None = None
    notes: tuple[str, ...] = ()
    sensors: tuple[Sensor, ...] = ()

    def __post_init__(self) -> None:
        if self.shapes is None:
            return
        if self.shapes.shape != (len(self.lines), len(self.points)):
            raise AnalysisError(
                f"measured shapes have one row a line and one column a point, ({len(self.lines)}, {len(self.points)}); "
                f"got {self.shapes.shape}"
            )
        if np.isinf(self.shapes).any():
            raise AnalysisError("measured shapes hold infinite displacements: NaN stands for one that was not measured")
        twice = sorted({point for point in self.points if self.points.count(point) > 1})
        if twice:
            raise AnalysisError(
                f"shapes were measured twice at {', '.join(twice)}: keep one sensor of each place and direction"
            )
        # A shape that is 0 everywhere has no direction to compare; its frequency is a line like any other.
        still = ~np.any(np.nan_to_num(self.shapes) != 0.0, axis=1)
        if still.any():
            object.__setattr__(self, "shapes", np.where(still[:, None], complex(np.nan), self.shapes))

    def check_points(self, model: Model) -> None:
        """Raise AnalysisError where a measured point is none of the model's."""
        for name in self.points:
            if not (name in model.points or ":" in name):
                known = ", ".join(model.points) or "none"
                raise AnalysisError(
                    f"shapes were measured at '{name}', which is no point of the model ([points]: {known}), and no part with a "
                    "direction such as 'bearings.left:x'"
                )
            coordinates(model, name)

    @property
    def real_shapes(self) -> NDArray[np.float64]:
        """The shapes turned to the phase in which each is most nearly real, (n, s); NaN rows without shapes.

        A mode with little damping moves in phase; its largest part, sum of phi^2, turned to the real axis, is that phase.
        """
        if self.shapes is None:
            return np.full((len(self.lines), 0), np.nan)
        squares = np.nansum(self.shapes**2, axis=1)
        phase = np.exp(-0.5j * np.angle(squares))
        return np.real(self.shapes * phase[:, None])


def read_rig_shapes(path: str | Path, points: str | Path | None = None, model: Model | None = None) -> Measured:
    """Return frequencies and shapes of a universal file, at its sensors.

    Args:
        path: of the universal file.
        points: of the table of sensors (CSV); None: every node that moves, at the nearest place of the model.
        model: needed where the table doesn't name all places.

    Returns:
        A line for each shape, in the order of the file, and the shapes at the sensors (n, s).

    Raises:
        ModelError: a file that can't be read, mistakes in the table, a sensor whose node no shape has.
        AnalysisError: a universal file without shapes, or whose shapes have no frequency.
    """
    file = read_universal(path)
    if not file.shapes:
        raise AnalysisError(f"{path}: no mode shapes (dataset 55) in it; its datasets: {file.kinds}")
    sensors, notes = sensors_of(file, Path(path).name, points, model)
    lines = []
    rows = []
    for number, shape in enumerate(file.shapes, start=1):
        if not 0.0 < shape.frequency_hz < math.inf:
            raise AnalysisError(
                f"{path}: shape {number} has the frequency {shape.frequency_hz:g} Hz; expected a positive one"
            )
        label = shape.names[3] if len(shape.names) > 3 else ""
        damping = shape.damping_ratio if 0.0 < shape.damping_ratio < 1.0 else None
        lines.append(RigLine(shape.frequency_hz, "" if label.lower() == "none" else label, None, damping))
        # Displacements by node and direction, those of all six that the file has.
        moved = {
            (int(n), k): value for n, row in zip(shape.nodes, shape.values, strict=True) for k, value in enumerate(row)
        }
        rows.append([s.sign * moved.get((s.node, s.direction), complex(math.nan)) for s in sensors])
    table = np.array(rows, dtype=complex)
    for sensor, seen in zip(sensors, np.isfinite(table).any(axis=0), strict=True):
        if not seen:
            problem = Problem(f"point {sensor.place}", f"node {sensor.node}", "a node that some shape of the file has")
            raise ModelError([problem], str(path))
    for number in np.flatnonzero(~np.any(np.nan_to_num(table) != 0.0, axis=1)).tolist():
        what = f"shape {number + 1} ({lines[number].frequency_hz:.4g} Hz) moves no sensor"
        notes.append(Note("", what, "taken as a line without shape"))
    if file.nodes is not None and {18, 2420} & set(file.others) and file.nodes.systems.any():
        what = "displacements are in local coordinate systems (datasets 18, 2420), which are not read"
        notes.append(Note("", what, "all are taken as global"))
    names = tuple(sensor.place for sensor in sensors)
    return Measured(tuple(lines), names, table, (*file.notes, *notes), tuple(sensors))


@dataclass(frozen=True)
class MeasuredFrf:
    """Measured receptances of p pairs of places at f frequencies.

    Attributes:
        frequency_hz: positive, ascending (f,).
        responses, references: places as `frf` takes them (p,).
        receptance: (p, f), signs of the sensors applied.
        notes: sentences on what the file leaves open.
    """

    frequency_hz: NDArray[np.float64]
    responses: tuple[str, ...]
    references: tuple[str, ...]
    receptance: NDArray[np.complex128]
    notes: tuple[str, ...] = ()


def read_rig_frf(
    path: str | Path, points: str | Path | None = None, model: Model | None = None, motion: str | None = None
) -> MeasuredFrf:
    """Return the frequency responses of a universal file (dataset 58 or 58b) as receptances.

    Args:
        path: of the file.
        points: table of sensors (CSV); None: each node at the nearest place of the model.
        model: needed where the table doesn't name all places.
        motion: what responses are, "displacement", "velocity" or "acceleration", where neither their type in the file nor their
            unit says so.

    Raises:
        ModelError: a file that can't be read.
        AnalysisError: no frequency responses, different frequencies, quantities that are no motion over force, another word.
    """
    if motion is not None and motion not in MOTIONS:
        raise AnalysisError(f"the motion of frequency responses is one of {', '.join(MOTIONS)}; got {motion!r}")
    file = read_universal(path, MOTIONS.get(motion or ""))
    functions = [function for function in file.functions if function.kind == FREQUENCY_RESPONSE]
    if not functions:
        raise AnalysisError(
            f"{path}: no frequency responses (dataset 58, function type 4) in it; its datasets: {file.kinds}"
        )
    sensors, notes = sensors_of(file, Path(path).name, points, model)
    by_freedom = {(sensor.node, sensor.direction): sensor for sensor in sensors}
    hz = functions[0].x
    rows = []
    left = 0
    for function in functions:
        wrong = ""
        if function.numerator not in DERIVATIVES:
            motions = "displacement (8), velocity (11) or acceleration (12)"
            wrong = f"the response of a function is of type {function.numerator}; expected {motions}"
            if function.numerator in SAYS_NOTHING:
                wrong += f", or a unit such as m/s^2 or g that says it; name it by --frf-motion {' | '.join(MOTIONS)}"
        elif function.denominator in DERIVATIVES:
            what = f"a motion over a motion (type {function.denominator}), a transmissibility"
            wrong = f"a function is {what}; expected motions over forces (13)"
        elif function.x_type not in (0, FREQUENCY):
            wrong = f"a function is over an axis of type {function.x_type}; expected frequency (18)"
        elif len(function.x) != len(hz) or not np.allclose(function.x, hz, rtol=1e-4):
            wrong = "frequency responses have different frequencies; give one file for each set of them"
        if wrong:
            raise AnalysisError(f"{path}: {wrong}")
        response, sign = _sensor(function.response, by_freedom)
        reference, other = _sensor(function.reference, by_freedom)
        if response is None or reference is None:
            left += 1
            continue
        w = 2.0 * np.pi * function.x
        receptance = function.values / np.where(w > 0.0, (1j * w) ** DERIVATIVES[function.numerator], 1.0)
        rows.append((response.place, reference.place, sign * other * np.asarray(receptance, dtype=complex)))
    if not rows:
        raise AnalysisError(f"{path}: none of its frequency responses is between two sensors of the table")
    if left:
        notes.append(f"{left} of {len(functions)} frequency responses are at nodes that the table of sensors has not")
    keep = hz > 0.0
    places = list(zip(*rows, strict=True))
    return MeasuredFrf(
        hz[keep], tuple(places[0]), tuple(places[1]), np.array(places[2])[:, keep], (*file.notes, *notes)
    )


def frf_of(
    frf: str | Path | MeasuredFrf | None, points: str | Path | None, model: Model, motion: str | None
) -> MeasuredFrf:
    """Frequency responses as they were measured, or those of a file, as `read_rig_frf` reads it."""
    if frf is not None and not isinstance(frf, MeasuredFrf):
        return read_rig_frf(frf, points, model, motion)
    if frf is None or motion is not None:
        raise AnalysisError("--frf-motion says what the responses in a file are: give it with --frf rig.uff")
    return frf


def _sensor(freedom: tuple[int, int], sensors: dict[tuple[int, int], Sensor]) -> tuple[Sensor | None, float]:
    """The sensor at a signed degree of freedom, and the sign of both together."""
    node, direction = freedom
    sensor = sensors.get((node, abs(direction) - 1))
    return sensor, (1.0 if direction > 0 else -1.0) * (sensor.sign if sensor else 1.0)


_KEYS = ("name", "rig", "shapes", "frf", "frf_motion", "points", "speed", "changes")
_FILES = ("rig", "shapes", "frf", "points")


@dataclass(frozen=True)
class Campaign:
    """What was measured in one state of the gearbox.

    Attributes:
        rig: a rig file (CSV), lines, plain frequencies in Hz, or lines with shapes (`rg.Measured`).
        shapes: in place of it, a universal file with shapes and their frequencies, and
        points: the table of sensors of shapes and responses.
        speed: of the input shaft in rad/s or with its unit; None: at standstill.
        changes: address -> value of what was otherwise than in the model file, such as {"disks.hub.mass": "3 kg"}.
        name: what tables call it.
        frf: beside lines or shapes, or alone: a universal file with frequency responses, or what it holds (`rg.read_rig_frf`).
        frf_motion: what its responses are where the file doesn't say it.
    """

    rig: str | Path | Measured | Sequence[RigLine | float] | None = None
    shapes: str | Path | None = None
    points: str | Path | None = None
    speed: float | str | None = None
    changes: Mapping[str, Any] = field(default_factory=dict)
    name: str = ""
    frf: str | Path | MeasuredFrf | None = None
    frf_motion: str | None = None

    def measured(self, model: Model) -> tuple[Measured, MeasuredFrf | None]:
        """Lines and shapes, and frequency responses, by the model in the state of the campaign.

        Raises:
            AnalysisError: nothing was measured, a line twice, points that the model has not.
            ModelError: a file that can't be read.
        """
        rig = self.rig
        if (rig is not None and self.shapes is not None) or (rig is None and self.shapes is None and self.frf is None):
            raise AnalysisError(
                "give what was measured: --rig lines.csv or --shapes rig.uff, --frf rig.uff beside one of them or alone, and "
                "where the sensors are: --points sensors.csv"
            )
        if self.shapes is not None:
            given = read_rig_shapes(self.shapes, self.points, model)
        elif self.points is not None and self.frf is None:
            raise AnalysisError("--points belongs to --shapes or --frf: the table of sensors says where each node is")
        elif rig is None:
            given = Measured(())
        else:
            given = rig if isinstance(rig, Measured) else Measured(rig_lines_of(rig))
        if not given.points:
            refuse_repeated(given.lines)
        given.check_points(model)
        if self.frf is None and self.frf_motion is None:
            return given, None
        return given, frf_of(self.frf, self.points, model, self.frf_motion)


def read_campaigns(path: str | Path) -> tuple[Campaign, ...]:
    """Return the campaigns of a file (TOML).

    Args:
        path: of the file: tables [[campaign]] with rig, or shapes and points, or frf and frf_motion, and speed, changes, name.
            Files that it names lie beside it.

    Raises:
        ModelError: a file that can't be read, no campaigns, other keys.
    """
    file = Path(path)
    try:
        data = tables_of(read_text(file, MODEL.most_bytes))
        if any(long_texts(data)):
            raise ValueError(f"a text or name of more than {LONGEST_TEXT} letters")
    except (UnreadableError, ValueError) as error:
        reason = error.reason if isinstance(error, UnreadableError) else str(error)
        raise ModelError([Problem(str(file), "", f"no file of campaigns (TOML): {reason}")], file.name) from None
    tables = data.get("campaign")
    if not isinstance(tables, list) or not tables or set(data) != {"campaign"}:
        raise ModelError([Problem(file.name, "", "expected tables [[campaign]], and nothing beside them")], file.name)
    problems = []
    found = []
    for number, table in enumerate(tables, start=1):
        address = f"campaign {number}"
        strange = sorted(set(table) - set(_KEYS))
        wrong = [key for key in ("name", "frf_motion", *_FILES) if not isinstance(table.get(key, ""), str)]
        if strange:
            problems.append(Problem(address, strange[0], f"only {', '.join(_KEYS)}"))
        elif wrong:
            problems.append(Problem(f"{address}: {wrong[0]}", repr(table[wrong[0]]), "a text"))
        elif not isinstance(table.get("changes", {}), dict):
            problems.append(Problem(f"{address}: changes", repr(table["changes"]), "a table of addresses and values"))
        else:
            files = {key: file.parent / table[key] for key in _FILES if key in table}
            name = table.get("name", f"campaign {number}")
            others = {key: table[key] for key in ("speed", "changes", "frf_motion") if key in table}
            found.append(Campaign(**files, **others, name=name))
    if problems:
        raise ModelError(problems, file.name)
    return tuple(found)


def joined(measured: Sequence[Measured]) -> tuple[Measured, NDArray[np.intp]]:
    """All lines of some campaigns with shapes at the points of all, NaN where there was none, and each line's campaign (n,)."""
    points = tuple(dict.fromkeys(point for given in measured for point in given.points))
    lines = tuple(line for given in measured for line in given.lines)
    owner = np.repeat(np.arange(len(measured)), [len(given.lines) for given in measured])
    notes = tuple(dict.fromkeys(note for given in measured for note in given.notes))
    if not points:
        return Measured(lines, notes=notes), owner
    table = np.full((len(lines), len(points)), np.nan, dtype=complex)
    for number, given in enumerate(measured):
        if given.shapes is not None:
            at = [points.index(point) for point in given.points]
            table[np.ix_(owner == number, at)] = given.shapes
    return Measured(lines, points, table, notes), owner
