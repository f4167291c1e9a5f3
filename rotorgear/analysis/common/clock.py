"""Time taken by the steps of an analysis."""

from __future__ import annotations

import time


class Clock:
    """Seconds that went into each step."""

    def __init__(self) -> None:
        self.laps: dict[str, float] = {}
        self._last = time.perf_counter()

    def lap(self, name: str) -> None:
        """Add the time since the last lap to a step."""
        now = time.perf_counter()
        self.laps[name] = self.laps.get(name, 0.0) + now - self._last
        self._last = now

    def total(self) -> dict[str, float]:
        """Seconds by step, and their sum as "total"."""
        return {**self.laps, "total": sum(self.laps.values())}
