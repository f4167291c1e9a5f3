"""Compiled: what the lanes of kernel_lanes.py do in one stage of a step: tables, sparse products, contacts, statistics.

Every array has the systems as its last axis of LANES entries. Those with several rows for a column are flat, with offsets that
the compiler knows, so that it can tell the rows apart and vectorise the loops over lanes.
"""

from __future__ import annotations

import numpy as np

from rotorgear.solvers.compiled import compiled
from rotorgear.solvers.kernel_contact import schedule_all

LANES = 32
# How a column acts: as MeshContact.gap does, or as a force that is prescribed.
LINE, ONE_SIDED, NEVER_PARTS, PRESCRIBED = 0, 1, 2, 3
CLAMPED, UNCLAMPED, PENETRATION = 0, 1, 2
# Rows of the tables: share of the mean stiffness, error, its slope, share of the prescribed force.
STIFFNESS, ERROR, SLOPE, PUSH = 0, 1, 2, 3
# Rows of the sums: steps on the driving flank, apart, on the back flank, losses of contact; least and largest of the displacement
# d, of the approach d - e and of the force; sums of force, its square, displacement, its square.
DRIVING, APART, BACK, LOSSES, D_MIN, D_MAX, X_MIN, X_MAX, F_MIN, F_MAX, F_SUM, F_SQUARES, D_SUM, D_SQUARES = range(14)


@compiled
def tabulate(schedules, kind, parameters, parameters_first, state_first, angles, out):
    """State (r, s) of all laws at angles (r,) of the reference, at unit speed."""
    for i in range(angles.size):
        schedule_all(schedules, kind, parameters, parameters_first, state_first, angles[i], 1.0, 0.0, out[i])


@compiled(fast=True)
def read_table(table, row, out):
    """One time of the tables, for all lanes; a table with one lane serves them all."""
    for j in range(out.shape[0]):
        for f in range(table.shape[2]):
            if table.shape[3] == 1:
                value = table[row, j, f, 0]
                for w in range(LANES):
                    out[j, f, w] = value
            else:
                for w in range(LANES):
                    out[j, f, w] = table[row, j, f, w]


@compiled(fast=True)
def product(first, column, value, x, out):
    """out = A x for a sparse matrix with values by lane and rows of even length, up to six columns in one pass over the lanes."""
    for i in range(out.shape[0]):
        p, end = first[i], first[i + 1]
        if p + 4 < end:
            a, b, c = column[p], column[p + 1], column[p + 2]
            d, e, f = column[p + 3], column[p + 4], column[p + 5]
            for w in range(LANES):
                out[i, w] = (value[p, w] * x[a, w] + value[p + 1, w] * x[b, w] + value[p + 2, w] * x[c, w]) + (
                    value[p + 3, w] * x[d, w] + value[p + 4, w] * x[e, w] + value[p + 5, w] * x[f, w]
                )
            p += 6
        elif p + 2 < end:
            a, b, c, d = column[p], column[p + 1], column[p + 2], column[p + 3]
            for w in range(LANES):
                out[i, w] = (value[p, w] * x[a, w] + value[p + 1, w] * x[b, w]) + (
                    value[p + 2, w] * x[c, w] + value[p + 3, w] * x[d, w]
                )
            p += 4
        elif p < end:
            a, b = column[p], column[p + 1]
            for w in range(LANES):
                out[i, w] = value[p, w] * x[a, w] + value[p + 1, w] * x[b, w]
            p += 2
        else:
            for w in range(LANES):
                out[i, w] = 0.0
        while p < end:
            a, b = column[p], column[p + 1]
            for w in range(LANES):
                out[i, w] += value[p, w] * x[a, w] + value[p + 1, w] * x[b, w]
            p += 2


