"""Where a contact map is solved: positions in a base pitch, the even ones that it keeps, its loads, and its differing periods.

The approach of a spur pair has a kink wherever a pair comes into contact or leaves it. Positions chosen there and where the curve
of the working load needs them are worth many times as many even ones (64 of a crowned pair 512). The map keeps even ones, so
that a law finds its place in one step:

    delta(F_j; u) = delta(F_w; u) + [delta(F_j; u_i) - delta(F_w; u_i)],

the curve of the working load F_w by cubics between the positions u_i (`cycle_curve.py`), the difference to the others straight
between them: their kinks stand elsewhere. So the approach rises with the load at all positions, as it does at u_i. Helical pairs
have no kinks. Their differences from load to load are cubics too, for helices that share a load carry a third of F_w or twice as
much; held to half of the straight ones at least, so that the approach rises.

Errors of single teeth make periods differ: period n has the pairs whose teeth are n ahead.

Loads are multiples of the working load, in groups whose largest load decides the patches. In the plane patches follow no load,
and one group has all loads. In space those of a spur pair follow the load from group to group; of a helical pair most loads
have the same, so that its groups only spare it looking for their width under every load.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.gears.loaded.helix_cycles import helix_cycle
from rotorgear.gears.loaded.mesh_cycle import MeshCycle
from rotorgear.gears.loaded.tooth_contact import ContactProblem
from rotorgear.gears.stiffness.cycle_curve import CycleCurve
from rotorgear.gears.stiffness.mesh_stiffness import ToothPair

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
# Linear analyses of spur pairs stay near the mean load of a contact, but helices and branches need not share alike: some carry a
# third of the working load, others twice as much.
_NEAR_IN_SPACE = (*_UP_TO_WORKING, (1.12, 1.25, 1.4), (1.6, 1.8, 2.0))
# Loads of helical pairs are closer in this range: they share slices and patches, so that one costs little, and curves of
# herringbone pairs and loops are as small as 0.02 um. In two parts each step missed 3.8 % of such a one, in three 0.15 %.
_FINER = (0.2, 2.3)
_PARTS = 3
# Slices of a spur pair reach as far beyond the line of action as corners touch: groups up to the working load, up to this
# multiple of it, and above have slices of their own.
_MODERATE = 2.5


def load_groups(problem: ContactProblem, near: bool = False) -> tuple[tuple[float, ...], ...]:
    """Groups of rising loads over the working one; `near`: in space up to about twice it only, for linear analyses."""
    if problem.one_slice:
        return _IN_PLANE
    groups = _NEAR_IN_SPACE if near else _IN_SPACE
    if not problem.oblique:
        return groups
    # More loads in a range, evenly between each two.
    found = []
    before = 0.0
    for group in groups:
        loads: list[float] = []
        for factor in group:
            near_working = before > _FINER[0] and factor < _FINER[1]
            loads += [before + (factor - before) * k / _PARTS for k in range(1, _PARTS)] if near_working else []
            loads.append(factor)
            before = factor
        found.append(tuple(loads))
    return tuple(found)


def families(problem: ContactProblem, groups: tuple[tuple[float, ...], ...]) -> list[tuple[tuple[float, ...], ...]]:
    """Groups that share slices: all of oblique lines; else up to the working load, up to `_MODERATE` times it, and above."""
    if problem.oblique:
        return [groups]
    borders = (0.0, 1.0, _MODERATE, np.inf)
    found = [tuple(group for group in groups if low < group[-1] <= high) for low, high in pairwise(borders)]
    return [family for family in found if family]


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
        told.append(np.where(np.isin(tooth % z, [number % z for number, _ in flank.tooth_topography]), tooth % z, -1))
    found = [tuple(row.tolist()) for row in np.concatenate(told, axis=1)]
    differing = len(set(found))
    if differing > _MOST_DIFFERING:
        raise AnalysisError(
            f"The errors of single teeth make {differing} of {periods} base pitches differ, and {_MOST_DIFFERING} can be solved: "
            "give errors to fewer teeth."
        )
    return found if differing > 1 else found[:1]


# Even positions that a map keeps of a base pitch.
_KEPT = 256


@dataclass(frozen=True)
class MapPositions:
    """Positions of one base pitch.

    Attributes:
        position: (n,) rising from 0.
        event: (n,) whether curves have a kink there; None where the positions are even and the map keeps them.
        cycle: the contact under the working load there, where it is known.
    """

    position: np.ndarray
    event: np.ndarray | None = None
    cycle: MeshCycle | None = None

    @property
    def each(self) -> int:
        """Positions that a map keeps of each base pitch."""
        return len(self.position) if self.event is None else _KEPT

    def kept(
        self, approach: np.ndarray, compliance: np.ndarray, moment: np.ndarray, working: int
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Positions (p,) over all base pitches that a map keeps, and its columns there.

        Args:
            approach, compliance, moment: (periods n, l) at these positions of all base pitches, for l loads.
            working: number of the working load.
        """
        n = len(self.position)
        periods = len(approach) // n
        if self.event is None:
            return np.arange(periods * n) / n, approach, compliance, moment
        u = (np.arange(periods)[:, None] + self.position).ravel()
        even = np.arange(periods * _KEPT) / _KEPT

        def straight(values: np.ndarray) -> np.ndarray:
            return np.stack([np.interp(even, u, column, period=float(periods)) for column in values.T], axis=1)

        def smooth(values: np.ndarray) -> np.ndarray:
            assert self.event is not None
            return CycleCurve(u, values, float(periods), np.tile(self.event, periods)).at(even)

        one = approach[:, [working]]
        if self.event.any():
            # Compliances step at events, and moments climb steeply there: between positions they are straight.
            return even, smooth(one) + straight(approach - one), straight(compliance), straight(moment)
        steps = np.diff(approach, axis=1)
        rise = np.cumsum(np.maximum(smooth(steps), 0.5 * straight(steps)), axis=1)
        rise = np.column_stack([np.zeros(len(even)), rise])
        softness = np.maximum(smooth(compliance), 0.5 * straight(compliance))
        return even, smooth(one) + rise - rise[:, [working]], softness, smooth(moment)


def map_positions(teeth: ToothPair, load: float, count: int) -> MapPositions:
    """So many positions for F_bt = load (N): of a spur pair where its curve needs them, of a helical one even."""
    if teeth.first.helix_angle:
        return MapPositions(np.arange(count) / count, np.zeros(count, bool))
    found = helix_cycle(teeth, load, count)
    event = np.zeros(count, bool) if found.event is None else found.event
    return MapPositions(found.cycle.position, event, found.cycle)
