"""Compiled: the loop of the generalised-alpha family, with one constant factorisation and condensed contact.

    q1 = q + h v + h^2 (1/2 - beta) a + beta h^2 a1         v1 = v + h (1 - gamma) a + gamma h a1
    M [(1-am) a1 + am a] + D [(1-af) v1 + af v] + K [(1-af) q1 + af q] + B [(1-af) F1 + af F] = f
    S a1 = rhs - (1-af) B F1,   S = (1-am) M + (1-af) gamma h D + (1-af) beta h^2 K

am = af = 0 is Newmark's method, am = 0 Hilber, Hughes and Taylor's. F1 acts through the m columns P = (1-af) S^-1 B only, so that
Newton's method runs on m x m systems. Chung and Hulbert, J. Applied Mechanics 60 (1993) 371.

Average acceleration (beta 1/4, gamma 1/2) holds in the mean over a step, with local forces that do the work of their potential:

    q1 = q + h v + h^2/2 a         v1 = v + h a         (beta 1/2, gamma 1 on the mean a)
    M a + D (v + v1)/2 + K (q + q1)/2 + B F = f         S a = rhs - B F,   S = M + h/2 D + h^2/4 K

Laws of planets that go round act where these are: d = R(a) B^T q, with forces B R^T F (kernel_sisters.py).

F is the force of the whole step (kernel_contact.py). For linear systems this is Newmark's method. Without damping and prescribed
motion, v M v/2 + q K q/2 + V stays what it was: the equations times (q1 - q) = h (v + v1)/2. Simo and Tarnow, ZAMP 43 (1992) 757.
"""

from __future__ import annotations

import numpy as np

from rotorgear.solvers.time.compiled import compiled
from rotorgear.solvers.time.kernel_contact import blank_answer, contact_step, contact_work, force_all, schedule_all
from rotorgear.solvers.time.kernel_events import take_account
from rotorgear.solvers.time.kernel_sisters import add_going_round, take_power_of_turning, turn, turn_both
from rotorgear.solvers.time.kernel_time import (
    add_rows,
    gather,
    inertia_products,
    lu_solve,
    record_forces,
    rotation_at,
    set_row,
    subtract_products,
)


@compiled(entry=False)
def observe(step, carried, a, F, seen):
    """Fill what is gathered: local forces and displacements, watched ones, and channels with a and F at the end of the step."""
    m = F.size
    for j in range(m):
        seen[j] = carried.F[j]
        seen[m + j] = carried.d[j]
    seen[2 * m :] = 0.0
    add_rows(step.Wt, carried.q, seen, 2 * m)
    channels = 2 * m + step.Wt.first.size - 1
    add_rows(step.channels[0], carried.q, seen, channels)
    add_rows(step.channels[1], carried.v, seen, channels)
    add_rows(step.channels[2], a, seen, channels)
    add_rows(step.channels[3], F, seen, channels)


