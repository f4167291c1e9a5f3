"""Groups of degrees of freedom that do not act on each other: connected components of the pattern of all matrices of an analysis.

Nothing is dropped by a threshold: any entry that is not exactly zero joins.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from rotorgear.errors import AnalysisError
from rotorgear.solvers.sparse.entries import without_zeros
from rotorgear.system.system import System


def independent_groups(matrices: Iterable[sp.csc_array]) -> list[np.ndarray]:
    """Return the dofs of each independent group, largest group first; `matrices` are sparse (n, n)."""
    pattern: sp.csr_array | None = None
    for A in matrices:
        there = without_zeros(A)
        # Ones, since values of either sign could cancel in the sum; of the mirror image, by rows, as the search takes them.
        own = sp.csr_array((np.ones(there.nnz), there.indices, there.indptr), shape=A.shape)
        if connected_components(own, directed=False, return_labels=False) == 1:
            return [np.arange(A.shape[0])]  # others can't part what one holds together
        pattern = own if pattern is None else pattern + own
    if pattern is None:
        return []
    count, label = connected_components(pattern, directed=False)
    order = np.argsort(label, kind="stable")
    groups = np.split(order, np.cumsum(np.bincount(label, minlength=count))[:-1])
    return sorted(groups, key=lambda group: (-len(group), int(group[0])))


def groups_with_inertia(
    system: System, groups: list[np.ndarray], velocity: sp.csc_array | None
) -> tuple[list[np.ndarray], tuple[str, ...]]:
    """Return the groups that have modes, and a sentence where others are left out.

    Springs hold what has no inertia at all, such as the end of a motor that nobody weighed: it only follows, and has no modes.
    A group that springs do not hold stays, for the eigensolver to refuse.

    Args:
        system: with its mass and stiffness.
        groups: of dofs that do not act on each other.
        velocity: terms of damping and gyroscopic moments, sparse (n, n), if there are any.

    Raises:
        AnalysisError: dampers act on a group without inertia; its motion would decay without any modal mass.
    """
    moving = []
    still: list[str] = []
    mass = system.mass.diagonal()
    for group in groups:
        has_modes = bool(np.any(mass[group] > 0.0))
        if not has_modes:
            held = np.linalg.eigvalsh(system.stiffness()[group][:, group].toarray())
            has_modes = held[0] <= 1e-13 * held[-1]
        if has_modes:
            moving.append(group)
            continue
        names = system.dofs.describe_some(group.tolist(), system.nodes)
        if velocity is not None and velocity[group].nnz:
            raise AnalysisError(f"dampers but no inertia: {names}; give the body there inertia or no dampers")
        still.append(names)
    return moving, (f"modes of what has stiffness but no inertia: {'; '.join(still)}",) if still else ()


def dof_motions(system: System) -> np.ndarray:
    """The motion of each of the n free dofs, as words; of tied dofs, that of the one it moves most."""
    words = np.array(
        ["bending", "bending", "axial", "bending", "bending", "torsion"] * len(system.nodes) + system.nodes.internal
    )
    dofs = system.dofs
    if dofs.selects:
        return np.asarray(words[dofs.column >= 0])
    return np.asarray(words[np.asarray(abs(dofs.transform).argmax(axis=0)).ravel()])
