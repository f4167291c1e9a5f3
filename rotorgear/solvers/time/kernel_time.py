"""Compiled: what all time loops share. Prescribed angle, sparse products and triangular solutions."""

from __future__ import annotations

import numpy as np

from rotorgear.solvers.time.compiled import compiled


@compiled
def rotation_at(t, turning):
    """Angle and speed of the reference at a time; see solvers/time/motion.py."""
    times = turning.times
    speeds = turning.speeds
    angles = turning.angles
    k = times.size
    if k == 1 or t <= times[0]:
        return angles[0] + speeds[0] * (t - times[0]), speeds[0]
    if t >= times[k - 1]:
        return angles[k - 1] + speeds[k - 1] * (t - times[k - 1]), speeds[k - 1]
    i = np.searchsorted(times, t) - 1
    late = t - times[i]
    rate = (speeds[i + 1] - speeds[i]) / (times[i + 1] - times[i])
    return angles[i] + (speeds[i] + 0.5 * rate * late) * late, speeds[i] + rate * late


@compiled(fast=True, inner=True)
def subtract_products(structure, q, v, out):
    """Subtract K q + D v from out."""
    first = structure.first
    column = structure.column
    K = structure.K
    D = structure.D
    for i in range(out.size):
        total = 0.0
        for p in range(first[i], first[i + 1]):
            total += K[p] * q[column[p]] + D[p] * v[column[p]]
        out[i] -= total


@compiled(fast=True, inner=True)
def inertia_products(structure, x, out):
    """out = M x."""
    first = structure.first
    column = structure.column
    M = structure.M
    for i in range(out.size):
        total = 0.0
        for p in range(first[i], first[i + 1]):
            total += M[p] * x[column[p]]
        out[i] = total


@compiled(fast=True, inner=True)
def lu_solve(factors, b, y, x):
    """Solve A x = b from its `Triangles`; y is overwritten."""
    diagonal = factors.diagonal
    row_place = factors.row_place
    column_place = factors.column_place
    Lp = factors.Lp
    Li = factors.Li
    Lx = factors.Lx
    Up = factors.Up
    Ui = factors.Ui
    Ux = factors.Ux
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
