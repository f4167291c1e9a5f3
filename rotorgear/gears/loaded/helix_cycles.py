"""Loaded contact of the helices of a mesh over one cycle, to which positions are added where their common curves need them.

Helices share the load evenly, and the mesh approaches by their mean.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from rotorgear.gears.loaded.contact_events import contact_events, known_events
from rotorgear.gears.loaded.cycle_positions import SampledCurves, sampled
from rotorgear.gears.loaded.loaded_cycle import loaded_cycle
from rotorgear.gears.loaded.mesh_cycle import MeshCycle, with_more
from rotorgear.gears.loaded.tooth_contact import ContactProblem
from rotorgear.gears.stiffness.cycle_curve import CycleCurve
from rotorgear.gears.stiffness.mesh_stiffness import ToothPair
from rotorgear.progress import Progress, listener, part_of, silent

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
        """Choose and solve so many positions in a mesh period; `judged`: and some more, which judge those that are kept."""
        halves = 2 if self.twice else 1
        known = np.empty(0)
        first = self.helices[0]
        if not first.first.helix_angle:
            known = np.concatenate([known_events(first, shift) for shift in self.shift])
            known = (known + np.arange(self.periods)[:, None]).ravel()
        return sampled(self, positions * self.periods // halves, self.repeats, known, _SIDES, judged=judged)


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

    def mean_of_tangents(self, values: np.ndarray) -> np.ndarray:
        """Means (c,) of curves (p, c) that step where pairs come and go: straight between positions."""
        return np.asarray(self.cycle.weight @ values)


@lru_cache(maxsize=4)  # stiffness and map of a mesh ask for the same one
def helix_cycle(teeth: ToothPair, load: float, positions: int) -> HelixCycle:
    """Loaded contact of one helix for F_bt = load (N), at so many positions of a base pitch.

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
