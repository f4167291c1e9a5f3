"""Result of a frequency response analysis: receptances between places."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from rotorgear.model.model import Model
from rotorgear.results.modal import Piece

# What the receptance is multiplied with: a power of i w.
QUANTITIES = {"receptance": 0, "mobility": 1, "accelerance": 2}


@dataclass(frozen=True)
class FrequencyResponse:
    """Response of o places to unit forces (or moments) at i places, at f frequencies; Re(x e^{+iwt}).

    Attributes:
        model: the model; speed: of the reference shaft in rad/s.
        frequency_hz: (f,). inputs, outputs: the places, with their directions.
        receptance: (f, o, i) complex, displacement for a unit force: m/N, rad/N, m/(N m) or rad/(N m).
        damping_ratio: added to every elastic mode.
        residual: largest residual of the equations, relative to the forces inside.
        error_estimate: change on a finer mesh at the largest responses, relative to the largest; 0 without shaft elements.
    """

    model: Model
    speed: float
    frequency_hz: np.ndarray
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    receptance: np.ndarray
    damping_ratio: float
    residual: float
    error_estimate: float
    dofs: int
    discretisation: tuple[Piece, ...]
    seconds: dict[str, float]
    left_out: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    method: str = ""

    def of(self, quantity: str) -> np.ndarray:
        """Receptance, mobility or accelerance, (f, o, i)."""
        w = 2.0 * np.pi * self.frequency_hz
        return np.asarray(self.receptance * ((1j * w) ** QUANTITIES[quantity])[:, None, None])

    def peaks(self, output: int, entry: int, quantity: str = "receptance") -> list[tuple[float, float]]:
        """(Hz, size) of the local maxima of one response, largest first."""
        size = np.abs(self.of(quantity)[:, output, entry])
        inside = np.flatnonzero((size[1:-1] > size[:-2]) & (size[1:-1] >= size[2:])) + 1
        ranked = inside[np.argsort(-size[inside])]
        return [(float(self.frequency_hz[k]), float(size[k])) for k in ranked]

    def to_dict(self) -> dict[str, Any]:
        """Plain values for JSON; the keys are documented in docs/json.md."""
        return {
            "analysis": "frf",
            "title": self.model.title,
            "speed_rpm": self.speed * 30.0 / np.pi,
            "frequency_hz": self.frequency_hz.tolist(),
            "input": list(self.inputs),
            "output": list(self.outputs),
            "receptance_real": self.receptance.real.transpose(1, 2, 0).tolist(),
            "receptance_imag": self.receptance.imag.transpose(1, 2, 0).tolist(),
            "damping_ratio": self.damping_ratio,
            "residual": self.residual,
            "error_estimate": self.error_estimate,
            "dofs": self.dofs,
            "seconds": float(self.seconds.get("total", 0.0)),
            "left_out": list(self.left_out),
            "warnings": list(self.warnings),
            "method": self.method,
        }
