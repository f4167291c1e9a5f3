"""Compiled: evaluation of local laws, and the forces of one implicit step.

At the end of a step d = d_free - Ad F and v = v_free - Av F, with m x m compliances of the step; F follows from F = law(d, v), or
from the potential over the whole step. Newton's method is exact after one linear solution for laws that are piecewise linear. Its
steps are shortened until the residual falls. Where that does not help, forces are found one by one: with the others held,
law(d(F_i)) - F_i falls with F_i at least as fast as -F_i, so the root lies between F_i and the answer of the law, and bisection
always ends there (Gauss and Seidel's method, which converges for potentials that are convex).

The force of a whole step does exactly the work by which the potential changes,

    F = F(d_m, w) + lambda w/|w|^2,   d_m = (d_0 + d_1)/2,  w = (d_1 - d_0)/h,   lambda = [V(d_1) - V(d_0)]/h - dV(d_m)[w]

with all that depends on time taken at the middle of the step (Gonzalez's discrete gradient). F w = dV/h + dissipation - power put
in: with equations of motion that hold in the mean over a step, energy is kept, or dissipated, whatever the step, also where sides
meet and part. lambda vanishes where V is quadratic between d_0 and d_1; it is not smaller than rounding where it counts.
What a law answers gives dV(d_m)[w] = F w + P_in - P_diss at w less the same at rest: the rate of V that no motion makes.
Simo and Tarnow, ZAMP 43 (1992) 757; Gonzalez, J. Nonlinear Science 6 (1996) 449; Laursen and Chawla, Int. J. Numer. Methods
Eng. 40 (1997) 863.
"""

from __future__ import annotations

import numpy as np

from rotorgear.solvers.time.arguments import Answer, ContactWork
from rotorgear.solvers.time.compiled import compiled, force_function, schedule_function
from rotorgear.solvers.time.kernel_time import DISSIPATED, ENERGIES, POWER_IN, SIDE, STORED

_EPS = 2.220446049250313e-16
_ROUNDING = 16.0 * _EPS
# Of Newton's method: solutions, and halvings of one; then rounds over all forces one by one, and bisections of one.
_ITERATIONS = 40
_HALVINGS = 5
_ROUNDS = 400
_BISECTIONS = 80
FAILED = -1
NOT_FINITE = -2


@compiled(entry=False)
def all_straight(laws, work):
    """Whether no law needs more than its force half way: all are apart, or touch by one and the same spring, over the step."""
    middle = work.answer
    for law in range(laws.kind.size):
        if not laws.conserves[law]:
            continue
        side = middle.energy[ENERGIES * law + SIDE]
        if side != work.begun.energy[ENERGIES * law + SIDE] or side != work.ended.energy[ENERGIES * law + SIDE]:
            return False
        for p in range(laws.block_first[law], laws.block_first[law + 1]):
            if middle.Kd[p] != work.begun.Kd[p] or middle.Kd[p] != work.ended.Kd[p]:
                return False
    return True


@compiled(entry=False)
def whole_step(laws, work, h):
    """Turn the answer half way into that of the whole step, for laws whose stored energy is their potential.

    `unmoved` are the answers half way at rest, `begun` and `ended` those at both ends of the step in the same state; the side
    that touches is that of the end. Returns how far the rounding of the energies moves the forces.
    """
    answer = work.answer
    uncertain = 0.0
    energy = answer.energy
    rest = work.unmoved.energy
    begun = work.begun.energy
    ended = work.ended.energy
    for law in range(laws.kind.size):
        if not laws.conserves[law]:
            continue
        a = laws.first[law]
        b = laws.first[law + 1]
        e = ENERGIES * law
        energy[e + SIDE] = ended[e + SIDE]
        square = 0.0
        along = 0.0
        size = 0.0
        for i in range(a, b):
            square += work.v[i] * work.v[i]
            along += answer.F[i] * work.v[i]
            size += abs(answer.F[i] * work.v[i])
        moving = energy[e + POWER_IN] - energy[e + DISSIPATED]
        held = rest[e + POWER_IN] - rest[e + DISSIPATED]
        lacks = (ended[e + STORED] - begun[e + STORED]) / h - (along + moving - held)
        for which in (POWER_IN, DISSIPATED):
            size += abs(energy[e + which]) + abs(rest[e + which])
        size += (abs(ended[e + STORED]) + abs(begun[e + STORED])) / h
        lost = _ROUNDING * size
        if square == 0.0 or abs(lacks) <= lost:
            continue
        # What rounding may have made of nothing is taken off, so that the force is continuous where the correction sets in.
        lacks -= lost if lacks > 0.0 else -lost
        uncertain = max(uncertain, lost / np.sqrt(square))
        for i in range(a, b):
            answer.F[i] += lacks * work.v[i] / square
        if b - a == 1:
            # F = dV/dd of one displacement grows by [V'(d_1) - dV/dd]/dd; V' at the end has the damper's share in it, as F has.
            block = laws.block_first[law]
            change = work.v[a] * h
            steeper = (work.ended.F[a] - answer.F[a]) / change
            steepest = max(answer.Kd[block], work.ended.Kd[block], work.begun.Kd[block])
            answer.Kd[block] = max(min(2.0 * steeper, steepest), 0.0)
    return uncertain


