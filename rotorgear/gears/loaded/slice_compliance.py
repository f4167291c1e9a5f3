"""Compliance between the slices of one position: C = sum over both gears of P G_o P', with o the distance of their tooth pairs.

P spreads a unit force on a slice over the flank's nodes, G_o is the flexibility of the gear between teeth o apart. A slice loads
few layers of the face, so that P G_o takes only their rows of G_o; positions are taken some at a time, which bounds the memory.
Where patches grow, those of slices far from the ends of the flank stay what they are, and so does all between these.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np

from rotorgear.gears.loaded.contact_points import PatchLoads, Slices, patch_loads
from rotorgear.gears.loaded.tooth_contact import ContactProblem

# Positions that are taken together.
_TOGETHER = 16


def slice_compliances(
    problem: ContactProblem,
    slices: Slices,
    positions: Sequence[int],
    least: np.ndarray,
    known: Mapping[int, tuple[np.ndarray, np.ndarray]] | None = None,
) -> list[tuple[np.ndarray, np.ndarray]]:
    """Compliances of the slices at some positions.

    Args:
        problem: the helix.
        slices: of all positions.
        positions: numbers of those asked for.
        least: (n,) least half-width of the patch of every slice, in normal modules.
        known: those of all these positions in space with other patches.

    Returns:
        For each position C (n, n) in m/N without the local part, symmetric, and (n, 2) the logarithm of the patches' half-widths
        across the contact line (m).
    """
    found: list[tuple[np.ndarray, np.ndarray]] = []
    for first in range(0, len(positions), _TOGETHER):
        some = positions[first : first + _TOGETHER]
        found += _compliances(problem, slices, some, least, None if known is None else [known[i] for i in some])
    return found


# The slices of one position among those taken together, and those of each of its tooth pairs, which stand in a row.
_Block = tuple[slice, dict[int, slice]]


def _compliances(
    problem: ContactProblem,
    slices: Slices,
    positions: Sequence[int],
    least: np.ndarray,
    known: Sequence[tuple[np.ndarray, np.ndarray]] | None,
) -> list[tuple[np.ndarray, np.ndarray]]:
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
        changed = np.any(log_width != np.concatenate([width for _, width in known]), axis=1)
    for gear in (0, 1):
        _add(problem, gear, patches[gear], blocks, matrices, changed)
    if known is None or changed is None:
        done = [_completed(problem, some.take(block), C) for (block, _), C in zip(blocks, matrices, strict=True)]
    else:
        done = [
            _with_rows(old, C, np.flatnonzero(changed[block]))
            for (old, _), C, (block, _) in zip(known, matrices, blocks, strict=True)
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
