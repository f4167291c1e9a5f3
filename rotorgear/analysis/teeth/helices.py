"""All helices of a mesh over its cycle: positions chosen for their common curves, and what may lie between them.

Helices share the load evenly, and the mesh approaches by their mean.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rotorgear.analysis.teeth.request import MeshRequest
from rotorgear.gears.loaded.contact_events import contact_events, known_events
from rotorgear.gears.loaded.cycle_curve import CycleCurve
from rotorgear.gears.loaded.cycle_positions import SampledCurves, sampled
from rotorgear.gears.loaded.mesh_cycle import MeshCycle, with_more
from rotorgear.gears.loaded.stiffness import loaded_cycle
from rotorgear.gears.loaded.tooth_contact import ContactProblem
from rotorgear.gears.stiffness.mesh_stiffness import ToothPair
from rotorgear.model.layout.mesh_layout import mirrored
from rotorgear.progress import Progress, part_of, silent

# Curves that positions are chosen for: peak to peak of transmission error and stiffness, and the largest pressure.
_SIDES = np.array([2, 2, 1])


@dataclass(frozen=True)
class Cycle:
    """How much of a mesh is followed: positions in a mesh period, and mesh periods."""

    positions: int
    periods: int = 1


@dataclass(frozen=True)
class SolvedHelices:
    """All helices of one request at one load and setting.

    Attributes:
        problem: of the last helix.
        cycles: of each helix, at the positions that are kept.
        curve: transmission error (m), stiffness and tangent stiffness (N/m) of all helices, and largest pressure (Pa).
        no_load: (p,) transmission error without load (m).
        sampling: the first, second and last of these curves, with what may lie between the positions.
    """

    problem: ContactProblem
    cycles: tuple[MeshCycle, ...]
    curve: CycleCurve
    no_load: np.ndarray
    sampling: SampledCurves

    @property
    def position(self) -> np.ndarray:
        """(p,) u in base pitches."""
        return self.curve.position

    @property
    def error(self) -> np.ndarray:
        """Transmission error (p,) in m."""
        return np.asarray(self.curve.values[:, 0])

    @property
    def stiffness(self) -> np.ndarray:
        """Secant stiffness (p,) in N/m."""
        return np.asarray(self.curve.values[:, 1])

    @property
    def tangent(self) -> np.ndarray:
        """Tangent stiffness (p,) in N/m."""
        return np.asarray(self.curve.values[:, 2])

    @property
    def contact_ratio(self) -> float:
        """Mean number of tooth pairs that carry load in a helix."""
        return float(np.mean([cycle.contact_ratio for cycle in self.cycles]))


class _Solving:
    """Cycles of all helices of a mesh, to which positions are added."""

    def __init__(
        self,
        request: MeshRequest,
        teeth: ToothPair,
        base_force: float,
        stagger: float,
        period: float,
        progress: Progress,
    ) -> None:
        self.load = base_force
        self.period = period
        self.kinds = [teeth if ahead > 0 else mirrored(teeth) for ahead in request.senses]
        self.shift = [helix * stagger for helix in range(len(self.kinds))]
        # Equal helices half a period apart repeat together after half a period: so do their positions.
        self.twice = len(self.kinds) == 2 and self.kinds[0] == self.kinds[1] and stagger == 0.5
        # Equal helices abreast are solved once.
        self.solved = (
            1 if len(self.kinds) == 2 and self.kinds[0] == self.kinds[1] and stagger == 0.0 else len(self.kinds)
        )
        self.problems: list[ContactProblem] = []
        self.cycles: list[MeshCycle] = []
        self.progress = progress

    @property
    def repeats(self) -> float:
        """Base pitches after which the common curves repeat."""
        return 0.5 * self.period if self.twice else self.period

    def add(self, positions: np.ndarray) -> np.ndarray:
        """Solve all helices at new positions; transmission error, stiffness and largest pressure (m, 3) there."""
        u = np.sort(np.concatenate([positions, positions + self.repeats])) if self.twice else np.sort(positions)
        first = not self.cycles
        for helix in range(self.solved):
            place = u + self.shift[helix]
            told = part_of(self.progress, helix / self.solved, (helix + 1) / self.solved)
            if first:
                problem, cycle = loaded_cycle(self.kinds[helix], self.load, place, told)
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
        helices = len(self.kinds)
        error = np.mean([cycle.deflection[numbers] for cycle in cycles], axis=0)
        no_load = np.mean([cycle.no_load[numbers] for cycle in cycles], axis=0)
        tangent = helices / np.mean([1.0 / cycle.tangent[numbers] for cycle in cycles], axis=0)
        pressure = np.max([_largest_pressure(cycle)[numbers] for cycle in cycles], axis=0)
        return np.stack([error, self.load * helices / (error - no_load), tangent, pressure], axis=1)

    def events(self) -> tuple[np.ndarray, np.ndarray]:
        """Guesses of where pairs of any helix come and go, and the solved positions next to them."""
        found = [contact_events(cycle, self.period) for cycle in self.cycles]
        shifts = self.shift[: self.solved]
        guesses, nearest = (
            np.mod(np.concatenate([one[i] - shift for one, shift in zip(found, shifts, strict=True)]), self.repeats)
            for i in (0, 1)
        )
        return guesses, nearest


def _largest_pressure(cycle: MeshCycle) -> np.ndarray:
    """Of the slices at each position, (p,) in Pa."""
    found = np.zeros(len(cycle.position))
    np.maximum.at(found, cycle.slices.position, cycle.pressure)
    return found


def solve_helices(
    request: MeshRequest,
    teeth: ToothPair,
    base_force: float,
    cycle: Cycle,
    progress: Progress = silent,
    *,
    judged: bool = False,
) -> SolvedHelices:
    """All helices at one load.

    Args:
        request: the mesh; teeth: of a helix that runs ahead at larger z, with the flanks to be looked at.
        base_force: F_bt of one helix (N).
        cycle: how many positions are kept, in how many mesh periods.
        progress: told how far it is.
        judged: whether more positions are solved for the estimate of what lies between those that are kept.
    """
    stagger = request.mesh.lead_on_path(request.sense)
    periods = cycle.periods
    solving = _Solving(request, teeth, base_force, stagger, float(periods), progress)
    halves = 2 if solving.twice else 1
    known = np.empty(0)
    if not teeth.first.helix_angle:
        known = np.concatenate([known_events(solving.kinds[0], shift) for shift in solving.shift])
        known = (known + np.arange(periods)[:, None]).ravel()
    count = cycle.positions * periods // halves
    found = sampled(solving, count, solving.repeats, known, _SIDES, judged=judged)
    u = found.curve.position
    event = found.curve.event
    if solving.twice:
        u = np.concatenate([u, u + solving.repeats])
        event = np.concatenate([event, event])
    numbers = solving.numbers(u)
    cycles = [one.chosen(numbers) for one in solving.cycles]
    if solving.solved < len(solving.kinds):
        cycles = [cycles[0]] * len(solving.kinds)
    return SolvedHelices(
        problem=solving.problems[-1],
        cycles=tuple(cycles),
        curve=CycleCurve(u, solving.values(numbers), float(periods), event),
        no_load=np.mean([one.no_load for one in cycles], axis=0),
        sampling=found,
    )


def curves_at(
    request: MeshRequest,
    teeth: ToothPair,
    base_force: float,
    positions: np.ndarray,
    periods: int,
    progress: Progress = silent,
) -> np.ndarray:
    """Transmission error (m), stiffness (N/m) and largest pressure (Pa) of all helices at some positions: (m, 3)."""
    stagger = request.mesh.lead_on_path(request.sense)
    solving = _Solving(request, teeth, base_force, stagger, float(periods), progress)
    solving.twice = False
    return solving.add(positions)
