"""The contact map of a tooth pair: the contact solved over positions and loads, and what the map is wrong by.

Slices and compliances of a position serve several loads (`map_loads.py`, `map_contacts.py`). In space those of a spur pair serve
the loads between two bounds, since patches follow the load; what their change moves at such a bound fades away towards the next
one. Slices of a helical pair serve all loads, and its patches all but a few.

In the plane positions are even and dense, for solutions are cheap. In space those of a spur pair are chosen where pairs come and
go and where the curve of the working load needs them; those of a helical pair, whose curves are smooth, are even. Either is read
by cubics at more even positions, which the map keeps (`map_positions.py`).

With pitch errors, period n has the pairs whose teeth are n ahead. Periods in which the same errors touch are solved once.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np

from rotorgear.gears.loaded.mesh_cycle import mesh_cycle
from rotorgear.gears.loaded.settled_contacts import Settled, WideContactError, same_patches
from rotorgear.gears.loaded.tooth_contact import ContactProblem, contact_problem, in_space
from rotorgear.gears.maps.contact_map import ContactMap
from rotorgear.gears.maps.map_columns import Column, faded, map_columns, with_start
from rotorgear.gears.maps.map_contacts import above, cosine, of_period_ahead, up_to
from rotorgear.gears.maps.map_loads import families, load_groups
from rotorgear.gears.maps.map_periods import errors_by_period
from rotorgear.gears.maps.map_positions import MapPositions, even_positions, map_positions
from rotorgear.gears.maps.map_store import kept_map
from rotorgear.gears.stiffness.mesh_stiffness import ToothPair
from rotorgear.progress import Progress, listener, part_of

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
        positions: so many even ones in a base pitch, and the map keeps these; default 512 even ones in the plane, and in space
            128 of a spur pair where the curves need them, and 96 of a helical one, or 128 where single teeth differ.
        near: for linear analyses: of spur pairs in space fewer loads, up to about twice the working one. Helical pairs have one
            map for all analyses: theirs have most of their loads there, and a transient asks for both.

    Raises:
        AnalysisError: teeth that can't be made, meshed or brought into contact; pitch errors that make too many periods differ.
        WideContactError: a working load under which the contact is no line any more.
        ConvergenceError: a position has no solution to the tolerance.
        MissingExtraError: scikit-fem is needed and not installed.
    """
    uncoupled = in_space(teeth)[1]
    return _kept(teeth, load, positions, near and (uncoupled or not teeth.first.helix_angle))


@lru_cache(maxsize=32)  # the helices of a model and its analyses ask for the same maps again and again
def _kept(teeth: ToothPair, load: float, positions: int | None, near: bool) -> ContactMap:
    """The map from disk, or solved and kept."""

    def judged(found: ContactMap, problem: ContactProblem) -> ContactMap:
        return replace(found, error=_error(problem, found, load))

    def solve() -> ContactMap:
        progress = listener()
        problem = contact_problem(teeth, part_of(progress, 0.0, 0.5))
        told = part_of(progress, 0.5, 1.0)
        groups = load_groups(problem, near)
        if problem.plane and not problem.uncoupled:
            # One slice for a tooth pair: cheap, with patches that follow no load, so that one group has all loads.
            return judged(solved_map(problem, load, even_positions(positions or POSITIONS), groups, told), problem)
        if positions:
            return judged(solved_map(problem, load, even_positions(positions), groups, told), problem)
        count = _IN_SPACE_POSITIONS["helical" if teeth.first.helix_angle else "spur"]
        if any(flank.single_teeth for flank in problem.flanks):
            count = max(count, _WITH_ODD_TEETH)
        working = float(f"{load * cosine(problem):.12g}")  # that of the mesh's stiffness, whose cycle is known
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
    of_period = errors_by_period(problem)
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
    asked = families(problem, groups)
    for number, family in enumerate(asked):
        told = part_of(progress, number / len(asked), (number + 1) / len(asked))
        try:
            if not factors and positions.cycle is not None:
                notes += positions.cycle.warnings
            if not factors and not problem.oblique:
                top = load * family[-1][-1]
                known = None if common or family[-1][-1] != 1.0 else positions.cycle
                cycle = known or mesh_cycle(problem, top * cosine(problem), place, told)
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
            for kind, errors in enumerate(kinds):
                found = of_period_ahead(problem, slices, commonest, load * group[-1], of_period.index(errors) - common)
                # Where patches are those of the group below, its last load needs no second solution; a single load fades nothing.
                new = bool(factors) and len(group) > 1 and not same_patches(found, below[kind])
                bound = factors[-1:] if new else []
                columns = map_columns(slices, found, [load * f for f in (*bound, *group)], few=few)
                if bound:
                    columns = faded(columns, solved[kind][-1], [*bound, *group])
                if not factors:
                    touch.append(np.array([contact.gap.min() for contact in found.contacts]))
                solved[kind] += columns
                below[kind] = found
                told((kind + 1) / len(kinds), f"teeth {kind + 1} of {len(kinds)}")
            factors += group
        if factors[-1] < family[-1][-1]:
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


def _error(problem: ContactProblem, solved: ContactMap, load: float) -> float:
    """Largest difference (m along the flank normal) of a map to contacts that it has not seen, about a working force (N)."""
    along = cosine(problem)
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
