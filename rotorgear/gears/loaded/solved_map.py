"""The contact map of a tooth pair: its loads, the contact solved for all of them, and the periods that pitch errors make differ.

Slices and compliances of a position serve several loads. In space those of a spur pair serve the loads between two bounds, since
patches follow the load; what their change moves at such a bound fades away towards the next one. Those of a helical pair serve
all loads: its patches grow only where strips are wider, and slices of its corners are the same under all loads.

In the plane positions are even and dense, for solutions are cheap. In space those of a spur pair are chosen where pairs come and
go and where the curve of the working load needs them; those of a helical pair, whose curves are smooth, are even. Either is read
by cubics at more even positions, which the map keeps (`map_positions.py`).

With pitch errors, period n has the pairs whose teeth are n ahead. Periods in which the same errors touch are solved once.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import lru_cache
from itertools import pairwise

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.gears.loaded.contact_map import ContactMap
from rotorgear.gears.loaded.contact_points import Slices, contact_slices
from rotorgear.gears.loaded.map_columns import Column, faded, map_columns, with_start
from rotorgear.gears.loaded.map_positions import MapPositions, even_positions, map_positions
from rotorgear.gears.loaded.map_store import kept_map
from rotorgear.gears.loaded.mesh_cycle import MeshCycle, beyond_line, corner_reach, mesh_cycle
from rotorgear.gears.loaded.settled_contacts import (
    Settled,
    WideContactError,
    same_patches,
    settled,
    with_least_patches,
)
from rotorgear.gears.loaded.tooth_contact import ContactProblem, contact_problem
from rotorgear.gears.stiffness.mesh_stiffness import ToothPair
from rotorgear.progress import Progress, listener, part_of

# Positions that are solved in a base pitch. Spur pairs have a kink wherever a tooth pair comes or goes: even positions in the
# plane, chosen ones in space; the curves of helical ones are smooth, but for ripples where lines pass from one layer of
# elements to the next: 64 positions moved a curve of 0.05 um by 2 %.
POSITIONS = 512
_IN_SPACE_POSITIONS = {"spur": 128, "helical": 96}
# An odd tooth of a helical pair comes and goes within a small part of a base pitch.
_WITH_ODD_TEETH = 128
# Loads as multiples of the working load: resonances with contact loss reach four to five times it. In the plane pairs come and go
# suddenly with the load too, and solutions are cheap.
_IN_PLANE = ((0.003, 0.01, *(0.025 * np.arange(1, 81)), *(2.0 + 0.05 * np.arange(1, 61))),)
# In space the largest load of each group decides the patches of a spur pair, so that there the contact is as `rotorgear mesh`
# solves it at that load; the working load is such a one. Patches of three times the load would move the approach by 0.2 % and its
# harmonics by 1.4 %; with these groups 0.4 % are left. Where crowned or misaligned flanks carry, slices that touch change with
# the load: between loads 1.5 apart the curve over u is up to 10 % off, between these 1 %.
_UP_TO_WORKING = (
    (0.04, 0.05, 0.06, 0.07, 0.09, 0.11, 0.13, 0.16, 0.19, 0.23, 0.28),
    (0.33, 0.4, 0.48, 0.58),
    (0.7, 0.83, 1.0),
)
_IN_SPACE = (
    (0.01, 0.02, *_UP_TO_WORKING[0]),
    *_UP_TO_WORKING[1:],
    (1.12, 1.25, 1.4),
    (1.6, 1.9, 2.2),
    (2.7, 3.3, 4.1, 5.0),
)
# Linear analyses stay near the mean load of a contact, but helices and branches need not share alike: some carry a third of the
# working load, others twice as much.
_NEAR_IN_SPACE = (*_UP_TO_WORKING, (1.12, 1.25, 1.4), (1.6, 1.8, 2.0))
# Loads of helical pairs have another one between them in this range: they share slices and patches, so that one costs little, and
# curves of herringbone pairs and loops are as small as 0.05 um. With the loads above 3 % of such a one is missed.
_FINER = (0.2, 2.3)
# Slices of a spur pair reach as far beyond the line of action as corners touch: groups up to the working load, up to so many
# times it and above have slices of their own.
_MODERATE = 2.5
# Positions that tell this reach. Where corners touch farther than was thought, they are followed a little farther still.
_TELLING = 12
_FARTHER = 1.05
# More differing periods than these are refused.
_MOST_DIFFERING = 128
# More periods than these make no map.
_MOST_PERIODS = 4096

# So many places between positions and loads tell the error of a map, from 0.32 to 1.6 times the working load, about what contacts
# carry: a sequence that fills positions and loads evenly (M. Roberts, 2018: powers of 1/g, g^3 = g + 1).
_PLACES = 16
_FILLING = (0.7548776662466927, 0.5698402909980532)
_LOADS = (0.32, 5.0)


@lru_cache(maxsize=32)  # the helices of a model and its analyses ask for the same maps again and again
def contact_map(teeth: ToothPair, load: float, positions: int | None = None, near: bool = False) -> ContactMap:
    """Solve the loaded contact over the mesh cycle for loads up to five times the working one.

    Args:
        teeth: one helix.
        load: working force (N) along the flank normal.
        positions: so many even ones in a base pitch, and the map keeps these; default 512 even ones in the plane, and in space
            128 of a spur pair where the curves need them, and 96 of a helical one, or 128 where single teeth differ.
        near: for linear analyses: in space fewer loads, up to about twice the working one.

    Raises:
        AnalysisError: teeth that can't be made, meshed or brought into contact; pitch errors that make too many periods differ.
        WideContactError: a working load under which the contact is no line any more.
        ConvergenceError: a position has no solution to the tolerance.
        MissingExtraError: scikit-fem is needed and not installed.
    """

    def judged(found: ContactMap, problem: ContactProblem) -> ContactMap:
        return replace(found, error=_error(problem, found, load))

    def solve() -> ContactMap:
        progress = listener()
        problem = contact_problem(teeth, part_of(progress, 0.0, 0.5))
        told = part_of(progress, 0.5, 1.0)
        if problem.plane and not problem.uncoupled:
            # One slice for a tooth pair: cheap, with patches that follow no load, so that one group has all loads.
            return judged(solved_map(problem, load, even_positions(positions or POSITIONS), _IN_PLANE, told), problem)
        groups = _NEAR_IN_SPACE if near else _IN_SPACE
        if positions:
            return judged(solved_map(problem, load, even_positions(positions), groups, told), problem)
        count = _IN_SPACE_POSITIONS["helical" if teeth.first.helix_angle else "spur"]
        if any(flank.single_teeth for flank in problem.flanks):
            count = max(count, _WITH_ODD_TEETH)
        working = float(f"{load * _cosine(problem):.12g}")  # that of the mesh's stiffness, whose cycle is known
        return judged(solved_map(problem, load, map_positions(teeth, working, count), groups, told), problem)

    return kept_map((teeth, load, positions, near), solve)


def solved_map(
    problem: ContactProblem,
    load: float,
    positions: MapPositions,
    groups: tuple[tuple[float, ...], ...],
    progress: Progress,
) -> ContactMap:
    """The map at some positions for groups of rising multiples of a working load (N)."""
    of_period = _errors_by_period(problem)
    kinds = list(dict.fromkeys(of_period))
    # Patches are those of the commonest period: where an odd tooth carries they are wider, and would move all the others.
    common = of_period.index(max(kinds, key=of_period.count))
    place = common + positions.position
    few = problem.plane and not problem.uncoupled
    solved: list[list[Column]] = [[] for _ in kinds]
    below: dict[int, Settled] = {}
    touch: list[np.ndarray] = []
    notes: list[str] = []
    factors: list[float] = []
    oblique = not problem.plane and problem.line.base_helix_angle > 0.0
    families = [_finer(groups)] if oblique else _families(groups)
    for number, family in enumerate(families):
        told = part_of(progress, number / len(families), (number + 1) / len(families))
        tops = [load * group[-1] for group in family]
        try:
            if not factors and positions.cycle is not None:
                notes += positions.cycle.warnings
            if not factors and not oblique:
                known = None if common or family[-1][-1] != 1.0 else positions.cycle
                cycle = known or mesh_cycle(problem, tops[-1] * _cosine(problem), place, told)
                notes += cycle.warnings
                slices = cycle.slices
                contacts = _up_to(problem, cycle, tops)
            else:
                slices, contacts = _above(problem, tops, place, told, needed=load)
        except WideContactError:
            if not factors:
                raise
            contacts = []
        for group, commonest in zip(family, contacts, strict=False):
            for kind, errors in enumerate(kinds):
                found = _of_kind(problem, slices, commonest, load * group[-1], of_period.index(errors) - common)
                # Where patches are those of the group below, its last load needs no second solution.
                bound = factors[-1:] if factors and not same_patches(found, below[kind]) else []
                columns = map_columns(slices, found, [load * f for f in (*bound, *group)], few=few)
                if bound:
                    columns = faded(columns, solved[kind][-1], [*bound, *group])
                if not factors:
                    touch.append(np.array([contact.gap.min() for contact in found.contacts]))
                solved[kind] += columns
                below[kind] = found
                told((kind + 1) / len(kinds), f"teeth {kind + 1} of {len(kinds)}")
            factors += group
        if len(contacts) < len(family):
            notes.append(
                f"the loaded teeth were solved up to {factors[-1]:.3g} times the working load; above it their contact is no line"
            )
            break
    order = [kinds.index(errors) for errors in of_period]
    loads = load * np.array([0.0, *factors])
    return _assembled(problem, positions, loads, load, order, touch, solved, notes)


def _assembled(
    problem: ContactProblem,
    positions: MapPositions,
    loads: np.ndarray,
    load: float,
    order: list[int],
    touch: list[np.ndarray],
    solved: list[list[Column]],
    notes: list[str],
) -> ContactMap:
    """The map over all periods, period n being of the kind order[n], from touch and columns of each kind."""
    kinds = range(len(solved))
    approach = [np.stack([touch[k], *(c.approach for c in solved[k])], axis=1) for k in kinds]
    slope = [with_start(np.stack([c.slope for c in solved[k]], axis=1), approach[k], loads) for k in kinds]
    moment = [np.stack([np.zeros(len(positions.position)), *(c.moment for c in columns)], axis=1) for columns in solved]
    position, *curves = positions.kept(
        np.concatenate([approach[k] for k in order]),
        np.concatenate([slope[k] for k in order]),
        np.concatenate([moment[k] for k in order]),
        int(np.argmin(np.abs(loads - load))),
    )
    return ContactMap(
        position=position,
        periods=len(order),
        load=loads,
        approach=curves[0],
        warnings=tuple(dict.fromkeys((*problem.warnings, *notes))),
        compliance=curves[1],
        moment=curves[2] if not problem.plane or problem.uncoupled else None,
    )


def _finer(groups: tuple[tuple[float, ...], ...]) -> tuple[tuple[float, ...], ...]:
    """Groups with the mean of two loads before the second of them."""
    found = []
    before = 0.0
    for group in groups:
        loads: list[float] = []
        for factor in group:
            if before > _FINER[0] and factor < _FINER[1]:
                loads.append(0.5 * (before + factor))
            loads.append(factor)
            before = factor
        found.append(tuple(loads))
    return tuple(found)


def _families(groups: tuple[tuple[float, ...], ...]) -> list[tuple[tuple[float, ...], ...]]:
    """Groups that share their slices: up to the working load, up to `_MODERATE` times it, and above."""
    borders = (0.0, 1.0, _MODERATE, np.inf)
    families = [tuple(group for group in groups if low < group[-1] <= high) for low, high in pairwise(borders)]
    return [family for family in families if family]


def _up_to(problem: ContactProblem, cycle: MeshCycle, loads: list[float]) -> list[Settled]:
    """Contacts on the slices of a cycle under rising normal forces (N), the last of which is that of the cycle."""
    last = Settled(cycle.contacts, cycle.states, cycle.patch)
    if len(loads) == 1:
        return [last]
    gap = problem.gap(cycle.slices)
    found = [with_least_patches(problem, cycle.slices, gap, last)]
    for load in loads[:-1]:
        found.append(settled(problem, cycle.slices, gap, load, known=found[-1]))
    return [*found[1:], last]


def _above(
    problem: ContactProblem, loads: list[float], place: np.ndarray, progress: Progress, needed: float
) -> tuple[Slices, list[Settled]]:
    """Slices that reach as far as corners touch under the largest of rising normal forces (N), and contacts under each.

    Forces end before the first one under which the contact is no line.

    Raises:
        WideContactError: there is none, or it is no larger than `needed` (N).
    """
    cosine = _cosine(problem)
    reach = corner_reach(problem, loads[-1] * cosine, place[:: max(1, len(place) // _TELLING)])
    while True:
        slices = contact_slices(problem.line, place, problem.width, problem.slices, reach, stations=problem.uncoupled)
        gap = problem.gap(slices)
        found: list[Settled] = []
        last: Settled | None = None
        for load in loads:
            try:
                last = settled(problem, slices, gap, load, progress, last)
                found.append(last)
            except WideContactError:
                if not found or load <= needed * (1.0 + 1e-9):
                    raise
                break
        deflection = max(state.approach for state in found[-1].states) - float(gap.min())
        wanted = beyond_line(problem, deflection / cosine + problem.largest_gap)
        if wanted[0] <= reach[0] and wanted[1] <= reach[1]:
            return slices, found
        # Rare: the positions that told the reach missed where most is touched.
        reach = (max(reach[0], _FARTHER * wanted[0]), max(reach[1], _FARTHER * wanted[1]))


def _of_kind(problem: ContactProblem, slices: Slices, commonest: Settled, load: float, ahead: int) -> Settled:
    """Contacts of the period so many after the commonest, under a normal force (N)."""
    if not any(flank.single_teeth for flank in problem.flanks):
        return commonest
    return settled(problem, slices, problem.gap(slices, ahead), load, known=commonest)


def _error(problem: ContactProblem, solved: ContactMap, load: float) -> float:
    """Largest difference (m along the flank normal) of a map to contacts that it has not seen, about a working force (N)."""
    cosine = _cosine(problem)
    of_period = _errors_by_period(problem)
    first = [of_period.index(errors) for errors in dict.fromkeys(of_period)]  # base pitches of each kind take turns
    most = 0.0
    for number in range(_PLACES):
        place, height = ((0.5 + (number + 1) * step) % 1.0 for step in _FILLING)
        force = load * _LOADS[0] * _LOADS[1] ** height
        if force > solved.largest_load:
            continue
        u = first[number % len(first)] + place
        exact = float(mesh_cycle(problem, force * cosine, np.array([u])).deflection[0]) * cosine
        most = max(most, abs(float(solved.approach_at(force, u)) - exact))
    return most


def _cosine(problem: ContactProblem) -> float:
    """cos b_b: F_bt = F_n cos b_b."""
    return float(np.cos(problem.line.base_helix_angle))


def _errors_by_period(problem: ContactProblem) -> list[tuple[float, ...]]:
    """What tells the periods apart: the pitch errors of the pairs that can touch, and which teeth have their own topography.

    Errors of a pair add up, and what shifts all pairs alike is the same for all but the approach: it is left in.

    Raises:
        AnalysisError: too many periods differ, as where both gears have errors all round.
    """
    turning = [z for z, flank in zip(problem.teeth, problem.flanks, strict=True) if flank.single_teeth]
    periods = math.lcm(*turning)
    if periods > _MOST_PERIODS:
        raise AnalysisError(
            f"The errors of single teeth of both gears repeat after {periods} base pitches only, and a map takes "
            f"{_MOST_PERIODS}: give them to one gear."
        )
    # A pair can touch from the start of the path to its end, corners and the whole face included.
    line = problem.line
    reach = line.end - line.start + line.base_pitch + problem.width * math.tan(line.base_helix_angle)
    pairs = math.ceil(reach / line.base_pitch)
    tooth = np.arange(periods)[:, None] - np.arange(-pairs, pairs + 1)
    depth = np.zeros(tooth.shape)
    told = [depth]
    for flank, z in zip(problem.flanks, problem.teeth, strict=True):
        depth += flank.pitch_depth(tooth, z)
        own = [number % z for number, _ in flank.tooth_topography]
        told.append(np.where(np.isin(tooth % z, own), tooth % z, -1))
    found = [tuple(row.tolist()) for row in np.concatenate(told, axis=1)]
    differing = len(set(found))
    if differing > _MOST_DIFFERING:
        raise AnalysisError(
            f"The errors of single teeth make {differing} of {periods} base pitches differ, and {_MOST_DIFFERING} can be solved: "
            "give errors to fewer teeth."
        )
    return found if differing > 1 else found[:1]
