"""Compiled: the impulse of a damper that sets in where sides meet, put right at the end of each step.

The damping force c s(x) x' of a contact jumps, or rises over a depth that no step of sensible length sees. What it did in a
step by the stages of the Runge-Kutta method then depends on where these happened to fall, and so much noise makes motions look
chaotic that are not. But its impulse in a step follows from the ends alone:

    int c s(x) x' dt = c [G(x_1) - G(x_0)],   G(x) = int s dx

So a step ends by what is missing of that. Damping that never pulls does not obey it while it is held back; there only steps in
which the sides meet are put right. Tangents follow with s(x_1) T_1 - s(x_0) T_0 in place of the difference of G.
"""

from __future__ import annotations

from rotorgear.solvers.batch.columns import CLEARANCE, CLOSING, DEPTH, ERROR, NEVER, PER_DEPTH, C
from rotorgear.solvers.batch.kernel_parts import GROWTH, IN_V, of, put_of
from rotorgear.solvers.contact.gap_contact import momentum
from rotorgear.solvers.contact.vectors import fill, formula, get, put, where_positive
from rotorgear.solvers.time.compiled import compiled

# What is kept of the end of a step: G, s, the side that touches, and whether the impulse of the step is put right (> 0).
INTEGRAL, SHARE, SIDE, RIGHT = range(4)
KEPT = 4


@compiled(fast=True)
def keep_start(values, x, kept):
    """Fill kept (m, 4, w) at the start of a run from the approach x (m, w)."""
    for j in range(x.shape[0]):
        end = momentum(*regularised(values, j), get(x, j))
        put_of(kept, j, INTEGRAL, end.integral)
        put_of(kept, j, SHARE, end.share)
        put_of(kept, j, SIDE, end.side)
        put_of(kept, j, RIGHT, end.side)


@formula
def regularised(values, j):
    """Clearance, depth of regularisation and 1/depth of a column."""
    return of(values, j, CLEARANCE), of(values, j, DEPTH), of(values, j, PER_DEPTH)


@compiled(fast=True, inner=True)
def missing(jumps, values, table, d, used, kept, impulse):
    """What the impulses of a step lack, to impulse (m, w); kept (m, 4, w) goes from the step's begin to its end.

    d (2 m, w): displacements at the end; used (m, w): impulses by the stages.
    """
    one = fill(1.0)
    none = fill(0.0)
    for j in range(jumps.size):
        if jumps[j] == NEVER:
            put(impulse, j, none)
            continue
        end = momentum(*regularised(values, j), get(d, 2 * j) - of(table, j, ERROR))
        rest = of(values, j, C) * (end.integral - of(kept, j, INTEGRAL)) - get(used, j)
        right = one
        if jumps[j] == CLOSING:
            right = end.side * (end.side - of(kept, j, SIDE))
        put(impulse, j, where_positive(right, rest, none))
        put(used, j, none)
        put_of(kept, j, INTEGRAL, end.integral)
        put_of(kept, j, SHARE, end.share)
        put_of(kept, j, SIDE, end.side)
        put_of(kept, j, RIGHT, right)


@compiled(fast=True, inner=True)
def add_used_along(jumps, weight, found, kept, d, used, start, at, first):
    """Add what a stage's damping does along a tangent with displacements and velocities d (2 m, w), to rows of used from `at` on.

    In the first stage, s T at the step's begin goes to the same rows of start.
    """
    for j in range(jumps.size):
        if jumps[j] == NEVER:
            continue
        now = of(found, j, IN_V) * get(d, 2 * j + 1) + of(found, j, GROWTH) * get(d, 2 * j)
        if first:
            put(used, at + j, weight * now)
            put(start, at + j, of(kept, j, SHARE) * get(d, 2 * j))
        else:
            put(used, at + j, get(used, at + j) + weight * now)


@compiled(fast=True, inner=True)
def missing_along(jumps, values, kept, d, used, start, at, impulse):
    """What the impulses of a step lack along a tangent with displacements d (2 m, w) at its end, to impulse (m, w)."""
    none = fill(0.0)
    for j in range(jumps.size):
        if jumps[j] == NEVER:
            put(impulse, j, none)
            continue
        change = of(kept, j, SHARE) * get(d, 2 * j) - get(start, at + j)
        rest = of(values, j, C) * change - get(used, at + j)
        put(impulse, j, where_positive(of(kept, j, RIGHT), rest, none))


@compiled(fast=True, inner=True)
def add_impulses(matrix, impulse, stage, at, state, state_at):
    """Add impulses to the velocities, by rows of -B, in the stage to come (rows from `at` on) and the state."""
    first = matrix.first
    column = matrix.column
    value = matrix.value
    n = first.size - 1
    for i in range(n):
        total = fill(0.0)
        for p in range(first[i], first[i + 1]):
            total += get(value, p) * get(impulse, column[p])
        total += get(state, state_at + n + i)
        put(stage, at + n + i, total)
        put(state, state_at + n + i, total)
