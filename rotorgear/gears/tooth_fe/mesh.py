"""Mapped quadratic mesh of one pitch of a gear: a rim block as wide as the pitch with a tooth block on its middle.

Parameter space is a lattice: columns I run across the pitch, rows J from the inner circle to the tip. The two blocks meet on a
curve through the middle of both fillets. Quadratic elements (9 nodes) are built on the lattice by scikit-fem and all their
nodes are then mapped onto the tooth, so their edges follow involute and trochoid. Lengths in normal modules.

The tooth stands on the +y axis, its loaded flank at x > 0; columns and rows are graded towards that flank and to its ends.
That of a ring stands on the -y axis, its tip up, too: then all of its formulas are those of an external tooth with z and radii
below 0, and "inner" is the circle around it where its rim ends.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from rotorgear.errors import AnalysisError, MissingExtraError
from rotorgear.gears.geometry.outline import ToothOutline
from rotorgear.gears.tooth_fe.points import MeshSize, flank_rolls, rim_points, tooth_points

# The least radius of the rim's inner circle over that of the root: below, cells would turn over.
LEAST_INNER = 0.5


@dataclass(frozen=True)
class PitchMesh:
    """The quadratic mesh of one pitch in the transverse plane.

    Attributes:
        outline: of the tooth, normal module 1.
        points: (p, 2) nodes in normal modules.
        cells: (9, e) nodes of the elements in scikit-fem's order.
        mesh: the scikit-fem mesh (MeshQuad2) itself.
        lattice: (p, 2) doubled lattice numbers of the nodes, so that middle nodes have whole numbers too.
        inner: nodes on the inner circle.
        left: nodes on the left cut by rising radius, without the inner circle.
        right: nodes on the right cut, likewise.
        flank: (k,) nodes of the loaded involute by rising roll length.
        roll: (k,) roll lengths of the flank nodes, with the sign of z.
        normal: (k, 2) outward unit normals at the flank nodes.
    """

    outline: ToothOutline
    points: np.ndarray
    cells: np.ndarray
    lattice: np.ndarray
    inner: np.ndarray
    left: np.ndarray
    right: np.ndarray
    flank: np.ndarray
    roll: np.ndarray
    normal: np.ndarray
    mesh: Any = field(repr=False, compare=False)

    @property
    def pitch_angle(self) -> float:
        """2 pi / z (rad): clockwise to the next tooth, on the side of the loaded flank."""
        return 2.0 * math.pi / self.outline.geometry.teeth

    @property
    def twist(self) -> float:
        """tan(b_b)/r_b: angle by which the section turns clockwise over the length along the face."""
        return float(np.tan(self.outline.geometry.base_helix_angle) / self.outline.geometry.base_radius)

    @property
    def helicoid_normal(self) -> np.ndarray:
        """(k, 3) outward unit normals of the helicoid at the flank nodes."""
        b = self.outline.geometry.base_helix_angle
        return np.hstack([np.cos(b) * self.normal, np.full((len(self.normal), 1), -np.sin(b))])


def scikit_fem() -> Any:
    """The package scikit-fem; MissingExtraError where it is not installed."""
    try:
        import skfem
    except ImportError:
        raise MissingExtraError("The finite-element model of teeth", "scikit-fem", "tooth") from None
    return skfem


def pitch_mesh(outline: ToothOutline, size: MeshSize, inner_radius: float) -> PitchMesh:
    """Mesh one pitch of a gear down to a circle of `inner_radius` (normal modules).

    Raises:
        AnalysisError: the inner circle lies outside the root circle, or cells would turn over.
        MissingExtraError: scikit-fem is not installed.
    """
    if outline.geometry.is_internal and not outline.root_radius < inner_radius < math.inf:
        raise AnalysisError(
            f"The outer radius of the ring's body, {inner_radius:.4g} normal modules, must be above the root radius, "
            f"{outline.root_radius:.4g}."
        )
    if not outline.geometry.is_internal and not 0.0 < inner_radius < outline.root_radius:
        raise AnalysisError(
            f"The inner radius of the gear's body, {inner_radius:.4g} normal modules, must lie between 0 and the root radius, "
            f"{outline.root_radius:.4g}."
        )
    skfem = scikit_fem()

    # Elements on the lattice; every node, also in the middle of an edge or cell, is then mapped onto its place.
    corners, cells = _cells(size)
    straight = skfem.MeshQuad2.from_mesh(
        skfem.MeshQuad(np.ascontiguousarray(corners.T, float), np.ascontiguousarray(cells.T))
    )
    lattice = np.rint(2.0 * straight.doflocs.T).astype(int)
    rim = rim_points(outline, size, inner_radius)
    tooth = tooth_points(outline, size)
    in_rim = lattice[:, 1] <= 2 * size.rim
    in_tooth = lattice[~in_rim]
    points = np.empty(lattice.shape)
    points[in_rim] = rim[lattice[in_rim, 1], lattice[in_rim, 0]]
    points[~in_rim] = tooth[in_tooth[:, 1] - 2 * size.rim, in_tooth[:, 0] - 2 * size.land]
    mesh = skfem.MeshQuad2(np.ascontiguousarray(points.T), straight.t)
    low = 2 * (size.rim + size.fillet)
    flank = _on(lattice, (lattice[:, 0] == 2 * (size.land + size.tooth)) & (lattice[:, 1] >= low), 1)
    roll = flank_rolls(outline, size)

    # The normal of an involute is tangent to the base circle, at the angle eta_b -+ xi / r_b from the tooth's middle.
    sign = outline.geometry.sign
    normal_angle = outline.base_half_angle - sign * roll / outline.geometry.base_radius
    pitch = PitchMesh(
        outline=outline,
        points=points,
        cells=mesh.dofs.element_dofs,
        lattice=lattice,
        inner=_on(lattice, lattice[:, 1] == 0, 0),
        left=_on(lattice, (lattice[:, 0] == 0) & (lattice[:, 1] > 0), 1),
        right=_on(lattice, (lattice[:, 0] == 2 * size.columns) & (lattice[:, 1] > 0), 1),
        flank=flank,
        roll=roll,
        normal=np.stack([np.cos(normal_angle), -sign * np.sin(normal_angle)], -1),
        mesh=mesh,
    )

    # A Jacobian that is not positive at a quadrature point: the flank of a deep undercut folds the mapped elements over.
    if not skfem.Basis(mesh, skfem.ElementQuad2(), intorder=4).dx.min() > 0.0:
        g = outline.geometry
        raise AnalysisError(
            f"The teeth of a gear with z = {g.teeth}, x = {g.profile_shift:.4g} are undercut so deeply that they can't be "
            "meshed: use more teeth or more profile shift."
        )
    return pitch


def _cells(size: MeshSize) -> tuple[np.ndarray, np.ndarray]:
    """Corner points (c, 2) and cells (e, 4) of the lattice, counter-clockwise."""
    rim = [(i, j) for j in range(size.rim) for i in range(size.columns)]
    top = size.rim + size.fillet + size.involute
    tooth = [(i, j) for j in range(size.rim, top) for i in range(size.land, size.land + size.tooth)]
    low = np.array(rim + tooth)
    square = low[:, None, :] + np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    corners, cells = np.unique(square.reshape(-1, 2), axis=0, return_inverse=True)
    return corners, cells.reshape(-1, 4)


def _on(lattice: np.ndarray, chosen: np.ndarray, axis: int) -> np.ndarray:
    """Numbers of chosen nodes, by rising lattice number along an axis."""
    nodes = np.flatnonzero(chosen)
    return nodes[np.argsort(lattice[nodes, axis], kind="stable")]
