"""The statistics of a transient that its error is stated for, and whether both halves of its time give the same."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from rotorgear.analysis.transient.histories import Histories
from rotorgear.analysis.transient.request import Task
from rotorgear.results.transient import TransientResult, is_shown
from rotorgear.solvers.time.statistics import (
    STATISTICS,
    WINDOWS,
    MotionStatistics,
    Statistics,
    compared,
    largest_relative,
)

# Contact forces that move by less than this share of their size do not move: what is left is rounding.
_STILL = 1e-8
# A channel that moves by less than this share of the largest of its kind is measured on that share.
_SMALL = 0.01
# What is stated of a channel.
_OF_CHANNELS = ("mean", "rms", "largest", "smallest")
# The fewest records in a window, and how many records are made of them.
_LEAST = 64
_DRAWS = 200
# Which statistics of both halves are compared: those of how far forces and flanks move. One impact makes a largest force.
_OF_HALVES = [STATISTICS.index(what) for what in ("rms force", "transmission error", "approach")]


@dataclass(frozen=True)
class Quantities:
    """Statistics by which runs are judged: names, values, sizes that errors are relative to, whether a table shows them, (s,)."""

    name: tuple[str, ...]
    value: np.ndarray
    scale: np.ndarray
    shown: np.ndarray

    def errors(self, other: Quantities, factor: float) -> tuple[np.ndarray, float]:
        """Errors (s,) by a run that is worse by a factor, less 1, or better by as much; the largest one shown, relative."""
        errors = compared(self.value, other.value, self.scale, factor)
        return errors, self.largest(errors)

    def largest(self, errors: np.ndarray) -> float:
        """The largest of errors (s,) of what is shown, relative to its scale."""
        return largest_relative(errors[self.shown], self.scale[self.shown])


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
    events = found.state.events[meshes, :3] / (int(found.state.gathered.steps[0]) or np.nan)
    return MotionStatistics(
        force,
        # What touches for less than a step may count less than nothing.
        np.maximum(events, 0.0),
        moved[local.m : local.m + local.watched_vectors.shape[1]],
        moved[columns] / task.local.transverse[:, None],
    )


def of_channels(found: Histories, task: Task) -> Statistics:
    """Statistics of the channels over all steps that count."""
    all_of = Statistics.of_steps(found.state.gathered)
    return all_of.chosen(slice(all_of.mean.size - len(task.channels.names), None)).about(task.channels.constant)


def quantities_of(found: Histories, task: Task) -> Quantities:
    """The statistics of each contact and of each channel."""
    meshes = of_meshes(found, task)
    labels = [task.local.parts[i].label for i in task.local.meshes]
    names = [f"{what} {label}" for label in labels for what in STATISTICS]
    names += [f"{what} {name}" for name in task.channels.names for what in _OF_CHANNELS]
    force = meshes.force
    still = bool(labels) and bool(np.all(force.rms <= _STILL * np.hypot(force.mean, force.rms)))
    seen = of_channels(found, task)
    scales = _channel_scales(seen, task.channels.units)
    values = _of_each(seen)
    return Quantities(
        tuple(names),
        np.concatenate([meshes.values.ravel(), values.ravel()]),
        np.concatenate([meshes.scales.ravel(), np.where(still, np.inf, scales).ravel()]),
        np.array([is_shown(name) for name in names]),
    )


def _of_each(seen: Statistics) -> np.ndarray:
    """`_OF_CHANNELS`, (p, 4)."""
    return np.column_stack([seen.mean, seen.rms, seen.largest, seen.least])


def _channel_scales(seen: Statistics, units: tuple[str, ...]) -> np.ndarray:
    """The size of each statistic of the channels, (p, 4), no less than a share of the largest of its unit."""
    kinds = np.array(units)
    size = np.hypot(seen.mean, seen.rms)

    def least(of: np.ndarray) -> np.ndarray:
        return np.array([_SMALL * of[kinds == unit].max() for unit in units])

    size = np.maximum(size, least(size)) if units else size
    rms = np.maximum(seen.rms, least(seen.rms)) if units else seen.rms
    ends = [np.maximum(size, np.abs(end)) for end in (seen.largest, seen.least)]
    return np.column_stack([size, rms, *ends])


def resampled(runs: Sequence[Histories], task: Task) -> np.ndarray | None:
    """Statistics of records as long as those of some runs, made of their windows drawn with replacement, (draws, s).

    None where the records that count are too few. B. Efron, Ann. Stat. 7 (1979) 1; by windows, for records in a row are alike.
    """
    columns = task.local.mesh_columns
    forces: list[Statistics] = []
    channels: list[Statistics] = []
    watched: list[Statistics] = []
    approach: list[Statistics] = []
    shares: list[np.ndarray] = []
    for run in runs:
        t = run.table("t")
        counted = np.flatnonzero(t > t[-1] - int(run.state.gathered.steps[0]) * run.h * (1.0 - 1e-9))
        long = counted.size // WINDOWS
        if long < _LEAST:
            continue
        which = counted[-WINDOWS * long :].reshape(WINDOWS, long)
        F = run.table("F")[:, columns]
        d = run.table("d")[:, columns] / task.local.transverse
        tables = (F, run.table("values"), run.table("watched"), d)
        for of_windows, x in zip((forces, channels, watched, approach), tables, strict=True):
            of_windows += [_of_records(x[one]) for one in which]
        shares += [np.column_stack([np.mean(side, axis=0) for side in (f > 0.0, f == 0.0, f < 0.0)]) for f in F[which]]
    if not forces:
        return None
    rows = []
    for drawn in np.random.default_rng(1).integers(0, len(forces), (_DRAWS, WINDOWS)):
        moved = [np.column_stack([x.least, x.largest]) for x in (_joined(watched, drawn), _joined(approach, drawn))]
        share = np.mean([shares[i] for i in drawn], axis=0)
        contacts = MotionStatistics(_joined(forces, drawn), share, *moved)
        rows.append(np.concatenate([contacts.values.ravel(), _of_each(_joined(channels, drawn)).ravel()]))
    return np.array(rows)


def _joined(windows: list[Statistics], drawn: np.ndarray) -> Statistics:
    """Statistics of windows of one length in a row; least and largest values are those of a quarter of them.

    The largest of a longer record scatters no more, while records made of the same windows mostly share the highest one.
    """
    mean, rms, least, largest = (
        np.array([getattr(windows[i], name) for i in drawn]) for name in ("mean", "rms", "least", "largest")
    )
    whole = mean.mean(axis=0)
    rms = np.sqrt(np.mean(rms**2 + (mean - whole) ** 2, axis=0))
    few = len(drawn) // 4
    return Statistics(whole, rms, least[:few].min(axis=0), largest[:few].max(axis=0))


def _of_records(x: np.ndarray) -> Statistics:
    """Statistics of values at records (r, g)."""
    return Statistics(x.mean(axis=0), x.std(axis=0), x.min(axis=0), x.max(axis=0))


def halves_differ(result: TransientResult) -> tuple[float, str]:
    """By how much, of its own size, a statistic of the records that count differs between their halves, and which does most."""
    counted = np.flatnonzero(result.counted)
    half = counted.size // 2

    def of(which: np.ndarray) -> MotionStatistics:
        force = result.mesh_force[which]
        moved = (result.transmission_error[which], result.approach[which])
        return MotionStatistics(
            _of_records(force),
            np.zeros((len(result.contact), 3)),
            *(np.column_stack([x.min(axis=0), x.max(axis=0)]) for x in moved),
        )

    first, second, whole = of(counted[:half]), of(counted[half:]), of(counted)
    change = np.abs(first.values - second.values) / np.where(whole.scales > 0.0, whole.scales, np.inf)
    change = change[:, _OF_HALVES]
    contact, what = np.unravel_index(change.argmax(), change.shape)
    return float(change.max()), f"{STATISTICS[_OF_HALVES[what]]} {result.contact[contact]}"
