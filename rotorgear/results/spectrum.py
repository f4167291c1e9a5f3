"""Spectra: amplitudes over frequency, and their lines."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np


@dataclass(frozen=True)
class Spectrum:
    """One-sided amplitude spectrum: a sine of amplitude A shows a peak of height A.

    `frequency` (f,) in Hz, or orders of the reference shaft; `amplitude` (f,) in the history's unit; `resolution` the
    distance of two lines that are just told apart.
    """

    name: str
    unit: str
    frequency: np.ndarray
    amplitude: np.ndarray
    window: str
    resolution: float
    over: str = "Hz"


@dataclass(frozen=True)
class SpectralLines:
    """The strongest lines of a spectrum, by frequency; `source` says which shaft or mesh order a line belongs to, else ""."""

    name: str
    unit: str
    frequency_hz: np.ndarray
    amplitude: np.ndarray
    source: tuple[str, ...]
    window: str
    resolution_hz: float

    def to_dict(self) -> dict[str, Any]:
        """Plain values for JSON."""
        return {
            "history": self.name,
            "unit": self.unit,
            "window": self.window,
            "resolution_hz": self.resolution_hz,
            "lines": [
                {"frequency_hz": float(f), "amplitude": float(a), "source": what}
                for f, a, what in zip(self.frequency_hz, self.amplitude, self.source, strict=True)
            ],
        }


@dataclass(frozen=True)
class RigSpectrum:
    """Spectral lines beside the lines of a rig.

    For each of the k rig lines: its frequency in Hz and label, the nearest spectral line (frequency and amplitude, NaN where
    none lies within the tolerance), its source, and in words why none is there.
    """

    name: str
    unit: str
    rig_hz: np.ndarray
    label: tuple[str, ...]
    frequency_hz: np.ndarray
    amplitude: np.ndarray
    source: tuple[str, ...]
    reason: tuple[str, ...]
    tolerance: float

    def to_dict(self) -> dict[str, Any]:
        """Plain values for JSON."""

        def number(value: float) -> float | None:
            return float(value) if np.isfinite(value) else None

        rows = zip(self.rig_hz, self.label, self.frequency_hz, self.amplitude, self.source, self.reason, strict=True)
        return {
            "tolerance": self.tolerance,
            "lines": [
                {
                    "rig_hz": float(rig),
                    "label": label,
                    "frequency_hz": number(f),
                    "amplitude": number(a),
                    "source": source,
                    "reason": reason,
                }
                for rig, label, f, a, source, reason in rows
            ],
        }
