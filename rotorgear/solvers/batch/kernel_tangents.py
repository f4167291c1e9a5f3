"""Compiled: tangents of a batch, freed of rigid-body motions and made orthonormal once in a period.

Benettin, Galgani, Giorgilli and Strelcyn, Meccanica 15 (1980) 9.
"""

from __future__ import annotations

import numpy as np

from rotorgear.solvers.contact.vectors import BATCH, fill, get, put
from rotorgear.solvers.time.compiled import compiled


@compiled(fast=True, inner=True)
def remove(part, part_at, along, along_at, measured, measured_at, unit, unit_at, rows):
    """Take away from rows of `part` as much of `along` as the product of `measured` with the unit vector `unit` says."""
    total = fill(0.0)
    for i in range(rows):
        total += get(measured, measured_at + i) * get(unit, unit_at + i)
    for i in range(rows):
        put(part, part_at + i, get(part, part_at + i) - total * get(along, along_at + i))


@compiled(fast=True, inner=True)
def look_along(state, carried, along):
    """Write z and z' (2 n, w) along the motions that the drive carries (c, n, w) to `along` (2 c, w)."""
    n = state.shape[0] // 2
    for r in range(carried.shape[0]):
        for part in range(2):
            total = fill(0.0)
            for i in range(n):
                total += get(state, part * n + i) * get(carried, r * n + i)
            put(along, 2 * r + part, total)


@compiled(fast=True, inner=True)
def keep_speed(state, carried, begun, length, along):
    """Give z and z' (2 n, w) what the drive gives at the end of a period, so that speeds along its motions are 0 on average.

    `begun` is `along` at the beginning of the period, whose length is in radians. Where a motion had a mean speed v in it, the
    next period begins slower by v than this one did, whatever pushes. An oscillation about the mean stays as it is.
    """
    look_along(state, carried, along)
    n = state.shape[0] // 2
    mean = fill(1.0 / length)
    for r in range(carried.shape[0]):
        moved = get(along, 2 * r) - get(begun, 2 * r)
        faster = get(along, 2 * r + 1) - get(begun, 2 * r + 1) + mean * moved
        for i in range(n):
            unit = get(carried, r * n + i)
            put(state, i, get(state, i) - moved * unit)
            put(state, n + i, get(state, n + i) - faster * unit)


@compiled(fast=True, inner=True)
def weigh(root, tangents, weighed, at):
    """Root of the stiffness times displacements, and velocities as they are: the energy of a tangent is the square of it."""
    n = root.shape[0]
    for i in range(n):
        total = fill(0.0)
        for j in range(n):
            total += get(root, n * i + j) * get(tangents, at + j)
        put(weighed, at + i, total)
        put(weighed, at + n + i, get(tangents, at + n + i))


@compiled(fast=True, inner=True)
def orthonormal(tangents, weighed, root, rigid, growth):
    """Free tangents (t, 2 n, w) of rigid-body motions (r, n, w), orthonormalise them, add the logarithms of their size to growth.

    Sizes are energies, which vibrations in a linear system keep: slow motions would seem to grow in most other norms.
    """
    rows = tangents.shape[1]
    n = rows // 2
    size = np.zeros(BATCH)
    for a in range(tangents.shape[0]):
        for r in range(rigid.shape[0]):
            for part in range(2):
                at = a * rows + part * n
                remove(tangents, at, rigid, r * n, tangents, at, rigid, r * n, n)
        weigh(root, tangents, weighed, a * rows)
        for b in range(a):
            remove(tangents, a * rows, tangents, b * rows, weighed, a * rows, weighed, b * rows, rows)
            weigh(root, tangents, weighed, a * rows)
        total = fill(0.0)
        for i in range(rows):
            one = get(weighed, a * rows + i)
            total += one * one
        put(size, 0, total)
        for w in range(BATCH):
            growth[a, w] += 0.5 * np.log(size[w])
            size[w] = 1.0 / np.sqrt(size[w])
        scale = get(size, 0)
        for i in range(a * rows, (a + 1) * rows):
            put(tangents, i, scale * get(tangents, i))
            put(weighed, i, scale * get(weighed, i))
