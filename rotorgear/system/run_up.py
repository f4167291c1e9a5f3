"""Run-ups of planets that go round: what changes with the speed of their carriers beside W G, and what accelerates them.

In axes of the planets' own, whose carrier turns with W(t), the accelerations of r e + p are

    p'' + 2 W S p' + (W^2 S S + W' S) (r e + p),

and taken at the directions that the pins had at the start, with D = S - T in place of S (`system/planets.py`). So M has beside it

* -W^2 S S r M e, the centrifugal load outwards, and -W' r M S e onwards, by which its pin takes a planet along;
* W' M D in the stiffness, half of what 2 W M D grows by in the damping;
* K_g and all else of `System.of_carriers` at the speed of the moment.

The angle of the carrier is that of its prescribed speed. As everywhere in motions in time, what accelerates the prescribed turn
of a shaft acts on this shaft itself; the carrier's has N m r^2 beside its own inertia. Terms of the tilt of a rotor whose spin is
accelerated, I_p w' times the tilt, are left out, as for all shafts.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from rotorgear.solvers.time.contact_equilibrium import free_motions
from rotorgear.solvers.time.local_system import LocalSystem
from rotorgear.system.assembly import assemble
from rotorgear.system.loads import centrifugal_loads, orbit_loads
from rotorgear.system.system import System

# Speeds, evenly in their squares, at which the balance of loads is found; between them it is linear.
_BALANCES = 9


def on_rigid_train(local: LocalSystem, rigid: np.ndarray, loads: np.ndarray) -> np.ndarray:
    """What loads (n, k) need to do the work on free motions that they do on the rigid motions (n, r) next to them, (n, k).

    Planets that the centrifugal load has moved outwards go round on a larger circle, so that the free motions of the linear
    matrices are not quite those of the train's ratios: torques that balance would drive them on.
    """
    R = free_motions(local.M, local.stiffness_about)
    if not R.shape[1]:
        return np.zeros_like(loads)
    weighted = rigid.T @ local.M
    next_to = rigid @ np.linalg.solve(weighted @ rigid, weighted @ R)
    return np.asarray(local.M @ (R @ ((next_to - R).T @ loads)))


@dataclass(frozen=True)
class Carried:
    """What carriers bring at the speed of the moment.

    Attributes:
        system: the model. local: with its matrices at one speed, without `changes`, and the load that does not change.
        stiffness: (n, n), of it what does not change.
        rigid: motions (n, r) of the train without strain.
        squares: range of the squares of the speed in rad^2/s^2.
    """

    system: System
    local: LocalSystem
    stiffness: sp.csc_array
    rigid: np.ndarray
    squares: tuple[float, float]

    def at(self, speed: float, acceleration: float) -> tuple[sp.csc_array, np.ndarray]:
        """Stiffness (n, n) and constant load (n,) at a speed of the reference in rad/s and an acceleration in rad/s^2."""
        squares, balances = self._balances
        low = int(np.clip(np.searchsorted(squares, speed**2, side="right") - 1, 0, max(len(squares) - 2, 0)))
        balance = balances[low]
        if len(squares) > 1:
            share = (speed**2 - squares[low]) / (squares[low + 1] - squares[low])
            balance = balance + share * (balances[low + 1] - balance)
        load = self.local.load + balance @ (1.0, speed**2, acceleration)
        return sp.csc_array(self._stiffness(speed) + 0.5 * acceleration * self._gyroscopic), load

    def _stiffness(self, speed: float) -> sp.csc_array:
        groups = self.system.of_carriers(speed)
        K = assemble(groups, self.system.dofs, lambda g: g.matrices.stiffness)
        return sp.csc_array(self.stiffness + K + assemble(groups, self.system.dofs, lambda g: g.circulatory_at(speed)))

    @cached_property
    def _gyroscopic(self) -> sp.csc_array:
        """2 M D of all planets, (n, n), for unit speed of the reference."""
        return assemble(
            self.system.of_carriers(0.0),
            self.system.dofs,
            lambda g: None if g.matrices.gyroscopic is None else g.spin * g.matrices.gyroscopic,
        )

    @cached_property
    def _balances(self) -> tuple[np.ndarray, np.ndarray]:
        """Squares of the speed (k,), and what the constant, the centrifugal and the accelerating load need there, (k, n, 3)."""
        T = self.system.dofs.transform
        columns = (centrifugal_loads(self.system, 1.0), orbit_loads(self.system))
        loads = np.column_stack([self.local.load, *(T.T @ column for column in columns)])
        squares = np.unique(np.linspace(*self.squares, _BALANCES))
        there = [replace(self.local, K=self._stiffness(float(np.sqrt(square)))) for square in squares]
        return squares, np.array([on_rigid_train(local, self.rigid, loads) for local in there])
