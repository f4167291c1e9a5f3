"""Periods of a contact map that errors of single teeth make differ: period n has the pairs whose teeth are n ahead."""

from __future__ import annotations

import math

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.gears.loaded.tooth_contact import ContactProblem

# More differing periods than these are refused.
_MOST_DIFFERING = 128
# More periods than these make no map.
_MOST_PERIODS = 4096


def errors_by_period(problem: ContactProblem) -> list[tuple[float, ...]]:
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
