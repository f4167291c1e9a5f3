"""How far a contact map is from the loaded contact itself, between its positions and loads."""

from __future__ import annotations

import numpy as np

from rotorgear.gears.loaded.contact_map import ContactMap
from rotorgear.gears.loaded.mesh_cycle import mesh_cycle
from rotorgear.gears.loaded.tooth_contact import ContactProblem

# So many places, from 0.32 to 1.6 times the working load, about what contacts carry: a sequence that fills positions and loads
# evenly (M. Roberts, 2018: powers of 1/g, g^3 = g + 1).
_PLACES = 16
_FILLING = (0.7548776662466927, 0.5698402909980532)
_LOADS = (0.32, 5.0)


def map_error(problem: ContactProblem, solved: ContactMap, load: float, first: list[int]) -> float:
    """Largest difference (m along the flank normal) of a map to contacts that it has not seen.

    Args:
        problem: the helix.
        solved: its map.
        load: working force (N) along the flank normal.
        first: a base pitch of each kind, by number, which take turns.
    """
    cosine = float(np.cos(problem.line.base_helix_angle))
    most = 0.0
    for number in range(_PLACES):
        place, height = ((0.5 + (number + 1) * step) % 1.0 for step in _FILLING)
        force = load * _LOADS[0] * _LOADS[1] ** height
        if force > solved.largest_load:
            continue
        u = first[number % len(first)] + place
        exact = float(mesh_cycle(problem, force * cosine, np.array([u])).deflection[0]) * cosine
        most = max(most, abs(float(solved.approach_at(force, u)) - exact))
    return most
