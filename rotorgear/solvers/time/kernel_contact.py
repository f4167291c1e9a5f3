"""Compiled: evaluation of local laws, and Newton's method for the forces of one implicit step.

At the end of a step d = d_free - Ad F and v = v_free - Av F, with m x m compliances of the step; F follows from
F = law(d, v). The iteration is exact after one linear solution for laws that are piecewise linear.
"""

from __future__ import annotations

import numpy as np

from rotorgear.solvers.time.arguments import Answer, ContactWork
from rotorgear.solvers.time.compiled import compiled, force_function, schedule_function

# Where a law's four energies stand.
STORED, POWER_IN, DISSIPATED, SIDE = range(4)
ENERGIES = 4
_EPS = 2.220446049250313e-16
_ITERATIONS = 60
FAILED = -1
NOT_FINITE = -2


@schedule_function
def no_schedule(angle, speed, time, parameters, state):
    """Nothing depends on time."""


@force_function
def no_force(parameters, state, d, v, force, in_d, in_v, energy):
    """No force."""


@compiled
def schedule_all(laws, angle, speed, time, state):
    """Fill the state of all laws at a time."""
    schedules = laws.schedules
    kind = laws.kind
    parameters = laws.parameters
    parameters_first = laws.parameters_first
    state_first = laws.state_first
    for i in range(kind.size):
        schedules[kind[i]](
            angle,
            speed,
            time,
            parameters[parameters_first[i] : parameters_first[i + 1]],
            state[state_first[i] : state_first[i + 1]],
        )


@compiled
def force_all(laws, state, d, v, answer):
    """Fill the answer of all laws to d and v (m,)."""
    forces = laws.forces
    kind = laws.kind
    first = laws.first
    parameters = laws.parameters
    parameters_first = laws.parameters_first
    state_first = laws.state_first
    block_first = laws.block_first
    F = answer.F
    Kd = answer.Kd
    Kv = answer.Kv
    energy = answer.energy
    for i in range(kind.size):
        a = first[i]
        b = first[i + 1]
        p = block_first[i]
        q = block_first[i + 1]
        forces[kind[i]](
            parameters[parameters_first[i] : parameters_first[i + 1]],
            state[state_first[i] : state_first[i + 1]],
            d[a:b],
            v[a:b],
            F[a:b],
            Kd[p:q],
            Kv[p:q],
            energy[ENERGIES * i : ENERGIES * (i + 1)],
        )


@compiled
def evaluate_instants(schedules, forces, parameters, state, instants, answer):
    """Fill the answer of one law, the first of the functions, to d and v at r instants."""
    for i in range(instants.angle.size):
        schedules[0](instants.angle[i], instants.speed[i], instants.time[i], parameters, state)
        forces[0](
            parameters,
            state,
            instants.d[i],
            instants.v[i],
            answer.F[i],
            answer.Kd[i],
            answer.Kv[i],
            answer.energy[i],
        )


@compiled
def take_account(energy, h, carried):
    """Sum up energies put in and dissipated; count steps on the front side, apart and on the back, and contact losses."""
    sums = carried.sums
    last = carried.last
    events = carried.events
    for law in range(last.size):
        sums[law, 0] += h * energy[ENERGIES * law + POWER_IN]
        sums[law, 1] += h * energy[ENERGIES * law + DISSIPATED]
        now = int(energy[ENERGIES * law + SIDE])
        if now > 0:
            events[law, 0] += 1
        elif now < 0:
            events[law, 2] += 1
        else:
            events[law, 1] += 1
            if last[law] != 0:
                events[law, 3] += 1
        last[law] = now


@compiled
def widen(extremes, i, value):
    """Take a displacement into its least and largest value so far."""
    if value < extremes[i, 0]:
        extremes[i, 0] = value
    if value > extremes[i, 1]:
        extremes[i, 1] = value


@compiled
def record_forces(r, h, work, carried, kept):
    """Record local displacements, forces and energies, whose sums follow the trapezoidal rule."""
    kept.d[r] = work.d
    kept.F[r] = carried.F
    energy = work.answer.energy
    for law in range(carried.last.size):
        kept.energy[r, law, 0] = energy[ENERGIES * law + STORED]
        kept.energy[r, law, 1] = carried.sums[law, 0] - 0.5 * h * energy[ENERGIES * law + POWER_IN]
        kept.energy[r, law, 2] = carried.sums[law, 1] - 0.5 * h * energy[ENERGIES * law + DISSIPATED]


