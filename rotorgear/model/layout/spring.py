"""What linear analyses take of a bearing, a support, a coupling or a nonlinear element: stiffness and damping over speed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.model.parts.supports import Bearing, Coupling, DampingMatrix, NonlinearElement, StiffnessMatrix, Support
from rotorgear.quantity import RPM_PER_RAD_S


@dataclass(frozen=True, eq=False)
class Spring:
    """Stiffness and damping among the six displacements of a node, constant or linear between rows over speed.

    Attributes:
        stiffness: (r, 6, 6) in N/m, N and N m/rad. damping: (r, 6, 6).
        speeds: (r,) of its shaft in rad/s, ascending sizes; empty where it is one pair for all speeds, r = 1.
    """

    stiffness: np.ndarray
    damping: np.ndarray
    speeds: np.ndarray

    def __post_init__(self) -> None:
        # A state is frozen, and so is what it holds: nobody writes through a view of these.
        for array in (self.stiffness, self.damping, self.speeds):
            array.flags.writeable = False

    @property
    def varies(self) -> bool:
        """Whether it is a table over speed."""
        return bool(self.speeds.size)

    def at(self, speed: float, part: str) -> tuple[np.ndarray, np.ndarray]:
        """Stiffness and damping (6, 6) at a speed of its shaft in rad/s; `part` is its address.

        Raises:
            AnalysisError: the speed lies outside the table.
        """
        if not self.varies:
            return self.stiffness[0], self.damping[0]
        speeds = self.speeds
        if not speeds[0] * (1.0 - 1e-12) <= speed <= speeds[-1] * (1.0 + 1e-12):
            rpm, first, last = (value * RPM_PER_RAD_S for value in (speed, speeds[0], speeds[-1]))
            raise AnalysisError(
                f"{part}: its shaft turns at {rpm:.6g} rpm, but its table covers {first:.6g} to "
                f"{last:.6g} rpm; ask for a speed inside (--speed) or add rows to the table"
            )
        right = int(np.clip(np.searchsorted(speeds, speed), 1, len(speeds) - 1))
        share = float(np.clip((speed - speeds[right - 1]) / (speeds[right] - speeds[right - 1]), 0.0, 1.0))
        return (
            (1.0 - share) * self.stiffness[right - 1] + share * self.stiffness[right],
            (1.0 - share) * self.damping[right - 1] + share * self.damping[right],
        )


def constant_spring(stiffness: np.ndarray, damping: np.ndarray) -> Spring:
    """A spring and a damper, (6, 6) each, that are the same at all speeds."""
    return Spring(np.array(stiffness)[None], np.array(damping)[None], np.zeros(0))


def given_spring(part: Bearing | Support | Coupling | NonlinearElement) -> Spring:
    """What the file gives of a part; nothing where it gives a law alone."""
    table = getattr(part, "table", ())
    if not table:
        return constant_spring(matrix_rows(part.stiffness), matrix_rows(part.damping))
    return Spring(
        np.array([matrix_rows(row.stiffness) for row in table]),
        np.array([matrix_rows(row.damping) for row in table]),
        np.array([row.speed for row in table]),
    )


def matrix_rows(matrix: StiffnessMatrix | DampingMatrix | None) -> np.ndarray:
    """A matrix of the file, (6, 6); zeros where it gives none."""
    return np.zeros((6, 6)) if matrix is None else np.array(matrix.as_rows())
