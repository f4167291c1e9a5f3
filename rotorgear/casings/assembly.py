"""Stiffness and consistent mass of a mesh of quadratic solids.

    K_ab = ∫ λ ∇N_a ∇N_bᵀ + μ ∇N_b ∇N_aᵀ + μ (∇N_a · ∇N_b) I dV        M_ab = ρ ∫ N_a N_b dV · I

with Lamé's λ and μ of an isotropic material: 3 x 3 blocks for pairs of nodes a, b. All blocks follow from G_ab = ∫ ∇N_a ∇N_bᵀ.
The blocks are summed on the graph of nodes, which the order of the factorisation is found on too.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from rotorgear.casings.solid_mesh import MASS_DEGREE, STIFFNESS_DEGREE, SolidMesh, in_space

_CHUNK = 4000  # elements at a time: some ten MB of gradients


@dataclass(frozen=True)
class Elastic:
    """An isotropic material: Young's modulus in Pa, Poisson's ratio, density in kg/m^3."""

    youngs_modulus: float
    poisson_ratio: float
    density: float

    @property
    def lame(self) -> tuple[float, float]:
        """Lamé's λ and μ in Pa."""
        shear = self.youngs_modulus / (2.0 * (1.0 + self.poisson_ratio))
        return 2.0 * shear * self.poisson_ratio / (1.0 - 2.0 * self.poisson_ratio), shear


@dataclass(frozen=True)
class Assembled:
    """K (3p, 3p) in 3 x 3 blocks, three dofs x y z a node; and the mass (p, p) of each of the three directions."""

    stiffness: sp.bsr_array
    mass: sp.csr_array

    def times_mass(self, columns: np.ndarray) -> np.ndarray:
        """M U for U (3p, k)."""
        nodes = self.mass.shape[0]
        return np.asarray(self.mass @ columns.reshape(nodes, -1)).reshape(columns.shape)


def assemble(mesh: SolidMesh, material: Elastic) -> Assembled:
    """Assemble a mesh."""
    shape = mesh.element
    nodes = len(mesh.points)
    cells = mesh.cells
    k = cells.shape[1]
    pairs = (cells[:, :, None] * nodes + cells[:, None, :]).ravel()
    keys, inverse = np.unique(pairs, return_inverse=True)
    del pairs
    rows = keys // nodes
    columns = (keys % nodes).astype(np.int32)
    starts = np.searchsorted(rows, np.arange(nodes + 1)).astype(np.int32)
    lame, shear = material.lame
    stiff_places, stiff_weights = shape.quadrature(STIFFNESS_DEGREE)
    stiff_gradients = shape.shapes(stiff_places)[1]
    mass_places, mass_weights = shape.quadrature(MASS_DEGREE)
    mass_values, mass_gradients = shape.shapes(mass_places)
    blocks = np.zeros((len(keys), 3, 3))
    masses = np.zeros(len(keys))
    products = (mass_values[:, None, :] * mass_values[None, :, :]).reshape(k * k, -1)
    for start in range(0, len(cells), _CHUNK):
        some = mesh.points[cells[start : start + _CHUNK]]
        where = inverse[start * k * k : (start + len(some)) * k * k]
        volume, gradients = in_space(some, stiff_gradients, stiff_weights)
        # Each gradient times √(w det J), so that one product of matrices integrates.
        weighted = (gradients * np.sqrt(volume)[:, :, None, None]).reshape(len(some), -1, k * 3)
        G = np.matmul(weighted.transpose(0, 2, 1), weighted).reshape(-1, k, 3, k, 3).transpose(0, 1, 3, 2, 4)
        G = G.reshape(-1, 3, 3)
        trace = shear * np.trace(G, axis1=1, axis2=2)
        for i in range(3):
            for j in range(3):
                entry = lame * G[:, i, j] + shear * G[:, j, i] + (trace if i == j else 0.0)
                blocks[:, i, j] += np.bincount(where, entry, len(keys))
        volume = np.linalg.det(np.einsum("eki,kjq->eqij", some, mass_gradients, optimize=True)) * mass_weights
        masses += np.bincount(where, (volume @ products.T).ravel(), len(keys))
    stiffness = sp.bsr_array((blocks, columns, starts), shape=(3 * nodes, 3 * nodes))
    return Assembled(stiffness, sp.csr_array((material.density * masses, columns, starts), shape=(nodes, nodes)))
