"""Loaded tooth contact of one helix over the mesh cycle: positions, slices, compliance of all of them, and the sweep.

Transmission error and stiffness are transverse, along the line of action: k = F_bt / (delta - delta_0), delta_0 being the one
without load; the tangent stiffness is its derivative dF_bt / d delta at the load.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np

from rotorgear.gears.loaded.contact_points import MOST_BEYOND, OF_SLICES, Slices, contact_slices
from rotorgear.gears.loaded.loaded_contact import ContactState, PositionContact, moment_and_tangents
from rotorgear.gears.loaded.patched_contacts import PASSES, patched_contacts
from rotorgear.gears.loaded.tooth_contact import ContactProblem, contact_problem
from rotorgear.gears.stiffness.mesh_stiffness import ToothPair
from rotorgear.progress import Progress, part_of, silent

_kept_problem = lru_cache(maxsize=8)(contact_problem)


def loaded_cycle(
    teeth: ToothPair, load: float, positions: np.ndarray, progress: Progress = silent
) -> tuple[ContactProblem, MeshCycle]:
    """Loaded contact of one helix at positions u (p,) for F_bt = load (N); the compliance comes first."""
    # The compliance takes most of the time. It is computed here, with progress, and kept by its own key; the
    # second call only puts the problem together, and keeps it by the teeth alone (a listener is no key).
    contact_problem(teeth, part_of(progress, 0.0, 0.8))
    problem = _kept_problem(teeth)
    return problem, mesh_cycle(problem, load, positions, part_of(progress, 0.8, 1.0))


# They are followed a little farther than they touch, so that the next pass does not ask for more.
_MORE_BEYOND = 1.05
# Passes for the reach of corners.
_PASSES = 12
# The reach of corners is found at each eighth position first.
_STRIDE = 8
# Above such a pressure (Pa) no gear steel stays elastic.
_MOST_PRESSURE = 4e9
# First guesses: the load is spread over two thirds of the face, and the teeth give way as one pair of 8 N/(mm um) would.
_FIRST_PEAK = 1.5
_FIRST_STIFFNESS = 8e9


# Arrays of a cycle with one entry for each position, and for each slice.
_BY_POSITION = ("position", "deflection", "no_load", "tangent", "moment", "along_face")
_BY_SLICE = ("force", "strip", "pressure", "opening", "patch")


@dataclass(frozen=True)
class MeshCycle:
    """Loaded contact at p positions of a mesh cycle of one helix.

    Attributes:
        position: (p,) u in base pitches; pair k touches at u + k from the pitch point, in the middle of the face.
        load: F_bt (N) of this helix.
        deflection: delta (p,), transmission error under load along the line of action (m).
        no_load: delta_0 (p,), transmission error without load (m).
        tangent: (p,) dF_bt / d delta (N/m).
        moment: (p,) M (N m) of the normal forces about the middle of the face, sum F_i z_i.
        along_face: (p, 2, 2) d(F, M)/d(approach, tilt) along the flank normal (N/m, N, N m), for a tilt (m/m) that opens the
            flanks at larger z.
        slices: the slices of all positions.
        force: (n,) along the flank normal (N).
        strip: (n,) half-widths of the contact (m).
        pressure: (n,) largest Hertz pressure (Pa).
        residual: largest violation of the contact conditions (m).
        opening: (n,) of the flanks under load along their normal (m); of slices that carry less than nothing: the overlap
            C_jj F_j that their force takes away.
        contacts: (p,) the contact at each position, its slices in the order of `slices`.
        states: (p,) its solution.
        patch: (n,) least half-widths of the patches in normal modules.
        beyond: how far corner contacts were followed before the start and after the end (m).
        warnings: sentences.
    """

    position: np.ndarray
    load: float
    deflection: np.ndarray
    no_load: np.ndarray
    tangent: np.ndarray
    moment: np.ndarray
    along_face: np.ndarray
    slices: Slices
    force: np.ndarray
    strip: np.ndarray
    pressure: np.ndarray
    residual: float
    opening: np.ndarray
    contacts: tuple[PositionContact, ...]
    states: tuple[ContactState, ...]
    patch: np.ndarray
    beyond: tuple[float, float]
    warnings: tuple[str, ...] = ()

    @property
    def secant(self) -> np.ndarray:
        """k(u) in N/m, (p,)."""
        return np.asarray(self.load / (self.deflection - self.no_load))

    def share_by_pair(self) -> dict[int, np.ndarray]:
        """Share (p,) of each tooth pair in the load."""
        forces = {}
        for k in np.unique(self.slices.pair):
            of_pair = self.slices.pair == k
            forces[int(k)] = np.bincount(self.slices.position[of_pair], self.force[of_pair], len(self.position))
        total = sum(forces.values(), np.zeros(len(self.position)))
        return {k: value / total for k, value in forces.items()}

    @property
    def weight(self) -> np.ndarray:
        """Share (p,) of the cycle that each position stands for: half of the intervals beside it."""
        u = self.position
        period = np.floor(u[-1] - u[0]) + 1.0
        width = np.diff(u, append=u[0] + period)
        return np.asarray(0.5 * (width + np.roll(width, 1)) / period)

    @property
    def contact_ratio(self) -> float:
        """Mean number of tooth pairs that carry load."""
        return float(sum(self.weight @ (share > 0.0) for share in self.share_by_pair().values()))

    def chosen(self, numbers: np.ndarray) -> MeshCycle:
        """The cycle at some of its positions alone, numbers (m,) rising."""
        new = np.full(len(self.position), -1)
        new[numbers] = np.arange(len(numbers))
        here = np.flatnonzero(new[self.slices.position] >= 0)
        slices = self.slices.take(here)
        arrays: dict[str, Any] = {name: getattr(self, name)[numbers] for name in _BY_POSITION}
        arrays |= {name: getattr(self, name)[here] for name in _BY_SLICE}
        return replace(
            self,
            **arrays,
            slices=replace(slices, position=new[slices.position]),
            contacts=tuple(self.contacts[i] for i in numbers),
            states=tuple(self.states[i] for i in numbers),
        )


def mesh_cycle(problem: ContactProblem, load: float, positions: np.ndarray, progress: Progress = silent) -> MeshCycle:
    """Solve the contact at all positions for F_bt = load (N) on this helix.

    Raises:
        WideContactError: a load under which the contact is no line any more.
        ConvergenceError: a position has no solution to the tolerance.
    """
    reach = None if len(positions) < 2 * _STRIDE else corner_reach(problem, load, positions[::_STRIDE])
    return _followed(problem, load, positions, reach, progress)


def corner_reach(problem: ContactProblem, load: float, positions: np.ndarray) -> tuple[float, float]:
    """How far corners touch before the start and after the end (m) for F_bt = load (N), as some positions tell it."""
    return _followed(problem, load, positions, None, silent, passes=1).beyond


def with_more(problem: ContactProblem, cycle: MeshCycle, positions: np.ndarray) -> MeshCycle:
    """The cycle with more positions (m,), solved with slices as far beyond the line of action as those that are there."""
    widest = float(cycle.patch.max())
    more = _swept(problem, cycle.load, positions, cycle.beyond, silent, PASSES, widest)
    wanted = beyond_line(problem, float((more.deflection - more.no_load).max()) + problem.largest_gap)
    wider = problem.oblique and more.patch.max() > widest
    if wider or any(np.array(wanted) > cycle.beyond):
        # Rare, since a little more was followed than touched: all positions get the same reach, and oblique lines one width.
        farther = (max(cycle.beyond[0], _MORE_BEYOND * wanted[0]), max(cycle.beyond[1], _MORE_BEYOND * wanted[1]))
        every = np.sort(np.concatenate([cycle.position, positions]))
        return _swept(problem, cycle.load, every, farther, silent, PASSES)
    return _joined(cycle, more)


def _joined(first: MeshCycle, second: MeshCycle) -> MeshCycle:
    """Positions of both, in their order."""
    order = np.argsort(np.concatenate([first.position, second.position]), kind="stable")
    rank = np.empty(len(order), int)
    rank[order] = np.arange(len(order))
    number = rank[np.concatenate([first.slices.position, len(first.position) + second.slices.position])]
    here = np.argsort(number, kind="stable")

    def both(one: Any, other: Any, name: str, chosen: np.ndarray, axis: int = 0) -> Any:
        return np.take(np.concatenate([getattr(one, name), getattr(other, name)], axis=axis), chosen, axis=axis)

    arrays = {name: both(first, second, name, order) for name in _BY_POSITION}
    arrays |= {name: both(first, second, name, here) for name in _BY_SLICE}
    slices = {name: both(first.slices, second.slices, name, here) for name in OF_SLICES} | {"position": number[here]}
    contacts = first.contacts + second.contacts
    states = first.states + second.states
    return replace(
        first,
        **arrays,
        slices=replace(first.slices, **slices, roll=both(first.slices, second.slices, "roll", here, axis=1)),
        residual=max(first.residual, second.residual),
        contacts=tuple(contacts[i] for i in order),
        states=tuple(states[i] for i in order),
        warnings=tuple(dict.fromkeys(first.warnings + second.warnings)),
    )


def _followed(
    problem: ContactProblem,
    load: float,
    positions: np.ndarray,
    beyond: tuple[float, float] | None,
    progress: Progress,
    passes: int = PASSES,
) -> MeshCycle:
    """The cycle with corners followed as far as they touch, but not much farther: slices that never touch cost time.

    `beyond` is how far they are followed at first; None: as for a typical stiffness, a guess that spares passes.
    """
    if beyond is None:
        beyond = beyond_line(problem, _FIRST_PEAK * load / (_FIRST_STIFFNESS * problem.width) + problem.largest_gap)
    for _ in range(_PASSES):
        cycle = _swept(problem, load, positions, beyond, progress, passes)
        wanted = beyond_line(problem, float((cycle.deflection - cycle.no_load).max()) + problem.largest_gap)
        near = all(have <= _MORE_BEYOND**2 * want for have, want in zip(beyond, wanted, strict=True))
        if near and all(np.array(wanted) <= beyond):
            break
        beyond = (_MORE_BEYOND * wanted[0], _MORE_BEYOND * wanted[1])
    return cycle


def beyond_line(problem: ContactProblem, approach: float) -> tuple[float, float]:
    """How far corners can touch for an approach along the line of action: there the gap has become as large."""
    grid = np.linspace(0.0, MOST_BEYOND * problem.line.base_pitch, 401)

    def reach(gear: int) -> float:
        wide = problem.line.corner(gear, grid)[0] >= approach
        return float(grid[np.argmax(wide)]) if wide.any() else float(grid[-1])

    return reach(1), reach(0)  # the gear's tip before the start, the pinion's after the end


def _swept(
    problem: ContactProblem,
    load: float,
    positions: np.ndarray,
    beyond: tuple[float, float],
    progress: Progress,
    passes: int,
    least: float = 0.0,
) -> MeshCycle:
    """One sweep over all positions; passes: for the widths of patches at most; least: of oblique lines, in normal modules."""
    cosine = problem.cosine
    slices = contact_slices(problem.line, positions, problem.width, problem.slices, beyond, stations=problem.uncoupled)
    found = patched_contacts(problem, slices, problem.gap(slices), load / cosine, progress, passes=passes, least=least)
    states = found.states
    force = np.concatenate([state.force for state in states])
    strip = np.concatenate([state.strip for state in states])
    place = slices.z @ slices.weight
    along = [
        moment_and_tangents(contact, state, place[slices.at(i)])
        for i, (contact, state) in enumerate(zip(found.contacts, states, strict=True))
    ]

    # Hertz: p_0 = 2 F' / (pi a). Along the line of action delta = delta_n / cos b_b and F_bt = F_n cos b_b.
    line_load = force * cosine / slices.length
    pressure = np.where(force > 0.0, 2.0 * line_load / (np.pi * np.maximum(strip, 1e-300)), 0.0)
    # Approach (p,) along the normal at which the first place of any slice touches, without load.
    no_load = np.full(len(positions), np.inf)
    np.minimum.at(no_load, slices.position, problem.gap_along(slices).min(axis=1))
    return MeshCycle(
        position=positions,
        load=load,
        deflection=np.array([state.approach for state in states]) / cosine,
        no_load=no_load / cosine,
        tangent=np.array([state.tangent for state in states]) * cosine**2,
        moment=np.array([moment for moment, _ in along]),
        along_face=np.array([tangents for _, tangents in along]),
        slices=slices,
        force=force,
        strip=strip,
        pressure=pressure,
        residual=max(state.residual for state in states),
        opening=np.concatenate([_opening(*one) for one in zip(found.contacts, states, strict=True)]),
        contacts=found.contacts,
        states=states,
        patch=found.patch,
        beyond=beyond,
        warnings=_notes(problem, slices, force, pressure, beyond),
    )


def _opening(contact: PositionContact, state: ContactState) -> np.ndarray:
    """Opening (n,) of the slices at one position, and less than nothing where they carry."""
    opening = contact.compliance @ state.force + contact.gap - state.approach
    return np.where(state.force > 0.0, -np.diag(contact.compliance) * state.force, opening)


def _notes(
    problem: ContactProblem, slices: Slices, force: np.ndarray, pressure: np.ndarray, beyond: tuple[float, float]
) -> tuple[str, ...]:
    """Where the solution leaves what its theory covers."""
    notes = []
    if pressure.max() > _MOST_PRESSURE:
        notes.append(
            f"a contact pressure of {1e-9 * pressure.max():.2g} GPa is beyond any gear steel; the result is elastic"
        )
    # Loaded slices whose kinematic gap is near that of the last place where corners were looked for.
    most = MOST_BEYOND * problem.line.base_pitch
    widest = min(float(problem.line.corner(gear, np.array([0.9 * most]))[0][0]) for gear in (0, 1)) * problem.cosine
    far = (slices.gap @ slices.weight >= widest) & (force > 0.0)
    if max(beyond) >= most * (1.0 - 1e-9) and far.any():
        notes.append(
            f"tip corners were followed to {MOST_BEYOND:g} base pitches beyond the line of action only; at this load they may "
            "touch farther out"
        )
    if np.any(slices.corner & (force > 0.0)):
        notes.append(
            "tip corners carry load: sharp corners are taken as line contacts, which may be 5 to 7 % too stiff there"
        )
    return tuple(notes)
