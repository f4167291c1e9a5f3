"""Statistics of contact forces, displacements and channels over all steps that count, without keeping the steps."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rotorgear.solvers.time.arguments import Gathered


def blank_gathered(values: np.ndarray) -> Gathered:
    """Statistics of nothing yet, of quantities with these values (g,) at the start."""
    size = values.size
    recent = np.ascontiguousarray(np.repeat(values[:, None], 3, axis=1), dtype=float)
    nothing = np.tile([np.inf, -np.inf], (size, 1))
    return Gathered(recent, np.zeros(size), np.zeros((size, 3)), nothing, np.zeros(1, dtype=np.int64))


@dataclass(frozen=True)
class StepStatistics:
    """Of g quantities: mean, root mean square about it, least, largest and mean of the negative part, (g,); NaN without steps."""

    mean: np.ndarray
    rms: np.ndarray
    least: np.ndarray
    largest: np.ndarray
    negative: np.ndarray
    steps: int

    @staticmethod
    def of(gathered: Gathered) -> StepStatistics:
        """Read what the compiled loops have summed up."""
        steps = int(gathered.steps[0])
        if not steps:
            nothing = np.full(gathered.level.size, np.nan)
            return StepStatistics(nothing, nothing, nothing, nothing, nothing, 0)
        about, square, negative = gathered.sums.T / steps
        rms = np.sqrt(np.maximum(square - about**2, 0.0))
        least, largest = gathered.extremes.T
        return StepStatistics(gathered.level + about, rms, least.copy(), largest.copy(), negative, steps)

    def chosen(self, which: np.ndarray | slice) -> StepStatistics:
        """Those of some quantities."""
        return StepStatistics(
            self.mean[which],
            self.rms[which],
            self.least[which],
            self.largest[which],
            self.negative[which],
            self.steps,
        )
