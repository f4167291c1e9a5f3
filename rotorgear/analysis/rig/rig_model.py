"""The modes of a model with free numbers, as an update asks for them again and again: one mesh, all modes below one frequency."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from rotorgear.analysis.common.points import point_rows
from rotorgear.analysis.modal.modes import Wanted
from rotorgear.analysis.modal.solve import solve
from rotorgear.analysis.rig.sensitivity import changes_of, frequency_derivatives, shape_derivatives, system_of
from rotorgear.model.free_numbers import FreeNumbers
from rotorgear.system.plan import Plan
from rotorgear.system.system import System


@dataclass(frozen=True)
class RigModes:
    """Elastic modes at one set of numbers: w^2 (m,), shapes X (n, m) with modal mass 1, and their values at s points (m, s)."""

    system: System
    eigenvalues: NDArray[np.float64]
    vectors: NDArray[np.float64]
    at_points: NDArray[np.float64]

    @property
    def frequency_hz(self) -> NDArray[np.float64]:
        """Natural frequencies in Hz, (m,)."""
        return np.sqrt(self.eigenvalues) / (2.0 * np.pi)

    def overlap(self, other: RigModes) -> NDArray[np.float64]:
        """(phi_i^T M phi_k)^2 of each mode i here with each mode k of the other, (m, m'): 1 where they are the same mode."""
        return np.asarray((self.vectors.T @ (self.system.mass @ other.vectors)) ** 2)


@dataclass
class RigModel:
    """A model with free numbers on one mesh; `solutions` counts the eigenproblems solved.

    Attributes:
        numbers: the free numbers.
        plan: the mesh.
        fmax: all modes below so many Hz.
        points: names of the points whose displacements are wanted.
    """

    numbers: FreeNumbers
    plan: Plan
    fmax: float
    points: tuple[str, ...] = ()
    solutions: int = field(default=0)

    def modes(self, x: NDArray[np.float64]) -> RigModes:
        """The elastic modes at x."""
        system = system_of(self.numbers.at(x), self.plan)
        found = solve(system, Wanted(None, None, 2.0 * np.pi * self.fmax))
        self.solutions += 1
        elastic = ~found.rigid & (np.abs(found.eigenvalues) > 0.0)
        X = np.real(found.vectors[:, elastic])
        rows = point_rows(system, self.points)
        return RigModes(system, np.abs(found.eigenvalues[elastic]) ** 2, X, np.asarray(rows @ X).T)

    def derivatives(
        self, x: NDArray[np.float64], modes: RigModes, chosen: NDArray[np.intp], *, shapes: bool
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """d ln f / dx (k, p) and d phi / dx at the points (k, s, p) of k chosen modes; the latter zero unless asked for."""
        X = modes.vectors[:, chosen]
        values = modes.eigenvalues[chosen]
        changes = changes_of(self.numbers, x, modes.system, self.plan, X, shapes=shapes)
        slopes = frequency_derivatives(changes, values)
        if not shapes:
            return slopes, np.zeros((len(chosen), len(self.points), len(x)))
        rows = point_rows(modes.system, self.points)
        at_points = np.tensordot(
            rows.toarray(),
            shape_derivatives(modes.system, changes, modes.eigenvalues, modes.vectors, chosen),
            axes=(1, 0),
        )
        return slopes, np.transpose(at_points, (1, 0, 2))
