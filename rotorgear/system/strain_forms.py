"""Stiffness and damping as strains and what acts on them: K = B^T D B, C = B^T V B + alpha M, circulatory N = B^T Z B.

A form y^T K x taken as (B y)^T D (B x) keeps its relative accuracy for motions that hardly strain stiff parts, where y^T (K x)
with the assembled K is left with rounding.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from rotorgear.system.dofs import DofMap
from rotorgear.system.groups import ElementGroup

Local = Callable[[ElementGroup], np.ndarray | None]


@dataclass(frozen=True)
class StrainForms:
    """Strains B (s, n) of all elements, and D, V and Z (s, s), block diagonal."""

    strain: sp.csr_array
    modulus: sp.csr_array
    viscosity: sp.csr_array
    circulation: sp.csr_array

    def cut(self, dofs: np.ndarray) -> StrainForms:
        """The same for a group of dofs that no other dof acts on."""
        B = sp.csr_array(sp.csc_array(self.strain)[:, dofs])
        rows = np.flatnonzero(np.diff(B.indptr) > 0)
        return StrainForms(
            sp.csr_array(B[rows]),
            *(sp.csr_array(A[rows][:, rows]) for A in (self.modulus, self.viscosity, self.circulation)),
        )


def strain_forms(groups: Iterable[ElementGroup], dofs: DofMap, speed: float, rayleigh_beta: float) -> StrainForms:
    """Return the strains of all elements at a reference speed in rad/s."""
    strained = [group for group in groups if group.matrices.strain is not None]

    def viscosity(group: ElementGroup) -> np.ndarray | None:
        D = group.matrices.modulus
        V = group.matrices.viscosity
        if D is None or not rayleigh_beta:
            return V
        return rayleigh_beta * D if V is None else V + rayleigh_beta * D

    def circulation(group: ElementGroup) -> np.ndarray | None:
        Z = group.matrices.circulation
        per_speed = group.matrices.circulation_per_speed
        if per_speed is None or not group.spin * speed:
            return Z
        return group.spin * speed * per_speed if Z is None else Z + group.spin * speed * per_speed

    first = 0
    rows = []
    for group in strained:
        assert group.matrices.strain is not None
        e, s, _ = group.matrices.strain.shape
        rows.append(first + np.arange(e * s).reshape(e, s))
        first += e * s
    B = _scattered(
        [(r, group.dofs, group.matrices.strain) for r, group in zip(rows, strained, strict=True)],
        (first, dofs.transform.shape[0]),
    )

    def block(term: Local) -> sp.csr_array:
        return _scattered([(r, r, term(group)) for r, group in zip(rows, strained, strict=True)], (first, first))

    return StrainForms(
        sp.csr_array(B @ dofs.transform), block(lambda g: g.matrices.modulus), block(viscosity), block(circulation)
    )


def _scattered(parts: list[tuple[np.ndarray, np.ndarray, np.ndarray | None]], shape: tuple[int, int]) -> sp.csr_array:
    """Sparse matrix of the sum of small ones (e, r, c) at rows (e, r) and columns (e, c)."""
    rows = [np.zeros(0, int)]
    cols = [np.zeros(0, int)]
    values = [np.zeros(0)]
    for row, col, part in parts:
        if part is None:
            continue
        full = np.broadcast_to(part, (len(row), *part.shape[1:]))
        e, r, c = np.nonzero(full)
        rows.append(row[e, r])
        cols.append(col[e, c])
        values.append(full[e, r, c])
    triple = (np.concatenate(values), (np.concatenate(rows), np.concatenate(cols)))
    return sp.csr_array(sp.coo_array(triple, shape=shape))
