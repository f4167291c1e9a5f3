"""One pitch of a wheel as a superelement that stands on its blank: cuts, seat on the blank, and flank.

The pitch reaches down to a circle, at most to the inside of the rim. There it is not held: the circle follows the seat, quadratic
shape functions over the angle of a pitch, in polar components, which are alike in all pitches. Below it the blank is a body
of revolution (`blank_section`), and `wheel_compliance` joins both.

Along the face there are two models. Layers of hexahedra, as for all teeth in space. Or, for a spur pair whose load is even along
the face, Legendre polynomials P_k of t = 2 z / b in place of layers,
    u_x, u_y = sum_k P_k(t) u_k(x, y),   u_z = sum_k P_k(t) w_k(x, y),
so that the section is meshed once: free end faces and a web that carries a part of the face only are in it, at nearly the cost
of a plane model. Young's modulus 1, lengths in normal modules.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.polynomial import legendre

from rotorgear.gears.tooth_fe import elasticity
from rotorgear.gears.tooth_fe.mesh import PitchMesh, scikit_fem
from rotorgear.gears.tooth_fe.sector import Frame, Sector, layered_sector, node_frames
from rotorgear.progress import Progress, silent

# Quadratic elements of the seat over one pitch.
SEATS = 2


@dataclass(frozen=True)
class WheelSector(Sector):
    """Superelement of one pitch; unknowns: left cut, right cut (in the next pitch's frame), middle of the seat, flank normals.

    The seat's end is among the unknowns of a cut.

    Attributes:
        middle: unknowns of the seat between the cuts.
        seat: (2 SEATS, s, 3) where the components (radial, tangential, axial) of the seat's s functions along the face stand: of
            its end among those of a cut, of its other nodes among the middle ones; -1 where a function has no such component.
        along: the s functions along the face at places (k,): (k, s).
        twist: angle of the teeth over the length along the axis.
    """

    middle: int
    seat: np.ndarray
    along: Callable[[np.ndarray], np.ndarray]
    twist: float


def _row_of_elements(place: np.ndarray, elements: int) -> np.ndarray:
    """Shape functions (k, 2 e + 1) of a row of e equal quadratic elements at places (k,), counted in elements."""
    element = np.clip(place.astype(int), 0, elements - 1)
    values = np.zeros((len(place), 2 * elements + 1))
    nodes = 2 * element[:, None] + np.arange(3)
    np.put_along_axis(values, nodes, elasticity.quadratic(2.0 * (place - element) - 1.0), axis=1)
    return values


def seat_shapes(share: np.ndarray) -> np.ndarray:
    """Functions (k, 2 SEATS + 1) of the seat at shares (k,) of a pitch between -1/2 and 1/2."""
    return _row_of_elements((share + 0.5) * SEATS, SEATS)


def seat_frame(mesh: PitchMesh) -> tuple[np.ndarray, np.ndarray]:
    """Values (i, 2 SEATS + 1) of the seat's functions at the inner nodes, and there the radial, clockwise and axial directions
    as columns (i, 3, 3)."""
    x, y = mesh.points[mesh.inner].T
    angle = np.arctan2(x, y)
    polar = np.tile(np.eye(3), (len(angle), 1, 1))
    polar[:, :2, :2] = np.array([[np.sin(angle), np.cos(angle)], [np.cos(angle), -np.sin(angle)]]).transpose(2, 0, 1)
    return seat_shapes(angle / mesh.pitch_angle), polar


def _frame(mesh: PitchMesh, normal: np.ndarray) -> Frame:
    """Frame of the plane's nodes with d = 1 (axial), 2 (in the plane) or 3 components, for normals (f, d) or none (0, 1)."""
    d = normal.shape[1]
    matrix = sp.lil_array(sp.block_diag(list(node_frames(mesh, normal))))

    # The inner circle follows the seat: polar components (radial, clockwise, axial) times the seat's functions.
    shapes, polar = seat_frame(mesh)
    directions = polar[:, 2:, 2:] if d == 1 else polar[:, :d, :d]
    nodes = np.concatenate([mesh.inner[: 2 * SEATS], mesh.inner[-1:]])
    for node in mesh.inner:
        matrix[d * node : d * node + d, :] = 0.0
    for node, values, frame in zip(mesh.inner, shapes, directions, strict=True):
        for seat, value in zip(nodes, values, strict=True):
            if value:
                matrix[d * node : d * node + d, d * seat : d * seat + d] = value * frame

    ends = (np.concatenate([nodes[:1], mesh.left]), np.concatenate([nodes[-1:], mesh.right]))
    cut = np.stack([elasticity.node_dofs(end, d) for end in ends])
    middle = elasticity.node_dofs(nodes[1:-1], d)
    flank = d * mesh.flank if len(normal) else np.empty(0, int)
    kept = np.concatenate([cut.ravel(), middle, flank, elasticity.node_dofs(mesh.inner, d)])
    return Frame(sp.csc_array(matrix), np.setdiff1d(np.arange(d * len(mesh.points)), kept), cut, middle, flank)


def layered_wheel(
    mesh: PitchMesh, poisson_ratio: float, width: float, layers: int, progress: Progress = silent
) -> WheelSector:
    """Superelement in layers of hexahedra, spur or helical; end faces free."""
    frame = _frame(mesh, mesh.helicoid_normal)
    base = layered_sector(mesh, poisson_ratio, width, layers, progress, frame)
    cut = len(frame.cut[0])
    middle = len(frame.middle)

    # Plane by plane, a cut begins with the seat's end, and the middle holds the seat's other nodes.
    plane = np.arange(2 * layers + 1)[:, None]
    rest = [middle * plane + 3 * node + np.arange(3) for node in range(2 * SEATS - 1)]

    def along(z: np.ndarray) -> np.ndarray:
        return _row_of_elements(0.5 * (np.clip(2.0 * z / width, -1.0, 1.0) + 1.0) * layers, layers)

    return WheelSector(
        **vars(base),
        middle=len(plane) * middle,
        seat=np.stack([cut * plane + np.arange(3), *rest]),
        along=along,
        twist=mesh.twist,
    )


def even_wheel(mesh: PitchMesh, poisson_ratio: float, width: float, order: int, *, centred: bool) -> WheelSector:
    """Superelement of a spur pitch by polynomials along the face, loaded evenly along it.

    The flank's unknowns are the means of the normal displacements along the face, and their forces those of the whole face. A
    blank that is centred moves evenly in its own plane and oddly across it.
    """
    orders = np.arange(order + 1)
    in_plane = orders[::2] if centred else orders
    axial = orders[1::2] if centred else orders
    u = _frame(mesh, mesh.normal)
    w = _frame(mesh, np.empty((0, 1)))
    K = _polynomial_stiffness(mesh, poisson_ratio, width, (in_plane, axial), (u.matrix, w.matrix))

    # Unknowns order by order: those in the plane, then the axial ones.
    p = len(mesh.points)
    place_u = 2 * p * np.arange(len(in_plane))[:, None]
    place_w = 2 * p * len(in_plane) + p * np.arange(len(axial))[:, None]

    def both(of_u: np.ndarray, of_w: np.ndarray) -> np.ndarray:
        return np.concatenate([(place_u + of_u).ravel(), (place_w + of_w).ravel()])

    cuts = [both(u.cut[i], w.cut[i]) for i in range(2)]
    middle = both(u.middle, w.middle)
    flank = u.flank  # of the first polynomial, which is the mean along the face
    keep = np.concatenate([*cuts, middle, flank])
    # Normal displacements of higher polynomials, and all that is inside.
    others = (place_u[1:] + u.flank).ravel()
    inside = np.concatenate([both(u.inside, w.inside), others])

    def seats(node: int, size: tuple[int, int]) -> np.ndarray:
        """Where a node of the seat stands in its group, by polynomial and component."""
        found = np.full((order + 1, 3), -1)
        found[in_plane, :2] = size[0] * np.arange(len(in_plane))[:, None] + 2 * node + np.arange(2)
        found[axial, 2] = size[0] * len(in_plane) + size[1] * np.arange(len(axial)) + node
        return found

    end = seats(0, (len(u.cut[0]), len(w.cut[0])))
    rest = [seats(node, (len(u.middle), len(w.middle))) for node in range(2 * SEATS - 1)]

    def along(z: np.ndarray) -> np.ndarray:
        return np.asarray(legendre.legvander(np.clip(2.0 * z / width, -1.0, 1.0), order))

    return WheelSector(
        stiffness=elasticity.condensed(K, inside, keep),
        cut=len(cuts[0]),
        middle=len(middle),
        flank=len(flank),
        seat=np.stack([end, *rest]),
        along=along,
        twist=0.0,
        unknowns=len(inside) + len(keep),
    )


def _polynomial_stiffness(
    mesh: PitchMesh,
    poisson_ratio: float,
    width: float,
    powers: tuple[np.ndarray, np.ndarray],
    frames: tuple[sp.csc_array, sp.csc_array],
) -> sp.csc_array:
    """Stiffness over the face, polynomial by polynomial, for powers and frames in the plane and along the axis.

    With the plane integrals H_ij = (d_i N_a)(d_j N_b), C_i = (d_i N_a) N_b, Q = N_a N_b and those along the face
    M_kl = int P_k P_l, R_kl = int P_k P_l', T_kl = int P_k' P_l':
    u_i u_j: M (lam H_ij + mu H_ji + mu delta_ij tr H) + T mu delta_ij Q;   u_i w: R lam C_i + R^T mu C_i^T;
    w w: T (lam + 2 mu) Q + M mu tr H.
    """
    skfem = scikit_fem()
    lam, mu = elasticity.lame(poisson_ratio)
    in_plane, axial = powers
    u_frame, w_frame = frames
    basis = skfem.Basis(mesh.mesh, skfem.ElementQuad2(), intorder=4)
    p = len(mesh.points)
    nodes = elasticity.component_dofs(mesh.cells, 1)
    N = np.stack([np.broadcast_to(np.asarray(shape[0].value), basis.dx.shape) for shape in basis.basis])
    dN = np.stack([np.asarray(shape[0].grad) for shape in basis.basis])
    Q = elasticity.assembled(np.einsum("aeq,beq,eq->eab", N, N, basis.dx, optimize=True), nodes, p)
    tr_H = elasticity.assembled(np.einsum("aieq,bieq,eq->eab", dN, dN, basis.dx, optimize=True), nodes, p)
    plane = elasticity.assembled(
        elasticity.element_matrices(basis, poisson_ratio), elasticity.component_dofs(mesh.cells, 2), 2 * p
    )
    C = [
        elasticity.assembled(np.einsum("aeq,beq,eq->eab", dN[:, i], N, basis.dx, optimize=True), nodes, p)
        for i in range(2)
    ]
    # Both components of a node follow each other.
    place = [sp.csc_array((np.ones(p), (2 * np.arange(p) + i, np.arange(p))), (2 * p, p)) for i in range(2)]
    lam_C = lam * (place[0] @ C[0] + place[1] @ C[1])
    mu_C = mu * (place[0] @ C[0].T + place[1] @ C[1].T)
    Q_2 = sp.kron(Q, sp.eye_array(2))

    # Along the face, by Gauss points that are exact for the products.
    order = int(max(*in_plane, *axial))
    t, weight = legendre.leggauss(order + 2)
    P = legendre.legvander(t, order)
    slope = np.stack([legendre.legval(t, legendre.legder(row)) for row in np.eye(order + 1)], -1) * 2.0 / width
    weight = 0.5 * width * weight[:, None]
    M = P.T @ (weight * P)
    R = P.T @ (weight * slope)
    T = slope.T @ (weight * slope)

    def cut(matrix: np.ndarray, rows: np.ndarray, columns: np.ndarray) -> np.ndarray:
        values = matrix[np.ix_(rows, columns)]
        return np.where(np.abs(values) > 1e-12 * np.abs(matrix).max(), values, 0.0)

    plane = u_frame.T @ plane @ u_frame
    Q_2 = u_frame.T @ Q_2 @ u_frame
    UU = sp.kron(cut(M, in_plane, in_plane), plane) + mu * sp.kron(cut(T, in_plane, in_plane), Q_2)
    UW = sp.kron(cut(R, in_plane, axial), u_frame.T @ lam_C @ w_frame) + sp.kron(
        cut(R.T, in_plane, axial), u_frame.T @ mu_C @ w_frame
    )
    Q_w = w_frame.T @ Q @ w_frame
    tr_w = w_frame.T @ tr_H @ w_frame
    WW = (lam + 2.0 * mu) * sp.kron(cut(T, axial, axial), Q_w) + mu * sp.kron(cut(M, axial, axial), tr_w)
    return sp.csc_array(sp.block_array([[UU, UW], [UW.T, WW]]))
