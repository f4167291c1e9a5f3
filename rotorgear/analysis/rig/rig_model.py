"""The modes of a model with free numbers, as an update asks for them again and again: one mesh, all modes below one frequency."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from rotorgear.analysis.common.points import point_rows
from rotorgear.analysis.modal.modes import Wanted
from rotorgear.analysis.modal.solve import solve
from rotorgear.analysis.rig.rotating_sensitivity import rotating_changes, rotating_shape_slopes, rotating_slopes
from rotorgear.analysis.rig.sensitivity import changes_of, frequency_derivatives, shape_derivatives, system_of
from rotorgear.model.numbers import FreeNumbers
from rotorgear.system.plan import Plan
from rotorgear.system.system import System

Shapes = NDArray[np.float64] | NDArray[np.complex128]


class ComparedModes(Protocol):
    """What lines are compared with: the modes of one model, or those of all campaigns one after the other."""

    @property
    def system(self) -> System: ...
    @property
    def eigenvalues(self) -> NDArray[np.float64]: ...
    @property
    def frequency_hz(self) -> NDArray[np.float64]: ...
    @property
    def campaign(self) -> NDArray[np.intp]: ...
    @property
    def at_points(self) -> Shapes: ...
    @property
    def parts(self) -> tuple[Any, ...]: ...
    def overlap(self, other: Any) -> NDArray[np.float64]: ...


class ComparedModel(Protocol):
    """Where such modes come from; it understands its own modes only."""

    @property
    def numbers(self) -> FreeNumbers: ...
    @property
    def solutions(self) -> int: ...
    def modes(self, x: NDArray[np.float64]) -> ComparedModes: ...
    def derivatives(
        self, x: NDArray[np.float64], modes: Any, chosen: NDArray[np.intp], *, shapes: bool
    ) -> tuple[NDArray[np.float64], Shapes]: ...


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
    """

    system: System
    speed: float
    eigenvalues: NDArray[np.float64]
    vectors: Shapes
    at_points: Shapes
    carriers: Shapes

    @property
    def frequency_hz(self) -> NDArray[np.float64]:
        """Natural frequencies in Hz, (m,)."""
        return np.sqrt(self.eigenvalues) / (2.0 * np.pi)

    @property
    def campaign(self) -> NDArray[np.intp]:
        """Number of the campaign that each mode belongs to, (m,)."""
        return np.zeros(len(self.eigenvalues), dtype=np.intp)

    @property
    def parts(self) -> tuple[RigModes, ...]:
        """The modes of each campaign: there is one."""
        return (self,)

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
        fmax: all modes below so many Hz.
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
        system = system_of(self.numbers.at(x), self.plan, self.speed)
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
        return RigModes(system, self.speed, squares, X, np.asarray(rows @ X).T, found.vectors)

    def derivatives(
        self, x: NDArray[np.float64], modes: RigModes, chosen: NDArray[np.intp], *, shapes: bool
    ) -> tuple[NDArray[np.float64], Shapes]:
        """d ln f / dx (k, p) and d phi / dx at the points (k, s, p) of k chosen modes; the latter zero unless asked for."""
        system = modes.system
        X = modes.vectors[:, chosen]
        values = modes.eigenvalues[chosen]
        moved: Shapes = np.zeros((system.n, 0, 0))
        if self.speed:
            omega = np.sqrt(modes.eigenvalues)
            turning = rotating_changes(
                self.numbers,
                x,
                system,
                self.plan,
                self.speed,
                omega[chosen],
                np.asarray(X, dtype=complex),
                shapes=shapes,
            )
            slopes = rotating_slopes(system, self.speed, turning, omega[chosen], np.asarray(X, dtype=complex))
            if shapes:
                vectors = np.asarray(modes.vectors, dtype=complex)
                moved = rotating_shape_slopes(system, self.speed, turning, omega, vectors, chosen)
        else:
            changes = changes_of(self.numbers, x, system, self.plan, np.real(X), shapes=shapes)
            slopes = frequency_derivatives(changes, values)
            if shapes:
                moved = shape_derivatives(system, changes, modes.eigenvalues, np.real(modes.vectors), chosen)
        if not shapes:
            return slopes, np.zeros((len(chosen), len(self.points), len(x)))
        at_points = np.tensordot(point_rows(system, self.points).toarray(), moved, axes=(1, 0))
        return slopes, np.transpose(at_points, (1, 0, 2))