@schedule_function
def no_schedule(angle, speed, time, parameters, state):
    """Nothing depends on time."""


@force_function
def no_force(parameters, state, d, v, force, in_d, in_v, energy):
    """No force."""


@compiled(entry=False)
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


@compiled(entry=False)
def force_all(laws, state, d, v, answer, conserving=False):
    """Fill the answer of all laws to d and v (m,), or of those alone whose stored energy is their potential (`conserving`)."""
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
        if conserving and not laws.conserves[i]:
            continue
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
def evaluate_instants(schedules, forces, parameters, state, angle, speed, time, d, v, answer):
    """Fill the answer of one law, the first of the functions, to d and v (r, k) at r instants."""
    for i in range(angle.size):
        schedules[0](angle[i], speed[i], time[i], parameters, state)
        forces[0](parameters, state, d[i], v[i], answer.F[i], answer.Kd[i], answer.Kv[i], answer.energy[i])


@compiled(entry=False)
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


@compiled(entry=False)
def blank_answer(laws):
    """Arrays for an answer of all laws."""
    m = laws.first[-1]
    blocks = laws.block_first[-1]
    return Answer(np.zeros(m), np.zeros(blocks), np.zeros(blocks), np.zeros(ENERGIES * laws.kind.size))


@compiled(entry=False)
def contact_work(laws):
    """Arrays for `contact_step`."""
    m = laws.first[-1]
    return ContactWork(
        np.zeros(laws.state_first[-1]),
        np.empty(m),
        np.empty(m),
        np.empty(m),
        np.empty(m),
        blank_answer(laws),
        np.empty(m),
        np.empty(m),
        np.empty((m, m)),
        np.empty(m),
        np.empty(m),
        np.zeros(m),
        blank_answer(laws),
        blank_answer(laws),
        blank_answer(laws),
    )


@compiled(entry=False)
def answer_to(laws, Ad, Av, work, F, h):
    """Fill d, v and the answer of the laws to forces F: at the step's end, or of the whole step of h > 0.

    Returns the largest difference between answer and F, its bound by rounding, and the largest force; NaN where one is none.
    """
    d = work.d
    v = work.v
    d_free = work.d_free
    answer = work.answer
    m = F.size
    floor = 0.0
    for i in range(m):
        x = d_free[i]
        for j in range(m):
            x -= Ad[i, j] * F[j]
        d[i] = x
    if h > 0.0:
        for i in range(m):
            v[i] = (d[i] - work.begin[i]) / h
            work.middle[i] = 0.5 * (d[i] + work.begin[i])
        force_all(laws, work.state, work.middle, v, answer)
        force_all(laws, work.state, d, v, work.ended, True)
        if not all_straight(laws, work):
            force_all(laws, work.state, work.middle, work.zeros, work.unmoved, True)
            floor = whole_step(laws, work, h)
    else:
        for i in range(m):
            y = work.v_free[i]
            for j in range(m):
                y -= Av[i, j] * F[j]
            v[i] = y
        force_all(laws, work.state, d, v, answer)
    size = 0.0
    worst = 0.0
    for i in range(m):
        work.step[i] = answer.F[i] - F[i]
        if not np.isfinite(work.step[i]):
            return np.nan, 0.0, 0.0
        size = max(size, abs(answer.F[i]))
        worst = max(worst, abs(work.step[i]))
    first = laws.first
    for law in range(laws.kind.size):
        a = first[law]
        k = first[law + 1] - a
        block = laws.block_first[law]
        for i in range(k):
            rounding = 0.0
            for j in range(k):
                reach = abs(d_free[a + j]) + abs(d[a + j])
                Kd = abs(answer.Kd[block + i * k + j]) + abs(work.ended.Kd[block + i * k + j])
                rounding += Kd * (reach + laws.extents[a + j])
                if h > 0.0:
                    rounding += abs(answer.Kv[block + i * k + j]) * reach / h
            floor = max(floor, 8.0 * _EPS * rounding)
    return worst, floor, size


