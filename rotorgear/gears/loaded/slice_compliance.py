"""Compliance between the slices of one position: C = sum over both gears of P G_o P', with o the distance of their tooth pairs.

P spreads a unit force on a slice over the flank's nodes, G_o is the flexibility of the gear between teeth o apart. A slice loads
few layers of the face, so that P G_o takes only their rows of G_o; positions are taken some at a time, which bounds the memory.
Where patches grow, those of slices far from the ends of the flank stay what they are, and so does all between these.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from rotorgear.gears.loaded.contact_points import PatchLoads, Slices, patch_loads
from rotorgear.gears.loaded.tooth_contact import ContactProblem
from rotorgear.gears.tooth_fe.gear_compliance import GearCompliance

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
        before = None if known is None else [known[i] for i in some]
        found += _compliances(problem, slices, some, least, before)
    return found


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
    blocks = [_Block.of(some.pair, low, high) for low, high in pairwise(np.cumsum([0, *map(len, ranges)]).tolist())]
    matrices = [np.zeros((len(one), len(one))) for one in ranges]
    log_width = np.empty((len(here), 2))
    patches = []
    for gear in (0, 1):
        place = problem.place(gear, some.z)
        patches.append(
            patch_loads(some, gear, problem.compliance[gear], problem.module, place, least[here], problem.patch)
        )
        log_width[:, gear] = np.log(problem.module * np.cos(problem.line.base_helix_angle)) + patches[gear].log_width
    if known is None:
        for gear in (0, 1):
            _add_gear(problem, gear, patches[gear], blocks, matrices)
        done = [_completed(problem, some.take(block.all), C) for block, C in zip(blocks, matrices, strict=True)]
    else:
        changed = np.any(log_width != np.concatenate([width for _, width in known]), axis=1)
        for gear in (0, 1):
            _add_rows(problem, gear, patches[gear], blocks, matrices, changed)
        done = [
            _with_rows(old, C, np.flatnonzero(changed[block.all]))
            for (old, _), C, block in zip(known, matrices, blocks, strict=True)
        ]
    return [(C, log_width[block.all]) for block, C in zip(blocks, done, strict=True)]


@dataclass(frozen=True)
class _Block:
    """The slices of one position among those taken together, and those of each of its tooth pairs, which stand in a row."""

    all: slice
    by_pair: dict[int, slice]

    @classmethod
    def of(cls, pair: np.ndarray, low: int, high: int) -> _Block:
        """Block of the slices low to high, with pair numbers (n,) that rise."""
        number, start = np.unique(pair[low:high], return_index=True)
        ends = [*(low + start).tolist(), high]
        return cls(slice(low, high), {k: slice(*one) for k, one in zip(number.tolist(), pairwise(ends), strict=True)})


def _add_gear(
    problem: ContactProblem, gear: int, patches: PatchLoads, blocks: list[_Block], matrices: list[np.ndarray]
) -> None:
    """Add P G_o P' of one gear where the pair of the row is o >= 0 ahead of that of the column."""
    compliance = problem.compliance[gear]
    # Pair k + 1 of the pinion stands clockwise of pair k, that of the gear the other way.
    side = 1 if gear == 0 else -1
    for o in range(_span(blocks, compliance) + 1):
        touching = [
            (block, C, rows, block.by_pair[k - o])
            for block, C in zip(blocks, matrices, strict=True)
            for k, rows in block.by_pair.items()
            if k - o in block.by_pair
        ]
        asked = np.concatenate([np.arange(rows.start, rows.stop) for _, _, rows, _ in touching])
        moved = patches.moved(compliance.response(side * o), asked)
        first = 0
        for block, C, rows, columns in touching:
            last = first + rows.stop - rows.start
            part = moved[first:last] @ patches.loads[columns].T
            low = block.all.start
            C[rows.start - low : rows.stop - low, columns.start - low : columns.stop - low] += (
                problem.scale[gear] * part
            )
            first = last


def _span(blocks: list[_Block], compliance: GearCompliance) -> int:
    """Largest distance of pairs at one position that still feel each other."""
    return min(compliance.reach, max(max(block.by_pair) - min(block.by_pair) for block in blocks))


def _add_rows(
    problem: ContactProblem,
    gear: int,
    patches: PatchLoads,
    blocks: list[_Block],
    matrices: list[np.ndarray],
    chosen: np.ndarray,
) -> None:
    """Add P G_o P' of one gear in the rows of chosen (n,) slices, for pairs before and behind."""
    compliance = problem.compliance[gear]
    side = 1 if gear == 0 else -1
    span = _span(blocks, compliance)
    for o in range(-span, span + 1):
        touching = [
            (block, C, rows.start + np.flatnonzero(chosen[rows]), block.by_pair[k - o])
            for block, C in zip(blocks, matrices, strict=True)
            for k, rows in block.by_pair.items()
            if k - o in block.by_pair and chosen[rows].any()
        ]
        if not touching:
            continue
        moved = patches.moved(compliance.response(side * o), np.concatenate([rows for _, _, rows, _ in touching]))
        first = 0
        for block, C, rows, columns in touching:
            part = moved[first : first + len(rows)] @ patches.loads[columns].T
            low = block.all.start
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
