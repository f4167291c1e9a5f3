"""The joint quasi-static state: all loaded contacts of a gearbox together, at every position of their mesh cycles.

At a crawl the structure, linear but for its teeth, is in equilibrium at every position u of the cycle:

    K q + sum_i v_i F_i(v_i . q, u_i) = f,        F_i from the contact map of helix i.

Helices and branches share the load, so they are solved together. Reduced to the m contacts (solvers/sparse/newton.py):

    delta = delta_0 - A (F(delta, u) - k delta),   A = V^T (K + V k V^T)^-1 V,

for any k; whatever else of the structure is nonlinear has its tangents at the equilibrium. Contacts of one mesh frequency run
through one cycle. Of several frequencies there is no short common period: each cycle is taken for itself, with the other
contacts on the mean of their curves, delta_mean(F) over u.

Linear analyses are about the mean of this state. With k_i the mean tangent of contact i, what shakes it is

    f_i(u) = F_i(u) - k_i delta_i(u),

because k_i v_i . q + f_i then gives F_i(u) wherever the rest follows without inertia: exactly this state at a crawl.
H. N. Ozguven and D. R. Houser, Journal of Sound and Vibration 125 (1988) 71, for one mesh.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from rotorgear.analysis.static.solve import Equilibrated, equilibrate
from rotorgear.errors import AnalysisError, ConvergenceError
from rotorgear.model.layout.mean_load import MeshForce
from rotorgear.solvers.sparse.newton import Settled, settle
from rotorgear.system.system import System

if TYPE_CHECKING:
    from rotorgear.gears.loaded.contact_map import ContactMap

# Positions in a base pitch at least; a map that knows more is followed.
_POSITIONS = 128
# A curve F(delta) at one position is straight between so many points to each step of load of its map.
_FINER = 8
# Positions whose curves are made together.
_TOGETHER = 512
# Cycles of several pitches whose rows of the map agree to this share are solved once.
_ALIKE = 1e-10
# Mean state and tangents of nonlinear bearings agree when no mean force changes by more than this share of the largest.
_AGREED = 1e-9
_PASSES = 30


@dataclass(frozen=True)
class Cycle:
    """The joint state over the cycle of the contacts of one mesh frequency.

    Attributes:
        meshes: names of these meshes.
        ratio: mesh frequency in rad/s over the size of the reference speed.
        periods: base pitches after which it repeats.
        position: (p,) in base pitches from the time 0 on, evenly spaced over `periods`.
        approach: (p, c) delta of all contacts along the flank normal in m.
        force: (p, c) along the flank normal in N.
    """

    meshes: tuple[str, ...]
    ratio: float
    periods: int
    position: np.ndarray
    approach: np.ndarray
    force: np.ndarray


@dataclass(frozen=True)
class JointState:
    """The joint quasi-static state of all contacts.

    Attributes:
        cycles: one for each mesh frequency of loaded teeth.
        own: (c,) number of the cycle that a contact runs through; -1 of one without a contact map.
        force, approach: (c,) means over its own cycle, N and m along the flank normal; of a contact without map over the first.
        stiffness: (c,) mean tangent over its own cycle in N/m; of a contact without map its own.
        gap: (c,) index error of each contact in m.
        maps: (c,) contact maps, None without one.
        compliance: (c, c) approach of the contacts in m under a constant force of each mapped one in N, all being springs of
            these stiffnesses.
        pitch: (c,) base pitches past the pitch point of each contact at time 0; sense: (c,) +1 where it then runs up its map.
    """

    cycles: tuple[Cycle, ...]
    own: np.ndarray
    force: np.ndarray
    approach: np.ndarray
    stiffness: np.ndarray
    gap: np.ndarray
    maps: tuple[ContactMap | None, ...]
    compliance: np.ndarray
    pitch: np.ndarray
    sense: np.ndarray

    @property
    def start(self) -> list[float | None]:
        """In N: about its mean a contact with a map is F = start + k (delta - gap)."""
        F_0 = self.force - self.stiffness * (self.approach - self.gap)
        return [float(F) if own >= 0 else None for F, own in zip(F_0, self.own, strict=True)]

    def excitation(self, cycle: Cycle) -> np.ndarray:
        """f_i = F_i - k_i delta_i over a cycle, (p, c) in N, without its mean; 0 for contacts without a map."""
        f = cycle.force - self.stiffness * cycle.approach
        return np.where(self.own >= 0, f - f.mean(axis=0), 0.0)

    def no_load(self, cycle: Cycle) -> np.ndarray:
        """Approach (p, c) at first touch of the contacts that run through a cycle, in m without its mean; 0 for the others."""
        found = np.zeros_like(cycle.approach)
        for i, contact_map in enumerate(self.maps):
            if contact_map is not None and self.cycles[self.own[i]] is cycle:
                found[:, i] = contact_map.no_load(self.on_map(i, cycle.position))
        return np.asarray(found - found.mean(axis=0))

    def on_map(self, contact: int, position: np.ndarray) -> np.ndarray:
        """Place u on its map of a contact at positions of its cycle."""
        return np.asarray(self.sense[contact] * (self.pitch[contact] + position))


def over_cycle(equilibrium: Equilibrated, speed: float) -> tuple[Equilibrated, JointState | None]:
    """Return the equilibrium that is the mean of the joint state of the loaded teeth, and that state.

    Without loaded teeth (`stiffness = "tooth_fe"`) it is the one given, and there is no such state. A mesh that feels the tilt
    of its shafts stays linear about the load along its face.

    Args:
        equilibrium: with the contacts as springs, on the flanks that carry.
        speed: of the reference shaft in rad/s.

    Raises:
        AnalysisError: a position of the cycle has no equilibrium.
        ConvergenceError: mean state and nonlinear parts don't come to agree.
    """
    for _ in range(_PASSES):
        joint = joint_state(equilibrium)
        if joint is None:
            return equilibrium, None
        load = equilibrium.system.load.about_cycle(joint.force, joint.stiffness, joint.start)
        closed = np.where(joint.own >= 0, joint.force > 0.0, equilibrium.closed)
        settled = equilibrate(equilibrium.system.with_load(load), speed, closed)
        change = float(np.abs(settled.force - equilibrium.force).max())
        equilibrium = settled
        if not equilibrium.laws or change <= _AGREED * float(np.abs(settled.force).max()):
            return equilibrium, joint
    raise ConvergenceError(
        "The mean state of the loaded teeth and that of the nonlinear bearings and elements don't come to agree: give the "
        "stiffness of one of them as a number."
    )


def joint_state(equilibrium: Equilibrated) -> JointState | None:
    """Solve all contacts together over their cycles about an equilibrium; None where no contact has a map.

    Raises:
        AnalysisError: a position has no equilibrium.
    """
    load = equilibrium.system.load
    lines = equilibrium.lines
    maps = tuple(load.contact_map(state, near=True) for state in lines.states)
    if not any(maps):
        return None
    phases = [load.phase(state.contact) for state in lines.states]
    ratios = [
        _mesh_ratio(equilibrium.system, state) if map_ else -1.0 for state, map_ in zip(lines.states, maps, strict=True)
    ]
    frequencies = {round(ratio, 9): ratio for ratio in ratios if ratio >= 0.0}
    number = {key: g for g, key in enumerate(frequencies)}
    own = np.array([number.get(round(ratio, 9), -1) for ratio in ratios])
    problem = _Problem(
        equilibrium=equilibrium,
        maps=maps,
        gap=lines.gap,
        pitch=np.array([(phase or 0.0) / (2.0 * math.pi) for phase in phases]),
        sense=np.array([1.0 if state.pinion_drives else -1.0 for state in lines.states]),
    )
    cycles = tuple(problem.cycle(np.flatnonzero(own == g), ratio) for g, ratio in enumerate(frequencies.values()))
    at = np.maximum(own, 0)
    contacts = range(len(maps))
    stiffness = lines.stiffness.copy()
    for i, contact_map in enumerate(maps):
        if contact_map is not None:
            cycle = cycles[own[i]]
            u = problem.sense[i] * (problem.pitch[i] + cycle.position)
            stiffness[i] = contact_map.stiffness(cycle.approach[:, i] - problem.gap[i], u).mean()
    # A about other stiffnesses of the mapped contacts: A (1 + dk A_m)^-1.
    m = problem.mapped
    change = (stiffness - problem.stiffness)[m]
    compliance = np.zeros((len(maps), len(maps)))
    compliance[:, m] = problem.compliance @ np.linalg.inv(np.eye(len(m)) + change[:, None] * problem.compliance[m])
    return JointState(
        cycles=cycles,
        own=own,
        force=np.array([cycles[at[i]].force[:, i].mean() for i in contacts]),
        approach=np.array([cycles[at[i]].approach[:, i].mean() for i in contacts]),
        stiffness=stiffness,
        gap=problem.gap,
        maps=maps,
        compliance=compliance,
        pitch=problem.pitch,
        sense=problem.sense,
    )


def _mesh_ratio(system: System, state: MeshForce) -> float:
    """Mesh frequency over the speed of the reference shaft."""
    pinion = system.layout.mesh(state.contact.mesh).pinion
    return abs(system.train.ratio(pinion.shaft)) * (pinion.part.teeth or 0)


@dataclass(frozen=True)
class _Problem:
    """The contacts of an equilibrium, ready for any position; fields as in JointState."""

    equilibrium: Equilibrated
    maps: tuple[ContactMap | None, ...]
    gap: np.ndarray
    pitch: np.ndarray
    sense: np.ndarray

    @cached_property
    def mapped(self) -> np.ndarray:
        """Numbers (m,) of the contacts that have a map."""
        return np.array([i for i, contact_map in enumerate(self.maps) if contact_map is not None])

    @cached_property
    def stiffness(self) -> np.ndarray:
        """k (c,) about which the structure is solved: that of the equilibrium, 0 where it is open."""
        return np.where(self.equilibrium.closed, self.equilibrium.lines.stiffness, 0.0)

    @cached_property
    def spring_start(self) -> np.ndarray:
        """F (c,) in N of the contacts where their flanks have not approached, as springs."""
        return np.where(self.equilibrium.closed, self.equilibrium.lines.start, 0.0)

    @cached_property
    def compliance(self) -> np.ndarray:
        """A (c, m): approach of all contacts under unit forces of the mapped ones, with all contacts as springs k."""
        V = self.equilibrium.lines.vectors
        return np.asarray(V.T @ self.equilibrium.solver.solve(V[:, self.mapped], carried=True))

    @cached_property
    def start(self) -> np.ndarray:
        """delta_0 (c,) under the loads with the mapped contacts F = k delta."""
        found = self.equilibrium.lines.vectors.T @ self.equilibrium.q
        k = self.stiffness[self.mapped]
        return np.asarray(found + self.compliance @ (self.equilibrium.force[self.mapped] - k * found[self.mapped]))

    def cycle(self, running: np.ndarray, ratio: float) -> Cycle:
        """Solve one cycle: the contacts `running` go through it, the others stay on the mean of their curves."""
        maps = [contact_map for i in running if (contact_map := self.maps[i]) is not None]
        periods = math.lcm(*(contact_map.periods for contact_map in maps))
        count = max(_POSITIONS, *(len(contact_map.position) // contact_map.periods for contact_map in maps))
        position = np.arange(count * periods) / count if ratio else np.zeros(1)
        tables = [self._table(int(i), position, i in running) for i in self.mapped]
        key = np.hstack([np.round(table.approach / (_ALIKE * np.ptp(table.approach))) for table in tables])
        _, first, which = np.unique(key, axis=0, return_index=True, return_inverse=True)
        k = self.stiffness[self.mapped]
        approach = np.zeros((len(first), len(self.maps)))
        force = np.zeros((len(first), len(self.maps)))
        for row, p in enumerate(first):
            if row % _TOGETHER == 0:
                curves = [table.curves(first[row : row + _TOGETHER]) for table in tables]
            found = self._at([one[row % _TOGETHER] for one in curves])
            if not found.converged:
                names = ", ".join(dict.fromkeys(self.equilibrium.lines.names))
                raise AnalysisError(
                    f"meshes {names}: the loaded teeth have no equilibrium {position[p]:.3f} base pitches into their cycle; "
                    "look for a helix that hardly carries"
                )
            approach[row] = self.start - self.compliance @ (found.force - k * found.d)
            force[row] = self.spring_start + self.stiffness * (approach[row] - self.gap)
            force[row, self.mapped] = found.force
            approach[row, self.mapped] = found.d
        meshes = dict.fromkeys(self.equilibrium.lines.names[i] for i in running)
        again = which.ravel()
        return Cycle(tuple(meshes), ratio, periods, position, approach[again], force[again])

    def _at(self, curves: list[_Curve]) -> Settled:
        """Equilibrium of the mapped contacts on the curves of one position."""
        k = self.stiffness[self.mapped]

        def laws(delta: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            pairs = [curve.force(float(x)) for curve, x in zip(curves, delta, strict=True)]
            F, tangent = np.array(pairs).T
            return F, np.diag(tangent)

        return settle(self.start[self.mapped], self.compliance[self.mapped], np.diag(k), laws)

    def _table(self, contact: int, position: np.ndarray, runs: bool) -> _Table:
        """The map of a contact at the positions of a cycle, or its mean over the map."""
        contact_map = self.maps[contact]
        assert contact_map is not None
        loads = np.append(contact_map.load, 10.0 * contact_map.largest_load)
        if runs:
            u = self.sense[contact] * (self.pitch[contact] + position)
            rows = contact_map.approach_at(loads, u[:, None])
        else:
            mean = contact_map.approach_at(loads, contact_map.position[:, None]).mean(axis=0)
            u = None
            rows = np.broadcast_to(mean, (len(position), len(loads)))
        return _Table(contact_map, u, rows, float(self.gap[contact]))


@dataclass(frozen=True)
class _Table:
    """A contact over the p positions of a cycle.

    Attributes:
        contact_map: its map.
        place: (p,) places u on it; None where the mean of the map holds.
        approach: (p, l) at the loads of the map and one far above.
        gap: index error in m.
    """

    contact_map: ContactMap
    place: np.ndarray | None
    approach: np.ndarray
    gap: float

    def curves(self, positions: np.ndarray) -> list[_Curve]:
        """F(delta) at some positions (r,), given by their numbers."""
        steps = np.arange(_FINER) / _FINER
        load = self.contact_map.load
        fine = np.append((load[:-1, None] + np.diff(load)[:, None] * steps).ravel(), load[-1])
        far = 10.0 * load[-1]
        if self.place is None:
            everywhere = self.contact_map.position
            approach = self.contact_map.curves(fine, everywhere).mean(axis=0)
            beyond = self.contact_map.approach_at(far, everywhere).mean()
            return [_Curve(self.gap + np.append(approach, beyond), np.append(fine, far))] * len(positions)
        u = self.place[positions]
        beyond = self.contact_map.approach_at(far, u)
        approach = np.column_stack([self.contact_map.curves(fine, u), beyond])
        return [_Curve(self.gap + row, np.append(fine, far)) for row in approach]


@dataclass(frozen=True)
class _Curve:
    """F(delta) of a contact at one position, straight between points: approach (n,) in m, rising, and load (n,) in N."""

    approach: np.ndarray
    load: np.ndarray

    def force(self, delta: float) -> tuple[float, float]:
        """Force in N and tangent in N/m at an approach."""
        if delta <= self.approach[0]:
            return 0.0, 0.0
        i = min(int(np.searchsorted(self.approach, delta)), len(self.load) - 1)
        slope = float((self.load[i] - self.load[i - 1]) / (self.approach[i] - self.approach[i - 1]))
        return float(self.load[i - 1]) + slope * (delta - float(self.approach[i - 1])), slope
