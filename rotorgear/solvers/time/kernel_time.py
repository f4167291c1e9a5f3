"""Compiled: what all time loops share. Prescribed angle, sparse products and triangular solutions, event counts."""

from __future__ import annotations

import numpy as np

from rotorgear.solvers.time.compiled import compiled


@compiled
def rotation_at(t, times, speeds, angles):
    """Angle and speed of the reference at a time; see solvers/time/motion.py."""
    k = times.size
    if k == 1 or t <= times[0]:
        return angles[0] + speeds[0] * (t - times[0]), speeds[0]
    if t >= times[k - 1]:
        return angles[k - 1] + speeds[k - 1] * (t - times[k - 1]), speeds[k - 1]
    i = np.searchsorted(times, t) - 1
    late = t - times[i]
    rate = (speeds[i + 1] - speeds[i]) / (times[i + 1] - times[i])
    return angles[i] + (speeds[i] + 0.5 * rate * late) * late, speeds[i] + rate * late


@compiled(fast=True)
def subtract_products(first, column, K, D, q, v, out):
    """Subtract K q + D v from out; both matrices in one pattern by rows."""
    for i in range(out.size):
        total = 0.0
        for p in range(first[i], first[i + 1]):
            total += K[p] * q[column[p]] + D[p] * v[column[p]]
        out[i] -= total


@compiled(fast=True)
def row_products(first, column, value, x, out):
    """Sparse matrix by rows times x."""
    for i in range(out.size):
        total = 0.0
        for p in range(first[i], first[i + 1]):
            total += value[p] * x[column[p]]
        out[i] = total


@compiled(fast=True)
def lu_solve(Lp, Li, Lx, Up, Ui, Ux, diagonal, row_place, column_place, b, y, x):
    """Solve A x = b from SuperLU's factors by columns, without their diagonals; `diagonal` is 1/diag(U)."""
    n = b.size
    for i in range(n):
        y[row_place[i]] = b[i]
    for j in range(n):
        value = y[j]
        if value != 0.0:
            for p in range(Lp[j], Lp[j + 1]):
                y[Li[p]] -= Lx[p] * value
    for j in range(n - 1, -1, -1):
        value = y[j] * diagonal[j]
        y[j] = value
        if value != 0.0:
            for p in range(Up[j], Up[j + 1]):
                y[Ui[p]] -= Ux[p] * value
    for i in range(n):
        x[i] = y[column_place[i]]


@compiled
def count_events(energy, last, events):
    """Count, for each law, steps on the front side, apart, and on the back side, and the contact losses."""
    for law in range(last.size):
        now = int(energy[4 * law + 3])
        if now > 0:
            events[law, 0] += 1
        elif now < 0:
            events[law, 2] += 1
        else:
            events[law, 1] += 1
            if last[law] != 0:
                events[law, 3] += 1
        last[law] = now
