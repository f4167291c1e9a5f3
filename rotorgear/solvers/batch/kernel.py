"""Compiled: many small systems side by side through the same time steps, by the Runge-Kutta method of order 4.

    z'' = f - K z - D z' - B F(B^T z, B^T z', t),   M = 1,   time in radians of the fastest excitation

Every array has the systems as its last axis of BATCH entries, which move through vector registers together. What depends on
time only (k(t), e(t), prescribed forces) is in tables over the common period, for the times at and between steps.
Tangents T obey T'' = -K T - D T' - B (Kd B^T T + Kv B^T T') along the trajectory; once in a period of the fastest excitation
they are freed of rigid-body motions and made orthonormal, and the logarithms of their growth sum up to Lyapunov exponents.
Columns of planets that go round are told where the pins were at the start, and act where these are (kernel_sisters.py).
"""

from __future__ import annotations

import numpy as np

from rotorgear.solvers.batch.arguments import TangentWork
from rotorgear.solvers.batch.columns import STIFFNESS
from rotorgear.solvers.batch.kernel_jumps import add_impulses, add_used_along, missing, missing_along
from rotorgear.solvers.batch.kernel_laws import SPACE, force_laws, laws_along, schedule_laws
from rotorgear.solvers.batch.kernel_parts import (
    FOUND,
    IN_D,
    IN_V,
    add_moments,
    contacts,
    count,
    of,
    product,
    put_of,
    read_table,
    row_product,
    widen,
)
from rotorgear.solvers.batch.kernel_sisters import follow_planets, turn_rows
from rotorgear.solvers.batch.kernel_switches import (
    DONE,
    MIDDLE,
    STEP_BEGIN,
    add_contacts,
    correct,
    keep_begin,
    keep_end,
)
from rotorgear.solvers.batch.kernel_tangents import keep_speed, look_along, orthonormal
from rotorgear.solvers.contact.vectors import BATCH, copy_rows, get, put, work
from rotorgear.solvers.time.compiled import compiled


@compiled(fast=True, inner=True)
def advance(number, h, matrix, stage, ahead, at, base, base_at, total):
    """Add a stage's slopes to those of the step, and write the state of the next stage; the last one writes the step's end, too.

    Args:
        number: of the stage, 0 to 3. h: the step. matrix: z'' from (z, z', F, 1).
        stage, ahead: rows of this stage and of the next one from `at` on. base: z and z' at the step's begin from `base_at` on.
        total: sums of slopes so far, (2 n, w).
    """
    first = matrix.first
    column = matrix.column
    value = matrix.value
    n = total.shape[0] // 2
    weight = 1.0 if number == 0 else 2.0
    share = h if number == 2 else 0.5 * h
    for i in range(n):
        a = row_product(i, first, column, value, stage, at)
        v = get(stage, at + n + i)
        q0 = get(base, base_at + i)
        v0 = get(base, base_at + n + i)
        if number == 3:
            q0 += h / 6.0 * (get(total, i) + v)
            v0 += h / 6.0 * (get(total, n + i) + a)
            put(base, base_at + i, q0)
            put(base, base_at + n + i, v0)
            put(ahead, at + i, q0)
            put(ahead, at + n + i, v0)
            continue
        if number == 0:
            put(total, i, v)
            put(total, n + i, a)
        else:
            put(total, i, get(total, i) + weight * v)
            put(total, n + i, get(total, n + i) + weight * a)
        put(ahead, at + i, q0 + share * v)
        put(ahead, at + n + i, v0 + share * a)


