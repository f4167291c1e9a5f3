"""What the compiled loops over small systems take and fill, by name, like solvers/time/arguments.py for the time loops.

n degrees of freedom, m local displacements ("columns"), w = BATCH systems side by side on the last axis. Loops read the fields
into variables of their own before they begin: numba reads a field anew each time it is named.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from rotorgear.solvers.time.arguments import Laws, SparseRows


class BatchSystem(NamedTuple):
    """Matrices of all systems of a batch.

    Attributes:
        matrix: z'' from (z, z', F, 1): -K, -D, -B, f by rows, (n, 2 n + m + 1).
        across: d and d' of each column from (z, z'), (2 m, 2 n).
        watched: of displacements W^T, and loads, from (z, z', F, 1) by rows, (p, 2 n + m + 1); the last l of them are loads.
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


class ActingLaws(NamedTuple):
    """Laws that act by functions of their own, see kernel_laws.py.

    Attributes:
        laws: l laws; their parameters are (s, p) of s systems. place: (2, l) first of the local displacements of each, and how
        many it takes.
        clock: (2, w) radians of the reference for one of the fastest excitation, and the rad/s of that.
    """

    laws: Laws
    place: np.ndarray
    clock: np.ndarray


class BatchMotion(NamedTuple):
    """What a batch carries from step to step, and what is found in p common periods.

    Attributes:
        state: z and z', (2 n, w). kept: (m, 4, w) of the end of the last step, see kernel_jumps.py.
        tangents: (t, 2 n, w). last: (m, w) sides that touched last.
        growth: of tangents, (p, t, w), and section: (p, 2 m, w), at the end of each period.
        sums: (m, 14, w) and extremes, the least and largest of what is watched, (2, p, w), so far.
        moments: sums of the loads and of their squares, (2, l, w), so far.
    """

    state: np.ndarray
    kept: np.ndarray
    tangents: np.ndarray
    last: np.ndarray
    growth: np.ndarray
    section: np.ndarray
    sums: np.ndarray
    extremes: np.ndarray
    moments: np.ndarray


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
