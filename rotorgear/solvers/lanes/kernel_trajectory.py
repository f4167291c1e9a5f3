"""Compiled: one small system step by step through the method and the forces of kernel_lanes.py, recording as it goes.

It serves few systems for a short time, so it has no lanes and no tangents; that it goes the same way is tested.
"""

from __future__ import annotations

import numpy as np

from rotorgear.solvers.contact.kinds import ADHESIVE, BILATERAL, PENETRATION
from rotorgear.solvers.lanes.columns import ALWAYS, ERROR, OWN_LAW, PRESCRIBED, PUSH, SLOPE, STIFFNESS
from rotorgear.solvers.lanes.kernel_laws import SPACE
from rotorgear.solvers.time.compiled import compiled


@compiled
def force(gap, mode, values, now, d, v):
    """Force of one column, and the share of its damping that can jump.

    values (5,): k, c, backlash, 1/ramp, prescribed force; now (4,) of its table; see `contacts`.
    """
    push = values[4] * now[PUSH]
    if gap == PRESCRIBED:
        return push, 0.0
    k = values[0] * now[STIFFNESS]
    c = values[1]
    x = d - now[ERROR]
    rate = v - now[SLOPE]
    if gap == BILATERAL:
        return k * x + c * rate + push, 0.0
    behind = -x - values[2]
    depth, touch = (x, 1.0) if x > 0.0 else ((behind, -1.0) if behind > 0.0 else (0.0, 0.0))
    share = depth * values[3]
    if mode != PENETRATION:
        share = min(share, 1.0)
    total = k * depth + c * share * touch * rate
    if total <= 0.0 and mode != ADHESIVE:
        return push, 0.0
    return touch * total + push, c * share * rate


@compiled
def momentum(values, now, d):
    """Integral of the damping's share over the approach d - e, and the flank that touches; see `edges`."""
    x = d - now[ERROR]
    behind = -x - values[2]
    depth, touch = (x, 1.0) if x > 0.0 else ((behind, -1.0) if behind > 0.0 else (0.0, 0.0))
    share = min(depth * values[3], 1.0)
    return touch * share * (depth - 0.5 * share / values[3]), touch


@compiled
def own_schedules(laws, clock, time, condition):
    """Fill the state (s,) of the laws at a time in radians of the fastest mesh."""
    schedules, _, kind, _, parameters, parameters_first, state_first, _ = laws
    for i in range(kind.size):
        schedules[kind[i]](
            time * clock[0],
            clock[1] * clock[0],
            time / clock[1],
            parameters[parameters_first[i] : parameters_first[i + 1]],
            condition[state_first[i] : state_first[i + 1]],
        )


@compiled
def own_forces(laws, clock, condition, space, local):
    """Forces of the laws of kernel_lane_laws.py to local (m, 3), one system.

    clock (2,): radians of the reference for one of the fastest mesh, and its rad/s; space: SPACE numbers.
    """
    _, forces, kind, place, parameters, parameters_first, state_first, _ = laws
    rate = clock[1]
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


@compiled
def slopes(K, D, B, load, gap, mode, values, now, laws, clock, condition, space, y, local, a):
    """z'' (n,) of a state y = (z, z'), and d, d', F and its damping of each column, local (m, 4).

    laws, clock, condition, space: of the columns that act by laws of their own, see `own_forces`.
    """
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
        if gap[j] != OWN_LAW:
            local[j, 2], local[j, 3] = force(gap[j], mode[j], values[j], now[j], d, v)
    own_forces(laws, clock, condition, space, local)
    for i in range(n):
        total = load[i]
        for k in range(n):
            total -= K[i, k] * z[k] + D[i, k] * dz[k]
        for j in range(m):
            total -= B[i, j] * local[j, 2]
        a[i] = total


@compiled(free=True)
def trajectory(steps, every, begun, K, D, B, load, gap, mode, jumps, values, table, laws, clock, state, out):
    """Run on from a state (2 n,) in place; out (s, m, 3) gets d, d' and F once in `every` steps, beginning with the first state.

    Args:
        steps: in a period of the fastest mesh; begun: steps before. jumps, values: (m,), (m, 5).
        table: (2 steps in a common period + 1, m, 4). laws, clock: see `own_forces`.
    """
    n = K.shape[0]
    h = 2.0 * np.pi / steps
    period = (table.shape[0] - 1) // 2
    m = B.shape[1]
    y = np.empty(2 * n)
    total = np.empty(2 * n)
    a = np.empty(n)
    local = np.zeros((m, 4))
    used = np.empty(m)
    edge = np.empty((m, 2))
    condition = np.zeros(laws[6][-1])
    space = np.zeros(SPACE)
    for step in range(out.shape[0] * every):
        y[:] = state
        total[:] = 0.0
        used[:] = 0.0
        for stage in range(4):
            half = (stage + 1) // 2
            if stage != 2:
                own_schedules(laws, clock, 0.5 * h * (2.0 * (begun + step) + half), condition)
            now = table[2 * (step % period) + half]
            slopes(K, D, B, load, gap, mode, values, now, laws, clock, condition, space, y, local, a)
            if stage == 0 and step % every == 0:
                out[step // every] = local[:, :3]
            weight = (1.0 if stage in (0, 3) else 2.0) * h / 6.0
            for j in range(m):
                used[j] += weight * local[j, 3]
                if stage == 0 and jumps[j]:
                    edge[j] = momentum(values[j], now[j], local[j, 0])
            share = h if stage == 2 else 0.5 * h
            for i in range(n):
                total[i] += weight * y[n + i]
                total[n + i] += weight * a[i]
                y[i] = state[i] + share * y[n + i]
            for i in range(n):
                y[n + i] = state[n + i] + share * a[i]
        state += total
        for j in range(m):
            if jumps[j]:
                d = 0.0
                for i in range(n):
                    d += B[i, j] * state[i]
                gamma, touch = momentum(values[j], now[j], d)
                if jumps[j] == ALWAYS or (touch != 0.0 and touch != edge[j, 1]):
                    rest = values[j, 1] * (gamma - edge[j, 0]) - used[j]
                    for i in range(n):
                        state[n + i] -= B[i, j] * rest
