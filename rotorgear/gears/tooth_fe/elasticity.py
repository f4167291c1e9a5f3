"""Element matrices of isotropic linear elasticity, their assembly and condensation, and quadratic shape functions on a line.

With H_ab^ij = integral of (d_i N_a) (d_j N_b):  K_(ai)(bj) = lambda H_ab^ij + mu H_ab^ji + mu delta_ij sum_k H_ab^kk.
Young's modulus is 1; two dimensions mean plane strain of unit thickness. Reference: any text on finite elements.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu


def lame(poisson_ratio: float) -> tuple[float, float]:
    """lambda and mu for a Young's modulus of 1."""
    nu = poisson_ratio
    return nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), 0.5 / (1.0 + nu)


def element_matrices(basis: Any, poisson_ratio: float) -> np.ndarray:
    """Stiffness of all elements of a scalar basis, (e, n d, n d); the d components of a node follow each other."""
    lam, mu = lame(poisson_ratio)
    grads = np.stack([np.asarray(shape[0].grad) for shape in basis.basis])  # (n, d, e, q)
    n, d, e, q = grads.shape
    # H as one product of matrices an element, summed over the quadrature points: BLAS does it.
    flat = np.ascontiguousarray(grads.transpose(2, 0, 1, 3)).reshape(e, n * d, q)
    H = ((flat * basis.dx[:, None, :]) @ flat.transpose(0, 2, 1)).reshape(e, n, d, n, d)
    trace = np.einsum("eaibi->eab", H)
    K = lam * H + mu * H.transpose(0, 1, 4, 3, 2)
    for i in range(d):
        K[:, :, i, :, i] += mu * trace
    return np.asarray(K.reshape(e, n * d, n * d))


def component_dofs(cells: np.ndarray, dimension: int) -> np.ndarray:
    """Degrees of freedom (e, n d) of elements with nodes (n, e): those of a node follow each other."""
    return np.asarray((dimension * cells.T[:, :, None] + np.arange(dimension)).reshape(cells.shape[1], -1))


def node_dofs(nodes: np.ndarray, dimension: int) -> np.ndarray:
    """Degrees of freedom (n d,) of nodes (n,), those of a node one after the other."""
    return np.asarray((dimension * nodes[:, None] + np.arange(dimension)).ravel())


def assembled(elements: np.ndarray, dofs: np.ndarray, size: int) -> sp.csc_array:
    """Sum of element matrices (e, n, n) on their degrees of freedom (e, n), sparse (size, size)."""
    n = dofs.shape[1]
    rows = np.repeat(dofs, n, axis=1).ravel()
    return sp.csc_array(sp.coo_array((elements.ravel(), (rows, np.tile(dofs, n).ravel())), (size, size)))


def factorised(K: sp.csc_array) -> Any:
    """Sparse factorisation of a symmetric matrix: minimum degree on its own pattern, which pivots on the diagonal keep."""
    return splu(sp.csc_matrix(K), permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})


def condensed(K: sp.csc_array, inside: np.ndarray, keep: np.ndarray) -> np.ndarray:
    """Stiffness of a sparse K in the kept unknowns, those inside being eliminated: K_kk - K_ki K_ii^-1 K_ik."""
    couple = K[inside][:, keep].toarray()
    S = K[keep][:, keep].toarray() - couple.T @ factorised(K[inside][:, inside]).solve(couple)
    return np.asarray(0.5 * (S + S.T))


def quadratic(t: np.ndarray) -> np.ndarray:
    """The three quadratic shape functions (..., 3) at places between -1 and 1."""
    return np.stack([0.5 * t * (t - 1.0), 1.0 - t * t, 0.5 * t * (t + 1.0)], -1)


def with_middles(knots: np.ndarray) -> np.ndarray:
    """Knots with the middle of each interval between them: the nodes of a line of quadratic elements."""
    nodes = np.empty(2 * len(knots) - 1)
    nodes[::2] = knots
    nodes[1::2] = 0.5 * (knots[1:] + knots[:-1])
    return nodes
