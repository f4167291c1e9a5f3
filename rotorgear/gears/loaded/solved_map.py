"""The contact map of a tooth pair: its loads, the contact solved for all of them, and the periods that pitch errors make differ.

Slices and compliances of a position serve several loads. In space they serve those between two bounds, since patches and reach of
corners follow the load; what the change of patches moves at such a bound fades away towards the next one.

In the plane positions are even and dense, for solutions are cheap. In space those of a spur pair are chosen where pairs come and
go and where the curve of the working load needs them; those of a helical pair, whose curves are smooth, are even. Either is read
by cubics at more even positions, which the map keeps (`map_positions.py`).

With pitch errors, period n has the pairs whose teeth are n ahead. Periods in which the same errors touch are solved once.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.gears.loaded.contact_map import ContactMap
from rotorgear.gears.loaded.loaded_contact import PositionContact, solve_contact, solve_many
from rotorgear.gears.loaded.map_positions import MapPositions, even_positions, map_positions
from rotorgear.gears.loaded.map_store import kept_map
from rotorgear.gears.loaded.mesh_cycle import MeshCycle, WideContactError, mesh_cycle, settled
from rotorgear.gears.loaded.tooth_contact import ContactProblem, contact_problem
from rotorgear.gears.stiffness.mesh_stiffness import ToothPair
from rotorgear.progress import Progress, listener, part_of

# Positions that are solved in a base pitch, in the plane and in space. In the plane the approach has a kink wherever a tooth pair
# comes or goes.
POSITIONS = (512, 96)
# Loads as multiples of the working load: resonances with contact loss reach four to five times it. In the plane pairs come and go
# suddenly with the load too, and solutions are cheap.
_IN_PLANE = ((0.003, 0.01, *(0.025 * np.arange(1, 81)), *(2.0 + 0.05 * np.arange(1, 61))),)
# In space the largest load of each group decides patches and corners, so that there the contact is as `rotorgear mesh` solves it
# at that load; the working load is such a one. Patches of three times the load would move the approach by 0.2 % and its
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
# working load, others twice as much. Kinks of spur pairs need more positions than smooth curves of helical ones.
_NEAR_POSITIONS = {"spur": 128, "helical": 64}
_NEAR_IN_SPACE = (*_UP_TO_WORKING, (1.12, 1.25, 1.4), (1.6, 1.8, 2.0))
# More differing periods than these are refused.
_MOST_DIFFERING = 128
# More periods than these make no map.
_MOST_PERIODS = 4096


@dataclass(frozen=True)
class _Column:
    """Approach along the normal (p,) in m, its slope d delta / dF (p,) in m/N, moment (p,) in N m, at one load."""

    approach: np.ndarray
    slope: np.ndarray
    moment: np.ndarray


@lru_cache(maxsize=32)  # the helices of a model and its analyses ask for the same maps again and again
def contact_map(teeth: ToothPair, load: float, positions: int | None = None, near: bool = False) -> ContactMap:
    """Solve the loaded contact over the mesh cycle for loads up to five times the working one.

    Args:
        teeth: one helix.
        load: working force (N) along the flank normal.
        positions: so many even ones in a base pitch, and the map keeps these; default 512 even ones in the plane, and in space
            where the curves need them: 128 of a spur pair, 96 of a helical one, or 64 near the working load.
        near: for linear analyses: in space fewer loads, up to about twice the working one.

    Raises:
        AnalysisError: teeth that can't be made, meshed or brought into contact; pitch errors that make too many periods differ.
        WideContactError: a working load under which the contact is no line any more.
        ConvergenceError: a position has no solution to the tolerance.
        MissingExtraError: scikit-fem is needed and not installed.
    """

    def solve() -> ContactMap:
        progress = listener()
        problem = contact_problem(teeth, part_of(progress, 0.0, 0.5))
        told = part_of(progress, 0.5, 1.0)
        if problem.plane and not problem.uncoupled:
            # One slice for a tooth pair: cheap, with patches that follow no load, so that one group has all loads.
            return solved_map(problem, load, even_positions(positions or POSITIONS[0]), _IN_PLANE, told)
        groups = _NEAR_IN_SPACE if near else _IN_SPACE
        if positions:
            return solved_map(problem, load, even_positions(positions), groups, told)
        few = _NEAR_POSITIONS["helical" if teeth.first.helix_angle else "spur"]
        chosen = map_positions(teeth, load * _cosine(problem), few if near else max(few, POSITIONS[1]))
        return solved_map(problem, load, chosen, groups, told)

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
    solved: list[list[_Column]] = [[] for _ in kinds]
    touch: list[np.ndarray] = []
    notes: list[str] = []
    factors: list[float] = []
    for number, group in enumerate(groups):
        told = part_of(progress, number / len(groups), (number + 1) / len(groups))
        try:
            known = positions.cycle if group[-1] == 1.0 and not common else None
            cycle = known or mesh_cycle(problem, group[-1] * load * _cosine(problem), common + positions.position, told)
        except WideContactError:
            if not factors:
                raise
            notes.append(
                f"the loaded teeth were solved up to {factors[-1]:.3g} times the working load; above it their contact is no line"
            )
            break
        bound = factors[-1:]
        for kind, errors in enumerate(kinds):
            columns, gaps = _columns(
                problem, cycle, [load * f for f in (*bound, *group)], of_period.index(errors) - common
            )
            if bound:
                columns = _faded(columns, solved[kind][-1], [*bound, *group])
            else:
                touch.append(gaps)
                notes += cycle.warnings
            solved[kind] += columns
            told((kind + 1) / len(kinds), f"teeth {kind + 1} of {len(kinds)}")
        factors += group
    loads = load * np.array([0.0, *factors])
    approach = [np.stack([touch[k], *(c.approach for c in solved[k])], axis=1) for k in range(len(kinds))]
    slope = [_with_start(np.stack([c.slope for c in solved[k]], axis=1), approach[k], loads) for k in range(len(kinds))]
    moment = [np.stack([np.zeros(len(positions.position)), *(c.moment for c in columns)], axis=1) for columns in solved]
    order = [kinds.index(errors) for errors in of_period]
    varies = not problem.plane or problem.uncoupled
    working = int(np.argmin(np.abs(loads - load)))
    position, *curves = positions.kept(
        np.concatenate([approach[k] for k in order]),
        np.concatenate([slope[k] for k in order]),
        np.concatenate([moment[k] for k in order]),
        working,
    )
    return ContactMap(
        position=position,
        periods=len(of_period),
        load=loads,
        approach=curves[0],
        warnings=tuple(dict.fromkeys((*problem.warnings, *notes))),
        compliance=curves[1],
        moment=curves[2] if varies else None,
    )


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


def _columns(
    problem: ContactProblem, cycle: MeshCycle, loads: list[float], period: int
) -> tuple[list[_Column], np.ndarray]:
    """Approaches at normal forces that rise to that of the cycle, so many periods after it; and that of first touch, (p,)."""
    gap = problem.gap(cycle.slices, period)
    contacts = list(cycle.contacts)
    if any(flank.single_teeth for flank in problem.flanks):
        contacts = settled(problem, cycle.slices, gap, loads[-1], known=(contacts, cycle.patch))[0]
    if problem.plane and not problem.uncoupled:
        columns = _few_slices(contacts, loads)
    else:
        place = cycle.slices.z @ cycle.slices.weight
        rows = [_row(contact, loads, place[cycle.slices.at(i)]) for i, contact in enumerate(contacts)]
        columns = [_Column(*(np.array([row[j][i] for row in rows]) for i in range(3))) for j in range(len(loads))]
    return columns, np.array([contact.gap.min() for contact in contacts])


def _few_slices(contacts: list[PositionContact], loads: list[float]) -> list[_Column]:
    """Columns of a pair that has one slice for a tooth pair: all positions with as many pairs, and all loads, at once."""
    found = np.empty((2, len(contacts), len(loads)))
    for n in {len(contact.gap) for contact in contacts}:
        which = [i for i, contact in enumerate(contacts) if len(contact.gap) == n]

        def stacked(name: str, which: list[int] = which) -> np.ndarray:
            return np.repeat(np.stack([getattr(contacts[i], name) for i in which]), len(loads), axis=0)

        many = replace(
            contacts[which[0]],
            compliance=stacked("compliance"),
            gap=stacked("gap"),
            length=stacked("length"),
            log_width=stacked("log_width"),
            radius=stacked("radius"),
        )
        approach, tangent = solve_many(many, np.tile(loads, len(which)))
        found[:, which] = np.stack([approach, 1.0 / tangent]).reshape(2, len(which), len(loads))
    return [_Column(found[0, :, j], found[1, :, j], np.zeros(len(contacts))) for j in range(len(loads))]


def _row(contact: PositionContact, loads: list[float], place: np.ndarray) -> list[tuple[float, float, float]]:
    """Approach, its slope and the moment at rising loads of one position: down from the largest, each from those above.

    `place` (n,) is that of each slice from the middle of the face (m).
    """
    state = solve_contact(contact, loads[-1])
    # A slice whose gap is wider than the approach at the largest load touches at none.
    near = np.flatnonzero((contact.gap < state.approach) | (state.force > 0.0))
    fewer = replace(
        contact,
        compliance=contact.compliance[np.ix_(near, near)],
        gap=contact.gap[near],
        length=contact.length[near],
        log_width=contact.log_width[near],
        radius=contact.radius[near],
    )
    force = state.force[near]
    # How the forces change with the load, from the two loads above; below the first one they are taken in proportion.
    rate = force / loads[-1]
    at = loads[-1]
    found = [(state.approach, 1.0 / state.tangent, float(state.force @ place))]
    for load in reversed(loads[:-1]):
        start = np.maximum(force + rate * (load - at), 0.0)
        state = solve_contact(fewer, load, start)
        rate = (force - state.force) / (at - load)
        force = state.force
        at = load
        found.append((state.approach, 1.0 / state.tangent, float(state.force @ place[near])))
    return found[::-1]


def _faded(columns: list[_Column], below: _Column, factors: list[float]) -> list[_Column]:
    """Columns above a bound, the first of them at it, led from the value `below` it to their own at the last load."""
    jump = columns[0].approach - below.approach
    turn = columns[0].moment - below.moment
    left = [(factors[-1] - factor) / (factors[-1] - factors[0]) for factor in factors[1:]]
    return [
        _Column(column.approach - jump * share, column.slope, column.moment - turn * share)
        for column, share in zip(columns[1:], left, strict=True)
    ]


def _with_start(slope: np.ndarray, approach: np.ndarray, loads: np.ndarray) -> np.ndarray:
    """Slopes (p, l) with that at no load: of the parabola through the first two points with the slope at the second."""
    first = 2.0 * (approach[:, 1] - approach[:, 0]) / loads[1] - slope[:, 0]
    return np.column_stack([np.maximum(first, slope[:, 0]), slope])