@compiled(fast=True, inner=True)
def tangent_stage(number, h, time, system, columns, acting, sisters, found, kept, stage, ahead, base, work):
    """One stage of all tangents: (t, 2 n + m + 1, w) of this stage and the next, (t, 2 n, w) of the step's begin."""
    matrix = system.matrix
    across = system.across
    jumps = columns.jumps
    jumping = columns.jumping
    d = work.d
    blocks = work.blocks
    totals = work.totals
    used = work.used
    start = work.start
    own = acting.laws.kind.size > 0
    t = stage.shape[0]
    rows = stage.shape[1]
    n = base.shape[1] // 2
    m = found.shape[0]
    for k in range(t):
        at = k * rows
        product(across, stage, at, d)
        if sisters is not None:
            follow_planets(sisters, time, d)
        for j in range(m):
            along = of(found, j, IN_D) * get(d, 2 * j) + of(found, j, IN_V) * get(d, 2 * j + 1)
            put(stage, at + 2 * n + j, along)
        if own:
            laws_along(acting, blocks, d, stage, at + 2 * n)
        add_contacts(number, h, columns, found, d, work.done, DONE * m * k)
        if jumping:
            add_used_along(jumps, weight_of(number, h), found, kept, d, used, start, m * k, number == 0)
        if sisters is not None:
            turn_rows(sisters, -time, stage, at + 2 * n, 1)
        advance(number, h, matrix, stage, ahead, at, base, 2 * n * k, totals[k])


@compiled(inner=True)
def weight_of(number, h):
    """Weight of a stage in a step."""
    return (h / 6.0) if number in (0, 3) else (h / 3.0)


@compiled(fast=True, inner=True)
def end_tangents(time, system, columns, sisters, kept, moved, tangents, impulse, work):
    """Put the impulses of the damping right along all tangents."""
    across = system.across
    per_force = system.per_force
    jumps = columns.jumps
    values = columns.values
    d = work.d
    used = work.used
    start = work.start
    t = moved.shape[0]
    rows = moved.shape[1]
    n = tangents.shape[1] // 2
    m = jumps.size
    for k in range(t):
        product(across, moved, k * rows, d)
        if sisters is not None:
            follow_planets(sisters, time, d)
        missing_along(jumps, values, kept, d, used, start, m * k, impulse)
        if sisters is not None:
            turn_rows(sisters, -time, impulse, 0, 1)
        add_impulses(per_force, impulse, moved, k * rows, tangents, 2 * n * k)


@compiled(inner=True)
def switch_tangents(h, time, system, columns, sisters, step_begin, ends, moved, tangents, work):
    """Put all tangents right where a contact has switched in a step."""
    across = system.across
    d = work.d
    m = columns.kind.size
    for k in range(tangents.shape[0]):
        product(across, moved[k], 0, d)
        if sisters is not None:
            follow_planets(sisters, time, d)
        correct(
            h,
            time,
            columns,
            sisters,
            step_begin,
            ends,
            system.per_force,
            d,
            work.done,
            tangents[k],
            moved[k],
            DONE * m * k,
        )


