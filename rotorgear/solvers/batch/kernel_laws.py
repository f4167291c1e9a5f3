"""Compiled: force laws that run one system at a time: rolling elements, friction, torques over speed.

The laws work in SI: displacements of the systems are metres already, velocities are multiplied and forces divided by powers of
the rad/s of the fastest excitation, whose radian is the unit of time of a batch. There are as many rows of parameters as systems;
places of the batch beyond them repeat the last system, and take its answers over.
"""

from __future__ import annotations

from rotorgear.solvers.batch.kernel_parts import SIDE
from rotorgear.solvers.contact.vectors import fill, get, put
from rotorgear.solvers.time.compiled import compiled

_MOST_COMPONENTS = 6
# Numbers that a law with this many components c needs beside its state: d, v, F, both tangents and four energies.
SPACE = 3 * _MOST_COMPONENTS + 2 * _MOST_COMPONENTS**2 + 4


@compiled(inner=True)
def schedule_laws(acting, time, state):
    """Fill the state (w, s) of the laws of all systems at a time in radians of the fastest excitation."""
    laws = acting.laws
    schedules = laws.schedules
    kind = laws.kind
    parameters = laws.parameters
    parameters_first = laws.parameters_first
    state_first = laws.state_first
    clock = acting.clock
    for w in range(parameters.shape[0] if kind.size else 0):
        angle = time * clock[0, w]
        speed = clock[1, w] * clock[0, w]
        for i in range(kind.size):
            schedules[kind[i]](
                angle,
                speed,
                time / clock[1, w],
                parameters[w, parameters_first[i] : parameters_first[i + 1]],
                state[w, state_first[i] : state_first[i + 1]],
            )


@compiled(inner=True)
def force_laws(acting, state, d, F, found, tangents, work):
    """Forces of the laws to F (m, w), their tangents in displacement and velocity to tangents (2, b, w), and the sides
    that touch to found (m, 4, w).

    work: SPACE numbers.
    """
    laws = acting.laws
    forces = laws.forces
    kind = laws.kind
    place = acting.place
    parameters = laws.parameters
    parameters_first = laws.parameters_first
    state_first = laws.state_first
    block_first = laws.block_first
    clock = acting.clock
    systems = parameters.shape[0]
    for i in range(kind.size):
        a = place[0, i]
        k = place[1, i]
        own_d = work[:k]
        own_v = work[k : 2 * k]
        own_f = work[2 * k : 3 * k]
        rest = work[3 * k :]
        in_d = rest[: k * k]
        in_v = rest[k * k : 2 * k * k]
        energy = rest[2 * k * k : 2 * k * k + 4]
        for w in range(systems):
            rate = clock[1, w]
            for j in range(k):
                own_d[j] = d[2 * (a + j), w]
                own_v[j] = rate * d[2 * (a + j) + 1, w]
            forces[kind[i]](
                parameters[w, parameters_first[i] : parameters_first[i + 1]],
                state[w, state_first[i] : state_first[i + 1]],
                own_d,
                own_v,
                own_f,
                in_d,
                in_v,
                energy,
            )
            for j in range(k):
                F[a + j, w] = own_f[j] / (rate * rate)
                found[a + j, SIDE, w] = energy[3]
            for j in range(k * k):
                tangents[0, block_first[i] + j, w] = in_d[j] / (rate * rate)
                tangents[1, block_first[i] + j, w] = in_v[j] / rate
        for w in range(systems, F.shape[1]):
            for j in range(k):
                F[a + j, w] = F[a + j, systems - 1]
                found[a + j, SIDE, w] = found[a + j, SIDE, systems - 1]
            for j in range(k * k):
                tangents[0, block_first[i] + j, w] = tangents[0, block_first[i] + j, systems - 1]
                tangents[1, block_first[i] + j, w] = tangents[1, block_first[i] + j, systems - 1]


@compiled(fast=True, inner=True)
def laws_along(acting, tangents, d, out, at):
    """Forces of the laws along a tangent's displacements and velocities d (2 m, w), to the rows of out from `at` on."""
    kind = acting.laws.kind
    place = acting.place
    block_first = acting.laws.block_first
    size = tangents.shape[1]
    for i in range(kind.size):
        a = place[0, i]
        k = place[1, i]
        for r in range(k):
            total = fill(0.0)
            for c in range(k):
                p = block_first[i] + r * k + c
                total += get(tangents, p) * get(d, 2 * (a + c)) + get(tangents, size + p) * get(d, 2 * (a + c) + 1)
            put(out, at + a + r, total)
