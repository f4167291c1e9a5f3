"""All helices of a mesh over its cycle: positions chosen for their common curves, and what may lie between them.

Helices share the load evenly, and the mesh approaches by their mean.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rotorgear.analysis.teeth.request import MeshRequest
from rotorgear.gears.loaded.cycle_positions import SampledCurves
from rotorgear.gears.loaded.helix_cycles import HelixCycles
from rotorgear.gears.loaded.mesh_cycle import MeshCycle
from rotorgear.gears.loaded.tooth_contact import ContactProblem
from rotorgear.gears.stiffness.cycle_curve import CycleCurve
from rotorgear.gears.stiffness.mesh_stiffness import ToothPair
from rotorgear.model.layout.mesh_layout import mirrored
from rotorgear.progress import Progress, silent


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
    solving = _cycles(request, teeth, base_force, cycle.periods, progress)
    found = solving.sample(cycle.positions, judged=judged)
    u = found.curve.position
    event = found.curve.event
    if solving.twice:
        u = np.concatenate([u, u + solving.repeats])
        event = np.concatenate([event, event])
    numbers = solving.numbers(u)
    cycles = [one.chosen(numbers) for one in solving.cycles]
    if solving.solved < len(solving.helices):
        cycles = [cycles[0]] * len(solving.helices)
    return SolvedHelices(
        problem=solving.problems[-1],
        cycles=tuple(cycles),
        curve=CycleCurve(u, solving.values(numbers), float(cycle.periods), event),
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
    solving = _cycles(request, teeth, base_force, periods, progress)
    solving.twice = False
    return solving.add(positions)


def _cycles(request: MeshRequest, teeth: ToothPair, base_force: float, periods: int, progress: Progress) -> HelixCycles:
    """The helices of a request along the path of contact."""
    helices = [teeth if ahead > 0 else mirrored(teeth) for ahead in request.senses]
    return HelixCycles(helices, base_force, request.mesh.lead_on_path(request.sense), periods, progress)
