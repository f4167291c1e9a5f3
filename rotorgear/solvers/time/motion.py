"""Prescribed rotation of the reference: speed over time, linear between given points, and the angle it sums up to."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rotorgear.errors import AnalysisError


@dataclass(frozen=True)
class Rotation:
    """Speeds (k,) in rad/s at times (k,) in s; constant before the first and after the last."""

    times: np.ndarray
    speeds: np.ndarray

    @staticmethod
    def constant(speed: float) -> Rotation:
        """Return the rotation at one speed."""
        return Rotation(np.zeros(1), np.array([float(speed)]))

    def __post_init__(self) -> None:
        if self.times.size == 0 or self.times.size != self.speeds.size or np.any(np.diff(self.times) <= 0.0):
            raise AnalysisError("the speed over time needs rising times, with one speed each")

    @property
    def is_constant(self) -> bool:
        """Whether the speed never changes."""
        return bool(np.all(self.speeds == self.speeds[0]))

    @property
    def accelerations(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Times in s and the accelerations in rad/s^2 that hold from them on; none where the speed never changes."""
        if self.is_constant:
            return (), ()
        steps = np.diff(self.speeds) / np.diff(self.times)
        return tuple(map(float, self.times)), (*map(float, steps), 0.0)

    @property
    def angles(self) -> np.ndarray:
        """Angle in rad at each of the times, with 0 at time 0."""
        steps = 0.5 * (self.speeds[1:] + self.speeds[:-1]) * np.diff(self.times)
        return self.speeds[0] * self.times[0] + np.concatenate([[0.0], np.cumsum(steps)])

    def speed(self, t: np.ndarray) -> np.ndarray:
        """Speed in rad/s at times (p,)."""
        return np.asarray(np.interp(t, self.times, self.speeds))

    def angle(self, t: np.ndarray) -> np.ndarray:
        """Angle in rad at times (p,)."""
        t = np.asarray(t, dtype=float)
        i = np.clip(np.searchsorted(self.times, t, side="right") - 1, 0, self.times.size - 1)
        late = t - self.times[i]
        mean = 0.5 * (self.speeds[i] + self.speed(t))
        return np.asarray(self.angles[i] + np.where(t < self.times[0], self.speeds[0], mean) * late)
