"""Compiled: the loops of the generalised-alpha family, with one constant factorisation and condensed contact.

    q1 = q + h v + h^2 (1/2 - beta) a + beta h^2 a1         v1 = v + h (1 - gamma) a + gamma h a1
    M [(1-am) a1 + am a] + D [(1-af) v1 + af v] + K [(1-af) q1 + af q] + B [(1-af) F1 + af F] = f
    S a1 = rhs - (1-af) B F1,   S = (1-am) M + (1-af) gamma h D + (1-af) beta h^2 K

am = af = 0 is Newmark's method, am = 0 Hilber, Hughes and Taylor's. F1 acts through the m columns P = S^-1 B only, so that
Newton's method runs on m x m systems. Chung and Hulbert, J. Applied Mechanics 60 (1993) 371.

Average acceleration (beta 1/4, gamma 1/2) holds in the mean over a step, with local forces that do the work of their potential:

    q1 = q + h v + h^2/2 a         v1 = v + h a
    M a + D (v + v1)/2 + K (q + q1)/2 + B F = f         S a = rhs - B F,   S = M + h/2 D + h^2/4 K

F is the force of the whole step (kernel_contact.py). For linear systems this is Newmark's method. Without damping and prescribed
motion, v M v/2 + q K q/2 + V stays what it was: the equations times (q1 - q) = h (v + v1)/2. Simo and Tarnow, ZAMP 43 (1992) 757.
"""

from __future__ import annotations

import numpy as np

from rotorgear.solvers.time.compiled import compiled
from rotorgear.solvers.time.kernel_contact import (
    blank_answer,
    contact_step,
    contact_work,
    force_all,
    schedule_all,
)
from rotorgear.solvers.time.kernel_time import (
    add_rows,
    gather,
    inertia_products,
    lu_solve,
    record_forces,
    record_whole,
    rotation_at,
    subtract_products,
    take_account,
    take_energies,
    take_events,
)


@compiled(entry=False)
def observe(step, F, d, q, v, a, F_end, seen):
    """Fill what statistics are gathered of: local forces, displacements, watched ones, and channels at the step's end."""
    m = F.size
    for j in range(m):
        seen[j] = F[j]
        seen[m + j] = d[j]
    seen[2 * m :] = 0.0
    add_rows(step.Wt, q, seen, 2 * m)
    channels = 2 * m + step.Wt.first.size - 1
    add_rows(step.observing.q, q, seen, channels)
    add_rows(step.observing.v, v, seen, channels)
    add_rows(step.observing.a, a, seen, channels)
    add_rows(step.observing.F, F_end, seen, channels)


@compiled
def newmark_loop(span, weights, turning, structure, step, laws, motion, carried, tolerance, kept):
    """Advance `motion` and `carried` in place over a span and record; returns steps done, status and linear solutions."""
    h = span.h
    am = weights.am
    af = weights.af
    beta = weights.beta
    gamma = weights.gamma
    q = motion.q
    v = motion.v
    a = motion.a
    F = carried.F
    before = carried.before
    load = structure.load
    Bt_first = step.Bt.first
    Bt_column = step.Bt.column
    Bt_value = step.Bt.value
    gathered = carried.gathered
    factors = step.S
    compliance = step.compliance
    P = step.P
    n = q.size
    m = F.size
    work = contact_work(laws, m)
    state = work.state
    d_free = work.d_free
    v_free = work.v_free
    energy = work.answer.energy
    Ma = np.zeros(n)
    qm = np.empty(n)
    vm = np.empty(n)
    rhs = np.empty(n)
    permuted = np.empty(n)
    a_free = np.empty(n)
    seen = np.zeros(gathered.level.size)
    solutions = 0
    for number in range(1, span.steps + 1):
        t = (span.begun + number) * h
        angle, speed = rotation_at(t, turning)
        schedule_all(laws, angle, speed, t, state)
        old = h * h * (0.5 - beta)
        new = h * (1.0 - gamma)
        for i in range(n):
            qp = q[i] + h * v[i] + old * a[i]
            vp = v[i] + new * a[i]
            qm[i] = (1.0 - af) * qp + af * q[i]
            vm[i] = (1.0 - af) * vp + af * v[i]
            rhs[i] = load[i]
            q[i] = qp
            v[i] = vp
        subtract_products(structure, qm, vm, rhs)
        if am != 0.0:
            inertia_products(structure, a, Ma)
            for i in range(n):
                rhs[i] -= am * Ma[i]
        if af != 0.0:
            for j in range(m):
                for p in range(Bt_first[j], Bt_first[j + 1]):
                    rhs[Bt_column[p]] -= af * Bt_value[p] * F[j]
        lu_solve(factors, rhs, permuted, a_free)
        for j in range(m):
            x = 0.0
            y = 0.0
            for p in range(Bt_first[j], Bt_first[j + 1]):
                i = Bt_column[p]
                x += Bt_value[p] * (q[i] + beta * h * h * a_free[i])
                y += Bt_value[p] * (v[i] + gamma * h * a_free[i])
            d_free[j] = x
            v_free[j] = y
            F[j], before[j] = 2.0 * F[j] - before[j], F[j]  # a guess that goes on as before
        code = contact_step(laws, compliance, work, F, tolerance, 0.0)
        if code < 0:
            return number - 1, code, solutions
        solutions += code
        for i in range(n):
            total = a_free[i]
            for j in range(m):
                total -= (1.0 - af) * P[i, j] * F[j]
            a[i] = total
            q[i] += beta * h * h * total
            v[i] += gamma * h * total
        take_account(energy, h, carried)
        for j in range(m):
            carried.d[j] = work.d[j]
        observe(step, F, work.d, q, v, a, F, seen)
        gather(gathered, seen, m, False)
        if number % span.every == 0:
            r = number // span.every - 1
            kept.q[r] = q
            kept.v[r] = v
            kept.a[r] = a
            record_forces(r, h, work, carried, kept)
    return span.steps, 0, solutions


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
        force_all(laws, work.state, work.begin, work.zeros, work.begun, True)
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
        observe(step, F, work.d, q, v, a_end, F_end, seen)
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
