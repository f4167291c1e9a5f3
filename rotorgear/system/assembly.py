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


def assemble(groups: Iterable[ElementGroup], dofs: DofMap, term: Term) -> sp.csc_array:
    """Return the sum over all elements of `term(group)`, each (e, d, d) or None, as a sparse (n, n)."""
    rows = []
    cols = []
    values = []
    for group in groups:
        block = term(group)
        if block is None:
            continue
        numbers = group.dofs.astype(INDEX)
        d = numbers.shape[1]
        rows.append(np.repeat(numbers, d, axis=1).ravel())
        cols.append(np.tile(numbers, (1, d)).ravel())
        values.append(block.ravel())
    if not rows:
        return sp.csc_array((dofs.n, dofs.n))
    row = np.concatenate(rows)
    col = np.concatenate(cols)
    value = np.concatenate(values)
    nonzero = value != 0.0
    row = row[nonzero]
    col = col[nonzero]
    value = value[nonzero]
    if dofs.selects:
        row = dofs.column[row]
        col = dofs.column[col]
        kept = (row >= 0) & (col >= 0)
        return sp.csc_array(sp.coo_array((value[kept], (row[kept], col[kept])), shape=(dofs.n, dofs.n)))
    size = dofs.transform.shape[0]
    full = sp.csr_array(sp.coo_array((value, (row, col)), shape=(size, size)))
    return sp.csc_array(dofs.transform.T @ full @ dofs.transform)


def strain_factor(groups: Iterable[ElementGroup], dofs: DofMap) -> sp.csr_array | None:
    """Return S, sparse (s, n), with K = S^T S, row by row from element strains; None where a modulus is not positive.

    S q has the strains of each element, so |S q|^2 is free of the cancellation in q^T K q.
    """
    rows = []
    cols = []
    values = []
    first = 0
    for group in groups:
        strain = group.matrices.strain
        modulus = group.matrices.modulus
        if strain is None or modulus is None:
            continue
        root = _root(modulus)
        if root is None:
            return None
        factor = root @ strain
        e, s, d = factor.shape
        number = np.arange(first, first + e * s, dtype=INDEX).reshape(e, s, 1)
        rows.append(np.broadcast_to(number, (e, s, d)).ravel())
        cols.append(np.broadcast_to(group.dofs.astype(INDEX)[:, None, :], (e, s, d)).ravel())
        values.append(factor.ravel())
        first += e * s
    size = dofs.transform.shape[0]
    if not rows:
        return sp.csr_array((0, dofs.n))
    triple = (np.concatenate(values), (np.concatenate(rows), np.concatenate(cols)))
    full = sp.csr_array(sp.coo_array(triple, shape=(first, size)))
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
