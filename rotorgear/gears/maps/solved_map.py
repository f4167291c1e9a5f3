"""The contact map of a tooth pair: the contact solved over positions and loads, and what the map is wrong by.

Slices and compliances of a position serve several loads (`map_positions.load_groups`). In space those of a spur pair serve
the loads between two bounds, since patches follow the load; what their change moves at such a bound fades away towards the next
one. Slices of a helical pair serve all loads, and its patches all but a few.

In the plane positions are even and dense, for solutions are cheap. In space those of a spur pair are chosen where pairs come and
go and where the curve of the working load needs them; those of a helical pair, whose curves are smooth, are even. Either is read
by cubics at more even positions, which the map keeps (`map_positions.py`).

With pitch errors, period n has the pairs whose teeth are n ahead. Periods in which the same errors touch are solved once.

A column holds approach, slope and moment at all positions under one load, with the patches of the largest load of its group. Each
position goes down from its largest load, and every solution begins with what those above it lead to.
"""

from __future__ import annotations

import hashlib
import time
from collections.abc import Callable, Sequence
from dataclasses import fields, is_dataclass, replace
from functools import lru_cache, partial
from typing import Any

import numpy as np

from rotorgear.files.cache import read_entry, write_entry
from rotorgear.fingerprint import fingerprint
from rotorgear.gears.loaded.contact_points import Slices, contact_slices
from rotorgear.gears.loaded.loaded_contact import ContactState, PositionContact, solve_contact, solve_many
from rotorgear.gears.loaded.mesh_cycle import MeshCycle, beyond_line, corner_reach, mesh_cycle
from rotorgear.gears.loaded.patched_contacts import PatchedContacts, WideContactError, patched_contacts, same_patches
from rotorgear.gears.loaded.tooth_contact import ContactProblem, contact_problem, in_space
from rotorgear.gears.maps.contact_map import ContactMap
from rotorgear.gears.maps.map_positions import MapPositions, errors_by_period, families, load_groups, map_positions
from rotorgear.gears.stiffness.mesh_stiffness import ToothPair
from rotorgear.memory import require_memory
from rotorgear.progress import Progress, listener, part_of

# Maps that other sources kept are passed over.
_MAKERS = ("gears",)
# CPU seconds from which on a map is worth a file.
_WORTH = 1.0
# Numbers that are held for each position and load of a map, by an analysis that is made with it: approach, slope and moment, what
# they are put together from, and what joint equilibria look them up in.
_COPIES = 12.0
# Positions that tell how far corners touch. Where they touch farther than was thought, they are followed a little farther still.
_TELLING = 12
_FARTHER = 1.05


# Groups of loads as multiples of the working one, and groups with the contacts under their largest load.
Groups = tuple[tuple[float, ...], ...]
_Solved = list[tuple[tuple[float, ...], PatchedContacts]]
# Slices, multiples of the working load, and the contacts of the commonest period under the last of these.
Step = tuple[Slices, tuple[float, ...], PatchedContacts]


def up_to(problem: ContactProblem, cycle: MeshCycle, load: float, family: Groups) -> _Solved:
    """Groups of rising multiples of a force (N), the last of which is that of the cycle, and contacts on its slices."""
    last = PatchedContacts(cycle.contacts, cycle.states, cycle.patch)
    gap = problem.gap(cycle.slices)
    below = last
    found = []
    for group in family[:-1]:
        below = patched_contacts(problem, cycle.slices, gap, load * group[-1], known=below, narrowest=below is last)
        found.append((group, below))
    return [*found, (family[-1], last)]


