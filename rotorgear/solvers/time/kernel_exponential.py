"""Compiled: the loop of the exponential integrator in complex modes, with local forces that are constant within a step.

With z' = s z + w^T (B u + f) and the rest u = k d_m + c w - F of the local forces, which all hold for the whole step,
z1 = e z0 + Q u + g is exact. In y = z - Q u it reads y1 = e y + e Q u0 + g, so that one pass over the modes serves the step;
d at its end is C y1 + A u1. Motions without stiffness and damping follow r1 = r + h r' + h^2/2 u, r1' = r' + h u.
F does the work by which its potential changes (kernel_contact.py), and so the step keeps the energy of a system without damping,
and loses energy with it, whatever its length: Li and Wu, SIAM J. Sci. Comput. 38 (2016) A1876.
Laws of planets that go round act where these are, d = R(a) B^T q with forces B R^T F (kernel_sisters.py), while modes and the
rest u are those of the structure, where planets stand as at the start.
Hochbruck and Ostermann, Acta Numerica 19 (2010) 209.
"""

from __future__ import annotations

import numpy as np

from rotorgear.solvers.time.compiled import compiled
from rotorgear.solvers.time.kernel_contact import blank_answer, contact_step, contact_work, force_all, schedule_all
from rotorgear.solvers.time.kernel_events import take_account
from rotorgear.solvers.time.kernel_sisters import add_going_round, take_power_of_turning, turn, turn_both
from rotorgear.solvers.time.kernel_time import gather, record_forces, rotation_at

_BLOCK = 256


@compiled(fast=True, inner=True)
def modal_pass(step, u, yr, yi, out):
    """y <- e y + G u + g and out = Re(C y), block by block so that y stays in the fast cache.

    Slices whose index starts at 0, and several rows at once: only so do the loops become vector instructions.
    """
    er = step.e[0]
    ei = step.e[1]
    gr = step.g[0]
    gi = step.g[1]
    Gr = step.G[0]
    Gi = step.G[1]
    Cr = step.C[0]
    Ci = step.C[1]
    nz = yr.size
    m = u.size
    rows = out.size
    for r in range(rows):
        out[r] = 0.0
    for start in range(0, nz, _BLOCK):
        stop = min(start + _BLOCK, nz)
        n = stop - start
        a = yr[start:stop]
        b = yi[start:stop]
        e = er[start:stop]
        f = ei[start:stop]
        p = gr[start:stop]
        q = gi[start:stop]
        for j in range(n):
            x = e[j] * a[j] - f[j] * b[j] + p[j]
            b[j] = e[j] * b[j] + f[j] * a[j] + q[j]
            a[j] = x
        i = 0
        while i + 3 < m:
            u0 = u[i]
            u1 = u[i + 1]
            u2 = u[i + 2]
            u3 = u[i + 3]
            k0 = Gr[i, start:stop]
            k1 = Gr[i + 1, start:stop]
            k2 = Gr[i + 2, start:stop]
            k3 = Gr[i + 3, start:stop]
            for j in range(n):
                a[j] += k0[j] * u0 + k1[j] * u1 + k2[j] * u2 + k3[j] * u3
            k0 = Gi[i, start:stop]
            k1 = Gi[i + 1, start:stop]
            k2 = Gi[i + 2, start:stop]
            k3 = Gi[i + 3, start:stop]
            for j in range(n):
                b[j] += k0[j] * u0 + k1[j] * u1 + k2[j] * u2 + k3[j] * u3
            i += 4
        while i < m:
            k0 = Gr[i, start:stop]
            k1 = Gi[i, start:stop]
            u0 = u[i]
            for j in range(n):
                a[j] += k0[j] * u0
                b[j] += k1[j] * u0
            i += 1
        r = 0
        while r + 1 < rows:
            k0 = Cr[r, start:stop]
            k1 = Ci[r, start:stop]
            k2 = Cr[r + 1, start:stop]
            k3 = Ci[r + 1, start:stop]
            first = 0.0
            second = 0.0
            for j in range(n):
                first += k0[j] * a[j] - k1[j] * b[j]
                second += k2[j] * a[j] - k3[j] * b[j]
            out[r] += first
            out[r + 1] += second
            r += 2
        if r < rows:
            k0 = Cr[r, start:stop]
            k1 = Ci[r, start:stop]
            first = 0.0
            for j in range(n):
                first += k0[j] * a[j] - k1[j] * b[j]
            out[r] += first


