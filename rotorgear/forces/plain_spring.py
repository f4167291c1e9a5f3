"""Spring with cubic term, clearance and damper: F = k x + k3 x^3 + c d' with x = d beyond +-gap."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from rotorgear.forces.law import ForceLaw, parameter
from rotorgear.solvers.time.compiled import force_function
from rotorgear.solvers.time.kernel_contact import no_schedule

STIFFNESS, CUBIC, DAMPING, GAP = range(4)  # of the parameters


@force_function
def force(p, s, d, v, F, Kd, Kv, energy):  # type: ignore[no-untyped-def]
    """Elastic force beyond the clearance, damping everywhere."""
    k = p[STIFFNESS]
    k3 = p[CUBIC]
    c = p[DAMPING]
    side = 1.0 if d[0] >= p[GAP] else (-1.0 if d[0] <= -p[GAP] else 0.0)
    x = d[0] - side * p[GAP] if side != 0.0 else 0.0
    F[0] = k * x + k3 * x**3 + c * v[0]
    Kd[0] = (k + 3.0 * k3 * x * x) if side != 0.0 else 0.0
    Kv[0] = c
    energy[:] = 0.5 * k * x * x + 0.25 * k3 * x**4, 0.0, c * v[0] ** 2, side


@dataclass(frozen=True)
class PlainSpring(ForceLaw):
    """Spring with cubic term and clearance."""

    title: ClassVar[str] = "spring with cubic term and clearance"
    conserves: ClassVar[bool] = True

    stiffness: float = parameter("N/m", "k")
    cubic: float = parameter("N/m^3", "k3", 0.0)
    damping: float = parameter("N s/m", "c", 0.0, least=0.0)
    gap: float = parameter("m", "clearance to each side", 0.0, least=0.0)

    def functions(self) -> tuple[Any, Any]:
        """Return the compiled functions schedule and force."""
        return no_schedule, force

    def reference_stiffness(self) -> np.ndarray:
        """k."""
        return np.array([[self.stiffness]])

    def reference_damping(self) -> np.ndarray:
        """c."""
        return np.array([[self.damping]])

    @classmethod
    def examples(cls) -> tuple[PlainSpring, ...]:
        """With a cubic term, and with a clearance."""
        return (cls(2e7, 1e15, 300.0), cls(2e7, 0.0, 300.0, 1e-5))
