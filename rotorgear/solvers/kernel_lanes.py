"""Compiled: many small systems side by side through the same time steps, by the Runge-Kutta method of order 4.

    z'' = f - K z - D z' - B F(B^T z, B^T z', t),   M = 1,   time in radians of the fastest mesh

Every array has the systems as its last axis of LANES entries, so that the innermost loops run over systems and vectorise. What depends
on time only (k(t), e(t), prescribed forces) stands in tables over the common period, for the times at and between steps. Tangents T obey
T'' = -K T - D T' - B (Kd B^T T + Kv B^T T') along the trajectory; each mesh period they are freed of rigid motions and made
orthonormal, and the logarithms of their growth sum up to Lyapunov exponents (Benettin et al., Meccanica 15 (1980) 9).
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
    """out = A x for a sparse matrix with values by lane, up to six columns in one pass over the lanes; its rows hold even numbers."""
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
def next_stage(keep, weight, share, base, stage, a, total):
    """Add a stage's slopes to those of the step (keep 1; 0: begin with them), and turn its state into that of the next one."""
    n = a.shape[0]
    for i in range(n):
        for w in range(LANES):
            total[i, w] = keep * total[i, w] + weight * stage[n + i, w]
            stage[i, w] = base[i, w] + share * stage[n + i, w]
        for w in range(LANES):
            total[n + i, w] = keep * total[n + i, w] + weight * a[i, w]
            stage[n + i, w] = base[n + i, w] + share * a[i, w]


@compiled(fast=True)
def last_stage(weight, base, stage, a, total):
    """Add the slopes of the last stage, and take the step: state and first stage of the next one."""
    n = a.shape[0]
    for i in range(n):
        for w in range(LANES):
            base[i, w] += total[i, w] + weight * stage[n + i, w]
            stage[i, w] = base[i, w]
        for w in range(LANES):
            base[n + i, w] += total[n + i, w] + weight * a[i, w]
            stage[n + i, w] = base[n + i, w]


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


@compiled(fast=True)
def remove(part, along):
    """Take away from `part` (k, w) what lies along the unit vectors `along` (k, w)."""
    total = np.zeros(LANES)
    for i in range(part.shape[0]):
        for w in range(LANES):
            total[w] += part[i, w] * along[i, w]
    for i in range(part.shape[0]):
        for w in range(LANES):
            part[i, w] -= total[w] * along[i, w]


@compiled(fast=True)
def orthonormal(tangents, rigid, growth):
    """Free tangents (t, 2 n, w) of rigid motions (r, n, w), make them orthonormal one by one, add the logarithms of their sizes."""
    n = tangents.shape[1] // 2
    for a in range(tangents.shape[0]):
        for r in range(rigid.shape[0]):
            remove(tangents[a, :n], rigid[r])
            remove(tangents[a, n:], rigid[r])
        for b in range(a):
            remove(tangents[a], tangents[b])
        size = np.zeros(LANES)
        for i in range(2 * n):
            for w in range(LANES):
                size[w] += tangents[a, i, w] ** 2
        for w in range(LANES):
            growth[a, w] += 0.5 * np.log(size[w])
            size[w] = 1.0 / np.sqrt(size[w])
        for i in range(2 * n):
            for w in range(LANES):
                tangents[a, i, w] *= size[w]


@compiled(fast=True, free=True)
def lanes_loop(turns, steps, counting, matrix, across, gap, mode, values, mesh, table, rigid, state, tangents, last,
               growth, section, sums):  # fmt: skip
    """Advance all lanes in place by common periods and record a section at the end of each.

    Args:
        turns: periods of the fastest mesh in a common one; steps: steps in one of those.
        counting: whether the statistics count.
        matrix: z'' from (z, z', F, 1): -K, -D, -B, f by rows, (n, 2 n + m + 1); across: d and d' of each column from (z, z'), (2 m, 2 n).
        gap, mode, mesh: of the columns, (m,); values: theirs, (m, 5, w), see `contacts`.
        table: (2 turns steps + 1, m, 4, 1 or w), without its last row where no force is prescribed; rigid: orthonormal motions without strain, (r, n, w).
        state: z and z', (2 n, w); tangents: (t, 2 n, w); last: (m, w) flanks that touched last.
        growth: (p, t, w), section: (p, 2 m, w), sums: (m, 14, w): what is found in p common periods.
    """
    n, m, t = state.shape[0] // 2, mesh.size, tangents.shape[0]
    h = 2.0 * np.pi / steps
    now = np.zeros((m, 4, LANES))
    d, found = np.zeros((2 * m, LANES)), np.zeros((m, 3, LANES))
    y, a, total = np.ones((2 * n + m + 1, LANES)), np.empty((n, LANES)), np.zeros((2 * n, LANES))
    moved, ta, moved_total = np.zeros((t, 2 * n + m + 1, LANES)), np.empty((n, LANES)), np.zeros((t, 2 * n, LANES))
    F = y[2 * n : 2 * n + m]
    flat = (
        values.reshape(values.size),
        now.reshape(now.size),
        d.reshape(d.size),
        F.reshape(F.size),
        found.reshape(found.size),
    )
    flat_last, flat_sums = last.reshape(last.size), sums.reshape(sums.size)
    y[: 2 * n], moved[:, : 2 * n] = state, tangents
    for period in range(growth.shape[0]):
        for step in range(turns * steps):
            for stage in range(4):
                keep = 0.0 if stage == 0 else 1.0
                weight = (1.0 if stage in (0, 3) else 2.0) * h / 6.0
                share = h if stage == 2 else 0.5 * h
                if stage != 2:
                    read_table(table, 2 * step + (stage + 1) // 2, now)
                product(*across, y, d)
                contacts(gap, mode, *flat)
                if stage == 0 and counting:
                    count(mesh, *flat[1:], flat_last, flat_sums)
                product(*matrix, y, a)
                if stage < 3:
                    next_stage(keep, weight, share, state, y, a, total)
                else:
                    last_stage(weight, state, y, a, total)
                for k in range(t):
                    product(*across, moved[k], d)
                    for j in range(m):
                        for w in range(LANES):
                            moved[k, 2 * n + j, w] = found[j, 0, w] * d[2 * j, w] + found[j, 1, w] * d[2 * j + 1, w]
                    product(*matrix, moved[k], ta)
                    if stage < 3:
                        next_stage(keep, weight, share, tangents[k], moved[k], ta, moved_total[k])
                    else:
                        last_stage(weight, tangents[k], moved[k], ta, moved_total[k])
            if t and (step + 1) % steps == 0:
                orthonormal(tangents, rigid, growth[period])
                moved[:, : 2 * n] = tangents
        product(*across, state, section[period])
