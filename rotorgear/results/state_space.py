"""Result of a state-space export: the equations of motion between inputs and outputs, whole or reduced to modes."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import scipy.linalg as la

from rotorgear.quantity import counted
from rotorgear.results.frequency_response import BetweenPlaces
from rotorgear.results.schema import of
from rotorgear.results.table import Block, Line, error_words, grid


class StateSpace(BetweenPlaces, kind="state_space"):
    """M x'' + D x' + K x = B u,  y = C x + C_v x' + C_a x''  with s coordinates x, forces u and displacements or loads y.

    Whole, x are the free displacements; reduced, they are coordinates of modes and of static shapes. D = C + W G holds damping
    and gyroscopic moments at the speed. C_v and C_a are of outputs that read a load.
    """

    fmax: float = of("highest frequency that the system is meant for", "Hz")
    mass_matrix: np.ndarray = of("mass matrix", "", "coordinate", "coordinate", json=None)
    velocity_terms: np.ndarray = of("damping and gyroscopic matrix", "", "coordinate", "coordinate", json=None)
    stiffness_matrix: np.ndarray = of("stiffness matrix", "", "coordinate", "coordinate", json=None)
    input_matrix: np.ndarray = of("forces on the coordinates", "", "coordinate", "input", json=None)
    output_matrix: np.ndarray = of("outputs from the coordinates", "", "output", "coordinate", json=None)
    velocity_output: np.ndarray = of(
        "outputs from the velocities of the coordinates",
        "",
        "output",
        "coordinate",
        json=None,
        default_factory=lambda: np.zeros((0, 0)),
        kw_only=True,
    )
    acceleration_output: np.ndarray = of(
        "outputs from the accelerations of the coordinates",
        "",
        "output",
        "coordinate",
        json=None,
        default_factory=lambda: np.zeros((0, 0)),
        kw_only=True,
    )
    reduced: bool = of("whether it is reduced to modes and static shapes")
    kept_modes: int = of("number of modes that were kept", note="; 0 without a reduction")
    reduction_error: float = of(
        "estimated error of the reduction",
        note=": twice the largest change of a response over its size",
        form=error_words,
    )
    error_estimate: float = of(
        "estimated error of the mesh", note=": the largest change of a response over its size", form=error_words
    )

    @property
    def size(self) -> int:
        """Number of coordinates; there are twice as many states."""
        return int(self.mass_matrix.shape[0])

    def first_order(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """A (2s, 2s), B (2s, i), C (o, 2s), D (o, i) of x' = A x + B u, y = C x + D u, with states (L^T x, L^T x').

        M = L L^T: coordinates of unit mass keep the rounding of M^-1 K small.
        """
        L = la.cholesky(self.mass_matrix, lower=True)

        def reduced(matrix: np.ndarray) -> np.ndarray:
            half = la.solve_triangular(L, matrix, lower=True)
            return np.asarray(la.solve_triangular(L, half.T, lower=True).T)

        n = self.size
        zero = np.zeros((n, n))
        forces = la.solve_triangular(L, self.input_matrix, lower=True)
        A = np.block([[zero, np.eye(n)], [-reduced(self.stiffness_matrix), -reduced(self.velocity_terms)]])
        B = np.vstack([np.zeros_like(forces), forces])
        # y = C x + C_v x' + C_a x'', with the accelerations that the equations of motion give.
        read, rate, inertia = (
            la.solve_triangular(L, rows.T, lower=True).T if rows.size else np.zeros((len(self.outputs), n))
            for rows in (self.output_matrix, self.velocity_output, self.acceleration_output)
        )
        C = np.hstack([read, rate]) + inertia @ A[n:]
        return A, B, C, inertia @ forces

    def receptance(self, frequencies: np.ndarray) -> np.ndarray:
        """(C + i w C_v - w^2 C_a) (K + i w D - w^2 M)^-1 B at frequencies in Hz, (f, o, i)."""
        found = []
        for hz in np.asarray(frequencies, float).ravel():
            w = 2.0 * np.pi * hz
            Z = self.stiffness_matrix + 1j * w * self.velocity_terms - w**2 * self.mass_matrix
            read = self.output_matrix.astype(complex)
            if self.velocity_output.size:
                read += 1j * w * self.velocity_output - w**2 * self.acceleration_output
            found.append(read @ np.linalg.solve(Z, self.input_matrix.astype(complex)))
        return np.array(found)

    def tables(self) -> Iterator[Block]:
        """Inputs and outputs with their units, the size, and how far the reduction is off."""
        yield from (Line(f"{self.model.title or 'Model'}: state space, {self.at_speed}"), "")
        rows = [("input", *one) for one in zip(self.inputs, self.input_units, strict=True)]
        rows += [("output", *one) for one in zip(self.outputs, self.output_units, strict=True)]
        yield from (grid(rows, "kind", "place", "unit", left=3, caption="Inputs and outputs"), "")
        size = f"{2 * self.size} states"
        if self.reduced:
            size += (
                f": {counted(self.kept_modes, 'modes')} and {counted(self.size - self.kept_modes, 'other shapes')} "
                f"of {self.dofs} dofs"
            )
            changed = f"the reduction changes responses up to {self.fmax:.6g} Hz by {error_words(self.reduction_error)}"
            error = f"{changed}, the mesh by {error_words(self.error_estimate)} of their largest (estimated)"
        else:
            size += f", twice the {self.dofs} dofs: nothing is reduced"
            changed = f"the mesh changes responses up to {self.fmax:.6g} Hz"
            error = f"{changed} by {error_words(self.error_estimate)} of their largest (estimated)"
        yield from (f"{size}; {self.cost}", error, *self.remarks())
