"""Several campaigns of one rig: measured at other speeds, or in other states of the gearbox, with the same uncertain numbers.

Each campaign has a model of its own, the file's with some values changed and its speed; all share the logs of the free factors.
A line is only ever paired with a mode of its own campaign.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rotorgear.analysis.rig.measured import Measured, MeasuredFrf, read_rig_frf, read_rig_shapes
from rotorgear.analysis.rig.rig_file import refuse_repeated, rig_lines_of
from rotorgear.errors import AnalysisError, ModelError, Problem
from rotorgear.model.model import Model
from rotorgear.results.comparison import RigLine

_KEYS = ("name", "rig", "shapes", "frf", "points", "speed", "changes")
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
    """

    rig: str | Path | Measured | Sequence[RigLine | float] | None = None
    shapes: str | Path | None = None
    points: str | Path | None = None
    speed: float | str | None = None
    changes: Mapping[str, Any] = field(default_factory=dict)
    name: str = ""
    frf: str | Path | MeasuredFrf | None = None

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
        if self.frf is None or isinstance(self.frf, MeasuredFrf):
            return given, self.frf
        return given, read_rig_frf(self.frf, self.points, model)


def read_campaigns(path: str | Path) -> tuple[Campaign, ...]:
    """Return the campaigns of a file (TOML).

    Args:
        path: of the file: tables [[campaign]] with rig, or shapes and points, or frf, and speed, changes, name. Files that it
            names lie beside it.

    Raises:
        ModelError: a file that can't be read, no campaigns, other keys.
    """
    file = Path(path)
    try:
        data = tomllib.loads(file.read_text(encoding="utf-8-sig"))
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        raise ModelError([Problem(str(file), "", f"no file of campaigns (TOML): {reason}")], file.name) from None
    tables = data.get("campaign")
    if not isinstance(tables, list) or not tables or set(data) != {"campaign"}:
        raise ModelError([Problem(file.name, "", "expected tables [[campaign]], and nothing beside them")], file.name)
    problems = []
    found = []
    for number, table in enumerate(tables, start=1):
        address = f"campaign {number}"
        strange = sorted(set(table) - set(_KEYS))
        wrong = [key for key in ("name", *_FILES) if not isinstance(table.get(key, ""), str)]
        if strange:
            problems.append(Problem(address, strange[0], f"only {', '.join(_KEYS)}"))
        elif wrong:
            problems.append(Problem(f"{address}: {wrong[0]}", repr(table[wrong[0]]), "a text"))
        elif not isinstance(table.get("changes", {}), dict):
            problems.append(Problem(f"{address}: changes", repr(table["changes"]), "a table of addresses and values"))
        else:
            files = {key: file.parent / table[key] for key in _FILES if key in table}
            name = table.get("name", f"campaign {number}")
            found.append(Campaign(**files, speed=table.get("speed"), changes=table.get("changes", {}), name=name))
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
