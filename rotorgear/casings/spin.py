"""What rotation adds to a body that turns about z: integrals over its mesh, each the same for all three directions.

A body turns about its axis with speed W, and its displacements u(x, t) are seen from the ground, as a field over places x. What a
particle meets is D u = ∂u/∂t + W ∂u/∂θ (the derivatives of the components along x y z that stand still), so that

    ∫ ρ v · D²u dV = M ü + 2 W T u̇ - W² H u,   T_ab = ∫ ρ N_a ∂N_b/∂θ dV,   H_ab = ∫ ρ ∂N_a/∂θ ∂N_b/∂θ dV

and the stresses s of the centrifugal forces at W = 1 stiffen it by W² S, S_ab = ∫ ∇N_aᵀ s ∇N_b dV (Lamb and Southwell, Proc. R.
Soc. A 99, 1921, for a disk). For a body of revolution none of these depends on the angle that it has turned by, and for all its
rigid motions S - H vanishes. H of its modes follows from T (`casings/wheel_reduction.py`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from rotorgear.casings.assembly import Elastic
from rotorgear.casings.solid_mesh import MASS_DEGREE, STIFFNESS_DEGREE, SolidMesh

_CHUNK = 4000  # elements at a time


@dataclass(frozen=True)
class SpinIntegrals:
    """T and S (p, p) of the docstring above, for each of the three directions."""

    transport: sp.csr_array
    stress: sp.csr_array


def spin_integrals(mesh: SolidMesh, material: Elastic, stretched: np.ndarray) -> SpinIntegrals:
    """Integrate over a mesh.

    Args:
        mesh: in m, its axis of rotation z.
        material: of all of it.
        stretched: (3p,) displacements by the centrifugal forces at 1 rad/s.
    """
    shape = mesh.element
    places, weights = shape.quadrature(MASS_DEGREE)
    values, gradients = shape.shapes(places)
    stress_places, stress_weights = shape.quadrature(STIFFNESS_DEGREE)
    stress_gradients = shape.shapes(stress_places)[1]
    lame, shear = material.lame
    moved = stretched.reshape(-1, 3)
    parts: list[tuple[np.ndarray, np.ndarray]] = []
    for start in range(0, len(mesh.cells), _CHUNK):
        cells = mesh.cells[start : start + _CHUNK]
        corners = mesh.points[cells]
        volume, slopes = _slopes(corners, gradients, weights)
        x, y = np.einsum("kq,eki->ieq", values, corners[:, :, :2])
        turned = x[:, None] * slopes[:, :, 1] - y[:, None] * slopes[:, :, 0]  # ∂N/∂θ, (e, k, q)
        transport = np.einsum("aq,ebq->eab", values, turned * (material.density * volume)[:, None])
        volume, slopes = _slopes(corners, stress_gradients, stress_weights)
        strain = np.einsum("eki,ekjq->eijq", moved[cells], slopes, optimize=True)
        stress = shear * (strain + strain.transpose(0, 2, 1, 3))
        stress += lame * np.einsum("eiiq->eq", strain)[:, None, None] * np.eye(3)[:, :, None]
        pulled = np.einsum("eijq,ebjq->ebiq", stress * volume[:, None, None], slopes, optimize=True)
        k = cells.shape[1]
        flat = (len(cells), k, -1)
        stiff = np.matmul(slopes.reshape(flat), pulled.reshape(flat).transpose(0, 2, 1))
        parts.append((transport, stiff))
    rows = np.repeat(mesh.cells, mesh.cells.shape[1], axis=1).ravel()
    columns = np.tile(mesh.cells, (1, mesh.cells.shape[1])).ravel()
    size = (len(mesh.points), len(mesh.points))
    found = []
    for number in range(2):
        entries = np.concatenate([part[number].ravel() for part in parts])
        found.append(sp.csr_array(sp.coo_array((entries, (rows, columns)), shape=size)))
    return SpinIntegrals(*found)


def _slopes(corners: np.ndarray, gradients: np.ndarray, weights: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Volumes (e, q) that count for the Gauss points, and gradients (e, k, 3, q) of the shape functions in space."""
    J = np.einsum("eki,kjq->eqij", corners, gradients, optimize=True)
    slopes = np.einsum("eqji,kjq->ekiq", np.linalg.inv(J), gradients, optimize=True)
    return np.linalg.det(J) * weights, slopes
