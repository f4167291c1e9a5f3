"""Result of a frequency response analysis: receptances between places."""

from __future__ import annotations

import numpy as np

from rotorgear.results.modal import Piece
from rotorgear.results.result import ModelResult
from rotorgear.results.schema import Written, of

# What the receptance is multiplied with: a power of i w.
QUANTITIES = {"receptance": 0, "mobility": 1, "accelerance": 2}


class FrequencyResponse(ModelResult, kind="frf"):
    """Response of o places to unit forces (or moments) at i places, at f frequencies; Re(x e^{+iwt})."""

    speed: float = of("speed of the input shaft", "rad/s", json="speed_rpm")
    frequency_hz: np.ndarray = of("frequency", "Hz", "frequency")
    inputs: tuple[str, ...] = of("where the unit forces or moments act", "", "input", json="input")
    outputs: tuple[str, ...] = of("where the response is read", "", "output", json="output")
    receptance: np.ndarray = of(
        "receptance: displacement over force",
        "m/N, rad/N, m/(N m) or rad/(N m)",
        "frequency",
        "output",
        "input",
        json=(
            Written(
                "receptance_real",
                lambda result, values: values.real.transpose(1, 2, 0),
                axes=("output", "input", "frequency"),
                note=", real part",
            ),
            Written(
                "receptance_imag",
                lambda result, values: values.imag.transpose(1, 2, 0),
                axes=("output", "input", "frequency"),
                note=", imaginary part; negative where the response lags",
            ),
        ),
    )
    damping_ratio: float = of("damping ratio", note=" added to every elastic mode")
    residual: float = of("residual", note=" of the equations, the largest, relative to the forces inside", form=".0e")
    error_estimate: float = of(
        "estimated relative discretisation error",
        note=": change on a finer mesh at the largest responses, relative to the largest; 0 without shaft elements",
        form=".0e",
    )
    discretisation: tuple[Piece, ...] = of("how each shaft segment was divided", "", "piece", record=Piece, json=None)

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