@compiled
def solve_small(A, b, n):
    """Solve A x = b in place by Gauss with row exchanges; False where A is singular."""
    for k in range(n):
        pivot = abs(A[k, k])
        row = k
        for i in range(k + 1, n):
            if abs(A[i, k]) > pivot:
                pivot = abs(A[i, k])
                row = i
        if pivot == 0.0:
            return False
        if row != k:
            for j in range(k, n):
                A[k, j], A[row, j] = A[row, j], A[k, j]
            b[k], b[row] = b[row], b[k]
        for i in range(k + 1, n):
            factor = A[i, k] / A[k, k]
            if factor != 0.0:
                for j in range(k + 1, n):
                    A[i, j] -= factor * A[k, j]
                b[i] -= factor * b[k]
    for k in range(n - 1, -1, -1):
        for j in range(k + 1, n):
            b[k] -= A[k, j] * b[j]
        b[k] /= A[k, k]
    return True


@compiled
def contact_work(laws, m):
    """Arrays for `contact_step`."""
    blocks = laws.block_first[-1]
    return ContactWork(
        np.zeros(laws.state_first[-1]),
        np.empty(m),
        np.empty(m),
        np.empty(m),
        np.empty(m),
        Answer(np.empty(m), np.zeros(blocks), np.zeros(blocks), np.zeros(ENERGIES * laws.kind.size)),
        np.empty(m),
        np.empty((m, m)),
    )


@compiled
def contact_step(laws, compliance, work, F, tolerance):
    """Find F with F = law(d_free - Ad F, v_free - Av F), from the guess in F; d, v and the answer in `work` are filled.

    Returns the number of linear solutions, or FAILED or NOT_FINITE.
    """
    kind = laws.kind
    Ad = compliance.Ad
    Av = compliance.Av
    d_free = work.d_free
    v_free = work.v_free
    d = work.d
    v = work.v
    state = work.state
    answer = work.answer
    trial = answer.F
    Kd = answer.Kd
    Kv = answer.Kv
    step = work.step
    J = work.J
    first = laws.first
    block_first = laws.block_first
    m = F.size
    last = np.inf
    share = 1.0
    for iteration in range(_ITERATIONS):
        for i in range(m):
            x = d_free[i]
            y = v_free[i]
            for j in range(m):
                x -= Ad[i, j] * F[j]
                y -= Av[i, j] * F[j]
            d[i] = x
            v[i] = y
        force_all(laws, state, d, v, answer)
        size = 0.0
        worst = 0.0
        floor = 0.0
        for i in range(m):
            step[i] = trial[i] - F[i]
            if not np.isfinite(step[i]):
                return NOT_FINITE
            size = max(size, abs(trial[i]))
            worst = max(worst, abs(step[i]))
        for law in range(kind.size):
            k = first[law + 1] - first[law]
            for i in range(k):
                rounding = 0.0
                for j in range(k):
                    rounding += abs(Kd[block_first[law] + i * k + j]) * (
                        abs(d_free[first[law] + j]) + abs(d[first[law] + j])
                    )
                floor = max(floor, 8.0 * _EPS * rounding)
        if worst <= tolerance * size + floor:
            for i in range(m):
                F[i] = trial[i]
            return iteration
        # A full step that does not bring the residual down again and again runs in a circle: shorten it.
        if iteration >= 5:
            share = 0.5 * share if worst >= last else min(1.0, 1.5 * share)
            share = max(share, 0.02)
        last = worst
        for i in range(m):
            for j in range(m):
                J[i, j] = 1.0 if i == j else 0.0
        for law in range(kind.size):
            a = first[law]
            k = first[law + 1] - first[law]
            for i in range(k):
                for r in range(k):
                    kd = Kd[block_first[law] + i * k + r]
                    kv = Kv[block_first[law] + i * k + r]
                    if kd != 0.0 or kv != 0.0:
                        for j in range(m):
                            J[a + i, j] += kd * Ad[a + r, j] + kv * Av[a + r, j]
        if not solve_small(J, step, m):
            return FAILED
        for i in range(m):
            F[i] += share * step[i]
    return FAILED