@compiled(seconds=25.0)
def newmark_loop(step, laws, sisters, seen_sisters, steps, every, begun, carried, kept):
    """Advance `carried` in place by steps after the `begun` first ones, and record every `every`-th.

    `sisters`, `seen_sisters`: planets that go round among the local displacements and all that is gathered; None where there are
    none, and then numba compiles the loop without what follows such a question.
    Of whole steps accelerations and local forces are means, which channels and records take on to the step's end.

    Returns:
        Steps done, status and linear solutions.
    """
    h = step.h
    whole = step.whole
    am = step.am
    af = step.af
    beta = step.beta
    gamma = step.gamma
    load = step.load
    Bt_first = step.Bt.first
    Bt_column = step.Bt.column
    Bt_value = step.Bt.value
    factors = step.S
    P = step.P
    q = carried.q
    v = carried.v
    a = carried.a
    F = carried.F
    before = carried.before
    begin = carried.d
    gathered = carried.gathered
    n = q.size
    m = F.size
    work = contact_work(laws)
    d_free = work.d_free
    v_free = work.v_free
    at_end = blank_answer(laws)
    Ma = np.zeros(n)
    qp = np.empty(n)
    vp = np.empty(n)
    qm = np.empty(n)
    vm = np.empty(n)
    rhs = np.empty(n)
    permuted = np.empty(n)
    a_free = np.empty(n)
    a_end = np.empty(n)
    F_end = np.empty(m)
    seen = np.zeros(gathered.level.size)
    # Place of the equations in the step, and the length over which local forces do their work: 0 where they are those of its end.
    back = 0.5 * h if whole else 0.0
    length = h if whole else 0.0
    old = h * h * (0.5 - beta)
    new = h * (1.0 - gamma)
    acting = F
    Ad = step.Ad
    Av = step.Av
    if sisters is not None:
        # Forces on the structure, and displacements of it, where planets stand as at the start.
        acting = F.copy()
        place = begin.copy()
        column = np.empty(m)
        followed = np.zeros(m)
        moved = np.zeros(m)
        Ad = np.empty((m, m))
        Av = np.empty((m, m))
        end, speed = rotation_at(begun * h, step.rotation)
        turn(sisters, -end, acting, 0)
        turn(sisters, -end, place, 0)
    solutions = 0
    for number in range(1, steps + 1):
        t = (begun + number) * h
        angle, speed = rotation_at(t - back, step.rotation)
        schedule_all(laws, angle, speed, t - back, work.state)
        for i in range(n):
            rhs[i] = load[i]
            if whole:
                qp[i] = q[i] + h * v[i]
                vp[i] = v[i]
                qm[i] = q[i] + 0.5 * h * v[i]
                vm[i] = v[i]
            else:
                qp[i] = q[i] + h * v[i] + old * a[i]
                vp[i] = v[i] + new * a[i]
                qm[i] = (1.0 - af) * qp[i] + af * q[i]
                vm[i] = (1.0 - af) * vp[i] + af * v[i]
        subtract_products(step, qm, vm, rhs)
        if am != 0.0:
            inertia_products(step, a, Ma)
            for i in range(n):
                rhs[i] -= am * Ma[i]
        if af != 0.0:
            for j in range(m):
                for p in range(Bt_first[j], Bt_first[j + 1]):
                    rhs[Bt_column[p]] -= af * Bt_value[p] * acting[j]
        lu_solve(factors, rhs, permuted, a_free)
        for j in range(m):
            x = 0.0
            y = 0.0
            for p in range(Bt_first[j], Bt_first[j + 1]):
                i = Bt_column[p]
                x += Bt_value[p] * (qp[i] + beta * h * h * a_free[i])
                y += Bt_value[p] * (vp[i] + gamma * h * a_free[i])
            d_free[j] = x
            v_free[j] = y
            work.begin[j] = begin[j]
            F[j], before[j] = 2.0 * F[j] - before[j], F[j]  # a guess that goes on as before
        if sisters is not None:
            end, speed = rotation_at(t, step.rotation)
            add_going_round(sisters, speed, d_free, v_free)
            turn(sisters, end, d_free, 0)
            turn(sisters, end, v_free, 0)
            turn_both(sisters, end, angle, step.Ad, column, Ad)
            turn_both(sisters, end, angle, step.Av, column, Av)
        if whole:
            force_all(laws, work.state, work.begin, work.zeros, work.begun, True)
        code = contact_step(laws, Ad, Av, work, F, step.tolerance, length)
        if code < 0:
            return number - 1, code, solutions
        solutions += code
        if sisters is not None:
            acting[:] = F
            turn(sisters, -angle, acting, 0)
        for i in range(n):
            total = a_free[i]
            for j in range(m):
                total -= P[i, j] * acting[j]
            if whole:
                q[i] += h * v[i] + beta * h * h * total
                v[i] += gamma * h * total
                a_end[i] = 1.5 * total - 0.5 * a[i]
            else:
                q[i] = qp[i] + beta * h * h * total
                v[i] = vp[i] + gamma * h * total
                a_end[i] = total
            a[i] = total
        if sisters is not None:
            for j in range(m):
                followed[j] = place[j]
                place[j] = work.d[j]
                moved[j] = work.v[j] if whole else 0.0
            turn(sisters, -end, place, 0)
            if whole:
                for j in range(m):
                    followed[j] = (place[j] - followed[j]) / h
            else:
                add_going_round(sisters, speed, work.d, moved)
                followed[:] = 0.0
            take_power_of_turning(laws, work.answer.energy, F, moved, acting, followed)
        take_account(laws, step.rotation, t, h, work.answer.energy, work.d, carried)
        for j in range(m):
            begin[j] = work.d[j]
            F_end[j] = 1.5 * F[j] - 0.5 * before[j] if whole else F[j]
        observe(step, carried, a_end, F_end, seen)
        if sisters is not None:
            turn(seen_sisters, end, seen, 2 * m)
        gather(gathered, seen, m, whole)
        if number % every == 0:
            r = number // every - 1
            set_row(kept.motion[0], r, q)
            set_row(kept.motion[1], r, v)
            set_row(kept.motion[2], r, a_end)
            if whole:
                angle, speed = rotation_at(t, step.rotation)
                schedule_all(laws, angle, speed, t, work.state)
                work.v[:] = 0.0
                add_rows(step.Bt, v, work.v, 0)
                if sisters is not None:
                    add_going_round(sisters, speed, place, work.v)
                    turn(sisters, end, work.v, 0)
                force_all(laws, work.state, work.d, work.v, at_end)
                record_forces(r, at_end.F, at_end.energy, 0.0, carried, kept)
            else:
                record_forces(r, F, work.answer.energy, 0.5 * h, carried, kept)
    return steps, 0, solutions
