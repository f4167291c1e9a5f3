"""A torque that depends on speed, time and angle: drive or load of a machine.

    M = M0 s(t) [1 + a cos(order * angle + phase)] (|w|/w0)^power,   w = ratio * speed + v

power 2 is the propeller law, 0 a constant torque, -1 constant power. s(t) is a step from 1 to `step` between t1 and
t1 + rise (half a cosine), such as a turbine that is cut back. The law's force is -M, so that a positive torque drives in the
positive sense.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np

from rotorgear.forces.law import ForceLaw, Repeats, parameter
from rotorgear.solvers.batch.columns import FORCE_SHARE, OWN_LAW, PRESCRIBED, TABLE_ROWS, Column
from rotorgear.solvers.time.compiled import force_function, schedule_function

# Of the parameters, in the order of the fields; and of the state.
TORQUE, RATIO, POWER, REFERENCE, VISCOUS, RIPPLE, ORDER, PHASE, STEP, STEP_TIME, STEP_RISE = range(11)
TORQUE_NOW, SPEED = range(2)
# Of w0, below which a power law is held: constant power would ask for an infinite torque at rest.
_SLOWEST = 1e-3


@schedule_function
def schedule(angle, speed, time, p, s):  # type: ignore[no-untyped-def]
    """Fill the torque at nominal speed, and the nominal speed of the shaft."""
    torque = p[TORQUE] * (1.0 + p[RIPPLE] * np.cos(p[ORDER] * angle + p[PHASE]))
    if p[STEP] != 1.0:
        share = min(max((time - p[STEP_TIME]) / p[STEP_RISE], 0.0), 1.0)
        torque *= 1.0 + (p[STEP] - 1.0) * 0.5 * (1.0 - np.cos(np.pi * share))
    s[TORQUE_NOW] = torque
    s[SPEED] = p[RATIO] * speed


@force_function
def force(p, s, d, v, F, Kd, Kv, energy):  # type: ignore[no-untyped-def]
    """Torque and its slope over speed."""
    power = p[POWER]
    Kd[0] = 0.0
    Kv[0] = p[VISCOUS]
    torque = s[TORQUE_NOW]
    if power != 0.0:
        w = s[SPEED] + v[0]
        relative = max(abs(w) / p[REFERENCE], _SLOWEST)
        torque = s[TORQUE_NOW] * relative**power
        if relative > _SLOWEST:
            slope = -s[TORQUE_NOW] * power * relative ** (power - 1.0) / p[REFERENCE]
            Kv[0] += slope if w > 0.0 else -slope
    F[0] = -torque + p[VISCOUS] * v[0]
    energy[:] = 0.0, torque * v[0], p[VISCOUS] * v[0] * v[0], 0.0


@dataclass(frozen=True)
class TorqueCurve(ForceLaw):
    """Torque over speed, time and angle."""

    title: ClassVar[str] = "torque of a drive or load"
    passive: ClassVar[bool] = False

    torque: float = parameter("N m", "M0 at the reference speed, positive about +z")
    ratio: float = parameter("", "speed of the shaft over that of the reference", 1.0)
    power: float = parameter("", "2: propeller law, 0: constant torque, -1: constant power", 0.0)
    reference_speed: float = parameter("rad/s", "w0 of the shaft", 1.0, above=0.0)
    damping: float = parameter("N m s/rad", "torque against a change of speed, beside the curve", 0.0, least=0.0)
    ripple: float = parameter("", "a, share of M0", 0.0)
    order: float = parameter("rad/rad", "of the ripple, for each turn of the reference", 1.0)
    phase: float = parameter("rad", "of the ripple", 0.0)
    step: float = parameter("", "share of M0 that remains after the step", 1.0)
    step_time: float = parameter("s", "t1", 0.0)
    step_rise: float = parameter("s", "duration of the step", 1e-3, above=0.0)

    def functions(self) -> tuple[Any, Any]:
        """Return the compiled functions schedule and force."""
        return schedule, force

    def state_size(self) -> int:
        """Torque and nominal speed."""
        return 2

    def repeats(self) -> tuple[Repeats, ...]:
        """The ripple."""
        return (Repeats(abs(self.order)),) if self.ripple and self.order else ()

    def mean(self) -> TorqueCurve:
        """The curve over speed, without ripple and step."""
        return replace(self, ripple=0.0, step=1.0)

    def unsettled(self) -> str:
        """A step in time."""
        if self.step == 1.0:
            return ""
        return (
            "sweeps don't take a torque that steps at a time, which no settled motion shows; leave step_to out, or run "
            "single points by the transient analysis"
        )

    def columns(self, speed: float = 1.0) -> tuple[Column, ...]:
        """A prescribed torque where the speed does not matter, else a law of its own."""
        if self.power == 0.0 and self.damping == 0.0:
            return (Column(PRESCRIBED, prescribed=self.torque),)
        return (Column(OWN_LAW),)

    def table(self, angles: np.ndarray, states: np.ndarray, order: float) -> np.ndarray:
        """The torque over M0."""
        found = np.zeros((len(angles), 1, TABLE_ROWS))
        found[:, 0, FORCE_SHARE] = -states[:, TORQUE_NOW] / self.torque if self.torque else 0.0
        return found

    def table_key(self) -> bytes:
        """The ripple."""
        return repr([bool(self.torque), self.ripple, self.order, self.phase]).encode()

    @classmethod
    def examples(cls) -> tuple[TorqueCurve, ...]:
        """A propeller, and a ripple with a step."""
        return (
            cls(-800.0, 0.2, 2.0, 30.0),
            cls(500.0, ripple=0.1, order=3.0, step=0.4, step_time=0.0, step_rise=0.01, damping=2.0),
        )
