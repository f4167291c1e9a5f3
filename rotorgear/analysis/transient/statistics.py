"""The statistics of a transient that its error is stated for, and their comparison between two steps."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from rotorgear.analysis.transient.histories import Histories

# Contact forces that move by less than this share of their size do not move: what is left is rounding.
_STILL = 1e-8


@dataclass(frozen=True)
class Statistics:
    """Names, values (s,), and the size (s,) that an error is taken relative to."""

    name: tuple[str, ...]
    value: np.ndarray
    scale: np.ndarray


def statistics(found: Histories, task: Any, settled: int) -> Statistics:
    """Mean, root mean square about it and largest of each contact force, and root mean square of each channel."""
    t = found.table("t")
    counted = slice(settled, None) if t.size > settled else slice(None)
    F = found.table("F")[counted]
    values = found.table("values")[counted]
    names: list[str] = []
    data: list[float] = []
    scale: list[float] = []
    first = task.local.local.forces.first
    for i, part in enumerate(task.local.parts):
        if not part.is_mesh:
            continue
        force = F[:, first[i]]
        level = float(np.sqrt(np.mean(force**2)))
        for what, value in (("mean", force.mean()), ("rms", force.std()), ("largest", force.max())):
            names.append(f"{what} force {part.label}")
            data.append(float(value))
            scale.append(level)
    still = bool(data) and all(data[i + 1] <= _STILL * scale[i] for i in range(0, len(data), 3))
    rms = values.std(axis=0) if values.shape[1] else np.zeros(0)
    units = np.array(task.channels.units)
    for i, name in enumerate(task.channels.names):
        names.append(f"rms {name}")
        data.append(float(rms[i]))
        # A channel that hardly moves is measured on the largest of its kind.
        scale.append(np.inf if still else float(rms[units == units[i]].max()))
    return Statistics(tuple(names), np.array(data), np.array(scale))


def compared(fine: Statistics, coarse: Statistics, factor: float = 3.0) -> tuple[np.ndarray, float]:
    """Errors (s,) of the better of two runs, and the largest of them relative to its scale.

    `factor`: by how much the better one is better, less 1; 3 for a step ratio of 2 and order 2.
    """
    errors = np.abs(fine.value - coarse.value) / factor
    known = fine.scale > 0.0
    relative = errors[known] / fine.scale[known]
    return errors, float(relative.max(initial=0.0)) if np.all(np.isfinite(relative)) else float("inf")
