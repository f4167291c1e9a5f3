"""Loaded contact of the helices of a mesh over one cycle, to which positions are added where their common curves need them.

Helices share the load evenly, and the mesh approaches by their mean.

The contact itself tells where tooth pairs come into contact and leave it. Between a position where pair k carries nothing and
one where it does, the least of the openings of its slices under load,

    s_k(u) = min (C F + gap - delta)_j,     for slices that carry: -C_jj F_j, the overlap that their own force takes away,

crosses zero (`MeshCycle.opening`). On the open side it is smooth, so that chords find the crossing within a few solutions. What
the geometry of a spur pair knows beforehand are the ends A and E of the line of action, which with the base pitch are those of
single contact too (B, D), and where linear reliefs begin.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from rotorgear.gears.loaded.cycle_positions import SampledCurves, sampled
from rotorgear.gears.loaded.mesh_cycle import MeshCycle, loaded_cycle, with_more
from rotorgear.gears.loaded.tooth_contact import ContactProblem, line_of_action
from rotorgear.gears.stiffness.cycle_curve import CycleCurve
from rotorgear.gears.stiffness.mesh_stiffness import MeshStiffness, ToothPair
from rotorgear.progress import Progress, listener, part_of, silent

# A chord's zero keeps this share of the bracket away from its ends, until the bracket is short.
_INSIDE = 1e-3
# A position nearer to one end of a bracket than this share of its length shows that chords come from that side.
_NEAR = 0.3
# Brackets shorter than this, in base pitches, are not looked into any more.
_FOUND = 1e-5
# Positions to either side of a step, in base pitches.
_BESIDE = 4e-6


def contact_events(cycle: MeshCycle, period: float) -> tuple[np.ndarray, np.ndarray]:
    """Guesses (k,) of where pairs come and go, and the solved position (k,) next to each.

    Args:
        cycle: at rising positions within one cycle.
        period: its length in base pitches, after which pair k stands where pair k + period stood.
    """
    n = len(cycle.position)
    u = cycle.position
    # Beyond both ends the cycle goes on, with other pairs in these ones' places.
    around = np.concatenate([u[-2:] - period, u, u[:2] + period])
    pair = cycle.slices.pair
    nearest_pair = int(pair.min())
    least = np.full((int(pair.max()) - nearest_pair + 1, n), np.inf)
    np.minimum.at(least, (pair - nearest_pair, cycle.slices.position), cycle.opening)
    nowhere = np.full(n, np.inf)
    turn = round(period)

    def of_pair(k: int) -> np.ndarray:
        """Infinite where the pair is too far away to have slices."""
        return np.asarray(least[k - nearest_pair]) if 0 <= k - nearest_pair < len(least) else nowhere

    guesses = []
    nearest = []
    for k in range(nearest_pair - turn, nearest_pair + len(least) + turn):
        s = np.concatenate([of_pair(k - turn)[-2:], of_pair(k), of_pair(k + turn)[:2]])
        for i in np.flatnonzero((s[1:-2] < 0.0) != (s[2:-1] < 0.0)) + 1:
            share = _crossing(around[i - 1 : i + 3], s[i - 1 : i + 3])
            if around[i + 1] - around[i] > _FOUND:
                guesses.append(around[i] + share * (around[i + 1] - around[i]))
            nearest.append(around[i] if share < 0.5 else around[i + 1])
    return np.mod(guesses, period), np.mod(nearest, period)


def _crossing(u: np.ndarray, s: np.ndarray) -> float:
    """Share of the way from the second to the third of four positions where s crosses zero."""
    opened_first = s[1] > 0.0
    u = u if opened_first else -u[::-1]
    before, low, high, _ = s if opened_first else s[::-1]
    width = u[2] - u[1]
    share = 0.5
    if np.isfinite(low) and np.isfinite(high):
        share = low / (low - high)
    if np.isfinite(low) and np.isfinite(before) and before > low:
        # The open side is smooth: its own chord goes on to the crossing.
        ahead = low / (before - low) * (u[1] - u[0]) / width
        share = ahead if ahead < 1.0 else share
    # Chords that come from one side only are made to overshoot: then the crossing is between two near positions.
    beside = (u[1] - u[0] < _NEAR * width, u[3] - u[2] < _NEAR * width)
    if beside == (True, False):
        share = min(2.0 * share, 0.5)
    elif beside == (False, True):
        share = max(2.0 * share - 1.0, 0.5)
    share = float(np.clip(share, _INSIDE, 1.0 - _INSIDE))
    return share if opened_first else 1.0 - share


def known_events(teeth: ToothPair, shift: float = 0.0) -> np.ndarray:
    """Positions in the first base pitch where a curve of a spur pair has a kink by its geometry alone; helical teeth have none.

    shift: position of the helix when the cycle begins.
    """
    line = line_of_action(teeth)
    if line.base_helix_angle:
        return np.empty(0)
    ends = [line.start, line.end]
    for gear, flank in enumerate((teeth.first_flank, teeth.second_flank)):
        begin = []
        if flank.tip_relief:
            begin.append(line.tip[gear] - flank.tip_relief_length)
        if flank.root_relief:
            begin.append(line.form[gear] + flank.root_relief_length)
        # Roll lengths of the pinion at these places.
        ends += [roll if gear == 0 else line.length - roll for roll in begin]
    u = (np.array(ends) - line.pitch_point) / line.base_pitch - shift
    if line.interference:
        # Where a tip reaches below the involute of its mate contact ends at once: the curves have a step between two positions.
        u = np.concatenate([u - _BESIDE, u + _BESIDE])
    return np.unique(np.mod(u, 1.0))


# Curves that positions are chosen for: peak to peak of transmission error and stiffness, and the largest pressure.
_SIDES = np.array([2, 2, 1])


class HelixCycles:
    """Cycles of all helices of a mesh, to which positions are added."""

    def __init__(
        self,
        helices: Sequence[ToothPair],
        load: float,
        stagger: float = 0.0,
        periods: int = 1,
        progress: Progress = silent,
    ) -> None:
        """Nothing is solved yet.

        Args:
            helices: the teeth of each, along the path of contact.
            load: F_bt of one helix (N).
            stagger: by which share of a mesh period the second one is ahead on that path.
            periods: mesh periods in the cycle.
            progress: told how far it is.
        """
        self.helices = tuple(helices)
        self.load = load
        self.periods = periods
        self.shift = [helix * stagger for helix in range(len(self.helices))]
        alike = len(self.helices) == 2 and self.helices[0] == self.helices[1]
        # Equal helices half a period apart repeat together after half a period: so do their positions.
        self.twice = alike and stagger == 0.5
        # Equal helices abreast are solved once.
        self.solved = 1 if alike and stagger == 0.0 else len(self.helices)
        self.problems: list[ContactProblem] = []
        self.cycles: list[MeshCycle] = []
        self.progress = progress

    @property
    def repeats(self) -> float:
        """Base pitches after which the common curves repeat."""
        return 0.5 * self.periods if self.twice else float(self.periods)

    def add(self, positions: np.ndarray) -> np.ndarray:
        """Solve all helices at new positions; transmission error, stiffness and largest pressure (m, 3) there."""
        u = np.sort(np.concatenate([positions, positions + self.repeats])) if self.twice else np.sort(positions)
        first = not self.cycles
        for helix in range(self.solved):
            place = u + self.shift[helix]
            told = part_of(self.progress, helix / self.solved, (helix + 1) / self.solved)
            if first:
                problem, cycle = loaded_cycle(self.helices[helix], self.load, place, told)
                self.problems.append(problem)
                self.cycles.append(cycle)
            else:
                self.cycles[helix] = with_more(self.problems[helix], self.cycles[helix], place)
        return self.values(self.numbers(positions))[:, [0, 1, 3]]

    def numbers(self, positions: np.ndarray) -> np.ndarray:
        """Numbers of solved positions."""
        u = self.cycles[0].position
        after = np.clip(np.searchsorted(u, positions), 1, len(u) - 1)
        return np.where(np.abs(u[after] - positions) < np.abs(u[after - 1] - positions), after, after - 1)

    def values(self, numbers: np.ndarray) -> np.ndarray:
        """Transmission error, stiffness, tangent stiffness and largest pressure (m, 4) at positions by number."""
        cycles = self.cycles
        helices = len(self.helices)
        error = np.mean([cycle.deflection[numbers] for cycle in cycles], axis=0)
        no_load = np.mean([cycle.no_load[numbers] for cycle in cycles], axis=0)
        tangent = helices / np.mean([1.0 / cycle.tangent[numbers] for cycle in cycles], axis=0)
        pressure = np.max([_largest_pressure(cycle)[numbers] for cycle in cycles], axis=0)
        return np.stack([error, self.load * helices / (error - no_load), tangent, pressure], axis=1)

    def events(self) -> tuple[np.ndarray, np.ndarray]:
        """Guesses of where pairs of any helix come and go, and the solved positions next to them."""
        found = [contact_events(cycle, float(self.periods)) for cycle in self.cycles]
        shifts = self.shift[: self.solved]
        guesses, nearest = (
            np.mod(np.concatenate([one[i] - shift for one, shift in zip(found, shifts, strict=True)]), self.repeats)
            for i in (0, 1)
        )
        return guesses, nearest

    def sample(self, positions: int, *, judged: bool = False) -> SampledCurves:
        """Choose and solve positions of each mesh period; `judged`: and some more, which judge those that are kept."""
        known = np.empty(0)
        first = self.helices[0]
        if not first.first.helix_angle:
            known = np.concatenate([known_events(first, shift) for shift in self.shift])
            known = (known + np.arange(self.periods)[:, None]).ravel()
        count = positions * self.periods // (2 if self.twice else 1)
        return sampled(self.add, self.events, count, self.repeats, known, _SIDES, judged=judged)


def _largest_pressure(cycle: MeshCycle) -> np.ndarray:
    """Of the slices at each position, (p,) in Pa."""
    found = np.zeros(len(cycle.position))
    np.maximum.at(found, cycle.slices.position, cycle.pressure)
    return found


@dataclass(frozen=True)
class HelixCycle:
    """One helix over a base pitch.

    Attributes:
        problem: the helix.
        cycle: its contact at some positions.
        event: (p,) whether curves have a kink there; None of even positions.
    """

    problem: ContactProblem
    cycle: MeshCycle
    event: np.ndarray | None

    def mean(self, values: np.ndarray) -> np.ndarray:
        """Means (c,) of continuous curves (p, c) over the base pitch."""
        if self.event is None:
            return np.asarray(values.mean(axis=0))
        return CycleCurve(self.cycle.position, values, 1.0, self.event).mean()


@lru_cache(maxsize=4)  # stiffness and map of a mesh ask for the same one
def helix_cycle(teeth: ToothPair, load: float, positions: int) -> HelixCycle:
    """Loaded contact of one helix for F_bt = load (N), at a number of positions of a base pitch.

    Those of a spur pair are the ones that `rotorgear mesh` chooses, where pairs come and go and the curves need them. Curves of
    helical teeth are smooth, and the mean of even positions then converges faster than any power of their number.
    """
    progress = listener()
    if teeth.first.helix_angle:
        problem, cycle = loaded_cycle(teeth, load, np.arange(positions) / positions, progress)
        return HelixCycle(problem, cycle, None)
    solving = HelixCycles((teeth,), load, progress=progress)
    found = solving.sample(positions).curve
    return HelixCycle(solving.problems[0], solving.cycles[0].chosen(solving.numbers(found.position)), found.event)


def tooth_fe_stiffness(teeth: ToothPair, load: float, positions: int) -> MeshStiffness:
    """Secant and tangent stiffness of one helix over one mesh period at F_bt = load (N), at some positions of it."""
    found = helix_cycle(teeth, load, positions)
    return MeshStiffness(
        model="tooth_fe",
        position=found.cycle.position,
        transverse=found.cycle.secant,
        definition="secant",
        load=load,
        body=found.problem.body,
        base_helix_angle=found.problem.line.base_helix_angle,
        warnings=found.problem.warnings + found.cycle.warnings,
        tangent=found.cycle.tangent,
        event=found.event,
    )
