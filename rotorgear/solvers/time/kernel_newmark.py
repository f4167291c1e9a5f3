"""Compiled: the loop of the generalised-alpha family with one constant factorisation and condensed contact.

    q1 = q + h v + h^2 (1/2 - beta) a + beta h^2 a1         v1 = v + h (1 - gamma) a + gamma h a1
    M [(1-am) a1 + am a] + D [(1-af) v1 + af v] + K [(1-af) q1 + af q] + B [(1-af) F1 + af F] = f
    S a1 = rhs - (1-af) B F1,   S = (1-am) M + (1-af) gamma h D + (1-af) beta h^2 K

am = af = 0 is Newmark's method, am = 0 Hilber, Hughes and Taylor's. F1 acts through the m columns P = S^-1 B only, so that
Newton's method runs on m x m systems. Chung and Hulbert, J. Applied Mechanics 60 (1993) 371.
"""

from __future__ import annotations

import numpy as np

from rotorgear.solvers.time.compiled import compiled
from rotorgear.solvers.time.kernel_contact import contact_step, schedule_all
from rotorgear.solvers.time.kernel_time import count_events, lu_solve, rotation_at, row_products, subtract_products


@compiled
def newmark_loop(
    steps,
    every,
    step0,
    h,
    am,
    af,
    beta,
    gamma,
    times,
    speeds,
    angles,
    first_nz,
    column,
    K,
    D,
    M,
    Lp,
    Li,
    Lx,
    Up,
    Ui,
    Ux,
    diagonal,
    row_place,
    column_place,
    Bt_first,
    Bt_column,
    Bt_value,
    P,
    Ad,
    Av,
    load,
    schedules,
    forces,
    kind,
    first,
    parameters,
    parameters_first,
    state_first,
    block_first,
    q,
    v,
    a,
    F,
    before,
    tolerance,
    records_q,
    records_v,
    records_a,
    records_d,
    records_F,
    records_E,
    sums,
    last,
    events,
):
    """Advance `steps` steps in place and record every `every`-th; returns steps done and the status of the last."""
    n = q.size
    m = F.size
    state = np.zeros(state_first[-1])
    Kd = np.zeros(block_first[-1])
    Kv = np.zeros(block_first[-1])
    energy = np.zeros(4 * kind.size)
    J = np.empty((m, m))
    d = np.empty(m)
    w = np.empty(m)
    trial = np.empty(m)
    d_free = np.empty(m)
    v_free = np.empty(m)
    Ma = np.zeros(n)
    qm = np.empty(n)
    vm = np.empty(n)
    rhs = np.empty(n)
    work = np.empty(n)
    a_free = np.empty(n)
    solutions = 0
    for number in range(1, steps + 1):
        t = (step0 + number) * h
        angle, speed = rotation_at(t, times, speeds, angles)
        schedule_all(schedules, kind, parameters, parameters_first, state_first, angle, speed, t, state)
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
        subtract_products(first_nz, column, K, D, qm, vm, rhs)
        if am != 0.0:
            row_products(first_nz, column, M, a, Ma)
            for i in range(n):
                rhs[i] -= am * Ma[i]
        if af != 0.0:
            for j in range(m):
                for p in range(Bt_first[j], Bt_first[j + 1]):
                    rhs[Bt_column[p]] -= af * Bt_value[p] * F[j]
        lu_solve(Lp, Li, Lx, Up, Ui, Ux, diagonal, row_place, column_place, rhs, work, a_free)
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
        code = contact_step(
            forces,
            kind,
            first,
            parameters,
            parameters_first,
            state_first,
            block_first,
            state,
            d_free,
            v_free,
            Ad,
            Av,
            F,
            d,
            w,
            trial,
            Kd,
            Kv,
            energy,
            J,
            tolerance,
        )
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
        for law in range(kind.size):
            sums[law, 0] += h * energy[4 * law + 1]
            sums[law, 1] += h * energy[4 * law + 2]
        count_events(energy, last, events)
        if number % every == 0:
            r = number // every - 1
            records_q[r] = q
            records_v[r] = v
            records_a[r] = a
            records_d[r] = d
            records_F[r] = F
            for law in range(kind.size):
                records_E[r, law, 0] = energy[4 * law]
                records_E[r, law, 1] = sums[law, 0] - 0.5 * h * energy[4 * law + 1]
                records_E[r, law, 2] = sums[law, 1] - 0.5 * h * energy[4 * law + 2]
    return steps, 0, solutions
