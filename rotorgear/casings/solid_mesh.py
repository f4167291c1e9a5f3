"""A mesh of quadratic solids that integrates: linear elements raised, numbering put right, folded elements straightened.

Linear tetrahedra are far too stiff in bending (frequencies of thin walls 17 to 94 % too high), so that straight elements get
nodes in the middle of their edges. A mesher may curve an element so far that its Jacobian is negative somewhere; finite-element
codes that integrate |det J| then go on with wrong numbers. Here such elements are found, named and made straight.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from rotorgear.casings.elements import QUADRATIC, Element, element, matched
from rotorgear.casings.file_mesh import SOLID_BEGINNINGS, SOLIDS, FileMesh, NamedSet
from rotorgear.errors import AnalysisError
from rotorgear.quantity import millimetres

# Degrees of the polynomials that the rules for stiffness and mass integrate: exact for straight tetrahedra and bricks, with
# some to spare for curved ones, and with positive weights (the rule of degree 4 has a negative one).
STIFFNESS_DEGREE = 5
MASS_DEGREE = 6
# A sentence names this many elements, and this many parts.
_NAMED = 5
_LISTED = 4


@dataclass(frozen=True)
class SolidMesh:
    """Quadratic solids of one kind.

    Attributes:
        points: (p, 3) in m; every one belongs to an element.
        cells: (e, k) nodes in VTK's order.
        kind: meshio's word: tetra10, hexahedron20, hexahedron27.
        sets: by name.
        notes: sentences on what was done.
        jacobian_low: least det J over that of the straight element, over all Gauss points as the file has them.
        straightened: numbers of elements, from 0 in the order of the file, whose mid-nodes were moved.
        raised: whether the file has linear elements.
    """

    points: np.ndarray
    cells: np.ndarray
    kind: str
    sets: dict[str, NamedSet]
    notes: tuple[str, ...] = ()
    jacobian_low: float = 1.0
    straightened: tuple[int, ...] = ()
    raised: bool = False

    @property
    def element(self) -> Element:
        """The kind of its elements."""
        return element(self.kind)

    @cached_property
    def boundary(self) -> np.ndarray:
        """Nodes (f, m) of the outer faces, counter-clockwise seen from outside: corners first."""
        return boundary_faces(self.cells, self.element)

    def parts(self) -> np.ndarray:
        """Number (p,) of the connected part that each node belongs to."""
        rows = np.repeat(self.cells[:, 0], self.cells.shape[1] - 1)
        columns = self.cells[:, 1:].ravel()
        n = len(self.points)
        labels: np.ndarray = connected_components(sp.coo_array((np.ones(len(rows)), (rows, columns)), shape=(n, n)))[1]
        return labels

    def in_words(self, part_of: np.ndarray) -> str:
        """The largest parts of a mesh by their elements and where they are; `part_of` (e,) numbers the part of each element."""
        elements = np.bincount(part_of)
        named = []
        for part in np.argsort(-elements)[:_LISTED]:
            middle = self.points[np.unique(self.cells[part_of == part])].mean(axis=0)
            named.append(f"{elements[part]} elements about ({', '.join(map(millimetres, middle))})")
        return "; ".join(named) + (f" and {len(elements) - _LISTED} more" if len(elements) > _LISTED else "")


def solid_mesh(found: FileMesh, unit: float, address: str) -> SolidMesh:
    """The solids of a file in m, checked.

    Args:
        found: as it was read.
        unit: of its lengths in m.
        address: of the mesh in the model file, for errors.

    Raises:
        AnalysisError: no solids, kinds that are not computed, shells with nodes of their own, elements inside out.
    """
    kind = _only_kind(found, address)
    notes = list(found.notes)
    cells = found.cells[kind]
    # Cells that are no solids may only mark faces of the solids: a wall of shells would be lost.
    used = np.unique(cells)
    for other, faces in found.cells.items():
        if other not in SOLIDS and other != "vertex":
            loose = int(np.count_nonzero(~np.isin(faces, used).all(axis=1)))
            if loose:
                raise AnalysisError(
                    f"{address}: {loose} of {len(faces)} {other} cells are not on the solids: shells and beams are not computed. "
                    "Mesh these walls as solids, or leave them out of the file."
                )
    place = np.full(len(found.points), -1, dtype=np.int64)
    place[used] = np.arange(len(used))
    points = unit * found.points[used]
    cells = place[cells]
    sets = {name: one.renumbered(place) for name, one in found.sets.items()}
    raised = QUADRATIC[kind] != kind
    shape = element(QUADRATIC[kind])
    if raised:
        # A new node in the middle of every edge; a set of nodes gets those between two of its nodes.
        edges = np.sort(cells[:, np.array(shape.edges)], axis=2)
        keys, inverse = np.unique(edges.reshape(-1, 2), axis=0, return_inverse=True)
        middle = points[keys].mean(axis=1)
        cells = np.hstack([cells, len(points) + inverse.reshape(len(cells), -1)])
        for one in sets.values():
            new = len(points) + np.flatnonzero(np.isin(keys, one.nodes).all(axis=1))
            one.nodes = np.concatenate([one.nodes, new])
        points = np.vstack([points, middle])
        word = "tetrahedra" if kind == "tetra" else "hexahedra"
        notes.append(
            f"{len(cells)} linear {word} were raised to quadratic ones with straight edges: linear ones are far too stiff. "
            "Curved walls stay as faceted as the file has them."
        )
    else:
        order = _order_by_position(points, cells, shape)
        if order is not None:
            cells = cells[:, order]
            notes.append("The nodes on the edges were numbered in another order than the format's; this was put right.")
    cells = _right_handed(points, cells, shape, address)
    _apart(cells, shape, address)
    mesh = SolidMesh(points, cells, shape.kind, sets, tuple(notes), raised=raised)
    return _unfolded(mesh, address)


def _only_kind(found: FileMesh, address: str) -> str:
    """The kind of solids in a file; others beside it are refused."""
    kinds = [kind for kind in SOLIDS if kind in found.cells]
    others = [kind for kind in found.cells if kind not in SOLIDS and kind.startswith(SOLID_BEGINNINGS)]
    if len(kinds) == 1 and not others:
        return kinds[0]
    if others:
        fault = f"has {others[0]} cells, which are not computed"
        remedy = "Mesh the body with tetrahedra of the first or second order, or with such hexahedra alone"
    elif kinds:
        fault = f"mixes {' and '.join(kinds)}, which do not fit together"
        remedy = "Mesh the whole body with one kind"
    else:
        fault = "has no solid cells"
        remedy = "A casing is a mesh of tetrahedra or hexahedra: mesh its volume and save all elements"
    counts = ", ".join(f"{len(cells)} {kind}" for kind, cells in found.cells.items()) or "none"
    raise AnalysisError(f"{address}: the mesh {fault} (cells: {counts}). {remedy}.")


def _straight(points: np.ndarray, cells: np.ndarray, shape: Element) -> np.ndarray:
    """Places (e, k, 3) of the nodes if the edges were straight: those of the linear element on the corners."""
    return np.einsum("ck,eci->eki", shape.linear.shapes(shape.nodes.T)[0], points[cells[:, : shape.corners]])


def _order_by_position(points: np.ndarray, cells: np.ndarray, shape: Element) -> np.ndarray | None:
    """The order of an element's nodes as their places tell, where it is not VTK's in most elements; else None."""
    # The order is one for the whole file: some elements tell it.
    cells = cells[np.linspace(0, len(cells) - 1, min(len(cells), 200)).astype(int)]
    straight = _straight(points, cells, shape)[:, shape.corners :]
    given = points[cells[:, shape.corners :]]
    nearest = np.argmin(np.linalg.norm(given[:, None, :, :] - straight[:, :, None, :], axis=3), axis=2)
    orders, counts = np.unique(nearest, axis=0, return_counts=True)
    order = orders[np.argmax(counts)]
    usual = np.arange(len(order))
    if np.array_equal(order, usual) or len(np.unique(order)) < len(order) or counts.max() < 0.9 * len(nearest):
        return None
    return np.concatenate([np.arange(shape.corners), shape.corners + order])


def _corner_volumes(points: np.ndarray, cells: np.ndarray, shape: Element) -> np.ndarray:
    """det J (e,) of the straight elements in their middle."""
    middle = shape.linear.nodes.mean(axis=0)[:, None]
    gradients = shape.linear.shapes(middle)[1][:, :, 0]
    return np.linalg.det(np.einsum("eki,kj->eji", points[cells[:, : shape.corners]], gradients))


def _right_handed(points: np.ndarray, cells: np.ndarray, shape: Element, address: str) -> np.ndarray:
    """Elements whose corners are numbered the other way round are mirrored; flat ones are refused."""
    volume = _corner_volumes(points, cells, shape)
    size = np.linalg.norm(np.ptp(points[cells], axis=1), axis=1) ** 3
    flat = np.flatnonzero(np.abs(volume) <= 1e-10 * size)
    if len(flat):
        raise AnalysisError(
            f"{address}: {_elements(flat)} {'has' if len(flat) == 1 else 'have'} no volume. Mesh the body anew, or repair the "
            "geometry: slivers come from faces that nearly touch."
        )
    if not np.any(volume < 0.0):
        return cells
    swap = matched(shape.nodes[:, [1, 0, 2]], shape.nodes)
    return np.where((volume < 0.0)[:, None], cells[:, swap], cells)


def _apart(cells: np.ndarray, shape: Element, address: str) -> None:
    """Refuse elements that lie in one another: two elements of one face are on its two sides."""
    faces = cells[:, np.array(shape.faces)].reshape(-1, len(shape.faces[0]))
    first = np.argmin(faces, axis=1)
    turned = np.take_along_axis(faces, (first[:, None] + np.arange(faces.shape[1])) % faces.shape[1], axis=1)
    side = np.where(turned[:, 1] < turned[:, -1], 1, -1)
    _, number, counts = np.unique(np.sort(faces, axis=1), axis=0, return_inverse=True, return_counts=True)
    sides = np.bincount(number.ravel(), side)
    wrong = (counts > 2) | ((counts == 2) & (sides != 0))
    if wrong.any():
        elements = np.unique(np.flatnonzero(wrong[number.ravel()]) // len(shape.faces))
        raise AnalysisError(
            f"{address}: {_elements(elements)} lie in one another: elements that stand twice in the file, or that are turned "
            "inside out by a node in the wrong place. Mesh the body anew, or delete the copies."
        )


def in_space(
    corners: np.ndarray, gradients: np.ndarray, weights: np.ndarray, others: np.ndarray | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Volumes (e, q) that count for the Gauss points, and gradients (e, q, k, 3) in space of the shape functions.

    Args:
        corners: (e, k, 3) places of all nodes of elements.
        gradients: (k, 3, q) of the shape functions on the reference cell.
        weights: (q,).
        others: (m, 3, q) gradients of other functions, whose gradients in space are wanted in place of those.
    """
    J = np.einsum("eki,kjq->eqij", corners, gradients, optimize=True)
    # ∇N = J^-T ∇_ξ N.
    wanted = gradients if others is None else others
    return np.linalg.det(J) * weights, np.einsum("eqji,kjq->eqki", np.linalg.inv(J), wanted, optimize=True)


