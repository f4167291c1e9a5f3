"""The statistics of a transient that its error is stated for, and their comparison between two steps."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from rotorgear.analysis.transient.histories import Histories
from rotorgear.solvers.time.gathered import StepStatistics

# Contact forces that move by less than this share of their size do not move: what is left is rounding.
_STILL = 1e-8
# Roache's margin, for where sides meet and part and impacts begin and end an order holds in the mean only.
# J. Fluids Eng. 116 (1994) 405.
_MARGIN = 1.25


def gain(ratio: float) -> float:
    """By how much a step that is smaller by a ratio is better, less 1, with second order, and with a margin."""
    return (ratio**2 - 1.0) / _MARGIN


_TWICE = gain(2.0)


@dataclass(frozen=True)
class Statistics:
    """Names, values (s,), and the size (s,) that an error is taken relative to."""

    name: tuple[str, ...]
    value: np.ndarray
    scale: np.ndarray


def of_forces(found: Histories, task: Any) -> StepStatistics:
    """Statistics of the mesh contacts' forces over all steps that count.

    Forces of steps are means, half a step away from the end of the time: where one rises until there, its last record counts.
    """
    columns = [int(task.local.local.forces.first[i]) for i, part in enumerate(task.local.parts) if part.is_mesh]
    steps = StepStatistics.of(found.state.gathered).chosen(np.array(columns, dtype=int))
    if not steps.steps:
        return steps
    last = found.table("F")[-1, columns]
    return replace(steps, least=np.minimum(steps.least, last), largest=np.maximum(steps.largest, last))


def of_channels(found: Histories, task: Any) -> StepStatistics:
    """Statistics of the channels over all steps that count."""
    all_of = StepStatistics.of(found.state.gathered)
    return all_of.chosen(slice(all_of.mean.size - len(task.channels.names), None))


def statistics(found: Histories, task: Any) -> Statistics:
    """Mean, root mean square about it and largest of each contact force, and root mean square of each channel."""
    force = of_forces(found, task)
    labels = [part.label for part in task.local.parts if part.is_mesh]
    names = [f"{what} force {label}" for label in labels for what in ("mean", "rms", "largest")]
    data = np.column_stack([force.mean, force.rms, force.largest]).ravel().tolist()
    size = np.sqrt(force.mean**2 + force.rms**2)
    # A largest force is as large as it is: of impacts that last a thousandth of a period, many times the root mean square.
    scale = np.column_stack([size, size, np.maximum(size, np.abs(force.largest))]).ravel().tolist()
    still = bool(data) and all(data[i + 1] <= _STILL * scale[i] for i in range(0, len(data), 3))
    rms = of_channels(found, task).rms
    units = np.array(task.channels.units)
    for i, name in enumerate(task.channels.names):
        names.append(f"rms {name}")
        data.append(float(rms[i]))
        # A channel that hardly moves is measured on the largest of its kind.
        scale.append(np.inf if still else float(rms[units == units[i]].max()))
    return Statistics(tuple(names), np.array(data), np.array(scale))


def compared(fine: Statistics, coarse: Statistics, factor: float = _TWICE) -> tuple[np.ndarray, float]:
    """Errors (s,) of the better of two runs, and the largest of them relative to its scale.

    `factor`: by how much the better one is better, less 1.
    """
    errors = np.abs(fine.value - coarse.value) / factor
    known = ~(fine.scale <= 0.0)
    relative = errors[known] / fine.scale[known]
    # The error of one statistic may pass through zero between two steps; that half of all are as good says nothing of it.
    typical = float(np.median(relative)) if relative.size and np.all(np.isfinite(relative)) else 0.0
    errors = np.maximum(errors, typical * np.where(known & np.isfinite(fine.scale), fine.scale, 0.0))
    return errors, float(relative.max(initial=0.0)) if np.all(np.isfinite(relative)) else float("inf")
