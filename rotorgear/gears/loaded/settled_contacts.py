"""Contacts at positions of the mesh cycle under one load, with patches wider than the strips under them.

Patches replace the Hertz strips in the finite elements (`loaded_contact.py`), and a strip must not be wider than its patch. Each
position is solved, patches that its strips outgrow are widened, and only their rows of the compliance are spread anew. Patches of
oblique lines are all as wide as each other.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.gears.loaded.contact_points import Slices
from rotorgear.gears.loaded.loaded_contact import ContactState, PositionContact, solve_contact
from rotorgear.gears.loaded.slice_compliance import slice_compliances
from rotorgear.gears.loaded.tooth_contact import ContactProblem
from rotorgear.progress import Progress, silent

# In space each patch of a spur pair stays wider than its Hertz strip by this factor; all are wider than this in normal modules.
# Lines of spur teeth pass a tip all at once, and patches as narrow as that are as good as plane elements. A patch that has to
# grow becomes so much wider than its strip asks for.
_STRIP_MARGIN = 1.3
_LEAST_PATCH = 0.08
_WIDENING = 1.05
# Of oblique lines a small part is near a tip, where elements do not resolve narrower patches than this. (23/61, 12 deg, against
# 1.5 times as fine elements: largest pressure -1 %, with 0.08 +7 %.) Patches that grow slice by slice, from load to load, make
# ripples of some nm: so all of a cycle have one width, the first of 0.2, 0.25, ... that no strip on it exceeds. Where a
# strip is wider than 0.78 of it, its tangent is held, which is 1 % of what its slice gives way at most.
_LEAST_OBLIQUE_PATCH = 0.2
_NEXT_OBLIQUE_PATCH = 1.25
# In the plane a slice is a tooth pair's whole line. Its own compliance is seven times K / l and more, so that C + dg/dF stays
# positive definite for strips up to six times as wide as their patches.
_LEAST_TANGENT_IN_PLANE = -2.0
# Passes for the widths of patches.
PASSES = 12
# Wider strips (half-width over m_n) are no line contact any more.
_WIDEST_STRIP = 0.5


class WideContactError(AnalysisError):
    """A load under which the contact is no line any more."""


@dataclass(frozen=True)
class Settled:
    """Contacts under a load, their patches wider than the strips under them.

    Attributes:
        contacts: (p,) the contact at each position.
        states: (p,) its solution.
        patch: (n,) least half-widths of the patches in normal modules.
    """

    contacts: tuple[PositionContact, ...]
    states: tuple[ContactState, ...]
    patch: np.ndarray


def settled(
    problem: ContactProblem,
    slices: Slices,
    gap: np.ndarray,
    total: float,
    progress: Progress = silent,
    known: Settled | None = None,
    passes: int = PASSES,
    least: float = 0.0,
    *,
    narrowest: bool = False,
) -> Settled:
    """Contacts and states at all positions, with patches wider than the strips under them.

    Args:
        problem: the helix.
        slices: of all positions.
        gap: (n,) along the flank normal (m).
        total: normal force (N).
        progress: told how far it is.
        known: of the same slices with other gaps or under another load: patches grow from these, forces begin with these.
        passes: for the widths at most.
        least: where patches of oblique lines begin, in normal modules, in place of the narrowest.
        narrowest: patches begin as narrow as for the smallest loads although others are `known`, of whose compliances only rows
            that change are spread anew.
    """
    numbers = [slices.at(i) for i in range(int(slices.position[-1]) + 1)]
    count = len(numbers)
    narrow = max(least, _LEAST_OBLIQUE_PATCH) if problem.oblique else _LEAST_PATCH
    patch = known.patch.copy() if known and not narrowest else np.full(len(slices), narrow)
    contacts = {i: replace(one, gap=gap[numbers[i]]) for i, one in enumerate(known.contacts)} if known else {}
    start = {i: one.force for i, one in enumerate(known.states)} if known else {}
    if known is None or narrowest:
        contacts = _with_patches(problem, slices, gap, range(count), patch, contacts)
    states: dict[int, ContactState] = {}
    margin = 1.0 if problem.oblique else _STRIP_MARGIN
    unsettled = list(range(count))
    for number in range(passes):
        for i in unsettled:
            states[i] = solve_contact(contacts[i], total, start.get(i))
            start[i] = states[i].force
            strip = float(states[i].strip.max()) / problem.module
            if strip > _WIDEST_STRIP:
                raise WideContactError(
                    f"At this load the contact strip would be {2.0 * strip:.2g} modules wide, which is no line contact any more: "
                    "reduce the torque."
                )
            progress((i + 1) / count, f"contact {i + 1} of {count}")
        if problem.plane:
            break
        # The patches' half-widths lie in the transverse section; cos b_b brings them across the line.
        wanted = {i: margin * states[i].strip / problem.cosine / problem.module for i in unsettled}
        unsettled = [i for i in unsettled if np.any(wanted[i] > patch[numbers[i]])]
        if not unsettled or number + 1 == passes:
            break
        if problem.oblique:
            # One after the other: strips on too narrow patches are wider than on those that they ask for.
            patch *= _NEXT_OBLIQUE_PATCH
            unsettled = list(range(count))
            contacts = {}  # all rows are new
        else:
            for i in unsettled:
                short = wanted[i] > patch[numbers[i]]
                patch[numbers[i][short]] = _WIDENING * wanted[i][short]
        contacts |= _with_patches(problem, slices, gap, unsettled, patch, contacts)
    return Settled(tuple(contacts[i] for i in range(count)), tuple(states[i] for i in range(count)), patch)


def same_patches(first: Settled, second: Settled) -> bool:
    """Whether both have the same compliances, the second having grown from the first or the other way round."""
    both = zip(first.contacts, second.contacts, strict=True)
    return all(one.compliance is other.compliance for one, other in both)


def _with_patches(
    problem: ContactProblem,
    slices: Slices,
    gap: np.ndarray,
    positions: Sequence[int],
    patch: np.ndarray,
    known: dict[int, PositionContact],
) -> dict[int, PositionContact]:
    """Contacts at some positions with patches (n,) of such least half-widths; of those `known` only rows that change are new."""
    # In the plane of action: length of the contact line dz / cos b_b, and R = rho_1 rho_2 / (rho_1 + rho_2) with
    # rho = xi / cos b_b.
    length = slices.length / problem.cosine
    R = np.sum(slices.roll[0] * slices.roll[1] / slices.roll.sum(axis=0) * slices.weight, axis=1) / problem.cosine
    before = {i: (known[i].compliance, known[i].log_width) for i in positions if i in known}
    found = {}
    compliances = slice_compliances(problem, slices, positions, patch, before or None)
    for i, (compliance, log_width) in zip(positions, compliances, strict=True):
        here = slices.at(i)
        found[i] = PositionContact(
            compliance=compliance,
            gap=gap[here],
            length=length[here],
            local=problem.local,
            log_width=log_width,
            radius=R[here],
            modulus=problem.modulus,
            least_tangent=_LEAST_TANGENT_IN_PLANE if problem.plane else 0.01,
        )
    return found
