"""The normal motion of a surface: a cube that moves along an axis sends air off two of its faces."""

from __future__ import annotations

import numpy as np
import pytest

from rotorgear.casings.reduced_body import Surface
from rotorgear.elements.spring import rigid_transfer
from tests.bar_casing import cube


def test_a_cube_that_moves_along_an_axis_pushes_with_two_faces() -> None:
    points, triangles = cube(0.4)
    surface = Surface(points, triangles, np.array([rigid_transfer(point)[:3] for point in points]))
    normals, areas = surface.normals_and_areas()
    assert np.einsum("tx,tx->t", normals, points[triangles].mean(axis=1)) == pytest.approx(0.2 * np.ones(12))
    assert areas == pytest.approx(0.08 * np.ones(12))
    W = surface.normal_motion()
    assert W[:3, :3] == pytest.approx(2.0 * 0.4**2 * np.eye(3), abs=1e-15)
    # Turning about z moves four faces: n.u = y on those across x, at the middles of their triangles +-0.2/3.
    assert W[5, 5] == pytest.approx(8 * 0.08 * (0.2 / 3.0) ** 2)


def test_walls_of_a_shell_off_the_origin_belong_to_the_side_where_they_stand() -> None:
    """A box of 0.4, 0.8 and 1.2 m about (5, -3, 2) with an inside of nine tenths, whose faces look inwards."""
    points, triangles = cube(0.4)
    sizes = np.array([1.0, 2.0, 3.0])
    outer, inner = points * sizes, 0.9 * points * sizes
    both = np.vstack([outer, inner]) + np.array([5.0, -3.0, 2.0])
    faces = np.vstack([triangles, triangles[:, ::-1] + len(points)])
    surface = Surface(both, faces, np.array([rigid_transfer(point)[:3] for point in both]))
    sides = surface.motion_of_sides
    assert sides.sum(axis=0) == pytest.approx(surface.normal_motion(), abs=1e-12)
    lengths = 0.4 * sizes
    for axis in range(3):
        area = (1.0 + 0.9**2) * np.prod(lengths) / lengths[axis]
        for side in range(6):
            expected = area if side // 2 == axis else 0.0
            assert sides[side][axis, axis] == pytest.approx(expected, abs=1e-12)
    # Turning about z at the origin: the walls at +-x move along x by -y of the middles of their triangles.
    y = surface.points[surface.triangles].mean(axis=1)[:, 1]
    normals, areas = surface.normals_and_areas()
    at = surface.points[surface.triangles].mean(axis=1)[:, 0]
    for side, here in ((0, at < 4.9), (1, at > 5.1)):
        there = here & (np.abs(normals[:, 0]) > 0.5)
        assert there.sum() == 4
        assert sides[side][5, 5] == pytest.approx(np.sum(areas[there] * y[there] ** 2))
