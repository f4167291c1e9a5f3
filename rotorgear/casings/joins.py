"""Faces that touch without common nodes, such as the flanges of bolted halves: tied, or held together by a stiffness per area.

The finer of two faces follows the coarser one. Tied: each of its nodes moves as the point of the other face that it lies on,
u_s = Σ N_m u_m. Else the energy ½ ∫ k |u_s - u_m|² dA over the finer face joins them. Its nodes are moved onto the other face
before, so that a rigid motion of both strains neither; where the faces don't overlap, they stay free.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp
from scipy.spatial import cKDTree

from rotorgear.casings.patches import by_set, face_areas
from rotorgear.casings.settings import JoinSettings
from rotorgear.casings.solid_mesh import SolidMesh
from rotorgear.errors import AnalysisError
from rotorgear.quantity import millimetres

_CANDIDATES = 8
# Faces that are farther apart than this share of their elements' size do not touch.
_GAP = 0.1


@dataclass(frozen=True)
class Joined:
    """What joins make of a mesh.

    Attributes:
        mesh: with the nodes of finer faces moved.
        interpolation: (p, p) motions of all nodes from those of the nodes that are not tied; None where nothing is tied.
        tied: nodes that follow others.
        stiffness: (p, p) of the joints, for each of the three directions, in N/m; None where there is none.
    """

    mesh: SolidMesh
    interpolation: sp.csr_array | None
    tied: np.ndarray
    stiffness: sp.csr_array | None

    def links(self) -> sp.coo_array:
        """Which nodes move each other through joins, for the search of connected parts."""
        n = len(self.mesh.points)
        parts = [part for part in (self.interpolation, self.stiffness) if part is not None]
        return sp.coo_array(sum(parts[1:], parts[0]) if parts else sp.coo_array((n, n)))


def join(mesh: SolidMesh, joins: tuple[JoinSettings, ...], address: str) -> Joined:
    """Tie faces, or put springs between them.

    Raises:
        AnalysisError: unknown sets, faces that do not touch, that share nodes, or a face that is tied twice.
    """
    n = len(mesh.points)
    ties = sp.csr_array((n, n))
    springs = sp.csr_array((n, n))
    tied = np.zeros(n, dtype=bool)
    notes: list[str] = []
    for number, one in enumerate(joins):
        here = f"{address}.joins[{number}]"
        first = _faces(mesh, one.first, here)
        second = _faces(mesh, one.second, here)
        # The finer face follows the coarser one, whose shape functions are smooth over each of its elements.
        if _size(mesh, first) > _size(mesh, second):
            first, second = second, first
        nodes = np.unique(first)
        if np.isin(nodes, second).any():
            raise AnalysisError(f"{here}: '{one.first}' and '{one.second}' have nodes in common: they are one already.")
        masters, weights, places, distance = _projected(mesh, second, mesh.points[nodes])
        size = _size(mesh, first)
        near = distance <= _GAP * size
        if not near.any():
            raise AnalysisError(
                f"{here}: '{one.first}' and '{one.second}' do not touch: they are {millimetres(distance.min())} apart at "
                "least. Name the two faces of the joint."
            )
        if one.stiffness is None and (tied[nodes[near]].any() or tied[np.unique(second)].any()):
            raise AnalysisError(f"{here}: nodes of '{one.first}' or '{one.second}' are tied by another join already.")
        points = mesh.points.copy()
        points[nodes[near]] = places[near]
        mesh = replace(mesh, points=points)
        left = "" if near.all() else f"; {np.count_nonzero(~near)} nodes beyond its edge stay free"
        if one.stiffness is None:
            tied[nodes[near]] = True
            places_of_ties = (np.repeat(nodes[near], second.shape[1]), masters[near].ravel())
            ties = ties + sp.csr_array((weights[near].ravel(), places_of_ties), shape=(n, n))
            notes.append(f"'{one.first}' and '{one.second}' are tied at {np.count_nonzero(near)} nodes{left}.")
        else:
            springs = springs + one.stiffness * _spring(mesh, first, second, _GAP * size)
            notes.append(f"'{one.first}' stands on '{one.second}' with {one.stiffness:.4g} N/m^3{left}.")
    interpolation = sp.csr_array(ties + sp.diags_array((~tied).astype(float))) if tied.any() else None
    mesh = replace(mesh, notes=(*mesh.notes, *notes))
    return Joined(mesh, interpolation, np.flatnonzero(tied), springs if springs.nnz else None)


def _faces(mesh: SolidMesh, set_name: str, address: str) -> np.ndarray:
    patch = by_set(mesh, set_name, address)
    if not patch.area:
        raise AnalysisError(f"{address}: the set '{set_name}' makes no face of the solids: name all nodes of a face.")
    return mesh.boundary[np.isin(mesh.boundary, patch.nodes).all(axis=1)]


def _size(mesh: SolidMesh, faces: np.ndarray) -> float:
    """Mean size of the elements of a face in m."""
    return float(np.sqrt(face_areas(mesh, faces)[1].sum(axis=1).mean()))


def _projected(mesh: SolidMesh, faces: np.ndarray, points: np.ndarray) -> tuple[np.ndarray, ...]:
    """The nearest points on curved faces, by Gauss and Newton's method on the faces whose middles are nearest.

    Returns:
        Nodes (n, m) and weights (n, m) of each, its place (n, 3), and its distance (n,) from the point (n, 3) that was given.
    """
    face = mesh.element.face
    tri = len(mesh.element.faces[0]) == 3
    corners = mesh.points[faces]
    count = min(_CANDIDATES, len(faces))
    _, near = cKDTree(corners[:, : len(mesh.element.faces[0])].mean(axis=1)).query(points, k=count)
    near = near.reshape(-1)
    target = np.repeat(points, count, axis=0)
    X = corners[near]
    place = np.full((len(near), 2), 1.0 / 3.0 if tri else 0.5)
    for _ in range(8):
        values, gradients = face.shapes(place.T)
        off = target - np.einsum("mn,nmi->ni", values, X)
        J = np.einsum("mjn,nmi->nji", gradients, X)
        step = np.linalg.solve(np.einsum("nji,nki->njk", J, J), np.einsum("nji,ni->nj", J, off)[:, :, None])[:, :, 0]
        place = np.clip(place + step, 0.0, 1.0)
        if tri:
            place /= np.maximum(place.sum(axis=1), 1.0)[:, None]
    values = face.shapes(place.T)[0]
    found = np.einsum("mn,nmi->ni", values, X)
    distance = np.linalg.norm(target - found, axis=1).reshape(-1, count)
    best = np.arange(len(points)) * count + np.argmin(distance, axis=1)
    return faces[near[best]], values.T[best], found[best], distance.reshape(-1)[best]


def _spring(mesh: SolidMesh, first: np.ndarray, second: np.ndarray, gap: float) -> sp.csr_array:
    """(p, p): ∫ (N_s - N_m)ᵀ (N_s - N_m) dA over the part of the first face that touches the second one, in m^2."""
    values, areas = face_areas(mesh, first)
    gauss = np.einsum("mq,fmi->fqi", values, mesh.points[first]).reshape(-1, 3)
    masters, weights, _, distance = _projected(mesh, second, gauss)
    area = np.where(distance <= gap, areas.reshape(-1), 0.0)
    count, m = masters.shape
    own = np.repeat(first, values.shape[1], axis=0)
    rows = np.repeat(np.arange(count), 2 * m)
    columns = np.hstack([own, masters]).ravel()
    entries = np.hstack([np.tile(values.T, (len(first), 1)), -weights]).ravel()
    B = sp.csr_array(sp.coo_array((entries, (rows, columns)), shape=(count, len(mesh.points))))
    return sp.csr_array(B.T @ sp.diags_array(area) @ B)
