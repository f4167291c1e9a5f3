"""Compiled: what the lanes of kernel.py do in one stage of a step: tables, sparse products, contacts, statistics.

Every array has the systems as its last axis of LANES entries, and is read by rows of lanes (solvers/contact/vectors.py).
"""

from __future__ import annotations

from rotorgear.solvers.contact.gap_contact import gap_contact, tied_contact
from rotorgear.solvers.contact.kinds import BILATERAL
from rotorgear.solvers.contact.vectors import fill, formula, get, larger, put, smaller, where_positive
from rotorgear.solvers.lanes.columns import ERROR, OWN_LAW, PRESCRIBED, PUSH, SLOPE, STIFFNESS, TABLE_ROWS
from rotorgear.solvers.time.compiled import compiled
from rotorgear.solvers.time.kernel_contact import schedule_all

# Values of a column: k, c, clearance, 1/depth of regularisation, prescribed force, depth of regularisation.
K, C, CLEARANCE, PER_DEPTH, FORCE, DEPTH = range(6)
VALUES = 6
# What a contact leaves: its tangents in displacement and velocity, the side that touches, and the part of the tangent in
# displacement that comes from the growth of the damping with depth.
IN_D, IN_V, SIDE, GROWTH = range(4)
FOUND = 4
# Rows of the sums: steps on the front side, apart, on the back side, losses of contact; least and largest of the displacement
# d, of the approach d - e and of the force; sums of force, its square, displacement, its square.
FRONT, APART, BACK, LOSSES, D_MIN, D_MAX, X_MIN, X_MAX, F_MIN, F_MAX, F_SUM, F_SQUARES, D_SUM, D_SQUARES = range(14)
SUMS = 14


@compiled
def tabulate(laws, angles, out):
    """State (r, s) of all laws at angles (r,) of the reference, at unit speed."""
    for i in range(angles.size):
        schedule_all(laws, angles[i], 1.0, 0.0, out[i])


@compiled(fast=True, inner=True)
def read_table(table, at, out):
    """One time of the tables for all lanes, out (m, 4, w); a table with one lane serves them all."""
    for j in range(out.shape[0]):
        for f in range(table.shape[2]):
            if table.shape[3] == 1:
                put(out, TABLE_ROWS * j + f, fill(table[at, j, f, 0]))
            else:
                put(out, TABLE_ROWS * j + f, get(table, (at * out.shape[0] + j) * table.shape[2] + f))


@compiled(fast=True, inner=True)
def product(matrix, x, out):
    """out = A x for a sparse matrix with values by lane."""
    first = matrix.first
    column = matrix.column
    value = matrix.value
    for i in range(out.shape[0]):
        total = fill(0.0)
        for p in range(first[i], first[i + 1]):
            total += get(value, p) * get(x, column[p])
        put(out, i, total)


@compiled(fast=True, inner=True)
def contacts(columns, table, weight, d, F, found, used):
    """Forces (m, w) of the columns that are contacts or prescribed, their tangents, and the side that touches.

    table (m, 4, w); d (2 m, w): displacement and velocity; found (m, 4, w);
    used (m, w): impulses of the damping, to which this one is added with its weight.
    """
    kind = columns.kind
    mode = columns.mode
    values = columns.values
    for j in range(kind.size):
        if kind[j] == OWN_LAW:
            continue
        prescribed = get(values, VALUES * j + FORCE) * get(table, TABLE_ROWS * j + PUSH)
        if kind[j] == PRESCRIBED:
            put(F, j, prescribed)
            continue
        k = get(values, VALUES * j + K) * get(table, TABLE_ROWS * j + STIFFNESS)
        c = get(values, VALUES * j + C)
        x = get(d, 2 * j) - get(table, TABLE_ROWS * j + ERROR)
        rate = get(d, 2 * j + 1) - get(table, TABLE_ROWS * j + SLOPE)
        if kind[j] == BILATERAL:
            leave(tied_contact(k, c, x, rate), prescribed, weight, rate, j, F, found, used)
        else:
            clearance = get(values, VALUES * j + CLEARANCE)
            per_depth = get(values, VALUES * j + PER_DEPTH)
            now = gap_contact(mode[j], k, c, clearance, per_depth, x, rate)
            leave(now, prescribed, weight, rate, j, F, found, used)


@formula
def leave(now, prescribed, weight, rate, j, F, found, used):
    """Write what column j's contact found, and a force prescribed beside it; see `contacts`."""
    put(F, j, now.force + prescribed)
    put(found, FOUND * j + IN_D, now.stiffness)
    put(found, FOUND * j + IN_V, now.damping)
    put(found, FOUND * j + SIDE, now.side)
    put(found, FOUND * j + GROWTH, now.growth)
    put(used, j, get(used, j) + weight * (now.damping * rate))


@compiled(fast=True, inner=True)
def widen(seen, extremes, p):
    """Take p displacements (p, w) into their least and largest values so far, (2, p, w)."""
    for j in range(p):
        x = get(seen, j)
        put(extremes, j, smaller(get(extremes, j), x))
        put(extremes, p + j, larger(get(extremes, p + j), x))


@compiled(fast=True, inner=True)
def count(counted, table, d, F, found, last, sums):
    """Take a step into the statistics of the columns that are counted (m,); arrays as in `contacts`, sums (m, 14, w)."""
    one = fill(1.0)
    none = fill(0.0)
    for j in range(counted.size):
        if not counted[j]:
            continue
        s = SUMS * j
        side = get(found, FOUND * j + SIDE)
        before = get(last, j)
        touching = side * side
        put(sums, s + FRONT, get(sums, s + FRONT) + where_positive(side, one, none))
        put(sums, s + APART, get(sums, s + APART) + (one - touching))
        put(sums, s + BACK, get(sums, s + BACK) + where_positive(-side, one, none))
        put(sums, s + LOSSES, get(sums, s + LOSSES) + (one - touching) * (before * before))
        put(last, j, side)
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
        x -= get(table, TABLE_ROWS * j + ERROR)
        put(sums, s + X_MIN, smaller(get(sums, s + X_MIN), x))
        put(sums, s + X_MAX, larger(get(sums, s + X_MAX), x))
