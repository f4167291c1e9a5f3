"""Compiled: all laws at many instants of one motion."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from rotorgear.solvers.time.arguments import Answer
from rotorgear.solvers.time.compiled import compiled
from rotorgear.solvers.time.kernel_contact import contact_work, force_all, schedule_all
from rotorgear.solvers.time.kernel_time import ENERGIES, SIDE

# Changes of piece that are looked for in one cell.
MOST_IN_CELL = 6


class Harmonic(NamedTuple):
    """A motion by coefficients (H + 1, m) in real and imaginary parts; frequency, speed and spacing of instants in phase."""

    real: np.ndarray
    imaginary: np.ndarray
    w: float
    speed: float
    spacing: float


@compiled
def laws_at(laws, speed, t, d, v, answer):
    """Fill the answer of all laws, r rows, at times t (r,) with d and v (r, m), at a constant speed of the reference."""
    state = np.zeros(laws.state_first[-1])
    for i in range(t.size):
        schedule_all(laws, speed * t[i], speed, t[i], state)
        row = Answer(answer.F[i], answer.Kd[i], answer.Kv[i], answer.energy[i])
        force_all(laws, state, d[i], v[i], row)


@compiled(entry=False)
def motion_at(real, imaginary, w, phase, d, v):
    """Fill d and v (m,) of the coefficients (H + 1, m) at one phase w t."""
    d[:] = 0.0
    v[:] = 0.0
    # cos(h p), sin(h p) by the addition theorem.
    c1 = np.cos(phase)
    s1 = np.sin(phase)
    c = 1.0
    s = 0.0
    for h in range(real.shape[0]):
        for j in range(d.size):
            d[j] += real[h, j] * c - imaginary[h, j] * s
            v[j] -= h * w * (real[h, j] * s + imaginary[h, j] * c)
        c, s = c * c1 - s * s1, s * c1 + c * s1


@compiled(entry=False)
def law_at(laws, motion, phase, law, full, work):
    """Fill the answers of all laws at one phase, and tell which smooth piece of its force the law with this number is on.

    Pieces are told apart by the side that touches, by whether the law answers to a small motion, which one does not that has let
    go, and by whether its damping is all there, `full` being what that is.
    """
    motion_at(motion.real, motion.imaginary, motion.w, phase, work.d, work.v)
    schedule_all(laws, motion.speed * phase / motion.w, motion.speed, phase / motion.w, work.state)
    force_all(laws, work.state, work.d, work.v, work.answer)
    holds = 0.0
    damping = 0.0
    for i in range(laws.block_first[law], laws.block_first[law + 1]):
        damping += work.answer.Kv[i]
        if work.answer.Kd[i] != 0.0 or work.answer.Kv[i] != 0.0:
            holds = 1.0
    piece = 4.0 * work.answer.energy[ENERGIES * law + SIDE] + holds
    return piece + 2.0 if damping >= full else piece


@compiled
def switches_in(laws, motion, cells, index, full, bisections, beside):
    """Find where law index[e] comes from one piece to another in each cell, one after the other, and its answers beside.

    Returns:
        Of e switches, MOST_IN_CELL a cell at most: cell and law, theta in the cell (e,), and the answers at -1, -2, 1 and 2 times
        `beside` from it, F (4, e, m), Kd and Kv (4, e, blocks).
    """
    room = MOST_IN_CELL * cells.size
    cell = np.zeros(room, np.int64)
    switching = np.zeros(room, np.int64)
    place = np.zeros(room)
    F = np.zeros((4, room, laws.first[-1]))
    Kd = np.zeros((4, room, laws.block_first[-1]))
    Kv = np.zeros((4, room, laws.block_first[-1]))
    work = contact_work(laws)
    number = 0
    for i in range(cells.size):
        law = index[i]
        begin = cells[i] * motion.spacing
        piece = law_at(laws, motion, begin, law, full[law], work)
        last = law_at(laws, motion, begin + motion.spacing, law, full[law], work)
        low = 0.0
        for _ in range(MOST_IN_CELL):
            if piece == last:
                break
            high = 1.0
            following = last
            for _ in range(bisections):
                middle = 0.5 * (low + high)
                now = law_at(laws, motion, begin + middle * motion.spacing, law, full[law], work)
                if now == piece:
                    low = middle
                else:
                    high = middle
                    following = now
            theta = 0.5 * (low + high)
            cell[number] = cells[i]
            switching[number] = law
            place[number] = theta
            for k in range(4):
                away = (-1.0, -2.0, 1.0, 2.0)[k] * beside
                law_at(laws, motion, begin + (theta + away) * motion.spacing, law, full[law], work)
                F[k, number] = work.answer.F
                Kd[k, number] = work.answer.Kd
                Kv[k, number] = work.answer.Kv
            number += 1
            piece = following
            low = high
    return cell[:number], switching[:number], place[:number], F[:, :number], Kd[:, :number], Kv[:, :number]
