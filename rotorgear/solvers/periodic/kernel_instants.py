"""Compiled: all laws at many instants of one motion."""

from __future__ import annotations

import numpy as np

from rotorgear.solvers.time.arguments import Answer
from rotorgear.solvers.time.compiled import compiled
from rotorgear.solvers.time.kernel_contact import force_all, schedule_all


@compiled
def laws_at(laws, instants, answer):
    """Fill the answer of all laws, r rows, at r instants with d and v (r, m)."""
    state = np.zeros(laws.state_first[-1])
    for i in range(instants.angle.size):
        schedule_all(laws, instants.angle[i], instants.speed[i], instants.time[i], state)
        force_all(
            laws,
            state,
            instants.d[i],
            instants.v[i],
            Answer(answer.F[i], answer.Kd[i], answer.Kv[i], answer.energy[i]),
        )


@compiled
def motion_at(real, imaginary, w, phase, d, v):
    """Fill d and v (m,) of the coefficients (H + 1, m) at one phase w t."""
    d[:] = 0.0
    v[:] = 0.0
    for h in range(real.shape[0]):
        c = np.cos(h * phase)
        s = np.sin(h * phase)
        for j in range(d.size):
            d[j] += real[h, j] * c - imaginary[h, j] * s
            v[j] -= h * w * (real[h, j] * s + imaginary[h, j] * c)


@compiled
def switches_in(laws, real, imaginary, w, speed, spacing, cells, index, bisections, beside, theta, instants, answer):
    """Bisect for the switch of law index[e] in each cell, and fill the answers beside it: at -1, -2, 1 and 2 times `beside`."""
    m = real.shape[1]
    state = np.zeros(laws.state_first[-1])
    blocks = laws.block_first[-1]
    own = Answer(np.zeros(m), np.zeros(blocks), np.zeros(blocks), np.zeros(4 * laws.kind.size))
    d = np.zeros(m)
    v = np.zeros(m)
    e = cells.size
    for i in range(e):
        low = 0.0
        high = 1.0
        begin = 0.0
        for k in range(bisections + 1):
            middle = 0.0 if k == 0 else 0.5 * (low + high)
            phase = (cells[i] + middle) * spacing
            motion_at(real, imaginary, w, phase, d, v)
            schedule_all(laws, speed * phase / w, speed, phase / w, state)
            force_all(laws, state, d, v, own)
            side = own.energy[4 * index[i] + 3]
            if k == 0:
                begin = side
            elif side == begin:
                low = middle
            else:
                high = middle
        theta[i] = 0.5 * (low + high)
        for k in range(4):
            away = (-1.0, -2.0, 1.0, 2.0)[k] * beside
            phase = (cells[i] + theta[i] + away) * spacing
            row = k * e + i
            motion_at(real, imaginary, w, phase, instants.d[row], instants.v[row])
            schedule_all(laws, speed * phase / w, speed, phase / w, state)
            force_all(
                laws,
                state,
                instants.d[row],
                instants.v[row],
                Answer(answer.F[row], answer.Kd[row], answer.Kv[row], answer.energy[row]),
            )
