"""Surfaces as plain arrays: bodies of revolution, twisted prisms (teeth), balls and symbols, each about the axis x = y = 0.

Corners run counter-clockwise seen from outside, so the volume by the divergence theorem, V = sum(p1 . (p2 x p3)) / 6 over the
triangles of a closed surface, is positive. Lengths in m, angles in rad.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Surface:
    """A surface of quadrangles and triangles.

    Attributes:
        points: (P, 3) in m.
        quads: (Q, 4) numbers of the corners.
        triangles: (T, 3) numbers of the corners.
    """

    points: np.ndarray
    quads: np.ndarray
    triangles: np.ndarray

    def moved(self, offset: Sequence[float]) -> Surface:
        """The same surface shifted by (x, y, z) in m."""
        return Surface(self.points + np.asarray(offset, float), self.quads, self.triangles)

    def volume(self) -> float:
        """Enclosed volume in m^3, if the surface is closed."""
        split = np.concatenate([self.quads[:, [0, 1, 2]], self.quads[:, [0, 2, 3]], self.triangles])
        a, b, c = (self.points[split[:, k]] for k in range(3))
        return float(np.sum(a * np.cross(b, c)) / 6.0)


def make_surface(points: np.ndarray, quads: Sequence[np.ndarray] = (), triangles: Sequence[np.ndarray] = ()) -> Surface:
    """A surface from its points and blocks of cells of shapes (..., 4) and (..., 3)."""
    return Surface(
        np.asarray(points, float).reshape(-1, 3),
        np.concatenate([np.zeros((0, 4), int), *(np.reshape(block, (-1, 4)) for block in quads)]),
        np.concatenate([np.zeros((0, 3), int), *(np.reshape(block, (-1, 3)) for block in triangles)]),
    )


def join(surfaces: Sequence[Surface]) -> Surface:
    """Several surfaces as one; the order of quads and that of triangles is kept."""
    starts = np.cumsum([0, *(len(surface.points) for surface in surfaces)])
    return make_surface(
        np.concatenate([np.zeros((0, 3)), *(surface.points for surface in surfaces)]),
        [surface.quads + start for surface, start in zip(surfaces, starts, strict=False)],
        [surface.triangles + start for surface, start in zip(surfaces, starts, strict=False)],
    )


def revolve(contour: np.ndarray, segments: int, closed: bool = False) -> Surface:
    """A body of revolution.

    Args:
        contour: (k, 2) radius and z, from left to right where it is an outer surface; radius 0 is a point on the axis.
        segments: straight pieces around the axis.
        closed: join the last point of the contour with the first (a hollow body).
    """
    angle = np.linspace(0.0, 2.0 * np.pi, segments, endpoint=False)
    points: list[np.ndarray] = []
    rings = []
    # A point on the axis stands for a whole ring: its number is repeated, and its cells become triangles.
    for radius, z in contour:
        start = sum(map(len, points))
        around = angle if radius > 0.0 else angle[:1]
        points.append(np.column_stack([radius * np.cos(around), radius * np.sin(around), np.full(len(around), z)]))
        rings.append(start + np.arange(segments) % len(around))
    quads = []
    triangles = []
    for low, high in zip(rings, rings[1:] + rings[:1] if closed else rings[1:], strict=False):
        low_next = np.roll(low, -1)
        high_next = np.roll(high, -1)
        if low[0] == low[-1] and high[0] == high[-1]:
            continue  # along the axis
        if low[0] == low[-1]:
            triangles.append(np.column_stack([low, high_next, high]))
        elif high[0] == high[-1]:
            triangles.append(np.column_stack([low, low_next, high]))
        else:
            quads.append(np.column_stack([low, low_next, high_next, high]))
    return make_surface(np.concatenate(points), quads, triangles)


def hollow_cylinder(outer_radius: float, inner_radius: float, low: float, high: float, segments: int) -> Surface:
    """A closed cylinder between two values of z, solid for inner_radius = 0."""
    inner = max(inner_radius, 0.0)
    corners = [[inner, low], [outer_radius, low], [outer_radius, high], [inner, high]]
    return revolve(np.array(corners), segments, closed=inner > 0.0)


def twisted_prism(angles: np.ndarray, radii: np.ndarray, z: np.ndarray, twist: np.ndarray, inner: float) -> Surface:
    """A closed prism whose star-shaped contour turns along z, around a hole or, of a ring with its teeth inside, in a cylinder.

    Args:
        angles: (n, c) of the contour of n equal teeth with c points each, counter-clockwise.
        radii: (n, c) of the contour.
        z: (s,) places along the axis, rising.
        twist: (s,) the contour's rotation there.
        inner: radius of the hole, with one point a tooth, 0 for none; beyond the contour that of the cylinder around it.
    """
    count, corners = angles.shape
    s = len(z)
    size = angles.size
    turned = angles.ravel() + twist[:, None]
    side = np.stack([radii.ravel() * np.cos(turned), radii.ravel() * np.sin(turned), np.tile(z[:, None], size)], -1)
    index = np.arange(s * size).reshape(s, size)
    following = np.roll(index, -1, axis=1)
    quads = [np.stack([index[:-1], following[:-1], following[1:], index[1:]], -1)]

    # Points of the hole's edge on both faces, one a tooth, or the two middles of the faces.
    if inner > 0.0:
        edge = angles[:, 0] + twist[[0, -1]][:, None]
        points = [inner * np.cos(edge), inner * np.sin(edge), np.tile(z[[0, -1]][:, None], count)]
        hole = np.stack(points, -1).reshape(-1, 3)
    else:
        hole = np.array([[0.0, 0.0, z[0]], [0.0, 0.0, z[-1]]])
    core = s * size + np.arange(2 * (count if inner > 0.0 else 1)).reshape(2, -1)
    core = np.broadcast_to(core, (2, count))

    # Faces: each tooth a fan from its point of the hole, and the gap to the next tooth.
    triangles = []
    for end, order in ((0, -1), (-1, 1)):  # the left face looks towards -z
        rim = index[end].reshape(count, corners)
        fan = np.stack([np.tile(core[end][:, None], corners - 1), rim[:, :-1], rim[:, 1:]], -1)
        triangles.append(fan[..., ::order])
        ring = rim[:, -1]
        ring_next = np.roll(rim[:, 0], -1)
        core_next = np.roll(core[end], -1)
        if inner > 0.0:
            quads.append(np.stack([core[end], ring, ring_next, core_next], -1)[:, ::order])
        else:
            triangles.append(np.stack([core[end], ring, ring_next], -1)[:, ::order])
    if inner > 0.0:
        low, high = core
        quads.append(np.stack([low, high, np.roll(high, -1), np.roll(low, -1)], -1))
    if inner > radii.max():  # what was outside is inside
        quads = [cells[..., ::-1] for cells in quads]
        triangles = [cells[..., ::-1] for cells in triangles]
    return make_surface(np.concatenate([side.reshape(-1, 3), hole]), quads, triangles)


def ball(radius: float, segments: int) -> Surface:
    """A ball about the origin."""
    latitude = np.linspace(-0.5 * np.pi, 0.5 * np.pi, max(segments // 2, 4) + 1)
    contour = np.column_stack([radius * np.cos(latitude), radius * np.sin(latitude)])
    contour[[0, -1], 0] = 0.0
    return revolve(contour, segments)


def wedge(top: float, bottom: float, half_width: float, low: float, high: float) -> Surface:
    """The sign for the ground: a triangular prism with its edge (points 0 and 3) at y = top and its base at y = bottom < top."""
    corners = np.array([[0.0, top], [-half_width, bottom], [half_width, bottom]])
    points = np.vstack([np.column_stack([corners, np.full(3, z)]) for z in (low, high)])
    sides = np.array([[0, 1, 4, 3], [1, 2, 5, 4], [2, 0, 3, 5]])
    return make_surface(points, [sides], [np.array([[0, 2, 1], [3, 4, 5]])])


def beam(start: np.ndarray, end: np.ndarray, half: float) -> Surface:
    """A square bar between two points, upright in z; points 0 to 3 belong to its start, 4 to 7 to its end."""
    along = (end - start) / np.linalg.norm(end - start)
    across = np.cross(along, [0.0, 0.0, 1.0])
    across = across / np.linalg.norm(across) if np.linalg.norm(across) > 1e-6 else np.array([1.0, 0.0, 0.0])
    up = np.cross(across, along)
    ring = half * np.array([across + up, across - up, -across - up, -across + up])
    sides = [[k, (k + 1) % 4, (k + 1) % 4 + 4, k + 4] for k in range(4)]
    return make_surface(np.vstack([start + ring, end + ring]), [np.array([*sides, [3, 2, 1, 0], [4, 5, 6, 7]])])
