"""The matrices of a system as functions of speed, projected on a basis: M, D0 + W G, K0 + W K1, and tables of bearings.

Between two rows of any bearing's table everything is affine in the speed, so linear interpolation between the projected matrices
at these rows is exact. Stiffness is projected through its strains, so that soft modes keep their digits.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from rotorgear.solvers.eigen.reduced_pencil import Pencil
from rotorgear.system.assembly import assemble, strain_forms
from rotorgear.system.components import groups_with_inertia, independent_groups
from rotorgear.system.groups import ElementGroup
from rotorgear.system.planets import turning_carriers
from rotorgear.system.system import System

# Speeds between which what the loads of planets' pins have beyond the square of the speed is taken as linear: where the pins give
# by a hundredth of their circle, that leaves out 2e-4 of this load, and less than 1e-6 of a frequency.
PIN_LOADS = 9


class SpeedFamily:
    """The matrices of a system from the lowest to the highest speed of interest (rad/s, of one sign).

    Raises:
        AnalysisError: a speed outside a bearing's table.
    """

    def __init__(self, system: System, low: float, high: float) -> None:
        self.system = system
        beta = system.model.damping.rayleigh_beta
        self._constant = strain_forms(system.groups, system.dofs, 0.0, beta)
        self._per_speed = strain_forms(system.groups, system.dofs, 1.0, beta).circulation - self._constant.circulation
        self._per_square = self._square(system)
        self._ends = (low, high)
        self.knots = table_speeds(system, low, high)
        self._tables = [self._table(speed) for speed in self.knots]

    def _table(self, speed: float) -> tuple[sp.csc_array, sp.csc_array]:
        """Damping and stiffness of the bearings with tables at a speed, sparse (n, n)."""
        bearings = self.system.groups_of(float(speed))

        def whole(group: ElementGroup) -> np.ndarray | None:
            K = group.matrices.stiffness
            N = group.matrices.circulatory
            return K if N is None else N if K is None else K + N

        C = assemble(bearings, self.system.dofs, lambda g: g.matrices.damping)
        beta = self.system.model.damping.rayleigh_beta
        symmetric = assemble(bearings, self.system.dofs, lambda g: g.matrices.stiffness)
        return sp.csc_array(C + beta * symmetric), assemble(bearings, self.system.dofs, whole)

    def _square(self, system: System) -> sp.csr_array:
        """Growth of the modulus of all strains with the square of the reference speed, sparse (s, s)."""
        if not (system.nodes.bodies or turning_carriers(system.layout)):
            return sp.csr_array(self._constant.modulus.shape)
        growing = []
        for group in system.groups:
            S = group.matrices.modulus_per_square
            D = None if S is None else group.spin**2 * S
            growing.append(replace(group, matrices=replace(group.matrices, modulus=D)))
        return strain_forms(growing, system.dofs, 0.0, 0.0).modulus

    @cached_property
    def is_conservative(self) -> bool:
        """Whether nothing takes energy out or brings it in (no damping, cross-coupled or indefinite spring): s is imaginary."""
        forms = self._constant
        quiet = not (forms.viscosity.nnz or forms.circulation.nnz or self._per_speed.nnz)
        tables = all(not C.nnz and abs(K - K.T).max() == 0.0 for C, K in self._tables)
        alpha = self.system.model.damping.rayleigh_alpha
        speeds = [float(speed) for speed in (*self.knots, *(self._ends if self._per_square.nnz else ()))] or [0.0]
        return quiet and tables and not alpha and all(self.system.strain_factor(w) is not None for w in speeds)

    @cached_property
    def groups(self) -> list[np.ndarray]:
        """Dofs that act on each other at no speed and have inertia, largest group first."""
        forms = self._constant
        sizes = [abs(A) for A in (forms.modulus, forms.viscosity, forms.circulation, self._per_speed, self._per_square)]
        B = abs(forms.strain)
        strained = [sp.csc_array(B.T @ A @ B) for A in sizes if A.nnz]
        tables = [A for pair in self._tables for A in pair]
        found = independent_groups([self.system.mass, self.system.gyroscopic, *strained, *tables])
        return groups_with_inertia(self.system, found, self.system.damping(self._ends[0]))[0]

    def reduced(self, V: np.ndarray) -> Callable[[float], Pencil]:
        """M, D and K (r, r) over the speed in rad/s, in the coordinates of a basis V (n, r), real."""
        forms = self._constant
        strained = forms.strain @ V
        mass = V.T @ (self.system.mass @ V)
        gyroscopic = V.T @ (self.system.gyroscopic @ V)
        M = 0.5 * (mass + mass.T)
        G = 0.5 * (gyroscopic - gyroscopic.T)
        damping = strained.T @ (forms.viscosity @ strained) + self.system.model.damping.rayleigh_alpha * mass
        stiffness = strained.T @ (forms.modulus @ strained) + strained.T @ (forms.circulation @ strained)
        per_speed = strained.T @ (self._per_speed @ strained)
        # What centrifugal forces in gear bodies add grows with the square of the speed.
        per_square = strained.T @ (self._per_square @ strained) if self._per_square.nnz else None
        knots = self.knots
        tables = [[V.T @ (A @ V) for A in pair] for pair in self._tables]

        def at(speed: float) -> Pencil:
            D = damping + speed * G
            K = stiffness + speed * per_speed
            if per_square is not None:
                K = K + speed**2 * per_square
            if len(knots):
                right = int(np.clip(np.searchsorted(knots, speed), 1, len(knots) - 1))
                (C_a, K_a), (C_b, K_b) = tables[right - 1 : right + 1]
                share = (speed - knots[right - 1]) / (knots[right] - knots[right - 1])
                D = D + (1.0 - share) * C_a + share * C_b
                K = K + (1.0 - share) * K_a + share * K_b
            return Pencil(M, D, K)

        return at


def table_speeds(system: System, low: float, high: float) -> np.ndarray:
    """Reference speeds (k,) from `low` to `high` at which a table of a part has a kink; none without tables."""
    found: set[float] = set()
    sign = -1.0 if min(low, high) < 0.0 else 1.0
    for address, spring in system.state.springs.items():
        if not spring.varies:
            continue
        ratio = system.state.shaft_ratio(address)
        found |= {low, high}
        for row in spring.speeds if ratio else ():
            speed = sign * row / ratio
            if low < speed < high:
                found.add(float(speed))
    if turning_carriers(system.layout):
        # The load of a planet's pin grows a little faster than with the square of the speed.
        found |= set(np.linspace(low, high, PIN_LOADS).tolist())
    return merged(sorted(found), high - low)


def merged(speeds: Sequence[float], span: float) -> np.ndarray:
    """Ascending speeds without those that are the same but for rounding."""
    kept: list[float] = []
    for speed in speeds:
        if not kept or speed - kept[-1] > 1e-9 * abs(span):
            kept.append(speed)
    return np.array(kept)
