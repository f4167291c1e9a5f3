"""Result of a direct calculation of critical speeds, and of a map of them over support stiffness."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from rotorgear.model.model import Model
from rotorgear.results.campbell import RPM, ExcitationOrder
from rotorgear.results.modal import NodeTable, Piece
from rotorgear.results.plain import plain


@dataclass(frozen=True)
class CriticalSpeed:
    """A speed at which a line of excitation meets a mode.

    Attributes:
        line: its name. speed: of the input shaft in rad/s. frequency_hz: of the mode there, the damped one.
        damping_ratio: of the mode there; 0 in an undamped analysis. whirl: forward, backward, mixed, planar or "".
        participation, excited: as at a crossing of the Campbell diagram. description: what moves.
        residual: |w - p W| / (p W), with the eigenvalue of the system solved for again at that speed.
    """

    line: str
    speed: float
    frequency_hz: float
    damping_ratio: float
    whirl: str
    participation: float
    excited: bool
    description: str
    residual: float


@dataclass(frozen=True)
class CriticalResult:
    """c critical speeds, ascending.

    Attributes:
        model: the model; damped: whether damping and circulatory terms took part.
        top_speed: highest speed looked at in rad/s, negative for the other sense.
        lines: the lines; speeds: the critical speeds.
        shapes: (p, 6, c) complex, modal mass 1; nodes: where they are.
        dofs, discretisation, seconds, left_out, warnings, method: as in a modal result.
    """

    model: Model
    damped: bool
    top_speed: float
    lines: tuple[ExcitationOrder, ...]
    speeds: tuple[CriticalSpeed, ...]
    shapes: np.ndarray
    nodes: NodeTable
    dofs: int
    discretisation: tuple[Piece, ...]
    seconds: dict[str, float]
    left_out: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    method: str = ""

    def __len__(self) -> int:
        return len(self.speeds)

    @property
    def critical_speed_rpm(self) -> np.ndarray:
        """Speeds of the input shaft in rpm, (c,)."""
        return np.array([item.speed * RPM for item in self.speeds])

    @property
    def worst_residual(self) -> float:
        """Largest residual; 0 without critical speeds."""
        return max((item.residual for item in self.speeds), default=0.0)

    def to_dict(self) -> dict[str, Any]:
        """Everything but the shapes as plain values for JSON; the keys are documented in docs/json.md."""
        names = (
            "line",
            "frequency_hz",
            "damping_ratio",
            "whirl",
            "participation",
            "excited",
            "description",
            "residual",
        )
        return {
            "analysis": "critical",
            "title": self.model.title,
            "damped": self.damped,
            "top_speed_rpm": self.top_speed * RPM,
            "critical_speed_rpm": plain(self.critical_speed_rpm),
            **{name: [getattr(item, name) for item in self.speeds] for name in names},
            "lines": [asdict(line) for line in self.lines],
            "dofs": self.dofs,
            "discretisation": [asdict(piece) for piece in self.discretisation],
            "seconds": float(self.seconds.get("total", 0.0)),
            "seconds_by_step": {step: float(value) for step, value in self.seconds.items() if step != "total"},
            "left_out": list(self.left_out),
            "warnings": list(self.warnings),
            "method": self.method,
        }


@dataclass(frozen=True)
class CriticalMap:
    """Undamped critical speeds over one radial stiffness of all bearings.

    Attributes:
        model: the model. line: name of the line. stiffness: (k,) in N/m.
        forward, backward: (k, m) speeds of the input shaft in rad/s by sense of whirl, ascending, NaN beyond the last one;
            other: the same for modes that don't whirl (torsion, axial, planar).
        bearings: radial stiffness along x and y in N/m that the bearings of the model have, bearing -> (2,).
        top_speed: highest speed looked at in rad/s. dofs, seconds: of the largest problem, and of all.
    """

    model: Model
    line: str
    stiffness: np.ndarray
    forward: np.ndarray
    backward: np.ndarray
    other: np.ndarray
    bearings: dict[str, np.ndarray]
    top_speed: float
    dofs: int
    seconds: dict[str, float]

    def to_dict(self) -> dict[str, Any]:
        """Plain values for JSON."""
        return {
            "line": self.line,
            "stiffness_n_per_m": plain(self.stiffness),
            **{f"{kind}_rpm": plain(getattr(self, kind) * RPM) for kind in ("forward", "backward", "other")},
            "bearing_stiffness_n_per_m": {name: plain(values) for name, values in self.bearings.items()},
            "top_speed_rpm": self.top_speed * RPM,
            "dofs": self.dofs,
            "seconds": float(self.seconds.get("total", 0.0)),
        }
