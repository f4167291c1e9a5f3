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
from rotorgear.solvers.time.kernel_contact import contact_step, schedule_all
from rotorgear.solvers.time.kernel_time import count_events, rotation_at

_BLOCK = 256


@compiled(fast=True)
def modal_pass(er, ei, Gr, Gi, gr, gi, Cr, Ci, u, yr, yi, out):
    """y <- e y + G u + g and out = Re(C y), block by block so that y stays in the fast cache.

    Slices whose index starts at 0, and several rows at once: only so do the loops become vector instructions.
    """
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
def exponential_loop(
    steps,
    every,
    step0,
    h,
    needs_v,
    times,
    speeds,
    angles,
    er,
    ei,
    Gr,
    Gi,
    gr,
    gi,
    Qr,
    Qi,
    Cr,
    Ci,
    Br,
    rigid_load,
    Z,
    Ad,
    Av,
    k_ref,
    c_ref,
    schedules,
    forces,
    kind,
    first,
    parameters,
    parameters_first,
    state_first,
    block_first,
    yr,
    yi,
    r0,
    r1,
    u,
    F,
    before,
    tolerance,
    records_z,
    records_r,
    records_u,
    records_d,
    records_F,
    records_E,
    sums,
    last,
    events,
):
    """Advance `steps` steps in place and record every `every`-th; returns steps done, status and linear solutions."""
    m = F.size
    nr = r0.size
    nz = yr.size
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
    out = np.empty(2 * m if needs_v else m)
    free = np.zeros(2 * m)
    pushed = np.empty(nr)
    solutions = 0
    for number in range(1, steps + 1):
        t = (step0 + number) * h
        angle, speed = rotation_at(t, times, speeds, angles)
        schedule_all(schedules, kind, parameters, parameters_first, state_first, angle, speed, t, state)
        modal_pass(er, ei, Gr, Gi, gr, gi, Cr, Ci, u, yr, yi, out)
        for i in range(out.size):
            free[i] = out[i]
        for k in range(nr):
            total = rigid_load[k]
            for j in range(m):
                total += Br[k, j] * u[j]
            pushed[k] = total
            # The share of u1 comes through the compliances Ad and Av; the constant load acts from both ends.
            r0[k] += h * r1[k] + h * h * (total / 3.0 + rigid_load[k] / 6.0)
            r1[k] += 0.5 * h * (total + rigid_load[k])
            for j in range(m):
                free[j] += Br[k, j] * r0[k]
                free[m + j] += Br[k, j] * r1[k]
        for i in range(m):
            x = 0.0
            y = 0.0
            for j in range(2 * m):
                x += Z[i, j] * free[j]
                y += Z[m + i, j] * free[j]
            d_free[i] = x
            v_free[i] = y
            F[i], before[i] = 2.0 * F[i] - before[i], F[i]
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
        for i in range(m):
            total = -F[i]
            for j in range(m):
                total += k_ref[i, j] * d[j] + c_ref[i, j] * w[j]
            u[i] = total
        for k in range(nr):
            total = 0.0
            for j in range(m):
                total += Br[k, j] * u[j]
            r0[k] += h * h * total / 6.0
            r1[k] += 0.5 * h * total
        for law in range(kind.size):
            sums[law, 0] += h * energy[4 * law + 1]
            sums[law, 1] += h * energy[4 * law + 2]
        count_events(energy, last, events)
        if number % every == 0:
            r = number // every - 1
            for j in range(nz):
                real = yr[j]
                imaginary = yi[j]
                for i in range(m):
                    real += Qr[i, j] * u[i]
                    imaginary += Qi[i, j] * u[i]
                records_z[r, j] = real
                records_z[r, nz + j] = imaginary
            for k in range(nr):
                records_r[r, k] = r0[k]
                records_r[r, nr + k] = r1[k]
            records_u[r] = u
            records_d[r] = d
            records_F[r] = F
            for law in range(kind.size):
                records_E[r, law, 0] = energy[4 * law]
                records_E[r, law, 1] = sums[law, 0] - 0.5 * h * energy[4 * law + 1]
                records_E[r, law, 2] = sums[law, 1] - 0.5 * h * energy[4 * law + 2]
    return steps, 0, solutions
