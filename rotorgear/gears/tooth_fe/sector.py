"""One pitch of a gear as a superelement: its stiffness at the two cuts to its neighbours and along the loaded flank.

All pitches of a gear are the same body turned by 2 pi / z, and all layers of a helical one are the same body turned by
z tan(b_b) / r_b. With the displacements of each node in the frame of its own pitch and layer, every pitch and every layer has
the same matrix, so one layer is assembled, stacked along the face by static condensation (exact, K_rr - K_ri K_ii^-1 K_ir), and
the pitches are chained in `gear_compliance`. Nodes on the inner circle are held. Young's modulus 1, lengths in normal modules.
Reference: Guyan/Irons static condensation; Przemieniecki, Theory of Matrix Structural Analysis, chapter 9.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp

from rotorgear.gears.tooth_fe.elasticity import assembled, component_dofs, element_matrices, node_dofs
from rotorgear.gears.tooth_fe.mesh import PitchMesh, scikit_fem
from rotorgear.progress import Progress, silent

# Above this many unknowns a plane pitch is condensed by a sparse factorisation instead of a dense one.
_DENSE_LIMIT = 3000


@dataclass(frozen=True)
class Sector:
    """Superelement of one pitch; unknowns: left cut, right cut (in the next pitch's frame), flank normals.

    The flank unknowns are displacements along the outward normal, ordered plane by plane, within a plane by roll length.

    Attributes:
        stiffness: (n, n), condensed.
        cut: unknowns of one cut.
        flank: unknowns of the flank.
        unknowns: degrees of freedom before condensation.
    """

    stiffness: np.ndarray
    cut: int
    flank: int
    unknowns: int


def clockwise(angle: float, dimension: int) -> np.ndarray:
    """Matrix (d, d) of a clockwise rotation about z, 2 or 3 dimensions."""
    c = np.cos(angle)
    s = np.sin(angle)
    R = np.eye(dimension)
    R[:2, :2] = [[c, s], [-s, c]]
    return R


def plane_sector(mesh: PitchMesh, poisson_ratio: float) -> Sector:
    """Superelement of a spur pitch in plane strain, unit width."""
    skfem = scikit_fem()
    K_e = element_matrices(skfem.Basis(mesh.mesh, skfem.ElementQuad2(), intorder=4), poisson_ratio)
    frame = held_frame(mesh, mesh.normal)
    inside = frame.inside
    keep = frame.keep
    K = sp.csc_array(
        frame.matrix.T @ assembled(K_e, component_dofs(mesh.cells, 2), 2 * len(mesh.points)) @ frame.matrix
    )
    A = K[inside][:, inside]
    B = K[inside][:, keep].toarray()
    D = K[keep][:, keep].toarray()
    if len(inside) <= _DENSE_LIMIT:
        condensed = _condensed(np.block([[A.toarray(), B], [B.T, D]]), len(inside))
    else:
        # Minimum degree on A + A^T: A is symmetric, and its pivots on the diagonal keep that pattern.
        condensed = D - B.T @ sp.linalg.splu(sp.csc_matrix(A), permc_spec="MMD_AT_PLUS_A").solve(B)
    return Sector(0.5 * (condensed + condensed.T), len(frame.cut[0]), len(frame.flank), len(inside) + len(keep))


def layered_sector(
    mesh: PitchMesh,
    poisson_ratio: float,
    width: float,
    layers: int,
    progress: Progress = silent,
    frame: Frame | None = None,
) -> Sector:
    """Superelement of a pitch of face width `width` (normal modules) in layers of hexahedra; end faces free.

    Its inner circle is held where no other `frame` is given.
    """
    frame = frame or held_frame(mesh, mesh.helicoid_normal)
    K = layer_stiffness(mesh, poisson_ratio, width / layers, frame.matrix)
    groups = [len(group) for group in (*frame.cut, frame.middle, frame.flank)]
    S = stacked_layers(K, frame.inside, frame.keep, layers, groups, progress)
    planes = 2 * layers + 1
    return Sector(S, planes * groups[0], planes * groups[3], planes * (len(frame.inside) + len(frame.keep)))


def layer_stiffness(mesh: PitchMesh, poisson_ratio: float, height: float, frame: sp.csc_array) -> sp.csc_array:
    """Stiffness of one layer in the unknowns of its three planes, each turned with the helix: all layers have the same."""
    skfem = scikit_fem()
    hexes, place_of = layer_mesh(mesh, height)
    K_e = element_matrices(skfem.Basis(hexes, skfem.ElementHex2(), intorder=4), poisson_ratio)
    K = assembled(K_e, component_dofs(place_of[hexes.dofs.element_dofs], 3), 9 * len(mesh.points))
    turn = [
        sp.csc_array(sp.kron(sp.eye_array(len(mesh.points)), clockwise(mesh.twist * h, 3))) @ frame
        for h in (0.0, 0.5 * height, height)
    ]
    T = sp.block_diag(turn, format="csc")
    return sp.csc_array(T.T @ K @ T)


def layer_mesh(mesh: PitchMesh, height: float) -> tuple[Any, np.ndarray]:
    """One layer of quadratic hexahedra, and the place of each of its nodes: plane by plane, there as in the plane mesh."""
    skfem = scikit_fem()
    quads = mesh.mesh.t
    corners = 1 + int(quads.max())  # the corners come first among the nodes
    flat = mesh.lattice[:corners].T.astype(float)
    ends = np.hstack([np.vstack([flat, np.full((1, corners), z)]) for z in (0.0, 2.0)])
    # Counter-clockwise quadrangles below, the same `corners` later above, in scikit-fem's order of a hexahedron's corners.
    a, b, c, d = quads
    hexahedra = np.vstack([a, d, b, a + corners, c, d + corners, b + corners, c + corners])
    straight = skfem.MeshHex2.from_mesh(skfem.MeshHex(np.ascontiguousarray(ends), hexahedra))
    lattice = np.rint(straight.doflocs.T).astype(int)
    number = {tuple(place): k for k, place in enumerate(mesh.lattice)}
    below = np.array([number[tuple(place)] for place in lattice[:, :2]])

    # The plane's nodes, turned clockwise with the helix as z rises.
    z = 0.5 * height * lattice[:, 2]
    cosine = np.cos(mesh.twist * z)
    sine = np.sin(mesh.twist * z)
    x, y = mesh.points[below].T
    points = np.vstack([cosine * x + sine * y, cosine * y - sine * x, z])
    return skfem.MeshHex2(points, straight.t), lattice[:, 2] * len(mesh.points) + below


@dataclass(frozen=True)
class Frame:
    """Unknowns of one plane: displacements = matrix @ unknowns.

    Attributes:
        matrix: sparse, square; columns of inner nodes that are held, or follow others, don't matter or are empty.
        inside: unknowns that are condensed.
        cut: (2, c) unknowns of the left and the right cut, the end of a seat first.
        middle: unknowns of the rest of a seat.
        flank: unknowns along the flank normals.
    """

    matrix: sp.csc_array
    inside: np.ndarray
    cut: np.ndarray
    middle: np.ndarray
    flank: np.ndarray

    @property
    def keep(self) -> np.ndarray:
        """Unknowns that are kept, group by group."""
        return np.concatenate([*self.cut, self.middle, self.flank])


def held_frame(mesh: PitchMesh, normal: np.ndarray) -> Frame:
    """Frame of a plane whose inner circle is held."""
    d = normal.shape[1]
    cut = np.stack([node_dofs(mesh.left, d), node_dofs(mesh.right, d)])
    flank = d * mesh.flank
    kept = np.concatenate([*cut, flank, node_dofs(mesh.inner, d)])
    inside = np.setdiff1d(np.arange(d * len(mesh.points)), kept)
    return Frame(sp.csc_array(sp.block_diag(list(node_frames(mesh, normal)))), inside, cut, np.empty(0, int), flank)


def node_frames(mesh: PitchMesh, normal: np.ndarray) -> np.ndarray:
    """Frames (p, d, d) of the nodes of a plane for normals (f, d) at the flank; the right cut is in the next pitch's frame.

    A flank node's first unknown is its displacement along the normal; the others complete an orthogonal frame, and are condensed,
    so that any frame will do. Axial displacements (d = 1) need no normals, which are (0, 1).
    """
    d = normal.shape[1]
    frames = np.tile(np.eye(d), (len(mesh.points), 1, 1))
    if d > 1:
        frames[mesh.right] = clockwise(mesh.pitch_angle, d)
    for node, direction in zip(mesh.flank, normal, strict=d > 1):
        q, _ = np.linalg.qr(np.column_stack([direction, np.eye(d)[:, : d - 1] + 0.1]))
        q[:, 0] = direction  # qr keeps it up to its sign
        frames[node] = q
    return frames


def _condensed(K: np.ndarray, inside: int) -> np.ndarray:
    """K without its first `inside` unknowns, in place: K_rr - K_ri K_ii^-1 K_ir."""
    L = la.cholesky(K[:inside, :inside], lower=True, check_finite=False)
    W = la.solve_triangular(L, K[:inside, inside:], lower=True, check_finite=False)
    return np.asarray(K[inside:, inside:] - W.T @ W)


def stacked_layers(
    K: sp.csc_array, inside: np.ndarray, keep: np.ndarray, layers: int, groups: list[int], progress: Progress
) -> np.ndarray:
    """Stiffness of a stack of equal layers in the kept unknowns of all planes, group by group, plane by plane within a group.

    The middle plane of one layer is condensed, then layers are stacked: equal blocks are doubled, so few joints are worked out.

    Args:
        K: of one layer with its three planes.
        inside: those of a plane that are condensed.
        keep: those that are kept.
        layers: how many.
        groups: how many of the kept ones belong together, in their order.
        progress: told how far it is.
    """
    i = len(inside)
    k = len(keep)
    p = K.shape[0] // 3  # unknowns of a plane
    order = np.concatenate([p + inside, inside, 2 * p + inside, keep, p + keep, 2 * p + keep])
    block = _condensed(K[order][:, order].toarray(), i)  # bottom and top inside, then what is kept of its planes

    # Binary digits of the number of layers: `block` is doubled, and put upon the stack for each digit that is 1. The stack's
    # bottom and the last block's top meet no other layer: they are condensed before that block is joined, not after it.
    stack: np.ndarray | None = None
    rest = layers
    while rest > 2 or (rest == 2 and stack is not None):
        progress((layers - rest) / layers, f"{layers - rest} of {layers} layers")
        if rest % 2:
            stack = _condensed(block, i) if stack is None else _joined(stack, block, i, k, bottom=0)
        rest //= 2
        block = _joined(block, block, i, k)
    if layers == 1:
        S = _condensed(block, 2 * i)
    else:
        lower = _condensed(block, i) if stack is None else stack
        top_first = np.concatenate([np.arange(i, 2 * i), np.arange(i), np.arange(2 * i, len(block))])
        S = _joined(lower, _condensed(block[np.ix_(top_first, top_first)], i), i, k, bottom=0, top=0)
    progress(1.0, "pitch condensed")
    planes = 2 * layers + 1
    number = np.arange(planes * k).reshape(planes, k)
    ends = np.cumsum([0, *groups])
    final = np.concatenate([number[:, low:high].ravel() for low, high in pairwise(ends)])
    S = S[np.ix_(final, final)]
    return np.asarray(0.5 * (S + S.T))


def _joined(
    lower: np.ndarray, upper: np.ndarray, i: int, k: int, *, bottom: int | None = None, top: int | None = None
) -> np.ndarray:
    """Two blocks of layers as one: the plane between them is condensed, except for its k kept unknowns.

    Args:
        lower: with the unknowns inside its bottom, those inside its top, and the kept ones; upper: likewise.
        i: unknowns inside the plane between them.
        k: kept ones of a plane.
        bottom: unknowns that are left inside the bottom of `lower`; None: all i.
        top: the same of the top of `upper`.
    """
    below = i if bottom is None else bottom
    above = i if top is None else top
    first = len(lower) - below - i
    second = len(upper) - i - above
    ends = i + below + above
    size = ends + first + second - k
    whole = np.zeros((size, size))
    shared = slice(0, i)
    low_end = slice(i, i + below)
    high_end = slice(i + below, ends)
    low = slice(ends, ends + first)
    high = slice(size - second, size)
    for block, inside, places in (
        (lower, (below, below + i), (low_end, shared, low)),
        (upper, (i, i + above), (shared, high_end, high)),
    ):
        parts = (slice(0, inside[0]), slice(*inside), slice(inside[1], None))
        for row, rows in zip(parts, places, strict=True):
            for column, columns in zip(parts, places, strict=True):
                whole[rows, columns] += block[row, column]
    return _condensed(whole, i)