@compiled(fast=True, free=True, seconds=25.0)
def batch_loop(turns, steps, begun, counting, system, columns, table, acting, sisters, seen_sisters, motion):
    """Advance the motion of all systems in place by common periods and record a section at the end of each.

    turns: periods of the fastest excitation in a common one. steps: in one of those. begun: common periods before.
    counting: whether the statistics count. columns: of a batch. acting: see `ActingLaws`.
    table: (2 turns steps + 1, m, 4, 1 or w), without its last row where no force is prescribed.
    sisters, seen_sisters: planets that go round among the columns and among what is watched; None where there are none.
    """
    matrix = system.matrix
    across = system.across
    per_force = system.per_force
    jumps = columns.jumps
    jumping = columns.jumping
    counted = columns.counted
    values = columns.values
    state = motion.state
    kept = motion.kept
    tangents = motion.tangents
    last = motion.last
    growth = motion.growth
    section = motion.section
    sums = motion.sums
    extremes = motion.extremes
    moments = motion.moments
    watched = system.watched
    p = extremes.shape[1]
    seen = work(p)
    n = state.shape[0] // 2
    m = counted.size
    t = tangents.shape[0]
    rows = 2 * n + m + 1
    own = acting.laws.kind.size > 0
    carrying = system.carried.shape[0] > 0
    at_begin = work(2 * system.carried.shape[0])
    at_end = work(2 * system.carried.shape[0])
    h = 2.0 * np.pi / steps
    now = work(4 * m).reshape(m, 4, BATCH)
    found = work(FOUND * m).reshape(m, FOUND, BATCH)
    d = work(2 * m)
    total = work(2 * n)
    stage = work(rows)
    ahead = work(rows)
    stage[:] = 1.0
    ahead[:] = 1.0
    moved = work(t * rows).reshape(t, rows, BATCH)
    moved_ahead = work(t * rows).reshape(t, rows, BATCH)
    weighed = work(t * 2 * n).reshape(t, 2 * n, BATCH)
    blocks = work(2 * acting.laws.block_first[-1]).reshape(2, acting.laws.block_first[-1], BATCH)
    along = TangentWork(
        d, blocks, work(t * 2 * n).reshape(t, 2 * n, BATCH), work(t * m), work(t * m), work(t * m * DONE)
    )
    step_begin = work(m * STEP_BEGIN).reshape(m, STEP_BEGIN, BATCH)
    ends = work(m * 4).reshape(m, 4, BATCH)
    condition = np.zeros((BATCH, acting.laws.state_first[-1]))
    space = np.zeros(SPACE)
    used = work(m)
    impulse = work(m)
    F = stage[2 * n : 2 * n + m]
    F_ahead = ahead[2 * n : 2 * n + m]
    copy_rows(state, 0, stage, 0, 2 * n)
    for k in range(t):
        copy_rows(tangents, 2 * n * k, moved, rows * k, 2 * n)
    for period in range(growth.shape[0]):
        if carrying:
            look_along(state, system.carried, at_begin)
        for step in range(turns * steps):
            for number in range(4):
                if number != 2:
                    at = 2 * step + (number + 1) // 2
                    time = 0.5 * h * at
                    read_table(table, at, now)
                    if own:
                        schedule_laws(acting, 0.5 * h * (2.0 * steps * turns * (begun + period) + at), condition)
                product(across, stage, 0, d)
                if sisters is not None:
                    follow_planets(sisters, time, d)
                contacts(columns, now, weight_of(number, h), d, F, found, used)
                if own:
                    force_laws(acting, condition, d, F, found, blocks, space)
                if number == 0 and counting:
                    count(counted, now, d, F, found, last, sums)
                    product(watched, stage, 0, seen)
                    if seen_sisters is not None:
                        turn_rows(seen_sisters, time, seen, 0, 1)
                    widen(seen, extremes, p)
                    add_moments(seen, p, moments)
                if sisters is not None:
                    turn_rows(sisters, -time, F, 0, 1)
                advance(number, h, matrix, stage, ahead, 0, state, 0, total)
                if t:
                    if number == 0:
                        keep_begin(columns, now, d, found, step_begin)
                    elif number == 1:
                        for j in range(m):
                            put_of(step_begin, j, MIDDLE, of(now, j, STIFFNESS))
                    tangent_stage(
                        number,
                        h,
                        time,
                        system,
                        columns,
                        acting,
                        sisters,
                        found,
                        kept,
                        moved,
                        moved_ahead,
                        tangents,
                        along,
                    )
                stage, ahead, moved, moved_ahead, F, F_ahead = ahead, stage, moved_ahead, moved, F_ahead, F
            if jumping or t:
                product(across, stage, 0, d)
                if sisters is not None:
                    follow_planets(sisters, time, d)
            if t and keep_end(columns, now, d, step_begin, ends):
                switch_tangents(h, time, system, columns, sisters, step_begin, ends, moved, tangents, along)
                product(across, stage, 0, d)
                if sisters is not None:
                    follow_planets(sisters, time, d)
            if jumping:
                missing(jumps, values, now, d, used, kept, impulse)
                if sisters is not None:
                    turn_rows(sisters, -time, impulse, 0, 1)
                add_impulses(per_force, impulse, stage, 0, state, 0)
                if t:
                    end_tangents(time, system, columns, sisters, kept, moved, tangents, impulse, along)
            if t and (step + 1) % steps == 0:
                orthonormal(tangents, weighed, system.root, system.rigid, growth[period])
                for k in range(t):
                    copy_rows(tangents, 2 * n * k, moved, rows * k, 2 * n)
        if carrying:
            keep_speed(state, system.carried, at_begin, 2.0 * np.pi * turns, at_end)
            copy_rows(state, 0, stage, 0, 2 * n)
        product(across, state, 0, section[period])
        if sisters is not None:
            follow_planets(sisters, 2.0 * np.pi * turns, section[period])
