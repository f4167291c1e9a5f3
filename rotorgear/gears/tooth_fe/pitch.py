"""One whole pitch of a gear with all its nodes: stiffness, frames at its cuts, and stresses from displacements.

A helical pitch is a stack of equal layers, each turned by z tan(b_b)/r_b against the middle of the face. Lengths in normal
modules, Young's modulus 1.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import scipy.sparse as sp

from rotorgear.gears.tooth_fe.elasticity import assembled, component_dofs, element_matrices, lame
from rotorgear.gears.tooth_fe.mesh import PitchMesh, scikit_fem
from rotorgear.gears.tooth_fe.sector import clockwise, layer_mesh


@dataclass(frozen=True)
class Pitch:
    """All nodes of a pitch, plane by plane along the face (one plane for a spur gear in plane strain).

    Attributes:
        points: (n, d).
        cells: (c, e, k) nodes of the elements of each layer, in scikit-fem's order.
        stiffness: sparse (d n, d n).
        inner: nodes on the inner circle, plane by plane as in the plane mesh; so are the next three.
        left: nodes on the left cut.
        right: nodes on the right cut.
        flank: nodes on the loaded involute.
        fillet: nodes of the fillet and half the root on the loaded side.
        normal: (f, d) outward at the flank.
        turn: (planes, d, d) rotation of each plane against the middle of the face.
        layer_turn: (c, d, d) rotation of each layer against the first one.
        pitch_turn: (d, d) rotation of the next pitch.
        poisson_ratio: of the material.
        basis: of one layer, at its nodes.
    """

    points: np.ndarray
    cells: np.ndarray
    stiffness: sp.csc_array
    inner: np.ndarray
    left: np.ndarray
    right: np.ndarray
    flank: np.ndarray
    fillet: np.ndarray
    normal: np.ndarray
    turn: np.ndarray
    layer_turn: np.ndarray
    pitch_turn: np.ndarray
    poisson_ratio: float
    basis: Any = field(repr=False, compare=False)

    @property
    def dimension(self) -> int:
        """2 or 3."""
        return self.points.shape[1]

    def in_tooth(self, u: np.ndarray, ahead: int = 0) -> np.ndarray:
        """Displacements of nodes in the tooth's frame from those in the frames of their planes, plane by plane.

        Those of the right cut are given in the frames of the pitch `ahead`, which is 1.
        """
        turn = self.turn @ self.pitch_turn if ahead else self.turn
        return np.einsum("pij,pnj->pni", turn, u.reshape(len(turn), -1, self.dimension)).ravel()

    def stress(self, displacement: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Equivalent stress (von Mises) and largest principal one (n,), means of the elements that meet at a node."""
        lam, mu = lame(self.poisson_ratio)
        d = self.dimension
        n = len(self.points)
        gradients = np.stack([np.asarray(shape[0].grad) for shape in self.basis.basis])  # (k, d, e, q)
        mises = np.zeros(n)
        largest = np.zeros(n)
        count = np.zeros(n)
        for cells, turn in zip(self.cells, self.layer_turn, strict=True):
            u = displacement[cells] @ turn  # into the frame of the first layer
            du = np.einsum("kieq,ekj->eqij", gradients, u)
            strain = np.zeros((*du.shape[:2], 3, 3))  # plane strain has stress along the face too: always 3 x 3
            strain[..., :d, :d] = 0.5 * (du + du.swapaxes(-1, -2))
            trace = np.trace(strain, axis1=-2, axis2=-1)
            stress = 2.0 * mu * strain + lam * trace[..., None, None] * np.eye(3)
            deviator = stress - np.trace(stress, axis1=-2, axis2=-1)[..., None, None] / 3.0 * np.eye(3)
            np.add.at(mises, cells, np.sqrt(1.5 * np.sum(deviator**2, axis=(-2, -1))))
            np.add.at(largest, cells, np.linalg.eigvalsh(stress)[..., -1])
            np.add.at(count, cells, 1.0)
        return mises / count, largest / count


def whole_pitch(mesh: PitchMesh, poisson_ratio: float, width: float, layers: int) -> Pitch:
    """A pitch of face `width` in so many layers; 0 layers: plane strain, unit width."""
    skfem = scikit_fem()
    p = len(mesh.points)
    d = 3 if layers else 2

    # Fillet: from the foot of the involute down the loaded column, then along the root to the cut.
    low, high = mesh.tooth_rows
    column = mesh.loaded_column
    inside = (mesh.lattice[:, 0] == column) & (mesh.lattice[:, 1] >= low) & (mesh.lattice[:, 1] <= high)
    fillet = np.flatnonzero(inside | ((mesh.lattice[:, 1] == low) & (mesh.lattice[:, 0] >= column)))

    # Planes and layers turn with the helix about the middle of the face; quadratic elements have a plane in their middle.
    if layers:
        height = width / layers
        elements, place_of = layer_mesh(mesh, height)
        basis, at_nodes = _bases(elements, skfem.ElementHex2())
        first = place_of[elements.dofs.element_dofs].T
        z = 0.5 * height * np.arange(2 * layers + 1) - 0.5 * width
    else:
        height = 0.0
        basis, at_nodes = _bases(mesh.mesh, skfem.ElementQuad2())
        first = mesh.cells.T
        z = np.zeros(1)
    number = np.arange(layers or 1)
    cells = first[None] + 2 * p * number[:, None, None]
    turn = np.array([clockwise(mesh.twist * h, d) for h in z])
    layer_turn = turn[0] @ np.array([clockwise(mesh.twist * height * i, d) for i in number])
    points = np.einsum("pij,nj->pni", turn[:, :2, :2], mesh.points)
    if layers:
        points = np.concatenate([points, np.broadcast_to(z[:, None, None], (*points.shape[:2], 1))], -1)
    points = points.reshape(-1, d)

    # Every layer has the element matrices of the first one, turned: K = R K_1 R^T node by node.
    e, k = first.shape
    blocks = element_matrices(basis, poisson_ratio).reshape(e, k, d, k, d)
    K = sp.csc_array((d * len(points), d * len(points)))
    for of_layer, R in zip(cells, layer_turn, strict=True):
        turned = np.einsum("ij,eajbl,ml->eaibm", R, blocks, R, optimize=True).reshape(e, d * k, d * k)
        K = K + assembled(turned, component_dofs(of_layer.T, d), d * len(points))

    def planes(nodes: np.ndarray) -> np.ndarray:
        return np.asarray((nodes[None] + p * np.arange(len(z))[:, None]).ravel())

    return Pitch(
        points=points,
        cells=cells,
        stiffness=K,
        inner=planes(mesh.inner),
        left=planes(mesh.left),
        right=planes(mesh.right),
        flank=planes(mesh.flank),
        fillet=planes(fillet),
        normal=np.einsum("pij,nj->pni", turn, mesh.helicoid_normal if layers else mesh.normal).reshape(-1, d),
        turn=turn,
        layer_turn=layer_turn,
        pitch_turn=clockwise(mesh.pitch_angle, d),
        poisson_ratio=poisson_ratio,
        basis=at_nodes,
    )


def _bases(mesh: Any, element: Any) -> tuple[Any, Any]:
    """Scalar bases with Gauss points, and with the nodes of the element as points."""
    skfem = scikit_fem()
    places = np.array(element.doflocs, float).T
    at_nodes = skfem.Basis(mesh, element, quadrature=(places, np.ones(places.shape[1])))
    return skfem.Basis(mesh, element, intorder=4), at_nodes
