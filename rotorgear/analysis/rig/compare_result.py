"""The verb behind `rotorgear compare`: the modes of a model, or of a result, beside the lines of a test rig."""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from rotorgear.analysis.common.excitation import excitation_lines
from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.modal.modal import modal
from rotorgear.analysis.rig.compare import compare_lines
from rotorgear.analysis.rig.rig_file import read_rig_lines
from rotorgear.errors import AnalysisError
from rotorgear.model.model import Model
from rotorgear.old_names import warn_old
from rotorgear.progress import Progress, silent
from rotorgear.results.comparison import Comparison, RigLine
from rotorgear.results.modal import ModalResult

# Modes of a model are found up to this much above the highest line of the rig, so that every line meets all its candidates.
ABOVE_RIG = 1.15


def rig_lines_of(rig: str | Path | Sequence[RigLine | float]) -> tuple[RigLine, ...]:
    """The lines of a rig from a file (CSV), from lines, or from plain frequencies in Hz.

    Raises:
        AnalysisError: no lines at all. ModelError: the file can't be read, or holds mistakes.
    """
    if isinstance(rig, str | Path):
        return read_rig_lines(rig)
    lines = tuple(line if isinstance(line, RigLine) else RigLine(float(line)) for line in rig)
    if not lines:
        raise AnalysisError("there are no rig lines to compare with: give at least one measured frequency")
    return lines


def _understanding_lists(verb: Callable[..., Comparison]) -> Callable[..., Comparison]:
    """The call of version 0.1, compare(frequencies, descriptions, lines), is understood for one version more."""

    @functools.wraps(verb)
    def call(source: Any, *args: Any, **kwargs: Any) -> Comparison:
        if isinstance(source, Model | ModalResult):
            return verb(source, *args, **kwargs)
        warn_old("the call", "compare(frequency_hz, descriptions, rig_lines)", "compare(result, rig)")
        return compare_lines(source, *args, **kwargs)

    return call


@_understanding_lists
@recorded
def compare(
    source: Model | ModalResult,
    rig: str | Path | Sequence[RigLine | float],
    *,
    tolerance: float = 0.05,
    speed: float | str | None = None,
    accuracy: float | None = None,
    elements: int | None = None,
    known_to_hz: float | None = None,
    excitation_tolerance: float = 0.005,
    band: tuple[float, float] | None = None,
    seed: int = 0,
    samples: int = 2000,
    progress: Progress = silent,
) -> Comparison:
    """Assign the lines of a rig to modes and say what the agreement is worth.

    Lines of excitation are those at the speed of the analysis, else at the operating point.

    Args:
        source: modes of a model, or a model, whose modes are then found up to 1.15 times the highest line.
        rig: measured frequencies (CSV); in Python also lines, or plain frequencies in Hz.
        tolerance: largest relative difference |f_mode / f_rig - 1| of a match.
        speed: as in `modal`; a saved result has its own.
        accuracy: as in `modal`; a saved result has its own.
        elements: as in `modal`; a saved result has its own.
        known_to_hz: frequency up to which a result has all modes, where that is above its last one.
        excitation_tolerance: relative distance within which an order of a shaft or a mesh coincides with a line or a mode.
        band: frequency range in Hz that the rig looked at, for the chance of a match (default: from the lowest to the highest
            line, widened by the tolerance at both ends).
        seed: seed of the random lists that chance is found from.
        samples: number of random lists that chance is found from.
        progress: callable that is told fraction and step.

    Returns:
        Matches, lines and modes without a partner, and what chance alone would give.

    Raises:
        AnalysisError: no lines, the same line twice, settings that make no sense, or settings of a model beside a result.
        ModelError: a rig file that can't be read.
    """
    lines = rig_lines_of(rig)
    if isinstance(source, Model):
        known_to_hz = ABOVE_RIG * max(line.frequency_hz for line in lines)
        result = modal(source, speed=speed, fmax=known_to_hz, accuracy=accuracy, elements=elements, progress=progress)
    elif speed is not None or accuracy is not None or elements is not None:
        raise AnalysisError("--speed, --accuracy and --elements belong to a model; a result has its own")
    else:
        result = source
    operation = result.model.operation
    turning = result.speed if result.speed is not None else (operation.speed if operation else None)
    return compare_lines(
        result.frequency_hz,
        result.description,
        lines,
        rigid=result.rigid,
        # At standstill without damping a ratio of 0 is no statement about the damping.
        damping_ratio=result.damping_ratio if result.speed is not None else None,
        strain_energy=result.strain_energy,
        excitations=excitation_lines(result.model, turning) if turning else (),
        tolerance=tolerance,
        excitation_tolerance=excitation_tolerance,
        band=band,
        known_to_hz=known_to_hz,
        seed=seed,
        samples=samples,
    )
