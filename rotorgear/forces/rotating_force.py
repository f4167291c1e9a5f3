"""A force or torque that turns with a shaft or oscillates: F = -A cos(p), p = order * angle + phase, A grows with speed^power.

As two components (x, y) it turns in the sense of its order: an unbalance u has A = u (order * speed)^2, power 2. Where the speed
changes, its mass m at the eccentricity e is accelerated along its path too; with w = order * speed and alpha = dw/dt the force
on the structure is, component by component,

    F_x = m e (w^2 cos p + alpha sin p),   F_y = m e (w^2 sin p - alpha cos p).

A force of a frequency f has p = order * angle + 2 pi f t + phase. The sign is that of a force on the structure, so the law, whose
force acts against the displacement, gives -A.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from rotorgear.forces.law import ForceLaw, Repeats, parameter, refuse
from rotorgear.solvers.batch.columns import FORCE_SHARE, OWN_LAW, PRESCRIBED, TABLE_ROWS, Column
from rotorgear.solvers.time.compiled import force_function, schedule_function

# Of the parameters; then the times from which an acceleration of the reference holds, and the accelerations.
AMPLITUDE, ORDER, PHASE, POWER, PLANE, FREQUENCY, COUNT, FIRST = range(8)


@schedule_function
def schedule(angle, speed, time, p, s):  # type: ignore[no-untyped-def]
    """Fill the components of the force."""
    phase = p[ORDER] * angle + 2.0 * np.pi * p[FREQUENCY] * time + p[PHASE]
    size = p[AMPLITUDE] * abs(p[ORDER] * speed) ** p[POWER] if p[POWER] > 0.0 else p[AMPLITUDE]
    s[0] = size * np.cos(phase)
    s[1] = size * np.sin(phase)
    count = int(p[COUNT])
    if count:
        alpha = 0.0
        for i in range(count):
            if time >= p[FIRST + i]:
                alpha = p[ORDER] * p[FIRST + count + i]
        s[0] += p[AMPLITUDE] * alpha * np.sin(phase)
        s[1] -= p[AMPLITUDE] * alpha * np.cos(phase)


@force_function
def force(p, s, d, v, F, Kd, Kv, energy):  # type: ignore[no-untyped-def]
    """Prescribed force, whatever d and v are."""
    Kd[:] = 0.0
    Kv[:] = 0.0
    energy[:] = 0.0
    for i in range(F.size):
        F[i] = -s[i]
        energy[1] += s[i] * v[i]


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
    frequency: float = parameter("Hz", "f, beside or in place of the order", 0.0, least=0.0)
    times: tuple[float, ...] = parameter("s", "from which the accelerations of the reference hold, of an unbalance", ())
    accelerations: tuple[float, ...] = parameter("rad/s^2", "of the reference, one for each of the times", ())

    def check(self) -> None:
        """Accelerations belong to an unbalance, one for each time."""
        if len(self.times) != len(self.accelerations) or (self.times and not (self.plane and self.power == 2.0)):
            raise refuse(self, "accelerations", "one for each time, and only of an unbalance (plane, power 2)")

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

    def parameters(self) -> np.ndarray:
        """Amplitude, order, phase, power, plane, frequency, and the accelerations over time."""
        own = [self.amplitude, self.order, self.phase, self.power, float(self.plane), self.frequency]
        return np.array([*own, len(self.times), *self.times, *self.accelerations])

    def mean(self) -> RotatingForce:
        """Nothing remains of it."""
        return RotatingForce(0.0, self.order, self.phase, self.power, self.plane)

    def repeats(self) -> tuple[Repeats, ...]:
        """Its order, where there is a force."""
        return (Repeats(abs(self.order)),) if self.amplitude and self.order else ()

    def unsettled(self) -> str:
        """A frequency that does not go with the speed."""
        if not (self.frequency and self.amplitude):
            return ""
        return (
            "sweeps don't take a load of a frequency in Hz, which has no common period with what turns; give it an order, or run "
            "single points by the transient analysis"
        )

    def columns(self, speed: float = 1.0) -> tuple[Column, ...]:
        """A prescribed force of the amplitude at that speed; with accelerations, which no sweep has, a law of its own."""
        if self.times:
            return (Column(OWN_LAW),) * self.components
        size = self.amplitude * abs(self.order * speed) ** self.power
        return (Column(PRESCRIBED, prescribed=size),) * self.components

    def table(self, angles: np.ndarray, states: np.ndarray, order: float) -> np.ndarray:
        """-cos p, and -sin p in a plane."""
        phase = self.order * angles + self.phase
        found = np.zeros((len(angles), self.components, TABLE_ROWS))
        for component, turning in enumerate((np.cos, np.sin)[: self.components]):
            found[:, component, FORCE_SHARE] = -turning(phase)
        return found

    def table_key(self) -> bytes:
        """Order and phase."""
        return repr([self.order, self.phase]).encode()

    @classmethod
    def examples(cls) -> tuple[RotatingForce, ...]:
        """A force, an unbalance, one that is accelerated, and a force of a frequency."""
        return (
            cls(100.0, 2.0, 0.4),
            cls(1e-3, 1.0, 0.1, 2.0, True),
            cls(1e-3, 1.0, 0.1, 2.0, True, times=(-1.0, 0.5), accelerations=(20.0, 0.0)),
            cls(100.0, 0.0, 0.4, frequency=30.0),
        )
