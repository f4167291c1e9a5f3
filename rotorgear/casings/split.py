"""A mesh with every element split in eight: the same body, for what a finer mesh would find.

The elements are mapped to space by their quadratic shape functions, and so are the places of the new nodes: the body keeps its
shape to the last digit, curved faces too. A new node is known by the old nodes that it stands between, so that parts that touch
without common nodes stay apart. Tetrahedra are cut along their shortest diagonal, which keeps their shapes from getting worse
with every split (Zhang, Houston J. Math. 21, 1995).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from rotorgear.casings.elements import Element, element, matched
from rotorgear.casings.file_mesh import NamedSet
from rotorgear.casings.solid_mesh import SolidMesh, boundary_faces

# Four tetrahedra at the corners; the octahedron between them is cut along one of its diagonals, around which the other four
# nodes stand in a ring. Nodes in VTK's order.
_CORNER_TETS = ((0, 4, 6, 7), (4, 1, 5, 8), (6, 5, 2, 9), (7, 8, 9, 3))
_DIAGONALS = ((4, 9), (5, 7), (6, 8))
_RINGS = ((5, 6, 7, 8), (6, 4, 8, 9), (4, 5, 9, 7))
TRIANGLES = ((0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5))
_QUADS = ((0, 4, 8, 7), (4, 1, 5, 8), (8, 5, 2, 6), (7, 8, 6, 3))


def split(mesh: SolidMesh) -> SolidMesh:
    """Split every element of a mesh in eight; sets keep their nodes and faces, and get those between them."""
    shape = mesh.element
    # Corners of the parts may stand on all nodes of a tetrahedron, and on the 27 places of a brick.
    whole = shape if shape.corners == 4 else element("hexahedron27")
    vertices, points = _with_middles(mesh, whole)
    # Corners (e, 8, k) of the eighths among the nodes of their element; those of a brick are its corners and the middles between.
    if shape.corners == 4:
        parts = _tetrahedra(mesh)
    else:
        middles = 0.5 * (whole.nodes[:8, None] + whole.nodes[None, :8])
        eighths = matched(middles.reshape(-1, 3), whole.nodes).reshape(8, 8)
        parts = np.broadcast_to(eighths, (len(vertices), 8, 8))
    corners = np.take_along_axis(vertices, parts.reshape(len(vertices), -1), axis=1).reshape(-1, shape.corners)
    local = parts.reshape(corners.shape)
    columns = [corners]
    places = [points]
    count = len(points)
    members: dict[str, list[np.ndarray]] = {}
    faces_of_sets: dict[str, list[np.ndarray]] = {}
    outer = boundary_faces(vertices, whole)
    smaller = np.array(TRIANGLES if shape.corners == 4 else _QUADS)
    for name, one in mesh.sets.items():
        # Nodes of the file's faces count, and not those in the middle of bricks' faces.
        faces = outer[one.faces_among(outer[:, : shape.face_nodes.shape[1]], len(shape.faces[0]))]
        members[name] = [np.isin(np.arange(len(points)), np.concatenate([one.nodes, faces.ravel()]))]
        faces_of_sets[name] = [faces[:, smaller].reshape(-1, smaller.shape[1])] if one.faces else []
    entities: list[np.ndarray] = [np.array(shape.edges)]
    if shape.kind == "hexahedron27":
        entities += [np.array(shape.faces), np.arange(8)[None, :]]
    for between in entities:
        keys = np.sort(corners[:, between], axis=2).reshape(-1, between.shape[1])
        names, first, number = np.unique(keys, axis=0, return_index=True, return_inverse=True)
        columns.append(count + number.reshape(len(corners), -1))
        cell, entity = np.divmod(first, len(between))
        reference = whole.nodes[np.take_along_axis(local[cell], between[entity], axis=1)].mean(axis=1)
        places.append(_mapped(mesh, shape, cell // 8, reference))
        for flags in members.values():
            flags.append(flags[0][names].all(axis=1))
        count += len(names)
    sets = {
        name: NamedSet(np.flatnonzero(np.concatenate(flags)), faces_of_sets[name]) for name, flags in members.items()
    }
    return replace(mesh, points=np.vstack(places), cells=np.hstack(columns), sets=sets, straightened=())


def without_middles(mesh: SolidMesh) -> SolidMesh:
    """The mesh with linear elements on the same corners, to show how much too stiff these are."""
    shape = mesh.element
    kind = "tetra" if shape.corners == 4 else "hexahedron"
    used, cells = np.unique(mesh.cells[:, : shape.corners], return_inverse=True)
    place = np.full(len(mesh.points), -1, dtype=np.int64)
    place[used] = np.arange(len(used))
    sets = {name: one.renumbered(place) for name, one in mesh.sets.items()}
    corners = cells.reshape(-1, shape.corners)
    return replace(mesh, points=mesh.points[used], cells=corners, kind=kind, sets=sets)


def _with_middles(mesh: SolidMesh, whole: Element) -> tuple[np.ndarray, np.ndarray]:
    """Nodes (e, k) of the elements with those in the middle of faces and elements, and all places (p, 3)."""
    if mesh.kind == whole.kind:
        return mesh.cells, mesh.points
    faces = np.sort(mesh.cells[:, np.array(whole.faces)], axis=2).reshape(-1, 4)
    _, first, number = np.unique(faces, axis=0, return_index=True, return_inverse=True)
    cell, face = np.divmod(first, len(whole.faces))
    on_faces = _mapped(mesh, mesh.element, cell, whole.nodes[20:26][face])
    inside = _mapped(mesh, mesh.element, np.arange(len(mesh.cells)), np.full((len(mesh.cells), 3), 0.5))
    start = len(mesh.points)
    middles = start + len(on_faces) + np.arange(len(mesh.cells))
    vertices = np.hstack([mesh.cells, start + number.reshape(len(mesh.cells), -1), middles[:, None]])
    return vertices, np.vstack([mesh.points, on_faces, inside])


def _tetrahedra(mesh: SolidMesh) -> np.ndarray:
    """Corners (e, 8, 4) of the eighths of each tetrahedron among its 10 nodes, by the shortest of its three diagonals."""
    octahedra = np.array(
        [[(ring[i], ring[i - 3], *pair) for i in range(4)] for pair, ring in zip(_DIAGONALS, _RINGS, strict=True)]
    )
    nodes = mesh.element.nodes
    edges = nodes[octahedra[..., 1:]] - nodes[octahedra[..., :1]]
    mirrored = np.linalg.det(edges) < 0.0
    octahedra[mirrored] = octahedra[mirrored][:, [1, 0, 2, 3]]
    ends = mesh.points[mesh.cells[:, np.array(_DIAGONALS)]]
    shortest = np.argmin(np.linalg.norm(ends[:, :, 0] - ends[:, :, 1], axis=2), axis=1)
    corner = np.broadcast_to(np.array(_CORNER_TETS), (len(mesh.cells), 4, 4))
    return np.concatenate([corner, octahedra[shortest]], axis=1)


def _mapped(mesh: SolidMesh, shape: Element, cells: np.ndarray, reference: np.ndarray) -> np.ndarray:
    """Places (n, 3) in space of reference places (n, 3) of elements (n,)."""
    found = np.empty((len(cells), 3))
    known, which = np.unique(np.round(reference, 9), axis=0, return_inverse=True)
    values = shape.shapes(known.T)[0]
    for number in range(len(known)):
        here = np.flatnonzero(which.ravel() == number)
        found[here] = np.einsum("k,nki->ni", values[:, number], mesh.points[mesh.cells[cells[here]]])
    return found
