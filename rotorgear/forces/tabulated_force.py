"""A force that follows a table over time, or over the angle of a shaft: F = -x, linear between its places.

Over the angle it begins again with each turn; over time it stays at its first and last value. The sign is that of a force on the
structure, as of `rotating_force`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from rotorgear.forces.law import ForceLaw, Repeats, parameter, refuse
from rotorgear.forces.rotating_force import force
from rotorgear.solvers.batch.columns import FORCE_SHARE, PRESCRIBED, TABLE_ROWS, Column
from rotorgear.solvers.time.compiled import schedule_function

ORDER, OVER_ANGLE, COUNT, FIRST = range(4)  # of the parameters; then the places, then the values
_TURN = 2.0 * np.pi
# Harmonics of a table that matter, for the length of steps in sweeps.
_HARMONICS = 10


@schedule_function
def schedule(angle, speed, time, p, s):  # type: ignore[no-untyped-def]
    """Fill the value at this angle or time."""
    count = int(p[COUNT])
    at = time
    if p[OVER_ANGLE] > 0.0:
        at = p[ORDER] * angle
        at -= _TURN * np.floor(at / _TURN)
    values = FIRST + count
    first = p[FIRST]
    last = p[values - 1]
    if at < first or at >= last:
        ends = p[values + count - 1]
        if p[OVER_ANGLE] > 0.0:  # between the last place and the first one of the next turn
            late = at - last if at >= first else at + _TURN - last
            s[0] = ends + (p[values] - ends) * late / (first + _TURN - last)
        else:
            s[0] = p[values] if at < first else ends
        return
    low = np.searchsorted(p[FIRST:values], at, side="right") - 1
    share = (at - p[FIRST + low]) / (p[FIRST + low + 1] - p[FIRST + low])
    s[0] = p[values + low] + (p[values + low + 1] - p[values + low]) * share


@dataclass(frozen=True)
class TabulatedForce(ForceLaw):
    """Force along one direction from a table over time, or over the angle of a shaft."""

    title: ClassVar[str] = "force from a table"
    passive: ClassVar[bool] = False

    places: tuple[float, ...] = parameter("", "times in s, or angles from 0 to below 2 pi in rad, rising")
    values: tuple[float, ...] = parameter("", "force or torque there, in N or N m")
    over_angle: bool = parameter("", "whether the places are angles", False)
    order: float = parameter("rad/rad", "turns of the shaft for each turn of the reference", 1.0)
    average: float = parameter("", "what remains of it without what varies, in N or N m", 0.0)

    def check(self) -> None:
        """Rising places, each with a value."""
        if len(self.places) < 1 or np.any(np.diff(self.places) <= 0.0):
            raise refuse(self, "places", "at least one, rising")
        if len(self.values) != len(self.places):
            raise refuse(self, "values", "one for each place")
        if self.over_angle and not (self.places[0] >= 0.0 and self.places[-1] < _TURN):
            raise refuse(self, "places", "angles from 0 to below 2 pi")

    def functions(self) -> tuple[Any, Any]:
        """Return the compiled functions schedule and force."""
        return schedule, force

    def state_size(self) -> int:
        """The value."""
        return 1

    def parameters(self) -> np.ndarray:
        """Order, whether over angle, number of places, places, values."""
        return np.array([self.order, float(self.over_angle), len(self.places), *self.places, *self.values])

    def mean(self) -> TabulatedForce:
        """Its constant part."""
        return TabulatedForce((0.0,), (self.average,), average=self.average)

    def repeats(self) -> tuple[Repeats, ...]:
        """The turns of its shaft."""
        return (Repeats(abs(self.order), _HARMONICS),) if self.over_angle and self.order else ()

    def unsettled(self) -> str:
        """A force over time."""
        if self.over_angle or len(self.places) == 1:
            return ""
        return "sweeps don't take a force over time, which no settled motion shows; run single points by the transient analysis"

    def columns(self, speed: float = 1.0) -> tuple[Column, ...]:
        """A prescribed force."""
        return (Column(PRESCRIBED, prescribed=1.0),)

    def table(self, angles: np.ndarray, states: np.ndarray, order: float) -> np.ndarray:
        """The force."""
        found = np.zeros((len(angles), 1, TABLE_ROWS))
        found[:, 0, FORCE_SHARE] = -states[:, 0]
        return found

    def table_key(self) -> bytes:
        """All of it."""
        return repr([self.places, self.values, self.over_angle, self.order]).encode()

    @classmethod
    def examples(cls) -> tuple[TabulatedForce, ...]:
        """A force over angle, and one over time."""
        return (
            cls((0.0, 2.0, 5.0), (10.0, 40.0, -20.0), True, 1.5, 12.0),
            cls((0.0, 0.1, 0.4), (0.0, 100.0, 80.0)),
        )
