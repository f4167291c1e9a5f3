"""A force or torque that turns with a shaft or oscillates: F = -A cos(p), p = order * angle + phase, A grows with speed^power.

As two components (x, y) it turns in the sense of its order: an unbalance u has A = u speed^2, power 2. The sign is
that of a force on the structure, so the law, whose force acts against the displacement, gives -A.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from rotorgear.forces.law import ForceLaw, Repeats, parameter
from rotorgear.solvers.lanes.columns import PRESCRIBED, PUSH, TABLE_ROWS, Column
from rotorgear.solvers.time.compiled import force_function, schedule_function

AMPLITUDE, ORDER, PHASE, POWER, PLANE = range(5)  # of the parameters


@schedule_function
def schedule(angle, speed, time, p, s):  # type: ignore[no-untyped-def]
    """Fill the components of the force."""
    phase = p[ORDER] * angle + p[PHASE]
    size = p[AMPLITUDE] * abs(p[ORDER] * speed) ** p[POWER] if p[POWER] > 0.0 else p[AMPLITUDE]
    s[0] = size * np.cos(phase)
    s[1] = size * np.sin(phase)


@force_function
def force(p, s, d, v, F, Kd, Kv, energy):  # type: ignore[no-untyped-def]
    """Prescribed force, whatever d and v are."""
    energy[0] = 0.0
    energy[1] = 0.0
    energy[2] = 0.0
    energy[3] = 0.0
    for i in range(F.size):
        F[i] = -s[i]
        energy[1] += s[i] * v[i]
    for i in range(Kd.size):
        Kd[i] = 0.0
        Kv[i] = 0.0


@dataclass(frozen=True)
class RotatingForce(ForceLaw):
    """Rotating force in a plane, or an oscillating one along one direction."""

    title: ClassVar[str] = "rotating or oscillating force"
    passive: ClassVar[bool] = False

    amplitude: float = parameter("N, or kg m with power 2", "A at power 0; A = amplitude * (order * speed)^power")
    order: float = parameter("rad/rad", "turns for each turn of the reference", 1.0)
    phase: float = parameter("rad", "phase at angle 0", 0.0)
    power: float = parameter("", "2 for an unbalance, 0 for a given force", 0.0, least=0.0)
    plane: bool = parameter("", "two components, cosine and sine, in place of one", False)

    @property
    def components(self) -> int:
        """One, or two in a plane."""
        return 2 if self.plane else 1

    def functions(self) -> tuple[Any, Any]:
        """Return the compiled functions schedule and force."""
        return schedule, force

    def state_size(self) -> int:
        """Both components."""
        return 2

    def mean(self) -> RotatingForce:
        """Nothing remains of it."""
        return RotatingForce(0.0, self.order, self.phase, self.power, self.plane)

    def repeats(self) -> tuple[Repeats, ...]:
        """Its order, where there is a force."""
        return (Repeats(abs(self.order)),) if self.amplitude and self.order else ()

    def columns(self, speed: float = 1.0) -> tuple[Column, ...]:
        """A prescribed force of the amplitude at that speed."""
        size = self.amplitude * abs(self.order * speed) ** self.power
        return (Column(PRESCRIBED, push=size),) * self.components

    def table(self, angles: np.ndarray, states: np.ndarray, order: float) -> np.ndarray:
        """-cos p, and -sin p in a plane."""
        phase = self.order * angles + self.phase
        found = np.zeros((len(angles), self.components, TABLE_ROWS))
        for component, turning in enumerate((np.cos, np.sin)[: self.components]):
            found[:, component, PUSH] = -turning(phase)
        return found

    def table_key(self) -> bytes:
        """Order and phase."""
        return repr([self.order, self.phase]).encode()

    @classmethod
    def examples(cls) -> tuple[RotatingForce, ...]:
        """A force and an unbalance."""
        return (cls(100.0, 2.0, 0.4), cls(1e-3, 1.0, 0.1, 2.0, True))
