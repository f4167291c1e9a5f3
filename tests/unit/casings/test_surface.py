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