@compiled(seconds=25.0)
def exponential_loop(step, laws, sisters, seen_sisters, steps, every, begun, motion, carried, kept):
    """Advance the motion and `carried` in place by steps after the `begun` first ones, and record every `every`-th.

    `sisters`, `seen_sisters`: as of `newmark_loop`.
    `motion`: both parts of y = z - Q u (nz,), motions without stiffness r and their rates (nr,), and the rest u (m,).

    Returns:
        Steps done, status and linear solutions.
    """
    h = step.h
    yr, yi, r0, r1, u = motion
    F = carried.F
    before = carried.before
    begin = carried.d
    gathered = carried.gathered
    B = step.B
    load = step.load
    watched = step.watched
    late = step.late
    forced = step.forced
    Z = step.Z
    Ud = step.Ud
    Uv = step.Uv
    k_ref = step.k
    c_ref = step.c
    Qr = step.Q[0]
    Qi = step.Q[1]
    Vr = step.V[0]
    Vi = step.V[1]
    z, rigid, rest = kept.motion
    m = F.size
    nr = r0.size
    nz = yr.size
    work = contact_work(laws)
    at_end = blank_answer(laws)
    d = work.d
    out = np.empty(step.C.shape[1])
    free = np.zeros(m)
    u_before = np.empty(m)
    seen = np.zeros(gathered.level.size)
    acting = F
    acting_at_end = at_end.F
    place = d
    before_step = begin
    rate = work.v
    Ad = step.Ad
    if sisters is not None:
        # Forces on the structure, and displacements of it at both ends of a step, where planets stand as at the start.
        acting = np.empty(m)
        acting_at_end = np.empty(m)
        place = begin.copy()
        before_step = begin.copy()
        rate = np.empty(m)
        column = np.empty(m)
        Ad = np.empty((m, m))
        end, speed = rotation_at(begun * h, step.rotation)
        turn(sisters, -end, place, 0)
    solutions = 0
    for number in range(1, steps + 1):
        t = (begun + number) * h
        angle, speed = rotation_at(t - 0.5 * h, step.rotation)
        schedule_all(laws, angle, speed, t - 0.5 * h, work.state)
        modal_pass(step, u, yr, yi, out)
        for i in range(m):
            free[i] = out[i]
        for k in range(nr):
            r0[k] += h * r1[k] + 0.5 * h * h * load[k]
            r1[k] += h * load[k]
            for j in range(m):
                free[j] += B[k, j] * r0[k]
        if sisters is not None:
            before_step[:] = place
        for i in range(m):
            # u has its reference half from the step's begin, half from its end; Z takes the latter to the left-hand side.
            for j in range(m):
                held = 0.0
                for k in range(m):
                    held += (0.5 * k_ref[j, k] - c_ref[j, k] / h) * before_step[k]
                free[i] += Ud[i, j] * held
        for i in range(m):
            x = 0.0
            for j in range(m):
                x += Z[i, j] * free[j]
            work.d_free[i] = x
            work.v_free[i] = 0.0
            work.begin[i] = begin[i]
            u_before[i] = u[i]
            F[i], before[i] = 2.0 * F[i] - before[i], F[i]
        if sisters is not None:
            end, speed = rotation_at(t, step.rotation)
            turn(sisters, end, work.d_free, 0)
            turn_both(sisters, end, angle, step.Ad, column, Ad)
        force_all(laws, work.state, work.begin, work.zeros, work.begun, True)
        code = contact_step(laws, Ad, step.Av, work, F, step.tolerance, h)
        if code < 0:
            return number - 1, code, solutions
        solutions += code
        if sisters is not None:
            acting[:] = F
            place[:] = d
            turn(sisters, -angle, acting, 0)
            turn(sisters, -end, place, 0)
            for i in range(m):
                rate[i] = (place[i] - before_step[i]) / h
            take_power_of_turning(laws, work.answer.energy, F, work.v, acting, rate)
        for i in range(m):
            total = -acting[i]
            for j in range(m):
                total += 0.5 * k_ref[i, j] * (place[j] + before_step[j]) + c_ref[i, j] * rate[j]
            u[i] = total
        for k in range(nr):
            total = 0.0
            for j in range(m):
                total += B[k, j] * u[j]
            r0[k] += 0.5 * h * h * total
            r1[k] += h * total
        take_account(laws, step.rotation, t, h, work.answer.energy, d, carried)
        for i in range(m):
            begin[i] = d[i]
            seen[i] = F[i]
            seen[m + i] = d[i]
        for i in range(len(watched)):
            x = out[m + i] + step.constant[i]
            for j in range(m):
                x += watched[i, j] * u[j] + late[i, j] * (1.5 * u[j] - 0.5 * u_before[j])
                x += forced[i, j] * (1.5 * F[j] - 0.5 * before[j])
            for k in range(nr):
                x += step.W[k, i] * r0[k] + step.Wv[k, i] * r1[k]
            seen[2 * m + i] = x
        if sisters is not None:
            turn(seen_sisters, end, seen, 2 * m)
        gather(gathered, seen, m, True)
        if number % every == 0:
            r = number // every - 1
            for j in range(nz):
                real = yr[j]
                imaginary = yi[j]
                for i in range(m):
                    real += Qr[i, j] * u[i]
                    imaginary += Qi[i, j] * u[i]
                z[r, j] = real
                z[r, nz + j] = imaginary
            for k in range(nr):
                rigid[r, k] = r0[k]
                rigid[r, nr + k] = r1[k]
            for i in range(m):
                total = 0.0
                for j in range(nz):
                    total += Vr[i, j] * yr[j] - Vi[i, j] * yi[j]
                for j in range(m):
                    total += Uv[i, j] * u[j]
                for k in range(nr):
                    total += B[k, i] * r1[k]
                work.v[i] = total
            angle, speed = rotation_at(t, step.rotation)
            schedule_all(laws, angle, speed, t, work.state)
            if sisters is not None:
                rate[:] = work.v
                add_going_round(sisters, speed, place, work.v)
                turn(sisters, end, work.v, 0)
            force_all(laws, work.state, d, work.v, at_end)
            if sisters is not None:
                acting_at_end[:] = at_end.F
                turn(sisters, -end, acting_at_end, 0)
            for i in range(m):
                total = -acting_at_end[i]
                for j in range(m):
                    total += k_ref[i, j] * place[j] + c_ref[i, j] * rate[j]
                rest[r, i] = total
            record_forces(r, at_end.F, at_end.energy, 0.0, carried, kept)
    return steps, 0, solutions
