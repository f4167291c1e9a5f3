"""The elements of casings: quadratic tetrahedra and hexahedra, by scikit-fem's shape functions in the order of the file.

Files number the nodes of an element in VTK's order, scikit-fem in its own. Both stand on the same places of the reference
element, so that they are matched by these.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from rotorgear.errors import MissingExtraError

_TET_CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
_HEX_CORNERS = np.array(
    [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]], dtype=float
)
_TET_EDGES = ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3))
_HEX_EDGES = (
    *((0, 1), (1, 2), (2, 3), (3, 0)),
    *((4, 5), (5, 6), (6, 7), (7, 4)),
    *((0, 4), (1, 5), (2, 6), (3, 7)),
)
# Corners of the faces, counter-clockwise seen from outside.
_TET_FACES = ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2))
_HEX_FACES = ((0, 4, 7, 3), (1, 2, 6, 5), (0, 1, 5, 4), (3, 7, 6, 2), (0, 3, 2, 1), (4, 5, 6, 7))


@dataclass(frozen=True)
class Reference:
    """Shape functions on a reference cell.

    Attributes:
        nodes: (k, d) reference places of the nodes, corners first, in VTK's order.
        skfem: scikit-fem's element.
        order: for each node the number of scikit-fem's function.
    """

    nodes: np.ndarray
    skfem: Any
    order: np.ndarray

    def shapes(self, places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Shape functions (k, q) and their gradients (k, d, q) at reference places (d, q)."""
        values = [self.skfem.lbasis(places, int(i)) for i in self.order]
        return (
            np.array([np.broadcast_to(value, places.shape[1]) for value, _ in values]),
            np.array([np.broadcast_to(gradient, places.shape) for _, gradient in values]),
        )

    def quadrature(self, degree: int) -> tuple[np.ndarray, np.ndarray]:
        """Places (d, q) and weights (q,) that integrate polynomials of a degree on the reference cell."""
        from skfem.quadrature import get_quadrature

        places, weights = get_quadrature(self.skfem.refdom, degree)
        return np.asarray(places), np.asarray(weights)


@dataclass(frozen=True)
class Element(Reference):
    """A kind of solid.

    Attributes:
        kind: meshio's word.
        corners: number of corners.
        edges: corners of each edge, in the order of the nodes on them.
        faces: corners of each face, counter-clockwise from outside.
        face_nodes: all nodes of each face: corners, those on its edges in the order of the corners, its middle if it has a node.
        face: shape functions on a face.
    """

    kind: str
    corners: int
    edges: tuple[tuple[int, int], ...]
    faces: tuple[tuple[int, ...], ...]
    face_nodes: np.ndarray
    face: Reference

    @property
    def linear(self) -> Element:
        """The linear element on the same corners."""
        return element("tetra" if self.corners == 4 else "hexahedron")


def matched(places: np.ndarray, others: np.ndarray) -> np.ndarray:
    """For each place (m, d) the number of the other place that stands there."""
    return np.asarray(np.argmin(np.linalg.norm(places[:, None] - others, axis=2), axis=1))


@cache
def element(kind: str) -> Element:
    """The element of a kind: tetra10, hexahedron20 or hexahedron27; tetra and hexahedron for comparison only.

    Raises:
        MissingExtraError: scikit-fem is not installed.
    """
    try:
        import skfem
    except ImportError:
        raise MissingExtraError("A casing from a mesh file", "scikit-fem", "casing") from None
    tet = kind.startswith("tetra")
    corners = _TET_CORNERS if tet else _HEX_CORNERS
    edges: tuple[tuple[int, int], ...] = _TET_EDGES if tet else _HEX_EDGES
    if kind in ("tetra", "hexahedron"):
        edges = ()
    faces = _TET_FACES if tet else _HEX_FACES
    nodes = [*corners, *(corners[list(edge)].mean(axis=0) for edge in edges)]
    if kind == "hexahedron27":
        nodes += [corners[list(face)].mean(axis=0) for face in faces]
        nodes.append(corners.mean(axis=0))
    places = np.array(nodes)
    # Nodes of a face by weights of its corners: these, the middles between them, and the middle of all.
    unit = np.eye(len(faces[0]))
    middles = 0.5 * (unit + np.roll(unit, -1, axis=0)) if edges else unit[:0]
    centre = unit.mean(axis=0, keepdims=True) if kind == "hexahedron27" else unit[:0]
    weights = np.vstack([unit, middles, centre])
    inside, on_face = {
        "tetra": (skfem.ElementTetP1, skfem.ElementTriP1),
        "tetra10": (skfem.ElementTetP2, skfem.ElementTriP2),
        "hexahedron": (skfem.ElementHex1, skfem.ElementQuad1),
        "hexahedron20": (skfem.ElementHexS2, skfem.ElementQuadS2),
        "hexahedron27": (skfem.ElementHex2, skfem.ElementQuad2),
    }[kind]
    finite = inside()
    rim_corners = np.array([[0, 0], [1, 0], [0, 1]] if tet else [[0, 0], [1, 0], [1, 1], [0, 1]], dtype=float)
    rim_nodes = weights @ rim_corners
    finite_face = on_face()
    return Element(
        nodes=places,
        skfem=finite,
        order=matched(places, np.asarray(finite.doflocs)),
        kind=kind,
        corners=len(corners),
        edges=edges,
        faces=faces,
        face_nodes=np.array([matched(weights @ corners[list(face)], places) for face in faces]),
        face=Reference(rim_nodes, finite_face, matched(rim_nodes, np.asarray(finite_face.doflocs))),
    )


QUADRATIC = {"tetra": "tetra10", "tetra10": "tetra10", "hexahedron": "hexahedron20", "hexahedron20": "hexahedron20"}
QUADRATIC["hexahedron27"] = "hexahedron27"
