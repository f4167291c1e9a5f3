"""What every force law is: declared parameters, and compiled functions of relative displacements d and velocities v.

A law is a frozen dataclass; each field is declared by `parameter(unit, meaning)`. Its module names two compiled functions,
`schedule` and `force`, as solvers/time/local_forces.py describes them.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import MISSING, dataclass, field, fields
from typing import Any, ClassVar

import numpy as np

from rotorgear.errors import AnalysisError


def parameter(unit: str, meaning: str, default: Any = MISSING) -> Any:
    """Declare a parameter of a law: its SI unit, what it means, and its default."""
    about = {"unit": unit, "meaning": meaning}
    return field(metadata=about) if default is MISSING else field(default=default, metadata=about)


@dataclass(frozen=True)
class LawValue:
    """Force (k,), its tangents in d and v (k, k), stored energy, powers put in and dissipated, and the state of contact."""

    force: np.ndarray
    in_displacement: np.ndarray
    in_velocity: np.ndarray
    stored: float
    power_in: float
    dissipated: float
    contact: int


@dataclass(frozen=True)
class ForceLaw(ABC):
    """Base of all laws."""

    title: ClassVar[str]
    # Whether the force alone can't bring energy into the structure while nothing prescribed moves.
    passive: ClassVar[bool] = True

    @property
    def components(self) -> int:
        """Number k of relative displacements."""
        return 1

    @property
    def uses_velocity(self) -> bool:
        """Whether force or energy depend on the velocities v."""
        return True

    @abstractmethod
    def functions(self) -> tuple[Any, Any]:
        """Return the compiled functions schedule and force."""

    @abstractmethod
    def parameters(self) -> np.ndarray:
        """Return the parameters as the compiled functions read them."""

    def state_size(self) -> int:
        """Length of what the schedule fills."""
        return 0

    def reference_stiffness(self) -> np.ndarray:
        """Linear stiffness (k, k) about which a solver may expand."""
        return np.zeros((self.components, self.components))

    def reference_damping(self) -> np.ndarray:
        """Linear damping (k, k) about which a solver may expand."""
        return np.zeros((self.components, self.components))

    def mean(self) -> ForceLaw:
        """Return the law without anything that varies in time."""
        return self

    @classmethod
    @abstractmethod
    def examples(cls) -> tuple[ForceLaw, ...]:
        """Laws with sensible parameters, for the contract tests."""

    @classmethod
    def declared(cls) -> dict[str, tuple[str, str]]:
        """Name -> (unit, meaning) of every parameter."""
        return {item.name: (item.metadata["unit"], item.metadata["meaning"]) for item in fields(cls)}

    def evaluate(self, d: Any, v: Any = 0.0, *, time: float = 0.0, angle: float = 0.0, speed: float = 0.0) -> LawValue:
        """Return force and tangents at displacements d and velocities v (k,), a time, and angle and speed of the reference."""
        schedule, force = self.functions()
        k = self.components
        p = np.ascontiguousarray(self.parameters(), dtype=float)
        state = np.zeros(self.state_size())
        schedule(angle, speed, time, p, state)
        d, v = (np.ascontiguousarray(np.broadcast_to(np.asarray(x, float), k)).copy() for x in (d, v))
        F = np.zeros(k)
        Kd = np.zeros(k * k)
        Kv = np.zeros(k * k)
        energy = np.zeros(4)
        force(p, state, d, v, F, Kd, Kv, energy)
        stored, power_in, dissipated, contact = map(float, energy)
        return LawValue(F, Kd.reshape(k, k), Kv.reshape(k, k), stored, power_in, dissipated, int(contact))


def refuse(law: ForceLaw, name: str, expected: str) -> AnalysisError:
    """Return the error for a parameter out of its bounds."""
    return AnalysisError(f"{type(law).__name__}.{name}: got {getattr(law, name)!r}, expected {expected}")
