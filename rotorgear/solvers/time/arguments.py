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


class Answer(NamedTuple):
    """What laws answer: forces (m,), tangents in d and v (sum of k*k,) and energies (4 l,); of r instants with r rows each."""

    F: np.ndarray
    Kd: np.ndarray
    Kv: np.ndarray
    energy: np.ndarray


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
    """What a run carries from step to step; see `MotionState`."""

    q: np.ndarray
    v: np.ndarray
    a: np.ndarray
    F: np.ndarray
    before: np.ndarray
    d: np.ndarray
    sums: np.ndarray
    last: np.ndarray
    events: np.ndarray
    gathered: Gathered


class Kept(NamedTuple):
    """r recorded steps: the motion, local d and F (r, m), energies of each law (r, l, 3): stored, put in, dissipated.

    The motion is q, v and a, (r, n) each; of the exponential integrator z (r, 2 nz), real parts first, r and r' (r, 2 nr), and
    u (r, m).
    """

    motion: tuple[np.ndarray, ...]
    d: np.ndarray
    F: np.ndarray
    energy: np.ndarray


class SparseRows(NamedTuple):
    """Sparse matrix: row i has `value` at `column`, from first[i] to first[i + 1]; of one by columns, those of its transpose."""

    first: np.ndarray
    column: np.ndarray
    value: np.ndarray


class Triangles(NamedTuple):
    """SuperLU's factors by columns without their diagonals, 1/diag(U), and both orders."""

    L: SparseRows
    U: SparseRows
    diagonal: np.ndarray
    row_place: np.ndarray
    column_place: np.ndarray


class Sisters(NamedTuple):
    """s sets of what equal planets have alike, N in each at most, in axes that go round with their carrier.

    Attributes:
        place: (s, N) where they stand in an array; planets: (s,) how many. ratio: (s,) of the carrier's speed to the reference.
        cosine, sine: (s, N) of the directions of the pins at the start.
    """

    place: np.ndarray
    planets: np.ndarray
    ratio: np.ndarray
    cosine: np.ndarray
    sine: np.ndarray


class NewmarkStep(NamedTuple):
    """A method of the generalised-alpha family, ready for steps of h seconds.

    Attributes:
        h: s. whole: whether forces are those of the whole step. am, af, beta, gamma: of the method.
        rotation: (3, k) see `Rotation.table`. tolerance: of the local forces.
        first, column: pattern by rows of K, D and M. load: (n,), constant. S: factored.
        Bt, Wt: B^T and W^T. P: (1 - af) S^-1 B, (n, m). channels: rows (p, n) on q, v and a, and (p, m) on the local forces.
        Ad, Av: (m, m), what a force of the step takes from d and v at its end, d = d_free - Ad F, v = v_free - Av F.
        With planets that go round, these are of the structure, where planets stand as at the start, and Av of what they see.
    """

    h: float
    whole: bool
    am: float
    af: float
    beta: float
    gamma: float
    rotation: np.ndarray
    tolerance: float
    first: np.ndarray
    column: np.ndarray
    K: np.ndarray
    D: np.ndarray
    M: np.ndarray
    load: np.ndarray
    S: Triangles
    Bt: SparseRows
    Wt: SparseRows
    P: np.ndarray
    channels: tuple[SparseRows, ...]
    Ad: np.ndarray
    Av: np.ndarray


class ExponentialStep(NamedTuple):
    """The exponential integrator, ready for steps of h seconds, in nz complex modes: real parts, then imaginary ones.

    Attributes:
        h: s. rotation: (3, k) see `Rotation.table`. tolerance: of the local forces.
        e: e^(s h), and g: of the load, (2, nz). Q: (2, m, nz) and G: e Q. C: (2, m, nz) rows that give d, then (2, p, nz) those
        that give the watched displacements and the channels. V: (2, m, nz) rows that give v.
        B: (nr, m) local displacements of motions without stiffness and damping, load: (nr,) on them; W, Wv: (nr, p), what
        watched displacements and channels get of these motions and of their velocities.
        k, c: (m, m), the linear reference k d + c v of the local forces, which the modes hold.
        Z: (m, m), turns d without the rest u of the step into d without its local forces. Ad, Av: as in `NewmarkStep`.
        Ud, Uv: (m, m), what the rest of the step adds to d and to v, by modes and rigid motions.
        watched: (p, m) what the rest of the step adds to watched displacements and channels by the modes; late: (p, m) what the
        rest at the step's end adds to channels that hold accelerations; forced: (p, m) what local forces there add.
        constant: (p,) of channels, by the load.
        With planets that go round, k and c are those of the structure, too.
    """

    h: float
    rotation: np.ndarray
    tolerance: float
    e: np.ndarray
    g: np.ndarray
    Q: np.ndarray
    G: np.ndarray
    C: np.ndarray
    V: np.ndarray
    B: np.ndarray
    load: np.ndarray
    W: np.ndarray
    Wv: np.ndarray
    k: np.ndarray
    c: np.ndarray
    Z: np.ndarray
    Ad: np.ndarray
    Av: np.ndarray
    Ud: np.ndarray
    Uv: np.ndarray
    watched: np.ndarray
    late: np.ndarray
    forced: np.ndarray
    constant: np.ndarray
