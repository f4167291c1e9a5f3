"""Patches of a mesh: seats, mounts and held faces, found by the name of a set or by their geometry; and their mean motion.

The mean motion q of a patch is the rigid motion that its displacements u are nearest to, in the mean over its area (RBE3):

    ∫ |u - R q|² dA = min:   q = (Rᵀ S R)⁻¹ Rᵀ S u = Wᵀ u,     S_ij = ∫ N_i N_j dA,    Wᵀ R = I

with the rigid motions R about the point of the patch. Where a set of nodes makes no face, all its nodes count the same.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from rotorgear.casings.reduced_body import rigid_motions
from rotorgear.casings.solid_mesh import SolidMesh
from rotorgear.errors import AnalysisError
from rotorgear.quantity import millimetres, nearest

# How far corners of the mesh may be from the cylinder of a seat, over its radius: a mesh has its corners on the surface.
_OFF_CYLINDER = 0.01
# Least singular value over the largest of the motions of a patch that has all six.
_SIX_MOTIONS = 1e-6
_LISTED = 12


@dataclass(frozen=True)
class Cylinder:
    """A bore: a point on its axis (m), the direction of that (a unit vector), its range from the point on and its radius."""

    center: tuple[float, float, float]
    direction: tuple[float, float, float]
    begin: float
    end: float
    radius: float


@dataclass(frozen=True)
class Patch:
    """Nodes of a mesh that move together.

    Attributes:
        name: as errors call it.
        nodes: (k,).
        surface_mass: (k, k) S of the docstring above in m^2; or the unit matrix.
        point: (3,) in m, about which it turns.
        area: in m^2; 0 where the nodes make no face.
    """

    name: str
    nodes: np.ndarray
    surface_mass: np.ndarray
    point: np.ndarray
    area: float

    def weights(self, points: np.ndarray) -> np.ndarray:
        """W (3k, 6): mean motion q = Wᵀ u of the displacements of the nodes.

        Raises:
            AnalysisError: nodes on a line or fewer than three, whose rotation is not known.
        """
        R = rigid_motions(points[self.nodes], self.point)
        singular = np.linalg.svd(R / np.linalg.norm(R, axis=0).clip(min=1e-300), compute_uv=False)
        if len(self.nodes) < 3 or singular[-1] < _SIX_MOTIONS * singular[0]:
            raise AnalysisError(
                f"{self.name}: its {len(self.nodes)} nodes lie on a line, or are fewer than three, so that their rotation is not "
                "known. Name a face."
            )
        SR = (self.surface_mass @ R.reshape(len(self.nodes), -1)).reshape(R.shape)
        return np.asarray(np.linalg.solve(R.T @ SR, SR.T).T)


def by_set(mesh: SolidMesh, set_name: str, address: str) -> Patch:
    """The patch of a named set.

    Raises:
        AnalysisError: no such set, or one without nodes on the solids.
    """
    one = mesh.sets.get(set_name)
    if one is None:
        names = list(mesh.sets)
        guess = nearest(set_name, names)
        there = ", ".join(names[:_LISTED]) + (" ..." if len(names) > _LISTED else "")
        none = "Gmsh 4.1 and Abaqus files keep named sets, VTK files as data of zeros and ones"
        if ".seats." in address:
            none = "give a place instead"
        hint = f"did you mean '{guess}'?" if guess else f"it has: {there}" if names else f"it has none: {none}"
        raise AnalysisError(f"{address}: the mesh has no set '{set_name}' ({hint}).")
    if not len(one.nodes):
        raise AnalysisError(f"{address}: the set '{set_name}' touches no node of the solids.")
    boundary = mesh.boundary
    chosen = one.faces_among(boundary, len(mesh.element.faces[0]))
    if not one.faces and len(one.nodes) > 0.5 * len(mesh.points) and chosen.all():
        raise AnalysisError(f"{address}: the set '{set_name}' is the whole body; name a face of it.")
    return patch_of(mesh, boundary[chosen], one.nodes, f"{address} ('{set_name}')")


def cylinder_faces(mesh: SolidMesh, cylinder: Cylinder, address: str) -> np.ndarray:
    """Outer faces (f, m) of a bore: with their corners on the cylinder and their middle within its range.

    Raises:
        AnalysisError: nothing there; the text says what is near.
    """
    boundary = mesh.boundary
    corners = mesh.points[boundary[:, : len(mesh.element.faces[0])]] - np.array(cylinder.center)
    direction = np.array(cylinder.direction)
    along = corners @ direction
    radius = np.linalg.norm(corners - along[:, :, None] * direction, axis=2)
    middle = along.mean(axis=1)
    within = (middle >= cylinder.begin) & (middle <= cylinder.end)
    chosen = within & (np.abs(radius - cylinder.radius) <= _OFF_CYLINDER * cylinder.radius).all(axis=1)
    if not chosen.any():
        low, high = mesh.points.min(axis=0), mesh.points.max(axis=0)
        box = ", ".join(
            f"{axis} {millimetres(a)} to {millimetres(b)}" for axis, a, b in zip("xyz", low, high, strict=True)
        )
        least = millimetres(radius[within].min()) if within.any() else ""
        near = f"; faces in its range are {least} or more from its axis" if least else ""
        raise AnalysisError(
            f"{address}: no face of the mesh lies on this cylinder (radius {millimetres(cylinder.radius)}){near}. The mesh "
            f"reaches over {box}."
        )
    return np.asarray(boundary[chosen])


def by_cylinder(mesh: SolidMesh, cylinder: Cylinder, address: str) -> Patch:
    """The patch of a bore, which turns about its middle; a set of the name `address` has its faces, where there is one.

    Raises:
        AnalysisError: as of `cylinder_faces`.
    """
    if address in mesh.sets:
        patch = by_set(mesh, address, address)
    else:
        faces = cylinder_faces(mesh, cylinder, address)
        patch = patch_of(mesh, faces, np.unique(faces), address)
    point = np.array(cylinder.center) + 0.5 * (cylinder.begin + cylinder.end) * np.array(cylinder.direction)
    return replace(patch, name=address, point=point)


def patch_of(mesh: SolidMesh, faces: np.ndarray, nodes: np.ndarray, name: str) -> Patch:
    """The patch of faces; of the nodes alone where there are none."""
    if not len(faces):
        return Patch(name, nodes, np.eye(len(nodes)), mesh.points[nodes].mean(axis=0), 0.0)
    nodes, local = np.unique(faces, return_inverse=True)
    local = local.reshape(faces.shape)
    values, areas = face_areas(mesh, faces)
    S = np.zeros((len(nodes), len(nodes)))
    blocks = np.einsum("aq,bq,fq->fab", values, values, areas)
    np.add.at(S, (local[:, :, None], local[:, None, :]), blocks)
    area = float(areas.sum())
    return Patch(name, nodes, S, S.sum(axis=0) @ mesh.points[nodes] / area, area)


def face_areas(mesh: SolidMesh, faces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Shape functions (m, q) at the Gauss points of faces (f, m), and the areas (f, q) that belong to the points."""
    face = mesh.element.face
    places, weights = face.quadrature(4)
    values, gradients = face.shapes(places)
    tangents = np.einsum("fki,kjq->fqji", mesh.points[faces], gradients)
    return values, np.linalg.norm(np.cross(tangents[:, :, 0], tangents[:, :, 1]), axis=2) * weights