def above(
    problem: ContactProblem, load: float, family: Groups, place: np.ndarray, progress: Progress
) -> tuple[Slices, _Solved]:
    """Slices that reach as far as corners touch under the largest of the forces, and groups with their contacts.

    Groups end before the first one under whose largest force the contact is no line.

    Args:
        problem: the helix.
        load: working force (N).
        family: groups of rising multiples of it.
        place: (p,) positions.
        progress: told how far it is.

    Raises:
        WideContactError: there is none, or it is no larger than the working one.
    """
    reach = corner_reach(problem, load * family[-1][-1] * problem.cosine, place[:: max(1, len(place) // _TELLING)])
    while True:
        slices = contact_slices(problem.line, place, problem.width, problem.slices, reach, stations=problem.uncoupled)
        gap = problem.gap(slices)
        solve = partial(patched_contacts, problem, slices, gap, progress=progress)
        found: _Solved = []
        for group in family:
            try:
                found += _contacts(problem, solve, load, group, found[-1][1] if found else None)
            except WideContactError:
                if not found or group[-1] < 1.0 + 1e-9:
                    raise
                break
        deflection = max(state.approach for state in found[-1][1].states) - float(gap.min())
        wanted = beyond_line(problem, deflection / problem.cosine + problem.largest_gap)
        if wanted[0] <= reach[0] and wanted[1] <= reach[1]:
            return slices, found
        # Rare: the positions that told the reach missed where most is touched.
        reach = (max(reach[0], _FARTHER * wanted[0]), max(reach[1], _FARTHER * wanted[1]))


def _contacts(
    problem: ContactProblem,
    solve: Callable[..., PatchedContacts],
    load: float,
    group: tuple[float, ...],
    below: PatchedContacts | None,
) -> _Solved:
    """A group and its contacts, which grow from those `below` it.

    Where patches of oblique lines change within it, each load by itself on those that it asks for.
    """
    if problem.oblique and below is None:
        below = solve(load * group[0])
    last = solve(load * group[-1], known=below)
    if not problem.oblique or below is None or np.array_equal(last.patch, below.patch):
        return [(group, last)]
    found = []
    for factor in group[:-1]:
        below = solve(load * factor, known=below)
        found.append(((factor,), below))
    return [*found, (group[-1:], last)]


# Change of the forces over the load in the last round: 1e-7 of the approach is left at most, and loads and positions lie farther
# apart than that.
_TOLERANCE = 1e-6


def map_columns(slices: Slices, found: PatchedContacts, loads: list[float], *, few: bool) -> np.ndarray:
    """Approach (m), its slope d delta / dF (m/N) and moment (N m) at rising normal forces (N): (3, l, p).

    Args:
        slices: of all positions.
        found: the contacts under the last of the forces.
        loads: normal forces.
        few: whether a tooth pair has one slice: then all positions and loads are solved at once.
    """
    if few:
        return _few_slices(found.contacts, loads)
    place = slices.z @ slices.weight
    rows = [
        _row(contact, state, loads, place[slices.at(i)])
        for i, (contact, state) in enumerate(zip(found.contacts, found.states, strict=True))
    ]
    return np.array(rows).transpose(2, 1, 0)


def _few_slices(contacts: Sequence[PositionContact], loads: list[float]) -> np.ndarray:
    """Columns of a pair that has one slice for a tooth pair: all positions with as many pairs, and all loads, at once."""
    found = np.zeros((3, len(loads), len(contacts)))
    for n in {len(contact.gap) for contact in contacts}:
        which = [i for i, contact in enumerate(contacts) if len(contact.gap) == n]

        def stacked(name: str, which: list[int] = which) -> np.ndarray:
            return np.repeat(np.stack([getattr(contacts[i], name) for i in which]), len(loads), axis=0)

        approach, tangent = solve_many(contacts[which[0]].with_arrays(stacked), np.tile(loads, len(which)))
        found[:2, :, which] = np.stack([approach, 1.0 / tangent]).reshape(2, len(which), len(loads)).swapaxes(1, 2)
    return found


def _row(
    contact: PositionContact, state: ContactState, loads: list[float], place: np.ndarray
) -> list[tuple[float, float, float]]:
    """Approach, its slope and the moment at rising loads of one position: down from the largest, each from those above.

    `place` (n,) is that of each slice from the middle of the face (m), `state` the solution at the largest load.
    """
    # A slice whose gap is wider than the approach at the largest load touches at none.
    near = np.flatnonzero((contact.gap < state.approach) | (state.force > 0.0))
    fewer = replace(contact.chosen(near), compliance=contact.compliance[np.ix_(near, near)])
    force = state.force[near]
    # How the forces change with the load, from the two loads above; below the first one they are taken in proportion.
    rate = force / loads[-1]
    at = loads[-1]
    found = [(state.approach, 1.0 / state.tangent, float(state.force @ place))]
    for load in reversed(loads[:-1]):
        state = solve_contact(fewer, load, np.maximum(force + rate * (load - at), 0.0), _TOLERANCE)
        rate = (force - state.force) / (at - load)
        force = state.force
        at = load
        found.append((state.approach, 1.0 / state.tangent, float(state.force @ place[near])))
    return found[::-1]


def faded(columns: np.ndarray, below: np.ndarray, factors: list[float]) -> np.ndarray:
    """Columns (3, l, p), the first of them at a bound, led from those `below` it (3, p) to their own at the last load.

    Slopes stay what they are.
    """
    jump = columns[:, 0] - below
    jump[1] = 0.0
    left = np.array([(factors[-1] - factor) / (factors[-1] - factors[0]) for factor in factors[1:]])
    return np.asarray(columns[:, 1:] - jump[:, None] * left[:, None])


def with_start(slope: np.ndarray, approach: np.ndarray, loads: np.ndarray) -> np.ndarray:
    """Slopes (p, l) with that at no load: of the parabola through the first two points with the slope at the second."""
    first = 2.0 * (approach[:, 1] - approach[:, 0]) / loads[1] - slope[:, 0]
    return np.column_stack([np.maximum(first, slope[:, 0]), slope])


# Positions that are solved in a base pitch. Spur pairs have a kink wherever a tooth pair comes or goes: even positions in the
# plane, chosen ones in space; the curves of helical ones are smooth, but for ripples where lines pass from one layer of
# elements to the next: 64 positions moved a curve of 0.05 um by 2 %.
POSITIONS = 512
_IN_SPACE_POSITIONS = {"spur": 128, "helical": 96}
# An odd tooth of a helical pair comes and goes within a small part of a base pitch.
_WITH_ODD_TEETH = 128
# So many places between positions and loads tell the error of a map, from 0.32 to 1.6 times the working load, about what contacts
# carry: a sequence that fills positions and loads evenly (M. Roberts, 2018: powers of 1/g, g^3 = g + 1).
_PLACES = 16
_FILLING = (0.7548776662466927, 0.5698402909980532)
_LOADS = (0.32, 5.0)


def contact_map(teeth: ToothPair, load: float, positions: int | None = None, near: bool = False) -> ContactMap:
    """Solve the loaded contact over the mesh cycle for loads up to five times the working one.

    Args:
        teeth: one helix.
        load: working force (N) along the flank normal.
        positions: number of even ones in a base pitch, which the map keeps; default 512 even ones in the plane, and in space
            128 of a spur pair where the curves need them, and 96 of a helical one, or 128 where single teeth differ.
        near: for linear analyses: of spur pairs in space fewer loads, up to about twice the working one. Helical pairs have one
            map for all analyses: theirs have most of their loads there, and a transient asks for both.

    Raises:
        AnalysisError: teeth that can't be made, meshed or brought into contact; pitch errors that make too many periods differ.
        WideContactError: a working load under which the contact is no line any more.
        ConvergenceError: a position has no solution to the tolerance.
        MissingExtraError: scikit-fem is needed and not installed.
    """
    return _kept(teeth, load, positions, near and (in_space(teeth)[1] or not teeth.first.helix_angle))


@lru_cache(maxsize=32)  # the helices of a model and its analyses ask for the same maps again and again
def _kept(teeth: ToothPair, load: float, positions: int | None, near: bool) -> ContactMap:
    """The map from disk, or solved and kept."""

    def solve() -> ContactMap:
        progress = listener()
        problem = contact_problem(teeth, part_of(progress, 0.0, 0.5))
        if positions or problem.one_slice:
            count = positions or POSITIONS
            chosen = MapPositions(np.arange(count) / count)
        else:
            count = _IN_SPACE_POSITIONS["helical" if teeth.first.helix_angle else "spur"]
            if any(flank.single_teeth for flank in problem.flanks):
                count = max(count, _WITH_ODD_TEETH)
            working = float(f"{load * problem.cosine:.12g}")  # that of the mesh's stiffness, whose cycle is known
            chosen = map_positions(teeth, working, count)
        found = solved_map(problem, load, chosen, load_groups(problem, near), part_of(progress, 0.5, 1.0))
        return replace(found, error=_error(problem, found, load))

    return kept_map((teeth, load, positions, near), solve)


def kept_map(key: Any, solve: Callable[[], ContactMap]) -> ContactMap:
    """The map of a key from disk, or solved, and kept where that took as long as a file is worth."""
    text = f"{fingerprint(*_MAKERS)} {_text(key)}"
    stored = read_entry("teeth", "map", text)
    if stored is not None:
        return ContactMap(**stored)
    start = time.process_time()
    found = solve()
    if time.process_time() - start >= _WORTH:
        assert found.compliance is not None
        write_entry("teeth", "map", text, {one.name: getattr(found, one.name) for one in fields(found)})
    return found


def _text(value: Any) -> str:
    """All that a value holds, arrays in full by their hash: a repr would leave out the middle of a long one."""
    if is_dataclass(value):
        inside = ", ".join(f"{field.name}={_text(getattr(value, field.name))}" for field in fields(value))
        return f"{type(value).__name__}({inside})"
    if isinstance(value, np.ndarray):
        return f"{value.dtype} {value.shape} {hashlib.sha256(np.ascontiguousarray(value).tobytes()).hexdigest()}"
    if isinstance(value, tuple | list):
        return f"({', '.join(_text(one) for one in value)})"
    return repr(value)


def solved_map(
    problem: ContactProblem, load: float, positions: MapPositions, groups: Groups, progress: Progress
) -> ContactMap:
    """The map at some positions for groups of rising multiples of a working load (N)."""
    of_period = errors_by_period(problem)
    kinds = list(dict.fromkeys(of_period))
    kept = len(of_period) * positions.each
    require_memory(
        8.0 * _COPIES * kept * (1 + sum(map(len, groups))),
        f"A map of loaded teeth over {len(of_period)} base pitches",
        "give pitch errors and topographies of single teeth to one gear only, or to fewer teeth",
    )
    # Patches are those of the commonest period: where an odd tooth carries they are wider, and would move all the others.
    common = of_period.index(max(kinds, key=of_period.count))
    place = common + positions.position
    odd_teeth = any(flank.single_teeth for flank in problem.flanks)
    steps: list[Step] = []
    notes: list[str] = []
    factors: list[float] = []
    asked = families(problem, groups)
    for number, family in enumerate(asked):
        told = part_of(progress, 0.5 * number / len(asked), 0.5 * (number + 1) / len(asked))
        try:
            if not factors and positions.cycle is not None:
                notes += positions.cycle.warnings
            if not factors and not problem.oblique:
                top = load * family[-1][-1]
                known = None if common or family[-1][-1] != 1.0 else positions.cycle
                cycle = known or mesh_cycle(problem, top * problem.cosine, place, told)
                notes += cycle.warnings
                slices = cycle.slices
                contacts = up_to(problem, cycle, load, family)
            else:
                slices, contacts = above(problem, load, family, place, told)
        except WideContactError:
            if not factors:
                raise
            contacts = []
        for group, commonest in contacts:
            steps.append((slices, group, commonest))
            factors += group
        if factors[-1] < family[-1][-1]:
            notes.append(
                f"the loaded teeth were solved up to {factors[-1]:.3g} times the working load; above it their contact is no line"
            )
            break
    loads = load * np.array([0.0, *factors])
    each = len(place)
    approach, slope, moment = np.empty((3, len(of_period) * each, len(loads)))
    for kind, errors in enumerate(kinds):
        progress(0.5 + 0.5 * kind / len(kinds), f"teeth {kind + 1} of {len(kinds)}")
        # Teeth by teeth: the contacts of all of many periods at once would take more memory than the map.
        curves = _curves(problem, load, steps, of_period.index(errors) - common if odd_teeth else None)
        for period in (number for number, other in enumerate(of_period) if other == errors):
            some = slice(period * each, (period + 1) * each)
            approach[some], slope[some], moment[some] = curves
    position, approach, slope, moment = positions.kept(approach, slope, moment, int(np.argmin(np.abs(loads - load))))
    return ContactMap(
        position=position,
        periods=len(of_period),
        load=loads,
        approach=approach,
        warnings=tuple(dict.fromkeys((*problem.warnings, *notes))),
        compliance=slope,
        moment=None if problem.one_slice else moment,
    )


def _curves(
    problem: ContactProblem, load: float, steps: list[Step], ahead: int | None
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Approach, its slope and the moment (n, l) of the teeth of one base pitch under no load and all groups of loads.

    Args:
        problem: the teeth. load: the working load (N).
        steps: slices, group of multiples and contacts of the commonest period, from the smallest loads up.
        ahead: base pitches from the commonest period to this one; None where all are as that one.
    """
    columns: list[np.ndarray] = []
    factors: list[float] = []
    touch = np.zeros(0)
    below = steps[0][2]
    for slices, group, commonest in steps:
        found = commonest
        if ahead is not None:
            gap = problem.gap(slices, ahead)
            found = patched_contacts(problem, slices, gap, load * group[-1], known=commonest)
        # Where patches are those of the group below, its last load needs no second solution; a single load fades nothing.
        new = bool(factors) and len(group) > 1 and not same_patches(found, below)
        bound = factors[-1:] if new else []
        solved = map_columns(slices, found, [load * f for f in (*bound, *group)], few=problem.one_slice)
        if bound:
            solved = faded(solved, columns[-1][:, -1], [*bound, *group])
        if not factors:
            touch = np.array([contact.gap.min() for contact in found.contacts])
        columns.append(solved)
        factors += group
        below = found
    deflection, compliance, moment = np.concatenate(columns, axis=1).swapaxes(1, 2)
    approach = np.column_stack([touch, deflection])
    slope = with_start(compliance, approach, load * np.array([0.0, *factors]))
    return approach, slope, np.column_stack([np.zeros(len(touch)), moment])


def _error(problem: ContactProblem, solved: ContactMap, load: float) -> float:
    """Largest difference (m along the flank normal) of a map to contacts that it has not seen, about a working force (N)."""
    along = problem.cosine
    of_period = errors_by_period(problem)
    first = [of_period.index(errors) for errors in dict.fromkeys(of_period)]  # base pitches of each kind take turns
    most = 0.0
    for number in range(_PLACES):
        place, height = ((0.5 + (number + 1) * step) % 1.0 for step in _FILLING)
        force = load * _LOADS[0] * _LOADS[1] ** height
        if force > solved.largest_load:
            continue
        u = first[number % len(first)] + place
        exact = float(mesh_cycle(problem, force * along, np.array([u])).deflection[0]) * along
        most = max(most, abs(float(solved.approach_at(force, u)) - exact))
    return most
