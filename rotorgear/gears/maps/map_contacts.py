"""Contacts of a map at all its positions under the largest load of each group, on slices that groups share."""

from __future__ import annotations

import numpy as np

from rotorgear.gears.loaded.contact_points import Slices, contact_slices
from rotorgear.gears.loaded.mesh_cycle import MeshCycle, beyond_line, corner_reach
from rotorgear.gears.loaded.settled_contacts import Settled, WideContactError, settled, with_least_patches
from rotorgear.gears.loaded.tooth_contact import ContactProblem
from rotorgear.progress import Progress

# Positions that tell how far corners touch. Where they touch farther than was thought, they are followed a little farther still.
_TELLING = 12
_FARTHER = 1.05


def cosine(problem: ContactProblem) -> float:
    """cos b_b: F_bt = F_n cos b_b."""
    return float(np.cos(problem.line.base_helix_angle))


def up_to(
    problem: ContactProblem, cycle: MeshCycle, load: float, family: tuple[tuple[float, ...], ...]
) -> list[tuple[tuple[float, ...], Settled]]:
    """Groups of rising multiples of a force (N), the last of which is that of the cycle, and contacts on its slices."""
    last = Settled(cycle.contacts, cycle.states, cycle.patch)
    if len(family) == 1:
        return [(family[0], last)]
    gap = problem.gap(cycle.slices)
    below = with_least_patches(problem, cycle.slices, gap, last)
    found = []
    for group in family[:-1]:
        below = settled(problem, cycle.slices, gap, load * group[-1], known=below)
        found.append((group, below))
    return [*found, (family[-1], last)]


def above(
    problem: ContactProblem, load: float, family: tuple[tuple[float, ...], ...], place: np.ndarray, progress: Progress
) -> tuple[Slices, list[tuple[tuple[float, ...], Settled]]]:
    """Slices that reach as far as corners touch under the largest of the forces, and groups with their contacts.

    Groups end before the first one under whose largest force the contact is no line.

    Args:
        problem: the helix.
        load: working force (N).
        family: groups of rising multiples of it.
        place: (p,) positions.
        progress: told how far it is.

    Raises:
        WideContactError: there is none, or it is no larger than the working one.
    """
    reach = corner_reach(problem, load * family[-1][-1] * cosine(problem), place[:: max(1, len(place) // _TELLING)])
    while True:
        slices = contact_slices(problem.line, place, problem.width, problem.slices, reach, stations=problem.uncoupled)
        gap = problem.gap(slices)
        found: list[tuple[tuple[float, ...], Settled]] = []
        for group in family:
            try:
                found += _contacts(problem, slices, gap, load, group, found[-1][1] if found else None, progress)
            except WideContactError:
                if not found or group[-1] < 1.0 + 1e-9:
                    raise
                break
        deflection = max(state.approach for state in found[-1][1].states) - float(gap.min())
        wanted = beyond_line(problem, deflection / cosine(problem) + problem.largest_gap)
        if wanted[0] <= reach[0] and wanted[1] <= reach[1]:
            return slices, found
        # Rare: the positions that told the reach missed where most is touched.
        reach = (max(reach[0], _FARTHER * wanted[0]), max(reach[1], _FARTHER * wanted[1]))


def _contacts(
    problem: ContactProblem,
    slices: Slices,
    gap: np.ndarray,
    load: float,
    group: tuple[float, ...],
    below: Settled | None,
    progress: Progress,
) -> list[tuple[tuple[float, ...], Settled]]:
    """A group and its contacts, which grow from those `below` it.

    Where patches of oblique lines change within it, each load by itself on those that it asks for.
    """
    if problem.oblique and below is None:
        below = settled(problem, slices, gap, load * group[0], progress)
    last = settled(problem, slices, gap, load * group[-1], progress, below)
    if not problem.oblique or below is None or np.array_equal(last.patch, below.patch):
        return [(group, last)]
    found = []
    for factor in group[:-1]:
        below = settled(problem, slices, gap, load * factor, progress, below)
        found.append(((factor,), below))
    return [*found, (group[-1:], last)]


def of_period_ahead(problem: ContactProblem, slices: Slices, commonest: Settled, load: float, ahead: int) -> Settled:
    """Contacts of the period so many after the commonest, under a normal force (N)."""
    if not any(flank.single_teeth for flank in problem.flanks):
        return commonest
    return settled(problem, slices, problem.gap(slices, ahead), load, known=commonest)
