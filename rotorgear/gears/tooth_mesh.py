"""Mapped quadratic mesh of one pitch of a gear: a rim block as wide as the pitch with a tooth block on its middle.

Parameter space is a lattice: columns I run across the pitch, rows J from the inner circle to the tip. The two blocks meet on a
curve through the middle of both fillets. Quadratic elements (9 nodes) are built on the lattice by scikit-fem and all their
nodes are then mapped onto the tooth, so their edges follow involute and trochoid. Lengths in normal modules.

The tooth stands on the +y axis, its loaded flank at x > 0; columns and rows are graded towards that flank and to its ends.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from rotorgear.errors import AnalysisError, MissingExtraError
from rotorgear.gears.outline import ToothOutline

# The curve between rim and tooth sags by this share of its half width, which keeps the angles at its ends open.
_SAG = 0.35
# Ratio of neighbouring columns of the tooth towards the loaded flank.
_COLUMN_RATIO = 1.3
# The least radius of the rim's inner circle over that of the root: below, cells would turn over.
LEAST_INNER = 0.5


@dataclass(frozen=True)
class MeshSize:
    """Elements of one pitch and along the face.

    Attributes:
        involute, fillet, rim: rows on the involute, on half a fillet, and below the teeth.
        tooth, land: columns across the tooth, and on each side of it across the land between the teeth.
        face: layers along the face width (3D only).
    """

    involute: int
    fillet: int
    tooth: int
    land: int
    rim: int
    face: int = 0

    @property
    def columns(self) -> int:
        """Columns of the whole pitch."""
        return self.tooth + 2 * self.land

    @property
    def elements(self) -> int:
        """Elements of one pitch in the transverse plane."""
        return self.columns * self.rim + self.tooth * (self.involute + self.fillet)


@dataclass(frozen=True)
class PitchMesh:
    """The quadratic mesh of one pitch in the transverse plane.

    Attributes:
        outline: of the tooth, normal module 1.
        points: (p, 2) nodes in normal modules.
        cells: (9, e) nodes of the elements in scikit-fem's order.
        mesh: the scikit-fem mesh (MeshQuad2) itself.
        lattice: (p, 2) doubled lattice numbers of the nodes.
        inner, left, right: nodes on the inner circle, and on the two cuts by rising radius, without the inner circle.
        flank: nodes of the loaded involute by rising roll length; `roll` (k,) are their roll lengths.
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
    def loaded_column(self) -> int:
        """Doubled lattice number of the column on the loaded flank."""
        return int(self.lattice[self.flank[0], 0])

    @property
    def tooth_rows(self) -> tuple[int, int]:
        """Doubled lattice numbers of the rows where tooth and involute begin."""
        return int(self.lattice[self.right[-1], 1]), int(self.lattice[self.flank[0], 1])

    @property
    def pitch_angle(self) -> float:
        """2 pi / z (rad)."""
        return 2.0 * math.pi / self.outline.geometry.teeth


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
    if not 0.0 < inner_radius < outline.root_radius:
        raise AnalysisError(
            f"The inner radius of the gear's body, {inner_radius:.4g} normal modules, must lie between 0 and the root radius, "
            f"{outline.root_radius:.4g}."
        )
    skfem = scikit_fem()
    corners, cells = _cells(size)
    straight = skfem.MeshQuad2.from_mesh(
        skfem.MeshQuad(np.ascontiguousarray(corners.T, float), np.ascontiguousarray(cells.T))
    )
    lattice = np.rint(2.0 * straight.doflocs.T).astype(int)
    grids = _rim_points(outline, size, inner_radius), _tooth_points(outline, size)
    points = _mapped(lattice, grids, size)
    mesh = skfem.MeshQuad2(np.ascontiguousarray(points.T), straight.t)
    low = 2 * (size.rim + size.fillet)
    flank = _on(lattice, (lattice[:, 0] == 2 * (size.land + size.tooth)) & (lattice[:, 1] >= low), 1)
    roll = _flank_rolls(outline, size)
    g = outline.base_half_angle - roll / outline.geometry.base_radius
    found = PitchMesh(
        outline=outline,
        points=points,
        cells=mesh.dofs.element_dofs,
        lattice=lattice,
        inner=_on(lattice, lattice[:, 1] == 0, 0),
        left=_on(lattice, (lattice[:, 0] == 0) & (lattice[:, 1] > 0), 1),
        right=_on(lattice, (lattice[:, 0] == 2 * size.columns) & (lattice[:, 1] > 0), 1),
        flank=flank,
        roll=roll,
        normal=np.stack([np.cos(g), -np.sin(g)], -1),
        mesh=mesh,
    )
    _require_sound(found)
    return found


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


def _mapped(lattice: np.ndarray, grids: tuple[np.ndarray, np.ndarray], size: MeshSize) -> np.ndarray:
    rim, tooth = grids
    inside = lattice[:, 1] <= 2 * size.rim
    points = np.empty(lattice.shape)
    points[inside] = rim[lattice[inside, 1], lattice[inside, 0]]
    above = lattice[~inside]
    points[~inside] = tooth[above[:, 1] - 2 * size.rim, above[:, 0] - 2 * size.land]
    return points


