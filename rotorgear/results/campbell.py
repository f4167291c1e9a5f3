"""Result of a Campbell analysis: branches of modes over speed, excitation lines, crossings, margins, onset of instability."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from rotorgear.model.model import Model
from rotorgear.results.modal import NodeTable, Piece
from rotorgear.results.plain import plain

WHIRL_WORDS = ("", "forward", "backward", "mixed", "planar")
RPM = 30.0 / np.pi


@dataclass(frozen=True)
class ExcitationOrder:
    """A line of excitation: `order` times the speed of the input shaft.

    Attributes:
        name: what a reader sees, such as "mesh stage_1 2x".
        kind: "shaft", "mesh" or "sideband".
        parts: the shafts or meshes that excite at this order.
        order: frequency over the rotational frequency of the input shaft, above 0.
    """

    name: str
    kind: str
    parts: tuple[str, ...]
    order: float

    def frequency_hz(self, speed: float) -> float:
        """Frequency in Hz at a speed of the input shaft in rad/s."""
        return float(self.order * abs(speed) / (2.0 * np.pi))


@dataclass(frozen=True)
class Crossing:
    """Where a branch (counted from 1) meets a line.

    Attributes:
        line: its name. speed: of the input shaft in rad/s. frequency_hz: damped frequency of the mode there.
        damping_ratio: of the mode there. whirl: its sense, as in the branches.
        participation: share of the exciting mesh in the strain energy of the mode, or of the exciting shaft in its kinetic
            energy (first order of a shaft: forward whirl of its bending only, which is what unbalance can drive).
        excited: False where the participation is below 1e-4: this line can't excite this mode.
    """

    line: str
    branch: int
    speed: float
    frequency_hz: float
    damping_ratio: float
    whirl: str
    participation: float
    excited: bool


@dataclass(frozen=True)
class Margin:
    """The mode next to a line at the operating speed, among those that the line can excite.

    Attributes:
        line: its name. frequency_hz: of the line. branch: counted from 1; 0 where the line lies above
            all branches, or can't excite any.
        mode_hz: damped frequency of that mode. margin: mode_hz / frequency_hz - 1. participation: as at a crossing.
        crossing_speed: nearest speed in rad/s, in the range, at which the line meets a mode that it can excite; NaN: none.
    """

    line: str
    frequency_hz: float
    branch: int
    mode_hz: float
    margin: float
    participation: float
    crossing_speed: float


@dataclass(frozen=True)
class Onset:
    """Where a branch (counted from 1; 0: a motion that does not oscillate) becomes unstable: speed in rad/s and frequency."""

    branch: int
    speed: float
    frequency_hz: float


@dataclass(frozen=True)
class CampbellResult:
    """b branches of modes over k speeds.

    Attributes:
        model: the model that was analysed.
        speeds: (k,) speeds of the input shaft in rad/s, ascending in size.
        eigenvalues: (k, b) complex, s in rad/s; NaN where a branch does not oscillate, or is out of reach.
        whirl: (k, b) numbers into `WHIRL_WORDS`; whirl_by_shaft: shaft -> (k, b), -1 backward to +1 forward, in its own sense.
        kinetic_by_motion, strain_by_motion, mesh_strain: shares of energy, motion or mesh -> (k, b).
        description: one line for each branch, at its first speed.
        error_estimate: (b,) estimated relative discretisation error, the larger of both ends; NaN where it was left out.
        basis_error: largest relative error of the reduced eigenvalues against true solutions at speeds outside of the basis.
        basis: (p, 6, r) real, displacements of the basis at nodes and stations; coordinates: (k, r, b) complex.
        nodes: where the p stations are.
        lines, crossings, margins, onsets: see their classes. operating_speed: in rad/s; None without one.
        dofs, discretisation, seconds, left_out, warnings, method: as in a modal result.
    """

    model: Model
    speeds: np.ndarray
    eigenvalues: np.ndarray
    whirl: np.ndarray
    whirl_by_shaft: dict[str, np.ndarray]
    kinetic_by_motion: dict[str, np.ndarray]
    strain_by_motion: dict[str, np.ndarray]
    mesh_strain: dict[str, np.ndarray]
    description: tuple[str, ...]
    error_estimate: np.ndarray
    basis_error: float
    basis: np.ndarray
    coordinates: np.ndarray
    nodes: NodeTable
    lines: tuple[ExcitationOrder, ...]
    crossings: tuple[Crossing, ...]
    margins: tuple[Margin, ...]
    onsets: tuple[Onset, ...]
    operating_speed: float | None
    dofs: int
    discretisation: tuple[Piece, ...]
    seconds: dict[str, float]
    left_out: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    method: str = ""

    def __len__(self) -> int:
        return int(self.eigenvalues.shape[1])

    @property
    def speed_rpm(self) -> np.ndarray:
        """Speeds of the input shaft in rpm, (k,)."""
        return np.asarray(self.speeds * RPM)

    @property
    def frequency_hz(self) -> np.ndarray:
        """Damped frequency Im s / 2 pi, (k, b)."""
        return np.asarray(self.eigenvalues.imag / (2.0 * np.pi))

    @property
    def natural_frequency_hz(self) -> np.ndarray:
        """|s| / 2 pi, (k, b)."""
        return np.asarray(np.abs(self.eigenvalues) / (2.0 * np.pi))

    @property
    def damping_ratio(self) -> np.ndarray:
        """-Re s / |s|, (k, b)."""
        return np.asarray(-self.eigenvalues.real / np.abs(self.eigenvalues) + 0.0)

    @property
    def log_decrement(self) -> np.ndarray:
        """2 pi zeta / sqrt(1 - zeta^2), (k, b); negative where the motion grows."""
        return np.asarray(-2.0 * np.pi * self.eigenvalues.real / self.eigenvalues.imag + 0.0)

    def whirl_word(self, speed: int, branch: int) -> str:
        """Sense of whirl of a branch at a speed, by their numbers from 0."""
        return WHIRL_WORDS[int(self.whirl[speed, branch])]

    def shapes(self, speed: int) -> np.ndarray:
        """Displacements x y z tx ty tz of all branches at a speed (number from 0), (p, 6, b) complex, modal mass 1."""
        return np.asarray(self.basis @ self.coordinates[speed])

    def to_dict(self) -> dict[str, Any]:
        """Everything but the shapes as plain values for JSON; the keys are documented in docs/json.md."""
        words = [[self.whirl_word(k, b) for k in range(len(self.speeds))] for b in range(len(self))]
        by_branch = {
            "frequency_hz": self.frequency_hz,
            "natural_frequency_hz": self.natural_frequency_hz,
            "damping_ratio": self.damping_ratio,
            "log_decrement": self.log_decrement,
        }
        shares = ("whirl_by_shaft", "kinetic_by_motion", "strain_by_motion", "mesh_strain")
        operating = self.operating_speed
        return {
            "analysis": "campbell",
            "title": self.model.title,
            "speed_rpm": plain(self.speed_rpm),
            "operating_speed_rpm": None if operating is None else operating * RPM,
            **{key: plain(values.T) for key, values in by_branch.items()},
            "whirl": words,
            **{name: {key: plain(v.T) for key, v in getattr(self, name).items()} for name in shares},
            "description": list(self.description),
            "error_estimate": plain(self.error_estimate),
            "basis_error": self.basis_error,
            "lines": [asdict(line) for line in self.lines],
            "crossings": [_with_rpm(asdict(item), "speed") for item in self.crossings],
            "margins": [_with_rpm(asdict(item), "crossing_speed") for item in self.margins],
            "onsets": [_with_rpm(asdict(item), "speed") for item in self.onsets],
            "dofs": self.dofs,
            "discretisation": [asdict(piece) for piece in self.discretisation],
            "seconds": float(self.seconds.get("total", 0.0)),
            "seconds_by_step": {step: float(value) for step, value in self.seconds.items() if step != "total"},
            "left_out": list(self.left_out),
            "warnings": list(self.warnings),
            "method": self.method,
        }


def _with_rpm(values: dict[str, Any], key: str) -> dict[str, Any]:
    """The same with the speed under `key` in rpm, what is not finite as None."""
    speed = values.pop(key)
    values[f"{key}_rpm"] = speed * RPM
    return {name: (plain(np.array([v]))[0] if isinstance(v, float) else v) for name, v in values.items()}
