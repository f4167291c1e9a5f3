"""Compiled: the turns R(a) and T of `solvers/time/sisters.py` for all systems of a batch, row by row.

Sets of sisters come with the speed of their carrier over that of the fastest excitation, whose radian is the unit of time: the
angle of a carrier is its ratio times the time. Where no planets go round there are no sets, but None, and numba compiles
what calls these functions without a word of them. Their sums are never reordered, for they stay calls.
"""

from __future__ import annotations

import numpy as np

from rotorgear.solvers.contact.vectors import fill, get, put
from rotorgear.solvers.time.compiled import compiled


@compiled(inner=True)
def first_class(sisters, k, x, begin, stride):
    """x_c and x_s of set k among the rows of x from `begin` on, each place `stride` rows behind the one before."""
    N = sisters.planets[k]
    of_cosine = fill(0.0)
    of_sine = fill(0.0)
    for i in range(N):
        value = get(x, begin + stride * sisters.place[k, i])
        of_cosine += (2.0 / N * sisters.cosine[k, i]) * value
        of_sine += (2.0 / N * sisters.sine[k, i]) * value
    return of_cosine, of_sine


@compiled(entry=False)
def turn_rows(sisters, time, x, begin, stride):
    """Turn the rows of all sets in x by the angles of their carriers at a time; nothing else changes."""
    for k in range(sisters.planets.size):
        a = sisters.ratio[k] * time
        of_cosine, of_sine = first_class(sisters, k, x, begin, stride)
        cosine = np.cos(a) - 1.0
        sine = np.sin(a)
        change_cosine = cosine * of_cosine + sine * of_sine
        change_sine = cosine * of_sine - sine * of_cosine
        for i in range(sisters.planets[k]):
            row = begin + stride * sisters.place[k, i]
            change = sisters.cosine[k, i] * change_cosine + sisters.sine[k, i] * change_sine
            put(x, row, get(x, row) + change)


@compiled(entry=False)
def follow_planets(sisters, time, d):
    """Take displacements and velocities d (2 m, w), side by side for each column, to those that the planets see at a time."""
    for k in range(sisters.planets.size):
        W = sisters.ratio[k]
        of_cosine, of_sine = first_class(sisters, k, d, 0, 2)
        for i in range(sisters.planets[k]):
            row = 2 * sisters.place[k, i] + 1
            going = (W * sisters.sine[k, i]) * of_cosine - (W * sisters.cosine[k, i]) * of_sine
            put(d, row, get(d, row) - going)
    turn_rows(sisters, time, d, 0, 2)
    turn_rows(sisters, time, d, 1, 2)
