"""Periodic motions of a family of plants by harmonic balance, as equations for the continuation."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from rotorgear.solvers.periodic.arclength import Linear
from rotorgear.solvers.periodic.balance import HarmonicGrid, balance, coefficients, samples_of, synthesised, unknowns
from rotorgear.solvers.periodic.floquet import FINER, ModalBasis, basis_of, multipliers
from rotorgear.solvers.periodic.plant import Plant, PlantAt
from rotorgear.solvers.periodic.receptances import Receptances
from rotorgear.solvers.periodic.samples import MotionCycle, answered, spectrum
from rotorgear.solvers.periodic.switches import switches_of

# Step of a difference in the parameter, as a share of the range.
_DIFFERENCE = 1e-6
# Modes up to this multiple of the base frequency, and of the contact's own, belong to the map over a period.
_BASES = 16.0
_CONTACTS = 3.0
# Values whose receptances are kept.
_MOST_KEPT = 2000


class HarmonicOrbits:
    """Coefficients of the local displacements over their scale, as unknowns; the parameter from 0 to 1.

    Args:
        plant_at: the plant at a value of the parameter. grid: harmonics and instants.
        scale: displacements (m,) that count as 1. receptances: of plants of the same structure, to go on with.
    """

    method = "harmonic balance"

    def __init__(
        self, plant_at: PlantAt, grid: HarmonicGrid, scale: np.ndarray, receptances: Receptances | None = None
    ) -> None:
        self._plant_at = plant_at
        self.grid = grid
        self.scale = scale
        self._receptances = receptances or Receptances(grid.harmonics, grid.order)
        # Receptances (H + 1, m, m) at values that are kept, and the watched displacements (H, p, m) of unit forces there.
        self._kept: dict[float, tuple[np.ndarray, np.ndarray]] = {}
        # Values that `memory` has not told of yet.
        self._new: dict[float, None] = {}
        # The bases of the map over a period that the begin of the range and the last plant have.
        self._bases: list[tuple[Plant, ModalBasis]] = []

    @property
    def size(self) -> int:
        """Number of unknowns."""
        return (2 * self.grid.harmonics + 1) * self.scale.size

    def prepare_at(self, p: float) -> None:
        """Solve for the exact receptances at a value, unless they follow from those of its neighbours to rounding."""
        if p in self._kept:
            return
        plant = self._plant_at(p)
        own = self._receptances
        if own.holds_for(plant, p):
            self._keep(p, own.near(plant), own.watched(plant))
        else:
            self._solve_at(p)

    def _keep(self, p: float, R: np.ndarray, watched: np.ndarray) -> None:
        for known in (self._kept, self._new):
            known.pop(p, None)
        # In one order in memory, as they come back from a file: products depend on it in the last digit.
        self._kept[p] = (np.ascontiguousarray(R), np.ascontiguousarray(watched))
        self._new[p] = None
        if len(self._kept) > _MOST_KEPT:
            oldest = next(iter(self._kept))
            del self._kept[oldest]
            self._new.pop(oldest, None)

    def memory(self) -> dict[str, np.ndarray]:
        """What answers depend on, beside what is asked: what was kept since the last call, and where exact solutions are.

        Returns:
            `places` (k,), values of the last exact solutions; `values` (j,) whose receptances are kept, `receptances`
            (j, H + 1, m, m) and `watched` (j, H, p, m) there.
        """
        values = list(self._new)
        self._new.clear()
        sides = zip(*(self._kept[p] for p in values), strict=True) if values else (np.zeros((0, 0, 0, 0)),) * 2
        R, watched = map(np.array, sides)
        return {
            "places": np.array(self._receptances.places),
            "values": np.array(values),
            "receptances": R,
            "watched": watched,
        }

    def recall(self, memory: dict[str, np.ndarray]) -> None:
        """Go on as equations that have told this `memory`, after all those that they told before."""
        for p, R, watched in zip(memory["values"].tolist(), memory["receptances"], memory["watched"], strict=True):
            self._keep(p, R, watched)
        self._new.clear()
        self._receptances.recall(memory["places"].tolist(), self._plant_at)

    def _solve_at(self, p: float) -> np.ndarray:
        """Displacements (H, n, m) of unit local forces at a value."""
        plant = self._plant_at(p)
        X = self._receptances.exact(plant, p)[:, :, : plant.m]
        self._keep(p, self._receptances.with_static(plant, plant.B.T @ X), plant.watched.T @ X)
        return X

    def _receptance(self, p: float) -> np.ndarray:
        if not self._receptances.begun:
            self.prepare_at(p)
        if p in self._kept:
            return self._kept[p][0]
        return self._receptances.near(self._plant_at(p))

    def along(self, plant_at: PlantAt) -> HarmonicOrbits:
        """The same for other plants of the same structure: both share receptances between exact ones."""
        return HarmonicOrbits(plant_at, self.grid, self.scale, self._receptances)

    def apart(self) -> HarmonicOrbits:
        """The same without what was asked before."""
        return HarmonicOrbits(self._plant_at, self.grid, self.scale)

    def coefficients(self, y: np.ndarray) -> np.ndarray:
        """c (H + 1, m) in m or rad from unknowns."""
        return coefficients(y, self.grid, self.scale.size) * self.scale

    def unknowns(self, c: np.ndarray) -> np.ndarray:
        """Unknowns of coefficients (h, m): harmonics that these do not have are zero."""
        wide = np.zeros((self.grid.harmonics + 1, c.shape[1]), complex)
        wide[: len(c)] = c
        return unknowns(wide / self.scale)

    def start(self, p: float) -> np.ndarray:
        """Unknowns of the static state at a value."""
        return self.unknowns(static_displacements(self._plant_at(p))[None])

    def from_samples(self, d: np.ndarray) -> np.ndarray:
        """Unknowns of displacements (N, m) over a period."""
        return self.unknowns(spectrum(d, self.grid.harmonics))

    def residual(self, y: np.ndarray, p: float) -> np.ndarray:
        """c - d0 - R u over the scale."""
        return self._rest(self.coefficients(y), self._plant_at(p), self._receptance(p))

    def _rest(self, c: np.ndarray, plant: Plant, R: np.ndarray, u: np.ndarray | None = None) -> np.ndarray:
        """The residual of coefficients c with receptances R; u (H + 1, m) where it is known."""
        u = balance(c, plant, self.grid, tangents=False)[0] if u is None else u
        rest = c - np.einsum("hab,hb->ha", R, u)
        rest[0] -= plant.static.d
        return unknowns(rest / self.scale)

    def linear(self, y: np.ndarray, p: float) -> Linear:
        """The residual and its derivatives; that by the parameter by a difference."""
        c = self.coefficients(y)
        residual, in_y = self.values(y, p)
        # Between exact solutions the rational form is smooth: both ends of the difference come from it.
        plants = (self._plant_at(value) for value in (p - _DIFFERENCE, p + _DIFFERENCE))
        before, after = (self._rest(c, plant, self._receptances.near(plant)) for plant in plants)
        return Linear(residual, in_y, (after - before) / (2.0 * _DIFFERENCE))

    def values(self, y: np.ndarray, p: float, *, smooth: bool = False) -> tuple[np.ndarray, np.ndarray]:
        """The residual and its derivative by y; smooth ones by receptances between exact ones, for differences in p."""
        plant = self._plant_at(p)
        c = self.coefficients(y)
        R = self._receptances.near(plant) if smooth else self._receptance(p)
        u, tangent = balance(c, plant, self.grid)
        return self._rest(c, plant, R, u), self._derivative(R, tangent)

    def _derivative(self, R: np.ndarray, tangent: np.ndarray) -> np.ndarray:
        H = self.grid.harmonics
        m = self.scale.size
        moved = (R @ tangent.reshape(H + 1, m, -1)).reshape(H + 1, m, 2 * H + 1, m)
        moved = moved * self.scale / self.scale[None, :, None, None]
        J = np.eye(self.size)
        J[: (H + 1) * m] -= moved.real.reshape((H + 1) * m, -1)
        J[(H + 1) * m :] -= moved[1:].imag.reshape(H * m, -1)
        return J

    def _modes(self, plant: Plant) -> ModalBasis:
        """The basis of the map over a period: that of the begin of the range where inertia and stiffness are the same."""
        if not self._bases:
            first = self._plant_at(0.0)
            self._bases = [(first, self._basis_at(first))]
        for known, basis in self._bases:
            if known is plant or (known is self._bases[0][0] and known.K is plant.K):
                return basis
        self._bases = [self._bases[0], (plant, self._basis_at(plant))]
        return self._bases[-1][1]

    def _basis_at(self, plant: Plant) -> ModalBasis:
        from rotorgear.solvers.time.local_system import contact_rates

        contact = plant.forces.reference_stiffness
        root = np.sqrt(np.maximum(np.diag(contact), 0.0))
        R = plant.static.R * root * root[:, None]
        alive = np.linalg.eigvalsh(0.5 * (R + R.T)).max(initial=0.0)
        w = self.grid.frequency(plant.speed)
        # The highest frequency at which a contact alone would vibrate on the inertia it meets.
        own = float(contact_rates(plant.M, plant.B, contact).max(initial=0.0)) if alive > 0.0 else 0.0
        return basis_of(plant, max(_BASES * w, _CONTACTS * own))

    def modes(self, p: float) -> ModalBasis:
        """The basis of the map over a period at a value."""
        return self._modes(self._plant_at(p))

    def multipliers(self, y: np.ndarray, p: float) -> np.ndarray:
        """Floquet multipliers of a solution."""
        plant = self._plant_at(p)
        c = self.coefficients(y)
        fine = samples_of(c, plant, self.grid, FINER * self.grid.instants)
        switches = switches_of(c, fine, plant, self.grid.frequency(plant.speed))
        return multipliers(plant, self._modes(plant), fine, switches)

    def cycle(self, y: np.ndarray, p: float, instants: int | None = None) -> MotionCycle:
        """A period of a solution; `prepare_at` has been at its value."""
        plant = self._plant_at(p)
        grid = self.grid
        c = self.coefficients(y)
        self.prepare_at(p)
        moved = self._kept[p][1]
        u, _ = balance(c, plant, grid, tangents=False)
        W = plant.watched
        seen = np.zeros((grid.harmonics + 1, W.shape[1]), complex)
        seen[0] = W.T @ (plant.static.q + plant.static.X @ u[0].real)
        if W.shape[1]:
            seen[1:] = np.einsum("hpm,hm->hp", moved, u[1:])
        N = instants or grid.instants
        w = grid.frequency(plant.speed)
        laws = plant.forces
        turn = 1j * w * np.arange(grid.harmonics + 1)[:, None]
        force = c @ laws.reference_stiffness.T + turn * (c @ laws.reference_damping.T) - u
        return MotionCycle(2.0 * np.pi / w, samples_of(c, plant, grid, N), *synthesised(seen, w, N), c, force)

    def state(self, y: np.ndarray, p: float) -> tuple[np.ndarray, np.ndarray]:
        """Displacements and velocities (n,) of a solution at the begin of its period."""
        X = self._solve_at(p)
        plant = self._plant_at(p)
        u, _ = balance(self.coefficients(y), plant, self.grid, tangents=False)
        q = np.einsum("hnm,hm->hn", X, u[1:])
        turn = 1j * self.grid.frequency(plant.speed) * np.arange(1, len(u))[:, None]
        static = plant.static.q + plant.static.X @ u[0].real
        return static + q.real.sum(axis=0), (turn * q).real.sum(axis=0)

    def finer(self) -> HarmonicOrbits:
        """The same motions with twice the harmonics and instants."""
        return HarmonicOrbits(self._plant_at, self.grid.doubled, self.scale)

    def lifted(self, y: np.ndarray, finer: HarmonicOrbits) -> np.ndarray:
        """The unknowns of a motion in the finer equations."""
        return finer.unknowns(self.coefficients(y))

    def doubled(self) -> HarmonicOrbits:
        """The same with twice the period."""
        grid = replace(self.grid.doubled, order=0.5 * self.grid.order)
        if self._receptances.twice is None:
            self._receptances.twice = Receptances(grid.harmonics, grid.order)
        return HarmonicOrbits(self._plant_at, grid, self.scale, self._receptances.twice)

    def twice(self, y: np.ndarray, other: HarmonicOrbits) -> np.ndarray:
        """The unknowns of one motion in the equations of twice its period."""
        c = self.coefficients(y)
        wide = np.zeros((other.grid.harmonics + 1, c.shape[1]), complex)
        wide[: 2 * len(c) - 1 : 2] = c
        return other.unknowns(wide)


def static_displacements(plant: Plant) -> np.ndarray:
    """Local displacements (m,) in the equilibrium of the mean laws."""
    from rotorgear.solvers.sparse.newton import local_equilibrium

    mean = plant.forces.mean
    static = plant.static

    def tangent(d: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        now = answered(np.zeros(1), d[None], np.zeros((1, d.size)), mean, plant.speed)
        return now.F[0], mean.matrix(now.Kd[0])

    found = local_equilibrium(static.d, static.R, plant.forces.reference_stiffness, tangent, extents=mean.extents)
    return np.asarray(found.d if found.converged else static.d)
