"""The statistics of a transient that its error is stated for, and whether both halves of its time give the same."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from rotorgear.analysis.transient.histories import Histories
from rotorgear.analysis.transient.request import Task
from rotorgear.results.transient import TransientResult
from rotorgear.solvers.time.statistics import STATISTICS, MotionStatistics, Statistics, compared, largest_relative

# Contact forces that move by less than this share of their size do not move: what is left is rounding.
_STILL = 1e-8
# Which statistics of both halves are compared: those of how far forces and flanks move. One impact makes a largest force.
_OF_HALVES = [STATISTICS.index(what) for what in ("rms force", "transmission error", "approach")]


@dataclass(frozen=True)
class Quantities:
    """Statistics by which runs are judged: names, values, sizes that errors are relative to, what counting leaves, (s,)."""

    name: tuple[str, ...]
    value: np.ndarray
    scale: np.ndarray
    counted: np.ndarray

    def errors(self, other: Quantities, factor: float) -> tuple[np.ndarray, float]:
        """Errors (s,) by a run that is worse by a factor, less 1, or better by as much; the largest relative to its scale."""
        errors = np.hypot(compared(self.value, other.value, self.scale, factor), self.counted)
        return errors, largest_relative(errors, self.scale)


def of_meshes(found: Histories, task: Task) -> MotionStatistics:
    """Statistics of the mesh contacts over all steps that count.

    Forces of steps are means, half a step away from the end of the time: where one rises until there, its last record counts.
    """
    local = task.local.local
    meshes = task.local.meshes
    columns = task.local.mesh_columns
    force = Statistics.of_steps(found.state.gathered).chosen(columns)
    last = found.table("F")[-1, columns]
    force = replace(force, least=np.minimum(force.least, last), largest=np.maximum(force.largest, last))
    moved = np.where(np.isfinite(found.state.extremes), found.state.extremes, np.nan)
    events = found.state.events[meshes] / (int(found.state.gathered.steps[0]) or np.nan)
    return MotionStatistics(
        force,
        events[:, :3],
        moved[local.m : local.m + local.watched_vectors.shape[1]],
        moved[columns] / task.local.transverse[:, None],
        events[:, 3],
    )


def of_channels(found: Histories, task: Task) -> Statistics:
    """Statistics of the channels over all steps that count."""
    all_of = Statistics.of_steps(found.state.gathered)
    return all_of.chosen(slice(all_of.mean.size - len(task.channels.names), None))


def quantities_of(found: Histories, task: Task) -> Quantities:
    """The statistics of each contact, and the root mean square of each channel."""
    meshes = of_meshes(found, task)
    labels = [task.local.parts[i].label for i in task.local.meshes]
    names = [f"{what} {label}" for label in labels for what in STATISTICS]
    force = meshes.force
    still = bool(labels) and bool(np.all(force.rms <= _STILL * np.hypot(force.mean, force.rms)))
    rms = of_channels(found, task).rms
    units = np.array(task.channels.units)
    # A channel that hardly moves is measured on the largest of its kind.
    kind = [np.inf if still else float(rms[units == unit].max()) for unit in units]
    return Quantities(
        (*names, *(f"rms {name}" for name in task.channels.names)),
        np.concatenate([meshes.values.ravel(), rms]),
        np.concatenate([meshes.scales.ravel(), kind]),
        np.concatenate([meshes.counted.ravel(), np.zeros(rms.size)]),
    )


def halves_differ(result: TransientResult) -> tuple[float, str]:
    """By how much, of its own size, a statistic of the records that count differs between their halves, and which does most."""
    counted = np.flatnonzero(result.counted)
    half = counted.size // 2

    def of(which: np.ndarray) -> MotionStatistics:
        force = result.mesh_force[which]
        moved = (result.transmission_error[which], result.approach[which])
        return MotionStatistics(
            Statistics(force.mean(axis=0), force.std(axis=0), force.min(axis=0), force.max(axis=0)),
            np.zeros((len(result.contact), 3)),
            *(np.column_stack([x.min(axis=0), x.max(axis=0)]) for x in moved),
        )

    first, second, whole = of(counted[:half]), of(counted[half:]), of(counted)
    change = np.abs(first.values - second.values) / np.where(whole.scales > 0.0, whole.scales, np.inf)
    change = change[:, _OF_HALVES]
    contact, what = np.unravel_index(change.argmax(), change.shape)
    return float(change.max()), f"{STATISTICS[_OF_HALVES[what]]} {result.contact[contact]}"
