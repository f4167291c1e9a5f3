"""Compiled: the loop of the exponential integrator in complex modes, with local forces that are constant within a step.

With z' = s z + w^T (B u + f) and the rest u = k d_m + c w - F of the local forces, which all hold for the whole step,
z1 = e z0 + Q u + g is exact. In y = z - Q u it reads y1 = e y + e Q u0 + g, so that one pass over the modes serves the step;
d at its end is C y1 + A u1. Motions without stiffness and damping follow r1 = r + h r' + h^2/2 u, r1' = r' + h u.
F does the work by which its potential changes (kernel_contact.py), and so the step keeps the energy of a system without damping,
and loses energy with it, whatever its length: Li and Wu, SIAM J. Sci. Comput. 38 (2016) A1876.
Hochbruck and Ostermann, Acta Numerica 19 (2010) 209.
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
from rotorgear.solvers.time.kernel_time import gather, record_whole, rotation_at, take_energies, take_events

_BLOCK = 256


@compiled(fast=True, inner=True)
def modal_pass(modal, u, yr, yi, out):
    """y <- e y + G u + g and out = Re(C y), block by block so that y stays in the fast cache.

    Slices whose index starts at 0, and several rows at once: only so do the loops become vector instructions.
    """
    er = modal.er
    ei = modal.ei
    gr = modal.gr
    gi = modal.gi
    Gr = modal.Gr
    Gi = modal.Gi
    Cr = modal.Cr
    Ci = modal.Ci
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


@compiled
def exponential_loop(span, turning, modal, rigid, reference, laws, motion, carried, tolerance, kept_modal, kept):
    """Advance `motion` and `carried` in place over a span and record; returns steps done, status and linear solutions."""
    h = span.h
    yr = motion.yr
    yi = motion.yi
    r0 = motion.r0
    r1 = motion.r1
    u = motion.u
    F = carried.F
    before = carried.before
    begin = carried.d
    gathered = carried.gathered
    B = rigid.B
    load = rigid.load
    watched = reference.watched
    late = reference.late
    forced = reference.forced
    Z = reference.Z
    A = reference.A
    Av = reference.Av
    k_ref = reference.k
    c_ref = reference.c
    Qr = modal.Qr
    Qi = modal.Qi
    m = F.size
    nr = r0.size
    nz = yr.size
    work = contact_work(laws, m)
    at_end = blank_answer(laws, m)
    d = work.d
    out = np.empty(modal.Cr.shape[0])
    free = np.zeros(m)
    u_before = np.empty(m)
    seen = np.zeros(gathered.level.size)
    solutions = 0
    for number in range(1, span.steps + 1):
        t = (span.begun + number) * h
        angle, speed = rotation_at(t - 0.5 * h, turning)
        schedule_all(laws, angle, speed, t - 0.5 * h, work.state)
        modal_pass(modal, u, yr, yi, out)
        for i in range(m):
            free[i] = out[i]
        for k in range(nr):
            r0[k] += h * r1[k] + 0.5 * h * h * load[k]
            r1[k] += h * load[k]
            for j in range(m):
                free[j] += B[k, j] * r0[k]
        for i in range(m):
            # u has its reference half from the step's begin, half from its end; Z takes the latter to the left-hand side.
            for j in range(m):
                held = 0.0
                for k in range(m):
                    held += (0.5 * k_ref[j, k] - c_ref[j, k] / h) * begin[k]
                free[i] += A[i, j] * held
        for i in range(m):
            x = 0.0
            for j in range(m):
                x += Z[i, j] * free[j]
            work.d_free[i] = x
            work.v_free[i] = 0.0
            work.begin[i] = begin[i]
            u_before[i] = u[i]
            F[i], before[i] = 2.0 * F[i] - before[i], F[i]
        force_all(laws, work.state, work.begin, work.zeros, work.begun, True)
        code = contact_step(laws, reference.compliance, work, F, tolerance, h)
        if code < 0:
            return number - 1, code, solutions
        solutions += code
        for i in range(m):
            total = -F[i]
            for j in range(m):
                total += 0.5 * k_ref[i, j] * (d[j] + begin[j]) + c_ref[i, j] * work.v[j]
            u[i] = total
        for k in range(nr):
            total = 0.0
            for j in range(m):
                total += B[k, j] * u[j]
            r0[k] += 0.5 * h * h * total
            r1[k] += h * total
        take_energies(work.answer.energy, h, carried)
        take_events(work.answer.energy, carried)
        for i in range(m):
            begin[i] = d[i]
            seen[i] = F[i]
            seen[m + i] = d[i]
        for i in range(len(watched)):
            x = out[m + i] + reference.constant[i]
            for j in range(m):
                x += watched[i, j] * u[j] + late[i, j] * (1.5 * u[j] - 0.5 * u_before[j])
                x += forced[i, j] * (1.5 * F[j] - 0.5 * before[j])
            for k in range(nr):
                x += rigid.W[k, i] * r0[k] + rigid.Wv[k, i] * r1[k]
            seen[2 * m + i] = x
        gather(gathered, seen, m, True)
        if number % span.every == 0:
            r = number // span.every - 1
            for j in range(nz):
                real = yr[j]
                imaginary = yi[j]
                for i in range(m):
                    real += Qr[i, j] * u[i]
                    imaginary += Qi[i, j] * u[i]
                kept_modal.z[r, j] = real
                kept_modal.z[r, nz + j] = imaginary
            for k in range(nr):
                kept_modal.rigid[r, k] = r0[k]
                kept_modal.rigid[r, nr + k] = r1[k]
            for i in range(m):
                total = 0.0
                for j in range(nz):
                    total += modal.Vr[i, j] * yr[j] - modal.Vi[i, j] * yi[j]
                for j in range(m):
                    total += Av[i, j] * u[j]
                for k in range(nr):
                    total += B[k, i] * r1[k]
                work.v[i] = total
            angle, speed = rotation_at(t, turning)
            schedule_all(laws, angle, speed, t, work.state)
            force_all(laws, work.state, d, work.v, at_end)
            for i in range(m):
                total = -at_end.F[i]
                for j in range(m):
                    total += k_ref[i, j] * d[j] + c_ref[i, j] * work.v[j]
                kept_modal.u[r, i] = total
            record_whole(r, at_end, work, carried, kept)
    return span.steps, 0, solutions
