"""The modes of a model with free numbers, as an update asks for them again and again: one mesh, all modes below one frequency."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from rotorgear.analysis.common.discretise import cut_of
from rotorgear.analysis.common.points import point_rows
from rotorgear.analysis.modal.modal import modal
from rotorgear.analysis.modal.solve import Wanted, solve
from rotorgear.analysis.sensitivity.derivatives import STEP, beside, changes_of, frequency_slopes, shape_slopes
from rotorgear.analysis.sensitivity.forms import Shapes
from rotorgear.analysis.static.state_at import linear_system
from rotorgear.model.model import Model
from rotorgear.model.numbers import FreeNumbers
from rotorgear.system.plan import Plan
from rotorgear.system.system import System


def plan_of(model: Model, fmax: float, accuracy: float | None) -> Plan:
    """The mesh on which all modes up to `fmax` are within an accuracy."""
    return Plan(cut=cut_of(modal(model, fmax=fmax, accuracy=accuracy).discretisation))


@dataclass(frozen=True)
class RigModes:
    """Elastic modes at one set of numbers.

    Attributes:
        system: the whole system.
        speed: of the reference shaft in rad/s, 0 at standstill.
        eigenvalues: w^2 (m,).
        vectors: shapes X (n, m), X^H (K + w^2 M) X = 2 w^2: modal mass 1 at standstill, where they are real.
        at_points: their values at s points (m, s).
        carriers: rigid and elastic shapes, of any size (n, m').
        numbers: their numbers among all modes, rigid-body motions counted, from 1 (m,): those of `modal`.
    """

    system: System
    speed: float
    eigenvalues: NDArray[np.float64]
    vectors: Shapes
    at_points: Shapes
    carriers: Shapes
    numbers: NDArray[np.intp]

    @property
    def damping_ratio(self) -> NDArray[np.float64]:
        """Damping ratios X^H C X / (2 w) beside that of all modes, (m,): of light damping, which leaves shapes as they are."""
        C = self.system.damping(self.speed)
        lost = np.real(np.sum(self.vectors.conj() * (C @ self.vectors), axis=0))
        return np.asarray(lost / (2.0 * np.sqrt(self.eigenvalues)) + self.system.model.damping.modal_ratio)

    @property
    def frequency_hz(self) -> NDArray[np.float64]:
        """Natural frequencies in Hz, (m,)."""
        return np.sqrt(self.eigenvalues) / (2.0 * np.pi)

    def overlap(self, other: RigModes) -> NDArray[np.float64]:
        """|phi_i^H M phi_k|^2 of each mode i here with each mode k of the other, (m, m'): 1 where they are the same mode.

        Of a rotating system it is the product in the energy, (phi_i^H K phi_k + w_i w_k phi_i^H M phi_k) / (2 w_i w_k).
        """
        kinetic = self.vectors.conj().T @ (self.system.mass @ other.vectors)
        if not self.speed:
            return np.asarray(kinetic**2)
        strain = self.vectors.conj().T @ (self.system.stiffness(self.speed) @ other.vectors)
        size = np.sqrt(np.outer(self.eigenvalues, other.eigenvalues))
        return np.asarray(np.abs(0.5 * (strain / size + kinetic)) ** 2)


@dataclass
class RigModel:
    """A model with free numbers on one mesh; `solutions` counts the eigenproblems solved.

    Attributes:
        numbers: the free numbers.
        plan: the mesh.
        fmax: highest frequency of the modes in Hz.
        points: names of the points whose displacements are wanted.
        speed: of the reference shaft in rad/s, 0 at standstill; nothing damps.
    """

    numbers: FreeNumbers
    plan: Plan
    fmax: float
    points: tuple[str, ...] = ()
    speed: float = 0.0
    solutions: int = field(default=0)

    def modes(self, x: NDArray[np.float64]) -> RigModes:
        """The elastic modes at x."""
        system = linear_system(self.numbers.at(x), [self.speed or None], self.plan)
        found = solve(system, Wanted(self.speed or None, None, 2.0 * np.pi * self.fmax, damped=False))
        self.solutions += 1
        elastic = ~found.rigid & (np.abs(found.eigenvalues) > 0.0)
        squares = np.abs(found.eigenvalues[elastic]) ** 2
        X = found.vectors[:, elastic] if self.speed else np.real(found.vectors[:, elastic])
        if self.speed:
            doubled = np.real(np.sum(X.conj() * (system.stiffness(self.speed) @ X), axis=0) / squares)
            doubled += np.real(np.sum(X.conj() * (system.mass @ X), axis=0))
            X = X * np.sqrt(2.0 / doubled)
        rows = point_rows(system, self.points)
        numbers = np.flatnonzero(elastic) + 1
        return RigModes(system, self.speed, squares, X, np.asarray(rows @ X).T, found.vectors, numbers)

    def derivatives(
        self, x: NDArray[np.float64], modes: RigModes, chosen: NDArray[np.intp], *, shapes: bool
    ) -> tuple[NDArray[np.float64], Shapes]:
        """d ln f / dx (k, p) and d phi / dx at the points (k, s, p) of k chosen modes; the latter zero unless asked for."""
        system = modes.system
        X = modes.vectors[:, chosen]
        values = modes.eigenvalues[chosen]
        changes = changes_of(self.numbers, x, system, self.speed, values, X, shapes=shapes)
        slopes = frequency_slopes(system, self.speed, changes, values, X)
        if not shapes:
            return slopes, np.zeros((len(chosen), len(self.points), len(x)))
        moved = shape_slopes(system, self.speed, changes, modes.eigenvalues, modes.vectors, chosen)
        at_points = np.tensordot(point_rows(system, self.points).toarray(), moved, axes=(1, 0))
        return slopes, np.transpose(at_points, (1, 0, 2))

    def damping_slopes(self, x: NDArray[np.float64], modes: RigModes, chosen: NDArray[np.intp]) -> NDArray[np.float64]:
        """d ln zeta / dx (k, p) of the damping ratios of k chosen modes: of shapes, dampers and frequencies."""
        system = modes.system
        X = modes.vectors[:, chosen]
        omega = np.sqrt(modes.eigenvalues[chosen])
        C = system.damping(self.speed)
        changes = changes_of(self.numbers, x, system, self.speed, modes.eigenvalues[chosen], X, shapes=True)
        moved = shape_slopes(system, self.speed, changes, modes.eigenvalues, modes.vectors, chosen)
        slower = frequency_slopes(system, self.speed, changes, modes.eigenvalues[chosen], X)
        ratio = modes.damping_ratio[chosen]
        own = ratio - system.model.damping.modal_ratio
        found = np.zeros((len(chosen), len(x)))
        for j in range(len(x)):
            above, below = beside(self.numbers, x, j, system, self.speed)
            change = (above.damping(self.speed) - below.damping(self.speed)) / (2.0 * STEP)
            lost = np.real(np.sum(X.conj() * (change @ X + 2.0 * (C @ moved[:, :, j])), axis=0)) / (2.0 * omega)
            modal = (above.model.damping.modal_ratio - below.model.damping.modal_ratio) / (2.0 * STEP)
            found[:, j] = (lost - own * slower[:, j] + modal) / ratio
        return found