@compiled(entry=False)
def contact_step(laws, Ad, Av, work, F, tolerance, h):
    """Find F with F = law(d_free - Ad F, v_free - Av F), from the guess in F; d, v and the answer in `work` are filled.

    With h > 0, F are the forces of the whole step from work.begin on. Returns the number of linear solutions, or FAILED or
    NOT_FINITE.
    """
    kind = laws.kind
    answer = work.answer
    Kd = answer.Kd
    Kv = answer.Kv
    step = work.step
    guess = work.guess
    J = work.J
    first = laws.first
    block_first = laws.block_first
    m = F.size
    per_d = 0.5 if h > 0.0 else 1.0
    worst, floor, size = answer_to(laws, Ad, Av, work, F, h)
    for iteration in range(_ITERATIONS):
        if np.isnan(worst):
            return NOT_FINITE
        if worst <= tolerance * size + floor:
            for i in range(m):
                F[i] = answer.F[i]
            return iteration
        for i in range(m):
            for j in range(m):
                J[i, j] = 1.0 if i == j else 0.0
        for law in range(kind.size):
            a = first[law]
            k = first[law + 1] - first[law]
            for i in range(k):
                for r in range(k):
                    kd = per_d * Kd[block_first[law] + i * k + r]
                    kv = Kv[block_first[law] + i * k + r]
                    if kd != 0.0 or kv != 0.0:
                        for j in range(m):
                            by_v = Ad[a + r, j] / h if h > 0.0 else Av[a + r, j]
                            J[a + i, j] += kd * Ad[a + r, j] + kv * by_v
        if not solve_small(J, step, m):
            break
        last = worst
        for i in range(m):
            guess[i] = F[i]
            J[0, i] = step[i]  # the direction: step is filled anew with each residual
            F[i] += step[i]
        worst, floor, size = answer_to(laws, Ad, Av, work, F, h)
        share = 1.0
        for _ in range(_HALVINGS):
            # The first solutions may overshoot: from one side of a kink to the other they end the iteration.
            if iteration < 4 or worst < last or worst <= tolerance * size + floor:
                break
            share *= 0.5
            for i in range(m):
                F[i] = guess[i] + share * J[0, i]
            worst, floor, size = answer_to(laws, Ad, Av, work, F, h)
    return one_by_one(laws, Ad, Av, work, F, tolerance, h)


@compiled(entry=False)
def one_by_one(laws, Ad, Av, work, F, tolerance, h):
    """The forces of `contact_step` one after the other, by bisection."""
    m = F.size
    for i in range(m):
        if not np.isfinite(F[i]):
            F[i] = 0.0
    for number in range(_ROUNDS):
        worst, floor, size = answer_to(laws, Ad, Av, work, F, h)
        if np.isnan(worst):
            return NOT_FINITE
        if worst <= tolerance * size + floor:
            for i in range(m):
                F[i] = work.answer.F[i]
            return _ITERATIONS + number
        moved = 0.0
        for i in range(m):
            answer_to(laws, Ad, Av, work, F, h)
            low = F[i]
            old = low
            gap = work.step[i]
            high = low + gap
            for _ in range(_BISECTIONS):
                middle = 0.5 * (low + high)
                if middle in (low, high):
                    break
                F[i] = middle
                answer_to(laws, Ad, Av, work, F, h)
                if (work.step[i] > 0.0) == (gap > 0.0):
                    low = middle
                else:
                    high = middle
            F[i] = 0.5 * (low + high)
            moved = max(moved, abs(F[i] - old))
        # A damper that sets in over less than the rounding of d jumps: its force lies within the jump, and no answer meets it.
        if moved <= tolerance * size + floor:
            answer_to(laws, Ad, Av, work, F, h)
            return _ITERATIONS + number
    return FAILED
