"""Loads of a contact map as multiples of the working load, in groups whose largest load decides the patches.

In the plane patches follow no load, and one group has all loads. In space those of a spur pair follow the load from group to
group; of a helical pair most loads have the same, so that its groups only spare it looking for their width under every load.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from rotorgear.gears.loaded.tooth_contact import ContactProblem

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
# Slices of a spur pair reach as far beyond the line of action as corners touch: groups up to the working load, up to so many
# times it and above have slices of their own.
_MODERATE = 2.5


def load_groups(problem: ContactProblem, near: bool = False) -> tuple[tuple[float, ...], ...]:
    """Groups of rising loads over the working one; `near`: in space up to about twice it only, for linear analyses."""
    if problem.plane and not problem.uncoupled:
        return _IN_PLANE
    groups = _NEAR_IN_SPACE if near else _IN_SPACE
    return _finer(groups) if problem.oblique else groups


def _finer(groups: tuple[tuple[float, ...], ...]) -> tuple[tuple[float, ...], ...]:
    """Groups with more loads, evenly between each two in a range."""
    found = []
    before = 0.0
    for group in groups:
        loads: list[float] = []
        for factor in group:
            near = before > _FINER[0] and factor < _FINER[1]
            loads += [before + (factor - before) * k / _PARTS for k in range(1, _PARTS)] if near else []
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
