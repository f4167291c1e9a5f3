"""Compiled: the loop of the exponential integrator in complex modes, with forces linear within a step.

With z' = s z + w^T (B u + f) and u linear from u0 to u1, the exact step is z1 = e z0 + Q0 u0 + Q1 u1 + g. In
y = z - Q1 u it reads y1 = e y + (e Q1 + Q0) u0 + g, so that one pass over the modes serves the step; d and v at its end are
C y1 + A u1.
Motions without stiffness and damping follow r1 = r + h r' + h^2 (u0/3 + u1/6), r1' = r' + h (u0 + u1)/2.
Hochbruck and Ostermann, Acta Numerica 19 (2010) 209.
"""

from __future__ import annotations

import numpy as np

from rotorgear.solvers.time.compiled import compiled
from rotorgear.solvers.time.kernel_contact import (
    contact_step,
    contact_work,
    record_forces,
    schedule_all,
    take_account,
    widen,
)
from rotorgear.solvers.time.kernel_time import rotation_at

_BLOCK = 256


@compiled(fast=True)
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
    B = rigid.B
    W = rigid.W
    load = rigid.load
    extremes = carried.extremes
    watched = reference.watched
    Z = reference.Z
    k_ref = reference.k
    c_ref = reference.c
    compliance = reference.compliance
    Qr = modal.Qr
    Qi = modal.Qi
    m = F.size
    nr = r0.size
    nz = yr.size
    work = contact_work(laws, m)
    state = work.state
    d_free = work.d_free
    v_free = work.v_free
    energy = work.answer.energy
    d = work.d
    v = work.v
    out = np.empty(modal.Cr.shape[0])
    local = out.size - len(watched)
    free = np.zeros(2 * m)
    solutions = 0
    for number in range(1, span.steps + 1):
        t = (span.begun + number) * h
        angle, speed = rotation_at(t, turning)
        schedule_all(laws, angle, speed, t, state)
        modal_pass(modal, u, yr, yi, out)
        for i in range(local):
            free[i] = out[i]
        for k in range(nr):
            total = load[k]
            for j in range(m):
                total += B[k, j] * u[j]
            # The share of u1 comes through the compliances Ad and Av; the constant load acts from both ends.
            r0[k] += h * r1[k] + h * h * (total / 3.0 + load[k] / 6.0)
            r1[k] += 0.5 * h * (total + load[k])
            for j in range(m):
                free[j] += B[k, j] * r0[k]
                free[m + j] += B[k, j] * r1[k]
        for i in range(m):
            x = 0.0
            y = 0.0
            for j in range(2 * m):
                x += Z[i, j] * free[j]
                y += Z[m + i, j] * free[j]
            d_free[i] = x
            v_free[i] = y
            F[i], before[i] = 2.0 * F[i] - before[i], F[i]
        code = contact_step(laws, compliance, work, F, tolerance)
        if code < 0:
            return number - 1, code, solutions
        solutions += code
        for i in range(m):
            total = -F[i]
            for j in range(m):
                total += k_ref[i, j] * d[j] + c_ref[i, j] * v[j]
            u[i] = total
        for k in range(nr):
            total = 0.0
            for j in range(m):
                total += B[k, j] * u[j]
            r0[k] += h * h * total / 6.0
            r1[k] += 0.5 * h * total
        take_account(energy, h, carried)
        for i in range(m):
            widen(extremes, i, d[i])
        for i in range(len(watched)):
            x = out[local + i]
            for j in range(m):
                x += watched[i, j] * u[j]
            for k in range(nr):
                x += W[k, i] * r0[k]
            widen(extremes, m + i, x)
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
            kept_modal.u[r] = u
            record_forces(r, h, work, carried, kept)
    return span.steps, 0, solutions
