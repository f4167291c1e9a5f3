"""Contacts at positions of the mesh cycle under one load, with patches wider than the strips under them.

Patches replace the Hertz strips in the finite elements (`loaded_contact.py`), and a strip must not be wider than its patch. Each
position is solved, patches that its strips outgrow are widened, and only their rows of the compliance are spread anew. Patches of
oblique lines are all as wide as each other.

Compliance between the slices of one position: C = sum over both gears of P G_o P', with o the distance of their tooth pairs.
P spreads a unit force on a slice over the flank's nodes, G_o is the flexibility of the gear between teeth o apart. A slice loads
few layers of the face, so that P G_o takes only their rows of G_o; positions are taken some at a time, which bounds the memory.
Where patches grow, those of slices far from the ends of the flank stay what they are, and so does all between these.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.gears.loaded.contact_points import PatchLoads, Slices, patch_loads
from rotorgear.gears.loaded.loaded_contact import ContactState, PositionContact, solve_contact
from rotorgear.gears.loaded.tooth_contact import ContactProblem
from rotorgear.progress import Progress, silent

# In space each patch of a spur pair stays wider than its Hertz strip by this factor; all are wider than this in normal modules.
# Lines of spur teeth pass a tip all at once, and patches as narrow as that are as good as plane elements. A patch that has to
# grow becomes so much wider than its strip asks for.
_STRIP_MARGIN = 1.3
_LEAST_PATCH = 0.08
_WIDENING = 1.05
# Of oblique lines a small part is near a tip, where elements do not resolve narrower patches than this. (23/61, 12 deg, against
# 1.5 times as fine elements: largest pressure -1 %, with 0.08 +7 %.) Patches that grow slice by slice, from load to load, make
# ripples of some nm: so all of a cycle have one width, the first of 0.2, 0.25, ... that no strip on it exceeds. Where a
# strip is wider than 0.78 of it, its tangent is held, which is 1 % of what its slice gives way at most.
_LEAST_OBLIQUE_PATCH = 0.2
_NEXT_OBLIQUE_PATCH = 1.25
# In the plane a slice is a tooth pair's whole line. Its own compliance is seven times K / l and more, so that C + dg/dF stays
# positive definite for strips up to six times as wide as their patches.
_LEAST_TANGENT_IN_PLANE = -2.0
# Passes for the widths of patches.
PASSES = 12
# Wider strips (half-width over m_n) are no line contact any more.
_WIDEST_STRIP = 0.5


class WideContactError(AnalysisError):
    """A load under which the contact is no line any more."""


@dataclass(frozen=True)
class PatchedContacts:
    """Contacts under a load, their patches wider than the strips under them.

    Attributes:
        contacts: (p,) the contact at each position.
        states: (p,) its solution.
        patch: (n,) least half-widths of the patches in normal modules.
    """

    contacts: tuple[PositionContact, ...]
    states: tuple[ContactState, ...]
    patch: np.ndarray


def patched_contacts(
    problem: ContactProblem,
    slices: Slices,
    gap: np.ndarray,
    total: float,
    progress: Progress = silent,
    known: PatchedContacts | None = None,
    passes: int = PASSES,
    least: float = 0.0,
    *,
    narrowest: bool = False,
) -> PatchedContacts:
    """Contacts and states at all positions, with patches wider than the strips under them.

    Args:
        problem: the helix.
        slices: of all positions.
        gap: (n,) along the flank normal (m).
        total: normal force (N).
        progress: told how far it is.
        known: of the same slices with other gaps or under another load: patches grow from these, forces begin with these.
        passes: for the widths at most.
        least: where patches of oblique lines begin, in normal modules, in place of the narrowest.
        narrowest: patches begin as narrow as for the smallest loads although others are `known`, of whose compliances only rows
            that change are spread anew.
    """
    numbers = [slices.at(i) for i in range(int(slices.position[-1]) + 1)]
    count = len(numbers)
    narrow = max(least, _LEAST_OBLIQUE_PATCH) if problem.oblique else _LEAST_PATCH
    patch = known.patch.copy() if known and not narrowest else np.full(len(slices), narrow)
    contacts = {i: replace(one, gap=gap[numbers[i]]) for i, one in enumerate(known.contacts)} if known else {}
    start = {i: one.force for i, one in enumerate(known.states)} if known else {}
    if known is None or narrowest:
        contacts = _with_patches(problem, slices, gap, range(count), patch, contacts)
    states: dict[int, ContactState] = {}
    margin = 1.0 if problem.oblique else _STRIP_MARGIN
    to_solve = list(range(count))
    for number in range(passes):
        for i in to_solve:
            states[i] = solve_contact(contacts[i], total, start.get(i))
            start[i] = states[i].force
            strip = float(states[i].strip.max()) / problem.module
            if strip > _WIDEST_STRIP:
                raise WideContactError(
                    f"At this load the contact strip would be {2.0 * strip:.2g} modules wide, which is no line contact any more: "
                    "reduce the torque."
                )
            progress((i + 1) / count, f"contact {i + 1} of {count}")
        if problem.plane:
            break
        # The patches' half-widths lie in the transverse section; cos b_b brings them across the line.
        wanted = {i: margin * states[i].strip / problem.cosine / problem.module for i in to_solve}
        to_solve = [i for i in to_solve if np.any(wanted[i] > patch[numbers[i]])]
        if not to_solve or number + 1 == passes:
            break
        if problem.oblique:
            # One after the other: strips on too narrow patches are wider than on those that they ask for.
            patch *= _NEXT_OBLIQUE_PATCH
            to_solve = list(range(count))
            contacts = {}  # all rows are new
        else:
            for i in to_solve:
                short = wanted[i] > patch[numbers[i]]
                patch[numbers[i][short]] = _WIDENING * wanted[i][short]
        contacts |= _with_patches(problem, slices, gap, to_solve, patch, contacts)
    return PatchedContacts(tuple(contacts[i] for i in range(count)), tuple(states[i] for i in range(count)), patch)


def same_patches(first: PatchedContacts, second: PatchedContacts) -> bool:
    """Whether both have the same compliances, the second having grown from the first or the other way round."""
    return all(one.compliance is other.compliance for one, other in zip(first.contacts, second.contacts, strict=True))


def _with_patches(
    problem: ContactProblem,
    slices: Slices,
    gap: np.ndarray,
    positions: Sequence[int],
    patch: np.ndarray,
    known: dict[int, PositionContact],
) -> dict[int, PositionContact]:
    """Contacts at some positions with patches (n,) of such least half-widths; of those `known` only rows that change are new."""
    # In the plane of action: length of the contact line dz / cos b_b, and R = rho_1 rho_2 / (rho_1 + rho_2) with
    # rho = xi / cos b_b.
    length = slices.length / problem.cosine
    R = np.sum(slices.roll[0] * slices.roll[1] / slices.roll.sum(axis=0) * slices.weight, axis=1) / problem.cosine
    found = {}
    for first in range(0, len(positions), _TOGETHER):
        some = positions[first : first + _TOGETHER]
        compliances = _compliances(problem, slices, some, patch, [known[i] for i in some] if known else None)
        for i, (compliance, log_width) in zip(some, compliances, strict=True):
            here = slices.at(i)
            found[i] = PositionContact(
                compliance=compliance,
                gap=gap[here],
                length=length[here],
                local=problem.local,
                log_width=log_width,
                radius=R[here],
                modulus=problem.modulus,
                least_tangent=_LEAST_TANGENT_IN_PLANE if problem.plane else 0.01,
            )
    return found


# Positions that are taken together.
_TOGETHER = 16


# The slices of one position among those taken together, and those of each of its tooth pairs, which stand in a row.
_Block = tuple[slice, dict[int, slice]]


def _compliances(
    problem: ContactProblem,
    slices: Slices,
    positions: Sequence[int],
    least: np.ndarray,
    known: Sequence[PositionContact] | None,
) -> list[tuple[np.ndarray, np.ndarray]]:
    """Compliances of the slices at some positions, on patches of least half-widths (n,) in normal modules.

    Args:
        problem: the helix; slices: of all positions; positions: numbers of those asked for.
        least: of every slice.
        known: the contacts at all these positions in space with other patches.

    Returns:
        For each position C (n, n) in m/N without the local part, symmetric, and (n, 2) the logarithm of the patches' half-widths
        across the contact line (m).
    """
    ranges = [slices.at(position) for position in positions]
    here = np.concatenate(ranges)
    some = slices.take(here)
    blocks: list[_Block] = []
    for low, high in pairwise(np.cumsum([0, *map(len, ranges)]).tolist()):
        number, start = np.unique(some.pair[low:high], return_index=True)
        ends = pairwise([*(low + start).tolist(), high])
        blocks.append((slice(low, high), {k: slice(*one) for k, one in zip(number.tolist(), ends, strict=True)}))
    matrices = [np.zeros((len(one), len(one))) for one in ranges]
    patches = [
        patch_loads(some, gear, problem.compliance[gear], problem.module, least[here], problem.patch) for gear in (0, 1)
    ]
    log_width = np.log(problem.module * problem.cosine) + np.stack([one.log_width for one in patches], axis=1)
    changed = None
    if known is not None:
        changed = np.any(log_width != np.concatenate([one.log_width for one in known]), axis=1)
    for gear in (0, 1):
        _add(problem, gear, patches[gear], blocks, matrices, changed)
    if known is None or changed is None:
        done = [_completed(problem, some.take(block), C) for (block, _), C in zip(blocks, matrices, strict=True)]
    else:
        done = [
            _with_rows(old.compliance, C, np.flatnonzero(changed[block]))
            for old, C, (block, _) in zip(known, matrices, blocks, strict=True)
        ]
    return [(C, log_width[block]) for (block, _), C in zip(blocks, done, strict=True)]


def _add(
    problem: ContactProblem,
    gear: int,
    patches: PatchLoads,
    blocks: list[_Block],
    matrices: list[np.ndarray],
    chosen: np.ndarray | None,
) -> None:
    """Add P G_o P' of one gear, the pair of the row being o ahead of that of the column.

    All rows with o >= 0, or `chosen` (n,) rows with pairs before and behind.
    """
    compliance = problem.compliance[gear]
    # Pair k + 1 of the pinion stands clockwise of pair k, that of the gear the other way.
    side = 1 if gear == 0 else -1
    # Largest distance of pairs at one position that still feel each other.
    span = min(compliance.reach, max(max(by_pair) - min(by_pair) for _, by_pair in blocks))
    for o in range(0 if chosen is None else -span, span + 1):
        touching = []
        for (block, by_pair), C in zip(blocks, matrices, strict=True):
            for k, of_pair in by_pair.items():
                if k - o in by_pair:
                    rows = np.arange(of_pair.start, of_pair.stop)
                    rows = rows if chosen is None else rows[chosen[of_pair]]
                    touching.append((C, rows, by_pair[k - o], block.start))
        if not touching:
            continue
        moved = patches.moved(compliance.response(side * o), np.concatenate([rows for _, rows, _, _ in touching]))
        first = 0
        for C, rows, columns, low in touching:
            part = moved[first : first + len(rows)] @ patches.loads[columns].T
            C[rows - low, columns.start - low : columns.stop - low] += problem.scale[gear] * part
            first += len(rows)


def _with_rows(C: np.ndarray, other: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """A symmetric matrix with some rows and columns of another one."""
    found = C.copy()
    found[rows] = other[rows]
    found[:, rows] = other[rows].T
    return np.asarray(0.5 * (found + found.T))


def _completed(problem: ContactProblem, slices: Slices, C: np.ndarray) -> np.ndarray:
    """The whole symmetric matrix of a position's slices from the part whose rows are not behind their columns."""
    pair = slices.pair
    # Entry -o of a gear's flexibility is the transpose of entry o.
    C = np.where(pair[:, None] >= pair, C, C.T)
    if problem.plane:
        C = C / slices.length  # a plane model answers to a force per width
    if problem.uncoupled:
        z = slices.z[:, 0]
        C = np.where(np.abs(z[:, None] - z) < 1e-9 * problem.width, C, 0.0)
    return np.asarray(0.5 * (C + C.T))
