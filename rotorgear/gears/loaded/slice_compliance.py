"""Compliance between the slices of one position: C = sum over both gears of P G_o P', with o the distance of their tooth pairs.

P spreads a unit force on a slice over the flank's nodes, G_o is the flexibility of the gear between teeth o apart. A slice loads
few layers of the face, so that P G_o takes only their rows of G_o; positions are taken some at a time, which bounds the memory.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from rotorgear.gears.loaded.contact_points import PatchLoads, Slices, patch_loads
from rotorgear.gears.loaded.tooth_contact import ContactProblem

# Positions that are taken together.
_TOGETHER = 16


@dataclass(frozen=True)
class SliceCompliance:
    """Compliance of the slices of one position.

    Attributes:
        matrix: C (n, n) in m/N without the local part, symmetric.
        log_width: (n, 2) logarithm of the patches' half-widths across the contact line (m).
    """

    matrix: np.ndarray
    log_width: np.ndarray


def slice_compliances(
    problem: ContactProblem, slices: Slices, positions: Sequence[int], least: np.ndarray
) -> list[SliceCompliance]:
    """Compliances of the slices at some positions.

    Args:
        problem: the helix.
        slices: of all positions.
        positions: numbers of those asked for.
        least: (n,) least half-width of the patch of every slice, in normal modules.
    """
    found: list[SliceCompliance] = []
    for first in range(0, len(positions), _TOGETHER):
        found += _compliances(problem, slices, positions[first : first + _TOGETHER], least)
    return found


def _compliances(
    problem: ContactProblem, slices: Slices, positions: Sequence[int], least: np.ndarray
) -> list[SliceCompliance]:
    ranges = [slices.at(position) for position in positions]
    here = np.concatenate(ranges)
    some = slices.take(here)
    blocks = [_Block.of(some.pair, low, high) for low, high in pairwise(np.cumsum([0, *map(len, ranges)]).tolist())]
    matrices = [np.zeros((len(one), len(one))) for one in ranges]
    log_width = np.empty((len(here), 2))
    for gear in (0, 1):
        place = problem.place(gear, some.z)
        patches = patch_loads(some, gear, problem.compliance[gear], problem.module, place, least[here], problem.patch)
        log_width[:, gear] = np.log(problem.module * np.cos(problem.line.base_helix_angle)) + patches.log_width
        _add_gear(problem, gear, patches, blocks, matrices)
    return [
        SliceCompliance(_completed(problem, some.take(block.all), C), log_width[block.all])
        for block, C in zip(blocks, matrices, strict=True)
    ]


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
    for o in range(max(max(block.by_pair) - min(block.by_pair) for block in blocks) + 1):
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
