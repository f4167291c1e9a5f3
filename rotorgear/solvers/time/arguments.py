"""What the compiled time loops take and fill, by name: numba reads named tuples of arrays, numbers and compiled functions.

The types are part of what numba compiles for: arrays are contiguous and writable always, so that each loop is compiled once.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np


class Laws(NamedTuple):
    """l laws side by side; see `LocalForces`, whose arrays these are."""

    schedules: tuple[Any, ...]
    forces: tuple[Any, ...]
    kind: np.ndarray
    first: np.ndarray
    parameters: np.ndarray
    parameters_first: np.ndarray
    state_first: np.ndarray
    block_first: np.ndarray
    conserves: np.ndarray
    extents: np.ndarray


class Instants(NamedTuple):
    """r instants at which one law is evaluated: angle and speed of the reference and time (r,), d and v (r, k)."""

    angle: np.ndarray
    speed: np.ndarray
    time: np.ndarray
    d: np.ndarray
    v: np.ndarray


class Answer(NamedTuple):
    """What laws answer: forces (m,), tangents in d and v (sum of k*k,) and energies (4 l,); of instants with r rows each."""

    F: np.ndarray
    Kd: np.ndarray
    Kv: np.ndarray
    energy: np.ndarray


class Compliance(NamedTuple):
    """What a local force of the step's end takes from d and v there: d = d_free - Ad F, v = v_free - Av F; (m, m)."""

    Ad: np.ndarray
    Av: np.ndarray


class ContactWork(NamedTuple):
    """Arrays in which the forces of a step are found.

    Attributes:
        state: (s,) of the laws, filled for the step. d_free, v_free: (m,) at its end without local forces.
        d, v: (m,) there with them; v is the mean velocity where forces are those of a whole step. answer: of the laws.
        guess, step: (m,) and J: (m, m) of Newton's method. begin: (m,) displacements at the step's begin; middle: half way.
        zeros: (m,), velocities at rest. unmoved, begun, ended: answers at rest in the middle, at the begin and at the end of the
        step, all in the state of the step.
    """

    state: np.ndarray
    d_free: np.ndarray
    v_free: np.ndarray
    d: np.ndarray
    v: np.ndarray
    answer: Answer
    guess: np.ndarray
    step: np.ndarray
    J: np.ndarray
    begin: np.ndarray
    middle: np.ndarray
    zeros: np.ndarray
    unmoved: Answer
    begun: Answer
    ended: Answer


class Span(NamedTuple):
    """`steps` steps of h seconds after the `begun` first ones, every `every`-th recorded."""

    steps: int
    every: int
    begun: int
    h: float


class Turning(NamedTuple):
    """Prescribed rotation of the reference: speeds and angles at times, (k,); see solvers/time/local_system.py."""

    times: np.ndarray
    speeds: np.ndarray
    angles: np.ndarray


class Gathered(NamedTuple):
    """Statistics of g quantities over the steps that count; see solvers/time/kernel_time.py.

    Attributes:
        recent: (g, 3) values at the last three steps, oldest first. level: (g,) that sums are taken about.
        sums: (g, 3) over the steps of x - level, of its square, and of the negative part of x.
        extremes: (g, 2) least and largest. steps: (1,) number of steps that count.
    """

    recent: np.ndarray
    level: np.ndarray
    sums: np.ndarray
    extremes: np.ndarray
    steps: np.ndarray


class Carried(NamedTuple):
    """What the local forces carry from step to step; see `State`."""

    F: np.ndarray
    before: np.ndarray
    d: np.ndarray
    sums: np.ndarray
    last: np.ndarray
    events: np.ndarray
    gathered: Gathered


class Kept(NamedTuple):
    """r recorded steps: q, v, a (r, n), local d and F (r, m), energies of each law (r, l, 3): stored, put in, dissipated."""

    q: np.ndarray
    v: np.ndarray
    a: np.ndarray
    d: np.ndarray
    F: np.ndarray
    energy: np.ndarray


class Weights(NamedTuple):
    """The four numbers of a generalised-alpha method."""

    am: float
    af: float
    beta: float
    gamma: float


