"""Meshes that do not integrate as they come: each is put right and told, or refused with its name."""

from __future__ import annotations

import numpy as np
import pytest

from rotorgear.casings.assembly import Elastic, assemble
from rotorgear.casings.file_mesh import FileMesh, NamedSet
from rotorgear.casings.patches import by_set
from rotorgear.casings.reduced_body import rigid_motions
from rotorgear.casings.solid_mesh import merged, solid_mesh
from rotorgear.errors import AnalysisError
from tests.unit.casings.blocks import block

STEEL = Elastic(206e9, 0.3, 7850.0)
SIZE = (0.1, 0.06, 0.2)


def mass_of(found: FileMesh) -> float:
    mesh = solid_mesh(found, 1.0, "casings.b.mesh")
    R = rigid_motions(mesh.points)
    return float(R[:, 0] @ assemble(mesh, STEEL).times_mass(R[:, :1])[:, 0])


@pytest.mark.parametrize("kind", ["tetra", "tetra10", "hexahedron", "hexahedron20"])
def test_a_block_has_its_mass_and_rigid_motions_strain_nothing(kind: str) -> None:
    mesh = solid_mesh(block(SIZE, (1, 1, 2), kind), 1.0, "casings.b.mesh")
    matrices = assemble(mesh, STEEL)
    R = rigid_motions(mesh.points)
    assert R[:, 0] @ matrices.times_mass(R)[:, 0] == pytest.approx(7850.0 * np.prod(SIZE), rel=1e-12)
    residual = np.linalg.norm(matrices.stiffness @ R) / np.linalg.norm(R)
    assert residual / abs(matrices.stiffness.data).max() < 1e-14
    assert len(mesh.boundary) == (20 if kind.startswith("tetra") else 10)


def test_linear_elements_become_quadratic_and_their_sets_get_the_nodes_between() -> None:
    linear = solid_mesh(block(kind="tetra"), 1.0, "casings.b.mesh")
    quadratic = solid_mesh(block(kind="tetra10"), 1.0, "casings.b.mesh")
    assert linear.raised
    assert not quadratic.raised
    assert "12 linear tetrahedra were raised" in linear.notes[0]
    assert sorted(map(tuple, linear.points)) == sorted(map(tuple, quadratic.points))
    assert len(linear.sets["low"].nodes) == len(quadratic.sets["low"].nodes) == 9


def test_an_element_folded_by_its_curvature_is_named_and_straightened() -> None:
    found = block()
    straight = mass_of(found)
    cell = found.cells["tetra10"][6]
    found.points[cell[4]] += 2.0 * (found.points[cell[2]] - found.points[cell[4]])
    mesh = solid_mesh(found, 1.0, "casings.b.mesh")
    assert mesh.jacobian_low < 0.0
    assert 6 in mesh.straightened
    note = " ".join(mesh.notes)
    assert "7" in note
    assert "negative" in note
    assert "straight edges" in note
    assert mass_of(found) == pytest.approx(straight, rel=1e-12)


def test_a_set_of_the_corners_of_quadratic_faces_is_the_faces() -> None:
    found = block(SIZE, (1, 1, 2), "tetra10")
    corners = np.unique(found.cells["tetra10"][:, :4])
    low = found.sets["low"].nodes
    found.sets["corners"] = NamedSet(np.intersect1d(low, corners))
    mesh = solid_mesh(found, 1.0, "casings.b.mesh")
    whole, some = (by_set(mesh, name, "casings.b.seats.one") for name in ("low", "corners"))
    assert some.area == pytest.approx(SIZE[0] * SIZE[1])
    assert some.nodes.tolist() == whole.nodes.tolist()


def test_elements_numbered_the_other_way_round_are_mirrored() -> None:
    found = block(kind="tetra")
    found.cells["tetra"] = found.cells["tetra"][:, [1, 0, 2, 3]]
    assert mass_of(found) == pytest.approx(7850.0 * np.prod(SIZE), rel=1e-12)


def test_nodes_between_in_another_order_are_put_right_by_their_places() -> None:
    found = block()
    usual = mass_of(found)
    found.cells["tetra10"] = found.cells["tetra10"][:, [0, 1, 2, 3, 4, 5, 6, 7, 9, 8]]
    mesh = solid_mesh(found, 1.0, "casings.b.mesh")
    assert "another order" in mesh.notes[0]
    assert mass_of(found) == pytest.approx(usual, rel=1e-12)


def refused(found: FileMesh) -> str:
    with pytest.raises(AnalysisError) as error:
        solid_mesh(found, 1.0, "casings.b.mesh")
    assert str(error.value).startswith("casings.b.mesh: ")
    return str(error.value)


def test_what_can_not_be_computed_is_refused_by_name() -> None:
    flat = block(kind="tetra")
    flat.points[flat.cells["tetra"][3]] = flat.points[flat.cells["tetra"][3]] * [1.0, 1.0, 0.0]
    assert "no volume" in refused(flat)

    tets = block(kind="tetra")
    assert "wedge" in refused(FileMesh(tets.points, {**tets.cells, "wedge": np.array([[0, 1, 2, 3, 4, 5]])}))
    assert "no solid cells (cells: 1 triangle)" in refused(FileMesh(tets.points, {"triangle": np.array([[0, 1, 2]])}))
    assert "mixes tetra and hexahedron" in refused(
        FileMesh(tets.points, {**tets.cells, "hexahedron": np.arange(8)[None, :]})
    )
    shell = FileMesh(
        np.vstack([tets.points, [[1.0, 1.0, 1.0]]]), {**tets.cells, "quad": np.array([[0, 1, 2, len(tets.points)]])}
    )
    assert "1 of 1 quad cells are not on the solids" in refused(shell)


def test_sets_of_two_meshes_are_told_apart() -> None:
    one = solid_mesh(block(), 1.0, "casings.b.mesh")
    both = merged({"lower": one, "upper": one}, "casings.b.mesh")
    assert {"lower.low", "upper.low"} <= set(both.sets)
    assert "low" not in both.sets
    assert len(both.points) == 2 * len(one.points)
