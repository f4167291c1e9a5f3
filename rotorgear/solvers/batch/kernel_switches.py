"""Compiled: tangents of a batch where a contact opens or closes within a step.

The tangent stiffness of a contact jumps there, and so does its damper. What the stages of the Runge-Kutta method make of that
depends on where they happen to fall: exponents are then good to the first order in the step only. With the share theta of the
step at which the contact switches, the impulses along a tangent tau = B^T T follow from the ends of the step. Over its part in
contact, a < s < b, with time t = s h,

    velocity       int k tau dt                     displacement       int (h - t) k tau dt
                   int d(c tau)                                        int (h - t) d(c tau)

where c tau jumps as sides meet, and as a damper that may pull lets go; a clamped one lets go where the force has come to zero,
and does not jump. tau and the approach x are cubics through both ends. What the stages did is taken off again.
Leine and Nijmeijer, Dynamics and Bifurcations of Non-Smooth Mechanical Systems (Springer 2004), ch. 7.
"""

from __future__ import annotations

from rotorgear.solvers.batch.columns import CLEARANCE, ERROR, OWN_LAW, PER_DEPTH, PRESCRIBED, SLOPE, STIFFNESS, C, K
from rotorgear.solvers.batch.kernel_parts import GROWTH, IN_D, IN_V, of
from rotorgear.solvers.batch.kernel_sisters import turn_rows
from rotorgear.solvers.contact.kinds import ADHESIVE, BILATERAL, PENETRATION
from rotorgear.solvers.contact.vectors import BATCH, get, put, work
from rotorgear.solvers.time.compiled import compiled

# Of each column at the begin of a step: approach, its rate, whether it holds (0 or 1), shares of its stiffness there and in the
# middle.
X, RATE, HOLDS, BEGIN, MIDDLE = range(5)
STEP_BEGIN = 5
# Of each tangent and column: tau and its rate at the begin; velocity and displacement by the spring, and by the damper.
TAU, TAU_RATE, BY_K, FAR_BY_K, BY_C, FAR_BY_C = range(6)
DONE = 6
_BISECTIONS = 40
# Gauss points and weights on 0 ... 1: exact for the cubics times the stiffness.
_POINTS = (0.1127016653792583, 0.5, 0.8872983346207417)
_WEIGHTS = (0.2777777777777778, 0.4444444444444444, 0.2777777777777778)


@compiled(inner=True)
def tangent_jumps(kind, mode):
    """Whether a column of this kind and mode has a tangent that jumps."""
    return kind not in (BILATERAL, PRESCRIBED, OWN_LAW) and mode != PENETRATION


@compiled(fast=True, inner=True)
def keep_begin(columns, table, d, found, step_begin):
    """Keep the begin of a step: d (2 m, w), found (m, 4, w) and table (m, 4, w) of its first stage; step_begin (m, 5, w)."""
    for j in range(columns.kind.size):
        if not tangent_jumps(columns.kind[j], columns.mode[j]):
            continue
        for w in range(BATCH):
            step_begin[j, X, w] = d[2 * j, w] - table[j, ERROR, w]
            step_begin[j, RATE, w] = d[2 * j + 1, w] - table[j, SLOPE, w]
            step_begin[j, HOLDS, w] = 1.0 if found[j, IN_D, w] - found[j, GROWTH, w] > 0.0 else 0.0
            step_begin[j, BEGIN, w] = table[j, STIFFNESS, w]


@compiled(fast=True, inner=True)
def add_contacts(number, h, columns, found, d, done, at):
    """Add what a stage's contacts do along a tangent with d (2 m, w) to rows of done from `at` on, DONE a column."""
    weight = (h / 6.0) if number in (0, 3) else (h / 3.0)
    far = 0.0 if number == 3 else h * h / 6.0
    for j in range(columns.kind.size):
        if not tangent_jumps(columns.kind[j], columns.mode[j]):
            continue
        row = at + DONE * j
        tau = get(d, 2 * j)
        rate = get(d, 2 * j + 1)
        growth = of(found, j, GROWTH) * tau
        spring = of(found, j, IN_D) * tau - growth
        damper = of(found, j, IN_V) * rate + growth
        if number == 0:
            put(done, row + TAU, tau)
            put(done, row + TAU_RATE, rate)
            put(done, row + BY_K, weight * spring)
            put(done, row + FAR_BY_K, far * spring)
            put(done, row + BY_C, weight * damper)
            put(done, row + FAR_BY_C, far * damper)
        else:
            put(done, row + BY_K, get(done, row + BY_K) + weight * spring)
            put(done, row + FAR_BY_K, get(done, row + FAR_BY_K) + far * spring)
            put(done, row + BY_C, get(done, row + BY_C) + weight * damper)
            put(done, row + FAR_BY_C, get(done, row + FAR_BY_C) + far * damper)