def _halves(knots: np.ndarray) -> np.ndarray:
    """Knots with the middle of each interval between them."""
    found = np.empty(2 * len(knots) - 1)
    found[::2], found[1::2] = knots, 0.5 * (knots[1:] + knots[:-1])
    return found


def _graded_ends(count: int) -> np.ndarray:
    """Knots from 0 to 1 that are denser at both ends."""
    t = np.linspace(0.0, 1.0, count + 1)
    return t - 0.5 * np.sin(2.0 * np.pi * t) / (2.0 * np.pi)


def _geometric(count: int, ratio: float) -> np.ndarray:
    """Knots from 0 to 1 whose steps shrink by `ratio` each."""
    steps = ratio ** -np.arange(count, dtype=float)
    return np.concatenate([[0.0], np.cumsum(steps) / steps.sum()])


def _flank_rolls(outline: ToothOutline, size: MeshSize) -> np.ndarray:
    """Roll lengths of the nodes on the involute, equal to the arc length's grading: arc = xi^2 / (2 r_b)."""
    low, high = outline.form_roll_length**2, outline.tip_roll_length**2
    return np.sqrt(low + (high - low) * _halves(_graded_ends(size.involute)))


def _cartesian(radius: np.ndarray, angle: np.ndarray) -> np.ndarray:
    return np.stack([radius * np.sin(angle), radius * np.cos(angle)], -1)


def _mirror(points: np.ndarray) -> np.ndarray:
    return points * np.array([-1.0, 1.0])


def _base_curve(outline: ToothOutline, across: np.ndarray) -> np.ndarray:
    """Curve between rim and tooth, sagging towards the axis; across (k,) runs from 0 on the left to 1 on the loaded side."""
    x, y = _cartesian(*outline.fillet(np.array([0.5])))[0]
    s = 2.0 * across - 1.0
    return np.stack([x * s, y - _SAG * x * (1.0 - s**2)], -1)


def _across(size: MeshSize) -> np.ndarray:
    return _halves(_geometric(size.tooth, _COLUMN_RATIO))


def _rim_points(outline: ToothOutline, size: MeshSize, inner_radius: float) -> np.ndarray:
    """Nodes (2 rim + 1, 2 columns + 1, 2) of the rim: straight lines from its inner circle to root, fillets and base curve."""
    pitch = 2.0 * math.pi / outline.geometry.teeth
    # From the cut along the root circle, then down the lower half of the fillet's parameter, as one curve by arc length.
    ends = _cartesian(*outline.fillet(np.linspace(1.0, 0.5, 201)))
    root = np.linspace(0.5 * pitch, outline.root_half_angle, 51)[:-1]
    half = np.concatenate([_cartesian(np.full(50, outline.root_radius), root), ends])
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(half, axis=0), axis=1))])
    wanted = np.linspace(0.0, length[-1], 2 * size.land + 1)
    side = np.stack([np.interp(wanted, length, half[:, k]) for k in (0, 1)], -1)
    top = np.concatenate([_mirror(side)[:-1], _base_curve(outline, _across(size)), side[::-1][1:]])
    arc = np.unwrap(np.arctan2(top[:, 0], top[:, 1]))
    even = np.linspace(-0.5 * pitch, 0.5 * pitch, len(arc))
    bottom = _cartesian(np.full(len(arc), inner_radius), 0.5 * (arc + even))
    depth = outline.root_radius - inner_radius
    ratio = max(1.0, (depth / 3.0) ** (1.0 / size.rim)) if depth > 3.0 else 1.0
    t = _halves(_geometric(size.rim, ratio))[:, None, None]
    return np.asarray((1.0 - t) * bottom + t * top)


def _tooth_points(outline: ToothOutline, size: MeshSize) -> np.ndarray:
    """Nodes (2 (fillet + involute) + 1, 2 tooth + 1, 2) of the tooth: a Coons patch between flanks, base curve and tip arc."""
    fillet = _cartesian(*outline.fillet(np.linspace(0.5, 0.0, 2 * size.fillet + 1)))
    right = np.concatenate([fillet[:-1], _cartesian(*outline.involute(_flank_rolls(outline, size)))])
    across = _across(size)
    half_tip = float(outline.involute(outline.tip_roll_length)[1])
    tip = _cartesian(np.full(len(across), outline.tip_radius), half_tip * (2.0 * across - 1.0))
    base, left = _base_curve(outline, across), _mirror(right)
    s = across[None, :, None]
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(right, axis=0), axis=1))])
    t = (length / length[-1])[:, None, None]
    ruled = (1.0 - s) * left[:, None] + s * right[:, None] + (1.0 - t) * base[None] + t * tip[None]
    corners = (1.0 - t) * ((1.0 - s) * base[0] + s * base[-1]) + t * ((1.0 - s) * tip[0] + s * tip[-1])
    return np.asarray(ruled - corners)


def _require_sound(found: PitchMesh) -> None:
    """AnalysisError where an element is turned over or nearly so."""
    skfem = scikit_fem()
    determinant = skfem.Basis(found.mesh, skfem.ElementQuad2(), intorder=4).dx
    if not determinant.min() > 0.0:
        g = found.outline.geometry
        raise AnalysisError(
            f"The teeth of a gear with z = {g.teeth}, x = {g.profile_shift:.4g} are undercut so deeply that they can't be "
            "meshed: use more teeth or more profile shift."
        )
