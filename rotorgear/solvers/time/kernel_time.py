"""Compiled: what all time loops share: the prescribed angle, sparse products, triangular solutions, and statistics.

Every step adds to statistics of forces, displacements and channels. Means are by the trapezoidal
rule over values at steps, or plain over forces that are means of steps themselves. Between steps a cubic through four values
gives the extremes, where the values bend one way only: a force that jumps or sets in has none there.
"""

from __future__ import annotations

import numpy as np

from rotorgear.solvers.time.compiled import compiled

# Where a law's four energies stand.
STORED, POWER_IN, DISSIPATED, SIDE = range(4)
ENERGIES = 4
# Sums of a quantity: about its level, of squares about it, and of the negative part.
LEVEL, SQUARE, NEGATIVE = range(3)
# Second differences of neighbours that differ by more than this share of their sum belong to no smooth curve.
_SMOOTH = 0.5
_ITERATIONS = 4


@compiled
def rotation_at(t, rotation):
    """Angle and speed of the reference at a time, from times, speeds and angles (3, k); see solvers/time/local_system.py."""
    times = rotation[0]
    speeds = rotation[1]
    angles = rotation[2]
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
def subtract_products(step, q, v, out):
    """Subtract K q + D v from out."""
    first = step.first
    column = step.column
    K = step.K
    D = step.D
    for i in range(out.size):
        total = 0.0
        for p in range(first[i], first[i + 1]):
            total += K[p] * q[column[p]] + D[p] * v[column[p]]
        out[i] -= total


@compiled(fast=True, inner=True)
def inertia_products(step, x, out):
    """out = M x."""
    first = step.first
    column = step.column
    M = step.M
    for i in range(out.size):
        total = 0.0
        for p in range(first[i], first[i + 1]):
            total += M[p] * x[column[p]]
        out[i] = total


@compiled(entry=False)
def add_rows(matrix, x, out, at):
    """Add a sparse matrix times x to out, from `at` on."""
    first = matrix.first
    column = matrix.column
    value = matrix.value
    for j in range(first.size - 1):
        total = 0.0
        for p in range(first[j], first[j + 1]):
            total += value[p] * x[column[p]]
        out[at + j] += total


@compiled(fast=True, inner=True)
def lu_solve(factors, b, y, x):
    """Solve A x = b from its `Triangles`; y is overwritten."""
    diagonal = factors.diagonal
    row_place = factors.row_place
    column_place = factors.column_place
    Lp = factors.L.first
    Li = factors.L.column
    Lx = factors.L.value
    Up = factors.U.first
    Ui = factors.U.column
    Ux = factors.U.value
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
def gather(gathered, values, forces, whole):
    """Take the values (g,) of a step into their statistics; the first `forces` of them, if `whole`, are means of the step.

    A curve through forces is not continued across zero: a contact does not pull before it closes.
    """
    recent = gathered.recent
    sums = gathered.sums
    levels = gathered.level
    extremes = gathered.extremes
    count = gathered.steps[0]
    for i in range(values.size):
        x = values[i]
        a = recent[i, 0]
        b = recent[i, 1]
        c = recent[i, 2]
        force = i < forces
        if count == 0:
            levels[i] = x if force and whole else c
        level = levels[i]
        now = x - level
        if force and whole:
            sums[i, LEVEL] += now
            sums[i, SQUARE] += now * now
            sums[i, NEGATIVE] += min(x, 0.0)
        else:
            before = c - level
            sums[i, LEVEL] += 0.5 * (now + before)
            sums[i, SQUARE] += 0.5 * (now * now + before * before)
            sums[i, NEGATIVE] += 0.5 * (min(x, 0.0) + min(c, 0.0))
        extremes[i, 0] = min(extremes[i, 0], x)
        extremes[i, 1] = max(extremes[i, 1], x)
        if count >= 3 and ((b >= a and c >= x) or (b <= a and c <= x)):
            value = peak(a, b, c, x)
            if not force or (value * b > 0.0 and value * c > 0.0):
                extremes[i, 0] = min(extremes[i, 0], value)
                extremes[i, 1] = max(extremes[i, 1], value)
        recent[i, 0] = b
        recent[i, 1] = c
        recent[i, 2] = x
    gathered.steps[0] = count + 1


@compiled(entry=False)
def peak(a, b, c, x):
    """Extreme between b and c of the cubic through four values at equal distances (Bessel's formula); b where none is smooth."""
    left = a - 2.0 * b + c
    right = b - 2.0 * c + x
    third = right - left
    bend = 0.5 * (left + right)
    if left * right <= 0.0 or abs(third) > 2.0 * _SMOOTH * abs(bend):
        return b
    t = 0.5 - (c - b) / bend
    for _ in range(_ITERATIONS):
        slope = c - b + (t - 0.5) * bend + third * (0.5 * t * (t - 1.0) + 1.0 / 12.0)
        t -= slope / (bend + third * (t - 0.5))
    if not 0.0 < t < 1.0:
        return b
    return b + t * (c - b) + 0.5 * t * (t - 1.0) * (bend + (t - 0.5) / 3.0 * third)


@compiled(entry=False)
def set_row(rows, r, values):
    """Write a row. numba compiles the message of an assignment whose shapes don't match, which takes longer than a loop."""
    for i in range(values.size):
        rows[r, i] = values[i]


@compiled
def record_forces(r, F, energy, ahead, carried, kept):
    """Record local displacements, forces and energies at a step's end, from sums that reach `ahead` seconds beyond it."""
    set_row(kept.d, r, carried.d)
    set_row(kept.F, r, F)
    for law in range(carried.last.size):
        kept.energy[r, law, 0] = energy[ENERGIES * law + STORED]
        kept.energy[r, law, 1] = carried.sums[law, 0] - ahead * energy[ENERGIES * law + POWER_IN]
        kept.energy[r, law, 2] = carried.sums[law, 1] - ahead * energy[ENERGIES * law + DISSIPATED]
