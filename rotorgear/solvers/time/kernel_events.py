"""Compiled: what the laws did in a step: energies put in and dissipated, time on each side, contact losses.

Where a law changes sides in a step, both instants are found, of leaving and of arriving: displacements go along the parabola
through the ends of the last two steps, and what depends on time is that of each instant. Sides at the ends of steps alone would
give shares of the time to half a step, by chance.
"""

from __future__ import annotations

import numpy as np

from rotorgear.solvers.time.compiled import compiled
from rotorgear.solvers.time.kernel_time import DISSIPATED, ENERGIES, POWER_IN, SIDE, rotation_at

# Halvings of the time of two steps in which a side changes.
_HALVINGS = 14
# A side is told with what depends on time half a step off, at most.
_EARLIEST = -0.5
_LATEST = 1.5


@compiled(entry=False)
def switch_at(laws, law, rotation, t, h, d, recent, side, leaving):
    """When a law leaves a side, or comes to it, as a share of the step that ends at t with displacements d (m,)."""
    a = laws.first[law]
    k = laws.first[law + 1] - a
    parameters = laws.parameters[laws.parameters_first[law] : laws.parameters_first[law + 1]]
    state = np.zeros(laws.state_first[law + 1] - laws.state_first[law])
    x = np.empty(k)
    v = np.empty(k)
    force = np.zeros(k)
    in_d = np.zeros(k * k)
    in_v = np.zeros(k * k)
    energy = np.zeros(ENERGIES)
    m = d.size
    low = _EARLIEST
    high = _LATEST
    for _ in range(_HALVINGS):
        s = 0.5 * (low + high)
        at = t + (s - 1.0) * h
        angle, speed = rotation_at(at, rotation)
        laws.schedules[laws.kind[law]](angle, speed, at, parameters, state)
        for i in range(k):
            b = recent[m + a + i, 1]
            c = recent[m + a + i, 2]
            end = d[a + i]
            x[i] = c + 0.5 * s * (end - b + s * (end - 2.0 * c + b))
            v[i] = (end - c) / h
        laws.forces[laws.kind[law]](parameters, state, x, v, force, in_d, in_v, energy)
        if (int(energy[SIDE]) == side) == leaving:
            low = s
        else:
            high = s
    return 0.5 * (low + high)


@compiled
def take_account(laws, rotation, t, h, energy, d, carried):
    """Sum up energies of the step that ends at t, and count it on the front side, apart or on the back; and contact losses."""
    sums = carried.sums
    last = carried.last
    events = carried.events
    for law in range(last.size):
        sums[law, 0] += h * energy[ENERGIES * law + POWER_IN]
        sums[law, 1] += h * energy[ENERGIES * law + DISSIPATED]
        now = int(energy[ENERGIES * law + SIDE])
        before = last[law]
        if now == before:
            events[law, 1 - now] += 1.0
            continue
        left = switch_at(laws, law, rotation, t, h, d, carried.gathered.recent, before, True)
        came = left
        if before != 0 and now != 0:
            came = max(left, switch_at(laws, law, rotation, t, h, d, carried.gathered.recent, now, False))
        events[law, 1 - before] += left
        events[law, 1] += came - left
        events[law, 1 - now] += 1.0 - came
        if now == 0:
            events[law, 3] += 1.0
        last[law] = now
