"""A torque that depends on speed, time and angle: drive or load of a machine.

    M = M0 s(t) [1 + a cos(order * angle + phase)] (|w|/w0)^power,   w = ratio * speed + v

power 2 is the propeller law, 0 a constant torque, -1 constant power. s(t) is a step from 1 to `step` between t1 and t1
+ rise (half a cosine): a
turbine that is cut back. The law's force is -M, so that a positive torque drives in the positive sense.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from rotorgear.forces.law import ForceLaw, parameter, refuse
from rotorgear.solvers.time.compiled import force_function, schedule_function

_SLOWEST = 1e-3  # of w0, below which a power law is held


@schedule_function
def schedule(angle, speed, time, p, s):  # type: ignore[no-untyped-def]
    """Fill the torque at nominal speed, and the nominal speed of the shaft."""
    size = p[0] * (1.0 + p[5] * np.cos(p[6] * angle + p[7]))
    if p[8] != 1.0:
        share = (time - p[9]) / p[10]
        share = min(max(share, 0.0), 1.0)
        size *= 1.0 + (p[8] - 1.0) * 0.5 * (1.0 - np.cos(3.141592653589793 * share))
    s[0] = size
    s[1] = p[1] * speed


@force_function
def force(p, s, d, v, F, Kd, Kv, energy):  # type: ignore[no-untyped-def]
    """Torque and its slope over speed."""
    power = p[2]
    reference = p[3]
    viscous = p[4]
    Kd[0] = 0.0
    Kv[0] = 0.0
    torque = s[0]
    if power != 0.0:
        w = s[1] + v[0]
        size = max(abs(w) / reference, 1e-3)
        torque = s[0] * size**power
        if abs(w) / reference > 1e-3:
            Kv[0] = -s[0] * power * size ** (power - 1.0) / reference * (1.0 if w > 0.0 else -1.0)
    F[0] = -torque + viscous * v[0]
    Kv[0] += viscous
    energy[0] = 0.0
    energy[1] = torque * v[0]
    energy[2] = viscous * v[0] * v[0]
    energy[3] = 0.0


@dataclass(frozen=True)
class TorqueCurve(ForceLaw):
    """Torque over speed, time and angle."""

    title: ClassVar[str] = "torque of a drive or load"
    passive: ClassVar[bool] = False

    torque: float = parameter("N m", "M0 at the reference speed, positive about +z")
    ratio: float = parameter("", "speed of the shaft over that of the reference", 1.0)
    power: float = parameter("", "2: propeller law, 0: constant torque, -1: constant power", 0.0)
    reference_speed: float = parameter("rad/s", "w0 of the shaft", 1.0)
    damping: float = parameter("N m s/rad", "torque against a change of speed, beside the curve", 0.0)
    ripple: float = parameter("", "a, share of M0", 0.0)
    order: float = parameter("rad/rad", "of the ripple, for each turn of the reference", 1.0)
    phase: float = parameter("rad", "of the ripple", 0.0)
    step: float = parameter("", "share of M0 that remains after the step", 1.0)
    step_time: float = parameter("s", "t1", 0.0)
    step_rise: float = parameter("s", "duration of the step", 1e-3)

    def __post_init__(self) -> None:
        if not (self.reference_speed > 0.0 and self.step_rise > 0.0):
            raise refuse(self, "reference_speed" if self.reference_speed <= 0.0 else "step_rise", "a positive number")

    def functions(self) -> tuple[Any, Any]:
        """Return the compiled functions schedule and force."""
        return schedule, force

    def state_size(self) -> int:
        """Torque and nominal speed."""
        return 2

    def parameters(self) -> np.ndarray:
        """In the order of the formula."""
        return np.array(
            [
                self.torque,
                self.ratio,
                self.power,
                self.reference_speed,
                self.damping,
                self.ripple,
                self.order,
                self.phase,
                self.step,
                self.step_time,
                self.step_rise,
            ]
        )

    @classmethod
    def examples(cls) -> tuple[TorqueCurve, ...]:
        """A propeller, and a ripple with a step."""
        return (
            cls(-800.0, 0.2, 2.0, 30.0),
            cls(500.0, ripple=0.1, order=3.0, step=0.4, step_time=0.0, step_rise=0.01, damping=2.0),
        )