def jacobians(points: np.ndarray, cells: np.ndarray, shape: Element) -> np.ndarray:
    """det J (e, q) at the Gauss points of stiffness and mass."""
    places = np.hstack([shape.quadrature(degree)[0] for degree in (STIFFNESS_DEGREE, MASS_DEGREE)])
    gradients = shape.shapes(places)[1]
    chunks = np.array_split(cells, max(1, len(cells) // 4000))
    return np.vstack([np.linalg.det(np.einsum("eki,kjq->eqij", points[some], gradients)) for some in chunks])


def _unfolded(mesh: SolidMesh, address: str) -> SolidMesh:
    """The mesh with all Jacobians positive: mid-nodes of folded elements are moved onto straight edges."""
    shape = mesh.element
    points = mesh.points
    reference = _corner_volumes(points, mesh.cells, shape)
    ratio = jacobians(points, mesh.cells, shape) / reference[:, None]
    lowest = float(ratio.min())
    moved: set[int] = set()
    while len(folded := np.flatnonzero(ratio.min(axis=1) <= 0.0)):
        if moved.issuperset(folded.tolist()):
            raise AnalysisError(
                f"{address}: {_elements(folded)} {'is' if len(folded) == 1 else 'are'} inside out, with straight edges too. "
                "Mesh the body anew."
            )
        moved.update(folded.tolist())
        points = points.copy()
        points[mesh.cells[folded]] = _straight(points, mesh.cells[folded], shape)
        ratio = jacobians(points, mesh.cells, shape) / reference[:, None]
    if not moved:
        return replace(mesh, jacobian_low=lowest)
    names = sorted(moved)
    note = (
        f"The Jacobian of {_elements(np.array(names))} is negative at Gauss points, down to {lowest:.2g} of that of straight "
        "elements: the edges are curved too far, and the nodes in their middle were moved onto straight edges."
    )
    notes = (*mesh.notes, note)
    return replace(mesh, points=points, jacobian_low=lowest, straightened=tuple(names), notes=notes)


def _elements(numbers: np.ndarray) -> str:
    """Elements by their numbers, from 1 in the order of the file."""
    listed = ", ".join(str(number + 1) for number in numbers[:_NAMED])
    more = f" and {len(numbers) - _NAMED} more" if len(numbers) > _NAMED else ""
    return f"element {listed}" if len(numbers) == 1 else f"elements {listed}{more}"


def boundary_faces(cells: np.ndarray, shape: Element) -> np.ndarray:
    """Nodes (f, m) of the faces that belong to one element only: corners, those on edges, the middle where it has a node."""
    faces = cells[:, shape.face_nodes].reshape(-1, shape.face_nodes.shape[1])
    corners = np.sort(faces[:, : len(shape.faces[0])], axis=1)
    _, first, counts = np.unique(corners, axis=0, return_index=True, return_counts=True)
    return np.asarray(faces[np.sort(first[counts == 1])])


def merged(meshes: dict[str, SolidMesh], address: str) -> SolidMesh:
    """Several meshes as one, not yet joined; set S of mesh A is `A.S`, and `S` too where no other mesh has it.

    Raises:
        AnalysisError: meshes of different kinds of elements.
    """
    if len(meshes) == 1:
        return next(iter(meshes.values()))
    kinds = {name: mesh.kind for name, mesh in meshes.items()}
    if len(set(kinds.values())) > 1:
        listed = ", ".join(f"{name}: {kind}" for name, kind in kinds.items())
        raise AnalysisError(f"{address}: the meshes have elements of different kinds ({listed}). Use one kind for all.")
    sets: dict[str, NamedSet] = {}
    names = [name for mesh in meshes.values() for name in mesh.sets]
    notes: list[str] = []
    straightened: list[int] = []
    points: list[np.ndarray] = []
    cells: list[np.ndarray] = []
    for part, mesh in meshes.items():
        first_point = sum(map(len, points))
        first_cell = sum(map(len, cells))
        for name, one in mesh.sets.items():
            shifted = one.renumbered(first_point + np.arange(len(mesh.points)))
            sets[f"{part}.{name}"] = shifted
            if names.count(name) == 1:
                sets[name] = shifted
        notes += [f"{part}: {note}" for note in mesh.notes]
        straightened += [number + first_cell for number in mesh.straightened]
        points.append(mesh.points)
        cells.append(mesh.cells + first_point)
    return SolidMesh(
        np.vstack(points),
        np.vstack(cells),
        next(iter(kinds.values())),
        sets,
        tuple(notes),
        min(mesh.jacobian_low for mesh in meshes.values()),
        tuple(straightened),
        any(mesh.raised for mesh in meshes.values()),
    )
