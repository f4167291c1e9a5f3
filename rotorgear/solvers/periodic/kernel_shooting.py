"""Compiled: a small system and its tangents over a time, by the method of Dormand and Prince with error control on both.

    P'' = f - D P' - K P - C F(E P, w E P', tau/w),     tau = w t

A step that a kink or a jump of a tangent lies in is cut down to it: the tangents' own error finds it, to the tolerance.
Dormand and Prince, J. Computational and Applied Mathematics 6 (1980) 19.
"""

from __future__ import annotations

import numpy as np

from rotorgear.solvers.time.compiled import compiled
from rotorgear.solvers.time.kernel_contact import contact_work, force_all, schedule_all
from rotorgear.solvers.time.kernel_time import set_row

_STAGES = 7
_SMALLEST = 1e-13
# Matrix, nodes and differences of both orders of the method.
_A = np.zeros((_STAGES, _STAGES))
_A[1, :1] = (1 / 5,)
_A[2, :2] = (3 / 40, 9 / 40)
_A[3, :3] = (44 / 45, -56 / 15, 32 / 9)
_A[4, :4] = (19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729)
_A[5, :5] = (9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656)
_A[6, :6] = (35 / 384, 0.0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84)
_NODE = np.array([0.0, 0.2, 0.3, 0.8, 8 / 9, 1.0, 1.0])
_E = _A[6] - np.array([5179 / 57600, 0.0, 7571 / 16695, 393 / 640, -92097 / 339200, 187 / 2100, 1 / 40])


@compiled(entry=False)
def rates(small, laws, tau, x, work, push, out):
    """Rates (2 n, 1 + c) of state and tangents x over tau; the first column is the state."""
    n = small.K.shape[0]
    m = small.C.shape[1]
    columns = x.shape[1]
    t = tau / small.w
    schedule_all(laws, small.speed * t, small.speed, t, work.state)
    d = work.d
    v = work.v
    for i in range(m):
        a = 0.0
        b = 0.0
        for j in range(n):
            a += small.E[i, j] * x[j, 0]
            b += small.E[i, j] * x[n + j, 0]
        d[i] = a
        v[i] = small.w * b
    answer = work.answer
    force_all(laws, work.state, d, v, answer)
    for c in range(columns):
        if c == 0:
            for i in range(m):
                push[i] = answer.F[i]
        else:
            for law in range(laws.kind.size):
                first = laws.first[law]
                k = laws.first[law + 1] - first
                block = laws.block_first[law]
                for i in range(k):
                    total = 0.0
                    for r in range(k):
                        a = 0.0
                        b = 0.0
                        for j in range(n):
                            a += small.E[first + r, j] * x[j, c]
                            b += small.E[first + r, j] * x[n + j, c]
                        total += answer.Kd[block + i * k + r] * a + answer.Kv[block + i * k + r] * small.w * b
                    push[first + i] = total
        for i in range(n):
            total = small.f[i] if c == 0 else 0.0
            for j in range(n):
                total -= small.K[i, j] * x[j, c] + small.D[i, j] * x[n + j, c]
            for j in range(m):
                total -= small.C[i, j] * push[j]
            out[i, c] = x[n + i, c]
            out[n + i, c] = total


@compiled(seconds=17.0)
def flow(small, laws, x, outputs, tolerance, kept, most):
    """Advance state and tangents x (2 n, 1 + c) in place through times `outputs`, and keep the state there.

    Returns the steps, or -1 where they are too many or numbers are none.
    """
    work = contact_work(laws)
    push = np.zeros(laws.first[-1])
    rows, columns = x.shape
    k = np.zeros((_STAGES, rows, columns))
    trial = np.empty((rows, columns))
    tau = outputs[0]
    end = outputs[-1]
    set_row(kept, 0, x[:, 0])
    number = 1
    h = 0.01
    rates(small, laws, tau, x, work, push, k[0])
    steps = 0
    while number < outputs.size:
        if steps > most:
            return -1
        stop = outputs[number]
        last = tau + h >= stop - 1e-14 * abs(end)
        step = stop - tau if last else h
        for stage in range(1, _STAGES):
            for i in range(rows):
                for c in range(columns):
                    total = 0.0
                    for s in range(stage):
                        total += _A[stage, s] * k[s, i, c]
                    trial[i, c] = x[i, c] + step * total
            rates(small, laws, tau + _NODE[stage] * step, trial, work, push, k[stage])
        # The last stage is at the end of the step: first same as last.
        error = 0.0
        for c in range(columns):
            size = 1.0
            off = 0.0
            for i in range(rows):
                total = 0.0
                for s in range(_STAGES):
                    total += _E[s] * k[s, i, c]
                off = max(off, abs(step * total))
                size = max(size, abs(trial[i, c]))
            error = max(error, off / size)
        if not np.isfinite(error):
            return -1
        steps += 1
        scaled = error / tolerance
        if scaled <= 1.0 or step <= _SMALLEST:
            tau = stop if last else tau + step
            for i in range(rows):
                for c in range(columns):
                    x[i, c] = trial[i, c]
                    k[0, i, c] = k[6, i, c]
            if last:
                set_row(kept, number, x[:, 0])
                number += 1
            factor = 5.0 if scaled < 1e-4 else min(5.0, 0.9 * scaled ** (-0.2))
            # A step that an output cuts short is no reason to shorten the next one.
            h = max(h, factor * step) if last else factor * step
        else:
            h = step * max(0.1, 0.9 * scaled ** (-0.2))
    return steps
