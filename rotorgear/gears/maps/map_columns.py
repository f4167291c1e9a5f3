"""Columns of a contact map: approach, slope and moment at all positions under rising loads, with the patches of the largest.

Each position goes down from its largest load, every solution beginning with what those above it lead to.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from rotorgear.gears.loaded.contact_points import Slices
from rotorgear.gears.loaded.loaded_contact import ContactState, PositionContact, solve_contact, solve_many
from rotorgear.gears.loaded.settled_contacts import Settled

# Change of the forces over the load in the last round: 1e-7 of the approach is left at most, and loads and positions lie farther
# apart than that.
_TOLERANCE = 1e-6


@dataclass(frozen=True)
class Column:
    """Approach along the normal (p,) in m, its slope d delta / dF (p,) in m/N, moment (p,) in N m, at one load."""

    approach: np.ndarray
    slope: np.ndarray
    moment: np.ndarray


def map_columns(slices: Slices, found: Settled, loads: list[float], *, few: bool) -> list[Column]:
    """Columns at rising normal forces (N), the contacts being settled under the last one.

    Args:
        slices: of all positions.
        found: the contacts.
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
    return [Column(*(np.array([row[j][i] for row in rows]) for i in range(3))) for j in range(len(loads))]


def _few_slices(contacts: Sequence[PositionContact], loads: list[float]) -> list[Column]:
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
    return [Column(found[0, :, j], found[1, :, j], np.zeros(len(contacts))) for j in range(len(loads))]


def _row(
    contact: PositionContact, state: ContactState, loads: list[float], place: np.ndarray
) -> list[tuple[float, float, float]]:
    """Approach, its slope and the moment at rising loads of one position: down from the largest, each from those above.

    `place` (n,) is that of each slice from the middle of the face (m), `state` the solution at the largest load.
    """
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
        state = solve_contact(fewer, load, start, _TOLERANCE)
        rate = (force - state.force) / (at - load)
        force = state.force
        at = load
        found.append((state.approach, 1.0 / state.tangent, float(state.force @ place[near])))
    return found[::-1]


def faded(columns: list[Column], below: Column, factors: list[float]) -> list[Column]:
    """Columns above a bound, the first of them at it, led from the value `below` it to their own at the last load."""
    jump = columns[0].approach - below.approach
    turn = columns[0].moment - below.moment
    left = [(factors[-1] - factor) / (factors[-1] - factors[0]) for factor in factors[1:]]
    return [
        Column(column.approach - jump * share, column.slope, column.moment - turn * share)
        for column, share in zip(columns[1:], left, strict=True)
    ]


def with_start(slope: np.ndarray, approach: np.ndarray, loads: np.ndarray) -> np.ndarray:
    """Slopes (p, l) with that at no load: of the parabola through the first two points with the slope at the second."""
    first = 2.0 * (approach[:, 1] - approach[:, 0]) / loads[1] - slope[:, 0]
    return np.column_stack([np.maximum(first, slope[:, 0]), slope])
