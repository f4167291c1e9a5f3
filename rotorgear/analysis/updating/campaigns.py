"""Several campaigns of one rig: measured at other speeds, or in other states of the gearbox, with the same uncertain numbers.

Each campaign has a model of its own, the file's with some values changed and its speed; all share the logs of the free factors.
Their modes stand one after the other, and a line is only ever paired with a mode of its own campaign.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rotorgear.analysis.rig.frf_file import MeasuredFrf
from rotorgear.analysis.rig.measured import Measured
from rotorgear.analysis.rig.rig_model import RigModel, RigModes, Shapes
from rotorgear.errors import ModelError, Problem
from rotorgear.model.numbers import FreeNumbers
from rotorgear.results.comparison import RigLine
from rotorgear.system.system import System

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


@dataclass(frozen=True)
class CampaignModes:
    """Modes of all campaigns, one after the other: as `RigModes`, at the points of all (m, s)."""

    parts: tuple[RigModes, ...]
    at_points: Shapes

    @property
    def system(self) -> System:
        """That of the first campaign."""
        return self.parts[0].system

    @property
    def eigenvalues(self) -> NDArray[np.float64]:
        """w^2 (m,)."""
        return np.concatenate([part.eigenvalues for part in self.parts])

    @property
    def frequency_hz(self) -> NDArray[np.float64]:
        """Natural frequencies in Hz, (m,)."""
        return np.sqrt(self.eigenvalues) / (2.0 * np.pi)

    @property
    def campaign(self) -> NDArray[np.intp]:
        """Number of the campaign that each mode belongs to, (m,)."""
        return np.repeat(np.arange(len(self.parts)), [len(part.eigenvalues) for part in self.parts])

    def overlap(self, other: CampaignModes) -> NDArray[np.float64]:
        """How far each mode here is one there (m, m'); nothing between campaigns."""
        found = np.zeros((len(self.eigenvalues), len(other.eigenvalues)))
        for number, (part, moved) in enumerate(zip(self.parts, other.parts, strict=True)):
            found[np.ix_(self.campaign == number, other.campaign == number)] = part.overlap(moved)
        return found


@dataclass
class CampaignModel:
    """The models of all campaigns with the same free factors; `points` are those of all of them."""

    parts: tuple[RigModel, ...]
    points: tuple[str, ...]

    @property
    def numbers(self) -> FreeNumbers:
        """The free numbers, as the first campaign has them."""
        return self.parts[0].numbers

    @property
    def solutions(self) -> int:
        """Eigenproblems solved: each campaign has one at every set of numbers, and the most of them counts."""
        return max(part.solutions for part in self.parts)

    def modes(self, x: NDArray[np.float64]) -> CampaignModes:
        """The elastic modes at x."""
        parts = tuple(part.modes(x) for part in self.parts)
        turning = any(np.iscomplexobj(part.at_points) for part in parts)
        counts = np.cumsum([0, *(len(part.eigenvalues) for part in parts)])
        table = np.zeros((counts[-1], len(self.points)), dtype=complex if turning else float)
        for first, model, part in zip(counts, self.parts, parts, strict=False):
            table[first : first + len(part.eigenvalues), self._at(model)] = part.at_points
        return CampaignModes(parts, table)

    def derivatives(
        self, x: NDArray[np.float64], modes: CampaignModes, chosen: NDArray[np.intp], *, shapes: bool
    ) -> tuple[NDArray[np.float64], Shapes]:
        """d ln f / dx (k, p) and d phi / dx at the points (k, s, p) of k chosen modes."""
        slopes = np.zeros((len(chosen), len(x)))
        kind = complex if np.iscomplexobj(modes.at_points) else float
        moved = np.zeros((len(chosen), len(self.points), len(x)), dtype=kind)
        for rows, model, part, own in self._of_each(modes, chosen):
            slopes[rows], at_points = model.derivatives(x, part, own, shapes=shapes)
            moved[np.ix_(rows, np.array(self._at(model), dtype=np.intp))] = at_points
        return slopes, moved

    def _of_each(
        self, modes: CampaignModes, chosen: NDArray[np.intp]
    ) -> Iterator[tuple[NDArray[np.intp], RigModel, RigModes, NDArray[np.intp]]]:
        """Rows of the chosen modes of each campaign, its model and modes, and their numbers in it."""
        first = 0
        for number, (model, part) in enumerate(zip(self.parts, modes.parts, strict=True)):
            rows = np.flatnonzero(modes.campaign[chosen] == number)
            if len(rows):
                yield rows, model, part, chosen[rows] - first
            first += len(part.eigenvalues)

    def _at(self, model: RigModel) -> list[int]:
        return [self.points.index(point) for point in model.points]
