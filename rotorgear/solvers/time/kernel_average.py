"""Compiled: average acceleration in the mean over a step, with local forces that do the work of their potential.

    q1 = q + h v + h^2/2 a         v1 = v + h a
    M a + D (v + v1)/2 + K (q + q1)/2 + B F = f         S a = rhs - B F,   S = M + h/2 D + h^2/4 K

F is the force of the whole step (kernel_middle.py). For linear systems this is Newmark's method with beta 1/4 and gamma 1/2.
Without damping and prescribed motion, v M v/2 + q K q/2 + V stays what it was: the equations times (q1 - q) = h (v + v1)/2.
Simo and Tarnow, ZAMP 43 (1992) 757.
"""

from __future__ import annotations

import numpy as np

from rotorgear.solvers.time.compiled import compiled
from rotorgear.solvers.time.kernel_contact import (
    blank_answer,
    contact_step,
    contact_work,
    force_all,
    force_conserving,
    schedule_all,
)
from rotorgear.solvers.time.kernel_gather import add_rows, gather, record_whole, take_energies, take_events
from rotorgear.solvers.time.kernel_time import lu_solve, rotation_at, subtract_products


@compiled
def average_loop(span, weights, turning, structure, step, laws, motion, carried, tolerance, kept):
    """Advance `motion` and `carried` in place over a span and record; returns steps done, status and linear solutions.

    `weights` are those of the general loop. Accelerations and channels at a step's end go on from the means of two steps.
    """
    h = span.h
    q = motion.q
    v = motion.v
    a = motion.a
    F = carried.F
    before = carried.before
    begin = carried.d
    load = structure.load
    Bt = step.Bt
    gathered = carried.gathered
    watched = step.Wt.first.size - 1
    observing = step.observing
    P = step.P
    n = q.size
    m = F.size
    work = contact_work(laws, m)
    at_end = blank_answer(laws, m)
    qm = np.empty(n)
    vm = np.empty(n)
    rhs = np.empty(n)
    permuted = np.empty(n)
    a_free = np.empty(n)
    a_end = np.empty(n)
    F_end = np.empty(m)
    seen = np.zeros(gathered.level.size)
    solutions = 0
    for number in range(1, span.steps + 1):
        t = (span.begun + number) * h
        angle, speed = rotation_at(t - 0.5 * h, turning)
        schedule_all(laws, angle, speed, t - 0.5 * h, work.state)
        for i in range(n):
            qm[i] = q[i] + 0.5 * h * v[i]
            vm[i] = v[i]
            rhs[i] = load[i]
        subtract_products(structure, qm, vm, rhs)
        lu_solve(step.S, rhs, permuted, a_free)
        for j in range(m):
            x = 0.0
            y = 0.0
            for p in range(Bt.first[j], Bt.first[j + 1]):
                i = Bt.column[p]
                x += Bt.value[p] * (q[i] + h * v[i] + 0.5 * h * h * a_free[i])
                y += Bt.value[p] * (v[i] + h * a_free[i])
            work.d_free[j] = x
            work.v_free[j] = y
            work.begin[j] = begin[j]
            F[j], before[j] = 2.0 * F[j] - before[j], F[j]  # a guess that goes on as before
        force_conserving(laws, work.state, work.begin, work.rest, work.begun)
        code = contact_step(laws, step.compliance, work, F, tolerance, h)
        if code < 0:
            return number - 1, code, solutions
        solutions += code
        for i in range(n):
            total = a_free[i]
            for j in range(m):
                total -= P[i, j] * F[j]
            q[i] += h * v[i] + 0.5 * h * h * total
            v[i] += h * total
            a_end[i] = 1.5 * total - 0.5 * a[i]
            a[i] = total
        take_energies(work.answer.energy, h, carried)
        take_events(work.answer.energy, carried)
        for j in range(m):
            begin[j] = work.d[j]
            F_end[j] = 1.5 * F[j] - 0.5 * before[j]
            seen[j] = F[j]
            seen[m + j] = work.d[j]
        seen[2 * m :] = 0.0
        add_rows(step.Wt, q, seen, 2 * m)
        add_rows(observing.q, q, seen, 2 * m + watched)
        add_rows(observing.v, v, seen, 2 * m + watched)
        add_rows(observing.a, a_end, seen, 2 * m + watched)
        add_rows(observing.F, F_end, seen, 2 * m + watched)
        gather(gathered, seen, m, True)
        if number % span.every == 0:
            r = number // span.every - 1
            kept.q[r] = q
            kept.v[r] = v
            kept.a[r] = a_end
            angle, speed = rotation_at(t, turning)
            schedule_all(laws, angle, speed, t, work.state)
            work.v[:] = 0.0
            add_rows(Bt, v, work.v, 0)
            force_all(laws, work.state, work.d, work.v, at_end)
            record_whole(r, at_end, work, carried, kept)
    return span.steps, 0, solutions
