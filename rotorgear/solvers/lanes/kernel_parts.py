"""Compiled: what the lanes of kernel_lanes.py do in one stage of a step: tables, sparse products, contacts, statistics.

Every array has the systems as its last axis of LANES entries, and is read by rows of lanes (kernel_lane_vectors.py).
"""

from __future__ import annotations

from rotorgear.solvers.contact.kinds import ADHESIVE, BILATERAL, PENETRATION
from rotorgear.solvers.lanes.columns import ERROR, OWN_LAW, PRESCRIBED, PUSH, SLOPE, STIFFNESS
from rotorgear.solvers.lanes.kernel_vectors import fill, get, larger, put, smaller, where_positive
from rotorgear.solvers.time.compiled import compiled
from rotorgear.solvers.time.kernel_contact import schedule_all

# Values of a column: k, c, backlash, 1/ramp, prescribed force, ramp.
K = 0
C = 1
BACKLASH = 2
RAMP = 3
FORCE = 4
REACH = 5
VALUES = 6
# What a contact leaves: its tangents in displacement and velocity, the flank that touches, and the part of the tangent in
# displacement that comes from the ramp.
IN_D = 0
IN_V = 1
FLANK = 2
GROWTH = 3
FOUND = 4
# Rows of the sums: steps on the driving flank, apart, on the back flank, losses of contact; least and largest of the displacement
# d, of the approach d - e and of the force; sums of force, its square, displacement, its square.
DRIVING, APART, BACK, LOSSES, D_MIN, D_MAX, X_MIN, X_MAX, F_MIN, F_MAX, F_SUM, F_SQUARES, D_SUM, D_SQUARES = range(14)


@compiled
def tabulate(schedules, kind, parameters, parameters_first, state_first, angles, out):
    """State (r, s) of all laws at angles (r,) of the reference, at unit speed."""
    for i in range(angles.size):
        schedule_all(schedules, kind, parameters, parameters_first, state_first, angles[i], 1.0, 0.0, out[i])


@compiled(fast=True)
def read_table(table, at, out):
    """One time of the tables for all lanes, out (m, 4, w); a table with one lane serves them all."""
    for j in range(out.shape[0]):
        for f in range(table.shape[2]):
            if table.shape[3] == 1:
                put(out, 4 * j + f, fill(table[at, j, f, 0]))
            else:
                put(out, 4 * j + f, get(table, (at * out.shape[0] + j) * table.shape[2] + f))


@compiled(fast=True)
def product(first, column, value, x, out):
    """out = A x for a sparse matrix with values by lane."""
    for i in range(out.shape[0]):
        total = fill(0.0)
        for p in range(first[i], first[i + 1]):
            total += get(value, p) * get(x, column[p])
        put(out, i, total)


@compiled(fast=True)
def contacts(gap, mode, values, table, weight, d, F, found, used):
    """Forces (m, w) of forces/mesh_contact.py without branches over lanes, their tangents, and the flank that touches.

    values (m, 6, w); table (m, 4, w); d (2 m, w): displacement and velocity; found (m, 4, w);
    used (m, w): impulses of the damping, to which this one is added with its weight.
    """
    one = fill(1.0)
    none = fill(0.0)
    for j in range(gap.size):
        if gap[j] == OWN_LAW:
            continue
        prescribed = get(values, VALUES * j + FORCE) * get(table, 4 * j + PUSH)
        if gap[j] == PRESCRIBED:
            put(F, j, prescribed)
            continue
        k = get(values, VALUES * j + K) * get(table, 4 * j + STIFFNESS)
        c = get(values, VALUES * j + C)
        x = get(d, 2 * j) - get(table, 4 * j + ERROR)
        rate = get(d, 2 * j + 1) - get(table, 4 * j + SLOPE)
        if gap[j] == BILATERAL:
            put(F, j, k * x + c * rate + prescribed)
            put(found, FOUND * j + IN_D, k)
            put(found, FOUND * j + IN_V, c)
            put(found, FOUND * j + FLANK, one)
            continue
        behind = -1.0 * x - get(values, VALUES * j + BACKLASH)
        ramp = get(values, VALUES * j + RAMP)
        touch = where_positive(x, one, where_positive(behind, fill(-1.0), none))
        depth = larger(larger(x, behind), none)
        closing = touch * rate
        share = depth * ramp
        if mode[j] != PENETRATION:
            ramp = where_positive(one - share, ramp, none)
            share = smaller(share, one)
        total = k * depth + c * share * closing
        holds = touch * touch
        if mode[j] != ADHESIVE:
            holds = where_positive(total, holds, none)
        put(F, j, touch * (holds * total) + prescribed)
        damping = holds * c * share
        growth = holds * (c * ramp * closing)
        put(found, FOUND * j + IN_D, holds * k + growth)
        put(found, FOUND * j + IN_V, damping)
        put(found, FOUND * j + GROWTH, growth)
        put(used, j, get(used, j) + weight * (damping * rate))
        put(found, FOUND * j + FLANK, touch)


@compiled(fast=True)
def count(mesh, table, d, F, found, last, sums):
    """Take a step into the statistics of the mesh contacts; arrays as in `contacts`, sums (m, 14, w)."""
    one = fill(1.0)
    none = fill(0.0)
    for j in range(mesh.size):
        if not mesh[j]:
            continue
        s = 14 * j
        flank = get(found, FOUND * j + FLANK)
        before = get(last, j)
        touching = flank * flank
        put(sums, s + DRIVING, get(sums, s + DRIVING) + where_positive(flank, one, none))
        put(sums, s + APART, get(sums, s + APART) + (one - touching))
        put(sums, s + BACK, get(sums, s + BACK) + where_positive(-1.0 * flank, one, none))
        put(sums, s + LOSSES, get(sums, s + LOSSES) + (one - touching) * (before * before))
        put(last, j, flank)
        f = get(F, j)
        x = get(d, 2 * j)
        put(sums, s + F_SUM, get(sums, s + F_SUM) + f)
        put(sums, s + F_SQUARES, get(sums, s + F_SQUARES) + f * f)
        put(sums, s + D_SUM, get(sums, s + D_SUM) + x)
        put(sums, s + D_SQUARES, get(sums, s + D_SQUARES) + x * x)
        put(sums, s + D_MIN, smaller(get(sums, s + D_MIN), x))
        put(sums, s + D_MAX, larger(get(sums, s + D_MAX), x))
        put(sums, s + F_MIN, smaller(get(sums, s + F_MIN), f))
        put(sums, s + F_MAX, larger(get(sums, s + F_MAX), f))
        x -= get(table, 4 * j + ERROR)
        put(sums, s + X_MIN, smaller(get(sums, s + X_MIN), x))
        put(sums, s + X_MAX, larger(get(sums, s + X_MAX), x))