class SparseRows(NamedTuple):
    """Sparse matrix: row i has `value` at `column`, from first[i] to first[i + 1]."""

    first: np.ndarray
    column: np.ndarray
    value: np.ndarray


class Structure(NamedTuple):
    """K, D and M in one pattern by rows, first (n + 1,) and column, and the constant load (n,)."""

    first: np.ndarray
    column: np.ndarray
    K: np.ndarray
    D: np.ndarray
    M: np.ndarray
    load: np.ndarray


class Observing(NamedTuple):
    """Rows of p channels on q, v, a (p, n) and on the local forces (p, m)."""

    q: SparseRows
    v: SparseRows
    a: SparseRows
    F: SparseRows


class Triangles(NamedTuple):
    """SuperLU's factors by columns (first, row, value) without their diagonals, 1/diag(U), and both orders."""

    Lp: np.ndarray
    Li: np.ndarray
    Lx: np.ndarray
    Up: np.ndarray
    Ui: np.ndarray
    Ux: np.ndarray
    diagonal: np.ndarray
    row_place: np.ndarray
    column_place: np.ndarray


class NewmarkStep(NamedTuple):
    """Of one step: S factored, B^T and W^T by rows, P = S^-1 B (n, m), the compliance, and rows of the channels."""

    S: Triangles
    Bt: SparseRows
    Wt: SparseRows
    P: np.ndarray
    compliance: Compliance
    observing: Observing


class Motion(NamedTuple):
    """Displacements, velocities and accelerations, (n,)."""

    q: np.ndarray
    v: np.ndarray
    a: np.ndarray


class ModalStep(NamedTuple):
    """Of one step in nz complex modes, real and imaginary parts.

    Attributes:
        er, ei: e^(s h), (nz,). Gr, Gi: e Q, (m, nz). gr, gi: of the load, (nz,). Qr, Qi: Q, (m, nz).
        Cr, Ci: (m, nz) rows that give d, then (p, nz) those that give the watched displacements and the channels.
        Vr, Vi: (m, nz) rows that give v.
    """

    er: np.ndarray
    ei: np.ndarray
    Gr: np.ndarray
    Gi: np.ndarray
    gr: np.ndarray
    gi: np.ndarray
    Qr: np.ndarray
    Qi: np.ndarray
    Cr: np.ndarray
    Ci: np.ndarray
    Vr: np.ndarray
    Vi: np.ndarray


class RigidStep(NamedTuple):
    """Motions without stiffness and damping: local displacements of each (nr, m), what p watched displacements and channels get
    of the motions and of their velocities (nr, p), and loads (nr,)."""

    B: np.ndarray
    W: np.ndarray
    Wv: np.ndarray
    load: np.ndarray


class Reference(NamedTuple):
    """The linear reference k d + c v of the local forces, (m, m), which the modes hold.

    Attributes:
        Z: (m, m), turns d without the rest u of the step into d without its local forces.
        A: (m, m), what the rest of the step adds to d, and Av to v, by modes and rigid motions.
        watched: (p, m) what the rest of the step adds to watched displacements and channels by the modes; late: (p, m) what the
        rest at the step's end adds to channels that hold accelerations; forced: (p, m) what local forces there add.
        constant: (p,) of channels, by the load.
    """

    Z: np.ndarray
    compliance: Compliance
    A: np.ndarray
    Av: np.ndarray
    k: np.ndarray
    c: np.ndarray
    watched: np.ndarray
    late: np.ndarray
    forced: np.ndarray
    constant: np.ndarray


class ModalMotion(NamedTuple):
    """y = z - Q u (nz,), motions without stiffness r and their rates (nr,), and the rest u (m,) of local forces."""

    yr: np.ndarray
    yi: np.ndarray
    r0: np.ndarray
    r1: np.ndarray
    u: np.ndarray


class ModalKept(NamedTuple):
    """Recorded z (r, 2 nz), real parts first, r and r' (r, 2 nr), and u (r, m)."""

    z: np.ndarray
    rigid: np.ndarray
    u: np.ndarray
