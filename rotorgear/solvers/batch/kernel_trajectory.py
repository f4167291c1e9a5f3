"""Compiled: one small system step by step through the method and the forces of kernel.py, recording as it goes.

It is for few systems and a short time, so it has no batch and no tangents; a test compares its steps with those of a batch.
"""

from __future__ import annotations

import numpy as np

from rotorgear.solvers.batch.columns import (
    ALWAYS,
    CLEARANCE,
    DEPTH,
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
from rotorgear.solvers.batch.kernel_laws import SPACE, force_laws, schedule_laws
from rotorgear.solvers.batch.kernel_parts import FOUND
from rotorgear.solvers.contact.gap_contact import contact, momentum
from rotorgear.solvers.time.compiled import compiled
from rotorgear.solvers.time.kernel_sisters import add_going_round, turn


@compiled(inner=True)
def force(kind, mode, values, now, d, v):
    """Force of one column, and the share of its damping that can jump.

    values (6,) of the column; now (4,) of its table; see `contacts`.
    """
    push = values[FORCE] * now[FORCE_SHARE]
    if kind == PRESCRIBED:
        return push, 0.0
    k = values[K] * now[STIFFNESS]
    rate = v - now[SLOPE]
    found = contact(kind, mode, k, values[C], values[CLEARANCE], values[PER_DEPTH], d - now[ERROR], rate)
    return found.force + push, found.damping * rate


@compiled(inner=True)
def edge(values, now, d):
    """Integral of the share of a column's damping up to a displacement, and the side that touches; see kernel_jumps.py."""
    found = momentum(values[CLEARANCE], values[DEPTH], values[PER_DEPTH], d - now[ERROR])
    return found.integral, found.side


@compiled(free=True)
def trajectory(steps, every, begun, system, columns, table, acting, sisters, state, out):
    """Run on from a state (2 n,) in place; out (s, m, 3) gets d, d' and F once in `every` steps, beginning with the first state.

    system: K and D (n, n), B (n, m) and the constant load (n,). steps: in a period of the fastest excitation, begun: before the
    first one. table: (2 steps in a common period + 1, m, 4). sisters: as of `batch_loop`.
    """
    kind = columns.kind
    mode = columns.mode
    jumps = columns.jumps
    values = columns.values
    stiffness, D, B, load = system
    laws = acting.laws
    n, m = B.shape
    h = 2.0 * np.pi / steps
    period = (table.shape[0] - 1) // 2
    y = np.empty(2 * n)
    total = np.empty(2 * n)
    a = np.empty(n)
    d = np.zeros((2 * m, 1))
    F = np.zeros((m, 1))
    damped = np.zeros(m)
    used = np.empty(m)
    begins = np.empty((m, 2))
    # Displacements and velocities that laws see, and forces and impulses as the structure feels them.
    seen = np.empty(m)
    rates = np.empty(m)
    felt = np.empty(m)
    # A batch of one system for the laws of kernel_laws.py.
    condition = np.zeros((1, laws.state_first[-1]))
    found = np.zeros((m, FOUND, 1))
    tangents = np.zeros((2, laws.block_first[-1], 1))
    space = np.zeros(SPACE)
    for step in range(out.shape[0] * every):
        for i in range(2 * n):
            y[i] = state[i]
        total[:] = 0.0
        used[:] = 0.0
        for stage in range(4):
            half = (stage + 1) // 2
            if stage != 2:
                schedule_laws(acting, 0.5 * h * (2.0 * (begun + step) + half), condition)
            now = table[2 * (step % period) + half]
            for j in range(m):
                x = 0.0
                rate = 0.0
                for i in range(n):
                    x += B[i, j] * y[i]
                    rate += B[i, j] * y[n + i]
                seen[j] = x
                rates[j] = rate
            if sisters is not None:
                time = 0.5 * h * (2.0 * (begun + step) + half)
                add_going_round(sisters, 1.0, seen, rates)
                turn(sisters, time, seen, 0)
                turn(sisters, time, rates, 0)
            for j in range(m):
                d[2 * j, 0] = seen[j]
                d[2 * j + 1, 0] = rates[j]
                if kind[j] != OWN_LAW:
                    F[j, 0], damped[j] = force(kind[j], mode[j], values[j], now[j], seen[j], rates[j])
            force_laws(acting, condition, d, F, found, tangents, space)
            for j in range(m):
                felt[j] = F[j, 0]
            if sisters is not None:
                turn(sisters, -time, felt, 0)
            for i in range(n):
                z2 = load[i]
                for k in range(n):
                    z2 -= stiffness[i, k] * y[k] + D[i, k] * y[n + k]
                for j in range(m):
                    z2 -= B[i, j] * felt[j]
                a[i] = z2
            if stage == 0 and step % every == 0:
                for j in range(m):
                    out[step // every, j, 0] = d[2 * j, 0]
                    out[step // every, j, 1] = d[2 * j + 1, 0]
                    out[step // every, j, 2] = F[j, 0]
            weight = (1.0 if stage in (0, 3) else 2.0) * h / 6.0
            for j in range(m):
                used[j] += weight * damped[j]
                if stage == 0 and jumps[j]:
                    begins[j, 0], begins[j, 1] = edge(values[j], now[j], d[2 * j, 0])
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
            felt[j] = 0.0
            seen[j] = 0.0
            for i in range(n):
                seen[j] += B[i, j] * state[i]
        if sisters is not None:
            turn(sisters, time, seen, 0)
        for j in range(m):
            if jumps[j]:
                integral, side = edge(values[j], now[j], seen[j])
                if jumps[j] == ALWAYS or (side != 0.0 and side != begins[j, 1]):
                    felt[j] = values[j, C] * (integral - begins[j, 0]) - used[j]
        if sisters is not None:
            turn(sisters, -time, felt, 0)
        for j in range(m):
            if felt[j] != 0.0:
                for i in range(n):
                    state[n + i] -= B[i, j] * felt[j]
