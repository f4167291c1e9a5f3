"""Compiled: the force of a whole step that does exactly the work by which the potential changes.

    F = F(d_m, w) + lambda w/|w|^2,   d_m = (d_0 + d_1)/2,  w = (d_1 - d_0)/h,   lambda = [V(d_1) - V(d_0)]/h - dV(d_m)[w]

with all that depends on time taken at the middle of the step (Gonzalez's discrete gradient). F w = dV/h + dissipation - power put
in: with equations of motion that hold in the mean over a step, energy is kept, or dissipated, whatever the step, also where sides
meet and part. lambda vanishes where V is quadratic between d_0 and d_1; it is not smaller than rounding where it counts.
What a law answers gives dV(d_m)[w] = F w + P_in - P_diss at w less the same at rest: the rate of V that no motion makes.
Simo and Tarnow, ZAMP 43 (1992) 757; Gonzalez, J. Nonlinear Science 6 (1996) 449; Laursen and Chawla, Int. J. Numer. Methods
Eng. 40 (1997) 863.
"""

from __future__ import annotations

import numpy as np

from rotorgear.solvers.time.compiled import compiled
from rotorgear.solvers.time.kernel_gather import DISSIPATED, ENERGIES, POWER_IN, SIDE, STORED

_ROUNDING = 16.0 * 2.220446049250313e-16


@compiled(entry=False)
def all_straight(laws, work):
    """Whether no law needs more than its force half way: all are apart, or touch by one and the same spring, over the step."""
    middle = work.answer
    for law in range(laws.kind.size):
        if not laws.conserves[law]:
            continue
        side = middle.energy[ENERGIES * law + SIDE]
        if side != work.begun.energy[ENERGIES * law + SIDE] or side != work.ended.energy[ENERGIES * law + SIDE]:
            return False
        for p in range(laws.block_first[law], laws.block_first[law + 1]):
            if middle.Kd[p] != work.begun.Kd[p] or middle.Kd[p] != work.ended.Kd[p]:
                return False
    return True


@compiled(entry=False)
def whole_step(laws, work, h):
    """Turn the answer half way into that of the whole step, for laws whose stored energy is their potential.

    `still` are the answers half way at rest, `begun` and `ended` those at both ends of the step in the same state; the side that
    touches is that of the end. Returns how far the rounding of the energies moves the forces.
    """
    answer = work.answer
    uncertain = 0.0
    energy = answer.energy
    rest = work.still.energy
    begun = work.begun.energy
    ended = work.ended.energy
    for law in range(laws.kind.size):
        if not laws.conserves[law]:
            continue
        a = laws.first[law]
        b = laws.first[law + 1]
        e = ENERGIES * law
        energy[e + SIDE] = ended[e + SIDE]
        square = 0.0
        along = 0.0
        size = 0.0
        for i in range(a, b):
            square += work.v[i] * work.v[i]
            along += answer.F[i] * work.v[i]
            size += abs(answer.F[i] * work.v[i])
        moving = energy[e + POWER_IN] - energy[e + DISSIPATED]
        held = rest[e + POWER_IN] - rest[e + DISSIPATED]
        lacks = (ended[e + STORED] - begun[e + STORED]) / h - (along + moving - held)
        for which in (POWER_IN, DISSIPATED):
            size += abs(energy[e + which]) + abs(rest[e + which])
        size += (abs(ended[e + STORED]) + abs(begun[e + STORED])) / h
        lost = _ROUNDING * size
        if square == 0.0 or abs(lacks) <= lost:
            continue
        # What rounding may have made of nothing is taken off, so that the force is continuous where the correction sets in.
        lacks -= lost if lacks > 0.0 else -lost
        uncertain = max(uncertain, lost / np.sqrt(square))
        for i in range(a, b):
            answer.F[i] += lacks * work.v[i] / square
        if b - a == 1:
            # F = dV/dd of one displacement grows by [V'(d_1) - dV/dd]/dd; V' at the end has the damper's share in it, as F has.
            block = laws.block_first[law]
            change = work.v[a] * h
            steeper = (work.ended.F[a] - answer.F[a]) / change
            steepest = max(answer.Kd[block], work.ended.Kd[block], work.begun.Kd[block])
            answer.Kd[block] = max(min(2.0 * steeper, steepest), 0.0)
    return uncertain
