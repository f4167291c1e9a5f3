"""Compiled: one small system step by step through the method and the forces of kernel.py, recording as it goes.

It is for few systems and a short time, so it has no batch and no tangents; a test compares its steps with those of a batch.
"""

from __future__ import annotations

import numpy as np

from rotorgear.solvers.batch.arguments import PathWork
from rotorgear.solvers.batch.columns import ALWAYS, ERROR, OWN_LAW, PRESCRIBED, PUSH, SLOPE, STIFFNESS
from rotorgear.solvers.batch.kernel_laws import SPACE
from rotorgear.solvers.batch.kernel_parts import CLEARANCE, DEPTH, FORCE, PER_DEPTH, C, K
from rotorgear.solvers.contact.gap_contact import contact, momentum
from rotorgear.solvers.time.compiled import compiled


@compiled(inner=True)
def force(kind, mode, values, now, d, v):
    """Force of one column, and the share of its damping that can jump.

    values (6,) of the column; now (4,) of its table; see `contacts`.
    """
    push = values[FORCE] * now[PUSH]
    if kind == PRESCRIBED:
        return push, 0.0
    rate = v - now[SLOPE]
    found = contact(
        kind,
        mode,
        values[K] * now[STIFFNESS],
        values[C],
        values[CLEARANCE],
        values[PER_DEPTH],
        d - now[ERROR],
        rate,
    )
    return found.force + push, found.damping * rate


@compiled(inner=True)
def own_schedules(laws, time, condition):
    """Fill the state (s,) of the laws at a time in radians of the fastest excitation."""
    schedules = laws.schedules
    kind = laws.kind
    parameters = laws.parameters
    parameters_first = laws.parameters_first
    state_first = laws.state_first
    clock = laws.clock
    for i in range(kind.size):
        schedules[kind[i]](
            time * clock[0],
            clock[1] * clock[0],
            time / clock[1],
            parameters[parameters_first[i] : parameters_first[i + 1]],
            condition[state_first[i] : state_first[i + 1]],
        )


@compiled(inner=True)
def own_forces(laws, work):
    """Forces of the laws of kernel_laws.py to work.local, one system."""
    forces = laws.forces
    kind = laws.kind
    place = laws.place
    parameters = laws.parameters
    parameters_first = laws.parameters_first
    state_first = laws.state_first
    rate = laws.clock[1]
    local = work.local
    condition = work.condition
    space = work.space
    for i in range(kind.size):
        a = place[0, i]
        k = place[1, i]
        d = space[:k]
        v = space[k : 2 * k]
        F = space[2 * k : 3 * k]
        rest = space[3 * k :]
        for j in range(k):
            d[j] = local[a + j, 0]
            v[j] = rate * local[a + j, 1]
        forces[kind[i]](
            parameters[parameters_first[i] : parameters_first[i + 1]],
            condition[state_first[i] : state_first[i + 1]],
            d,
            v,
            F,
            rest[: k * k],
            rest[k * k : 2 * k * k],
            rest[2 * k * k : 2 * k * k + 4],
        )
        for j in range(k):
            local[a + j, 2] = F[j] / (rate * rate)


@compiled(inner=True)
def slopes(system, columns, now, laws, work, y, a):
    """z'' (n,) of a state y = (z, z') with the tables (m, 4) of now; fills work.local."""
    K = system.K
    D = system.D
    B = system.B
    load = system.load
    kind = columns.kind
    mode = columns.mode
    values = columns.values
    local = work.local
    n = K.shape[0]
    m = B.shape[1]
    z = y[:n]
    dz = y[n:]
    for j in range(m):
        d = 0.0
        v = 0.0
        for i in range(n):
            d += B[i, j] * z[i]
            v += B[i, j] * dz[i]
        local[j, 0] = d
        local[j, 1] = v
        if kind[j] != OWN_LAW:
            local[j, 2], local[j, 3] = force(kind[j], mode[j], values[j], now[j], d, v)
    own_forces(laws, work)
    for i in range(n):
        total = load[i]
        for k in range(n):
            total -= K[i, k] * z[k] + D[i, k] * dz[k]
        for j in range(m):
            total -= B[i, j] * local[j, 2]
        a[i] = total


@compiled(free=True)
def trajectory(span, system, columns, table, laws, state, out):
    """Run on from a state (2 n,) in place; out (s, m, 3) gets d, d' and F once in `every` steps, beginning with the first state.

    table: (2 steps in a common period + 1, m, 4).
    """
    steps = span.steps
    every = span.every
    begun = span.begun
    B = system.B
    jumps = columns.jumps
    values = columns.values
    n = B.shape[0]
    h = 2.0 * np.pi / steps
    period = (table.shape[0] - 1) // 2
    m = B.shape[1]
    y = np.empty(2 * n)
    total = np.empty(2 * n)
    a = np.empty(n)
    local = np.zeros((m, 4))
    used = np.empty(m)
    edge = np.empty((m, 2))
    condition = np.zeros(laws.state_first[-1])
    work = PathWork(local, condition, np.zeros(SPACE))
    for step in range(out.shape[0] * every):
        for i in range(2 * n):
            y[i] = state[i]
        total[:] = 0.0
        used[:] = 0.0
        for stage in range(4):
            half = (stage + 1) // 2
            if stage != 2:
                own_schedules(laws, 0.5 * h * (2.0 * (begun + step) + half), condition)
            now = table[2 * (step % period) + half]
            slopes(system, columns, now, laws, work, y, a)
            if stage == 0 and step % every == 0:
                for j in range(m):
                    for i in range(3):
                        out[step // every, j, i] = local[j, i]
            weight = (1.0 if stage in (0, 3) else 2.0) * h / 6.0
            for j in range(m):
                used[j] += weight * local[j, 3]
                if stage == 0 and jumps[j]:
                    begin = momentum(
                        values[j, CLEARANCE], values[j, DEPTH], values[j, PER_DEPTH], local[j, 0] - now[j, ERROR]
                    )
                    edge[j, 0] = begin.integral
                    edge[j, 1] = begin.side
            share = h if stage == 2 else 0.5 * h
            for i in range(n):
                total[i] += weight * y[n + i]
                total[n + i] += weight * a[i]
                y[i] = state[i] + share * y[n + i]
            for i in range(n):
                y[n + i] = state[n + i] + share * a[i]
        for i in range(2 * n):
            state[i] += total[i]
        for j in range(m):
            if jumps[j]:
                d = 0.0
                for i in range(n):
                    d += B[i, j] * state[i]
                end = momentum(values[j, CLEARANCE], values[j, DEPTH], values[j, PER_DEPTH], d - now[j, ERROR])
                if jumps[j] == ALWAYS or (end.side != 0.0 and end.side != edge[j, 1]):
                    rest = values[j, C] * (end.integral - edge[j, 0]) - used[j]
                    for i in range(n):
                        state[n + i] -= B[i, j] * rest
