"""An order: all excitations of a gearbox that have one frequency."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from rotorgear.system.contacts import ContactLines

# Excitations of an order, which add up where several parts have one frequency.
_ADD_UP = ("unbalance", "error", "force", "couple", "applied")


@dataclass(frozen=True)
class Order:
    """Excitations of one frequency.

    Attributes:
        name: "shaft input 1x" or "mesh stage_1a, stage_1b 2x".
        ratio: frequency in rad/s over the size of the reference speed; fixed: what of it does not go with the speed, in rad/s.
        unbalance: force per square of the reference speed at the free dofs, and at those of rigid members, (b,).
        error: transmission error of each contact, (c,) m; force: F_0 times the stiffness variation, and impacts, (c,) N.
        applied: force at these dofs whatever the speed, (b,) or 0.
        couple: of loaded teeth that feel the tilt of their shafts, about the place of each contact along its face, (c,) N m.
        minor: whether it is one of the many small orders that loaded teeth need for their peak to peak only.
    """

    name: str
    ratio: float
    unbalance: np.ndarray
    error: np.ndarray
    force: np.ndarray
    couple: np.ndarray
    minor: bool = False
    applied: np.ndarray | float = 0.0
    fixed: float = 0.0

    def plus(self, other: Order) -> Order:
        """Both together; they have one frequency, or this one excites nothing."""
        sums = {name: getattr(self, name) + getattr(other, name) for name in _ADD_UP}
        minor = self.minor and other.minor
        return replace(self, ratio=self.ratio or other.ratio, fixed=other.fixed, minor=minor, **sums)

    def frequency_at(self, speed: float) -> float:
        """Frequency in rad/s at a reference speed in rad/s."""
        return self.ratio * abs(speed) + self.fixed

    def load(self, lines: ContactLines, speed: float) -> np.ndarray:
        """Force on these dofs, which the contacts are told on, at a reference speed in rad/s, (b,)."""
        w = self.frequency_at(speed)
        return np.asarray(
            speed**2 * self.unbalance
            + self.applied
            + lines.vectors @ (lines.forces(self.error[None], np.array([w]), speed)[0] - self.force)
            - lines.tilt @ self.couple
        )
