"""Compiled: many small systems side by side through the same time steps, by the Runge-Kutta method of order 4.

    z'' = f - K z - D z' - B F(B^T z, B^T z', t),   M = 1,   time in radians of the fastest mesh

Every array has the systems as its last axis of LANES entries, so that the innermost loops run over systems and vectorise. What
depends on time only (k(t), e(t), prescribed forces) stands in tables over the common period, for the times at and between steps.
Tangents T obey T'' = -K T - D T' - B (Kd B^T T + Kv B^T T') along the trajectory; each mesh period they are freed of rigid
motions and made orthonormal, and the logarithms of their growth sum up to Lyapunov exponents (Benettin et al., Meccanica 15
(1980) 9).
"""

from __future__ import annotations

import numpy as np

from rotorgear.solvers.compiled import compiled
from rotorgear.solvers.kernel_lane_parts import LANES, contacts, count, product, read_table


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
def remove(part, along, measured, unit):
    """Take away from `part` (k, w) as much of `along` (k, w) as the product of `measured` with the unit vector `unit` says."""
    total = np.zeros(LANES)
    for i in range(measured.shape[0]):
        for w in range(LANES):
            total[w] += measured[i, w] * unit[i, w]
    for i in range(part.shape[0]):
        for w in range(LANES):
            part[i, w] -= total[w] * along[i, w]


@compiled(fast=True)
def weigh(root, tangent, out):
    """Root of the stiffness times displacements, and velocities as they are: the energy of a tangent is the square of it."""
    n = root.shape[0]
    for i in range(n):
        for w in range(LANES):
            out[i, w] = 0.0
            out[n + i, w] = tangent[n + i, w]
        for j in range(n):
            for w in range(LANES):
                out[i, w] += root[i, j, w] * tangent[j, w]


@compiled(fast=True)
def orthonormal(tangents, weighed, root, rigid, growth):
    """Free tangents (t, 2 n, w) of rigid motions (r, n, w), make them orthonormal, add the logarithms of their sizes.

    Sizes are energies, which vibrations in a linear system keep: slow motions would seem to grow in most other norms.
    """
    n = tangents.shape[1] // 2
    for a in range(tangents.shape[0]):
        for r in range(rigid.shape[0]):
            remove(tangents[a, :n], rigid[r], tangents[a, :n], rigid[r])
            remove(tangents[a, n:], rigid[r], tangents[a, n:], rigid[r])
        weigh(root, tangents[a], weighed[a])
        for b in range(a):
            remove(tangents[a], tangents[b], weighed[a], weighed[b])
            weigh(root, tangents[a], weighed[a])
        size = np.zeros(LANES)
        for i in range(2 * n):
            for w in range(LANES):
                size[w] += weighed[a, i, w] ** 2
        for w in range(LANES):
            growth[a, w] += 0.5 * np.log(size[w])
            size[w] = 1.0 / np.sqrt(size[w])
        for i in range(2 * n):
            for w in range(LANES):
                tangents[a, i, w] *= size[w]
                weighed[a, i, w] *= size[w]


@compiled(fast=True, free=True)
def lanes_loop(turns, steps, counting, matrix, across, gap, mode, values, mesh, table, rigid, root, state, tangents, last,
               growth, section, sums):  # fmt: skip
    """Advance all lanes in place by common periods and record a section at the end of each.

    Args:
        turns: periods of the fastest mesh in a common one; steps: steps in one of those.
        counting: whether the statistics count.
        matrix: z'' from (z, z', F, 1): -K, -D, -B, f by rows, (n, 2 n + m + 1).
        across: d and d' of each column from (z, z'), (2 m, 2 n).
        gap, mode, mesh: of the columns, (m,); values: theirs, (m, 5, w), see `contacts`.
        table: (2 turns steps + 1, m, 4, 1 or w), without its last row where no force is prescribed.
        rigid: orthonormal motions without strain, (r, n, w); root: S with S^T S the mean stiffness, (n, n, w).
        state: z and z', (2 n, w); tangents: (t, 2 n, w); last: (m, w) flanks that touched last.
        growth: (p, t, w), section: (p, 2 m, w), sums: (m, 14, w): what is found in p common periods.
    """
    n, m, t = state.shape[0] // 2, mesh.size, tangents.shape[0]
    h = 2.0 * np.pi / steps
    now = np.zeros((m, 4, LANES))
    d, found = np.zeros((2 * m, LANES)), np.zeros((m, 3, LANES))
    y, a, total = np.ones((2 * n + m + 1, LANES)), np.empty((n, LANES)), np.zeros((2 * n, LANES))
    moved, ta, moved_total = np.zeros((t, 2 * n + m + 1, LANES)), np.empty((n, LANES)), np.zeros((t, 2 * n, LANES))
    F, weighed = y[2 * n : 2 * n + m], np.empty((t, 2 * n, LANES))
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
                orthonormal(tangents, weighed, root, rigid, growth[period])
                moved[:, : 2 * n] = tangents
        product(*across, state, section[period])
