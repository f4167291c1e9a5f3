"""Whether a casing can move without strain where it should not: held too little, or hanging together by edges only.

Elements that share whole faces move rigidly as one part, if at all. Parts of a mesh that share an edge or a node alone, which
meshers leave where two solids just touch, turn there like a hinge: no stiffness resists it.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from rotorgear.casings.joins import Joined
from rotorgear.casings.reduced_body import node_dofs, rigid_motions
from rotorgear.casings.settings import CasingSettings
from rotorgear.casings.solid_mesh import SolidMesh
from rotorgear.errors import AnalysisError

_MOTIONS = tuple(f"{motion} {axis}" for motion in ("displacement along", "rotation about") for axis in "xyz")
# With more parts than this without common faces, the mesh is no single body.
_MOST_PARTS = 200
# Squares of relative motions below this share of the largest are rounding of the file's coordinates.
_ROUNDING = 1e-12


def no_mechanism(settings: CasingSettings, mesh: SolidMesh, held: np.ndarray, springs: np.ndarray) -> None:
    """Refuse a body that is held, but not against all rigid motions; a body that nothing holds is sound.

    Args:
        settings: of the model file.
        mesh: of the body.
        held: nodes that are fixed.
        springs: (3p, m) directions of the springs of mounts.

    Raises:
        AnalysisError: the motions that are left, by name.
    """
    if not settings.held and not settings.mounts:
        return
    R = _scaled_motions(mesh.points)
    rows = [R.reshape(-1, 3, 6)[held].reshape(-1, 6), _on_springs(springs, R)]
    # Of the triangle: a held face has thousands of rows, and the whole left factor of their decomposition has their square.
    triangle = np.linalg.qr(np.vstack(rows), mode="r")
    _, singular, motions = np.linalg.svd(triangle, full_matrices=True)
    free = [motions[i] for i in range(6) if i >= len(singular) or singular[i] < 1e-6 * singular[0]]
    if free:
        named = "; ".join(_MOTIONS[int(np.argmax(np.abs(motion)))] for motion in free)
        what = ", ".join([*settings.held, *(mount.set for mount in settings.mounts)])
        key = "held" if settings.held else "mounts"
        remedy = (
            "Hold a face, or add springs"
            if settings.held
            else "A mount holds the mean motion of its set: give each foot a set and a mount of its own, or add tilt and torsion"
        )
        raise AnalysisError(
            f"{settings.address}.{key}: what is held ({what}) leaves the casing a mechanism: {named}. {remedy}; or hold nothing, "
            "for a body that floats on its bearings."
        )


def _scaled_motions(points: np.ndarray) -> np.ndarray:
    """Rigid motions (3p, 6) about the middle of a mesh, whose rotations move its ends by as much as its displacements."""
    R = rigid_motions(points, points.mean(axis=0))
    R[:, 3:] /= np.linalg.norm(np.ptp(points, axis=0))
    return R


def _on_springs(springs: np.ndarray, motions: np.ndarray) -> np.ndarray:
    """Stretch (m, k) of the springs of mounts by motions (3p, k), scaled to unit length: stiffnesses do not count."""
    stretched = springs.T @ motions
    return np.asarray(stretched / np.linalg.norm(stretched, axis=1)[:, None].clip(min=1e-300))


def no_hinges(settings: CasingSettings, joined: Joined, held: np.ndarray, springs: np.ndarray) -> None:
    """Refuse parts that share edges or nodes only and can turn about them without strain.

    Args:
        settings: of the model file.
        joined: the mesh with its joins.
        held, springs: as of `no_mechanism`.

    Raises:
        AnalysisError: the parts.
    """
    mesh = joined.mesh
    count, part_of = _parts_by_faces(mesh)
    if count == 1:
        return
    if count <= _MOST_PARTS:
        squares = la.eigvalsh(_relative_motions(joined, part_of, held, springs))
        if np.count_nonzero(squares < _ROUNDING * squares[-1]) <= (0 if len(held) or springs.shape[1] else 6):
            return
    raise AnalysisError(
        f"{settings.address}.mesh: parts of the mesh hang together by edges or single nodes only, and turn there like "
        f"hinges: {mesh.in_words(part_of)}. Let them meet in whole faces, or hold them together by joins."
    )


def _parts_by_faces(mesh: SolidMesh) -> tuple[int, np.ndarray]:
    """Number of parts whose elements are connected by faces, and the part (e,) of each element."""
    shape = mesh.element
    faces = np.sort(mesh.cells[:, np.array(shape.faces)].reshape(-1, len(shape.faces[0])), axis=1)
    order = np.lexsort(faces.T)
    same = np.flatnonzero((faces[order[1:]] == faces[order[:-1]]).all(axis=1))
    owner = order // len(shape.faces)
    n = len(mesh.cells)
    pairs = sp.coo_array((np.ones(len(same)), (owner[same], owner[same + 1])), shape=(n, n))
    count, labels = connected_components(pairs, directed=False)
    return int(count), labels


def _relative_motions(joined: Joined, part_of: np.ndarray, held: np.ndarray, springs: np.ndarray) -> np.ndarray:
    """G (6c, 6c): quadratic form of the stretch of joints, springs and held nodes by rigid motions of c parts."""
    mesh = joined.mesh
    count = int(part_of.max()) + 1
    nodes = len(mesh.points)
    R = _scaled_motions(mesh.points).reshape(nodes, 3, 6)
    k = mesh.cells.shape[1]
    # Pairs of a node and a part that it belongs to, each pair once.
    node, part = np.unique(np.column_stack([mesh.cells.ravel(), np.repeat(part_of, k)]), axis=0).T
    first = np.concatenate([[True], node[1:] != node[:-1]])

    def motions(of_nodes: np.ndarray, of_parts: np.ndarray) -> sp.csr_array:
        """(3m, 6c): displacements of nodes with their parts."""
        rows = np.repeat(np.arange(3 * len(of_nodes)), 6)
        columns = (6 * np.repeat(of_parts, 3)[:, None] + np.arange(6)).ravel()
        return sp.csr_array((R[of_nodes].ravel(), (rows, columns)), shape=(3 * len(of_nodes), 6 * count))

    moved = motions(node[first], part[first])  # every node has a part: this is by number
    again = ~first
    known = part[first]
    blocks = [motions(node[again], part[again]) - motions(node[again], known[node[again]])]
    if joined.interpolation is not None:
        follow = sp.csr_array(sp.kron(joined.interpolation - sp.eye_array(nodes), sp.eye_array(3)))
        blocks.append(sp.csr_array(follow @ moved))
    blocks.append(sp.csr_array(moved[node_dofs(held)]))
    if springs.shape[1]:
        blocks.append(sp.csr_array(_on_springs(springs, moved.toarray())))
    G = sum((block.T @ block).toarray() for block in blocks)
    if joined.stiffness is not None:
        joint = (moved.T @ sp.kron(joined.stiffness, sp.eye_array(3)) @ moved).toarray()
        G = G + joint / np.abs(joint).max(initial=1e-300)
    return np.asarray(G)
