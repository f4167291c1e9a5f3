"""What the compiled loops over small systems take and fill, by name, as solvers/time/arguments.py says it for the time loops.

n degrees of freedom, m local displacements ("columns"), w = BATCH systems side by side on the last axis. Loops read the fields
into variables of their own before they begin: numba reads a field anew each time it is named.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from rotorgear.solvers.time.arguments import SparseRows


class BatchSpan(NamedTuple):
    """How far a batch runs.

    Attributes:
        turns: periods of the fastest excitation in a common one; steps: steps in one of those; begun: common periods before.
        counting: whether the statistics count.
    """

    turns: int
    steps: int
    begun: int
    counting: bool


class BatchSystem(NamedTuple):
    """Matrices of all systems of a batch.

    Attributes:
        matrix: z'' from (z, z', F, 1): -K, -D, -B, f by rows, (n, 2 n + m + 1).
        across: d and d' of each column from (z, z'), (2 m, 2 n). watched: W^T by rows, (p, n).
        per_force: acceleration by a force of each column, -B, (n, m).
        rigid: orthonormal motions without strain, (r, n, w); carried: those whose speed the drive keeps, (c, n, w).
        root: S with S^T S the mean stiffness, (n, n, w).
    """

    matrix: SparseRows
    across: SparseRows
    per_force: SparseRows
    watched: SparseRows
    rigid: np.ndarray
    carried: np.ndarray
    root: np.ndarray


class ColumnValues(NamedTuple):
    """How the columns act, see columns.py.

    Attributes:
        kind, mode, jumps, counted: (m,). jumping: whether the damping of any one jumps.
        values: (m, 6) of one system, (m, 6, w) of a batch, in the order of `Columns.values`.
    """

    kind: np.ndarray
    mode: np.ndarray
    jumps: np.ndarray
    counted: np.ndarray
    jumping: bool
    values: np.ndarray


class ActingLaws(NamedTuple):
    """l laws that act by functions of their own, see kernel_laws.py; of a batch, `parameters` are (s, p) of s systems
    and `clock` is (2, w).

    Attributes:
        place: (2, l) first of the local displacements of each, and how many it takes.
        clock: (2,) radians of the reference for one of the fastest excitation, and the rad/s of that.
    """

    schedules: tuple[Any, ...]
    forces: tuple[Any, ...]
    kind: np.ndarray
    place: np.ndarray
    parameters: np.ndarray
    parameters_first: np.ndarray
    state_first: np.ndarray
    block_first: np.ndarray
    clock: np.ndarray


class BatchMotion(NamedTuple):
    """What a batch carries from step to step.

    Attributes:
        state: z and z', (2 n, w). kept: (m, 4, w) of the end of the last step, see kernel_jumps.py.
        tangents: (t, 2 n, w). last: (m, w) sides that touched last.
    """

    state: np.ndarray
    kept: np.ndarray
    tangents: np.ndarray
    last: np.ndarray


class BatchRecords(NamedTuple):
    """What is found in p common periods: growth of tangents (p, t, w) and sections (p, 2 m, w).

    So far: sums (m, 14, w), and extremes, the least and largest of the watched displacements, (2, p, w).
    """

    growth: np.ndarray
    section: np.ndarray
    sums: np.ndarray
    extremes: np.ndarray


class TangentWork(NamedTuple):
    """Arrays in which tangents are advanced.

    Attributes:
        d: (2 m, w) displacements and velocities along a tangent. blocks: (2, b, w) tangents of the laws.
        totals: (t, 2 n, w) sums of slopes. used, start: (t m, w) impulses of the damping, see kernel_jumps.py.
        done: (t m 6, w) what the contacts did in a step, see kernel_switches.py.
    """

    d: np.ndarray
    blocks: np.ndarray
    totals: np.ndarray
    used: np.ndarray
    start: np.ndarray
    done: np.ndarray


class PathSpan(NamedTuple):
    """`steps` in a period of the fastest excitation, `begun` before the first one, every `every`-th recorded."""

    steps: int
    every: int
    begun: int


class PathSystem(NamedTuple):
    """One system: K and D (n, n), B (n, m) and the constant load (n,)."""

    K: np.ndarray
    D: np.ndarray
    B: np.ndarray
    load: np.ndarray


class PathWork(NamedTuple):
    """Arrays of one system: d, d', F and its damping of each column (m, 4), state of the laws (s,), SPACE numbers for a law."""

    local: np.ndarray
    condition: np.ndarray
    space: np.ndarray