@compiled(fast=True)
def contacts(gap, mode, values, table, d, F, found):
    """Forces (m, w) of forces/mesh_contact.py without branches over lanes, their tangents, and the flank that touches.

    All arrays of lanes are flat, so that the compiler sees how far apart their rows are, and vectorises: values (m, 5, w): k, c,
    backlash, 1/ramp, prescribed force; table (m, 4, w); d (m, 2, w): displacement and velocity; found (m, 3, w).
    """
    for j in range(gap.size):
        p, q, x0, r = 5 * LANES * j, 4 * LANES * j, 2 * LANES * j, 3 * LANES * j
        if gap[j] == PRESCRIBED:
            for w in range(LANES):
                F[LANES * j + w] = values[p + 4 * LANES + w] * table[q + PUSH * LANES + w]
        elif gap[j] == NEVER_PARTS:
            for w in range(LANES):
                k, c = values[p + w] * table[q + w], values[p + LANES + w]
                x, rate = d[x0 + w] - table[q + ERROR * LANES + w], d[x0 + LANES + w] - table[q + SLOPE * LANES + w]
                F[LANES * j + w] = k * x + c * rate + values[p + 4 * LANES + w] * table[q + PUSH * LANES + w]
                found[r + w], found[r + LANES + w], found[r + 2 * LANES + w] = k, c, 1.0
        else:
            most = np.inf if mode[j] == PENETRATION else 1.0
            least = -np.inf if mode[j] == UNCLAMPED else 0.0
            for w in range(LANES):
                k, c = values[p + w] * table[q + w], values[p + LANES + w]
                x, rate = d[x0 + w] - table[q + ERROR * LANES + w], d[x0 + LANES + w] - table[q + SLOPE * LANES + w]
                behind, ramp = -x - values[p + 2 * LANES + w], values[p + 3 * LANES + w]
                touch = 1.0 if x > 0.0 else (-1.0 if behind > 0.0 else 0.0)
                depth = max(max(x, behind), 0.0)
                closing = touch * rate
                share = depth * ramp
                grows = ramp if share < most else 0.0
                share = min(share, most)
                total = k * depth + c * share * closing
                holds = touch * touch if total > least else 0.0
                F[LANES * j + w] = touch * holds * total + values[p + 4 * LANES + w] * table[q + PUSH * LANES + w]
                found[r + w] = holds * (k + c * grows * closing)
                found[r + LANES + w] = holds * c * share
                found[r + 2 * LANES + w] = touch


@compiled(fast=True)
def count(mesh, table, d, F, found, last, sums):
    """Take a step into the statistics of the mesh contacts; flat arrays as in `contacts`, sums (m, 14, w)."""
    for j in range(mesh.size):
        if not mesh[j]:
            continue
        s, f0, x0, e0 = 14 * LANES * j, LANES * j, 2 * LANES * j, (4 * j + ERROR) * LANES
        for w in range(LANES):
            now = found[(3 * j + 2) * LANES + w]
            sums[s + w] += 1.0 if now > 0.0 else 0.0
            sums[s + APART * LANES + w] += 1.0 if now == 0.0 else 0.0
            sums[s + BACK * LANES + w] += 1.0 if now < 0.0 else 0.0
            sums[s + LOSSES * LANES + w] += abs(last[f0 + w]) if now == 0.0 else 0.0
            last[f0 + w] = now
        for w in range(LANES):
            f, x = F[f0 + w], d[x0 + w]
            sums[s + F_SUM * LANES + w] += f
            sums[s + F_SQUARES * LANES + w] += f * f
            sums[s + D_SUM * LANES + w] += x
            sums[s + D_SQUARES * LANES + w] += x * x
            sums[s + D_MIN * LANES + w] = min(sums[s + D_MIN * LANES + w], x)
            sums[s + D_MAX * LANES + w] = max(sums[s + D_MAX * LANES + w], x)
            sums[s + F_MIN * LANES + w] = min(sums[s + F_MIN * LANES + w], f)
            sums[s + F_MAX * LANES + w] = max(sums[s + F_MAX * LANES + w], f)
            x -= table[e0 + w]
            sums[s + X_MIN * LANES + w] = min(sums[s + X_MIN * LANES + w], x)
            sums[s + X_MAX * LANES + w] = max(sums[s + X_MAX * LANES + w], x)
