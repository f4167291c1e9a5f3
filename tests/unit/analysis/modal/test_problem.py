"""The eigenproblem of a group of dofs: the rows and columns of these dofs, whatever else is stored."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import scipy.sparse as sp

from rotorgear.analysis.modal.problem import Problem
from rotorgear.system.system import System
from tests.overhung import overhung_disk


def with_stored_zeros(A: sp.csc_array, rows: np.ndarray, columns: np.ndarray) -> sp.csc_array:
    """The same matrix with zeros kept at some places, as sums that cancel leave them."""
    coo = sp.coo_array(A)
    data = np.append(coo.data, np.zeros(len(rows)))
    return sp.csc_array((data, (np.append(coo.row, rows), np.append(coo.col, columns))), shape=A.shape)


def test_a_group_has_its_own_rows_and_columns_with_and_without_zeros_that_are_stored_beside_it() -> None:
    system = System(overhung_disk())
    problem = Problem.at(system, 300.0)
    n = problem.M.shape[0]
    group = np.arange(n)[::3]
    others = np.setdiff1d(np.arange(n), group)
    # Dofs that nothing couples to the rest, but for the zeros.
    apart = np.ix_(others, group)
    parts = {}
    for name in ("M", "D", "K", "inertial"):
        dense = getattr(problem, name).toarray()
        dense[apart] = 0.0
        dense[np.ix_(group, others)] = 0.0
        parts[name] = with_stored_zeros(sp.csc_array(dense), others[:4], group[:4])
        assert parts[name].nnz > np.count_nonzero(dense)
    whole = replace(problem, K_symmetric=parts["K"], strain=None, **parts)
    found = whole.cut(group)
    for name, matrix in parts.items():
        cut = getattr(found, name)
        assert cut.indices.min(initial=0) >= 0
        np.testing.assert_array_equal(cut.toarray(), matrix.toarray()[np.ix_(group, group)])
    assert whole.cut(np.arange(n)) is whole
