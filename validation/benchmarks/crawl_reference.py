"""What a crawl is compared with: the quasi-static state of loaded teeth, from the contacts themselves and no map.

A lone mesh carries the force of the torque. Where its shafts tilt its flanks, tilt and moment agree at each position. Helices and
branches share the load: about any equilibrium (F_0, delta_0) a linear structure has

    delta - delta_0 = -A [F - F_0 - k (delta - delta_0)],

A being its compliance with springs k in the contacts, and each position is solved for the forces by Newton's method with the
approach delta_i(F_i) of its contacts and their tangents.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from scipy.interpolate import BarycentricInterpolator

import rotorgear as rg
from rotorgear.analysis.static.joint_state import JointState
from rotorgear.analysis.static.mean_state import Setup, mean_state
from rotorgear.errors import ConvergenceError
from rotorgear.gears.loaded.loaded_contact import PositionContact, solve_contact
from rotorgear.gears.loaded.mesh_cycle import MeshCycle, mesh_cycle
from rotorgear.gears.loaded.tooth_contact import ContactProblem, contact_problem
from rotorgear.gears.stiffness.mesh_stiffness import ToothPair
from rotorgear.system.system import System

HARMONICS = 5
ODD = 1  # the tooth with the pitch error
# Base pitches about the odd tooth that are their own.
NEAR = 4.5
# Newton's method rests where no force changes by more than this share of the largest.
ROUNDS = 30
RESTING = 1e-8


@dataclass(frozen=True)
class Curves:
    """What a contact does over its cycle of whole base pitches.

    Attributes:
        periods: base pitches in the cycle. values: (p, c) in m, transverse, evenly spaced over it.
        force: (c,) mean forces along the flank normal in N.
        lone: whether they are transmission errors of a lone mesh, and not approaches.
        teeth: (c,) whether the contact is of loaded teeth, and not a spring.
    """

    periods: int
    values: np.ndarray
    force: np.ndarray
    lone: bool
    teeth: np.ndarray

    @property
    def harmonics(self) -> np.ndarray:
        """Amplitudes (k, 5, c) of the orders of the mesh, and where teeth differ of their shaft."""
        return lines_of(self.values, self.periods)

    @property
    def peak_to_peak(self) -> np.ndarray:
        """(c,) in m."""
        return np.asarray(np.ptp(self.values, axis=0))


def lines_of(values: np.ndarray, periods: int) -> np.ndarray:
    """Amplitudes (k, 5, c) in values (p, c) over a cycle of so many periods: mesh, and shaft where they are more than one."""
    spectrum = 2.0 * np.abs(np.fft.rfft(values, axis=0)) / len(values)
    mesh = spectrum[periods : (HARMONICS + 1) * periods : periods]
    return np.stack([mesh, spectrum[1 : HARMONICS + 1]] if periods > 1 else [mesh])


def reference(model: rg.Model, positions: int) -> Curves:
    """The loaded contact at the force of a lone mesh; of several contacts their joint state.

    Args:
        model: at a crawl.
        positions: in a base pitch.
    """
    force = np.asarray(rg.static(model).mesh_force)
    if len(model.torque_flow(1).forces) > 1:
        return joint(model, force, positions)
    if any(mesh.tilt for mesh in model.meshes.values()):
        return coupled(model, force, positions)
    return Curves(*contact(model, positions), force, lone=True, teeth=np.ones(1, bool))


def contact(model: rg.Model, positions: int) -> tuple[int, np.ndarray]:
    """Periods of the cycle, and transmission error (p, 1) of the loaded contact of a lone mesh without any map."""
    (state,) = model.torque_flow(1).forces
    mesh = model.layout.mesh(state.contact.mesh)
    load = state.normal_force * np.cos(state.contact.base_helix_angle)
    problem = contact_problem(mesh.helix_teeth(0, state.torque_sense))
    return over_periods(problem, lambda number: alone(problem, load, number, positions).deflection[:, None])


def alone(problem: ContactProblem, load: float, number: int, positions: int) -> MeshCycle:
    """The contact over a base pitch, given by its number."""
    return mesh_cycle(problem, load, number + np.arange(positions) / positions)


def over_periods(problem: ContactProblem, period: Callable[[int], np.ndarray]) -> tuple[int, np.ndarray]:
    """Base pitches of the cycle, and values over all of them from those (p, c) of a base pitch by its number."""
    if not any(flank.single_teeth for flank in problem.flanks):
        return 1, period(0)
    # Some pitches before and behind the odd tooth are their own; all others are alike.
    periods = problem.teeth[0]
    own = {number % periods: period(number % periods) for number in range(ODD - 3, ODD + 4)}
    alike = period(periods // 2)
    return periods, np.concatenate([own.get(number, alike) for number in range(periods)])


def coupled(model: rg.Model, force: np.ndarray, positions: int) -> Curves:
    """Approach of a lone spur mesh whose shafts tilt its flanks: at each position tilt and moment agree.

    The shafts are linear, tilt = tilt_0 + a M at the force of the torque. Approach and moment of the contact over the tilt come
    from contacts solved at five misalignments, by the polynomial through them.
    """
    (cycle,) = joint_of(about_mean(model)).cycles
    a, tilt_0 = np.polyfit(cycle.moment[:, 0], cycle.tilt[:, 0], 1)
    low, high = cycle.tilt[:, 0].min(), cycle.tilt[:, 0].max()
    tilts = 0.5 * (low + high) + 0.75 * (high - low) * np.cos(np.pi * (np.arange(5) + 0.5) / 5)
    (state,) = model.torque_flow(1).forces
    mesh = model.layout.mesh(state.contact.mesh)
    teeth = mesh.working_teeth(state.torque_sense)
    problems = [contact_problem(replace(teeth, misalignment=teeth.misalignment - teeth.width * tilt)) for tilt in tilts]

    def period(number: int) -> np.ndarray:
        cycles = [alone(problem, float(force[0]), number, positions) for problem in problems]
        moment = BarycentricInterpolator(tilts, np.stack([one.moment for one in cycles]))
        approach = BarycentricInterpolator(tilts, np.stack([one.deflection for one in cycles]))
        tilt = np.full(positions, 0.5 * (low + high))
        each = np.arange(positions)
        h = 1e-4 * (high - low)
        for _ in range(8):  # Newton's method, each position for itself
            left = tilt - tilt_0 - a * moment(tilt)[each, each]
            slope = 1.0 - a * (moment(tilt + h)[each, each] - moment(tilt - h)[each, each]) / (2.0 * h)
            tilt = tilt - left / slope
        return np.asarray(approach(tilt)[each, each])[:, None]

    periods, values = over_periods(problems[0], period)
    return Curves(periods, values, force, lone=False, teeth=np.ones(1, bool))


def about_mean(model: rg.Model) -> Setup:
    """The model about the mean state of its loaded teeth."""
    assert model.operation is not None
    load = model.torque_flow(1).of_kind("static")
    return mean_state(System(model, state=load), float(model.operation.speed or 0.0))


def joint_of(setup: Setup) -> JointState:
    """The joint state of the loaded teeth."""
    assert setup.joint is not None
    return setup.joint


def joint(model: rg.Model, force: np.ndarray, positions: int) -> Curves:
    """Approach of all contacts in their joint state, from the contacts themselves at each position.

    Mean state, compliance of the structure and phases of the contacts are those of the analyses.
    """
    setup = about_mean(model)
    state = joint_of(setup)
    (cycle,) = state.cycles
    own = np.flatnonzero(state.own >= 0)
    pitches, which = solved_pitches(state, own, cycle.periods)
    position = (pitches[:, None] + np.arange(positions) / positions).ravel()
    contacts = []
    for i in own:
        helix = setup.lines.states[i]
        teeth = model.layout.mesh(helix.contact.mesh).helix_teeth(helix.contact.helix, helix.torque_sense)
        u = state.sense[i] * (state.pitch[i] + position)
        contacts.append(contacts_at(teeth, u, float(cycle.force[:, i].max()) * np.cos(helix.contact.base_helix_angle)))
    structure = Structure.about_mean(state, own)
    number = np.round(position * len(cycle.position) / cycle.periods).astype(int) % len(cycle.position)
    carried = np.array(
        [structure.settled([one[p] for one in contacts], cycle.force[n, own]) for p, n in enumerate(number)]
    )
    moved = carried[:, 0] - structure.force - structure.stiffness * (carried[:, 1] - structure.approach)
    approach = state.approach - moved @ state.compliance[:, own].T
    cosine = np.cos([helix.contact.base_helix_angle for helix in setup.lines.states])
    values = (approach / cosine).reshape(len(pitches), positions, -1)[which]
    return Curves(cycle.periods, values.reshape(cycle.periods * positions, -1), force, False, state.own >= 0)


def solved_pitches(state: JointState, own: np.ndarray, periods: int) -> tuple[np.ndarray, np.ndarray]:
    """Base pitches that are solved, by number, and which of them (periods,) each base pitch of the cycle is like.

    Those in which the odd tooth may touch in some contact are their own; all others are alike.
    """
    if periods == 1:
        return np.zeros(1, int), np.zeros(1, int)
    middle = state.sense[own] * (state.pitch[own] + np.arange(periods)[:, None] + 0.5)
    distance = np.abs(np.mod(middle - ODD + 0.5 * periods, periods) - 0.5 * periods)
    near = np.any(distance < NEAR, axis=1)
    pitches = np.append(np.flatnonzero(near), np.flatnonzero(~near)[0])
    which = np.full(periods, len(pitches) - 1)
    which[near] = np.arange(near.sum())
    return pitches, which


def contacts_at(teeth: ToothPair, place: np.ndarray, load: float) -> list[PositionContact]:
    """The contact at places (p,) of the path of contact, with patches for F_bt = load (N)."""
    problem = contact_problem(teeth)
    odd = any(flank.single_teeth for flank in problem.flanks)
    # Without odd teeth places a base pitch apart are alike.
    found, again = np.unique(np.round(place if odd else np.mod(place, 1.0), 9), return_inverse=True)
    cycle = solved_cycle(teeth, tuple(found.tolist()), float(f"{load:.3g}"))
    return [cycle.contacts[p] for p in again]


@lru_cache(maxsize=4)
def solved_cycle(teeth: ToothPair, place: tuple[float, ...], load: float) -> MeshCycle:
    """Kept for helices that have the same teeth and places."""
    return mesh_cycle(contact_problem(teeth), load, np.array(place))


@dataclass(frozen=True)
class Structure:
    """What joins m contacts: an equilibrium, and the compliance A (m, m) about springs k in them; (m,) in N, m, N/m and m/N."""

    force: np.ndarray
    approach: np.ndarray
    gap: np.ndarray
    stiffness: np.ndarray
    compliance: np.ndarray

    @classmethod
    def about_mean(cls, state: JointState, own: np.ndarray) -> Structure:
        """About the mean of a joint state."""
        every = (state.force, state.approach, state.gap, state.stiffness)
        return cls(*(one[own] for one in every), state.compliance[np.ix_(own, own)])

    def settled(self, contacts: list[PositionContact], start: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Forces (m,) and approaches (m,) of contacts in equilibrium with the structure.

        Raises:
            ConvergenceError: Newton's method doesn't come to rest.
        """
        F = start.copy()
        for _ in range(ROUNDS):
            states = [solve_contact(contact, float(load)) for contact, load in zip(contacts, F, strict=True)]
            delta = np.array([one.approach for one in states]) + self.gap
            softness = np.diag([1.0 / one.tangent for one in states])
            left = delta - self.approach
            left = left + self.compliance @ (F - self.force - self.stiffness * left)
            slope = softness + self.compliance @ (np.eye(len(F)) - self.stiffness[:, None] * softness)
            step = np.linalg.solve(slope, left)
            if np.abs(step).max() <= RESTING * np.abs(F).max():
                return F, delta
            F = F - step
        raise ConvergenceError("The joint state of the contacts does not come to rest.")
