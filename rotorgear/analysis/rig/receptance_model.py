"""Receptances of a model with free numbers, and their derivatives, over a few shapes.

    H(w) = P_o Z^-1 P_i,    Z = K + i w (C + W G) - w^2 M,    dH/dx = -q_o^T Z' q_i,    Z q_i = P_i,  Z^T q_o = P_o^T

(Friswell and Mottershead 1995, Finite element model updating in structural dynamics, Kluwer). The shapes V are those of the modes
and, for what lies above them, answers Z(s)^-1 P to the places at a few s along the band. Z' is the central difference of Z.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp
from numpy.typing import NDArray

from rotorgear.analysis.common.left_out import GIVE_DAMPING
from rotorgear.analysis.common.points import point_rows
from rotorgear.analysis.rig.rig_model import RigModel, RigModes
from rotorgear.analysis.sensitivity.derivatives import STEP, beside, springs_of
from rotorgear.analysis.sensitivity.forms import with_shapes
from rotorgear.errors import AnalysisError
from rotorgear.system.assembly import assemble
from rotorgear.system.damped_range import all_damped, damped_up_to
from rotorgear.system.system import System

# The modes that carry the responses reach up to this multiple of the highest measured frequency.
CARRIED = 2.0
# Answers to the places are taken at these multiples of the highest frequency, beside the axis: no resonance drowns the rest.
_SHIFTS = (3.0 + 0.0j, 0.1 + 1.0j, 0.1 + 0.75j, 0.1 + 0.5j, 0.1 + 0.25j, 0.1 + 0.0j)
# What is left of a shape beside the others below this share is rounding.
_SAME = 1e-9


@dataclass(frozen=True)
class Receptances:
    """Receptances at one set of numbers.

    Attributes:
        system: the whole system, and
        V: the shapes that carry it (n, r).
        H: (f, o, i).
        q_in, q_out: answers to unit forces at the inputs (f, r, i), and of the transposed system at the outputs (f, r, o).
    """

    system: System
    V: NDArray[np.float64]
    H: NDArray[np.complex128]
    q_in: NDArray[np.complex128]
    q_out: NDArray[np.complex128]


@dataclass(frozen=True)
class ReceptanceModel:
    """Receptances between places of a model with free numbers.

    Attributes:
        model: with its mesh and speed.
        frequency_hz: positive (f,).
        outputs, inputs: places.
        modal_damping: damping ratio added to every elastic mode beside that of the model.
    """

    model: RigModel
    frequency_hz: NDArray[np.float64]
    outputs: tuple[str, ...]
    inputs: tuple[str, ...]
    modal_damping: float

    def look(self, x: NDArray[np.float64], modes: RigModes) -> Receptances:
        """The receptances at x, where the model has some modes.

        Raises:
            AnalysisError: nothing damps the model; a place that can't move.
        """
        system = modes.system
        P_i = self._ports(system, self.inputs)
        P_o = self._ports(system, self.outputs)
        V = self._basis(modes, np.hstack([P_i, P_o]))
        K, D, M = self._reduced(system, V, x)
        if not np.any(D + D.T):
            raise AnalysisError(
                f"nothing damps the model, and measured responses are damped: {GIVE_DAMPING}, or --modal-damping"
            )
        w = 2.0 * np.pi * self.frequency_hz[:, None, None]
        Z = K + 1j * w * D - w**2 * M
        inputs, outputs = (
            np.broadcast_to((V.T @ P).astype(complex), (len(w), V.shape[1], P.shape[1])) for P in (P_i, P_o)
        )
        q_in = np.linalg.solve(Z, inputs)
        q_out = np.linalg.solve(np.transpose(Z, (0, 2, 1)), outputs)
        H = np.asarray(np.transpose(outputs, (0, 2, 1)) @ q_in)
        return Receptances(system, V, H, q_in, q_out)

    def slopes(self, x: NDArray[np.float64], here: Receptances) -> NDArray[np.complex128]:
        """dH/dx (p, f, o, i)."""
        numbers = self.model.numbers
        springs = springs_of(numbers.model, here.system)
        beta = numbers.model.damping.rayleigh_beta
        V = here.V
        w = 2.0 * np.pi * self.frequency_hz[:, None, None]
        left = np.transpose(here.q_out, (0, 2, 1))
        found = []
        for j, address in enumerate(numbers.addresses):
            # Derivatives of K, D and M over the shapes with respect to number j.
            if address in springs:
                # The matrix of a spring is in proportion to its number: no system is assembled again.
                spring = V.T @ (
                    assemble(springs[address], here.system.dofs, lambda group: group.matrices.stiffness) @ V
                )
                K, M = self._stiffness_and_mass(here.system, V)
                stiffer, softer = (self._modal_damping(here.system, K + h * spring, M, x) for h in (STEP, -STEP))
                # Damping in proportion to the stiffness has its part in the spring.
                change = np.array([spring, (stiffer - softer) / (2.0 * STEP) + beta * spring, np.zeros_like(K)])
            else:
                step = np.zeros(len(x))
                step[j] = STEP
                above, below = beside(numbers, x, j, here.system, self.model.speed)
                change = (self._reduced(above, V, x + step) - self._reduced(below, V, x - step)) / (2.0 * STEP)
            K, D, M = change
            forces = K @ here.q_in + 1j * w * (D @ here.q_in) - w**2 * (M @ here.q_in)
            found.append(-left @ forces)
        return np.array(found)

    def error(self, x: NDArray[np.float64], here: Receptances, count: int = 3) -> float:
        """Largest difference to the whole system at a few peaks, relative to the largest receptance of each pair."""
        from scipy.sparse.linalg import splu

        system = here.system
        speed = self.model.speed
        P_i = self._ports(system, self.inputs)
        P_o = self._ports(system, self.outputs)
        damped = self._modal_damping(system, *self._stiffness_and_mass(system, here.V), x)
        # V has modal mass: what damps its modes damps them in the whole system.
        B = system.mass @ here.V
        peaks = np.unique(np.abs(here.H).argmax(axis=0))
        at = peaks[np.unique(np.linspace(0, len(peaks) - 1, count).astype(int))]
        size = np.abs(here.H).max(axis=0)
        worst = 0.0
        for k in at:
            w = 2.0 * np.pi * float(self.frequency_hz[k])
            Z = system.stiffness(speed) + system.circulatory(speed)
            Z = Z + 1j * w * _damping(system, speed) - w**2 * system.mass
            solve = splu(sp.csc_array(Z)).solve
            answers = solve(np.hstack([P_i, B]).astype(complex))
            a, b = answers[:, : P_i.shape[1]], answers[:, P_i.shape[1] :]
            # (Z + B d B^T)^-1 by Woodbury's formula.
            d = 1j * w * damped
            inner = np.eye(len(d)) + d @ (B.T @ b)
            q = a - b @ np.linalg.solve(inner, d @ (B.T @ a))
            worst = max(worst, float(np.max(np.abs(P_o.T @ q - here.H[k]) / np.where(size > 0.0, size, 1.0))))
        return worst

    def _ports(self, system: System, places: tuple[str, ...]) -> NDArray[np.float64]:
        rows = point_rows(system, places).toarray()
        for place, row in zip(places, rows, strict=True):
            if not row.any():
                raise AnalysisError(f"'{place}' can't move: a support or the motions of the model hold it")
        return np.asarray(rows.T)

    def _basis(self, modes: RigModes, ports: NDArray[np.float64]) -> NDArray[np.float64]:
        """Shapes (n, r), orthonormal in M."""
        from scipy.sparse.linalg import splu

        system = modes.system
        speed = self.model.speed
        K = system.stiffness(speed)
        M = system.mass
        top = 2.0 * np.pi * float(self.frequency_hz[-1])
        nothing = np.zeros((system.n, 0))
        if all_damped(system) and np.all(M.diagonal() > 0.0):
            return with_shapes(M, nothing, np.eye(system.n), _SAME)
        D = _damping(system, speed)
        carriers = modes.carriers
        V = with_shapes(M, nothing, np.hstack([carriers.real, carriers.imag]) if speed else np.real(carriers), _SAME)
        forces = ports.astype(complex)
        for s in top * np.array(_SHIFTS):
            solver = splu(sp.csc_array(K + s * D + s**2 * M))
            answers = [solver.solve(forces), solver.solve(forces, trans="T")] if speed else [solver.solve(forces)]
            more = np.hstack([part(answer) for answer in answers for part in (np.real, np.imag) if part(answer).any()])
            V = with_shapes(M, V, more, _SAME)
        return V

    def _reduced(self, system: System, V: NDArray[np.float64], x: NDArray[np.float64]) -> NDArray[np.float64]:
        """K, C + W G and M over V, (3, r, r)."""
        K, M = self._stiffness_and_mass(system, V)
        D = V.T @ (_damping(system, self.model.speed) @ V) + self._modal_damping(system, K, M, x)
        circulatory = V.T @ (system.circulatory(self.model.speed) @ V)
        return np.array([K + circulatory, D, M])

    def _stiffness_and_mass(
        self, system: System, V: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        S = system.strain_factor(self.model.speed)
        # Strains keep the digits that K V of a stiff shaft would lose.
        strains = None if S is None else S @ V
        K = V.T @ (system.stiffness(self.model.speed) @ V) if strains is None else strains.T @ strains
        return np.asarray(K), np.asarray(V.T @ (system.mass @ V))

    def _modal_damping(
        self, system: System, K: NDArray[np.float64], M: NDArray[np.float64], x: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Sum of 2 zeta w M phi phi^T M over the undamped modes, (r, r), as in `frf`; the ratio of the model may be free."""
        zeta = self.modal_damping + self.model.numbers.at(x).damping.modal_ratio
        if not zeta:
            return np.zeros_like(K)
        values, phi = la.eigh(0.5 * (K + K.T), 0.5 * (M + M.T))
        w = np.sqrt(np.maximum(values, 0.0))
        limit = damped_up_to(system, 2.0 * np.pi * float(self.frequency_hz[-1]))
        momentum = M @ phi[:, w < limit]
        return np.asarray(momentum * (2.0 * zeta * w[w < limit]) @ momentum.T)


def _damping(system: System, speed: float) -> sp.csc_array:
    """C + W G."""
    C = system.damping(speed)
    return sp.csc_array(C + speed * system.gyroscopic) if speed else C
