"""Spectral lines of a transient beside the lines that a rig has measured."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rotorgear.analysis.common.excitation import excitation_lines
from rotorgear.analysis.common.recorded import recorded
from rotorgear.results.comparison import ExcitationLine, RigLine
from rotorgear.results.spectrum import RigSpectrum, SpectralLines
from rotorgear.results.transient import TransientResult

TOLERANCE = 0.01


@recorded
def compare_spectrum(
    result: TransientResult, lines: SpectralLines, rig: Sequence[RigLine], tolerance: float = TOLERANCE
) -> RigSpectrum:
    """Put the nearest spectral line within a relative tolerance beside each rig line, and say why where there is none.

    Args:
        result: a transient.
        lines: lines in the spectrum of one of its histories, from `spectral_lines`.
        rig: lines of a rig.
        tolerance: largest |f_line / f_rig - 1|.

    Returns:
        One row a rig line.
    """
    excitations = excitation_lines(result.model, float(result.speed[-1]))
    near = []
    sources = []
    reasons = []
    for line in rig:
        error = np.abs(lines.frequency_hz / line.frequency_hz - 1.0)
        best = int(np.argmin(error)) if error.size else -1
        found = best >= 0 and error[best] <= tolerance
        near.append((lines.frequency_hz[best], lines.amplitude[best]) if found else (np.nan, np.nan))
        sources.append(lines.source[best] if found else "")
        reasons.append("" if found else _reason(line.frequency_hz, excitations, tolerance))
    f, a = np.array(near).T if near else np.zeros((2, 0))
    return RigSpectrum(
        lines.name,
        lines.unit,
        np.array([line.frequency_hz for line in rig]),
        tuple(line.label or "" for line in rig),
        f,
        a,
        tuple(sources),
        tuple(reasons),
        tolerance,
    )


def _reason(frequency: float, excitations: Sequence[ExcitationLine], tolerance: float) -> str:
    """Whether anything in the model shakes at a frequency."""
    orders = [(abs(e.frequency_hz / frequency - 1.0), e.name, e.frequency_hz) for e in excitations]
    if not orders:
        return "nothing turns"
    error, name, f = min(orders)
    if error <= tolerance:
        return f"{name} at {f:.2f} Hz is there, but too weak at this place, or not excited by the model"
    return f"no shaft or mesh order: the nearest is {name} at {f:.2f} Hz; a forced response has no line here"
