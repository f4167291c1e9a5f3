"""Groups of degrees of freedom that do not act on each other: connected components of the pattern of all matrices of an analysis.

Nothing is dropped by a threshold: any entry that is not exactly zero joins.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from rotorgear.system.system import System


def independent_groups(matrices: Iterable[sp.csc_array]) -> list[np.ndarray]:
    """Return the dofs of each independent group, largest group first; `matrices` are sparse (n, n)."""
    pattern: sp.csc_array | None = None
    for A in matrices:
        own = sp.csc_array((np.ones(A.nnz), A.indices, A.indptr), shape=A.shape)
        own.data[A.data == 0.0] = 0.0
        pattern = own if pattern is None else pattern + own
    if pattern is None:
        return []
    pattern.eliminate_zeros()
    count, label = connected_components(pattern, directed=False)
    order = np.argsort(label, kind="stable")
    groups = np.split(order, np.cumsum(np.bincount(label, minlength=count))[:-1])
    return sorted(groups, key=lambda group: (-len(group), int(group[0])))


def dof_motions(system: System) -> np.ndarray:
    """The motion of each of the n free dofs, as words; of tied dofs, that of the one it moves most."""
    words = np.array(
        ["bending", "bending", "axial", "bending", "bending", "torsion"] * len(system.nodes) + system.nodes.internal
    )
    dofs = system.dofs
    if dofs.selects:
        return np.asarray(words[dofs.column >= 0])
    rows = np.asarray(abs(dofs.transform).argmax(axis=0)).ravel()
    return np.asarray(words[rows])
