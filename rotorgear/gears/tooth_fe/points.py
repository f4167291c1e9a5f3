"""Where the nodes of a pitch lie: the number of elements, their grading, and the points of rim and tooth. Lengths in modules.

The tooth points along +y, its loaded flank at x > 0: that of an external gear stands on the +y axis, that of a ring on the -y
axis, so that in both the rim lies below the tooth.

The tooth is a Coons patch between its flanks, the base curve and the tip arc; the rim is ruled between its inner circle and root,
fillets and base curve.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from rotorgear.gears.geometry.outline import ToothOutline
from rotorgear.gears.tooth_fe.elasticity import with_middles

# The curve between rim and tooth sags by this share of its half width, which keeps the angles at its ends open.
_SAG = 0.35
# Ratio of neighbouring columns of the tooth towards the loaded flank.
_COLUMN_RATIO = 1.3


@dataclass(frozen=True)
class MeshSize:
    """Elements of one pitch and along the face.

    Attributes:
        involute: rows on the involute.
        fillet: rows on half a fillet.
        tooth: columns across the tooth.
        land: columns on each side of it across the land between the teeth.
        rim: rows below the teeth.
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


def _geometric(count: int, ratio: float) -> np.ndarray:
    """Knots from 0 to 1 whose steps shrink by `ratio` each."""
    steps = ratio ** -np.arange(count, dtype=float)
    return np.concatenate([[0.0], np.cumsum(steps) / steps.sum()])


def flank_rolls(outline: ToothOutline, size: MeshSize) -> np.ndarray:
    """Roll lengths of the nodes on the involute, graded by arc length xi^2 / (2 r_b)."""
    low = outline.form_roll_length**2
    high = outline.tip_roll_length**2
    # Denser at both ends, where contact begins and tip corners touch.
    t = np.linspace(0.0, 1.0, size.involute + 1)
    share = with_middles(t - 0.5 * np.sin(2.0 * np.pi * t) / (2.0 * np.pi))
    return np.asarray(outline.geometry.sign * np.sqrt(low + (high - low) * share))


def _cartesian(outline: ToothOutline, radius: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """Points (n, 2) by radii (n,) and angles (n,) from the middle of the tooth, positive on the loaded side."""
    return np.stack([radius * np.sin(angle), outline.geometry.sign * radius * np.cos(angle)], -1)


def _mirror(points: np.ndarray) -> np.ndarray:
    return points * np.array([-1.0, 1.0])


def _base_curve(outline: ToothOutline, across: np.ndarray) -> np.ndarray:
    """Curve between rim and tooth, sagging into the rim; across (k,) runs from 0 on the left to 1 on the loaded side."""
    x, y = _cartesian(outline, *outline.fillet(np.array([0.5])))[0]
    s = 2.0 * across - 1.0
    return np.stack([x * s, y - _SAG * x * (1.0 - s**2)], -1)


def _across(size: MeshSize) -> np.ndarray:
    """Columns of the tooth from 0 on the left to 1 on the loaded flank, where they are densest."""
    return with_middles(_geometric(size.tooth, _COLUMN_RATIO))


def rim_points(outline: ToothOutline, size: MeshSize, inner_radius: float) -> np.ndarray:
    """Nodes (2 rim + 1, 2 columns + 1, 2) of the rim: straight lines from its held circle to root, fillets and base curve.

    That circle has the radius `inner_radius`; around the teeth of a ring it is the outer one.
    """
    sign = outline.geometry.sign
    pitch = 2.0 * math.pi / abs(outline.geometry.teeth)
    # From the cut along the root circle, then down the lower half of the fillet's parameter, as one curve by arc length.
    ends = _cartesian(outline, *outline.fillet(np.linspace(1.0, 0.5, 201)))
    root = np.linspace(0.5 * pitch, outline.root_half_angle, 51)[:-1]
    half = np.concatenate([_cartesian(outline, np.full(50, outline.root_radius), root), ends])
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(half, axis=0), axis=1))])
    wanted = np.linspace(0.0, length[-1], 2 * size.land + 1)
    side = np.stack([np.interp(wanted, length, half[:, k]) for k in (0, 1)], -1)
    top = np.concatenate([_mirror(side)[:-1], _base_curve(outline, _across(size)), side[::-1][1:]])
    # Halfway between the angles of the root and even ones: neither cells sheared at the root nor uneven at the inner circle.
    arc = np.unwrap(np.arctan2(top[:, 0], sign * top[:, 1]))
    even = np.linspace(-0.5 * pitch, 0.5 * pitch, len(arc))
    bottom = _cartesian(outline, np.full(len(arc), inner_radius), 0.5 * (arc + even))
    # Rows of a deep rim grow towards the inner circle, where the stresses of the teeth have died away.
    depth = abs(outline.root_radius - inner_radius)
    ratio = max(1.0, (depth / 3.0) ** (1.0 / size.rim)) if depth > 3.0 else 1.0
    t = with_middles(_geometric(size.rim, ratio))[:, None, None]
    return np.asarray((1.0 - t) * bottom + t * top)


def tooth_points(outline: ToothOutline, size: MeshSize) -> np.ndarray:
    """Nodes (2 (fillet + involute) + 1, 2 tooth + 1, 2) of the tooth: a Coons patch between flanks, base curve and tip arc."""
    fillet = _cartesian(outline, *outline.fillet(np.linspace(0.5, 0.0, 2 * size.fillet + 1)))
    right = np.concatenate([fillet[:-1], _cartesian(outline, *outline.involute(flank_rolls(outline, size)))])
    across = _across(size)
    half_tip = float(outline.involute(outline.tip_roll_length)[1])
    tip = _cartesian(outline, np.full(len(across), outline.tip_radius), half_tip * (2.0 * across - 1.0))
    base = _base_curve(outline, across)
    left = _mirror(right)
    s = across[None, :, None]
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(right, axis=0), axis=1))])
    t = (length / length[-1])[:, None, None]
    # Coons patch: both ruled surfaces less the bilinear one through the corners, which they count twice.
    ruled = (1.0 - s) * left[:, None] + s * right[:, None] + (1.0 - t) * base[None] + t * tip[None]
    corners = (1.0 - t) * ((1.0 - s) * base[0] + s * base[-1]) + t * ((1.0 - s) * tip[0] + s * tip[-1])
    return np.asarray(ruled - corners)
