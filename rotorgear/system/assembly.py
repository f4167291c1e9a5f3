"""Scatters element matrices through the DofMap into sparse global ones: A = T^T (sum over elements) T.

Stiffness and damping are at hand as strains and what acts on them, too: K = B^T D B, C = B^T V B + alpha M, circulatory
N = B^T Z B. A form y^T K x taken as (B y)^T D (B x) keeps its relative accuracy for motions that hardly strain stiff parts, where
y^T (K x) with the assembled K is left with rounding.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from rotorgear.elements.matrices import ElementMatrices
from rotorgear.system.dofs import INDEX, DofMap
from rotorgear.system.groups import ElementGroup

Term = Callable[[ElementGroup], np.ndarray | None]
# Values, rows and columns of a sparse matrix, (k,) each; those of one place are summed.
Entries = tuple[np.ndarray, np.ndarray, np.ndarray]


def _entries(parts: Iterable[tuple[np.ndarray, np.ndarray, np.ndarray | None]], *, zeros: bool = False) -> Entries:
    """Values, rows and columns of small matrices (e, r, c), or (1, r, c) for all e, at rows (e, r) and columns (e, c).

    Values that are zero are left out, but for `zeros`.
    """
    values = [np.zeros(0)]
    rows = [np.zeros(0, INDEX)]
    cols = [np.zeros(0, INDEX)]
    for row, col, part in parts:
        if part is None:
            continue
        shape = (len(row), row.shape[1], col.shape[1])
        values.append(np.broadcast_to(part, shape).ravel())
        rows.append(np.broadcast_to(row.astype(INDEX)[:, :, None], shape).ravel())
        cols.append(np.broadcast_to(col.astype(INDEX)[:, None, :], shape).ravel())
    value, row, col = (np.concatenate(every) for every in (values, rows, cols))
    kept = slice(None) if zeros else value != 0.0
    return value[kept], row[kept], col[kept]


def assemble(groups: Iterable[ElementGroup], dofs: DofMap, term: Term) -> sp.csc_array:
    """Return the sum over all elements of `term(group)`, each (e, d, d) or None, as a sparse (n, n)."""
    value, row, col = _entries((group.dofs, group.dofs, term(group)) for group in groups)
    if dofs.selects:
        row = dofs.column[row]
        col = dofs.column[col]
        kept = (row >= 0) & (col >= 0)
        return sp.csc_array(sp.coo_array((value[kept], (row[kept], col[kept])), shape=(dofs.n, dofs.n)))
    size = dofs.transform.shape[0]
    full = sp.csr_array(sp.coo_array((value, (row, col)), shape=(size, size)))
    return sp.csc_array(dofs.transform.T @ full @ dofs.transform)


def _strain_rows(groups: Iterable[ElementGroup]) -> tuple[list[np.ndarray], int]:
    """Numbers (e, s) of the strains of each group among those of all, and how many these are."""
    rows = []
    count = 0
    for group in groups:
        assert group.matrices.strain is not None
        e, s, _ = group.matrices.strain.shape
        rows.append(count + np.arange(e * s).reshape(e, s))
        count += e * s
    return rows, count


def strain_factor(groups: Iterable[ElementGroup], dofs: DofMap) -> sp.csr_array | None:
    """Return S, sparse (s, n), with K = S^T S, row by row from element strains; None where a modulus is not positive.

    S q has the strains of each element, so |S q|^2 is free of the cancellation in q^T K q.
    """
    stiff = [g for g in groups if g.matrices.strain is not None and g.matrices.modulus is not None]
    rows, count = _strain_rows(stiff)
    parts = []
    for group, row in zip(stiff, rows, strict=True):
        D = group.matrices.modulus
        root = None if D is None else _root(D)
        if root is None:
            return None
        parts.append((row, group.dofs, root @ group.matrices.strain))
    value, row, col = _entries(parts, zeros=True)
    full = sp.csr_array(sp.coo_array((value, (row, col)), shape=(count, dofs.transform.shape[0])))
    return sp.csr_array(full @ dofs.transform)


def without_negative(matrices: ElementMatrices) -> np.ndarray | None:
    """The stiffness B^T |D| B of elements, with the eigenvalues of each modulus without their signs; None without a modulus.

    It holds what K holds, and is positive semidefinite: undamped modes of it say which motions nothing holds.
    """
    B = matrices.strain
    D = matrices.modulus
    if B is None or D is None:
        return None
    values, vectors = np.linalg.eigh(D)
    size = np.einsum("eik,ek,ejk->eij", vectors, np.abs(values), vectors)
    return np.asarray(np.einsum("esd,est,etf->edf", B, size, B))


def _root(modulus: np.ndarray) -> np.ndarray | None:
    """R with R^T R = D for each small matrix; None where one is not positive semidefinite."""
    off_diagonal = modulus.copy()
    k = np.arange(modulus.shape[1])
    diagonal = modulus[:, k, k]
    off_diagonal[:, k, k] = 0.0
    if np.any(diagonal < 0.0):
        return None
    if not off_diagonal.any():
        return np.sqrt(diagonal)[:, :, None] * np.eye(modulus.shape[1])
    # Scaled to unit diagonal, so that stiffnesses in N/m and N m/rad do not drown each other.
    scale = np.sqrt(np.where(diagonal > 0.0, diagonal, 1.0))
    values, vectors = np.linalg.eigh(modulus / (scale[:, :, None] * scale[:, None, :]))
    if np.any(values < -1e-12):
        return None
    return np.sqrt(np.clip(values, 0.0, None))[:, :, None] * np.swapaxes(vectors, 1, 2) * scale[:, None, :]


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
        D, V, Z = (sp.csr_array(A[rows][:, rows]) for A in (self.modulus, self.viscosity, self.circulation))
        return StrainForms(sp.csr_array(B[rows]), D, V, Z)


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

    rows, count = _strain_rows(strained)

    def block(term: Term) -> sp.csr_array:
        return scattered([(row, row, term(group)) for row, group in zip(rows, strained, strict=True)], count)

    def scattered(parts: list[tuple[np.ndarray, np.ndarray, np.ndarray | None]], width: int) -> sp.csr_array:
        value, row, col = _entries(parts)
        return sp.csr_array(sp.coo_array((value, (row, col)), shape=(count, width)))

    of_dofs = [(row, group.dofs, group.matrices.strain) for row, group in zip(rows, strained, strict=True)]
    B = scattered(of_dofs, dofs.transform.shape[0]) @ dofs.transform
    return StrainForms(sp.csr_array(B), block(lambda g: g.matrices.modulus), block(viscosity), block(circulation))
