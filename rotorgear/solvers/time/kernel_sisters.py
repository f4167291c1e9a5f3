"""Compiled: the turns R(a) and T of `sisters.py`, by the sums of the first class x_c cos psi + x_s sin psi over the sisters."""

from __future__ import annotations

import numpy as np

from rotorgear.solvers.time.compiled import compiled
from rotorgear.solvers.time.kernel_time import ENERGIES, POWER_IN


@compiled(entry=False)
def first_class(sisters, k, x, begin):
    """x_c and x_s of set k among the places of x from `begin` on."""
    N = sisters.planets[k]
    of_cosine = 0.0
    of_sine = 0.0
    for i in range(N):
        value = x[begin + sisters.place[k, i]]
        of_cosine += 2.0 / N * value * sisters.cosine[k, i]
        of_sine += 2.0 / N * value * sisters.sine[k, i]
    return of_cosine, of_sine


@compiled(entry=False)
def turn(sisters, angle, x, begin):
    """Turn the places of all sets in x, from `begin` on, by an angle of the reference; nothing else changes."""
    for k in range(sisters.planets.size):
        a = sisters.ratio[k] * angle
        of_cosine, of_sine = first_class(sisters, k, x, begin)
        cosine = np.cos(a) - 1.0
        sine = np.sin(a)
        change_cosine = cosine * of_cosine + sine * of_sine
        change_sine = cosine * of_sine - sine * of_cosine
        for i in range(sisters.planets[k]):
            x[begin + sisters.place[k, i]] += change_cosine * sisters.cosine[k, i] + change_sine * sisters.sine[k, i]


@compiled(entry=False)
def add_going_round(sisters, speed, x, rate):
    """Subtract W T x from the rate: of the places, the rate that the planets themselves see."""
    for k in range(sisters.planets.size):
        W = sisters.ratio[k] * speed
        of_cosine, of_sine = first_class(sisters, k, x, 0)
        for i in range(sisters.planets[k]):
            rate[sisters.place[k, i]] -= W * (of_cosine * sisters.sine[k, i] - of_sine * sisters.cosine[k, i])


@compiled(entry=False)
def turn_both(sisters, left, right, A, column, out):
    """out = R(left) A R(right)^T for A (m, m); `column` (m,) is overwritten."""
    m = column.size
    for i in range(m):
        for j in range(m):
            column[j] = A[i, j]
        turn(sisters, right, column, 0)
        for j in range(m):
            out[i, j] = column[j]
    for j in range(m):
        for i in range(m):
            column[i] = out[i, j]
        turn(sisters, left, column, 0)
        for i in range(m):
            out[i, j] = column[i]


@compiled(entry=False)
def take_power_of_turning(laws, energy, F, moved, acting, followed):
    """Add F moved - acting followed to the power put in of each law: what forces do where the planets are beyond what they do
    on the structure; all (m,)."""
    for law in range(laws.kind.size):
        for j in range(laws.first[law], laws.first[law + 1]):
            energy[ENERGIES * law + POWER_IN] += F[j] * moved[j] - acting[j] * followed[j]
