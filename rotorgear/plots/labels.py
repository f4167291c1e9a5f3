"""Places for labels that do not cover each other."""

from __future__ import annotations

import numpy as np

# Size of a short label, and distances at which it is tried, as shares of the axes.
_WIDTH = 0.046
_HEIGHT = 0.026
_TRIALS = tuple((r * np.cos(a), r * np.sin(a)) for r in (0.03, 0.045) for a in np.radians((60, 120, -60, -120, 0, 180)))


def spread(places: list[float], least: float) -> list[float]:
    """Places moved apart by the least amounts that keep their order and a distance of `least` between neighbours."""
    order = np.argsort(places, kind="stable")
    moved = np.array([places[k] for k in order], float)
    for _ in range(200):
        gaps = np.diff(moved)
        tight = np.flatnonzero(gaps < least * 0.999)
        if not tight.size:
            break
        for k in tight:
            push = 0.5 * (least - (moved[k + 1] - moved[k]))
            if push > 0.0:
                moved[k] -= push
                moved[k + 1] += push
    back = np.empty(len(moved))
    back[order] = moved
    return [float(value) for value in back]


class Labels:
    """Boxes taken so far in axes of given limits."""

    def __init__(self, x: tuple[float, float], y: tuple[float, float]) -> None:
        self._low = np.array([x[0], y[0]])
        self._span = np.array([x[1] - x[0], y[1] - y[0]])
        self._boxes: list[np.ndarray] = []
        self._points = np.zeros((0, 2))

    @property
    def count(self) -> int:
        """How many labels have a place."""
        return len(self._boxes)

    def block(self, points: np.ndarray) -> None:
        """Keep points (k, 2) in data units free."""
        self._points = (points - self._low) / self._span

    def place(self, x: float, y: float) -> tuple[float, float] | None:
        """Centre of a free box beside a point in data units, or None."""
        at = (np.array([x, y]) - self._low) / self._span
        for offset in _TRIALS:
            centre = at + offset
            if self._is_free(centre):
                self._boxes.append(centre)
                where = self._low + centre * self._span
                return float(where[0]), float(where[1])
        return None

    def _is_free(self, centre: np.ndarray) -> bool:
        size = np.array([_WIDTH, _HEIGHT])
        if np.any(centre - 0.5 * size < 0.0) or np.any(centre + 0.5 * size > 1.0):
            return False
        if np.any(np.all(np.abs(self._points - centre) < 0.5 * size, axis=1)):
            return False
        return not any(np.all(np.abs(box - centre) < size) for box in self._boxes)
