"""What vibration puts on casings: at their seats by what stands in them, and by the ground at held sets and mounts.

A part in a seat has no mass, so that its force on the seat is -(K q + C q') in its rows of the seat. The ground holds a body by

    f = Ψᵀ (M a + C v + K u)

with static shapes Ψ for unit motions of the ground at one place (`rotorgear.casings.reduction`). Damping of modes of the whole
gearbox, D = M V diag(2 ζ ω) Vᵀ M, brakes every point of the casing as accelerations V diag(2 ζ ω) Vᵀ M q' would.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from rotorgear.system.system import System


@dataclass(frozen=True)
class ModalDamping:
    """Modes (n, m) of modal mass 1 and their 2 ζ ω (m,)."""

    modes: np.ndarray
    sizes: np.ndarray


class SeatLoads:
    """Force, and moment about its point, on each seat that something stands in: rows of the matrices of those parts."""

    def __init__(self, system: System) -> None:
        self._system = system
        self._rows: tuple[sp.csr_array, sp.csr_array] | None = None
        standing: dict[str, list[str]] = {}
        for table in ("bearings", "nonlinear_elements"):
            for part in getattr(system.model, table):
                seat = system.layout.seat(f"{table}.{part}")
                if seat is not None:
                    name = f"{seat.casing}.{system.layout.casing(seat.casing).seats[seat.number]}"
                    standing.setdefault(name, []).append(f"{table}.{part}")
        self._standing = standing

    @property
    def names(self) -> tuple[str, ...]:
        """Of the seats, such as "box.left"."""
        return tuple(self._standing)

    @property
    def shared(self) -> tuple[int, ...]:
        """Numbers of the seats whose load is not that of one bearing."""
        standing = self._standing.values()
        return tuple(k for k, parts in enumerate(standing) if len(parts) > 1 or not parts[0].startswith("bearings."))

    def read(self, speed: float, w: np.ndarray, q: np.ndarray) -> np.ndarray:
        """Amplitudes (o, s, 6) for displacements q (n, o) at frequencies w (o,), at a reference speed; all in SI."""
        if not self._standing:
            return np.zeros((len(w), 0, 6))
        if self._rows is None or self._system.has_tables:
            self._rows = self._at(speed)
        K, C = self._rows
        return np.asarray(-(K @ q + (C @ q) * (1j * w)).T.reshape(len(w), -1, 6))

    def _at(self, speed: float) -> tuple[sp.csr_array, sp.csr_array]:
        system = self._system
        beta = system.model.damping.rayleigh_beta
        groups = system.groups_at(speed)
        K, C = (np.zeros((6 * len(self._standing), system.dofs.transform.shape[0])) for _ in "KC")
        for number, parts in enumerate(self._standing.values()):
            rows = slice(6 * number, 6 * number + 6)
            for group in groups:
                if group.part not in parts:
                    continue
                columns = group.dofs[0]
                m = group.matrices
                for term in (m.stiffness, m.circulatory):
                    if term is not None:
                        K[rows, columns] += term[0][:6]
                if m.damping is not None:
                    C[rows, columns] += m.damping[0][:6]
                if beta and m.stiffness is not None:
                    C[rows, columns] += beta * m.stiffness[0][:6]
        T = sp.csr_array(system.dofs.transform)
        return sp.csr_array(sp.csr_array(K) @ T), sp.csr_array(sp.csr_array(C) @ T)


class GroundLoads:
    """Force, and moment about the origin of the model, of the ground on each held set and mount of casings from meshes."""

    def __init__(self, system: System, damped: ModalDamping | None) -> None:
        given = system.model.damping
        self._parts = []
        names: list[str] = []
        for casing in system.model.casings:
            body = system.layout.casing(casing)
            K, C, M = body.ground_force, body.ground_damping, body.ground_mass
            if K is None or C is None or M is None or not body.ground_sets:  # it floats, or was reduced elsewhere
                continue
            names += [f"{casing}.{place}" for place in body.ground_sets]
            own = sp.csr_array(system.dofs.transform)[system.nodes.of_casing(casing), :]
            # Rayleigh's damping is one of every part of the gearbox.
            C = C + given.rayleigh_beta * K + given.rayleigh_alpha * M
            self._parts.append((own, K, C, M))
        self.names = tuple(names)
        self._modes = damped if self._parts else None
        self._momentum = None if self._modes is None else np.asarray(system.mass @ self._modes.modes)

    def read(self, w: np.ndarray, q: np.ndarray) -> np.ndarray:
        """Amplitudes (o, g, 6) for displacements q (n, o) at frequencies w (o,); all in SI."""
        found = [np.zeros((len(w), 0))]
        brake = None
        if self._modes is not None and self._momentum is not None:
            brake = self._modes.modes @ (self._modes.sizes[:, None] * (self._momentum.T @ q)) * (1j * w)
        for own, K, C, M in self._parts:
            u = own @ q
            accelerations = -(w**2) * u
            if brake is not None:
                accelerations = accelerations + own @ brake
            found.append((K @ u + (C @ u) * (1j * w) + M @ accelerations).T)
        return np.hstack(found).reshape(len(w), -1, 6)