@compiled(inner=True)
def cubic(s, a, b, rate_a, rate_b):
    """Value at the share s of a step, of the cubic with values and rates (a step) at both ends."""
    u = 1.0 - s
    return u * u * ((1.0 + 2.0 * s) * a + s * rate_a) + s * s * ((3.0 - 2.0 * s) * b - u * rate_b)


@compiled(inner=True)
def slope_of_cubic(s, a, b, rate_a, rate_b):
    """Its slope over s."""
    u = 1.0 - s
    return 6.0 * s * u * (b - a) + u * (1.0 - 3.0 * s) * rate_a + s * (3.0 * s - 2.0) * rate_b


@compiled(inner=True)
def depth_of(x, clearance):
    """Penetration of the side that touches."""
    return max(x, -x - clearance, 0.0)


@compiled(inner=True)
def holds_at(x, rate, k, c, clearance, per_depth, clamped):
    """Whether a contact pushes at an approach and its rate."""
    depth = depth_of(x, clearance)
    if depth <= 0.0:
        return False
    closing = rate if x > 0.0 else -rate
    return not clamped or k * depth + c * min(depth * per_depth, 1.0) * closing > 0.0


@compiled(inner=True)
def switch_at(h, x0, rate0, x1, rate1, k, c, clearance, per_depth, clamped):
    """Share of a step at which a contact begins or ceases to hold."""
    low = 0.0
    high = 1.0
    before = holds_at(x0, rate0, k, c, clearance, per_depth, clamped)
    for _ in range(_BISECTIONS):
        s = 0.5 * (low + high)
        x = cubic(s, x0, x1, h * rate0, h * rate1)
        rate = slope_of_cubic(s, x0, x1, h * rate0, h * rate1) / h
        if holds_at(x, rate, k, c, clearance, per_depth, clamped) == before:
            low = s
        else:
            high = s
    return 0.5 * (low + high)


@compiled(fast=True, inner=True)
def keep_end(columns, table, d, step_begin, ends):
    """Whether any column of any system has switched in a step that ends with d (2 m, w); ends (m, 4, w) are filled.

    They are the approach, its rate, what holding has changed by (-1, 0, 1), and the share of the stiffness.
    """
    values = columns.values
    changed = 0.0
    for j in range(columns.kind.size):
        if not tangent_jumps(columns.kind[j], columns.mode[j]):
            continue
        clamped = columns.mode[j] != ADHESIVE
        for w in range(BATCH):
            x = d[2 * j, w] - table[j, ERROR, w]
            rate = d[2 * j + 1, w] - table[j, SLOPE, w]
            k = values[j, K, w] * table[j, STIFFNESS, w]
            now = holds_at(x, rate, k, values[j, C, w], values[j, CLEARANCE, w], values[j, PER_DEPTH, w], clamped)
            change = (1.0 if now else 0.0) - step_begin[j, HOLDS, w]
            ends[j, 0, w] = x
            ends[j, 1, w] = rate
            ends[j, 2, w] = change
            ends[j, 3, w] = table[j, STIFFNESS, w]
            changed += abs(change)
    return changed > 0.0


