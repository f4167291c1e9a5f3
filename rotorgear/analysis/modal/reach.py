"""Which modes a refinement must watch: those that were asked for, and those above that may still fall among them.

Frequencies of a coarse mesh come from above. A mode that looks too high may belong among the lowest, or below the limit, once
the mesh follows it; so a few more modes are solved, and those whose frequency less twice its estimated error is still inside
are refined as well.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np


@dataclass(frozen=True)
class Reach:
    """What was asked for, and how far beyond it the solver looks.

    Attributes:
        modes: number of modes asked for; limit: |s| in rad/s up to which all are asked for. None is no such limit.
        spare: modes solved beyond the number; factor: how far beyond the limit.
    """

    modes: int | None
    limit: float | None
    spare: int = 4
    factor: float = 1.25

    def solver_request(self) -> tuple[int | None, float | None]:
        """Number of modes and limit for the solver."""
        return (
            None if self.modes is None else self.modes + self.spare,
            None if self.limit is None else self.limit * self.factor,
        )

    def inside(self, size: np.ndarray) -> int:
        """How many of the ascending |s| (m,) were asked for."""
        within = len(size) if self.limit is None else int(np.sum(size <= self.limit * (1.0 + 1e-9)))
        return within if self.modes is None else min(within, self.modes)

    def watched(self, size: np.ndarray, error: np.ndarray) -> np.ndarray:
        """Which modes (m,) are asked for or may still turn out to be; `error` is the estimated relative error of each."""
        inside = self.inside(size)
        edges = [] if self.limit is None else [self.limit]
        if self.modes is not None and inside == self.modes:
            edges.append(float(size[inside - 1]))
        edge = min(edges, default=np.inf)
        lowest = size * np.clip(1.0 - 2.0 * error, 0.0, 1.0)
        return (np.arange(len(size)) < inside) | (lowest < edge)

    def is_certain(self, size: np.ndarray, error: np.ndarray, complete: bool) -> bool:
        """Whether the search went far enough: all modes are found, or one of them is certain to lie beyond those asked for."""
        return complete or not bool(np.all(self.watched(size, error)))

    def further(self) -> Reach:
        """Look twice as far."""
        return replace(self, spare=2 * self.spare, factor=1.0 + 2.0 * (self.factor - 1.0))
