"""Meshes with every element split in eight are finer meshes of the same body."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from rotorgear.casings.fe_body import finite_element_body
from rotorgear.casings.patches import Cylinder, by_cylinder
from rotorgear.casings.reduction import free_modes
from rotorgear.casings.solid_mesh import SolidMesh, jacobians, solid_mesh
from rotorgear.casings.split import split, without_middles
from tests.unit.casings.blocks import block
from tests.unit.casings.test_reduction import held_at_its_foot, settings

pytest.importorskip("meshio")


def test_a_split_lattice_of_bricks_is_the_finer_lattice(tmp_path: Path) -> None:
    once = finite_element_body(replace(settings(tmp_path, (1, 1, 2), "hexahedron20"), splits=1))
    finer = finite_element_body(settings(tmp_path, (2, 2, 4), "hexahedron20"))
    assert once.dofs == finer.dofs
    assert free_modes(once, 4).frequency == pytest.approx(free_modes(finer, 4).frequency, rel=1e-8)
    assert "split in eight, 1 time" in once.mesh.notes[-1]


@pytest.mark.parametrize("kind", ["tetra", "tetra10", "hexahedron20"])
def test_splits_keep_mass_seats_and_held_nodes_and_soften_every_mode(tmp_path: Path, kind: str) -> None:
    file = held_at_its_foot(tmp_path, counts=(1, 1, 2), kind=kind)
    bodies = [finite_element_body(replace(file, splits=n)) for n in range(3)]
    for body in bodies[1:]:
        assert body.mass_properties[0] == pytest.approx(bodies[0].mass_properties[0], rel=1e-12)
        np.testing.assert_allclose(body.mass_properties[1], bodies[0].mass_properties[1], rtol=1e-12)
        assert body.seats[0].area == pytest.approx(bodies[0].seats[0].area, rel=1e-12)
        assert np.all(np.abs(body.mesh.points[body.held, 2]) < 1e-12)
        assert len(body.held) == np.count_nonzero(np.abs(body.mesh.points[:, 2]) < 1e-12)
    frequency = [free_modes(body, 3).frequency for body in bodies]
    # The displacements of a coarse mesh are among those of the finer one.
    assert np.all(frequency[1] < frequency[0])
    assert np.all(frequency[2] < frequency[1])


def curved(kind: str) -> SolidMesh:
    """A quarter of a tube about z, radii 30 and 50 mm, in curved elements."""
    found = block((1.0, 1.0, 0.04), (1, 3, 1), kind)
    radius = 0.03 + 0.02 * found.points[:, 0]
    angle = 0.5 * np.pi * found.points[:, 1]
    found.points[:, 0] = radius * np.cos(angle)
    found.points[:, 1] = radius * np.sin(angle)
    return solid_mesh(found, 1.0, "mesh")


def test_an_inclined_bore_is_found_where_the_mesh_is_turned() -> None:
    mesh = curved("hexahedron20")
    R = Rotation.from_rotvec([0.4, -0.9, 0.3]).as_matrix()
    at = np.array([0.02, 0.5, -0.1])
    inclined = replace(mesh, points=mesh.points @ R.T + at)
    upright = by_cylinder(mesh, Cylinder((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), -0.01, 0.05, 0.03), "seat")
    x, y, z = R[:, 2].tolist()
    found = by_cylinder(inclined, Cylinder((0.02, 0.5, -0.1), (x, y, z), -0.01, 0.05, 0.03), "seat")
    assert found.nodes.tolist() == upright.nodes.tolist()
    np.testing.assert_allclose(found.point, R @ upright.point + at, rtol=0.0, atol=1e-15)


@pytest.mark.parametrize("kind", ["tetra10", "hexahedron20"])
def test_curved_faces_stay_where_they_are_and_shapes_get_no_worse(kind: str) -> None:
    mesh = curved(kind)
    finer = split(split(mesh))
    assert np.all(jacobians(finer.points, finer.cells, finer.element) > 0.0)
    bore = Cylinder((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), -0.01, 0.05, 0.03)
    before = by_cylinder(mesh, bore, "seat")
    after = by_cylinder(finer, bore, "seat")
    assert after.area == pytest.approx(before.area, rel=1e-3)
    # Faces have one area, whichever mesh integrates it.
    assert len(finer.boundary) == 16 * len(mesh.boundary)


def test_tetrahedra_do_not_get_flatter_with_every_split() -> None:
    mesh = solid_mesh(block((0.1, 0.06, 0.2), (1, 1, 1), "tetra10"), 1.0, "mesh")

    def worst(one: SolidMesh) -> float:
        corners = one.points[one.cells[:, :4]]
        sides = corners[:, [0, 0, 0, 1, 1, 2]] - corners[:, [1, 2, 3, 2, 3, 3]]
        volume = np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1]))
        return float((volume / np.linalg.norm(sides, axis=2).max(axis=1) ** 3).min())

    assert worst(split(split(mesh))) > 0.6 * worst(mesh)
    assert worst(split(split(mesh))) == pytest.approx(worst(split(mesh)), rel=1e-9)


def test_linear_elements_on_the_same_corners_are_stiffer(tmp_path: Path) -> None:
    body = finite_element_body(settings(tmp_path, (1, 1, 2), "tetra10"))
    linear = without_middles(body.mesh)
    assert linear.kind == "tetra"
    assert len(linear.points) == 12
    assert set(linear.sets) == set(body.mesh.sets)


def test_a_seat_found_by_its_place_is_found_before_elements_are_split(tmp_path: Path) -> None:
    # Middles of straight edges lie off the bore, so that a search on the split mesh would miss most of it.
    from tests.unit.casings.blocks import write_inp

    tube = block((1.0, 1.0, 0.04), (1, 12, 1), "tetra")
    radius = 0.03 + 0.02 * tube.points[:, 0]
    angle = 1.5 * np.pi * tube.points[:, 1]
    tube.points[:, 0] = radius * np.cos(angle)
    tube.points[:, 1] = radius * np.sin(angle)
    file = settings(tmp_path)
    bore = Cylinder((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 0.0, 0.04, 0.03)
    file = replace(file, files=(("mesh", write_inp(tmp_path / "tube.inp", tube)),), seats=(("one", bore),))
    plain, once = (finite_element_body(replace(file, splits=n)).seats[0] for n in (0, 1))
    assert once.area == pytest.approx(plain.area, rel=1e-12)
    assert len(once.nodes) > 3 * len(plain.nodes)
    np.testing.assert_allclose(once.point, [0.0, 0.0, 0.02], atol=1e-15)