@compiled(inner=True)
def correct(h, time, columns, sisters, step_begin, ends, per_force, d, done, tangents, ahead, at):
    """Put one tangent right: its d (2 m, w) at the end, done from row `at` on; its state (2 n, w) and that of the stage to come.

    per_force: -B by rows. sisters: planets that go round, whose impulses act where the pins were at the start.
    """
    n = tangents.shape[0] // 2
    if sisters is not None:
        moves = work(columns.kind.size)
        pushes = work(columns.kind.size)
    values = columns.values
    for j in range(columns.kind.size):
        if not tangent_jumps(columns.kind[j], columns.mode[j]):
            continue
        clamped = columns.mode[j] != ADHESIVE
        row = at + DONE * j
        for w in range(BATCH):
            change = ends[j, 2, w]
            if change == 0.0:
                continue
            k = values[j, K, w]
            c = values[j, C, w]
            clearance = values[j, CLEARANCE, w]
            per_depth = values[j, PER_DEPTH, w]
            x0 = step_begin[j, X, w]
            rate0 = h * step_begin[j, RATE, w]
            x1 = ends[j, 0, w]
            rate1 = h * ends[j, 1, w]
            k0 = k * step_begin[j, BEGIN, w]
            km = k * step_begin[j, MIDDLE, w]
            k1 = k * ends[j, 3, w]
            theta = switch_at(h, x0, rate0 / h, x1, rate1 / h, km, c, clearance, per_depth, clamped)
            closes = change > 0.0
            a = theta if closes else 0.0
            b = 1.0 if closes else theta
            tau0 = done[row + TAU, w]
            tau1 = d[2 * j, w]
            slope0 = h * done[row + TAU_RATE, w]
            slope1 = h * d[2 * j + 1, w]
            by_k = 0.0
            far_by_k = 0.0
            held = 0.0
            for g in range(3):
                s = a + (b - a) * _POINTS[g]
                weight = (b - a) * _WEIGHTS[g]
                tau = cubic(s, tau0, tau1, slope0, slope1)
                stiffness = (1.0 - s) * (1.0 - 2.0 * s) * k0 + 4.0 * s * (1.0 - s) * km + s * (2.0 * s - 1.0) * k1
                by_k += weight * stiffness * tau
                far_by_k += weight * (1.0 - s) * stiffness * tau
                held += weight * min(depth_of(cubic(s, x0, x1, rate0, rate1), clearance) * per_depth, 1.0) * tau
            velocity = h * by_k - done[row + BY_K, w]
            displacement = h * h * far_by_k - done[row + FAR_BY_K, w]
            share0 = min(depth_of(x0, clearance) * per_depth, 1.0)
            far_by_c = h * held
            if not closes:
                far_by_c -= h * share0 * tau0
            jumps = depth_of(x0, clearance) <= 0.0 if closes else not clamped
            if not jumps:
                there = cubic(theta, tau0, tau1, slope0, slope1)
                there *= min(depth_of(cubic(theta, x0, x1, rate0, rate1), clearance) * per_depth, 1.0)
                if closes:
                    by_c = min(depth_of(x1, clearance) * per_depth, 1.0) * tau1 - there
                    far_by_c -= (1.0 - theta) * h * there
                else:
                    by_c = there - share0 * tau0
                    far_by_c += (1.0 - theta) * h * there
                velocity += c * by_c - done[row + BY_C, w]
            displacement += c * far_by_c - done[row + FAR_BY_C, w]
            if sisters is not None:
                moves[j, w] = displacement
                pushes[j, w] = velocity
                continue
            for i in range(n):
                for p in range(per_force.first[i], per_force.first[i + 1]):
                    if per_force.column[p] == j:
                        moved = tangents[i, w] + per_force.value[p, w] * displacement
                        tangents[i, w] = moved
                        ahead[i, w] = moved
                        moved = tangents[n + i, w] + per_force.value[p, w] * velocity
                        tangents[n + i, w] = moved
                        ahead[n + i, w] = moved
    if sisters is not None:
        turn_rows(sisters, -time, moves, 0, 1)
        turn_rows(sisters, -time, pushes, 0, 1)
        for i in range(n):
            moved = get(tangents, i)
            pushed = get(tangents, n + i)
            for p in range(per_force.first[i], per_force.first[i + 1]):
                moved += get(per_force.value, p) * get(moves, per_force.column[p])
                pushed += get(per_force.value, p) * get(pushes, per_force.column[p])
            put(tangents, i, moved)
            put(ahead, i, moved)
            put(tangents, n + i, pushed)
            put(ahead, n + i, pushed)
