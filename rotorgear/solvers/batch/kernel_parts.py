"""Compiled: what the batch of kernel.py does in one stage of a step: tables, sparse products, contacts, statistics.

Every array has the systems as its last axis of BATCH entries, and is read by rows (solvers/contact/vectors.py).
"""

from __future__ import annotations

from rotorgear.solvers.batch.columns import (
    CLEARANCE,
    ERROR,
    FORCE,
    FORCE_SHARE,
    OWN_LAW,
    PER_DEPTH,
    PRESCRIBED,
    SLOPE,
    STIFFNESS,
    C,
    K,
)
from rotorgear.solvers.contact.gap_contact import gap_contact, tied_contact
from rotorgear.solvers.contact.kinds import BILATERAL
from rotorgear.solvers.contact.vectors import fill, formula, get, larger, put, smaller, where_positive
from rotorgear.solvers.time.compiled import compiled
from rotorgear.solvers.time.kernel_contact import schedule_all

# What a contact leaves: its tangents in displacement and velocity, the side that touches, and the part of the tangent in
# displacement that comes from the growth of the damping with depth.
IN_D, IN_V, SIDE, GROWTH = range(4)
FOUND = 4
# Rows of the sums: steps on the front side, apart, on the back side, losses of contact; least and largest of the displacement
# d, of the approach d - e and of the force; sums of force, its square, displacement, its square.
FRONT, APART, BACK, LOSSES, D_MIN, D_MAX, X_MIN, X_MAX, F_MIN, F_MAX, F_SUM, F_SQUARES, D_SUM, D_SQUARES = range(14)
SUMS = 14


@formula
def of(array, j, which):
    """One of the quantities of column j, a number for each system, from an array (m, quantities, w)."""
    return get(array, array.shape[1] * j + which)


@formula
def put_of(array, j, which, value):
    """Write one of the quantities of column j."""
    put(array, array.shape[1] * j + which, value)


@formula
def add_to(array, j, which, value):
    """Add to one of the quantities of column j."""
    put_of(array, j, which, of(array, j, which) + value)


@compiled
def tabulate(laws, angles, out):
    """State (r, s) of all laws at angles (r,) of the reference, at unit speed."""
    for i in range(angles.size):
        schedule_all(laws, angles[i], 1.0, 0.0, out[i])


@compiled(fast=True, inner=True)
def read_table(table, at, out):
    """One time of the tables for all systems, out (m, 4, w); a table of one system is that of all."""
    for j in range(out.shape[0]):
        for f in range(table.shape[2]):
            if table.shape[3] == 1:
                put_of(out, j, f, fill(table[at, j, f, 0]))
            else:
                put_of(out, j, f, get(table, (at * out.shape[0] + j) * table.shape[2] + f))


@compiled(fast=True, inner=True)
def row_product(i, first, column, value, x, at):
    """Row i of a sparse matrix with values by system, times rows of x from `at` on."""
    total = fill(0.0)
    for p in range(first[i], first[i + 1]):
        total += get(value, p) * get(x, at + column[p])
    return total


@compiled(fast=True, inner=True)
def product(matrix, x, at, out):
    """out = A x for a sparse matrix with values by system, and rows of x from `at` on."""
    first = matrix.first
    column = matrix.column
    value = matrix.value
    for i in range(out.shape[0]):
        put(out, i, row_product(i, first, column, value, x, at))


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
        prescribed = of(values, j, FORCE) * of(table, j, FORCE_SHARE)
        if kind[j] == PRESCRIBED:
            put(F, j, prescribed)
            continue
        k = of(values, j, K) * of(table, j, STIFFNESS)
        c = of(values, j, C)
        x = get(d, 2 * j) - of(table, j, ERROR)
        rate = get(d, 2 * j + 1) - of(table, j, SLOPE)
        if kind[j] == BILATERAL:
            write_contact(tied_contact(k, c, x, rate), prescribed, weight, rate, j, F, found, used)
        else:
            clearance = of(values, j, CLEARANCE)
            per_depth = of(values, j, PER_DEPTH)
            now = gap_contact(mode[j], k, c, clearance, per_depth, x, rate)
            write_contact(now, prescribed, weight, rate, j, F, found, used)


@formula
def write_contact(now, prescribed, weight, rate, j, F, found, used):
    """Write what column j's contact found, and a force prescribed beside it; see `contacts`."""
    put(F, j, now.force + prescribed)
    put_of(found, j, IN_D, now.stiffness)
    put_of(found, j, IN_V, now.damping)
    put_of(found, j, SIDE, now.side)
    put_of(found, j, GROWTH, now.growth)
    put(used, j, get(used, j) + weight * (now.damping * rate))


@compiled(fast=True, inner=True)
def widen(seen, extremes, p):
    """Take p displacements and loads (p, w) into their least and largest values so far, (2, p, w)."""
    for j in range(p):
        x = get(seen, j)
        put(extremes, j, smaller(get(extremes, j), x))
        put(extremes, p + j, larger(get(extremes, p + j), x))


@compiled(fast=True, inner=True)
def add_moments(seen, p, moments):
    """Add the last l of p watched values (p, w) and their squares to the sums of them, (2, l, w)."""
    loads = moments.shape[1]
    for j in range(loads):
        x = get(seen, p - loads + j)
        put(moments, j, get(moments, j) + x)
        put(moments, loads + j, get(moments, loads + j) + x * x)


@compiled(fast=True, inner=True)
def count(counted, table, d, F, found, last, sums):
    """Take a step into the statistics of the columns that are counted (m,); arrays as in `contacts`, sums (m, 14, w)."""
    one = fill(1.0)
    none = fill(0.0)
    for j in range(counted.size):
        if not counted[j]:
            continue
        side = of(found, j, SIDE)
        before = get(last, j)
        touching = side * side
        add_to(sums, j, FRONT, where_positive(side, one, none))
        add_to(sums, j, APART, (one - touching))
        add_to(sums, j, BACK, where_positive(-side, one, none))
        add_to(sums, j, LOSSES, (one - touching) * (before * before))
        put(last, j, side)
        f = get(F, j)
        x = get(d, 2 * j)
        add_to(sums, j, F_SUM, f)
        add_to(sums, j, F_SQUARES, f * f)
        add_to(sums, j, D_SUM, x)
        add_to(sums, j, D_SQUARES, x * x)
        put_of(sums, j, D_MIN, smaller(of(sums, j, D_MIN), x))
        put_of(sums, j, D_MAX, larger(of(sums, j, D_MAX), x))
        put_of(sums, j, F_MIN, smaller(of(sums, j, F_MIN), f))
        put_of(sums, j, F_MAX, larger(of(sums, j, F_MAX), f))
        x -= of(table, j, ERROR)
        put_of(sums, j, X_MIN, smaller(of(sums, j, X_MIN), x))
        put_of(sums, j, X_MAX, larger(of(sums, j, X_MAX), x))
